//! Filling what growth left empty.
//!
//! The paper stops when its queue is empty, which can leave large parts of a target without a
//! street. We learn how far places of the example lie from a street, look for places farther from
//! one than nearly all of these, and let a street set out towards them. Sea and hills of the example,
//! far from every street, do not count: the target is flat land.

use exurb_geom::{GridPoint, Polygon, RowPolygon, SegmentIndex, Vec2};
use exurb_operation::Run;

use super::error::Error;
use super::growth::Growth;
use super::procedural;

/// Share of the example's places from whose distance to a street the empty distance is learned: below
/// 1, so that a few parks do not decide it.
const NEAR_SHARE: f64 = 0.93;
/// A place is empty when it lies this many times as far from a street as that. In a square block the
/// centre lies 1.36 times as far, and following the example must not fill it.
const SLACK: f64 = 1.4;
/// Places of the example that are looked at, one per this many square metres up to a number.
const SAMPLE_M2: f64 = 5_000.0;
const MOST_SAMPLES: f64 = 8_000.0;
/// Distances are learned up to half of this, in metres; what lies farther lies nowhere near.
pub const FARTHEST_M: f64 = 1600.0;
/// Places of the example farther than this from every street are sea or hills, not city, in metres.
const BUILT_UP_M: f64 = 250.0;
/// Rounds at most: a round fills what the one before has brought within reach.
const ROUNDS: usize = 10;

/// Places of the built-up parts of `area`, near some street of `all`, with their distance to it.
pub fn built_up(area: &Polygon, all: &SegmentIndex) -> Vec<(Vec2, f64)> {
    let near = |p: Vec2| all.nearest_m(p, BUILT_UP_M).filter(|d| *d < BUILT_UP_M).map(|d| (p, d));
    scattered(area).filter_map(near).collect()
}

/// How far from a street a place must lie to count as empty, in metres: learned from the distances of
/// built-up places.
pub fn empty_distance_m(distances: impl Iterator<Item = f64>) -> f64 {
    let mut distances: Vec<f64> = distances.collect();
    distances.sort_by(f64::total_cmp);
    let rank = (distances.len() as f64 * NEAR_SHARE) as usize;
    distances.get(rank).map_or(FARTHEST_M, |d| SLACK * d).max(60.0)
}

/// Lets streets set out towards empty places of the growth's area until there are none in reach.
pub fn fill(growth: &mut Growth, empty_m: f64, run: &Run) -> Result<(), Error> {
    if empty_m >= FARTHEST_M {
        return Ok(());
    }
    let area = growth.area;
    for _ in 0..ROUNDS {
        let mut grew = false;
        for place in places(area, empty_m) {
            if growth.claims.owner(place).is_some()
                || !growth.relief.bears(place)
                || growth.net.edge_near(place, empty_m).is_some()
                || is_near_rim(growth, place, empty_m * 0.3)
            {
                continue;
            }
            let Some((edge, at)) = growth.net.edge_near(place, 3.0 * empty_m) else { continue };
            let before = growth.net.graph.edge_bound();
            set_out(growth, edge, at, place);
            growth.run(run)?;
            grew |= growth.net.graph.edge_bound() > before + 1;
        }
        if !grew {
            break;
        }
    }
    Ok(())
}

/// Is the border of the ground near a place with no street near? A cell's border is in its network.
fn is_near_rim(growth: &Growth, place: Vec2, near_m: f64) -> bool {
    if growth.is_main {
        return growth.area.boundary_distance_m(place) < near_m;
    }
    growth.net.rim_near(place, near_m)
}

/// Lays a street from `edge` at `at` towards `place` and queues its end.
fn set_out(growth: &mut Growth, edge: exurb_graph::EdgeId, at: Vec2, place: Vec2) {
    let e = growth.net.graph.edge(edge);
    let nearest_end = [e.from, e.to]
        .into_iter()
        .min_by(|a, b| {
            let d = |n| growth.net.graph.node(n).at.to_m().distance(at);
            d(*a).total_cmp(&d(*b))
        })
        .unwrap_or(e.from);
    let near = growth.net.graph.node(nearest_end).at.to_m().distance(at);
    let node = if e.data.is_fixed() || near < super::network::JOIN_M {
        nearest_end
    } else {
        growth.net.split(edge, GridPoint::round(at)).unwrap_or(nearest_end)
    };
    let direction = place - growth.net.graph.node(node).at.to_m();
    if let Some(direction) = direction.try_normalize() {
        procedural::step(growth, node, direction);
    }
}

/// Places scattered evenly over `area`, in no step with any street grid (the additive sequence of the
/// plastic number).
fn scattered(area: &Polygon) -> impl Iterator<Item = Vec2> {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let bounds = area.bounds();
    let size = bounds.size();
    let count = (size.x * size.y / SAMPLE_M2).clamp(100.0, MOST_SAMPLES) as u32;
    (0..count)
        .map(|i| Vec2::new(1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)) * f64::from(i + 1))
        .map(move |p| bounds.min + p.fract() * size)
        .filter(|p| area.contains(GridPoint::round(*p)))
}

/// Places of `area` on a square grid of `step_m`, row by row.
fn places(area: &Polygon, step_m: f64) -> Vec<Vec2> {
    let area = RowPolygon::new(area);
    let bounds = area.polygon().bounds();
    let size = bounds.size() / step_m;
    let (columns, rows) = (size.x.ceil() as i32, size.y.ceil() as i32);
    (0..rows)
        .flat_map(|y| (0..columns).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)))
        .map(|(x, y)| bounds.min + Vec2::new(x, y) * step_m)
        .filter(|p| area.contains(GridPoint::round(*p)))
        .collect()
}
