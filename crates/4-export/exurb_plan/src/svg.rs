//! Display list → SVG.

use std::fmt::Write;

use base64::Engine;
use exurb_city::City;

use crate::display::{Cap, Display, Group, Mark, Paint, Picture, Px, Shape};
use crate::{Options, font, map};

/// The map as SVG: a `<g id="streets">` and so on for every layer, two decimals, attribution in the
/// picture and in the metadata. Streets carry their names as titles. A width out of range is
/// brought into it.
pub fn to_svg(city: &City, options: &Options) -> String {
    let width_px = options.width_px.clamp(16, crate::options::MAX_PX);
    let display = map::draw(city, &Options { width_px, ..options.clone() });
    let mut out = String::with_capacity(1 << 16);
    head(&mut out, &display);
    for group in &display.groups {
        write_group(&mut out, group);
    }
    out.push_str("</svg>\n");
    out
}

/// Writing to a string cannot fail.
macro_rules! put {
    ($out:expr, $($arg:tt)*) => { write!($out, $($arg)*).expect("strings take everything") };
}

fn head(out: &mut String, display: &Display) {
    let (w, h) = (display.width_px, display.height_px);
    put!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    put!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
         viewBox=\"0 0 {w} {h}\" stroke-linejoin=\"round\">\n"
    );
    put!(out, "<title>{}</title>\n", escaped(&display.title));
    put!(
        out,
        "<metadata><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" \
         xmlns:dc=\"http://purl.org/dc/elements/1.1/\"><rdf:Description rdf:about=\"\">\
         <dc:title>{}</dc:title><dc:rights>{}</dc:rights>\
         </rdf:Description></rdf:RDF></metadata>\n",
        escaped(&display.title),
        escaped(&display.attribution)
    );
    put!(out, "<rect width=\"{w}\" height=\"{h}\" fill=\"{}\"/>\n", display.paper.hex());
}

/// Marks of one paint in a row share a `<g>`.
fn write_group(out: &mut String, group: &Group) {
    put!(out, "<g id=\"{}\">\n", group.id);
    for run in group.marks.chunk_by(|a, b| a.paint == b.paint && is_text(a) == is_text(b)) {
        let Some(first) = run.first() else { continue };
        out.push_str("<g");
        if is_text(first) {
            write_text_paint(out, &first.paint);
        } else {
            write_paint(out, &first.paint);
        }
        out.push_str(">\n");
        for mark in run {
            write_mark(out, mark);
        }
        out.push_str("</g>\n");
    }
    out.push_str("</g>\n");
}

fn is_text(mark: &Mark) -> bool {
    matches!(mark.shape, Shape::Text { .. })
}

fn write_paint(out: &mut String, paint: &Paint) {
    match paint.fill {
        Some(c) => put!(out, " fill=\"{}\"", c.hex()),
        None => out.push_str(" fill=\"none\""),
    }
    if let Some(c) = paint.fill.filter(|c| c.a < 255) {
        put!(out, " fill-opacity=\"{:.2}\"", c.opacity());
    }
    let Some(pen) = paint.pen else { return };
    put!(out, " stroke=\"{}\" stroke-width=\"{:.2}\"", pen.color.hex(), pen.width_px);
    if pen.color.a < 255 {
        put!(out, " stroke-opacity=\"{:.2}\"", pen.color.opacity());
    }
    if pen.cap == Cap::Round {
        out.push_str(" stroke-linecap=\"round\"");
    }
    if let Some([dash, gap]) = pen.dash_px {
        put!(out, " stroke-dasharray=\"{dash:.2} {gap:.2}\"");
    }
}

/// Words stay words: the reader's own sans serif, squeezed to the width of ours.
fn write_text_paint(out: &mut String, paint: &Paint) {
    let color = paint.pen.map(|p| p.color.hex()).unwrap_or_default();
    put!(out, " fill=\"{color}\" font-family=\"Helvetica, Arial, sans-serif\"");
}

fn write_mark(out: &mut String, mark: &Mark) {
    let tag = match &mark.shape {
        Shape::Area(rings) => {
            out.push_str("<path d=\"");
            rings.iter().for_each(|ring| write_line(out, ring, true));
            out.push('"');
            "path"
        }
        Shape::Line(line) => {
            out.push_str("<path d=\"");
            write_line(out, line, false);
            out.push('"');
            "path"
        }
        Shape::Disc { center, radius_px } => {
            put!(
                out,
                "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius_px:.2}\"",
                center[0],
                center[1]
            );
            "circle"
        }
        Shape::Picture(picture) => {
            write_picture(out, picture);
            return;
        }
        Shape::Text { at, height_px, text } => {
            put!(
                out,
                "<text x=\"{:.2}\" y=\"{:.2}\" font-size=\"{:.2}\" textLength=\"{:.2}\" \
                 lengthAdjust=\"spacingAndGlyphs\">{}</text>\n",
                at[0],
                at[1],
                height_px * 1.4,
                font::width(text, *height_px),
                escaped(text)
            );
            return;
        }
    };
    match &mark.title {
        Some(title) => put!(out, "><title>{}</title></{tag}>\n", escaped(title)),
        None => out.push_str("/>\n"),
    }
}

/// A picture inside the file, as PNG.
fn write_picture(out: &mut String, picture: &Picture) {
    let [w, h] = picture.size;
    let png = crate::raster::encode_rgba(picture).unwrap_or_default();
    let data = base64::engine::general_purpose::STANDARD.encode(png);
    put!(
        out,
        "<image width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
         href=\"data:image/png;base64,{data}\"/>\n"
    );
}

/// A line in hundredths of a pixel, each point relative to the one before as it was written, so
/// that rounding does not add up.
fn write_line(out: &mut String, line: &[Px], closed: bool) {
    let round = |p: &Px| p.map(|v| (f64::from(v) * 100.0).round() as i64);
    let mut last = [0, 0];
    for (i, p) in line.iter().enumerate() {
        let [x, y] = round(p);
        out.push(match i {
            0 => 'M',
            1 => 'l',
            _ => ' ',
        });
        write_hundredths(out, x - last[0]);
        if y >= last[1] {
            out.push(' ');
        }
        write_hundredths(out, y - last[1]);
        last = [x, y];
    }
    if closed {
        out.push('z');
    }
}

/// `-5` → `-.05`, `120` → `1.2`.
fn write_hundredths(out: &mut String, value: i64) {
    if value < 0 {
        out.push('-');
    }
    let (whole, part) = (value.abs() / 100, value.abs() % 100);
    if whole > 0 || part == 0 {
        put!(out, "{whole}");
    }
    match (part / 10, part % 10) {
        (0, 0) => {}
        (tens, 0) => put!(out, ".{tens}"),
        _ => put!(out, ".{part:02}"),
    }
}

/// Text for XML; characters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' => out.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}
