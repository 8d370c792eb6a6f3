//! The pure core: one block's kerb and open ground → trees and lamps.

use exurb_geom::{GridPoint, PointIndex, Polygon, Vec2, offset, polyline, trig};
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
    /// Width of its pavement in metres.
    pub pavement_m: f64,
    /// Buildings nearby.
    pub buildings: Vec<&'a Polygon>,
    /// May a thing of that kind stand at the kerb here?
    pub street_has: &'a dyn Fn(Kind, Vec2) -> bool,
    /// Is the place kept free: water, under a bridge?
    pub is_taken: &'a dyn Fn(Vec2) -> bool,
}

/// Trees stand this far behind the kerb, lamps somewhat more, in metres.
const TREE_M: f64 = 1.0;
const LAMP_M: f64 = 1.5;
/// Nothing stands nearer to the kerb, in metres.
const LEAST_KERB_M: f64 = 0.4;
/// Nothing stands this near to a corner, in metres.
const CORNER_M: f64 = 4.0;
/// A block gets no more park trees than this.
const MOST_TREES: f64 = 20_000.0;

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
            && ground.block.contains(at)
            && ground.block.boundary_distance_m(p) >= LEAST_KERB_M
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
                let mut line = polyline::to_m(ring);
                line.extend(line.first().copied());
                let length = polyline::length(&line);
                let mut at = spacing_m * rng.random::<f64>();
                while at < length {
                    let p = polyline::point_at(&line, at);
                    if !near_corner(&line, at, length) && (ground.street_has)(kind, p) {
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
        let bounds = area.bounds();
        let wanted = (area.area_m2() * per_m2).min(MOST_TREES);
        // The box holds more ground than the area: as many tries as give the density.
        let tries = wanted * bounds.size().x * bounds.size().y / area.area_m2().max(1.0);
        for _ in 0..tries.min(MOST_TREES * 10.0).round() as usize {
            let t = Vec2::new(rng.random(), rng.random());
            let p = bounds.min + bounds.size() * t;
            if area.contains(GridPoint::round(p)) {
                self.try_add(Kind::Tree, p, ground, params);
            }
        }
    }
}

/// Does the line turn a corner within reach of `at_m`?
fn near_corner(line: &[Vec2], at_m: f64, length_m: f64) -> bool {
    let point = |s: f64| polyline::point_at(line, s.rem_euclid(length_m));
    let p = point(at_m);
    let (before, after) = (p - point(at_m - CORNER_M), point(at_m + CORNER_M) - p);
    trig::angle_between(before, after) > 0.5
}
