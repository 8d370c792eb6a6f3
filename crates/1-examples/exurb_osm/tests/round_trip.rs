//! What is written is read back: topology, tags, places.

mod shared;

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::street_graph;
use exurb_city::{Area, Building, City, Class, Feature, FeatureShape, ImportOptions, Junction};
use exurb_city::{Origin, Provenance, Roof, Street, StreetGraph};
use exurb_geom::{Frame, GridPoint, LonLat, Polygon};
use exurb_osm::{Format, read_bytes};
use proptest::prelude::*;

fn xml(city: &City) -> Vec<u8> {
    let mut out = Vec::new();
    exurb_osm::write_xml(city, &mut out).expect("memory is writable");
    out
}

fn pbf(city: &City) -> Vec<u8> {
    let mut out = Vec::new();
    exurb_osm::write_pbf(city, &mut out).expect("memory is writable");
    out
}

fn read(bytes: &[u8], format: Format) -> City {
    read_bytes(bytes, "city.osm", Some(format), &ImportOptions::default()).expect("valid").city
}

/// The XML without bounds, so that reading cuts nothing.
fn unbounded(city: &City) -> Vec<u8> {
    let text = String::from_utf8(xml(city)).expect("text");
    let kept: Vec<&str> = text.lines().filter(|l| !l.contains("<bounds")).collect();
    kept.join("\n").into_bytes()
}

/// A grid of `n` x `n` streets bent at random, with every tag somewhere.
fn town(n: i32, bends: &[i32]) -> City {
    let frame = Frame::new(LonLat { lon: 24.94, lat: 60.17 }).expect("valid");
    let side = 90_000;
    let bend = |i: usize| bends[i % bends.len()];
    let mut streets = StreetGraph::new();
    let mut nodes = BTreeMap::new();
    for y in 0..n {
        for x in 0..n {
            let k = (y * n + x) as usize;
            let at = GridPoint { x: x * side + bend(k), y: y * side + bend(k + 7) };
            nodes.insert((x, y), streets.add_node(at, Junction::default()));
        }
    }
    let mut count = 0;
    for y in 0..n {
        for x in 0..n {
            for (u, v) in [(x + 1, y), (x, y + 1)] {
                let (Some(a), Some(b)) = (nodes.get(&(x, y)), nodes.get(&(u, v))) else { continue };
                let (p, q) = (streets.node(*a).at, streets.node(*b).at);
                let middle = GridPoint {
                    x: (p.x + q.x) / 2 + bend(count),
                    y: (p.y + q.y) / 2 + bend(count + 3),
                };
                streets.add_edge(*a, *b, vec![p, middle, q], street(count, u == x));
                count += 1;
            }
        }
    }
    let target = Polygon::rectangle(
        GridPoint { x: -200_000, y: -200_000 },
        GridPoint { x: n * side + 200_000, y: n * side + 200_000 },
    );
    let mut city = City::empty(frame, target);
    city.streets = Arc::new(streets);
    city.metadata.attribution = vec!["somebody's survey".to_owned()];
    furnish(&mut city);
    city
}

/// Along and across differ in class, so that no two streets become one at a corner.
fn street(i: usize, across: bool) -> Street {
    let i32 = i as i32;
    Street {
        class: Class::ALL[2 * i % 14 + usize::from(across)],
        lanes: (i % 5) as u8,
        width_m: f64::from(i32 % 7) * 1.25,
        oneway: i.is_multiple_of(3),
        bridge: i % 11 == 5,
        tunnel: i % 13 == 6,
        layer: (i32 % 5 - 2) as i8,
        roundabout: i % 17 == 8,
        name: i.is_multiple_of(2).then(|| Arc::from(format!("Street & \"{i}\" <ä>"))),
        ..Street::default()
    }
}

fn furnish(city: &mut City) {
    let imported = Provenance::of(Origin::Imported);
    let square = |x: f64, y: f64, side: f64| {
        Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + side, y + side))
    };
    let mut house = Building::new(1, square(20.0, 20.0, 15.0), imported.clone());
    house.height_m = Some(12.5);
    house.levels = Some(4.0);
    house.roof = Some(Roof::HalfHipped);
    house.usage = Some("house".into());
    let court = square(108.0, 8.0, 5.0).exterior().to_vec();
    let ring = square(105.0, 5.0, 30.0).exterior().to_vec();
    let block = Polygon::new(ring, vec![court]).expect("has area");
    let mut part = Building::new(3, square(22.0, 22.0, 5.0), imported.clone());
    part.is_part = true;
    part.min_height_m = 12.5;
    city.buildings = Arc::new(vec![house, Building::new(2, block, imported.clone()), part]);
    let area =
        |class: &str, x| Area { id: 1, polygon: square(x, 150.0, 20.0), class: class.into() };
    city.water = Arc::new(vec![area("lake", 20.0), area("water", 50.0)]);
    city.land_use = Arc::new(vec![area("park", 110.0), area("wood", 140.0), area("retail", 200.0)]);
    let feature = |kind: &str, shape| Feature {
        id: 1,
        kind: kind.into(),
        shape,
        block: 0,
        provenance: imported.clone(),
    };
    city.features = Arc::new(vec![
        feature("tree", FeatureShape::Point(GridPoint::m(12.0, 13.0))),
        feature("lamp", FeatureShape::Point(GridPoint::m(14.0, 13.0))),
        feature("hedge", FeatureShape::Line(vec![GridPoint::m(1.0, 9.0), GridPoint::m(9.0, 12.0)])),
        feature("playground", FeatureShape::Polygon(square(170.0, 15.0, 9.0))),
    ]);
}

/// The street graph as reading knows it: nodes of degree 2 dissolved, nothing but imported.
fn as_imported(graph: &StreetGraph) -> StreetGraph {
    let mut out = graph.clone();
    let ids: Vec<_> = out.edges().map(|(id, _)| id).collect();
    for id in ids {
        let street = &mut out.edge_mut(id).data;
        street.provenance = Provenance::default();
        street.level = 0;
    }
    street_graph::dissolve_all(&mut out);
    out.compacted()
}

/// Do the graphs have the same nodes within 2 cm, joined by like streets of the same length?
fn assert_same_streets(given: &StreetGraph, from: &City, back: &City) {
    let read = &back.streets;
    assert_eq!(given.node_count(), read.node_count());
    assert_eq!(given.edge_count(), read.edge_count());
    let mut index = exurb_geom::PointIndex::new(1.0);
    for (id, node) in read.nodes() {
        index.insert(id.0, node.at.to_m());
    }
    let twin = |id| {
        // The frames have other origins and norths.
        let at = back.frame.project(from.frame.unproject(given.node(id).at.to_m())).expect("near");
        index.within(at, 0.02).into_iter().map(|(n, _)| exurb_graph::NodeId(n)).collect::<Vec<_>>()
    };
    for (_, edge) in given.edges() {
        let (from, to) = (twin(edge.from), twin(edge.to));
        assert!(!from.is_empty() && !to.is_empty(), "a node moved by over 2 cm");
        let like = read.edges().find(|(_, e)| {
            let same = (from.contains(&e.from) && to.contains(&e.to))
                || (!edge.data.oneway && from.contains(&e.to) && to.contains(&e.from));
            // The level in the hierarchy is no tag; it is found anew.
            let data = Street { level: 0, ..e.data.clone() };
            same && data == edge.data && (e.length_m() - edge.length_m()).abs() < 0.05
        });
        assert!(like.is_some(), "no street like {:?} of {} m", edge.data, edge.length_m());
    }
}

fn assert_same_rest(given: &City, read: &City) {
    let tags =
        |b: &Building| (b.height_m, b.levels, b.roof, b.usage.clone(), b.is_part, b.min_height_m);
    let sorted = |city: &City| {
        let mut out: Vec<String> =
            city.buildings.iter().map(|b| format!("{:?}", tags(b))).collect();
        out.sort();
        out
    };
    assert_eq!(sorted(given), sorted(read));
    let size = |b: &Building| b.polygon.area_m2();
    let total = |city: &City| city.buildings.iter().map(size).sum::<f64>();
    assert!((total(given) - total(read)).abs() < 2.0 * given.buildings.len() as f64);
    let classes = |areas: &[Area]| {
        let mut out: Vec<_> = areas.iter().map(|a| a.class.clone()).collect();
        out.sort();
        out
    };
    assert_eq!(classes(&given.water), classes(&read.water));
    assert_eq!(classes(&given.land_use), classes(&read.land_use));
    let kinds = |city: &City| {
        let mut out: Vec<_> = city
            .features
            .iter()
            .map(|f| (f.kind.clone(), std::mem::discriminant(&f.shape)))
            .map(|(kind, shape)| format!("{kind} {shape:?}"))
            .collect();
        out.sort();
        out
    };
    assert_eq!(kinds(given), kinds(read));
    assert_eq!(given.metadata.attribution, read.metadata.attribution);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..Default::default() })]

    #[test]
    fn a_town_comes_back_from_both_formats(
        n in 2i32..6,
        bends in prop::collection::vec(-20_000i32..20_000, 5..40),
    ) {
        let city = town(n, &bends);
        let given = as_imported(&city.streets);
        for back in [read(&xml(&city), Format::Xml), read(&pbf(&city), Format::Pbf)] {
            assert_same_streets(&given, &city, &back);
            assert_same_rest(&city, &back);
        }
    }
}

#[test]
fn streets_past_the_target_come_back_and_their_ends_are_cut() {
    let mut city = town(4, &[0]);
    // A target with a yard, inside the streets.
    let square = |low: f64, high: f64| {
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        corners.map(|(x, y)| GridPoint::m(x, y)).to_vec()
    };
    city.target = Polygon::new(square(20.0, 250.0), vec![square(100.0, 140.0)]).expect("area");
    let mut streets = (*city.streets).clone();
    let stub = GridPoint::m(-60.0, 0.0);
    let corner = streets.nodes().find(|(_, n)| n.at == GridPoint::m(0.0, 0.0)).expect("there").0;
    let outside = streets.add_node(stub, Junction { cut: true, ..Junction::default() });
    streets.add_edge(outside, corner, Vec::new(), Street::default());
    city.streets = Arc::new(streets);
    let given = as_imported(&city.streets);
    for back in [read(&xml(&city), Format::Xml), read(&pbf(&city), Format::Pbf)] {
        assert_same_streets(&given, &city, &back);
        let cut = back.streets.nodes().filter(|(_, node)| node.data.cut).count();
        assert_eq!(cut, 1);
        assert_eq!(back.target.interiors().len(), 1);
        assert!((back.target.area_m2() - city.target.area_m2()).abs() < 20.0);
        // Asked for a part, the rest goes as ever.
        let bytes = xml(&city);
        let part = ImportOptions { part: Some(exurb_city::Part::West), ..Default::default() };
        let half = read_bytes(&bytes, "city.osm", None, &part).expect("valid").city;
        assert!(half.streets.length_m() < back.streets.length_m() / 2.0);
    }
}

#[test]
fn equal_cities_are_equal_files() {
    let bends = [100, -7_000, 3_333];
    assert_eq!(xml(&town(4, &bends)), xml(&town(4, &bends)));
    assert_eq!(pbf(&town(4, &bends)), pbf(&town(4, &bends)));
}

#[test]
fn a_bridge_over_a_street_stays_apart_although_vertices_coincide() {
    let mut city = town(2, &[0]);
    let mut streets = StreetGraph::new();
    let point = |x, y| GridPoint::m(x, y);
    let mut add = |points: [(f64, f64); 3], bridge| {
        let line: Vec<GridPoint> = points.iter().map(|(x, y)| point(*x, *y)).collect();
        let (a, b) = (line[0], line[2]);
        let from = streets.add_node(a, Junction::default());
        let to = streets.add_node(b, Junction::default());
        streets.add_edge(from, to, line, Street { bridge, ..Street::default() });
    };
    add([(0.0, 50.0), (50.0, 50.0), (100.0, 50.0)], false);
    add([(50.0, 0.0), (50.0, 50.0), (50.0, 100.0)], true);
    city.streets = Arc::new(streets);
    assert_eq!(read(&pbf(&city), Format::Pbf).streets.edge_count(), 2);
}

#[test]
fn a_real_city_comes_back_and_both_formats_agree() {
    for stem in ["tokyo_ichigaya", "munich_center", "duesseldorf_bilk", "copenhagen_east"] {
        let Some(path) = shared::map(stem) else { return };
        let city = exurb_osm::read(&path, &ImportOptions::default()).expect(stem).city;
        // Differential: the readers share nothing before the list of elements.
        let (by_xml, by_pbf) = (read(&xml(&city), Format::Xml), read(&pbf(&city), Format::Pbf));
        assert_eq!(by_xml.streets, by_pbf.streets, "{stem}");
        assert_eq!(by_xml.other_ways, by_pbf.other_ways, "{stem}");
        assert_eq!(by_xml.buildings, by_pbf.buildings, "{stem}");
        assert_eq!(by_xml.blocks, by_pbf.blocks, "{stem}");
        assert_eq!(by_xml.features, by_pbf.features, "{stem}");
        assert_eq!((&by_xml.water, &by_xml.land_use), (&by_pbf.water, &by_pbf.land_use), "{stem}");
        assert_eq!(by_xml.target, by_pbf.target, "{stem}");

        // Uncut, the streets are the same again.
        let back = read(&unbounded(&city), Format::Xml);
        let (given, read) = (as_imported(&city.streets), as_imported(&back.streets));
        let km = |g: &StreetGraph| g.length_m() / 1000.0;
        assert!((km(&given) / km(&read) - 1.0).abs() < 1e-4, "{stem}");
        let near = |a: usize, b: usize| a.abs_diff(b) * 200 <= a;
        assert!(near(given.node_count(), read.node_count()), "{stem}");
        assert!(near(given.edge_count(), read.edge_count()), "{stem}");
        assert!(near(city.buildings.len(), back.buildings.len()), "{stem}");
    }
}
