//! What growth learns from: patches of an example, which example serves where.

use std::sync::Arc;

use exurb_city::street_graph::{self, StreetGraph};
use exurb_city::{City, Class, ImportOptions, Junction, Role, Street};
use exurb_geom::{Bounds, Frame, GridPoint, SegmentIndex, Vec2, trig};
use exurb_operation::{Example, Failure, Lines, Run, Scope, erase};
use serde_json::json;

use super::super::layer::{Layer, NodeKind};
use super::super::like::{self, Fragment};
use super::super::{Grow, detect, patch, prepare};
use super::{assert_lawful, city_of, grid, grow, params, square};

#[test]
fn areas_grow_like_the_examples_they_name_and_parks_stay_free() {
    let named = |name: &str, mut city: City| {
        city.metadata.name = name.into();
        Example::new(city)
    };
    let examples = [named("west", grid(20)), named("east", grid(20))];
    let mut empty = City::empty(Frame::null_island(), square(Vec2::splat(800.0), 1600.0));
    let park = square(Vec2::new(400.0, 400.0), 300.0);
    empty.land_use =
        Arc::new(vec![exurb_city::Area { id: 1, polygon: park.clone(), class: "park".into() }]);
    let area = |name: &str, west: f64, east: f64| {
        serde_json::json!({
            "use": "flat", "examples": { name: 1.0 },
            "polygon": [[[west, -400.0], [east, -400.0], [east, 2000.0], [west, 2000.0]]],
        })
    };
    let areas = [area("west", -400.0, 800.0), area("east", 800.0, 2000.0)];
    let document = serde_json::json!({ "areas": { "areas": areas } });
    let city = erase::<Grow>()
        .run(&empty, &Scope::All, &examples, document, &Run::new(1))
        .expect("grows")
        .city;
    assert_lawful(&city);
    let (mut right, mut copied) = (0.0, 0.0);
    for (_, edge) in city.streets.edges() {
        let line = edge.line_m();
        let middle = exurb_geom::polyline::point_at(&line, edge.length_m() / 2.0);
        assert!(!park.contains(GridPoint::round(middle)), "a street in the park");
        if let Some(source) = &edge.data.provenance.source {
            let wanted = if middle.x < 800.0 { "west" } else { "east" };
            copied += edge.length_m();
            right += if **source == *wanted { edge.length_m() } else { 0.0 };
        }
    }
    assert!(right > 0.85 * copied && copied > 10_000.0, "{right} of {copied}");
    let unknown = serde_json::json!({ "areas": { "areas": [area("north", 0.0, 9.0)] } });
    let error =
        erase::<Grow>().run(&empty, &Scope::All, &examples, unknown, &Run::new(1)).unwrap_err();
    assert!(error.to_string().contains("`north`"), "{error}");
}

#[test]
fn examples_without_streets_or_junctions_are_refused() {
    let empty = city_of({
        let mut graph = StreetGraph::new();
        graph.add_node(GridPoint::m(0.0, 0.0), Junction::default());
        graph.add_node(GridPoint::m(9.0, 9.0), Junction::default());
        graph
    });
    let error = grow(&empty, square(Vec2::ZERO, 500.0), params(1.0), 1).unwrap_err();
    assert!(matches!(error, Failure::Example { .. }), "{error}");

    let lines = (0..5).map(|i| {
        let y = f64::from(i) * 80.0;
        (vec![GridPoint::m(0.0, y), GridPoint::m(200.0, y)], Street::default())
    });
    let loose = city_of(street_graph::from_lines(lines));
    let error = grow(&loose, square(Vec2::splat(100.0), 500.0), params(1.0), 1).unwrap_err();
    assert!(error.to_string().contains("no junction"), "{error}");
}

#[test]
fn a_map_without_main_streets_grows_local_ones() {
    let mut example = grid(15);
    let mut graph = (*example.streets).clone();
    for id in graph.edges().map(|(id, _)| id).collect::<Vec<_>>() {
        graph.edge_mut(id).data.class = Class::Residential;
    }
    example.streets = Arc::new(graph);
    let city = grow(&example, square(Vec2::splat(750.0), 800.0), params(0.7), 2).expect("grows");
    assert_lawful(&city);
    assert!(city.streets.length_m() > 8_000.0);
}

#[test]
fn every_chain_lies_in_one_patch_or_joins_two() {
    let graph = prepare::learnable(&grid(12).streets, &Arc::default());
    let main: Vec<bool> = (0..graph.edge_bound())
        .map(|i| graph.edge(exurb_graph::EdgeId(i as u32)).data.role() == Role::Main)
        .collect();
    for role in [Role::Main, Role::Local] {
        let mut layer = Layer::of(&graph, role, &main);
        let patches = patch::extract(&mut layer, &[], 20.0, "test");
        for (number, chain) in layer.chains.iter().enumerate() {
            let inner = patches.iter().filter(|p| p.inner.contains(&number)).count();
            let outer = patches.iter().flat_map(|p| &p.outer).filter(|e| e.chain == number).count();
            let ends = [chain.from, chain.to];
            let cores = ends.iter().filter(|n| layer.nodes[**n].patch.is_some()).count();
            let expected = if inner == 1 { 0 } else { cores };
            assert!(inner <= 1 && outer == expected, "chain {number}: {inner} {outer} {expected}");
        }
    }
}

#[test]
fn a_plaza_is_detected_as_one_circle() {
    // Six spokes meet a circle of 60 m.
    let ring: Vec<Vec2> =
        (0..=48).map(|i| trig::unit(f64::from(i) * std::f64::consts::TAU / 48.0) * 60.0).collect();
    let arcs = ring.windows(9).step_by(8).map(exurb_geom::polyline::round);
    let spokes =
        ring.iter().step_by(8).take(6).map(|p| exurb_geom::polyline::round(&[*p, *p * 4.0]));
    let lines = arcs.chain(spokes).map(|line| (line, Street::default()));
    let graph = street_graph::from_lines(lines);
    let layer = Layer::of(&graph, Role::Local, &vec![false; graph.edge_bound()]);
    let circles = detect::circles(&layer, 100.0);
    assert_eq!(circles.len(), 1);
    assert_eq!(circles[0].len(), 6);
    assert!(detect::circles(&layer, 40.0).is_empty(), "larger than asked for");
}

#[test]
fn an_end_cut_off_by_a_motorway_is_no_dead_end() {
    let line = |a: (f64, f64), b: (f64, f64)| vec![GridPoint::m(a.0, a.1), GridPoint::m(b.0, b.1)];
    let motorway = Street { class: Class::Motorway, ..Street::default() };
    let lines = vec![
        (line((0., 0.), (0., 100.)), Street::default()),
        (line((0., 100.), (0., 300.)), motorway.clone()),
        (line((0., 0.), (100., 0.)), Street::default()),
        (line((0., 0.), (-100., 0.)), Street::default()),
    ];
    let graph = prepare::learnable(&street_graph::from_lines(lines), &Arc::default());
    let layer = Layer::of(&graph, Role::Local, &vec![false; graph.edge_bound()]);
    let count = |kind| layer.nodes.iter().filter(|n| n.kind == kind).count();
    assert_eq!((count(NodeKind::DeadEnd), count(NodeKind::Cut)), (2, 1));
}

fn builtin(name: &str) -> City {
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data");
    let path = data.join(format!("{name}.osm.pbf"));
    exurb_osm::read(&path, &ImportOptions::default()).expect("readable").city
}

/// The streets of a map within `reach_m` of `center`, turned around it and drawn on the meridian.
fn drawn(city: &City, center: Vec2, reach_m: f64, turn_rad: f64) -> Lines {
    let near = |p: &Vec2| p.distance(center) < reach_m;
    let lines = city.streets.edges().map(|(_, e)| e.line_m());
    let lines = lines.filter(|line| line.iter().all(near));
    let point = |p: &Vec2| {
        let q = trig::unit(turn_rad).rotate(*p - center);
        [q.x, q.y]
    };
    let lines = lines.map(|line| line.iter().map(point).collect()).collect();
    Lines { origin: [0.0, 0.0], lines }
}

#[test]
fn a_fragment_of_a_map_is_found_where_it_was_cut_and_turned_as_it_was() {
    let cities = ["suburb", "helsinki", "karhula"].map(builtin);
    let middle = cities[1].target.bounds().center();
    let drawn = drawn(&cities[1], middle + Vec2::new(150.0, -100.0), 320.0, 0.6);
    let empty = City::empty(Frame::null_island(), square(Vec2::ZERO, 1000.0));
    let fragment = Fragment::of(&drawn, Some(&empty)).expect("is a fragment");
    let found = cities.iter().map(|city| fragment.place_in(city)).collect();
    let (example, found) = like::likest(found).expect("finds one");
    assert_eq!(example, 1);
    assert!((found.turn_rad - 0.6).abs() < 0.02 && found.apart_m < 10.0, "{found:?}");
    // Growth begins with that place, turned, where it was drawn.
    let params = json!({ "continuation": 1.0, "like": &drawn });
    let examples = cities.map(Example::new);
    let library = erase::<Grow>();
    let run = Run::new(1);
    let chosen = library.choose(&empty, &Scope::All, &examples, params.clone(), &run);
    assert_eq!(chosen.expect("chooses"), [1]);
    let city = library.run(&empty, &Scope::All, &examples, params, &run).expect("grows").city;
    let mut index = SegmentIndex::new(50.0);
    city.streets.edges().for_each(|(id, e)| index.insert_line(id.0, &e.line_m()));
    let points = drawn.lines.iter().flatten().map(|p| Vec2::new(p[0], p[1]));
    let is_near = |p: &Vec2| !index.ids(Bounds { min: *p, max: *p }.grown(6.0)).is_empty();
    let (near, all) = (points.clone().filter(is_near).count(), points.count());
    assert!(near * 2 > all, "{near} of {all}");
}

#[test]
fn a_library_is_asked_what_fits_and_says_when_nothing_tells() {
    let height = |slope: f64| move |p: Vec2| 50.0 + slope * p.x.abs();
    let on = |mut city: City, slope: f64, name: &str| {
        let bounds = city.target.bounds().grown(200.0);
        city.lay(
            exurb_city::Terrain::over(bounds, 20.0, |p| height(slope)(p) as f32)
                .expect("is ground"),
        );
        city.metadata.name = name.into();
        city
    };
    let library = [on(grid(8), 0.0, "plain"), on(grid(8), 0.15, "hill")].map(Example::new);
    let target = City::empty(Frame::null_island(), square(Vec2::ZERO, 1000.0));
    let choose = |city: &City, params: serde_json::Value| {
        erase::<Grow>().choose(city, &Scope::All, &library, params, &Run::new(1))
    };
    assert_eq!(choose(&on(target.clone(), 0.12, "t"), json!({})).expect("chooses"), [1]);
    assert_eq!(choose(&on(target.clone(), 0.01, "t"), json!({})).expect("chooses"), [0]);
    let error = choose(&target, json!({})).unwrap_err().to_string();
    assert!(error.contains("--like"), "{error}");
    // Without ground, density tells.
    let area = |density: f64| {
        let polygon = [[[-500.0, -500.0], [500.0, -500.0], [500.0, 500.0], [-500.0, 500.0]]];
        json!({ "use": "flat", "examples": {}, "density": density, "polygon": polygon })
    };
    let chosen = choose(&target, json!({ "areas": { "areas": [area(20.0)] } }));
    assert_eq!(chosen.expect("chooses").len(), 1);
}

#[test]
fn areas_say_where_growth_begins_and_with_what() {
    let example = grid(14);
    let ring = [[[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0], [0.0, 1000.0]]];
    let at = example.frame.unproject(Vec2::new(333.0, 333.0));
    let from = example.frame.unproject(Vec2::new(500.0, 500.0));
    let start = format!("{},{}={},{}", at.lon, at.lat, from.lon, from.lat);
    let area =
        json!({ "use": "flat", "examples": { "grid": 1.0 }, "starts": [start], "polygon": ring });
    let params = json!({ "continuation": 1.0, "areas": { "areas": [area] } });
    let city = grow(&example, square(Vec2::splat(500.0), 800.0), params, 1).expect("grows");
    // The grid lies so that its junction at 500, 500 lies on 333, 333.
    let off = |v: i32| (v - 33_000).rem_euclid(100_000).min((33_000 - v).rem_euclid(100_000));
    let inner = city.streets.nodes().filter(|(_, n)| !n.data.cut);
    let (near, all) = inner.fold((0, 0), |(near, all), (_, n)| {
        (near + usize::from(off(n.at.x) <= 2 && off(n.at.y) <= 2), all + 1)
    });
    assert!(near * 10 >= all * 9, "{near} of {all}");
    let wrong = json!({ "areas": { "areas": [
        json!({ "use": "flat", "examples": {}, "starts": ["99,0"], "polygon": ring })
    ] } });
    assert!(grow(&example, square(Vec2::splat(500.0), 800.0), wrong, 1).is_err());
}
