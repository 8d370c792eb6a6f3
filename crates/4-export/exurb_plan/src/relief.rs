//! The terrain: shaded as if lit from the north-west over the ground of a map; coloured by height
//! where it is drawn alone.

use std::sync::Arc;

use exurb_city::Terrain;
use exurb_geom::{Vec2, trig};

use crate::Layer;
use crate::color::{Color, rgb};
use crate::display::{Mark, Paint, Picture, Shape};
use crate::map::Map;

/// Pixels of the shading along the longer side; it is smooth and needs no more.
const MOST_PX: u32 = 1600;
/// Light from 315 degrees at 45 degrees over the horizon: where it comes from, of length 1.
const SUN: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
/// Gentle slopes are drawn this many times as steep, steep ones less and less so: mountains keep
/// their ridges and do not turn black.
const EXAGGERATION: f64 = 2.0;
/// Heights of the tints, as shares of the range, and their colours.
const TINTS: [(f64, u32); 6] = [
    (0.0, 0x7da97c),
    (0.2, 0xb3c98a),
    (0.4, 0xe6dba5),
    (0.6, 0xcfae7d),
    (0.8, 0xa98a72),
    (1.0, 0xf4f1ee),
];
const UNDER_WATER: Color = rgb(0x8fbad6);

pub fn draw(map: &Map) -> Vec<Mark> {
    let Some(terrain) = &map.city.terrain else { return Vec::new() };
    let alone = map.options.layers == [Layer::Terrain];
    let (width, height) = size_px(map);
    let bounds = map.view.bounds;
    let step = bounds.size() / Vec2::new(f64::from(width), f64::from(height));
    let pixel = |i: u32| {
        let at = Vec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let p = Vec2::new(bounds.min.x + at.x * step.x, bounds.max.y - at.y * step.y);
        let Some(light) = light(terrain, p) else { return [0; 4] };
        if alone { tinted(terrain, p, light) } else { veil(light) }
    };
    let rgba = Arc::new((0..width * height).flat_map(pixel).collect());
    let size = [map.view.width_px as f32, map.view.height_px as f32];
    let picture = Picture { width, height, rgba, size };
    vec![Mark::new(Shape::Picture(picture), Paint { fill: None, pen: None })]
}

fn size_px(map: &Map) -> (u32, u32) {
    let longer = map.view.width_px.max(map.view.height_px);
    let side = |px: u32| (px * MOST_PX.min(longer)).div_ceil(longer).max(1);
    (side(map.view.width_px), side(map.view.height_px))
}

/// How much light a place gets: 0 none, 1 as flat ground.
fn light(terrain: &Terrain, p: Vec2) -> Option<f64> {
    let gradient = terrain.gradient(p)?;
    let gradient = gradient * (EXAGGERATION / (1.0 + 1.4 * gradient.length()));
    let length = (1.0 + gradient.length_squared()).sqrt();
    let facing = (SUN[2] - gradient.x * SUN[0] - gradient.y * SUN[1]) / length;
    Some(facing.max(0.0) / SUN[2])
}

/// Black where it is darker than flat ground, white where it is lighter, more or less see-through.
fn veil(light: f64) -> [u8; 4] {
    if light < 1.0 {
        // Gentle slopes show, steep ones do not drown what is drawn on them.
        let dark = trig::pow(1.0 - light, 0.85) * 0.5;
        [0, 0, 0, (dark * 255.0) as u8]
    } else {
        let bright = ((light - 1.0) / (1.0 / SUN[2] - 1.0)).min(1.0) * 0.55;
        [255, 255, 255, (bright * 255.0) as u8]
    }
}

fn tinted(terrain: &Terrain, p: Vec2, light: f64) -> [u8; 4] {
    let height = terrain.height_m(p).unwrap_or(0.0);
    let (low, high) = terrain.range_m();
    let share = (height - f64::from(low)) / f64::from(high - low).max(1e-6);
    let tint = match terrain.water_level_m() {
        Some(level) if height < level => UNDER_WATER,
        _ => tint(share),
    };
    let shaded = |c: u8| (f64::from(c) * (0.35 + 0.65 * light)).min(255.0) as u8;
    [shaded(tint.r), shaded(tint.g), shaded(tint.b), 255]
}

fn tint(share: f64) -> Color {
    let after = TINTS.iter().position(|(at, _)| *at >= share).unwrap_or(TINTS.len() - 1).max(1);
    let ((from, a), (to, b)) = (TINTS[after - 1], TINTS[after]);
    rgb(a).mix(rgb(b), ((share - from) / (to - from)).clamp(0.0, 1.0) as f32)
}
