//! Parcels: size, frontage, access, and how they are built on.
//!
//! A parcel fronts the street where no other parcel lies 1 m outside its boundary: along the edge of
//! the ground that the parcels of its block take up together, whether they tile it up to the pavement
//! or, as in a cadastre, up to wherever property ends. Its front is that of its longer direction; a
//! corner parcel has two. O(n log n), on rayon's current pool.

use std::collections::BTreeMap;

use exurb_city::{BlockClass, City, Parcel};
use exurb_geom::{Bounds, BoxGrid, GridPoint, OrientedBox, Polygon, Vec2, overlay, polyline};
use rayon::prelude::*;

use crate::Sample;

/// Boundary with no other parcel this far outside is frontage, in metres.
const FRONT_M: f64 = 1.0;
/// Frontage is looked for in pieces of this many metres.
const STEP_M: f64 = 0.5;
/// A corner parcel fronts two directions that differ by more than this, in radians.
const CORNER_RAD: f64 = 45.0 * std::f64::consts::PI / 180.0;
/// Fronts shorter than this give no access, in metres.
const ACCESS_M: f64 = 3.0;

/// Parcels of a window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parcels {
    /// Area in m².
    pub area: Sample,
    /// Length of the front in metres.
    pub frontage: Sample,
    /// Depth, the extent across the front, over width, the extent along it.
    pub depth_ratio: Sample,
    /// Area over that of the smallest enclosing rectangle.
    pub rectangularity: Sample,
    /// Share that front two directions.
    pub corner_share: Option<f64>,
    /// Share with at least 3 m of frontage.
    pub access_share: Option<f64>,
    /// Share of its block's ground that parcels cover, one value a block with parcels.
    pub coverage: Sample,
    /// Buildings on a parcel.
    pub buildings: Sample,
    /// Share of the footprint area that lies outside its own parcel.
    pub outside_share: Option<f64>,
    /// Distance from the parcel's front to its nearest building, in metres.
    pub front_setback: Sample,
}

/// Measures the parcels whose centroid lies in the window.
pub fn parcels(city: &City, window: Bounds) -> Parcels {
    let inside = |p: &&Parcel| window.contains(p.polygon.centroid());
    let own: Vec<&Parcel> = city.parcels.iter().filter(inside).collect();
    let boxes = BoxGrid::of(city.parcels.iter().map(|p| &p.polygon));
    let fronts: Vec<Front> = own.par_iter().map(|p| Front::of(p, city, &boxes)).collect();
    let buildings = by_parcel(city);
    let count = |p: &Parcel| buildings.get(&p.id).map_or(0, Vec::len) as f64;
    let share = |number: usize| (!own.is_empty()).then(|| number as f64 / own.len() as f64);
    let rectangle =
        |p: &&Parcel| Some(p.polygon.area_m2() / OrientedBox::of(p.polygon.exterior())?.area_m2());
    let setback = |(front, parcel): (&Front, &&Parcel)| front.setback(parcel, city, &buildings);
    Parcels {
        area: Sample::plain(own.iter().map(|p| p.polygon.area_m2())),
        frontage: Sample::plain(fronts.iter().map(|f| f.length_m).filter(|m| *m > 0.0)),
        depth_ratio: Sample::plain(
            fronts.iter().zip(&own).filter_map(|(front, p)| front.depth_ratio(&p.polygon)),
        ),
        rectangularity: Sample::plain(own.iter().filter_map(rectangle)),
        corner_share: share(fronts.iter().filter(|f| f.is_corner()).count()),
        access_share: share(fronts.iter().filter(|f| f.total_m >= ACCESS_M).count()),
        coverage: coverage(city, &own),
        buildings: Sample::plain(own.iter().map(|p| count(p))),
        outside_share: outside_share(city, &own, &buildings),
        front_setback: Sample::plain(fronts.iter().zip(&own).filter_map(setback)),
    }
}

/// Indices of buildings, without parts, by parcel.
fn by_parcel(city: &City) -> BTreeMap<u32, Vec<usize>> {
    let mut out: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, building) in city.buildings.iter().enumerate() {
        if building.parcel != 0 && !building.is_part {
            out.entry(building.parcel).or_default().push(i);
        }
    }
    out
}

/// The side of a parcel along the street.
struct Front {
    /// Pieces of boundary of the longer direction, each short.
    pieces: Vec<(Vec2, Vec2)>,
    /// Their length, that of the other direction, and both together, in metres.
    length_m: f64,
    turned_m: f64,
    total_m: f64,
}

impl Front {
    fn of(parcel: &Parcel, city: &City, boxes: &BoxGrid) -> Self {
        let mut near = Vec::new();
        let mut is_front = |(a, b): (Vec2, Vec2)| {
            let outwards = -(b - a).perp().normalize_or_zero() * FRONT_M;
            let beside = GridPoint::round((a + b) / 2.0 + outwards);
            boxes.meeting(beside, beside, &mut near);
            !near.iter().any(|i| city.parcels[*i as usize].polygon.contains(beside))
        };
        let mut pieces = Vec::new();
        for (a, b) in parcel.polygon.segments() {
            let points = polyline::resample(&[a.to_m(), b.to_m()], STEP_M);
            pieces.extend(points.windows(2).map(|w| (w[0], w[1])).filter(|piece| is_front(*piece)));
        }
        let length = |pieces: &[(Vec2, Vec2)]| pieces.iter().map(|(a, b)| a.distance(*b)).sum();
        let first = pieces.first().copied();
        let along = |piece: &(Vec2, Vec2)| first.is_some_and(|first| !is_turned(first, *piece));
        let (one, other): (Vec<_>, Vec<_>) = pieces.into_iter().partition(along);
        let (one_m, other_m): (f64, f64) = (length(&one), length(&other));
        let (pieces, length_m, turned_m) =
            if one_m >= other_m { (one, one_m, other_m) } else { (other, other_m, one_m) };
        Self { pieces, length_m, turned_m, total_m: length_m + turned_m }
    }

    /// Mean direction of the front as a unit vector, both ways alike.
    fn direction(&self) -> Option<Vec2> {
        // Doubled angles, so that opposite directions add up.
        let doubled = self.pieces.iter().map(|(a, b)| {
            let d = *b - *a;
            Vec2::new(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y) / d.length().max(1e-9)
        });
        let sum: Vec2 = doubled.sum();
        let angle = exurb_geom::trig::angle(sum) / 2.0;
        (sum.length() > 0.0).then(|| exurb_geom::trig::unit(angle))
    }

    /// Does it run in two directions?
    fn is_corner(&self) -> bool {
        self.length_m >= ACCESS_M && self.turned_m >= ACCESS_M
    }

    fn depth_ratio(&self, polygon: &Polygon) -> Option<f64> {
        let along = self.direction()?;
        let extent = |axis: Vec2| {
            let at = polygon.exterior().iter().map(|p| p.to_m().dot(axis));
            let (lo, hi) =
                at.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
            hi - lo
        };
        Some(extent(along.perp()) / extent(along))
    }

    fn setback(
        &self,
        parcel: &Parcel,
        city: &City,
        buildings: &BTreeMap<u32, Vec<usize>>,
    ) -> Option<f64> {
        let own = buildings.get(&parcel.id)?;
        let walls = own.iter().flat_map(|i| city.buildings[*i].polygon.segments());
        let walls: Vec<(Vec2, Vec2)> = walls.map(|(a, b)| (a.to_m(), b.to_m())).collect();
        let distance = |(a, b): &(Vec2, Vec2)| {
            let to = |(c, d): &(Vec2, Vec2)| polyline::segment_distance(*a, *b, *c, *d);
            walls.iter().map(to).fold(f64::INFINITY, f64::min)
        };
        let least = self.pieces.iter().map(distance).fold(f64::INFINITY, f64::min);
        least.is_finite().then_some(least)
    }
}

/// Do two pieces run in different directions?
fn is_turned((a, b): (Vec2, Vec2), (c, d): (Vec2, Vec2)) -> bool {
    let angle = exurb_geom::trig::angle_between(b - a, d - c);
    angle.min(std::f64::consts::PI - angle) > CORNER_RAD
}

/// Of every block with parcels: area of its parcels by area of its ground.
fn coverage(city: &City, own: &[&Parcel]) -> Sample {
    let mut area_m2: BTreeMap<u32, f64> = BTreeMap::new();
    for parcel in own {
        *area_m2.entry(parcel.block).or_default() += parcel.polygon.area_m2();
    }
    Sample::plain(area_m2.into_iter().filter_map(|(block, covered_m2)| {
        let block = city.blocks.get(block.checked_sub(1)? as usize)?;
        let ground_m2: f64 = block.buildable().iter().map(Polygon::area_m2).sum();
        (block.class == BlockClass::Block && ground_m2 > 0.0).then(|| covered_m2 / ground_m2)
    }))
}

fn outside_share(
    city: &City,
    own: &[&Parcel],
    buildings: &BTreeMap<u32, Vec<usize>>,
) -> Option<f64> {
    let areas: Vec<(f64, f64)> = own
        .par_iter()
        .flat_map_iter(|parcel| {
            buildings.get(&parcel.id).into_iter().flatten().map(move |i| (parcel, i))
        })
        .map(|(parcel, i)| {
            let footprint = &city.buildings[*i].polygon;
            let inside = overlay::intersection(footprint, &parcel.polygon);
            let inside_m2: f64 = inside.iter().map(Polygon::area_m2).sum();
            (footprint.area_m2(), (footprint.area_m2() - inside_m2).max(0.0))
        })
        .collect();
    let (all_m2, outside_m2) = areas.iter().fold((0.0, 0.0), |(a, o), (x, y)| (a + x, o + y));
    (all_m2 > 0.0).then(|| outside_m2 / all_m2)
}
