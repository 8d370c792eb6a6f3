//! Display list → PNG.

use exurb_city::City;
use tiny_skia::{
    FillRule, FilterQuality, LineCap, LineJoin, Paint as Ink, Path, PathBuilder, Pixmap,
    PixmapPaint, Stroke, StrokeDash, Transform,
};

use crate::color::Color;
use crate::display::{Cap, Display, Mark, Pen, Picture, Px, Shape};
use crate::options::{Error, MAX_PX};
use crate::{Options, font, map};

/// Opaque marks of one paint are drawn together up to this many.
const BATCH: usize = 64;

/// The map as PNG, 8 bits RGB. Attribution and title stand in its text chunks.
pub fn to_png(city: &City, options: &Options) -> Result<Vec<u8>, Error> {
    if !(16..=MAX_PX).contains(&options.width_px) {
        return Err(Error::Width(options.width_px));
    }
    let display = map::draw(city, options);
    let mut pixels =
        Pixmap::new(display.width_px, display.height_px).ok_or(Error::Width(display.width_px))?;
    pixels.fill(ink(display.paper));
    for group in &display.groups {
        for run in group.marks.chunk_by(|a, b| a.paint == b.paint) {
            // Where see-through marks overlap, both count; opaque ones may be joined.
            let opaque = run.iter().all(|m| {
                m.paint.fill.is_none_or(|c| c.a == 255)
                    && (m.paint.pen.is_none() || m.paint.fill.is_none())
                    && m.paint.pen.is_none_or(|p| p.color.a == 255)
            });
            for batch in run.chunks(if opaque { BATCH } else { 1 }) {
                draw(&mut pixels, batch);
            }
        }
    }
    encode(&display, &pixels)
}

fn draw(pixels: &mut Pixmap, marks: &[Mark]) {
    let Some(first) = marks.first() else { return };
    if let Shape::Picture(picture) = &first.shape {
        return lay(pixels, picture);
    }
    let mut path = PathBuilder::new();
    marks.iter().for_each(|mark| add(&mut path, &mark.shape));
    let Some(path) = path.finish() else { return };
    if let Some(color) = first.paint.fill {
        pixels.fill_path(&path, &paint(color), FillRule::Winding, Transform::identity(), None);
    }
    if let Some(pen) = first.paint.pen {
        stroke(pixels, &path, &pen);
    }
}

/// Lays a picture over the page, stretched smoothly.
fn lay(pixels: &mut Pixmap, picture: &Picture) {
    let Some(mut map) = Pixmap::new(picture.width, picture.height) else { return };
    for (to, from) in map.pixels_mut().iter_mut().zip(picture.rgba.chunks_exact(4)) {
        *to = tiny_skia::ColorU8::from_rgba(from[0], from[1], from[2], from[3]).premultiply();
    }
    let scale = |size: f32, px: u32| size / px as f32;
    let place = Transform::from_scale(
        scale(picture.size[0], picture.width),
        scale(picture.size[1], picture.height),
    );
    let paint = PixmapPaint { quality: FilterQuality::Bilinear, ..PixmapPaint::default() };
    pixels.draw_pixmap(0, 0, map.as_ref(), &paint, place, None);
}

fn stroke(pixels: &mut Pixmap, path: &Path, pen: &Pen) {
    let stroke = Stroke {
        width: pen.width_px,
        line_cap: match pen.cap {
            Cap::Butt => LineCap::Butt,
            Cap::Round => LineCap::Round,
        },
        line_join: LineJoin::Round,
        dash: pen.dash_px.and_then(|d| StrokeDash::new(d.to_vec(), 0.0)),
        ..Stroke::default()
    };
    pixels.stroke_path(path, &paint(pen.color), &stroke, Transform::identity(), None);
}

fn add(path: &mut PathBuilder, shape: &Shape) {
    match shape {
        Shape::Area(rings) => rings.iter().for_each(|ring| {
            add_line(path, ring);
            path.close();
        }),
        Shape::Line(line) => add_line(path, line),
        Shape::Picture(_) => {}
        Shape::Disc { center, radius_px } => path.push_circle(center[0], center[1], *radius_px),
        Shape::Text { at, height_px, text } => {
            font::strokes(text, *at, *height_px).iter().for_each(|line| add_line(path, line));
        }
    }
}

fn add_line(path: &mut PathBuilder, line: &[Px]) {
    for (i, [x, y]) in line.iter().enumerate() {
        if i == 0 {
            path.move_to(*x, *y);
        } else {
            path.line_to(*x, *y);
        }
    }
}

fn ink(color: Color) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(color.r, color.g, color.b, color.a)
}

fn paint(color: Color) -> Ink<'static> {
    let mut paint = Ink { anti_alias: true, ..Ink::default() };
    paint.set_color(ink(color));
    paint
}

fn encode(display: &Display, pixels: &Pixmap) -> Result<Vec<u8>, Error> {
    // The paper is opaque, so no alpha is left.
    let rgb: Vec<u8> = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, display.width_px, display.height_px);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let texts = [("Title", &display.title), ("Copyright", &display.attribution)];
    for (keyword, text) in texts.into_iter().filter(|(_, text)| !text.is_empty()) {
        encoder.add_itxt_chunk(keyword.to_owned(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(out)
}

/// A picture as PNG with opacity.
pub fn encode_rgba(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgba)?;
    writer.finish()?;
    Ok(out)
}
