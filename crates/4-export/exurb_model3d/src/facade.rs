//! Textures of walls: four storeys of four bays, drawn here, repeated over every facade. Walls are
//! white in the texture; the colour of the building tints them.

use crate::palette::dice;
use crate::scene::Material;

/// Pixels along each side.
pub const SIZE: usize = 256;
/// Bays and storeys in the texture.
pub const BAYS: usize = 4;
const CELL: usize = SIZE / BAYS;

/// An RGB picture, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub pixels: Vec<[u8; 3]>,
}

/// The texture of a material that has one.
pub fn picture(material: Material) -> Option<Picture> {
    let cell: fn(usize, usize, u32) -> [u8; 3] = match material {
        Material::Windows => window,
        Material::Glass => glass,
        Material::Plain | Material::Water => return None,
    };
    let pixel = |i: usize| {
        let (x, y) = (i % SIZE, i / SIZE);
        let bay = (y / CELL * BAYS + x / CELL) as u32;
        cell(x % CELL, y % CELL, bay)
    };
    Some(Picture { pixels: (0..SIZE * SIZE).map(pixel).collect() })
}

/// The texture packed as PNG.
pub fn png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, SIZE as u32, SIZE as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.pixels.as_flattened())?;
    writer.finish()?;
    Ok(out)
}

const WALL: u8 = 250;

fn grey(v: i32) -> [u8; 3] {
    [v.clamp(0, 255) as u8; 3]
}

/// A single window in the middle of its bay.
fn window(x: usize, y: usize, bay: u32) -> [u8; 3] {
    let (x, y) = (x as i32, y as i32);
    let (left, right, top, bottom) = (18, 46, 12, 50);
    let grain = (dice((y * 64 + x) as u32, bay) % 7) as i32;
    let inside = (left..right).contains(&x) && (top..bottom).contains(&y);
    if !inside {
        // A sill with its shadow, and the reveal's edge.
        let sill = (left - 2..right + 2).contains(&x);
        return match y - bottom {
            0..3 if sill => grey(235),
            3..6 if sill => grey(190),
            _ if (left - 2..right + 2).contains(&x) && (top - 2..bottom).contains(&y) => grey(225),
            _ => grey(i32::from(WALL) - grain),
        };
    }
    let frame = x < left + 2
        || x >= right - 2
        || y < top + 2
        || y >= bottom - 2
        || (31..33).contains(&x)
        || (y == top + 12);
    if frame {
        return grey(228);
    }
    // Glass mirrors the sky above, shows the dark room below; some rooms have curtains.
    let sky = (bottom - y) * 38 / (bottom - top);
    let under_lintel = if y < top + 6 { -22 } else { 0 };
    let [mut r, mut g, mut b] = [62 + sky + under_lintel, 74 + sky + under_lintel, 92 + sky];
    let kind = dice(bay, 91) % 4;
    if kind == 0 && (x < left + 9 || x >= right - 9) {
        [r, g, b] = [168, 160, 148];
    }
    if kind == 1 && y < top + 16 {
        [r, g, b] = [176, 172, 164];
    }
    [r, g, b].map(|v| v.clamp(0, 255) as u8)
}

/// A band of panes over a parapet.
fn glass(x: usize, y: usize, bay: u32) -> [u8; 3] {
    let (x, y) = (x as i32, y as i32);
    let (top, bottom) = (8, 46);
    if !(top..bottom).contains(&y) {
        let joint = x < 1 || y == 63;
        return grey(if joint { 214 } else { i32::from(WALL) - (y - bottom).rem_euclid(3) });
    }
    if x % 21 < 2 || y < top + 1 || y >= bottom - 1 {
        return grey(150);
    }
    let pane = dice(bay, 50 + (x / 21) as u32) % 30;
    let sky = (bottom - y) * 46 / (bottom - top) + pane as i32;
    let under = if y < top + 5 { -20 } else { 0 };
    [58 + sky + under, 78 + sky + under, 98 + sky + under].map(|v| v.clamp(0, 255) as u8)
}
