//! A sample's outline put on a lot.

use exurb_geom::{GridPoint, Polygon, Vec2, grid, overlay, split, trig};

use super::lot::Lot;
use crate::library::BuildingSample;

/// How a sample is to stand on a lot.
#[derive(Clone, Copy, Debug)]
pub struct Wish<'a> {
    /// The building to be like.
    pub sample: &'a BuildingSample,
    /// Distance from the front in metres.
    pub setback_m: f64,
    /// Depth to aim at in metres.
    pub depth_m: f64,
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
const LEAST_SIDE_M: f64 = 3.0;
/// A court smaller than this is built over, in m².
const LEAST_COURT_M2: f64 = 25.0;
/// Buildings are scaled within these bounds to suit their lot.
const SCALES: (f64, f64) = (0.6, 1.35);

/// The footprint; `None` where none of at least the least area fits.
pub fn place(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let in_row = wish.wall_before || wish.wall_after;
    let found = if in_row && (lot.is_corner() || lot.bulge_m > 0.5) {
        around_corner(lot, wish)
    } else if in_row {
        between_walls(lot, wish).or_else(|| around_corner(lot, wish))
    } else {
        detached(lot, wish)
    };
    found.filter(|p| p.area_m2() >= wish.min_area_m2)
}

/// Rows of houses: the ground behind the setback of every front, as deep as the sample, from border
/// to border.
fn around_corner(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let behind = |distance_m: f64| {
        let mut ground = vec![lot.polygon.clone()];
        for run in &lot.runs {
            let (a, b) = run.line_at(distance_m);
            ground = ground.iter().flat_map(|g| split::left_of(g, a, b)).collect();
        }
        ground
    };
    let built = behind(wish.setback_m).into_iter().next()?;
    let court: Vec<Polygon> = behind(wish.setback_m + wish.depth_m)
        .into_iter()
        .filter(|c| c.area_m2() > LEAST_COURT_M2)
        .collect();
    if court.is_empty() {
        return Some(built);
    }
    let mut rest = overlay::difference(&built, &court).into_iter();
    rest.find(|p| p.is_valid() && p.mean_width_m() > LEAST_SIDE_M / 2.0)
}

/// The sample's outline stretched between the borders it reaches.
fn between_walls(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let front = lot.bulge_m + wish.setback_m;
    let gap = |wall: bool, gap_m: f64| if wall { 0.0 } else { (gap_m / 2.0).max(wish.min_gap_m) };
    let before = gap(wish.wall_before, wish.sample.gap_before_m);
    let after = gap(wish.wall_after, wish.sample.gap_after_m);
    let depth = wish.depth_m.min(lot.depth_at(0.0) - front);
    if depth < LEAST_SIDE_M {
        return None;
    }
    let size = wish.sample.size_m;
    let mut narrow = false;
    let mut stretch = |p: &Vec2| {
        let y = front + p.y / size.y * depth;
        let (left, right) = lot.chord(y.max(lot.bulge_m + 0.05))?;
        let room = right - left;
        // Gaps wider than the lot allows shrink together.
        let share = ((room - size.x.min(room * 0.7)) / (before + after).max(1e-9)).min(1.0);
        let (left, right) = (left + before * share, right - after * share);
        narrow |= right - left < LEAST_SIDE_M;
        Some(lot.world(Vec2::new(left + (right - left) * p.x / size.x, y)))
    };
    let rings: Option<Vec<Vec<GridPoint>>> = wish
        .sample
        .outline
        .iter()
        .map(|ring| ring.iter().map(|p| stretch(p).map(GridPoint::round)).collect())
        .collect();
    let mut rings = rings?.into_iter();
    let polygon = Polygon::new(rings.next()?, rings.collect())?;
    (!narrow && polygon.is_valid() && stays_inside(&polygon, &lot.polygon)).then_some(polygon)
}

/// The sample as it is, scaled a little, with room on all sides.
fn detached(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let size = wish.sample.size_m;
    let grown = (lot.width_m / wish.sample.frontage_m.max(1.0)).clamp(0.8, 1.2);
    let depth_scale = wish.depth_m / size.y.max(1e-6);
    let mut scale = grown;
    while scale >= SCALES.0 * grown.min(1.0) {
        let scaled = Vec2::new(size.x * scale, size.y * scale * depth_scale);
        let turns = [wish.sample.turn_rad, 0.0];
        let turns = if turns[0].abs() < 0.03 { &turns[1..] } else { &turns[..] };
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
    let front = lot.bulge_m + wish.setback_m.min(deepest).max(0.0);
    let chord = |t: f64| lot.chord((front + size.y * t).max(lot.bulge_m + 0.05));
    let (mut left, mut right) = chord(0.0)?;
    for t in [0.5, 1.0] {
        let (l, r) = chord(t)?;
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
    let share =
        (before / (before + after)).clamp(wish.min_gap_m / slack, 1.0 - wish.min_gap_m / slack);
    let corner = Vec2::new(left + slack * share, front);
    let middle = corner + size / 2.0;
    let factor = size / wish.sample.size_m;
    let put = |p: &Vec2| {
        let p = corner + *p * factor;
        lot.world(middle + trig::rotate(p - middle, turn_rad))
    };
    let mut rings = wish
        .sample
        .outline
        .iter()
        .map(|ring| ring.iter().map(|p| GridPoint::round(put(p))).collect::<Vec<_>>());
    let polygon = Polygon::new(rings.next()?, rings.collect())?;
    let clear = |p: &GridPoint| lot.polygon.boundary_distance_m(p.to_m()) >= wish.min_gap_m * 0.9;
    (stays_inside(&polygon, &lot.polygon)
        && polygon.exterior().iter().all(clear)
        && polygon.is_valid())
    .then_some(polygon)
}

/// Does `inner` lie in `outer`, give or take the rounding of points on its border?
fn stays_inside(inner: &Polygon, outer: &Polygon) -> bool {
    const ROUNDING_M: f64 = 2e-3;
    let held =
        |p: &GridPoint| outer.contains(*p) || outer.boundary_distance_m(p.to_m()) < ROUNDING_M;
    inner.exterior().iter().all(held)
        && inner.segments().all(|(a, b)| {
            let middle = GridPoint::round((a.to_m() + b.to_m()) / 2.0);
            held(&middle)
                && !outer
                    .segments()
                    .any(|(c, d)| grid::cross_properly(a, b, c, d) && !nearly_along(a, b, c, d))
        })
}

/// Do two crossing segments run along each other, so that the crossing is one of rounding?
fn nearly_along(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> bool {
    const ROUNDING_M: f64 = 2e-3;
    let distance = |p: GridPoint, q: GridPoint, r: GridPoint| {
        exurb_geom::polyline::nearest_on_segment(p.to_m(), q.to_m(), r.to_m()).0.distance(r.to_m())
    };
    let ends = [distance(a, b, c), distance(a, b, d), distance(c, d, a), distance(c, d, b)];
    ends.iter().any(|end| *end < ROUNDING_M)
}
