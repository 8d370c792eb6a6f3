//! A sample's outline put on a lot.

use exurb_geom::{GridPoint, Polygon, Vec2, grid, offset, overlay, split, trig};

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
const LEAST_SIDE_M: f64 = 3.0;
/// A court smaller than this is built over, in m².
const LEAST_COURT_M2: f64 = 25.0;
/// Buildings are scaled within these bounds to suit their lot.
const SCALES: (f64, f64) = (0.6, 1.35);
/// A footprint is at most this many times as large as its sample.
const MOST_GROWTH: f64 = 2.0;
/// A border leaning more than this is no wall, as sideways by depth.
const MOST_SKEW: f64 = 0.5;

/// The footprint; `None` where none of at least the least area fits.
pub fn place(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let mut found = None;
    if wish.wall_before || wish.wall_after {
        let bent = lot.is_corner() || lot.bulge_m > 0.5;
        found = if bent { None } else { between_walls(lot, wish) };
        found = found.or_else(|| around_corner(lot, wish));
    }
    found.or_else(|| detached(lot, wish)).filter(|p| is_sound(p, wish))
}

/// Large enough, no sliver, not blown up by a lot that is nothing like the sample's.
fn is_sound(polygon: &Polygon, wish: &Wish<'_>) -> bool {
    let sample = wish.sample;
    let perimeter: f64 = sample.outline.iter().map(|ring| closed_length(ring)).sum();
    let sample_width = 2.0 * sample.area_m2 / perimeter.max(1.0);
    polygon.area_m2() >= wish.min_area_m2
        && polygon.mean_width_m() >= (sample_width * 0.55).max(LEAST_SIDE_M * 0.6)
        && polygon.area_m2() <= sample.area_m2 * MOST_GROWTH * wish.growth.max(1.0)
        && polygon.is_valid()
}

fn closed_length(ring: &[Vec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])).sum()
}

/// Rows of houses: the ground behind the setback of every front, as deep as the sample, from border
/// to border. On a lot far larger than the sample's it is less deep.
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
    let mut depth = wish.depth_m;
    while depth > 6.0 {
        let court: Vec<Polygon> = behind(wish.setback_m + depth)
            .into_iter()
            .filter(|c| c.area_m2() > LEAST_COURT_M2)
            .collect();
        let found = if court.is_empty() {
            Some(built.clone())
        } else {
            overlay::difference(&built, &court).into_iter().next()
        };
        let found = found.and_then(without_spikes).filter(|p| is_sound(p, wish));
        if found.is_some() {
            return found;
        }
        depth *= 0.75;
    }
    None
}

/// Thin strips along slanting borders are cut off.
fn without_spikes(polygon: Polygon) -> Option<Polygon> {
    const HALF_STRIP_M: f64 = 1.4;
    let core = offset::inset(&polygon, HALF_STRIP_M).into_iter().next()?;
    let opened = offset::inset(&core, -HALF_STRIP_M).into_iter().next()?;
    // Growing back may round a corner over the border by a little.
    let kept = overlay::intersection(&opened, &polygon).into_iter().next()?;
    Some(if kept.area_m2() > 0.995 * polygon.area_m2() { polygon } else { kept })
}

/// A side of a lot as a building meets it.
#[derive(Clone, Copy)]
enum Flank {
    /// A shared wall on the border.
    Wall,
    /// A straight wall at this x.
    At(f64),
}

/// The sample's outline stretched between the borders it reaches.
fn between_walls(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let front = lot.bulge_m + wish.setback_m;
    let depth = wish.depth_m.min(lot.depth_at(0.0) - front);
    if depth < LEAST_SIDE_M {
        return None;
    }
    let size = wish.sample.size_m;
    let chord = |y: f64| lot.chord(y.max(lot.bulge_m + 0.05));
    let (near, middle, far) = (chord(front)?, chord(front + depth / 2.0)?, chord(front + depth)?);
    let inner = (near.0.max(middle.0).max(far.0), near.1.min(middle.1).min(far.1));
    // Borders that run off askew are no walls.
    let skew = |a: f64, b: f64| (b - a).abs() / depth > MOST_SKEW;
    let wall_before = wish.wall_before && !skew(near.0, far.0);
    let wall_after = wish.wall_after && !skew(near.1, far.1);
    let gap = |wall: bool, gap_m: f64| if wall { 0.0 } else { (gap_m / 2.0).max(wish.min_gap_m) };
    let mut before = gap(wall_before, wish.sample.gap_before_m);
    let mut after = gap(wall_after, wish.sample.gap_after_m);
    let room = inner.1 - inner.0;
    // Gaps wider than the lot allows shrink together; a lot far too wide leaves some of it open.
    let share = ((room - size.x.min(room * 0.8)) / (before + after).max(1e-9)).min(1.0);
    (before, after) = (before * share, after * share);
    let spare = room - before - after - size.x * SCALES.1;
    match (wall_before, wall_after) {
        _ if spare <= 0.0 => {}
        (true, false) => after += spare,
        (false, true) => before += spare,
        _ if !wall_before => (before, after) = (before + spare / 2.0, after + spare / 2.0),
        _ if spare > size.x * 0.5 => return None,
        _ => {}
    }
    if room - before - after < LEAST_SIDE_M {
        return None;
    }
    let left = if wall_before { Flank::Wall } else { Flank::At(inner.0 + before) };
    let right = if wall_after { Flank::Wall } else { Flank::At(inner.1 - after) };
    let stretch = |p: &Vec2| {
        let y = front + p.y / size.y * depth;
        let border = chord(y)?;
        let x = |flank: Flank, border: f64| match flank {
            Flank::Wall => border,
            Flank::At(x) => x,
        };
        let (l, r) = (x(left, border.0), x(right, border.1));
        Some(GridPoint::round(lot.world(Vec2::new(l + (r - l) * p.x / size.x, y))))
    };
    let mut rings =
        wish.sample.outline.iter().map(|ring| ring.iter().map(stretch).collect::<Option<Vec<_>>>());
    let outer = rings.next()??;
    let polygon = Polygon::new(outer, rings.collect::<Option<_>>()?)?;
    (is_sound(&polygon, wish) && stays_inside(&polygon, &lot.polygon)).then_some(polygon)
}

/// The sample as it is, scaled a little, with room on all sides.
fn detached(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let size = wish.sample.size_m;
    let grown = (lot.width_m / wish.sample.frontage_m.max(1.0)).clamp(0.8, 1.2);
    let grown = grown * wish.growth.sqrt().clamp(0.8, 1.3);
    let depth_scale = wish.depth_m / (size.y * wish.growth).max(1e-6);
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
