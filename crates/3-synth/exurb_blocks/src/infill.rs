//! What a layout lost on its way into a block is made good: more of its buildings, where there is room.
//!
//! A row laid out anew lines the kerb, and what the example had behind it is often lost; a block larger
//! than the example's has room the layout knows nothing of. So the layout is laid into the block as a
//! whole, too: as the outlines match, along each of the block's sides, shifted by parts of its size, and
//! turned round. Of each of these poses the buildings that stand free stay, until the block is built on as
//! much as it should be. Neighbours of one pose keep their places to each other, as pieces of a texture
//! do, but each building is turned a little about its middle, so that it lies to the kerb as it lay at home.

use exurb_city::Building;
use exurb_geom::{
    Bounds, BoxGrid, GridPoint, Polygon, Rigid, Vec2, overlap, overlay, polyline, trig,
};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use crate::database::{Layout, is_civic};
use crate::kerb::Kerb;
use crate::lay::{Laid, Spacing, Wish, body, put};
use crate::library::{OpenNearby, are_near, main_direction};
use crate::refine::{Body, Ground, SLACK_M2, is_off_kerb};
use crate::retarget::is_whole;
use crate::slices::Slices;

/// Buildings that stand by themselves keep this far from those of other poses, in metres.
const APART_M: f64 = 1.5;
/// Buildings nearer than this to another of their layout are attached to it, in metres.
const ATTACHED_M: f64 = 0.3;
/// Shifts to either side at most.
const MOST_SHIFTS: i32 = 12;
/// Buildings are turned towards the kerb by at most so many radians.
const MOST_TURN: f64 = 0.25;
/// Sides of a block shorter than this share of its outline give no pose.
const SIDE_SHARE: f64 = 0.08;
/// Directions nearer to each other than this are one, in radians.
const SAME_DIRECTION: f64 = 0.1;
/// Areas told by slices surely lie above a limit when they lie above so many times that and so many m² more.
const SURELY: (f64, f64) = (1.5, 3.0);
/// A building is added where at least this share of it is missing.
const ADD_SHARE: f64 = 0.6;

/// Where buildings are added, and how much is to stand there.
pub struct Room<'a> {
    /// The block.
    pub ground: &'a Ground<'a>,
    /// Open land in it.
    pub open: &'a OpenNearby<'a>,
    /// How close buildings may come.
    pub spacing: Spacing,
    /// What is to be built on in all, in m².
    pub goal_m2: f64,
    /// Shifts that make up the layout's size.
    pub shifts: u32,
    /// The smallest building to be added, as a quantile of the layout's sizes: small ones find room
    /// anywhere, and too many of them would come.
    pub least: f64,
}

/// Adds buildings of `layout`, which `motion` lays on the block, to `laid` until the goal is met or
/// nothing more finds room. Civic buildings are not repeated, nor layouts of few large buildings.
/// O(poses · footprints) but for the few that find room.
pub fn infill(laid: &mut Laid, layout: &Layout, motion: &Rigid, room: &Room<'_>) {
    let mut missing_m2 = room.goal_m2 - laid.built_m2();
    let polygons: Vec<&Polygon> = layout.footprints.iter().map(|f| &f.building.polygon).collect();
    let area_m2: Vec<f64> = polygons.iter().map(|p| p.area_m2()).collect();
    let smallest_m2 = quantile(area_m2.clone(), room.least);
    let least_m2 = smallest_m2 * ADD_SHARE;
    if missing_m2 < least_m2 || is_whole(layout.kerb.area_m2(), &polygons) {
        return;
    }
    let attached = attached(&polygons);
    let middles: Vec<Vec2> = polygons.iter().map(|p| p.interior_point()).collect();
    let home = Kerb::of(&layout.kerb);
    let along: Vec<f64> = middles.iter().map(|p| kerb_angle(&home, *p)).collect();
    let mut order: Vec<usize> = (0..polygons.len())
        .filter(|i| !is_civic(layout.footprints[*i].building.usage.as_deref()))
        .filter(|i| area_m2[*i] >= smallest_m2)
        .collect();
    order.sort_by(|a, b| area_m2[*b].total_cmp(&area_m2[*a]).then(a.cmp(b)));
    let provenance = layout.provenance();
    let ground = room.ground;
    let mut bodies = Bodies::default();
    ground.standing.iter().for_each(|p| bodies.add(p.clone()));
    laid.buildings.iter().filter(|b| !b.is_part).for_each(|b| bodies.add(b.polygon.clone()));
    for pose in poses(layout, motion, ground, room.shifts) {
        let turn = trig::angle(pose.turn);
        for &i in &order {
            if missing_m2 < least_m2 {
                return;
            }
            let middle = pose.apply(middles[i]);
            if area_m2[i] * ADD_SHARE > missing_m2
                || bodies.hold(middle)
                || !ground.kerb.contains(middle)
            {
                continue;
            }
            let lay = if pose.mirrored { -along[i] } else { along[i] };
            let off = quarter(kerb_angle(ground.kerb, middle) - lay - turn);
            if off.abs() > MOST_TURN {
                continue;
            }
            let motion = pose.then(&Rigid::about(middle, trig::unit(off), Vec2::ZERO));
            let wish = Wish { what: &layout.footprints[i], motion: motion.into() };
            let Ok(wished) = body(&wish, room.open, room.spacing.pavement_m) else { continue };
            let tolerance = room.spacing.tolerance;
            let Some(polygon) = fitted(&wished, attached[i], &bodies, ground, tolerance) else {
                continue;
            };
            missing_m2 -= polygon.area_m2();
            bodies.add(polygon.clone());
            put(&mut laid.buildings, &wish, &wished.polygon, polygon, &provenance);
        }
    }
}

/// Adds `others`, which stand in the same block in other fillings, where they stand free, larger ones
/// first, until `goal_m2` stands there. `least` as in [`Room`].
pub fn add_free(laid: &mut Laid, others: &[Building], goal_m2: f64, least: f64) {
    let mut missing_m2 = goal_m2 - laid.built_m2();
    let mut others: Vec<(f64, &Building)> =
        others.iter().filter(|b| !b.is_part).map(|b| (b.polygon.area_m2(), b)).collect();
    let smallest_m2 = quantile(others.iter().map(|(area_m2, _)| *area_m2).collect(), least);
    others.retain(|(area_m2, _)| *area_m2 >= smallest_m2);
    others.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut bodies = Bodies::default();
    laid.buildings.iter().filter(|b| !b.is_part).for_each(|b| bodies.add(b.polygon.clone()));
    for (area_m2, building) in others {
        let polygon = &building.polygon;
        let is_near = |b: &&Polygon| {
            are_near(b, polygon, APART_M) || overlap::shared_m2(b, polygon, 0.0) > 0.0
        };
        let around = polygon.bounds().grown(APART_M);
        if area_m2 * ADD_SHARE <= missing_m2 && !bodies.near(around).iter().any(is_near) {
            missing_m2 -= area_m2;
            bodies.add(polygon.clone());
            laid.buildings.push(building.clone());
        }
    }
}

/// The value below which this share of the values lies; 0 where there are none.
fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get((values.len() as f64 * share) as usize).copied().unwrap_or(0.0)
}

/// What stands already, by its boxes.
#[derive(Default)]
struct Bodies {
    all: Vec<Polygon>,
    slices: Vec<Slices>,
    boxes: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

impl Bodies {
    fn add(&mut self, polygon: Polygon) {
        let Bounds { min, max } = polygon.bounds();
        let around = Rectangle::from_corners([min.x, min.y], [max.x, max.y]);
        self.boxes.insert(GeomWithData::new(around, self.all.len()));
        self.slices.push(sliced(&polygon));
        self.all.push(polygon);
    }

    /// Does `p` lie in one of them?
    fn hold(&self, p: Vec2) -> bool {
        let at = GridPoint::round(p);
        self.near(Bounds { min: p, max: p }).into_iter().any(|polygon| polygon.contains(at))
    }

    /// Those whose boxes meet a box, in the order they came in.
    fn near(&self, bounds: Bounds) -> Vec<&Polygon> {
        self.numbers_near(bounds).into_iter().map(|i| &self.all[i]).collect()
    }

    fn numbers_near(&self, bounds: Bounds) -> Vec<usize> {
        let Bounds { min, max } = bounds;
        let asked = AABB::from_corners([min.x, min.y], [max.x, max.y]);
        let mut found: Vec<usize> =
            self.boxes.locate_in_envelope_intersecting(&asked).map(|b| b.data).collect();
        found.sort_unstable();
        found
    }
}

fn sliced(polygon: &Polygon) -> Slices {
    let rings: Vec<Vec<Vec2>> = polygon.rings().map(polyline::to_m).collect();
    Slices::of(rings.iter().map(|r| &r[..]))
}

/// Which footprints share walls with others.
fn attached(polygons: &[&Polygon]) -> Vec<bool> {
    let boxes = BoxGrid::of(polygons.iter().copied());
    let mut near = Vec::new();
    let mut is_attached = |(i, p): (usize, &&Polygon)| {
        let around = p.bounds().grown(ATTACHED_M);
        boxes.meeting(GridPoint::round(around.min), GridPoint::round(around.max), &mut near);
        near.iter().map(|j| *j as usize).any(|j| j != i && are_near(p, polygons[j], ATTACHED_M))
    };
    polygons.iter().enumerate().map(&mut is_attached).collect()
}

/// Angle of the kerb nearest to a point.
fn kerb_angle(kerb: &Kerb, p: Vec2) -> f64 {
    trig::angle(kerb.nearest(p).1.direction)
}

/// An angle less the quarter turns nearest to it.
fn quarter(angle: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    angle - (angle / quarter).round() * quarter
}

/// The poses of a layout in a block: as it lies on it and along the block's sides, shifted and turned
/// round, near ones first.
fn poses(layout: &Layout, motion: &Rigid, ground: &Ground<'_>, shifts: u32) -> Vec<Rigid> {
    let outline: Vec<Vec2> = layout.outline.iter().map(|p| motion.apply(p.to_m())).collect();
    let sides = (0..outline.len()).map(|i| (outline[i], outline[(i + 1) % outline.len()]));
    let main = main_direction(sides);
    let mut turns = vec![0.0];
    let ring = &ground.kerb.rings[0];
    for side in ring.sides() {
        let way = ring.point_at(side.end_m) - ring.point_at(side.start_m);
        let turn = quarter(trig::angle(way) - main);
        let is_new = |t: &f64| quarter(t - turn).abs() > SAME_DIRECTION;
        if side.length_m() > SIDE_SHARE * ring.length_m() && turns.iter().all(is_new) {
            turns.push(turn);
        }
    }
    let mut found = Vec::new();
    for turn in turns {
        let along = trig::unit(main + turn);
        let (low, high) = extent(&mut outline.iter().copied(), along);
        let middle = in_plane((low + high) / 2.0, along);
        let turned = motion.then(&Rigid::about(middle, trig::unit(turn), Vec2::ZERO));
        let placed = layout.outline.iter().map(|p| turned.apply(p.to_m()));
        let own = extent(&mut placed.into_iter(), along);
        let whole = extent(&mut ground.block.exterior().iter().map(|p| p.to_m()), along);
        let size = (own.1 - own.0).max(Vec2::ONE);
        let step = size / f64::from(shifts);
        for i in -MOST_SHIFTS..=MOST_SHIFTS {
            for j in -MOST_SHIFTS..=MOST_SHIFTS {
                let by = Vec2::new(f64::from(i), f64::from(j)) * step;
                let (low, high) = ((own.0 + by).max(whole.0), (own.1 + by).min(whole.1));
                // At least a quarter of it lies over the block each way.
                if (high - low).cmplt(size / 4.0).any() {
                    continue;
                }
                let shift = in_plane(by, along);
                for half in [Vec2::X, Vec2::NEG_X] {
                    found.push((i * i + j * j, turned.then(&Rigid::about(middle, half, shift))));
                }
            }
        }
    }
    found.sort_by_key(|(far, _)| *far);
    found.into_iter().map(|(_, pose)| pose).collect()
}

/// Lower and upper corner of points in the frame of a direction.
fn extent(points: &mut dyn Iterator<Item = Vec2>, along: Vec2) -> (Vec2, Vec2) {
    points.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), p| {
        let q = Vec2::new(p.dot(along), p.dot(along.perp()));
        (low.min(q), high.max(q))
    })
}

/// A point of that frame in the plane.
fn in_plane(p: Vec2, along: Vec2) -> Vec2 {
    along * p.x + along.perp() * p.y
}

/// The outline of a wished building where it finds room. One that shares walls in its layout may lose
/// to another what the tolerance allows, and shares a wall there.
fn fitted(
    wished: &Body,
    attached: bool,
    bodies: &Bodies,
    ground: &Ground<'_>,
    tolerance: f64,
) -> Option<Polygon> {
    let polygon = &wished.polygon;
    let mut in_the_way = Vec::new();
    let near = bodies.numbers_near(polygon.bounds().grown(APART_M));
    let most_m2 = if attached { tolerance * polygon.area_m2() } else { SLACK_M2 };
    if attached && !near.is_empty() {
        // Most poses lie in others by far: seen quickly.
        let slices = sliced(polygon);
        let surely_m2 = most_m2 * SURELY.0 + SURELY.1;
        if near.iter().any(|i| slices.shared_m2(0.0, &bodies.slices[*i]) > surely_m2) {
            return None;
        }
    }
    for other in near.into_iter().map(|i| &bodies.all[i]) {
        if !attached && are_near(other, polygon, APART_M) {
            return None;
        }
        let shared_m2 = overlap::shared_m2(polygon, other, SLACK_M2);
        if shared_m2 > most_m2 {
            return None;
        }
        if shared_m2 > SLACK_M2 {
            in_the_way.push(other);
        }
    }
    if !polygon.is_valid() || !is_off_kerb(ground, wished) {
        return None;
    }
    if in_the_way.is_empty() {
        return Some(polygon.clone());
    }
    let least_m2 = polygon.area_m2() * (1.0 - tolerance);
    let left = overlay::difference(polygon, in_the_way).into_iter().next()?;
    (left.area_m2() >= least_m2 && left.is_valid()).then_some(left)
}

#[cfg(test)]
mod tests {
    use exurb_city::City;

    use super::*;
    use crate::database::BlockDatabase;
    use crate::library::OpenLand;
    use crate::test_city::{Style, grid};

    /// What comes of filling up an empty block of that size, turned, with the layout of a block of 120 m
    /// by 90 m.
    fn filled(size_m: Vec2, angle: f64, goal: f64, style: Style) -> (Polygon, Laid) {
        let mut city: City = grid(1, 1, Vec2::new(120.0, 90.0), style);
        // Without blocks buildings are found by where they stand.
        let blocks = std::mem::take(&mut city.blocks);
        let layout = BlockDatabase::layout_of(&city, &blocks, 0).expect("a block");
        let middle = layout.kerb.centroid();
        let block = Polygon::rectangle(
            GridPoint::round(middle - size_m / 2.0),
            GridPoint::round(middle + size_m / 2.0),
        );
        let turn = Rigid::about(middle, trig::unit(angle), Vec2::ZERO);
        let block = turn.apply_polygon(&block).expect("has area");
        let kerb = Kerb::of(&block);
        let ground = Ground { block: &block, kerb: &kerb, standing: &[], at_home: false };
        let open = OpenLand::of(&city);
        let room = Room {
            ground: &ground,
            open: &open.near(&block),
            spacing: Spacing { pavement_m: 2.0, tolerance: 0.1, cut: 0.0 },
            goal_m2: goal * block.area_m2(),
            shifts: 2,
            least: 0.5,
        };
        let mut laid = Laid::default();
        infill(&mut laid, &layout, &Rigid::IDENTITY, &room);
        (block, laid)
    }

    #[test]
    fn a_block_larger_than_the_layouts_is_filled_to_the_goal_and_no_further() {
        for style in [Style::Rows, Style::Detached] {
            let (block, laid) = filled(Vec2::new(260.0, 200.0), 0.4, 0.15, style);
            let share = laid.built_m2() / block.area_m2();
            assert!((share - 0.15).abs() < 0.01, "{style:?} {share}");
            for (i, building) in laid.buildings.iter().enumerate() {
                assert!(overlap::outside_m2(&building.polygon, &block) == 0.0);
                let others = laid.buildings[..i].iter();
                let shares = |b: &Building| {
                    overlap::shared_m2(&b.polygon, &building.polygon, 0.0) > SLACK_M2
                };
                assert!(!others.into_iter().any(shares));
            }
        }
    }

    #[test]
    fn buildings_lie_to_the_kerb_as_they_did() {
        let (block, laid) = filled(Vec2::new(260.0, 200.0), 0.4, 0.1, Style::Detached);
        let kerb = Kerb::of(&block);
        assert!(!laid.buildings.is_empty());
        for building in &laid.buildings {
            let sides = building.polygon.segments().map(|(a, b)| (a.to_m(), b.to_m()));
            let off = main_direction(sides) - kerb_angle(&kerb, building.polygon.centroid());
            assert!(quarter(off).abs() < 0.01, "{off}");
        }
    }

    #[test]
    fn what_is_built_enough_stays_as_it_is() {
        assert!(filled(Vec2::new(100.0, 100.0), 0.0, 0.0, Style::Rows).1.buildings.is_empty());
    }
}
