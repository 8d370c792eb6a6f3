use std::sync::Arc;

use exurb_city::{Building, City, Class, Provenance, Street, StreetGraph, block, street_graph};
use exurb_geom::{Frame, GridPoint, LonLat, Polygon};
use serde_json::{Value, json};

use crate::Info;

fn square() -> Polygon {
    Polygon::rectangle(GridPoint::m(-500.0, -500.0), GridPoint::m(500.0, 500.0))
}

fn empty() -> City {
    let frame = Frame::new(LonLat { lon: 24.9, lat: 60.2 }).unwrap();
    City::empty(frame, square())
}

fn streets(lines: &[(&[(f64, f64)], Class)]) -> StreetGraph {
    street_graph::from_lines(lines.iter().map(|(line, class)| {
        let points = line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        (points, Street { class: *class, ..Street::default() })
    }))
}

/// One block of 100 m between four streets, with a dead end outside and a building of 20 m by 10 m.
fn town() -> City {
    let mut city = empty();
    city.streets = Arc::new(streets(&[
        (&[(0., 0.), (100., 0.)], Class::Primary),
        (&[(100., 0.), (100., 100.)], Class::Residential),
        (&[(100., 100.), (0., 100.)], Class::Residential),
        (&[(0., 100.), (0., 0.)], Class::Residential),
        (&[(0., 0.), (-80., 0.)], Class::Residential),
    ]));
    city.blocks = Arc::new(block::derive(&city.streets));
    let footprint = Polygon::rectangle(GridPoint::m(20., 20.), GridPoint::m(40., 30.));
    let mut house = Building::new(1, footprint, Provenance::default());
    (house.block, house.levels) = (1, Some(2.0));
    city.buildings = Arc::new(vec![house]);
    city
}

/// Every path of keys of a JSON document, for objects only.
fn keys(value: &Value, path: &str, out: &mut Vec<String>) {
    for (key, inner) in value.as_object().into_iter().flatten() {
        let path = format!("{path}/{key}");
        out.push(path.clone());
        keys(inner, &path, out);
    }
}

#[test]
fn the_document_has_the_keys_of_the_contract_whatever_the_city() {
    let contract = json!({
        "streets": {"count": 0, "km": 0, "km_by_class": {}, "km_by_role": {}, "dead_end_share": 0,
            "crossings_without_node": 0, "components": 0, "largest_component_share": 0},
        "intersections": {"count": 0, "by_degree": {}},
        "blocks": {"count": 0, "median_area": 0},
        "parcels": {"count": 0, "street_access_share": 0},
        "buildings": {"count": 0, "overlapping": 0, "outside_block": 0, "crossed_by_street": 0,
            "coverage": 0, "median_height": 0},
        "provenance": {"example_share": 0, "procedural_share": 0, "other_share": 0},
        "laws": {}, "likeness_gates": {},
        "area_km2": 0, "valid": 0, "problems_total": 0, "problems": 0
    });
    let mut promised = Vec::new();
    keys(&contract, "", &mut promised);
    let documents = [empty(), town()].map(|city| {
        let document = serde_json::to_value(Info::of(&city, None)).unwrap();
        let mut found = Vec::new();
        keys(&document, "", &mut found);
        assert!(promised.iter().all(|key| found.contains(key)), "{found:?}");
        document
    });
    let names =
        |d: &Value| -> Vec<String> { d["laws"].as_object().unwrap().keys().cloned().collect() };
    assert_eq!(names(&documents[0]), names(&documents[1]));
    assert_eq!(documents[0]["streets"]["largest_component_share"], Value::Null);
    assert_eq!(documents[0]["buildings"]["coverage"], Value::Null);
    assert_eq!(documents[0]["likeness_gates"]["dead_end_share"]["pass"], Value::Null);
}

#[test]
fn figures_of_a_small_town() {
    let info = Info::of(&town(), None);
    assert_eq!((info.streets.count, info.streets.components), (5, 1));
    assert!((info.streets.km - 0.48).abs() < 1e-12);
    assert!((info.streets.km_by_role["main"] - 0.1).abs() < 1e-12);
    assert!((info.streets.km_by_class["residential"] - 0.38).abs() < 1e-12);
    // The corners have degree 2; a junction and a dead end remain.
    assert_eq!(info.intersections.count, 2);
    assert_eq!(info.intersections.by_degree, [(1, 1), (3, 1)].into());
    assert_eq!(info.streets.dead_end_share, Some(0.5));
    assert_eq!(info.blocks.count, 1);
    assert_eq!(info.buildings.coverage, Some(200.0 / 10_000.0));
    assert_eq!(info.buildings.median_height, Some(6.0));
    assert_eq!((info.area_km2, info.valid, info.problems_total), (1.0, true, 0));
    let text = info.to_text();
    assert!(text.contains("laws: all kept") && text.contains("coverage 2.0 %"), "{text}");
}

#[test]
fn problems_have_their_place_on_earth() {
    let mut city = empty();
    city.streets = Arc::new(streets(&[
        (&[(-50., 0.), (50., 0.)], Class::Residential),
        (&[(0., -50.), (0., 50.)], Class::Residential),
    ]));
    let info = Info::of(&city, None);
    assert!(!info.valid);
    let problem = &info.problems[0];
    assert_eq!(
        (problem.law.as_str(), problem.layer.as_str()),
        ("crossings_without_node", "streets")
    );
    assert_eq!(problem.at, [24.9, 60.2]);
}

#[test]
fn an_example_sets_the_gates_and_so_do_stored_values() {
    let city = town();
    let beside = Info::of(&city, Some(&city));
    assert_eq!(beside.likeness_gates["dead_end_share"].pass, Some(true));
    let mut copy = city.clone();
    copy.metadata.example_gates = exurb_city::laws::gates(&city);
    assert_eq!(Info::of(&copy, None).likeness_gates, beside.likeness_gates);
}

#[test]
fn the_document_reads_back() {
    let info = Info::of(&town(), None);
    let text = serde_json::to_string(&info).unwrap();
    assert_eq!(serde_json::from_str::<Info>(&text).unwrap(), info);
}
