//! Measures and distances beside the programs that know them: momepy, OSMnx, networkx, scipy,
//! scikit-learn. What each is compared with, docs/likeness.md lists.
//!
//! Both sides see the same streets, cut and cleaned, and the same blocks and buildings; the other
//! side measures them anew. `cargo xtask test` installs it.

#![allow(clippy::print_stdout, reason = "what tests report")]

use std::path::Path;

use exurb_city::{City, Part};
use exurb_geom::{Polygon, Vec2};
use exurb_likeness::patches::{area_under_curve, kernel_distance, told_apart};
use exurb_likeness::{Panel, distance, windows};
use exurb_measure::block_shapes::{self, BlockShape};
use exurb_measure::network::rectangle;
use exurb_measure::{
    Network, Sample, bearings, buildings, built_blocks, junctions, moving_windows, natural_streets,
    parcels, paths, segments,
};
use exurb_operation::{Run, rng};
use exurb_recipe::Source;
use exurb_scenarios::{check, shared_data};
use rand::RngExt;
use serde_json::{Value, json};

/// Side of a window in metres: so small that every junction inside is a source of paths, and no
/// draw decides.
const SIDES_M: [(&str, f64); 3] =
    [("liege", 2000.0), ("salt_lake_city", 2400.0), ("aleppo", 1500.0)];

#[test]
fn streets_and_blocks_measure_as_in_momepy_osmnx_and_networkx() {
    let Some(data) = shared_data() else { return };
    let maps: Vec<Value> = SIDES_M
        .iter()
        .map(|(name, side_m)| {
            let city = read(&data.join(format!("osm/{name}.osm.pbf")));
            let half = windows::halves(&city, [Part::West, Part::East])[0];
            let window = windows::centred(half, Vec2::splat(*side_m));
            streets(name, &Network::of(&city.streets, window))
        })
        .collect();
    compare("measures_streets.py", &json!(maps));
}

#[test]
fn buildings_measure_as_in_momepy_and_shapely() {
    let Some(data) = shared_data() else { return };
    let city = read(&data.join("osm/karlsruhe_kirchfeld.osm.pbf"));
    compare("measures_buildings.py", &built(&city));
}

#[test]
fn parcels_measure_as_in_momepy() {
    let city = read("builtin:prague".as_ref());
    compare("measures_parcels.py", &lots(&city));
}

#[test]
fn distances_are_those_of_scipy_and_scikit_learn() {
    compare("distances.py", &distances());
}

fn read(file: &Path) -> City {
    let source = Source::new(file);
    exurb_recipe::read_source(&source, Path::new(""), &Run::new(1)).expect("a readable map")
}

/// Hands a document to a script of `consumers/`.
fn compare(script: &str, document: &Value) {
    let folder = tempfile::tempdir().expect("a folder for the document");
    let file = folder.path().join("measured.json");
    std::fs::write(&file, document.to_string()).expect("the folder takes files");
    check("EXURB_PYTHON", script, &[&file]);
}

fn streets(name: &str, network: &Network) -> Value {
    let graph = &network.graph;
    let nodes = graph.nodes().map(|(id, node)| {
        let at = node.at.to_m();
        json!([id.0, at.x, at.y, node.data.cut])
    });
    let edges = graph.edges().map(|(_, e)| json!([e.from.0, e.to.0, points(&e.line_m())]));
    let pieces = network.straight_pieces(bearings::PIECE_M);
    let pieces = pieces.iter().map(|(a, b)| [a.x, a.y, b.x, b.y]);
    let blocks = block_shapes::blocks(network);
    let paths = paths::paths(network, &mut rng::stream(1, "test", 0));
    let [near, far] = paths.detour;
    let measures = [
        ("seg_length", segments::length(network)),
        ("seg_sinuosity", segments::sinuosity(network)),
        ("deadend_length", segments::dead_end_length(network)),
        ("fourway_share_1km", moving_windows::four_way_share(network)),
        ("meshedness_1km", moving_windows::meshedness(network)),
        ("order_phi_1km", moving_windows::order(network)),
        ("density_junction", moving_windows::junction_density(network)),
        ("density_deadend", moving_windows::dead_end_density(network)),
        ("density_length", moving_windows::street_density(network)),
        ("reach_500m", paths.reach),
        ("detour_150_500m", near),
        ("detour_500_1200m", far),
        ("betweenness_local", paths.betweenness),
        ("natural_street_length", natural_streets::length(network)),
    ];
    let measures = measures.into_iter().chain(of_blocks(&blocks));
    json!({
        "name": name,
        "window": [network.window.min.x, network.window.min.y, network.window.max.x, network.window.max.y],
        "nodes": nodes.collect::<Vec<_>>(),
        "edges": edges.collect::<Vec<_>>(),
        "pieces": pieces.collect::<Vec<_>>(),
        "degrees": junctions::degrees(network),
        "bearings": bearings::histogram(network).map(|b| b.to_vec()),
        "measures": measures.map(|(name, s)| (name.to_owned(), sample(&s))).collect::<serde_json::Map<_, _>>(),
    })
}

fn of_blocks(blocks: &[BlockShape]) -> [(&'static str, Sample); 5] {
    let of = |value: fn(&BlockShape) -> f64| block_shapes::sample(blocks, value);
    [
        ("block_area", of(block_shapes::log_area)),
        ("block_shape_phi", of(|b| b.phi)),
        ("block_compactness", of(|b| b.compactness)),
        ("block_aspect", of(|b| b.aspect)),
        ("block_rectangularity", of(|b| b.rectangularity)),
    ]
}

fn built(city: &City) -> Value {
    let window = city.target.bounds();
    let network = Network::of(&city.streets, window);
    let blocks = block_shapes::blocks(&network);
    let shapes = buildings::shapes(city, window);
    let whole = built_blocks::built_blocks(city, &blocks, &shapes, window);
    let footprints: Vec<usize> =
        (0..city.buildings.len()).filter(|i| !city.buildings[*i].is_part).collect();
    let shape = |s: &buildings::Shape| {
        json!({
            "number": footprints.binary_search(&s.index).ok(), "area": s.area_m2,
            "elongation": s.elongation, "rectangularity": s.rectangularity, "corners": s.corners,
            "setback": s.setback_m, "alignment": s.street_alignment, "gap": s.gap_m,
        })
    };
    let outline = |i: &usize| rings(&city.buildings[*i].polygon);
    json!({
        "streets": city.streets.edges().map(|(_, e)| points(&e.line_m())).collect::<Vec<_>>(),
        "footprints": footprints.iter().map(outline).collect::<Vec<_>>(),
        "shapes": shapes.iter().map(shape).collect::<Vec<_>>(),
        "blocks": blocks.iter().map(|b| rings(&b.polygon)).collect::<Vec<_>>(),
        "coverage": sample(&whole.coverage),
        "buildings_per_ha": sample(&whole.buildings_per_ha),
    })
}

fn lots(city: &City) -> Value {
    let everywhere = rectangle(city.target.bounds().grown(1000.0)).bounds();
    let found = parcels::parcels(city, everywhere);
    let buildings = city.buildings.iter().filter(|b| !b.is_part).map(|b| b.parcel);
    json!({
        "parcels": city.parcels.iter().map(|p| rings(&p.polygon)).collect::<Vec<_>>(),
        "ids": city.parcels.iter().map(|p| p.id).collect::<Vec<_>>(),
        "parcel_of_building": buildings.collect::<Vec<_>>(),
        "area": sample(&found.area),
        "rectangularity": sample(&found.rectangularity),
        "buildings": sample(&found.buildings),
    })
}

fn distances() -> Value {
    let mut rng = rng::stream(1, "distances", 0);
    let mut draw = |count: usize, width: f64| -> Vec<f64> {
        // Rounded, so that values are tied within and between the samples.
        (0..count).map(|_| (rng.random::<f64>() * width * 50.0).round() / 50.0).collect()
    };
    let (a, b) = (draw(300, 2.0), draw(211, 3.0));
    let (wa, wb) = (draw(300, 4.0), draw(211, 1.0));
    let weights = |w: &[f64]| -> Vec<f64> { w.iter().map(|w| w + 0.1).collect() };
    let (wa, wb) = (weights(&wa), weights(&wb));
    let weighted =
        |v: &[f64], w: &[f64]| Sample::weighted(v.iter().copied().zip(w.iter().copied()));
    let plain = |v: &[f64]| Sample::plain(v.iter().copied());
    let pairs = |v: &[f64]| -> Vec<[f64; 2]> { v.chunks_exact(2).map(|p| [p[0], p[1]]).collect() };
    let (p, q) = (pairs(&a), pairs(&b));
    let positive: Vec<bool> = wa.iter().map(|w| *w > 1.3).collect();
    let sorted = |v: &[f64]| {
        let mut v = v[..200].to_vec();
        v.sort_by(f64::total_cmp);
        v
    };
    let panel = Panel::builtin().expect("the panel is part of the program");
    let looks: Vec<_> = panel.cities.iter().filter_map(|c| c.patches.as_ref()).take(3).collect();
    let look = |i: usize| {
        let rows = looks[i].features.rows().into_iter().map(|row| row.to_vec());
        json!({ "features": rows.collect::<Vec<_>>(), "halves": looks[i].halves })
    };
    let told = |i: usize, j: usize| told_apart(looks[i], looks[j]);
    json!({
        "a": a, "b": b, "weights_a": wa, "weights_b": wb, "positive": positive,
        "wasserstein": distance::wasserstein(&plain(&a), &plain(&b)),
        "wasserstein_weighted": distance::wasserstein(&weighted(&a, &wa), &weighted(&b, &wb)),
        "wasserstein_of_sorted": distance::wasserstein_of_sorted(&sorted(&a), &sorted(&b)),
        "kolmogorov_smirnov": distance::kolmogorov_smirnov(&plain(&a), &plain(&b)),
        "discrepancy": distance::squared_discrepancy(&p, &q),
        "area_under_curve": area_under_curve(&a, &positive),
        "patches": [look(0), look(1), look(2)],
        "told_apart": [told(0, 1), told(0, 2), told(1, 2)],
        "kernel_distance": [
            kernel_distance(looks[0], looks[1]),
            kernel_distance(looks[0], looks[2]),
            kernel_distance(looks[1], looks[2]),
        ],
    })
}

fn sample(sample: &Sample) -> Value {
    json!({ "values": sample.values(), "weights": sample.weights() })
}

fn rings(polygon: &Polygon) -> Vec<Vec<[f64; 2]>> {
    let ring = |ring: &[exurb_geom::GridPoint]| ring.iter().map(|p| p.to_m().to_array()).collect();
    std::iter::once(ring(polygon.exterior()))
        .chain(polygon.interiors().iter().map(|r| ring(r)))
        .collect()
}

fn points(line: &[Vec2]) -> Vec<[f64; 2]> {
    line.iter().map(|p| p.to_array()).collect()
}
