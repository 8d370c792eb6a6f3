//! Houses in a row: from border to border where they share walls, around street corners, with wings
//! into the yard.

use exurb_geom::{GridPoint, Polygon, Vec2, offset, overlay, split};

use super::lot::Lot;
use super::place::{LEAST_SIDE_M, Wish, is_sound, stays_inside};

/// The sample's own outline is kept while it is stretched within these bounds.
const SCALES: (f64, f64) = (0.7, 1.4);
/// Lots leaning more than this from square to the street get plain shapes, sideways by depth.
const MOST_LEAN: f64 = 0.25;
/// Depth of the part along the street, at least and at most, in metres.
const BANDS_M: (f64, f64) = (7.0, 22.0);
/// A court smaller than this is built over, in m².
const LEAST_COURT_M2: f64 = 25.0;
/// Width of a wing, at least and at most, in metres.
const WINGS_M: (f64, f64) = (4.5, 10.0);
/// No wing is longer, in metres.
const LONGEST_WING_M: f64 = 20.0;
/// Where the block is to be covered much more densely, houses may be this deep, in metres.
const DEEPEST_M: f64 = 45.0;
/// Wings keep this distance from the rear border, in metres.
const REAR_GAP_M: f64 = 3.0;

/// A house that shares at least one wall; `None` where none fits.
pub fn place(lot: &Lot, wish: &Wish<'_>) -> Option<Polygon> {
    let frame = Frame::of(lot, wish);
    let bent = lot.is_corner() || lot.bulge_m > 1.5;
    let plain = || around_corner(lot, wish);
    match frame.filter(|_| !bent) {
        Some(frame) => frame.own_outline(wish).or_else(|| frame.with_wings(wish)).or_else(plain),
        None => plain(),
    }
}

/// The ground between the walls of a house, by depth behind the setback.
struct Frame<'a> {
    lot: &'a Lot,
    front_m: f64,
    /// Ground behind the setback at the middle of the front.
    depth_m: f64,
    /// x of a wall that does not lie on the border.
    left: Option<f64>,
    right: Option<f64>,
    width_m: f64,
    lean: f64,
}

impl<'a> Frame<'a> {
    fn of(lot: &'a Lot, wish: &Wish<'_>) -> Option<Self> {
        let front_m = lot.bulge_m + wish.setback_m.max(0.05);
        let depth_m = lot.depth_at(0.0) - front_m;
        let band = wish.sample.band_m.min(depth_m);
        let (near, far) = (lot.chord(front_m)?, lot.chord(front_m + band * 0.98)?);
        let (from, to) = (near.0.max(far.0), near.1.min(far.1));
        let size = wish.sample.size_m;
        let gap = |wall: bool, gap_m: f64| {
            if wall { 0.0 } else { (gap_m / 2.0).max(wish.min_gap_m) }
        };
        let mut before = gap(wish.wall_before, wish.sample.gap_before_m);
        let mut after = gap(wish.wall_after, wish.sample.gap_after_m);
        let room = to - from;
        // Gaps wider than the lot allows shrink together; on a lot far too wide they grow.
        let share = ((room - size.x.min(room * 0.8)) / (before + after).max(1e-9)).min(1.0);
        (before, after) = (before * share, after * share);
        let spare = (room - before - after - size.x * SCALES.1).max(0.0);
        match (wish.wall_before, wish.wall_after) {
            (true, false) => after += spare,
            (false, true) => before += spare,
            _ => {}
        }
        let width_m = room - before - after;
        let lean = ((far.0 - near.0).abs().max((far.1 - near.1).abs())) / band.max(1.0);
        (width_m >= LEAST_SIDE_M && depth_m >= LEAST_SIDE_M).then_some(Self {
            lot,
            front_m,
            depth_m,
            left: (!wish.wall_before).then_some(from + before),
            right: (!wish.wall_after).then_some(to - after),
            width_m,
            lean,
        })
    }

    /// The sample's outline, where it suits the lot without much stretching.
    fn own_outline(&self, wish: &Wish<'_>) -> Option<Polygon> {
        let size = wish.sample.size_m;
        let deep = wish.growth.clamp(0.85, 1.25) * wish.depth_factor;
        let depth = (size.y * deep).min(self.depth_m);
        let (wide, deep) = (self.width_m / size.x, depth / size.y);
        let held = |v: f64| (SCALES.0..=SCALES.1).contains(&v);
        if !held(wide) || !held(deep / wish.depth_factor) || self.lean > MOST_LEAN {
            return None;
        }
        let outline = wish.sample.outline.iter().map(|ring| {
            ring.iter().map(|p| Vec2::new(p.x / size.x, p.y * deep)).collect::<Vec<_>>()
        });
        let made = self.stretched(&outline.collect::<Vec<_>>())?;
        let wanted = wish.sample.area_m2 * wide * wish.growth;
        (is_sound(&made, wish) && made.area_m2() > 0.8 * wanted).then_some(made)
    }

    /// A plain house along the street, with wings behind until it is as large as wished.
    fn with_wings(&self, wish: &Wish<'_>) -> Option<Polygon> {
        let sample = wish.sample;
        let wanted = sample.area_m2 * (self.width_m / sample.size_m.x).min(1.5) * wish.growth;
        let band = (sample.band_m * wish.depth_factor).clamp(BANDS_M.0, BANDS_M.1);
        let band = band.min(wanted / self.width_m).max(BANDS_M.0).min(self.depth_m);
        let missing = wanted - band * self.width_m;
        let most = (self.depth_m - REAR_GAP_M - band).min(LONGEST_WING_M);
        let wing = (self.width_m * 0.4).clamp(WINGS_M.0, WINGS_M.1);
        let u = wing / self.width_m;
        // What side the sample's own wing lies on is lost; lean towards a shared wall.
        let on_left = wish.wall_before;
        let mirrored = |outline: Vec<Vec2>| -> Vec<Vec2> {
            if on_left {
                return outline;
            }
            outline.iter().rev().map(|p| Vec2::new(1.0 - p.x, p.y)).collect()
        };
        let v = |x: f64, y: f64| Vec2::new(x, y);
        let plain = vec![v(0.0, 0.0), v(1.0, 0.0), v(1.0, band), v(0.0, band)];
        let length = (missing / wing).min(most);
        let mut outlines = Vec::new();
        // More than two wings give, so the house fills its lot.
        let full = missing > 2.2 * wing * most.max(0.0);
        if missing > 15.0 && full {
            let deep = (wanted / self.width_m).min(self.depth_m).min(DEEPEST_M);
            outlines.push(vec![v(0.0, 0.0), v(1.0, 0.0), v(1.0, deep), v(0.0, deep)]);
        }
        if missing > 15.0 && length > 3.0 && u < 0.6 {
            let first = band + length;
            let second = band + ((missing - length * wing) / wing).min(most);
            if second > band + 3.0 && u < 0.4 {
                outlines.push(vec![
                    v(0.0, 0.0),
                    v(1.0, 0.0),
                    v(1.0, second),
                    v(1.0 - u, second),
                    v(1.0 - u, band),
                    v(u, band),
                    v(u, first),
                    v(0.0, first),
                ]);
            }
            let wing = [v(1.0, band), v(u, band), v(u, first), v(0.0, first)];
            outlines.push([&plain[..2], &wing[..]].concat());
        }
        outlines.push(plain);
        outlines
            .into_iter()
            .filter_map(|outline| self.stretched(&[mirrored(outline)]))
            .find(|made| is_sound(made, wish))
    }

    /// An outline of x from 0 to 1 between the walls and y in metres behind the setback.
    fn stretched(&self, outline: &[Vec<Vec2>]) -> Option<Polygon> {
        let point = |p: &Vec2| {
            // The rear border itself has no extent.
            let y = self.front_m + p.y.min(self.depth_m - 0.02);
            let border = self.lot.chord(y)?;
            let left = self.left.unwrap_or(border.0);
            let right = self.right.unwrap_or(border.1);
            let x = left + (right - left) * p.x;
            (x >= border.0 - 0.01 && x <= border.1 + 0.01)
                .then(|| GridPoint::round(self.lot.world(Vec2::new(x, y))))
        };
        let ring = |ring: &Vec<Vec2>| ring.iter().map(point).collect::<Option<Vec<_>>>();
        let mut rings = outline.iter().map(ring);
        let outer = rings.next()??;
        let polygon = Polygon::new(outer, rings.collect::<Option<_>>()?)?;
        (stays_inside(&polygon, &self.lot.polygon) && polygon.is_valid()).then_some(polygon)
    }
}

/// The ground behind the setback of every front, as deep as the sample, from border to border. On a
/// lot far larger than the sample's it is less deep.
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
    let band = wish.sample.band_m.clamp(BANDS_M.0, BANDS_M.1) * wish.depth_factor;
    let mut depth = (band * wish.growth.max(0.8)).clamp(BANDS_M.0, DEEPEST_M);
    while depth > BANDS_M.0 * 0.8 {
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
    // A hair along a border has length, but no area.
    let whole = kept.area_m2() > 0.995 * polygon.area_m2()
        && kept.perimeter_m() > polygon.perimeter_m() - 0.5;
    Some(if whole { polygon } else { kept })
}
