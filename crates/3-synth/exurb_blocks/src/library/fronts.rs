//! Buildings and lots of an example, block by block, seen from the kerb they lie on.

use std::collections::BTreeMap;

use exurb_city::{Block, City};
use exurb_geom::{BoxGrid, GridPoint, Polygon, Vec2, polygon::signed_area_m2, polyline, trig};

use crate::kerb::Kerb;

/// Footprints under this area are sheds, not buildings, in m².
const LEAST_BUILDING_M2: f64 = 15.0;

/// Buildings farther from the kerb face no street, in metres.
const FACING_M: f64 = 60.0;

/// What lies in each block of a city, as indices into the city's lists.
pub struct Contents {
    pub of_block: Vec<BlockContents>,
}

#[derive(Clone, Debug, Default)]
pub struct BlockContents {
    pub buildings: Vec<u32>,
    pub parcels: Vec<u32>,
}

impl Contents {
    /// Puts every building and parcel into its block: by its block's number where the city tells
    /// it, else by a point well inside it.
    pub fn of(city: &City, blocks: &[Block]) -> Self {
        let boxes = BoxGrid::of(blocks.iter().map(|b| &b.polygon));
        let mut near = Vec::new();
        let number: BTreeMap<u32, usize> =
            blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
        let told = !city.blocks.is_empty();
        let mut holder = |polygon: &Polygon, block: u32| {
            if told && block != 0 {
                return number.get(&block).copied();
            }
            let p = GridPoint::round(polygon.interior_point());
            boxes.meeting(p, p, &mut near);
            near.iter().map(|n| *n as usize).find(|n| blocks[*n].polygon.contains(p))
        };
        let mut of_block = vec![BlockContents::default(); blocks.len()];
        for (i, building) in city.buildings.iter().enumerate() {
            if building.is_part || building.polygon.area_m2() < LEAST_BUILDING_M2 {
                continue;
            }
            if let Some(home) = holder(&building.polygon, building.block) {
                of_block[home].buildings.push(i as u32);
            }
        }
        for (i, parcel) in city.parcels.iter().enumerate() {
            if let Some(home) = holder(&parcel.polygon, parcel.block) {
                of_block[home].parcels.push(i as u32);
            }
        }
        Self { of_block }
    }
}

/// An outline seen from the kerb: x along the street with the block to the left, y into the block.
#[derive(Clone, Debug)]
pub struct Front {
    /// Index of the ring of the block's outline.
    pub ring: usize,
    /// Position of its middle along the ring.
    pub at_m: f64,
    /// Least distance to the kerb.
    pub setback_m: f64,
    /// Angle from the street to the outline's own direction, within ±45°.
    pub turn_rad: f64,
    /// Extent along the street and into the block.
    pub size_m: Vec2,
    /// The outline's rings from its corner nearest to the street's start; the outer one first.
    pub outline: Vec<Vec<Vec2>>,
}

impl Front {
    /// `polygon` as seen from the nearest kerb.
    pub fn of(polygon: &Polygon, kerb: &Kerb) -> Self {
        let corners = polyline::to_m(polygon.exterior());
        let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
        // The front is the edge whose middle is nearest: a corner alone tells no direction.
        let mut best = kerb.nearest(polygon.centroid());
        let reach = polygon.bounds().size().length() / 2.0;
        let mut setback_m = (best.1.distance_m - reach).max(0.0);
        // Far from any street it faces none.
        if setback_m < FACING_M {
            for (a, b) in edges().filter(|(a, b)| a.distance(*b) > 1.5) {
                let found = kerb.nearest((a + b) / 2.0);
                if found.1.distance_m < best.1.distance_m {
                    best = found;
                }
            }
            let distances = corners.iter().map(|p| kerb.nearest(*p).1.distance_m);
            setback_m = distances.fold(best.1.distance_m, f64::min);
        }
        let (ring, place) = best;
        let turn_rad = folded_turn(place.direction, main_direction(edges()));
        let along = trig::rotate(place.direction, turn_rad);
        let local = |p: Vec2| Vec2::new(p.dot(along), p.dot(along.perp()));
        let (low, high) = corners
            .iter()
            .map(|p| local(*p))
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let ring_of = |points: &[GridPoint]| -> Vec<Vec2> {
            points.iter().map(|p| local(p.to_m()) - low).collect()
        };
        let yards = polygon.interiors().iter().filter(|hole| -signed_area_m2(hole) > 9.0);
        let outline = std::iter::once(ring_of(polygon.exterior()))
            .chain(yards.map(|hole| ring_of(hole)))
            .collect();
        let middle = (low + high) / 2.0;
        let middle = along * middle.x + along.perp() * middle.y;
        let (on, there) = kerb.nearest(middle);
        let at_m = if on == ring { there.at_m } else { place.at_m };
        Self { ring, at_m, setback_m, turn_rad, size_m: high - low, outline }
    }

    /// Does `other` stand between it and the kerb?
    pub fn is_behind(&self, other: &Self) -> bool {
        let ((start, end), (from, to)) = (self.span(), other.span());
        let shared = (end.min(to) - start.max(from)) / (end - start).max(0.1);
        other.ring == self.ring
            && shared > 0.5
            && other.setback_m + other.size_m.y * 0.5 < self.setback_m
    }

    /// Stretch of the ring it covers.
    pub fn span(&self) -> (f64, f64) {
        (self.at_m - self.size_m.x / 2.0, self.at_m + self.size_m.x / 2.0)
    }
}

/// The direction that most of an outline runs in, of the four a right angle apart, as an angle.
pub fn main_direction(edges: impl Iterator<Item = (Vec2, Vec2)>) -> f64 {
    let mut sum = Vec2::ZERO;
    for (a, b) in edges {
        let length = a.distance(b);
        let unit = (b - a).normalize_or_zero();
        // The fourth power of a unit complex number has four times its angle.
        let square = unit.rotate(unit);
        sum += square.rotate(square) * length;
    }
    trig::angle(sum) / 4.0
}

/// The turn from `street` to the nearest of the four directions at `angle_rad`, within ±45°.
fn folded_turn(street: Vec2, angle_rad: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    let turn = angle_rad - trig::angle(street);
    turn - (turn / quarter).round() * quarter
}

/// Are the outlines nearer than `within_m`?
pub fn are_near(a: &Polygon, b: &Polygon, within_m: f64) -> bool {
    a.bounds().grown(within_m).intersects(b.bounds()) && gap_m(a, b) < within_m
}

/// Least distance between two outlines in metres; 0 when they touch or overlap.
fn gap_m(a: &Polygon, b: &Polygon) -> f64 {
    let between = |p: &Polygon, q: &Polygon| {
        let corners = p
            .exterior()
            .iter()
            .map(|c| if q.contains(*c) { 0.0 } else { q.boundary_distance_m(c.to_m()) });
        corners.fold(f64::INFINITY, f64::min)
    };
    between(a, b).min(between(b, a))
}
