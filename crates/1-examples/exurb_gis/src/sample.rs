//! Cities for tests: random ones with every kind of element, and large ones.

use std::sync::Arc;

use exurb_city::{
    Area, Block, BlockClass, Building, City, Class, Feature, FeatureShape, Junction, Origin,
    Parcel, Provenance, Roof, Street, StreetGraph, Terrain, Way,
};
use exurb_geom::{Frame, GridPoint, LonLat, Polygon};
use proptest::prelude::*;

use crate::numbered::numbered;

/// A street grid with a building and a tree in each of `n` times `n` cells of 50 m.
pub fn grid_city(n: usize) -> City {
    let frame = Frame::new(LonLat { lon: 24.94, lat: 60.17 }).expect("valid");
    let side = n as f64 * 50.0;
    let target = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(side, side));
    let mut city = City::empty(frame, target);
    let at = |i: usize, j: usize| GridPoint::m(i as f64 * 50.0, j as f64 * 50.0);
    let mut graph = StreetGraph::new();
    let nodes: Vec<_> = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (i, j)))
        .map(|(i, j)| graph.add_node(at(i, j), Junction::default()))
        .collect();
    for j in 0..=n {
        for i in 0..n {
            for (a, b) in
                [(j * (n + 1) + i, j * (n + 1) + i + 1), (i * (n + 1) + j, (i + 1) * (n + 1) + j)]
            {
                let street = Street { name: Some("Gridgatan".into()), ..Street::default() };
                graph.add_edge(nodes[a], nodes[b], Vec::new(), street);
            }
        }
    }
    let (mut buildings, mut features) = (Vec::new(), Vec::new());
    for j in 0..n {
        for i in 0..n {
            let (a, id) = (at(i, j), (j * n + i + 1) as u32);
            let corner = |d: i32| GridPoint { x: a.x + d, y: a.y + d };
            let mut building = Building::new(
                id,
                Polygon::rectangle(corner(10_000), corner(25_000)),
                Provenance::default(),
            );
            building.height_m = Some(7.3);
            buildings.push(building);
            let (kind, shape) = ("tree".into(), FeatureShape::Point(corner(5_000)));
            features.push(Feature { id, kind, shape, block: 0, provenance: Provenance::default() });
        }
    }
    city.streets = Arc::new(graph);
    city.buildings = Arc::new(buildings);
    city.features = Arc::new(features);
    city
}

fn point() -> impl Strategy<Value = GridPoint> {
    (-2_000_000..2_000_000, -2_000_000..2_000_000).prop_map(|(x, y)| GridPoint { x, y })
}

fn line() -> impl Strategy<Value = Vec<GridPoint>> {
    prop::collection::vec(point(), 2..6)
        .prop_filter("points differ", |line| line.windows(2).all(|w| w[0].distance_m(w[1]) > 0.1))
}

fn polygon() -> impl Strategy<Value = Polygon> {
    (point(), 1_000..90_000, 1_000..90_000, any::<bool>()).prop_map(|(a, w, h, hole)| {
        let at = |x: i32, y: i32| GridPoint { x: a.x + x, y: a.y + y };
        let outer =
            vec![at(0, 0), at(w, 0), at(w, h), at(w / 2, h), at(w / 2, h / 2), at(0, h / 2)];
        let (a, b, c) = (at(w / 8, h / 8), at(w / 4, h / 8), at(w / 4, h / 4));
        Polygon::new(outer, if hole { vec![vec![a, b, c]] } else { vec![] }).expect("has area")
    })
}

fn text() -> impl Strategy<Value = Option<Arc<str>>> {
    prop::option::of("[a-zäß\"'<&\\\\\n 0-9]{0,9}").prop_map(|t| t.map(Arc::from))
}

fn provenance() -> impl Strategy<Value = Provenance> {
    (prop::sample::select(&Origin::ALL[..]), text(), text())
        .prop_map(|(origin, source, part)| Provenance { origin, source, part })
}

fn street() -> impl Strategy<Value = Street> {
    let look = (prop::sample::select(&Class::ALL[..]), 0..9_u8, 0..9_u8, 0..200_u32);
    let flags = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), -3..4_i8);
    (look, flags, text(), provenance()).prop_map(|(look, flags, name, provenance)| Street {
        class: look.0,
        level: look.1,
        lanes: look.2,
        width_m: f64::from(look.3) / 7.0,
        oneway: flags.0,
        bridge: flags.1,
        tunnel: flags.2,
        roundabout: flags.3,
        layer: flags.4,
        name,
        provenance,
    })
}

/// Graphs with parallel edges, loops, dead ends, and a gap in their ids.
fn graph() -> impl Strategy<Value = StreetGraph> {
    let nodes = prop::collection::vec((point(), any::<bool>(), -9.0..9.0), 1..8);
    let edges = prop::collection::vec((0..8_usize, 0..8_usize, line(), street()), 0..12);
    (nodes, edges).prop_map(|(nodes, edges)| {
        let mut graph = StreetGraph::new();
        let ids: Vec<_> = nodes
            .iter()
            .map(|(at, cut, z_m)| graph.add_node(*at, Junction { cut: *cut, z_m: *z_m }))
            .collect();
        for (a, b, line, street) in edges {
            graph.add_edge(ids[a % ids.len()], ids[b % ids.len()], line, street);
        }
        let first = graph.edges().next().map(|(id, _)| id);
        if let Some(first) = first {
            graph.remove_edge(first);
        }
        graph.remove_isolated_nodes();
        graph
    })
}

fn block() -> impl Strategy<Value = (Polygon, f64, f64, Option<Arc<str>>, bool, Provenance)> {
    (polygon(), 1.0..9e4, 0.0..5.0, text(), any::<bool>(), provenance())
}

fn building() -> impl Strategy<Value = Building> {
    let sizes = (prop::option::of(1.0..99.0), 0.0..3.0, prop::option::of(0.5..9.0));
    let roof = prop::option::of(prop::sample::select(&Roof::ALL[..]));
    let places = (0..9_u32, 0..9_u32, any::<bool>());
    (polygon(), sizes, roof, text(), places, provenance()).prop_map(
        |(polygon, sizes, roof, usage, places, provenance)| Building {
            height_m: sizes.0,
            min_height_m: sizes.1,
            levels: sizes.2,
            roof,
            usage,
            block: places.0,
            parcel: places.1,
            is_part: places.2,
            ..Building::new(0, polygon, provenance)
        },
    )
}

fn feature() -> impl Strategy<Value = Feature> {
    let shape = prop_oneof![
        point().prop_map(FeatureShape::Point),
        line().prop_map(FeatureShape::Line),
        polygon().prop_map(FeatureShape::Polygon),
    ];
    (prop::sample::select(&["tree", "lamp", "playground"][..]), shape, 0..9_u32, provenance())
        .prop_map(|(kind, shape, block, provenance)| Feature {
            id: 0,
            kind: kind.into(),
            shape,
            block,
            provenance,
        })
}

fn parcel() -> impl Strategy<Value = Parcel> {
    (polygon(), 0..9_u32, any::<bool>(), text(), provenance()).prop_map(
        |(polygon, block, street_access, land_use, provenance)| Parcel {
            id: 0,
            block,
            polygon,
            street_access,
            land_use,
            provenance,
        },
    )
}

fn areas() -> impl Strategy<Value = Vec<Area>> {
    prop::collection::vec((polygon(), "[a-z]{1,6}"), 0..3).prop_map(|areas| {
        let area = |((polygon, class), id): ((Polygon, String), u32)| Area {
            id,
            polygon,
            class: class.into(),
        };
        areas.into_iter().zip(1..).map(area).collect()
    })
}

fn way() -> impl Strategy<Value = Way> {
    (any::<i64>(), line(), prop::collection::vec(any::<i64>(), 0..3), street()).prop_map(
        |(id, line, nodes, street)| Way {
            id,
            line,
            nodes,
            street: Street { class: Class::Service, ..street },
        },
    )
}

/// A terrain, with a gap here and there, of one tile or several.
pub fn terrain() -> impl Strategy<Value = Terrain> {
    let height = prop_oneof![9 => -500.0..9000.0_f32, 1 => Just(f32::NAN)];
    let heights = prop::collection::vec(height, 600..700);
    let place = (point(), 1_u32..50_000, prop::sample::select(&[2_usize, 3, 25, 300][..]));
    (heights, place, prop::option::of(-9.0..9.0)).prop_map(
        |(mut heights, (first, cell_mm, columns), level)| {
            heights.truncate(heights.len() / columns * columns);
            heights[0] = 1.5;
            let terrain =
                Terrain::new(first, cell_mm, columns, heights).expect("a height is known");
            terrain.with_water_level(level)
        },
    )
}

/// Any city, with ids from 1 in every layer.
pub fn any_city() -> impl Strategy<Value = City> {
    let place = (-180.0..180.0, -80.0..80.0_f64);
    let streets = (graph(), prop::collection::vec(way(), 0..3));
    let ground = (prop::collection::vec(block(), 0..3), prop::collection::vec(parcel(), 0..3));
    let built = (prop::collection::vec(building(), 0..4), prop::collection::vec(feature(), 0..4));
    let meta =
        (text(), text(), prop::collection::btree_map("[a-z]{1,5}", -9.0..9.0, 0..3), any::<bool>());
    (place, polygon(), streets, ground, built, (areas(), areas()), meta).prop_map(
        |(place, target, streets, ground, built, areas, meta)| {
            let frame = Frame::new(LonLat { lon: place.0, lat: place.1 }).expect("valid");
            let mut city = City::empty(frame, target);
            let sides: Vec<_> = streets.0.edges().map(|(id, _)| id).collect();
            city.blocks = Arc::new(
                ground.0.into_iter().zip(1..).map(|(b, id)| any_block(b, id, &sides)).collect(),
            );
            city.streets = Arc::new(streets.0);
            city.other_ways = Arc::new(streets.1);
            city.parcels =
                Arc::new(ground.1.into_iter().zip(1..).map(|(p, id)| Parcel { id, ..p }).collect());
            city.buildings = Arc::new(
                built.0.into_iter().zip(1..).map(|(b, id)| Building { id, ..b }).collect(),
            );
            city.features =
                Arc::new(built.1.into_iter().zip(1..).map(|(f, id)| Feature { id, ..f }).collect());
            (city.water, city.land_use) = (Arc::new(areas.0), Arc::new(areas.1));
            city.metadata.name = meta.0.unwrap_or_default();
            city.metadata.attribution = vec!["© Somebody, a licence".to_owned()];
            city.metadata.recipe = meta.1.unwrap_or_default().to_string();
            city.metadata.example_gates = meta.2;
            city.metadata.buildings_complete = meta.3;
            city
        },
    )
}

fn any_block(
    (polygon, face_area_m2, pavement_m, land_use, island, provenance): (
        Polygon,
        f64,
        f64,
        Option<Arc<str>>,
        bool,
        Provenance,
    ),
    id: u32,
    streets: &[exurb_graph::EdgeId],
) -> Block {
    let (sides, dead_ends) = streets.split_at(streets.len() / 2);
    Block {
        id,
        polygon,
        face_area_m2,
        pavement_m,
        land_use,
        class: if island { BlockClass::Island } else { BlockClass::Block },
        sides: sides.to_vec(),
        dead_ends: dead_ends.to_vec(),
        provenance,
    }
}

/// Fails where the cities differ; gaps in the numbers of streets do not count.
pub fn assert_same(a: &City, b: &City) {
    let (a, b) = (numbered(a), numbered(b));
    assert_eq!(a.frame, b.frame);
    assert_eq!(a.target, b.target);
    assert_eq!(a.streets, b.streets);
    assert_eq!(a.other_ways, b.other_ways);
    assert_eq!(a.blocks, b.blocks);
    assert_eq!(a.parcels, b.parcels);
    assert_eq!(a.buildings, b.buildings);
    assert_eq!(a.features, b.features);
    assert_eq!(a.water, b.water);
    assert_eq!(a.land_use, b.land_use);
    assert_eq!(a.terrain, b.terrain);
    assert_eq!(a.metadata, b.metadata);
}
