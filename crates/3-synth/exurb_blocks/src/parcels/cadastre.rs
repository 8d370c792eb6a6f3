//! Parcels around buildings that stand: a cadastre as the Voronoi diagram of the footprints.
//!
//! Source: Hartmann 2018, section 5.1.9, which names the way. Every point of the block's ground belongs to
//! the nearest footprint; sites stand along the walls, close enough that their cells' borders lie midway
//! between buildings, and the ground under a building is its own, exactly. Garages and sheds share the
//! parcel of the house they belong to. A parcel without street frontage is joined to the neighbour with
//! which it shares most. O(n log n) in the walls of a block.

use exurb_geom::{BoxGrid, GridPoint, Polygon, Vec2, polyline, voronoi, voronoi::Site};

use super::Lot;
use super::owners::Owners;
use super::tiling::Tiling;
use crate::library::median;

/// Sites along walls stand this far apart at most, in metres.
const STEP_M: f64 = 2.5;
/// Sites stand this far inside the walls, in metres: neighbours share walls.
const INSIDE_M: f64 = 0.15;
/// Borders are straightened by this much, in metres.
const TOLERANCE_M: f64 = 0.3;
/// Buildings under this share of the usual footprint, and under the second figure in m², are annexes.
const ANNEX: (f64, f64) = (0.45, 60.0);
/// An annex belongs to a house no farther than this, in metres.
const ANNEX_M: f64 = 25.0;
/// Lots with less frontage are joined to a neighbour, in metres.
const LEAST_FRONTAGE_M: f64 = 3.0;
/// So are lots smaller than this, in m².
const LEAST_M2: f64 = 10.0;

/// A lot and the buildings that stand on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Holding {
    /// The lot.
    pub lot: Lot,
    /// Indices of its buildings.
    pub footprints: Vec<usize>,
}

/// Cuts `ground` into lots around `footprints`, which lie in it, apart from each other. They tile it. One
/// lot where there are fewer than two buildings.
pub fn cadastre(ground: &Polygon, footprints: &[&Polygon]) -> Vec<Holding> {
    let labels = labels(footprints);
    let houses = labels.iter().collect::<std::collections::BTreeSet<_>>().len();
    if houses < 2 {
        let lot = Lot { polygon: ground.clone(), frontage_m: ground.perimeter_m(), is_rest: false };
        return vec![Holding { lot, footprints: (0..footprints.len()).collect() }];
    }
    let mut sites = Vec::new();
    for (polygon, label) in footprints.iter().zip(&labels) {
        walls(polygon, *label, &mut sites);
    }
    let mut lines = voronoi::borders(&sites, ground.bounds().grown(5.0));
    for line in &mut lines {
        *line = polyline::simplify(line, TOLERANCE_M);
    }
    let closed = |ring: &[GridPoint]| {
        let mut line = polyline::to_m(ring);
        line.extend(line.first().copied());
        line
    };
    lines.extend(footprints.iter().map(|p| closed(p.exterior())));
    let owners = Owners::of(&sites);
    let boxes = BoxGrid::of(footprints.iter().copied());
    let under = |p: GridPoint| {
        let mut near = Vec::new();
        boxes.meeting(p, p, &mut near);
        near.into_iter().find(|i| footprints[*i as usize].contains(p))
    };
    let owner = |p: Vec2| match under(GridPoint::round(p)) {
        Some(i) => labels[i as usize],
        None => owners.at(p),
    };
    let mut tiling = Tiling::of(ground, &lines, owner);
    tiling.join(|piece| piece.frontage_m < LEAST_FRONTAGE_M || piece.area_m2 < LEAST_M2);
    let mut out: Vec<Holding> = tiling
        .polygons()
        .into_iter()
        .map(|(polygon, piece)| Holding {
            lot: Lot { polygon, frontage_m: piece.frontage_m, is_rest: false },
            footprints: Vec::new(),
        })
        .collect();
    let boxes = BoxGrid::of(out.iter().map(|h| &h.lot.polygon));
    let mut near = Vec::new();
    for (i, footprint) in footprints.iter().enumerate() {
        let p = GridPoint::round(footprint.interior_point());
        boxes.meeting(p, p, &mut near);
        let home = near.iter().map(|k| *k as usize).find(|k| out[*k].lot.polygon.contains(p));
        if let Some(home) = home {
            out[home].footprints.push(i);
        }
    }
    out
}

/// The number of the house each building belongs to: its own, but for annexes.
fn labels(footprints: &[&Polygon]) -> Vec<u32> {
    let usual = median(footprints.iter().map(|p| p.area_m2()));
    let is_annex = |i: usize| {
        let area = footprints[i].area_m2();
        area < ANNEX.0 * usual && area < ANNEX.1
    };
    let houses: Vec<usize> = (0..footprints.len()).filter(|i| !is_annex(*i)).collect();
    let middles: Vec<Vec2> = footprints.iter().map(|p| p.interior_point()).collect();
    (0..footprints.len())
        .map(|i| {
            if !is_annex(i) {
                return i as u32;
            }
            let gap = |h: &usize| footprints[*h].boundary_distance_m(middles[i]);
            let near = houses
                .iter()
                .filter(|h| footprints[**h].bounds().grown(ANNEX_M).contains(middles[i]));
            let nearest = near.map(|h| (gap(h), *h)).min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.filter(|n| n.0 <= ANNEX_M).map_or(i, |n| n.1) as u32
        })
        .collect()
}

/// Sites along the outer walls of a building.
fn walls(polygon: &Polygon, label: u32, out: &mut Vec<Site>) {
    let ring = polygon.exterior();
    for (i, a) in ring.iter().enumerate() {
        let (a, b) = (a.to_m(), ring[(i + 1) % ring.len()].to_m());
        let along = b - a;
        let length = along.length();
        let inward = along.perp().normalize_or_zero() * INSIDE_M.min(length / 4.0);
        let steps = (length / STEP_M).ceil().max(1.0);
        for k in 0..steps as u32 {
            // Not at the corners, which two walls share.
            let t = (f64::from(k) + 0.5) / steps;
            out.push(Site { at: a + along * t + inward, label });
        }
    }
}
