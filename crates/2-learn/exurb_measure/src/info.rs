//! What is in a city: counts, lengths, areas, laws, likeness gates, provenance.
//!
//! [`Info`] is, key by key, what `exurb info --json` prints (contract, section 5). Keys never vanish;
//! what does not apply is `None`. Counts, lengths and areas are those of the whole city; shares of
//! the network are measured inside the target, as [`mod@exurb_city::laws`] says.

use std::collections::BTreeMap;

use exurb_city::laws::{self, Gate, LawReport};
use exurb_city::{BlockClass, City, Role, street_graph};
use exurb_geom::{Frame, GridPoint, polyline};
use serde::{Deserialize, Serialize};

use crate::on_land::{OnLand, on_land};

/// Problems listed at most.
pub const MOST_PROBLEMS: usize = 100;

/// The ground of a city.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terrain {
    /// Distance of neighbouring heights in metres.
    pub cell: f64,
    /// Lowest height in the target in metres.
    pub lowest: Option<f64>,
    /// Mean height in the target in metres.
    pub mean: Option<f64>,
    /// Highest height in the target in metres.
    pub highest: Option<f64>,
    /// Mean slope of the target, rise over run.
    pub mean_slope: Option<f64>,
    /// Share of the target's area where no height is known.
    pub missing_share: f64,
    /// Everything up to here is under water.
    pub water_level: Option<f64>,
}

impl Terrain {
    fn of(city: &City, terrain: &exurb_city::Terrain) -> Self {
        let relief = terrain.relief(&city.target);
        Self {
            cell: terrain.cell_m(),
            lowest: relief.map(|r| r.range_m.0),
            mean: relief.map(|r| r.mean_m),
            highest: relief.map(|r| r.range_m.1),
            mean_slope: relief.map(|r| r.slope),
            missing_share: terrain.missing_share(&city.target),
            water_level: terrain.water_level_m(),
        }
    }
}

/// What is in a city.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Info {
    /// Streets of the graph.
    pub streets: Streets,
    /// Nodes of degree other than 2.
    pub intersections: Intersections,
    /// Blocks.
    pub blocks: Blocks,
    /// Parcels.
    pub parcels: Parcels,
    /// Buildings without their parts.
    pub buildings: Buildings,
    /// Shares of the street length by origin.
    pub provenance: Shares,
    /// Laws by name.
    pub laws: BTreeMap<String, LawValue>,
    /// Likeness gates by name.
    pub likeness_gates: BTreeMap<String, GateValue>,
    /// The ground; `None` where it is flat.
    pub terrain: Option<Terrain>,
    /// Streets on terrain and water; none where there is neither.
    pub on_land: Option<OnLand>,
    /// Area of the target in km².
    pub area_km2: f64,
    /// Are all laws kept?
    pub valid: bool,
    /// Number of elements that count against broken laws.
    pub problems_total: usize,
    /// The first hundred of them.
    pub problems: Vec<Problem>,
}

/// Streets of the graph; beside them, in no other figure, the ways of role other that are drawn and
/// exported only (service roads, where nobody asked for them).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Streets {
    pub count: usize,
    pub km: f64,
    pub km_by_class: BTreeMap<String, f64>,
    pub km_by_role: BTreeMap<String, f64>,
    pub dead_end_share: Option<f64>,
    pub crossings_without_node: usize,
    pub components: usize,
    pub largest_component_share: Option<f64>,
    pub other_ways: usize,
    pub other_ways_km: f64,
}

/// Nodes of degree other than 2, cut ends among them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Intersections {
    pub count: usize,
    pub by_degree: BTreeMap<u32, usize>,
}

/// Blocks. The median is that of blocks that can be built on, in m².
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Blocks {
    pub count: usize,
    pub islands: usize,
    pub median_area: Option<f64>,
}

/// Parcels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Parcels {
    pub count: usize,
    pub street_access_share: Option<f64>,
}

/// Buildings. Coverage is the footprint area of buildings in blocks by the area of all faces, the
/// median of heights counts those known, in metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Buildings {
    pub count: usize,
    pub overlapping: usize,
    pub outside_block: usize,
    pub crossed_by_street: usize,
    pub coverage: Option<f64>,
    pub median_height: Option<f64>,
}

/// Shares of the street length by origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct Shares {
    pub example_share: Option<f64>,
    pub procedural_share: Option<f64>,
    pub other_share: Option<f64>,
}

/// A law as measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct LawValue {
    pub value: Option<f64>,
    pub limit: f64,
    pub pass: bool,
    pub count: usize,
}

/// A likeness gate as compared; `limit_min` where it has a lower side, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the contract")]
pub struct GateValue {
    pub value: Option<f64>,
    pub limit: Option<f64>,
    pub limit_min: Option<f64>,
    pub pass: Option<bool>,
}

/// One element against a broken law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Problem {
    /// Name of the law.
    pub law: String,
    /// Layer of the element.
    pub layer: String,
    /// Number of the element in that layer.
    pub id: u32,
    /// Longitude and latitude.
    pub at: [f64; 2],
    /// What is wrong.
    pub message: String,
}

impl Info {
    /// Measures `city`. Likeness gates are compared with `example`, else with the values that the
    /// city's metadata hold. O(n log n), on rayon's current pool.
    pub fn of(city: &City, example: Option<&City>) -> Self {
        let report = laws::laws(city);
        let values = laws::gates(city);
        let model = match example {
            Some(example) => Some(laws::gates(example)),
            None => Some(city.metadata.example_gates.clone()).filter(|gates| !gates.is_empty()),
        };
        let gates = laws::compare_gates(&values, model.as_ref());
        let dead_end_share = values.get("dead_end_share").copied();
        Self {
            streets: streets(city, &report, dead_end_share),
            intersections: intersections(city),
            blocks: blocks(city),
            parcels: Parcels {
                count: city.parcels.len(),
                street_access_share: value(&report, "street_access_share"),
            },
            buildings: buildings(city, &report),
            provenance: provenance(city),
            laws: report.laws.iter().map(|law| (law.name.to_owned(), law_value(law))).collect(),
            likeness_gates: gates.iter().map(|(n, g)| ((*n).to_owned(), gate_value(g))).collect(),
            on_land: on_land(city),
            terrain: city.terrain.as_ref().map(|terrain| Terrain::of(city, terrain)),
            area_km2: city.area_km2(),
            valid: report.is_valid(),
            problems_total: report.breaches.len(),
            problems: problems(&report, &city.frame),
        }
    }
}

fn value(report: &LawReport, law: &str) -> Option<f64> {
    report.get(law)?.value
}

fn law_value(law: &laws::Law) -> LawValue {
    LawValue { value: law.value, limit: law.limit, pass: law.pass, count: law.count }
}

fn gate_value(gate: &Gate) -> GateValue {
    GateValue { value: gate.value, limit: gate.limit, limit_min: gate.limit_min, pass: gate.pass }
}

fn streets(city: &City, report: &LawReport, dead_end_share: Option<f64>) -> Streets {
    let mut km_by_class: BTreeMap<String, f64> = BTreeMap::new();
    let roles = [Role::Main, Role::Local, Role::Other].map(|r| (r.as_str().to_owned(), 0.0));
    let mut km_by_role = BTreeMap::from(roles);
    for (_, edge) in city.streets.edges() {
        let km = edge.length_m() / 1000.0;
        let street = &edge.data;
        *km_by_class.entry(street.class.as_str().to_owned()).or_default() += km;
        *km_by_role.entry(street.role().as_str().to_owned()).or_default() += km;
    }
    let largest_component_share = value(report, "largest_component_share");
    Streets {
        count: city.streets.edge_count(),
        km: city.streets.length_m() / 1000.0,
        km_by_class,
        km_by_role,
        dead_end_share,
        crossings_without_node: report.count("crossings_without_node"),
        // What counts against the largest component is every other one.
        components: report.count("largest_component_share")
            + usize::from(largest_component_share.is_some()),
        largest_component_share,
        other_ways: city.other_ways.len(),
        other_ways_km: city
            .other_ways
            .iter()
            .fold(0.0, |km, way| km + polyline::grid_length_m(&way.line) / 1000.0),
    }
}

fn intersections(city: &City) -> Intersections {
    let mut by_degree: BTreeMap<u32, usize> = BTreeMap::new();
    for (id, _) in city.streets.nodes() {
        if street_graph::is_intersection(&city.streets, id) {
            *by_degree.entry(city.streets.degree(id) as u32).or_default() += 1;
        }
    }
    Intersections { count: by_degree.values().sum(), by_degree }
}

fn blocks(city: &City) -> Blocks {
    let ordinary = city.blocks.iter().filter(|b| b.class == BlockClass::Block);
    let areas: Vec<f64> = ordinary.map(|b| b.polygon.area_m2()).collect();
    let count = city.blocks.len();
    Blocks { count, islands: count - areas.len(), median_area: median(areas) }
}

fn buildings(city: &City, report: &LawReport) -> Buildings {
    let whole = || city.buildings.iter().filter(|b| !b.is_part);
    let in_blocks: Vec<f64> =
        whole().filter(|b| b.block != 0).map(|b| b.polygon.area_m2()).collect();
    let faces_m2 = face_area_m2(city);
    let coverage =
        (faces_m2 > 0.0 && !in_blocks.is_empty()).then(|| in_blocks.iter().sum::<f64>() / faces_m2);
    Buildings {
        count: whole().count(),
        overlapping: report.count("buildings_overlapping"),
        outside_block: report.count("buildings_outside_block"),
        crossed_by_street: report.count("buildings_crossed_by_street"),
        coverage,
        median_height: median(whole().filter_map(|b| b.known_height_m()).collect()),
    }
}

/// Area of all faces. Blocks that wide streets cut from one face follow each other and name the
/// same sides.
fn face_area_m2(city: &City) -> f64 {
    let parted = city.blocks.chunk_by(|a, b| {
        !a.sides.is_empty() && a.sides == b.sides && a.face_area_m2 == b.face_area_m2
    });
    parted.map(|blocks| blocks[0].face_area_m2).sum()
}

fn provenance(city: &City) -> Shares {
    let known = city.streets.edges().next().is_some();
    let (example, procedural, other) = street_graph::shares_by_origin(&city.streets);
    Shares {
        example_share: known.then_some(example),
        procedural_share: known.then_some(procedural),
        other_share: known.then_some(other),
    }
}

fn problems(report: &LawReport, frame: &Frame) -> Vec<Problem> {
    report
        .breaches
        .iter()
        .take(MOST_PROBLEMS)
        .map(|breach| Problem {
            law: breach.law.to_owned(),
            layer: breach.layer.to_owned(),
            id: breach.id,
            at: lon_lat(frame, breach.at),
            message: breach.message.clone(),
        })
        .collect()
}

fn lon_lat(frame: &Frame, at: GridPoint) -> [f64; 2] {
    let place = frame.unproject(at.to_m());
    [place.lon, place.lat].map(|degrees| (degrees * 1e7).round() / 1e7)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => None,
        _ if n.is_multiple_of(2) => Some((values[n / 2 - 1] + values[n / 2]) / 2.0),
        _ => Some(values[n / 2]),
    }
}

#[cfg(test)]
mod tests;
