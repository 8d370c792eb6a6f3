//! What makes buildings alike from above.

use std::collections::BTreeMap;

use exurb_city::{Block, City};
use exurb_geom::{BoxGrid, GridPoint, OrientedBox, PointIndex, Polygon, trig};

/// ln of footprint area; ln of the shorter side; share of the block covered; ln of the usual
/// footprint nearby; 1 for a building that shares a wall.
pub type Likeness = [f64; 5];

/// What each value weighs.
const WEIGHTS: Likeness = [1.0, 0.5, 2.0, 0.6, 0.5];
/// Buildings this near are nearby, in metres.
const NEARBY_M: f64 = 150.0;
/// Walls nearer than this are one, in millimetres.
const SHARED_WALL_MM: i32 = 300;

/// Squared distance of two buildings in likeness.
pub fn square_distance(a: &Likeness, b: &Likeness) -> f64 {
    (0..a.len()).map(|k| WEIGHTS[k] * (a[k] - b[k]).powi(2)).sum()
}

/// The likeness of the footprints in `chosen`, indices into the city's buildings. `block_of` gives
/// the index of the block of each of them.
pub fn of_city(
    city: &City,
    blocks: &[Block],
    chosen: &[usize],
    block_of: &[Option<usize>],
) -> Vec<Likeness> {
    let polygon = |i: usize| &city.buildings[i].polygon;
    let mut covered: BTreeMap<usize, f64> = BTreeMap::new();
    let mut centers = PointIndex::new(NEARBY_M);
    for (k, i) in chosen.iter().enumerate() {
        if let Some(b) = block_of[k] {
            *covered.entry(b).or_insert(0.0) += polygon(*i).area_m2();
        }
        centers.insert(k as u32, polygon(*i).centroid());
    }
    let areas: Vec<f64> = chosen.iter().map(|i| polygon(*i).area_m2()).collect();
    let boxes = BoxGrid::of(chosen.iter().map(|i| polygon(*i)));
    let mut near = Vec::new();
    let mut out = Vec::with_capacity(chosen.len());
    for (k, i) in chosen.iter().enumerate() {
        let coverage =
            block_of[k].map_or(0.0, |b| covered[&b] / blocks[b].polygon.area_m2().max(1.0));
        let around = centers.within(polygon(*i).centroid(), NEARBY_M);
        let mut usual: Vec<f64> = around.iter().map(|(n, _)| areas[*n as usize]).collect();
        let middle = usual.len() / 2;
        usual.select_nth_unstable_by(middle, f64::total_cmp);
        let (low, high) = grown_box(polygon(*i), SHARED_WALL_MM);
        boxes.meeting(low, high, &mut near);
        let touches = near
            .iter()
            .any(|n| *n as usize != k && share_wall(polygon(*i), polygon(chosen[*n as usize])));
        let short = OrientedBox::of(polygon(*i).exterior()).map_or(1.0, |b| b.short_m());
        let ln = |v: f64| trig::ln(v.max(1.0));
        out.push([ln(areas[k]), ln(short), coverage, ln(usual[middle]), f64::from(touches)]);
    }
    out
}

fn grown_box(polygon: &Polygon, by_mm: i32) -> (GridPoint, GridPoint) {
    let bounds = polygon.bounds();
    let (low, high) = (GridPoint::round(bounds.min), GridPoint::round(bounds.max));
    (
        GridPoint { x: low.x - by_mm, y: low.y - by_mm },
        GridPoint { x: high.x + by_mm, y: high.y + by_mm },
    )
}

fn share_wall(a: &Polygon, b: &Polygon) -> bool {
    let within_m = f64::from(SHARED_WALL_MM) / 1000.0;
    let reaches = |p: &Polygon, q: &Polygon| {
        p.exterior().iter().any(|c| q.boundary_distance_m(c.to_m()) < within_m)
    };
    reaches(a, b) || reaches(b, a)
}
