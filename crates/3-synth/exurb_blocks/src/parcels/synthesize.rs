//! The pure core: one block's ground, the lots it should get, chance → parcels.

use exurb_geom::{Polygon, Vec2, offset, polyline, voronoi, voronoi::Site};
use exurb_operation::Rng;
use rand::RngExt;

use super::box_split::{self, Wanted};
use super::owners::Owners;
use super::params::Method;
use super::stretches::{Stretch, stretches};
use super::tiling::Tiling;
use super::{Params, axis_voronoi, skeleton};
use crate::ring::Ring;

/// What is known of the lots of one block.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Frontages in the order of the example's kerb, in metres; not empty, all positive.
    pub frontages_m: Vec<f64>,
    /// Usual depth in metres.
    pub depth_m: f64,
    /// Share of the kerb to be fronted on; the rest stays one piece of land. In `0..=1`.
    pub fronted_share: f64,
}

/// A lot.
#[derive(Clone, Debug, PartialEq)]
pub struct Lot {
    /// Its outline.
    pub polygon: Polygon,
    /// Length of its border with the street side in metres.
    pub frontage_m: f64,
    /// Land that was left over by the rows: nobody builds on it.
    pub is_rest: bool,
}

/// Owner of the land that no row takes.
const REST: u32 = u32::MAX;
/// Owner of the land behind the rows; it falls to the lots around.
const COURT: u32 = u32::MAX - 1;
/// Land deeper than this many lot depths behind the kerb is not drawn into the rows.
const ROW_DEPTHS: f64 = 1.6;
/// A block this many lot depths wide has land behind its rows.
const COURT_DEPTHS: f64 = 4.4;
/// Under this share of fronted kerb, rows are islands in open land.
const PARTLY_FRONTED: f64 = 0.6;
/// Sites along the kerb stand this far apart at most, in metres.
const STEP_M: f64 = 4.0;
/// Borders are straightened by this much, in metres.
const TOLERANCE_M: f64 = 0.25;

/// Cuts `ground`, a block less its pavement, into lots that tile it. O(n²) in the vertices of one
/// block.
pub fn synthesize(ground: &Polygon, input: &Input, params: &Params, rng: &mut Rng) -> Vec<Lot> {
    let depth_m = input.depth_m * params.depth_factor;
    let mut next_m = frontages(input, params, rng.random());
    let area = ground.area_m2();
    let mean_m = mean(&input.frontages_m) * params.frontage_factor;
    let partly = input.fronted_share < PARTLY_FRONTED;
    let count = axis_voronoi::count(area, mean_m * depth_m);
    let whole = || {
        let frontage_m = ground.perimeter_m();
        vec![Lot { polygon: ground.clone(), frontage_m, is_rest: false }]
    };
    if count < 2 && !partly {
        return whole();
    }
    match params.method {
        Method::Box if !partly => return by_boxes(ground, input, params, rng),
        Method::Skeleton if !partly => {
            if let Some(lots) = by_skeleton(ground, input, params, &mut next_m) {
                return lots;
            }
        }
        _ => {}
    }
    let mut lines = Vec::new();
    let mut court: Vec<Polygon> = Vec::new();
    let mut resting: Vec<u32> = Vec::new();
    let axis = axis_voronoi::suits(ground, depth_m).filter(|_| !partly);
    let sites = if let Some(frame) = axis {
        let rows = axis_voronoi::rows(&frame, depth_m);
        let by_frontage = rows as f64 * frame.long_m() / mean_m;
        let count = (count as f64).clamp(by_frontage / 1.5, by_frontage * 1.5).round();
        axis_voronoi::sites(&frame, rows.min(count as usize), count as usize, next_m)
    } else {
        let rings: Vec<Ring> = ground.rings().map(Ring::of).collect();
        let rows: Vec<Vec<Stretch>> = rings
            .iter()
            .map(|ring| stretches(ring, depth_m, params.min_frontage, &mut next_m))
            .collect();
        let fronts = rows.iter().map(Vec::len).sum::<usize>() as u32;
        if partly {
            resting = resting_labels(fronts, input.fronted_share, rng);
        }
        if partly || ground.mean_width_m() * 2.0 > COURT_DEPTHS * depth_m {
            court = offset::inset(ground, depth_m * if partly { 1.0 } else { ROW_DEPTHS });
        }
        kerb_sites(&rings, &rows)
    };
    if sites.is_empty() {
        return whole();
    }
    let behind = if partly { REST } else { COURT };
    lines.extend(voronoi::borders(&sites, ground.bounds().grown(5.0)));
    for line in &mut lines {
        *line = polyline::simplify(line, TOLERANCE_M);
    }
    lines.extend(court.iter().flat_map(outlines));
    let owners = Owners::of(&sites);
    let owner = |p: Vec2| {
        if court.iter().any(|c| c.contains(exurb_geom::GridPoint::round(p))) {
            return behind;
        }
        let label = owners.at(p);
        if resting.binary_search(&label).is_ok() { REST } else { label }
    };
    lots(Tiling::of(ground, &lines, owner), mean_m * depth_m, params)
}

/// The pieces of a tiling as lots; those without frontage, and slivers, join a neighbour.
fn lots(mut tiling: Tiling, usual_m2: f64, params: &Params) -> Vec<Lot> {
    let least_m2 = params.min_area.min(usual_m2 * 0.25);
    tiling.join(|piece| piece.frontage_m < params.min_frontage || piece.area_m2 < least_m2);
    tiling
        .polygons()
        .into_iter()
        .map(|(polygon, piece)| Lot {
            polygon,
            frontage_m: piece.frontage_m,
            is_rest: piece.owner == REST,
        })
        .collect()
}

/// Vanegas' box method, with sizes learned from the example's lots.
fn by_boxes(ground: &Polygon, input: &Input, params: &Params, rng: &mut Rng) -> Vec<Lot> {
    let mut widths: Vec<f64> =
        input.frontages_m.iter().map(|w| w * params.frontage_factor).collect();
    widths.sort_by(f64::total_cmp);
    let depth_m = input.depth_m * params.depth_factor;
    let at = |share: f64| widths[((widths.len() - 1) as f64 * share).round() as usize];
    let width_m = ((at(0.1) * 0.7).max(params.min_frontage), at(0.9) * 1.3);
    let usual_m2 = mean(&widths) * depth_m;
    let wanted = Wanted {
        // Halving brings areas between half of the most and the most.
        area_m2: (usual_m2 * 0.35, usual_m2 * 1.4),
        width_m,
        irregularity: params.irregularity,
        access: params.access,
    };
    let lines = box_split::cuts(ground, &wanted, rng);
    let next = std::cell::Cell::new(0);
    let owner = |_| {
        next.set(next.get() + 1);
        next.get()
    };
    lots(Tiling::of(ground, &lines, owner), usual_m2, params)
}

/// Vanegas' skeleton method; `None` where the block has no skeleton.
fn by_skeleton(
    ground: &Polygon,
    input: &Input,
    params: &Params,
    next_m: impl FnMut() -> f64,
) -> Option<Vec<Lot>> {
    let depth_m = input.depth_m * params.depth_factor;
    let has_court = ground.mean_width_m() * 2.0 > COURT_DEPTHS * depth_m;
    let reach_m = if has_court { depth_m * ROW_DEPTHS } else { f64::MAX.sqrt() };
    let strips = skeleton::strips(ground, reach_m.min(ground.perimeter_m()), next_m)?;
    let mut lines = strips.lines.clone();
    if has_court {
        lines.extend(offset::inset(ground, reach_m).iter().flat_map(outlines));
    }
    let tiling = Tiling::of(ground, &lines, |p| strips.owner(p));
    Some(lots(tiling, mean(&input.frontages_m) * params.frontage_factor * depth_m, params))
}

/// The example's frontages in their order, from a place drawn by `start`, over and over.
fn frontages<'a>(input: &'a Input, params: &Params, start: u32) -> impl FnMut() -> f64 + use<'a> {
    let factor = params.frontage_factor;
    let start = start as usize % input.frontages_m.len().max(1);
    let mut widths = input.frontages_m.iter().cycle().skip(start);
    move || widths.next().map_or(20.0, |w| w * factor)
}

/// Labels that stay unbuilt: all but one run of neighbours.
fn resting_labels(fronts: u32, fronted_share: f64, rng: &mut Rng) -> Vec<u32> {
    let built = ((f64::from(fronts) * fronted_share).round() as u32).clamp(1, fronts.max(1));
    let start = rng.random_range(0..fronts.max(1));
    let mut out: Vec<u32> = (built..fronts).map(|i| (start + i) % fronts).collect();
    out.sort_unstable();
    out
}

/// Sites along the kerb, close to the ends of each stretch and in between, labelled by stretch.
fn kerb_sites(rings: &[Ring], rows: &[Vec<Stretch>]) -> Vec<Site> {
    let mut out = Vec::new();
    let mut label = 0;
    for (ring, row) in rings.iter().zip(rows) {
        for stretch in row {
            let length = stretch.end_m - stretch.start_m;
            let end = (length / 4.0).min(1.0);
            let steps = ((length - 2.0 * end) / STEP_M).ceil().max(1.0);
            for k in 0..=steps as u32 {
                let t = f64::from(k) / steps;
                let at = stretch.start_m + end + (length - 2.0 * end) * t;
                out.push(Site { at: ring.point_at(at), label });
            }
            label += 1;
        }
    }
    out
}

fn outlines(polygon: &Polygon) -> Vec<Vec<Vec2>> {
    polygon
        .rings()
        .map(|ring| {
            let mut line = polyline::to_m(ring);
            line.extend(line.first().copied());
            line
        })
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
