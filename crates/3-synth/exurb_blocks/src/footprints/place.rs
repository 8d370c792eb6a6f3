//! A sample's building put on a lot.

use exurb_geom::spikes::without_spikes;
use exurb_geom::{GridPoint, OrientedBox, Polygon, Vec2, grid, polyline, trig};

use super::lot::Lot;
use super::row;
use crate::filling::SHARP_RAD;
use crate::library::BuildingSample;

/// How a sample is to stand on a lot.
#[derive(Clone, Copy, Debug)]
pub struct Wish<'a> {
    /// The building to be like.
    pub sample: &'a BuildingSample,
    /// Distance from the front in metres.
    pub setback_m: f64,
    /// How many times as deep as the sample it is to be.
    pub depth_factor: f64,
    /// How many times as large as its sample the building is to be, for the block's coverage.
    pub growth: f64,
    /// Does it share its wall with the building before?
    pub wall_before: bool,
    /// And with the one after?
    pub wall_after: bool,
    /// Least gap to borders it does not reach, in metres.
    pub min_gap_m: f64,
    /// Least footprint in m².
    pub min_area_m2: f64,
}

/// A building narrower or shallower than this is none, in metres.
pub const LEAST_SIDE_M: f64 = 3.0;
/// Detached buildings are scaled within these bounds to suit their lot.
const SCALES: (f64, f64) = (0.6, 1.35);
/// A footprint is at most this many times as large as its sample.
const MOST_GROWTH: f64 = 2.0;

/// The footprint; `None` where none of at least the least area fits.
pub fn place(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let in_row = wish.wall_before || wish.wall_after;
    let found = if in_row { row::place(lot, wish) } else { None };
    found.or_else(|| detached(lot, wish)).and_then(without_hairs).filter(|p| is_sound(p, wish))
}

/// Fitted walls can overshoot by a hand's breadth.
fn without_hairs(polygon: Polygon) -> Option<Polygon> {
    without_spikes(&polygon, SHARP_RAD, f64::INFINITY)
}

/// Large enough, no sliver, not blown up by a lot that is nothing like the sample's.
pub fn is_sound(polygon: &Polygon, wish: &Wish<'_>) -> bool {
    let sample = wish.sample;
    let perimeter: f64 = sample.outline.iter().map(|ring| closed_length(ring)).sum();
    let sample_width = 2.0 * sample.area_m2 / perimeter.max(1.0);
    let longest = sample.size_m.max_element() * wish.growth.max(1.0).sqrt() * 2.0 + 10.0;
    OrientedBox::of(polygon.exterior()).is_some_and(|b| b.long_m() <= longest)
        && polygon.area_m2() >= wish.min_area_m2
        && polygon.mean_width_m() >= (sample_width * 0.5).max(LEAST_SIDE_M * 0.6)
        && polygon.area_m2() <= sample.area_m2 * MOST_GROWTH * wish.growth.max(1.0)
        && polygon.is_valid()
}

fn closed_length(ring: &[Vec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])).sum()
}

/// The sample as it is, scaled a little, with room on all sides.
fn detached(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let size = wish.sample.size_m;
    let suited = (lot.width_m / wish.sample.frontage_m.max(1.0)).clamp(0.8, 1.2);
    let suited = suited * wish.growth.sqrt().clamp(0.8, 1.3);
    let turns = [wish.sample.turn_rad, 0.0];
    let turns = if turns[0].abs() < 0.03 { &turns[1..] } else { &turns[..] };
    let mut scale = suited;
    while scale >= SCALES.0 * suited.min(1.0) {
        let scaled = size * Vec2::new(scale, scale * wish.depth_factor);
        for turn in turns {
            if let Some(found) = stand(lot, wish, scaled.min(size * SCALES.1), *turn) {
                return Some(found);
            }
        }
        scale *= 0.88;
    }
    None
}

/// A footprint of `size` behind the setback, where the gaps leave it room.
fn stand(lot: &Lot, wish: &Wish<'_>, size: Vec2, turn_rad: f64) -> Option<Polygon> {
    let deepest = lot.depth_at(0.0) - lot.bulge_m - wish.min_gap_m - size.y;
    if deepest < wish.min_gap_m || size.x < LEAST_SIDE_M || size.y < LEAST_SIDE_M {
        return None;
    }
    let front = lot.bulge_m + wish.setback_m.clamp(wish.min_gap_m, deepest);
    let (mut left, mut right) = lot.chord(front)?;
    for t in [0.5, 1.0] {
        let (l, r) = lot.chord(front + size.y * t)?;
        (left, right) = (left.max(l), right.min(r));
    }
    let slack = right - left - size.x;
    if slack < 2.0 * wish.min_gap_m {
        return None;
    }
    // At a street corner the side towards the other street keeps its distance, too.
    let street = |there: bool, gap: f64| if there { wish.setback_m.max(gap) } else { gap };
    let before = street(lot.main > 0, wish.sample.gap_before_m / 2.0).max(0.1);
    let after = street(lot.main + 1 < lot.runs.len(), wish.sample.gap_after_m / 2.0).max(0.1);
    let least = wish.min_gap_m / slack;
    let share = (before / (before + after)).clamp(least.min(0.5), 1.0 - least.min(0.5));
    let corner = Vec2::new(left + slack * share, front);
    let middle = corner + size / 2.0;
    let factor = size / wish.sample.size_m;
    let put = |p: &Vec2| {
        let p = corner + *p * factor;
        GridPoint::round(lot.world(middle + trig::rotate(p - middle, turn_rad)))
    };
    let mut rings = wish.sample.outline.iter().map(|ring| ring.iter().map(put).collect::<Vec<_>>());
    let polygon = Polygon::new(rings.next()?, rings.collect())?;
    let clear = |p: &GridPoint| lot.polygon.boundary_distance_m(p.to_m()) >= wish.min_gap_m * 0.9;
    (stays_inside(&polygon, &lot.polygon)
        && polygon.exterior().iter().all(clear)
        && polygon.is_valid())
    .then_some(polygon)
}

/// Rounding to the grid moves a point by less than this, in metres.
const ROUNDING_M: f64 = 2e-3;

/// Does `inner` lie in `outer`, give or take the rounding of points on its border?
pub fn stays_inside(inner: &Polygon, outer: &Polygon) -> bool {
    let held =
        |p: &GridPoint| outer.contains(*p) || outer.boundary_distance_m(p.to_m()) < ROUNDING_M;
    inner.exterior().iter().all(held)
        && inner.segments().all(|(a, b)| {
            let middle = GridPoint::round((a.to_m() + b.to_m()) / 2.0);
            let leaves = |(c, d): (GridPoint, GridPoint)| {
                grid::cross_properly(a, b, c, d) && !nearly_along(a, b, c, d)
            };
            held(&middle) && !outer.segments().any(leaves)
        })
}

/// Do two crossing segments run along each other, so that the crossing is one of rounding?
fn nearly_along(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> bool {
    let distance = |p: GridPoint, q: GridPoint, r: GridPoint| {
        polyline::nearest_on_segment(p.to_m(), q.to_m(), r.to_m()).0.distance(r.to_m())
    };
    let ends = [distance(a, b, c), distance(a, b, d), distance(c, d, a), distance(c, d, b)];
    ends.iter().any(|end| *end < ROUNDING_M)
}
