//! Trees, lamps and the like.

use exurb_city::{Feature, FeatureShape};
use exurb_geom::{Vec2, polyline};

use crate::color::rgb;
use crate::display::{Mark, Paint, Pen, Shape};
use crate::map::Map;

/// Radius of a tree's crown, and distance of the trees in a row.
const CROWN_M: f64 = 2.8;
const ROW_STEP_M: f64 = 8.0;

pub fn draw(map: &Map) -> Vec<Mark> {
    let mut marks = Vec::new();
    for feature in map.city.features.iter() {
        match (&*feature.kind, &feature.shape) {
            ("tree", FeatureShape::Point(p)) => marks.extend(tree(map, p.to_m(), feature.id)),
            ("tree_row", FeatureShape::Line(line)) => {
                let places = polyline::resample(&polyline::to_m(line), ROW_STEP_M);
                marks.extend(
                    places.iter().zip(feature.id..).filter_map(|(p, id)| tree(map, *p, id)),
                );
            }
            ("lamp", FeatureShape::Point(p)) => marks.extend(lamp(map, p.to_m())),
            _ => marks.extend(other(map, feature)),
        }
    }
    marks
}

fn tree(map: &Map, at: Vec2, id: u32) -> Option<Mark> {
    // Crowns of one size look stamped; the number decides, so that pictures repeat.
    let size = 0.8 + 0.4 * f64::from(id.wrapping_mul(2_654_435_761) >> 24) / 255.0;
    let radius_px = map.view.px(CROWN_M * size);
    let line = Pen::solid(map.base(map.sheet.tree_line), map.hair_px() * 0.8);
    let paint =
        Paint { fill: Some(map.base(map.sheet.tree)), pen: (radius_px > 1.5).then_some(line) };
    disc(map, at, radius_px, paint)
}

fn lamp(map: &Map, at: Vec2) -> Option<Mark> {
    disc(map, at, map.view.px(0.7), Paint::fill(map.base(map.sheet.lamp)))
}

/// Guidance maps and other fillings of a block are no things on the ground: outlines show them.
fn is_sketch(kind: &str) -> bool {
    kind == "guidance" || kind.starts_with("alternative_")
}

fn other(map: &Map, feature: &Feature) -> Option<Mark> {
    match &feature.shape {
        FeatureShape::Point(p) => {
            disc(map, p.to_m(), map.view.px(0.9), Paint::fill(map.base(rgb(0x8a7a9a))))
        }
        FeatureShape::Line(line) => {
            let pen = Pen::solid(map.base(map.sheet.building_line), map.hair_px());
            Some(Mark::new(Shape::Line(map.view.line(line)?), Paint::pen(pen)))
        }
        FeatureShape::Polygon(polygon) if is_sketch(&feature.kind) => {
            let pen = Pen::solid(map.base(rgb(0xc0_39_2b)), map.hair_px() * 1.5);
            Some(Mark::new(map.view.area(polygon)?, Paint::pen(pen)))
        }
        FeatureShape::Polygon(polygon) => {
            let fill = map.base(map.sheet.land_use(&feature.kind)?);
            Some(Mark::new(map.view.area(polygon)?, Paint::fill(fill)))
        }
    }
}

/// A disc in the window and large enough to be seen.
fn disc(map: &Map, at: Vec2, radius_px: f32, paint: Paint) -> Option<Mark> {
    let bounds = exurb_geom::Bounds { min: at, max: at };
    let shown = radius_px >= 0.45 && map.view.shows(bounds);
    shown.then(|| Mark::new(Shape::Disc { center: map.view.place(at), radius_px }, paint))
}
