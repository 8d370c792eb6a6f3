//! Growth as a whole: copies, statistics, seeds, motions. Where it may grow and what it learns from are
//! tested in rooms of their own.

mod examples;
mod places;

use std::sync::Arc;

use exurb_city::street_graph::{StreetGraph, shares_by_origin};
use exurb_city::{City, Class, ImportOptions, Junction, Street};
use exurb_geom::{Frame, GridPoint, Polygon, Vec2, trig};
use exurb_operation::{Example, Failure, Run, Scope, erase};
use proptest::prelude::*;

use super::{Params, learn};

/// A grid of `n` × `n` blocks of 100 m; every fifth street is a main one.
fn grid(n: usize) -> City {
    let mut graph = StreetGraph::new();
    let side = n + 1;
    let at = |x: usize, y: usize| GridPoint::m(x as f64 * 100.0, y as f64 * 100.0);
    let nodes: Vec<_> = (0..side * side)
        .map(|i| graph.add_node(at(i % side, i / side), Junction::default()))
        .collect();
    let street = |line: usize| {
        let class = if line.is_multiple_of(5) { Class::Secondary } else { Class::Residential };
        Street { class, ..Street::default() }
    };
    for y in 0..side {
        for x in 0..side {
            let here = nodes[y * side + x];
            if x + 1 < side {
                graph.add_edge(here, nodes[y * side + x + 1], vec![], street(y));
            }
            if y + 1 < side {
                graph.add_edge(here, nodes[(y + 1) * side + x], vec![], street(x));
            }
        }
    }
    city_of(graph)
}

fn city_of(graph: StreetGraph) -> City {
    let bounds = exurb_geom::Bounds::of(graph.nodes().map(|(_, n)| n.at)).expect("has nodes");
    let target = Polygon::rectangle(GridPoint::round(bounds.min), GridPoint::round(bounds.max));
    let mut city = City::empty(Frame::null_island(), target);
    city.streets = Arc::new(graph);
    city.metadata.name = "grid".into();
    city
}

fn square(center: Vec2, side_m: f64) -> Polygon {
    let half = Vec2::splat(side_m / 2.0);
    Polygon::rectangle(GridPoint::round(center - half), GridPoint::round(center + half))
}

fn grow(
    example: &City,
    target: Polygon,
    params: serde_json::Value,
    seed: u64,
) -> Result<City, Failure> {
    let empty = City::empty(example.frame.clone(), target);
    let examples = [Example::new(example.clone())];
    erase::<super::Grow>()
        .run(&empty, &Scope::All, &examples, params, &Run::new(seed))
        .map(|outcome| outcome.city)
}

fn params(continuation: f64) -> serde_json::Value {
    serde_json::json!({ "continuation": continuation })
}

fn assert_lawful(city: &City) {
    assert_eq!(exurb_graph::laws::breaches(&city.streets), []);
    let report = exurb_city::laws::laws(city);
    let broken: Vec<_> = report.laws.iter().filter(|law| !law.pass).collect();
    assert!(broken.is_empty(), "{broken:?}, first {:?}", report.breaches.first());
}

#[test]
fn following_a_grid_gives_that_grid() {
    let example = grid(30);
    let city = grow(&example, square(Vec2::splat(1500.0), 1000.0), params(1.0), 1).expect("grows");
    assert_lawful(&city);
    let (copied, ..) = shares_by_origin(&city.streets);
    assert!(copied > 0.99, "{copied}");
    // 1 km² of a grid of 100 m has 20 km of streets, give or take those on its edge.
    let km = city.streets.length_m() / 1000.0;
    assert!((18.0..26.0).contains(&km), "{km}");
    for (_, node) in city.streets.nodes().filter(|(_, n)| !n.data.cut) {
        let off = |v: i32| (v.rem_euclid(100_000)).min((-v).rem_euclid(100_000));
        assert!(off(node.at.x) <= 1 && off(node.at.y) <= 1, "{:?}", node.at);
    }
}

#[test]
fn drawing_from_a_grid_keeps_its_directions() {
    let city = grow(&grid(20), square(Vec2::splat(1000.0), 1200.0), params(0.0), 3).expect("grows");
    assert_lawful(&city);
    let (mut along, mut total) = (0.0, 0.0);
    for (_, edge) in city.streets.edges() {
        for w in edge.line_m().windows(2) {
            let d = w[1] - w[0];
            let lean = trig::angle(d).rem_euclid(std::f64::consts::FRAC_PI_2);
            let off = lean.min(std::f64::consts::FRAC_PI_2 - lean);
            total += d.length();
            along += if off < 0.15 { d.length() } else { 0.0 };
        }
    }
    assert!(along / total > 0.9, "{along} of {total}");
}

#[test]
fn same_seed_same_streets_on_any_number_of_threads() {
    let example = grid(20);
    let on = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| grow(&example, square(Vec2::splat(1000.0), 1500.0), params(0.5), seed))
            .expect("grows")
            .streets
    };
    let one = on(1, 7);
    assert_eq!(one, on(2, 7));
    assert_ne!(one, on(2, 8));
}

#[test]
fn several_starts_and_named_places_grow_one_piece() {
    let example = grid(20);
    let three = serde_json::json!({ "starts": 3, "continuation": 0.6 });
    let city = grow(&example, square(Vec2::splat(1000.0), 1600.0), three, 1).expect("grows");
    assert_lawful(&city);
    // 0.009 degrees are about a kilometre at the null island.
    let named = serde_json::json!({ "start": ["0.009,0.009=0.0045,0.0045"] });
    let city = grow(&example, square(Vec2::splat(1000.0), 800.0), named, 1).expect("grows");
    assert_lawful(&city);
    let outside = serde_json::json!({ "start": ["1,1"] });
    let error = grow(&example, square(Vec2::splat(1000.0), 800.0), outside, 1).unwrap_err();
    assert!(error.to_string().contains("the start 1,1 lies outside the target"), "{error}");
}

#[test]
fn a_turned_example_turns_its_streets() {
    let document = serde_json::json!({ "rotate": 30.0, "continuation": 1.0 });
    let city = grow(&grid(30), square(Vec2::splat(1500.0), 900.0), document, 1).expect("grows");
    assert_lawful(&city);
    let (mut along, mut total) = (0.0, 0.0);
    for (_, edge) in city.streets.edges() {
        for w in edge.line_m().windows(2) {
            let lean = (trig::angle(w[1] - w[0]).to_degrees() - 30.0).rem_euclid(90.0);
            total += w[0].distance(w[1]);
            along += if lean.min(90.0 - lean) < 2.0 { w[0].distance(w[1]) } else { 0.0 };
        }
    }
    assert!(along / total > 0.95, "{along} of {total}");
}

#[test]
fn a_warp_turns_streets_with_its_guideline() {
    // The example's line runs east; the target's runs north-east at first, then south-east.
    let place = |x: f64, y: f64| format!("{},{}", x / 111_319.49, y / 110_574.28);
    let guide = vec![
        format!("{}={}", place(500.0, 1000.0), place(500.0, 1500.0)),
        format!("{}={}", place(1500.0, 2000.0), place(1500.0, 1500.0)),
        format!("{}={}", place(2500.0, 1000.0), place(2500.0, 1500.0)),
    ];
    let document = serde_json::json!({ "guide": guide, "continuation": 0.5 });
    let target = Polygon::rectangle(GridPoint::m(400.0, 900.0), GridPoint::m(2600.0, 2100.0));
    let city = grow(&grid(30), target, document, 1).expect("grows");
    assert_lawful(&city);
    // Far from the bend streets run as the guideline does.
    let (mut along, mut total) = (0.0, 0.0);
    for (_, edge) in city.streets.edges() {
        for w in edge.line_m().windows(2) {
            if (w[0].x - 1500.0).abs() < 750.0 {
                continue;
            }
            let lean = (trig::angle(w[1] - w[0]).to_degrees() - 45.0).rem_euclid(90.0);
            total += w[0].distance(w[1]);
            along += if lean.min(90.0 - lean) < 25.0 { w[0].distance(w[1]) } else { 0.0 };
        }
    }
    assert!(along / total > 0.8, "{along} of {total}");
    let lonely = serde_json::json!({ "guide": ["0,0=0,0"] });
    assert!(grow(&grid(12), square(Vec2::splat(600.0), 600.0), lonely, 1).is_err());
}

#[test]
fn parameters_name_what_is_wrong() {
    let wrong = |document| exurb_operation::params::parse::<Params>(document).unwrap_err();
    assert!(wrong(serde_json::json!({ "continuation": 2 })).contains("expected 0 to 1"));
    assert!(wrong(serde_json::json!({ "start": ["here"] })).contains("`here` is no place"));
    assert!(wrong(serde_json::json!({ "keep": ["1,2 3,4"] })).contains("at least three"));
    assert!(wrong(serde_json::json!({ "speed": 1 })).contains("there is no parameter `speed`"));
}

#[test]
fn real_maps_grow_lawful_streets() {
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/osm");
    if !data.is_dir() {
        println!("skipped: no shared data");
        return;
    }
    for name in ["helsinki_center", "tokyo_kanda", "davis_california", "maribor"] {
        let path = data.join(format!("{name}.osm.pbf"));
        let example = exurb_osm::read(&path, &ImportOptions::default()).expect("readable").city;
        let learned = learn(&example, &Params::default()).expect("learns");
        let circles = [&learned.main, &learned.local].map(|s| s.patches.len());
        assert!(circles.iter().sum::<usize>() > 20, "{name}: {circles:?}");
        let target = square(example.target.bounds().center(), 1200.0);
        for (seed, continuation) in [(1, 0.3), (2, 1.0)] {
            let city = grow(&example, target.clone(), params(continuation), seed).expect("grows");
            assert_lawful(&city);
            assert!(city.streets.length_m() > 5_000.0, "{name}: {}", city.streets.length_m());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_target_and_seed_keeps_the_laws(
        seed in 0_u64..1000,
        continuation in 0.0..1.0_f64,
        procedural in 0.0..0.5_f64,
        corners in proptest::collection::vec((200.0..600.0_f64, 0.3..1.0_f64), 5..9),
    ) {
        // A star-shaped, usually concave target.
        let turn = std::f64::consts::TAU / corners.len() as f64;
        let ring = corners.iter().enumerate().map(|(i, (radius, part))| {
            GridPoint::round(Vec2::splat(700.0) + trig::unit((i as f64 + part * 0.8) * turn) * *radius)
        });
        let target = Polygon::new(ring.collect(), vec![]).expect("has area");
        let document = serde_json::json!({ "continuation": continuation, "procedural": procedural });
        let city = grow(&grid(14), target, document, seed).expect("grows");
        assert_lawful(&city);
        let past = city.streets.nodes().filter(|(_, n)| n.data.cut);
        for (id, node) in past {
            let out = city.target.boundary_distance_m(node.at.to_m());
            prop_assert!(!city.target.contains(node.at), "cut end {id:?} inside");
            prop_assert!(out > 0.0);
        }
    }
}
