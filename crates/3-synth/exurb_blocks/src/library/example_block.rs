use std::sync::Arc;

use exurb_city::{Block, BlockClass, City};
use exurb_geom::{Polygon, Vec2, overlay, polyline};

use super::fronts::{BlockContents, Front, are_near};
use super::{BuildingSample, Features, OpenLand};
use crate::kerb::Kerb;

/// A block of an example and all it teaches.
#[derive(Clone, Debug)]
pub struct ExampleBlock {
    /// Name of its example.
    pub source: Arc<str>,
    /// Its number in the example.
    pub id: u32,
    /// Weight of its example.
    pub weight: f64,
    /// What it is compared by.
    pub features: Features,
    /// Class of open land, where that takes most of the block.
    pub open: Option<Arc<str>>,
    /// Frontages of its lots in order along the kerb, in metres; empty where nothing is known.
    pub frontages_m: Vec<f64>,
    /// Usual depth of its lots in metres; 0 where nothing is known.
    pub depth_m: f64,
    /// Share of the kerb that lots front on, corners' flanks left out.
    pub fronted_share: f64,
    /// Share of lots without a building; `None` where the example's buildings are not complete.
    pub empty_share: Option<f64>,
    /// Footprints by area of the block.
    pub coverage: f64,
    /// Usual distance of its buildings from the kerb in metres; `None` with fewer than three.
    pub setback_m: Option<f64>,
    /// Buildings along its streets, in order along the kerb.
    pub buildings: Vec<BuildingSample>,
}

/// Blocks under this area teach nothing, in m².
const LEAST_BLOCK_M2: f64 = 100.0;
/// From this share of open land on, a block with next to no building is open.
pub const OPEN_SHARE: f64 = 0.5;
/// Coverage up to which a block of open land stays open: a park may hold a pavilion.
pub const OPEN_COVERAGE: f64 = 0.06;
/// Blocks covered more than this are built on all sides: one house may line several.
const SPARSE_COVERAGE: f64 = 0.12;
/// Buildings under this share of the block's usual footprint are garages and sheds.
const ANNEX_SHARE: f64 = 0.4;
/// Walls nearer than this are one, in metres.
const SHARED_WALL_M: f64 = 0.4;
/// Annexes nearer than this are built onto their house, in metres.
const TOUCHING_M: f64 = 0.05;
/// A building is compared with so many on either side.
const NEIGHBOURS: usize = 2;
/// Depth of lots, in metres, at least and at most.
const DEPTHS_M: (f64, f64) = (8.0, 150.0);
/// Outlines are simplified by this much, in metres.
const OUTLINE_TOLERANCE_M: f64 = 0.4;
/// Outlines with more corners than this are simplified further.
const MOST_CORNERS: usize = 24;

/// What `block` teaches; `None` for islands and slivers.
pub fn measure(
    city: &City,
    block: &Block,
    contents: &BlockContents,
    features: Features,
    open: &OpenLand,
    weight: f64,
) -> Option<ExampleBlock> {
    let area = block.polygon.area_m2();
    if block.class == BlockClass::Island || area < LEAST_BLOCK_M2 {
        return None;
    }
    let footprints = contents.buildings.iter().map(|i| &city.buildings[*i as usize].polygon);
    let coverage = footprints.map(|p| p.area_m2()).sum::<f64>() / area;
    let open = open
        .share(&block.polygon)
        .filter(|(_, share)| *share >= OPEN_SHARE && coverage <= OPEN_COVERAGE)
        .map(|(class, _)| class);
    let kerb = Kerb::of(&block.polygon);
    let fronts = row_of_fronts(city, contents, &kerb);
    let mut buildings = samples(&fronts, &kerb);
    let mut out = ExampleBlock {
        source: city.metadata.name.clone(),
        id: block.id,
        weight,
        features,
        open,
        frontages_m: buildings.iter().map(|b| b.frontage_m).collect(),
        depth_m: 0.0,
        fronted_share: 0.0,
        empty_share: None,
        coverage,
        setback_m: (buildings.len() >= 3).then(|| median(buildings.iter().map(|b| b.setback_m))),
        buildings: Vec::new(),
    };
    let lots = lots(city, contents, &kerb);
    if lots.len() >= 2 {
        out.frontages_m = lots.iter().map(|lot| lot.0).collect();
        out.depth_m = median(lots.iter().map(|lot| lot.1)).clamp(DEPTHS_M.0, DEPTHS_M.1);
        out.fronted_share = 1.0;
        let built = contents.buildings.len().min(lots.len()) as f64;
        out.empty_share = Some(1.0 - built / lots.len() as f64);
    } else if !buildings.is_empty() {
        measure_frontage(&mut out, &buildings, &kerb, area);
        out.empty_share = Some(0.0);
    } else {
        out.empty_share = Some(1.0);
    }
    if !city.metadata.buildings_complete {
        out.empty_share = None;
    }
    buildings.iter_mut().for_each(simplify);
    out.buildings = buildings;
    Some(out)
}

/// Depth and share of frontage, from buildings alone: what is fronted times the depth is the block,
/// unless houses line a small part of it only.
fn measure_frontage(
    out: &mut ExampleBlock,
    buildings: &[BuildingSample],
    kerb: &Kerb,
    area_m2: f64,
) {
    let fronted: f64 = out.frontages_m.iter().sum();
    let depth = area_m2 / fronted.max(1.0);
    let flanks: f64 = kerb
        .rings
        .iter()
        .flat_map(|ring| {
            let sides = ring.sides();
            let flanks = crate::parcels::flanks(&sides, depth.min(60.0));
            sides
                .into_iter()
                .zip(flanks)
                .filter(|(_, flank)| *flank)
                .map(|(side, _)| side.length_m())
        })
        .sum();
    out.fronted_share = (fronted / (kerb.length_m() - flanks).max(1.0)).min(1.0);
    if out.coverage > SPARSE_COVERAGE {
        out.fronted_share = 1.0;
    }
    // Ground far behind the houses belongs to no row.
    let used = median(buildings.iter().map(|b| b.setback_m + b.size_m.y));
    let depths = if out.fronted_share < 0.6 { 2.0 } else { 3.0 };
    let depth = depth.min((used * depths).max(25.0));
    out.depth_m = depth.clamp(DEPTHS_M.0, DEPTHS_M.1);
}

/// Frontage and depth of the parcels that lie at the kerb, in order along it.
fn lots(city: &City, contents: &BlockContents, kerb: &Kerb) -> Vec<(f64, f64)> {
    // Cadastres draw parcels to the kerb, to the pavement or to a line between.
    const AT_KERB_M: f64 = 8.0;
    let mut found: Vec<(usize, f64, f64, f64)> = contents
        .parcels
        .iter()
        .filter_map(|i| {
            let polygon = &city.parcels[*i as usize].polygon;
            let front = Some(Front::of(polygon, kerb)).filter(|f| f.setback_m < AT_KERB_M)?;
            let width = front.size_m.x.max(1.0);
            Some((front.ring, front.at_m, width, polygon.area_m2() / width))
        })
        .filter(|lot| lot.2 > 2.0 && lot.3 > 2.0)
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    found.into_iter().map(|lot| (lot.2, lot.3)).collect()
}

/// A building that fronts on the kerb, with what is built onto it.
struct Fronting {
    polygon: Polygon,
    front: Front,
}

/// Buildings that front on the kerb, in order along it. Annexes and buildings behind that share a
/// wall with one of them are joined to it, others are left out.
fn row_of_fronts(city: &City, contents: &BlockContents, kerb: &Kerb) -> Vec<Fronting> {
    let polygon = |i: u32| &city.buildings[i as usize].polygon;
    let usual = median(contents.buildings.iter().map(|i| polygon(*i).area_m2()));
    let mut fronts: Vec<(u32, Front)> =
        contents.buildings.iter().map(|i| (*i, Front::of(polygon(*i), kerb))).collect();
    fronts.sort_by(|a, b| a.1.setback_m.total_cmp(&b.1.setback_m).then(a.0.cmp(&b.0)));
    let mut kept: Vec<(u32, Front)> = Vec::new();
    let mut others: Vec<u32> = Vec::new();
    for (i, front) in fronts {
        let hidden = kept.iter().any(|(_, other)| front.is_behind(other));
        if hidden || polygon(i).area_m2() < usual * ANNEX_SHARE {
            others.push(i);
        } else {
            kept.push((i, front));
        }
    }
    let mut onto: Vec<Vec<u32>> = vec![Vec::new(); kept.len()];
    for i in others {
        let carries = |k: &usize| {
            let main = polygon(kept[*k].0);
            polygon(i).area_m2() <= main.area_m2() && are_near(polygon(i), main, TOUCHING_M)
        };
        if let Some(k) = (0..kept.len()).find(carries) {
            onto[k].push(i);
        }
    }
    let joined = |(i, front): (u32, Front), onto: Vec<u32>| {
        let parts = onto.iter().map(|j| polygon(*j)).chain([polygon(i)]);
        let whole = (!onto.is_empty()).then(|| overlay::union(parts).into_iter().next()).flatten();
        match whole {
            Some(polygon) => Fronting { front: Front::of(&polygon, kerb), polygon },
            None => Fronting { polygon: polygon(i).clone(), front },
        }
    };
    let mut out: Vec<Fronting> = kept.into_iter().zip(onto).map(|(k, o)| joined(k, o)).collect();
    let key = |f: &Fronting| (f.front.ring, f.front.at_m);
    out.sort_by(|a, b| {
        let ((r, s), (q, t)) = (key(a), key(b));
        r.cmp(&q).then(s.total_cmp(&t)).then_with(|| a.polygon.cmp(&b.polygon))
    });
    out
}

fn samples(fronts: &[Fronting], kerb: &Kerb) -> Vec<BuildingSample> {
    let polygon = |k: usize| &fronts[k].polygon;
    let corners: Vec<Vec<Vec2>> = kerb
        .rings
        .iter()
        .map(|ring| {
            let convex = ring.sides().into_iter().filter(|s| s.turn_before_rad > 0.0);
            convex.map(|s| ring.point_at(s.start_m)).collect()
        })
        .collect();
    (0..fronts.len())
        .map(|k| {
            let front = &fronts[k].front;
            let cap = front.size_m.x.max(8.0) * 2.0;
            let length = kerb.rings[front.ring].length_m();
            let ahead = |from: f64, to: f64| {
                let d = (to - from).rem_euclid(length);
                if d > length / 2.0 { d - length } else { d }
            };
            // Gaps to the nearest of the next few on either side; at corners the one that shares
            // the wall need not be the next one along the kerb.
            let (mut gap_before_m, mut gap_after_m) = (cap, cap);
            for step in 1..=NEIGHBOURS.min(fronts.len() - 1) {
                for other in [(k + fronts.len() - step) % fronts.len(), (k + step) % fronts.len()] {
                    let there = &fronts[other].front;
                    if other == k || there.ring != front.ring {
                        continue;
                    }
                    let is_after = ahead(front.at_m, there.at_m) > 0.0;
                    let along = if is_after {
                        ahead(front.span().1, there.span().0)
                    } else {
                        ahead(there.span().1, front.span().0)
                    };
                    let shares = are_near(polygon(k), polygon(other), SHARED_WALL_M);
                    let gap = if shares { 0.0 } else { along.clamp(0.5, cap) };
                    let side = if is_after { &mut gap_after_m } else { &mut gap_before_m };
                    if shares || step == 1 {
                        *side = side.min(gap);
                    }
                }
            }
            let near_corner = front.setback_m * 1.5 + 4.0;
            let at_corner = corners[front.ring]
                .iter()
                .any(|c| polygon(k).exterior().iter().any(|p| p.to_m().distance(*c) < near_corner));
            BuildingSample {
                frontage_m: front.size_m.x + (gap_before_m + gap_after_m) / 2.0,
                size_m: front.size_m,
                band_m: super::building_sample::band_m(&front.outline[0], front.size_m),
                setback_m: front.setback_m,
                gap_before_m,
                gap_after_m,
                turn_rad: front.turn_rad,
                at_corner,
                area_m2: polygon(k).area_m2(),
                outline: front.outline.clone(),
            }
        })
        .collect()
}

/// Outlines in as few corners as they can be told with.
fn simplify(building: &mut BuildingSample) {
    for ring in &mut building.outline {
        let mut tolerance = OUTLINE_TOLERANCE_M;
        let mut simple = simplified_ring(ring, tolerance);
        while simple.len() > MOST_CORNERS && tolerance < 5.0 {
            tolerance *= 1.6;
            simple = simplified_ring(ring, tolerance);
        }
        *ring = simple;
    }
    building.outline.retain(|ring| ring.len() >= 3);
    if building.outline.is_empty() {
        let (w, d) = (building.size_m.x, building.size_m.y);
        let corners = [(0.0, 0.0), (w, 0.0), (w, d), (0.0, d)];
        building.outline = vec![corners.map(|(x, y)| Vec2::new(x, y)).to_vec()];
    }
}

/// A closed ring simplified between its first point and the one farthest from it.
fn simplified_ring(ring: &[Vec2], tolerance_m: f64) -> Vec<Vec2> {
    let Some(first) = ring.first() else { return Vec::new() };
    let far = (0..ring.len())
        .max_by(|i, j| ring[*i].distance(*first).total_cmp(&ring[*j].distance(*first)))
        .unwrap_or(0);
    let back: Vec<Vec2> = ring[far..].iter().chain([first]).copied().collect();
    let mut out = polyline::simplify(&ring[..=far], tolerance_m);
    out.pop();
    out.extend(polyline::simplify(&back, tolerance_m));
    out.pop();
    // The ring's first point may itself lie on a straight side.
    let n = out.len();
    if n > 3 {
        let (a, b) = (out[n - 1], out[1]);
        if polyline::nearest_on_segment(a, b, out[0]).0.distance(out[0]) < tolerance_m {
            out.remove(0);
        }
    }
    out
}

/// The middle value; 0 when there is none.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
