//! The pure core: one block's kerb and open ground → trees and lamps.

use exurb_geom::{GridPoint, PointIndex, Polygon, SegmentGrid, Vec2, offset, polyline, trig};
use exurb_operation::Rng;
use rand::RngExt;

use super::Params;
use super::learn::Row;

/// What stands somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A tree.
    Tree,
    /// A street lamp.
    Lamp,
}

/// Where things may stand.
pub struct Ground<'a> {
    /// Kerb line of the block.
    pub block: &'a Polygon,
    /// Its segments.
    pub kerb: SegmentGrid,
    /// Width of its pavement in metres.
    pub pavement_m: f64,
    /// Buildings nearby.
    pub buildings: Vec<&'a Polygon>,
    /// May a thing of that kind stand at the kerb here?
    pub street_has: &'a dyn Fn(Kind, Vec2) -> bool,
    /// Is the place kept free: water, under a bridge?
    pub is_taken: &'a dyn Fn(Vec2) -> bool,
}

impl Ground<'_> {
    fn is_at_kerb(&self, p: Vec2) -> bool {
        let at = GridPoint::round(p);
        let mut near = Vec::new();
        self.kerb.near(at, at, (LEAST_KERB_M * 1000.0) as i32, &mut near);
        near.iter().any(|id| {
            let (a, b) = self.kerb.segment(*id);
            polyline::nearest_on_segment(a.to_m(), b.to_m(), p).0.distance(p) < LEAST_KERB_M
        })
    }
}

/// Trees stand this far behind the kerb, lamps somewhat more, in metres.
const TREE_M: f64 = 1.0;
const LAMP_M: f64 = 1.5;
/// Nothing stands nearer to the kerb, in metres.
const LEAST_KERB_M: f64 = 0.4;
/// Nothing stands this near to a corner, in metres.
const CORNER_M: f64 = 4.0;
/// No more trees are tried in one area of a block.
const MOST_TREES: f64 = 50_000.0;

/// Trees and lamps of one block, in order of placing.
pub struct Standing {
    /// What and where.
    pub things: Vec<(Kind, GridPoint)>,
    index: PointIndex,
    min_distance_m: f64,
}

impl Standing {
    /// Nothing yet, but what is there already.
    pub fn new(there: impl IntoIterator<Item = Vec2>, min_distance_m: f64) -> Self {
        let mut index = PointIndex::new(min_distance_m.max(5.0));
        for p in there {
            index.insert(0, p);
        }
        Self { things: Vec::new(), index, min_distance_m }
    }

    fn try_add(&mut self, kind: Kind, p: Vec2, ground: &Ground<'_>, params: &Params) -> bool {
        let at = GridPoint::round(p);
        let by_building = |b: &&Polygon| {
            b.bounds().grown(params.building_distance).contains(p)
                && (b.contains(at) || b.boundary_distance_m(p) < params.building_distance)
        };
        let free = self.index.nearest(p, self.min_distance_m).is_none()
            && !ground.is_at_kerb(p)
            && ground.block.contains(at)
            && !ground.buildings.iter().any(by_building)
            && !(ground.is_taken)(p);
        if free {
            self.index.insert(0, p);
            self.things.push((kind, at));
        }
        free
    }

    /// Walks the pavement all around with steps of `row`'s spacing, a little uneven.
    pub fn along_kerb(
        &mut self,
        kind: Kind,
        row: &Row,
        factor: f64,
        ground: &Ground<'_>,
        params: &Params,
        rng: &mut Rng,
    ) {
        if factor <= 0.0 {
            return;
        }
        let behind = if kind == Kind::Tree { TREE_M } else { LAMP_M };
        let behind = behind.min((ground.pavement_m * 0.75).max(LEAST_KERB_M + 0.01));
        let spacing_m = (row.spacing_m / factor).max(self.min_distance_m);
        for strip in offset::inset(ground.block, behind) {
            for ring in strip.rings() {
                let line = Loop::of(ring);
                let length = line.length_m();
                let mut at = spacing_m * rng.random::<f64>();
                while at < length {
                    let p = line.point_at(at);
                    if !line.turns_near(at) && (ground.street_has)(kind, p) {
                        self.try_add(kind, p, ground, params);
                    }
                    at += spacing_m * rng.random_range(0.8..1.2);
                }
            }
        }
    }

    /// Scatters trees over `area` by number per m² (rejection sampling).
    pub fn scatter(
        &mut self,
        area: &Polygon,
        per_m2: f64,
        ground: &Ground<'_>,
        params: &Params,
        rng: &mut Rng,
    ) {
        // Only where the box of the area and that of the block meet.
        let (area_box, block_box) = (area.bounds(), ground.block.bounds());
        let low = area_box.min.max(block_box.min);
        let size = (area_box.max.min(block_box.max) - low).max(Vec2::ZERO);
        let tries = (size.x * size.y * per_m2).min(MOST_TREES);
        for _ in 0..tries.round() as usize {
            let p = low + size * Vec2::new(rng.random(), rng.random());
            if area.contains(GridPoint::round(p)) {
                self.try_add(Kind::Tree, p, ground, params);
            }
        }
    }
}

/// A closed line with positions along it.
struct Loop {
    points: Vec<Vec2>,
    starts_m: Vec<f64>,
}

impl Loop {
    fn of(ring: &[GridPoint]) -> Self {
        let mut points = polyline::to_m(ring);
        points.extend(points.first().copied());
        let mut at = 0.0;
        let mut starts_m = vec![0.0];
        for w in points.windows(2) {
            at += w[0].distance(w[1]);
            starts_m.push(at);
        }
        Self { points, starts_m }
    }

    fn length_m(&self) -> f64 {
        self.starts_m[self.starts_m.len() - 1]
    }

    fn point_at(&self, at_m: f64) -> Vec2 {
        let at = at_m.rem_euclid(self.length_m());
        let after = self.starts_m.partition_point(|s| *s <= at);
        let i = after.saturating_sub(1).min(self.points.len() - 2);
        let step = self.starts_m[i + 1] - self.starts_m[i];
        let t = if step > 0.0 { (at - self.starts_m[i]) / step } else { 0.0 };
        self.points[i].lerp(self.points[i + 1], t.clamp(0.0, 1.0))
    }

    /// Does it turn a corner within reach of `at_m`?
    fn turns_near(&self, at_m: f64) -> bool {
        let p = self.point_at(at_m);
        let before = p - self.point_at(at_m - CORNER_M);
        let after = self.point_at(at_m + CORNER_M) - p;
        trig::angle_between(before, after) > 0.5
    }
}
