//! Streets: by storey, in each the casings of all and then the fills of all, so that junctions open
//! into each other; important streets over lesser ones.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{City, Class, Street};
use exurb_geom::GridPoint;

use crate::display::{Cap, Mark, Paint, Pen, Px, Shape};
use crate::map::Map;
use crate::view::View;

/// A street on the paper.
struct Ribbon {
    points: Vec<Px>,
    class: Class,
    fill: Pen,
    casing: Pen,
    bridge: bool,
    name: Option<Arc<str>>,
}

/// Streets this narrow on a picture of 2,000 pixels are lines; without houses beside them, which
/// make the blocks darker than the streets, wider ones, too.
const LINE_PX: f32 = 4.0;
const LINE_ALONE_PX: f32 = 9.0;
/// Width of a usual local street in metres.
const LOCAL_M: f64 = 6.0;

/// Are local streets too narrow on the paper for a light ribbon to be seen?
pub fn are_lines(city: &City, view: &View) -> bool {
    let least = if city.buildings.is_empty() { LINE_ALONE_PX } else { LINE_PX };
    view.px(LOCAL_M) < least * view.hair_px() * HAIRS
}

/// Hairs to a pixel of a picture of 2,000.
const HAIRS: f32 = 2400.0 / 2000.0;

pub fn draw(map: &Map) -> Vec<Mark> {
    let streets = map.city.streets.edges().map(|(_, e)| (e.line(), &e.data));
    marks(map, streets)
}

pub fn other_ways(map: &Map) -> Vec<Mark> {
    marks(map, map.city.other_ways.iter().map(|w| (&w.line[..], &w.street)))
}

fn marks<'a>(map: &Map, streets: impl Iterator<Item = (&'a [GridPoint], &'a Street)>) -> Vec<Mark> {
    let mut storeys: BTreeMap<i32, Vec<Ribbon>> = BTreeMap::new();
    for (line, street) in streets {
        if let Some(ribbon) = ribbon(map, line, street) {
            storeys.entry(street.crossing_level()).or_default().push(ribbon);
        }
    }
    let mut marks = Vec::new();
    for ribbons in storeys.values_mut() {
        ribbons.sort_by_key(|r| std::cmp::Reverse(r.class));
        let line = |r: &Ribbon, pen| Mark::new(Shape::Line(r.points.clone()), Paint::pen(pen));
        if !map.sheet.is_figure() {
            marks.extend(ribbons.iter().filter(|r| r.bridge).flat_map(|r| bridge_heads(map, r)));
            marks.extend(ribbons.iter().map(|r| line(r, r.casing)));
        }
        marks.extend(ribbons.iter().map(|r| Mark { title: r.name.clone(), ..line(r, r.fill) }));
    }
    marks
}

fn ribbon(map: &Map, line: &[GridPoint], street: &Street) -> Option<Ribbon> {
    let points = map.view.line(line)?;
    let paint = map.sheet.street(street.class);
    let scale = map.hair_px() * HAIRS;
    // Thinner than a pixel is only paler.
    let least_px = (paint.least_px * scale).max(paint.least_px.min(1.0));
    let width_px = map.view.px(map.sheet.width_m(street)).max(least_px);
    let (fill, casing) = match map.key.street(street) {
        Some(color) => (color, color.shade()),
        None => (map.base(paint.fill), map.base(paint.casing)),
    };
    let edge_px = (width_px * 0.16).clamp(0.5 * scale, 1.1 * scale);
    let mut ribbon = Ribbon {
        points,
        class: street.class,
        fill: Pen::solid(fill, width_px),
        casing: Pen::solid(casing, width_px + 2.0 * edge_px),
        bridge: street.bridge,
        name: street.name.clone(),
    };
    if street.bridge {
        ribbon.casing = Pen {
            color: map.sheet.bridge,
            width_px: width_px + 2.6 * edge_px,
            cap: Cap::Butt,
            dash_px: None,
        };
    } else if street.tunnel && !map.sheet.is_figure() {
        let dash = (4.0 * scale).max(width_px * 0.6);
        ribbon.casing = Pen {
            color: casing.alpha(150),
            cap: Cap::Butt,
            dash_px: Some([dash, dash * 0.7]),
            ..ribbon.casing
        };
        ribbon.fill = Pen { color: fill.mix(map.sheet.block, 0.6), cap: Cap::Butt, ..ribbon.fill };
    }
    Some(ribbon)
}

/// Wing walls: short strokes that spread from the corners of both ends.
fn bridge_heads(map: &Map, ribbon: &Ribbon) -> Vec<Mark> {
    let n = ribbon.points.len();
    let ends = [(ribbon.points[0], ribbon.points[1]), (ribbon.points[n - 1], ribbon.points[n - 2])];
    let mut out = Vec::new();
    let line_px = (ribbon.casing.width_px - ribbon.fill.width_px) / 2.0;
    let (half, wing) = (ribbon.casing.width_px / 2.0 - line_px / 2.0, ribbon.fill.width_px * 0.35);
    for (end, inner) in ends {
        let (dx, dy) = (end[0] - inner[0], end[1] - inner[1]);
        let length = (dx * dx + dy * dy).sqrt().max(1e-3);
        let (ux, uy) = (dx / length, dy / length);
        for side in [-1.0, 1.0] {
            let (sx, sy) = (-uy * side, ux * side);
            let corner = [end[0] + sx * half, end[1] + sy * half];
            let tip = [corner[0] + (ux + sx) * wing, corner[1] + (uy + sy) * wing];
            let pen = Pen::solid(map.sheet.bridge, line_px);
            out.push(Mark::new(Shape::Line(vec![corner, tip]), Paint::pen(pen)));
        }
    }
    out
}
