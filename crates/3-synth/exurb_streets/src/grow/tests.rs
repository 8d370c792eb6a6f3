use std::sync::Arc;

use exurb_city::street_graph::{self, StreetGraph, shares_by_origin};
use exurb_city::{City, Class, ImportOptions, Junction, Role, Street};
use exurb_geom::{Bounds, Frame, GridPoint, Polygon, SegmentIndex, Vec2, trig};
use exurb_operation::{Example, Failure, Lines, Run, Scope, erase};
use proptest::prelude::*;
use serde_json::json;

use super::layer::{Layer, NodeKind};
use super::like::Fragment;
use super::{Params, detect, learn, patch};

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

/// Streets of the city that lie outside `area`, as lines, in order.
fn outside(city: &City, area: &Polygon) -> Vec<(Vec<GridPoint>, Street)> {
    let edges = city.streets.edges().map(|(_, e)| (e.line().to_vec(), e.data.clone()));
    let is_outside = |line: &[GridPoint]| {
        line.iter().all(|p| !area.contains(*p) && area.boundary_distance_m(p.to_m()) > 0.01)
    };
    let mut kept: Vec<_> = edges.filter(|(line, _)| is_outside(line)).collect();
    kept.sort_by(|a, b| a.0.cmp(&b.0));
    kept
}

#[test]
fn a_part_grown_anew_leaves_the_rest_as_it_is_and_joins_it() {
    let city = grid(16);
    // Obliquely across the blocks, so that most of its border meets streets anywhere.
    let corners = [(310.0, 420.0), (1130.0, 290.0), (1270.0, 1080.0), (440.0, 1210.0)];
    let ring = corners.map(|(x, y)| GridPoint::m(x, y)).to_vec();
    let area = Polygon::new(ring, vec![]).expect("has area");
    let mut example = grid(12);
    example.metadata.name = "other".into();
    let examples = [Example::new(example)];
    for seed in 1..4 {
        let document = serde_json::json!({ "rotate": 20.0 * seed as f64 });
        let outcome = erase::<super::Grow>()
            .run(&city, &Scope::Inside(area.clone()), &examples, document, &Run::new(seed))
            .expect("grows");
        let new = outcome.city;
        assert_lawful(&new);
        assert_eq!(outside(&city, &area), outside(&new, &area));
        let (copied, ..) = shares_by_origin(&new.streets);
        assert!(copied > 0.15, "{copied}");
        let border =
            new.streets.nodes().filter(|(_, n)| area.boundary_distance_m(n.at.to_m()) < 0.01);
        let degrees: Vec<usize> = border.map(|(id, _)| new.streets.degree(id)).collect();
        let joined = degrees.iter().filter(|d| **d > 1).count();
        assert!(joined * 2 > degrees.len(), "{joined} of {}", degrees.len());
    }
}

#[test]
fn no_street_lies_along_the_border_of_a_part_grown_anew() {
    // The border lies as the example's streets do, and cuts the city's streets slantwise.
    let turned = |p: &Vec2| trig::unit(0.14).rotate(*p);
    let lines = grid(16);
    let lines = lines.streets.edges().map(|(_, e)| {
        let line: Vec<Vec2> = e.line_m().iter().map(turned).collect();
        (exurb_geom::polyline::round(&line), e.data.clone())
    });
    let city = city_of(street_graph::from_lines(lines));
    let middle = city.target.bounds().center();
    let examples = [Example::new(grid(12))];
    for seed in 1..9 {
        let area = square(middle, 600.0 + 40.0 * seed as f64);
        let outcome = erase::<super::Grow>()
            .run(&city, &Scope::Inside(area.clone()), &examples, params(0.5), &Run::new(seed))
            .expect("grows");
        assert_lawful(&outcome.city);
        for (_, edge) in outcome.city.streets.edges() {
            let points = exurb_geom::polyline::resample(&edge.line_m(), 5.0);
            assert!(points.iter().any(|p| area.boundary_distance_m(*p) > 0.5), "seed {seed}");
        }
    }
}

#[test]
fn given_streets_stay_and_are_joined() {
    let sketched = |class| Street {
        class,
        provenance: exurb_city::Provenance::of(exurb_city::Origin::Sketch),
        ..Street::default()
    };
    let line = |points: &[(f64, f64)]| points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
    let given: Vec<(Vec<GridPoint>, Street)> = vec![
        (line(&[(100.0, 200.0), (700.0, 500.0), (1100.0, 1000.0)]), sketched(Class::Primary)),
        (line(&[(200.0, 1000.0), (500.0, 900.0)]), sketched(Class::Residential)),
    ];
    let example = grid(16);
    let mut empty = City::empty(example.frame.clone(), square(Vec2::splat(600.0), 1200.0));
    empty.streets = Arc::new(street_graph::from_lines(given.clone()));
    let city = erase::<super::Grow>()
        .run(&empty, &Scope::All, &[Example::new(example)], params(0.5), &Run::new(1))
        .expect("grows")
        .city;
    assert_lawful(&city);
    for (line, street) in given {
        let kept = city.streets.edges().filter(|(_, e)| {
            e.data.provenance.origin == exurb_city::Origin::Sketch && e.data.class == street.class
        });
        let length: f64 = kept.map(|(_, e)| e.length_m()).sum();
        let wanted =
            exurb_geom::polyline::length(&line.iter().map(|p| p.to_m()).collect::<Vec<_>>());
        assert!((length - wanted).abs() < 0.1, "{length} of {wanted} m");
        let along = city.streets.nodes().filter(|(id, n)| {
            let line: Vec<Vec2> = line.iter().map(|p| p.to_m()).collect();
            city.streets.degree(*id) > 2
                && exurb_geom::polyline::distance(&line, n.at.to_m()) < 0.01
        });
        assert!(along.count() > 1, "nothing joins a given street");
    }
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

/// An empty city with a river from south to north, 90 m wide, and hills in the east.
fn riverside(side_m: f64) -> City {
    let mut city = City::empty(Frame::null_island(), square(Vec2::splat(side_m / 2.0), side_m));
    let river = Polygon::rectangle(
        GridPoint::m(0.4 * side_m, -400.0),
        GridPoint::m(0.4 * side_m + 90.0, side_m + 400.0),
    );
    city.water = Arc::new(vec![exurb_city::Area { id: 1, polygon: river, class: "river".into() }]);
    let bounds = city.target.bounds().grown(400.0);
    // A ridge of 70 m, its flanks rising by a quarter.
    let height = |p: Vec2| (70.0 - (p.x - 0.8 * side_m).abs() * 0.25).max(0.0) as f32;
    city.lay(exurb_city::Terrain::over(bounds, 10.0, height).expect("small"));
    city
}

#[test]
fn streets_keep_out_of_water_and_off_steep_ground_and_cross_on_bridges() {
    let city = riverside(1800.0);
    let land = exurb_city::Land::of(&city);
    for seed in 1..3 {
        let document = serde_json::json!({ "grade": 0.15, "continuation": 0.4 });
        let grown = erase::<super::Grow>()
            .run(&city, &Scope::All, &[Example::new(grid(20))], document, &Run::new(seed))
            .expect("grows")
            .city;
        assert_lawful(&grown);
        let (mut bridges, mut banks) = (0, [0.0, 0.0]);
        for (_, edge) in grown.streets.edges() {
            let line = edge.line_m();
            if edge.data.bridge {
                assert_eq!(edge.data.provenance.origin, exurb_city::Origin::Bridge);
                assert_eq!(edge.data.layer, 1);
                bridges += 1;
                continue;
            }
            let places = exurb_geom::polyline::resample(&line, 5.0);
            assert!(places.iter().all(|p| !land.is_wet(*p)), "a street in water");
            banks[usize::from(line[0].x > 760.0)] += edge.length_m();
            let inside = |p: &Vec2| city.target.contains(GridPoint::round(*p));
            for w in places.windows(8).filter(|w| w.iter().all(inside)) {
                let rise = (land.height_m(w[7]) - land.height_m(w[0])).abs();
                assert!(rise <= 0.19 * 35.0, "rises by {rise} m over 35 m");
            }
        }
        assert!(bridges >= 1, "no bridge");
        assert!(banks.iter().all(|m| *m > 3000.0), "{banks:?}");
        let deck = grown.streets.nodes().filter(|(_, n)| (700.0..830.0).contains(&n.at.to_m().x));
        assert!(deck.count() >= 2);
    }
}

#[test]
fn a_target_in_the_sea_and_a_start_in_water_are_refused() {
    let mut city = riverside(1000.0);
    let wet = serde_json::json!({ "start": ["0.0039,0.004"] });
    let run = |city: &City, document| {
        let examples = [Example::new(grid(12))];
        erase::<super::Grow>().run(city, &Scope::All, &examples, document, &Run::new(1))
    };
    let error = run(&city, wet).unwrap_err().to_string();
    assert!(error.contains("lies in water"), "{error}");
    let sea = exurb_city::Area {
        id: 1,
        polygon: square(Vec2::splat(500.0), 3000.0),
        class: "sea".into(),
    };
    city.water = Arc::new(vec![sea]);
    let error = run(&city, serde_json::json!({})).unwrap_err().to_string();
    assert!(error.contains("the whole target lies in water"), "{error}");
}

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
    let city = erase::<super::Grow>()
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
    let error = erase::<super::Grow>()
        .run(&empty, &Scope::All, &examples, unknown, &Run::new(1))
        .unwrap_err();
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
    let graph = super::prepare::learnable(&grid(12).streets, &Arc::default());
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
    let graph = super::prepare::learnable(&street_graph::from_lines(lines), &Arc::default());
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
    let (example, found) = super::like::likest(found).expect("finds one");
    assert_eq!(example, 1);
    assert!((found.turn_rad - 0.6).abs() < 0.02 && found.apart_m < 10.0, "{found:?}");
    // Growth begins with that place, turned, where it was drawn.
    let params = json!({ "continuation": 1.0, "like": &drawn });
    let examples = cities.map(Example::new);
    let library = erase::<super::Grow>();
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
        erase::<super::Grow>().choose(city, &Scope::All, &library, params, &Run::new(1))
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
