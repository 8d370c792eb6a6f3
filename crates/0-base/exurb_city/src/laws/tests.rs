use std::sync::Arc;

use exurb_geom::{Frame, GridPoint, Polygon};

use super::{LawReport, gates, laws};
use crate::{
    Block, BlockClass, Building, City, Class, Origin, Parcel, Provenance, Street, StreetGraph,
    street_graph,
};

type Line<'a> = &'a [(f64, f64)];

fn graph(lines: &[Line]) -> StreetGraph {
    graph_of(lines.iter().map(|line| (*line, Street::default())))
}

fn graph_of<'a>(lines: impl IntoIterator<Item = (Line<'a>, Street)>) -> StreetGraph {
    street_graph::from_lines(
        lines.into_iter().map(|(line, street)| {
            (line.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), street)
        }),
    )
}

/// A city over the square from -500 to 500 m.
fn city(streets: StreetGraph) -> City {
    let mut city = City::empty(Frame::null_island(), rectangle(-500., -500., 500., 500.));
    city.streets = Arc::new(streets);
    city
}

fn rectangle(w: f64, s: f64, e: f64, n: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(w, s), GridPoint::m(e, n))
}

fn count(report: &LawReport, law: &str) -> usize {
    report.get(law).unwrap_or_else(|| panic!("no law {law}")).count
}

/// A square of streets of 100 m with a cross inside, noded.
fn window() -> StreetGraph {
    graph(&[
        &[(0., 0.), (50., 0.)],
        &[(50., 0.), (100., 0.), (100., 50.)],
        &[(100., 50.), (100., 100.), (50., 100.)],
        &[(50., 100.), (0., 100.), (0., 50.)],
        &[(0., 50.), (0., 0.)],
        &[(0., 50.), (50., 50.)],
        &[(50., 50.), (100., 50.)],
        &[(50., 0.), (50., 50.)],
        &[(50., 50.), (50., 100.)],
    ])
}

#[test]
fn a_noded_square_keeps_all_laws() {
    let report = laws(&city(window()));
    assert!(report.is_valid(), "{:?}", report.breaches);
    assert_eq!(report.laws.len(), 18);
}

#[test]
fn an_empty_city_breaks_no_law() {
    assert!(laws(&city(StreetGraph::new())).is_valid());
}

#[test]
fn a_crossing_counts_on_one_level_only() {
    let cross: [Line; 2] = [&[(-50., 0.), (50., 0.)], &[(0., -50.), (0., 50.)]];
    let report = laws(&city(graph(&cross)));
    // One crossing on 0.2 km of streets.
    assert_eq!(report.get("crossings_without_node").and_then(|l| l.value), Some(500.0));
    assert_eq!(report.breaches[0].at, GridPoint::m(0., 0.));
    let bridge = Street { bridge: true, ..Street::default() };
    let over = graph_of([(cross[0], Street::default()), (cross[1], bridge)]);
    assert_eq!(count(&laws(&city(over)), "crossings_without_node"), 0);
}

#[test]
fn ends_and_bends_that_touch_a_street_are_found() {
    let tee = graph(&[&[(-50., 0.), (50., 0.)], &[(0., 0.01), (0., 50.)]]);
    assert_eq!(count(&laws(&city(tee)), "touching_vertices"), 1);
    let bend = graph(&[&[(-50., 0.), (50., 0.)], &[(-30., 50.), (0., 0.), (30., 50.)]]);
    assert_eq!(count(&laws(&city(bend)), "touching_vertices"), 1);
    let clear = graph(&[&[(-50., 0.), (50., 0.)], &[(0., 0.03), (0., 50.)]]);
    assert_eq!(count(&laws(&city(clear)), "touching_vertices"), 0);
}

#[test]
fn a_loop_is_sound_and_an_eight_is_not() {
    let ring = graph(&[&[(0., 0.), (50., 0.), (50., 50.), (0., 50.), (0., 0.)]]);
    assert_eq!(count(&laws(&city(ring)), "self_intersecting_edges"), 0);
    let eight = graph(&[&[(0., 0.), (50., 50.), (50., 0.), (0., 50.)]]);
    assert_eq!(count(&laws(&city(eight)), "self_intersecting_edges"), 1);
    let fold = graph(&[&[(0., 0.), (50., 0.), (20., 0.)]]);
    assert_eq!(count(&laws(&city(fold)), "self_intersecting_edges"), 1);
}

#[test]
fn what_is_delivered_twice_counts_by_length() {
    let lines: [Line; 2] = [&[(0., 0.), (60., 0.), (60., 40.)], &[(60., 0.), (0., 0.), (0., 40.)]];
    let report = laws(&city(graph(&lines)));
    let share = report.get("duplicate_length_share").and_then(|l| l.value).unwrap();
    assert!((share - 60.0 / 200.0).abs() < 1e-12);
}

#[test]
fn streets_side_by_side_overlap_unless_copied_together() {
    let pair: [Line; 2] = [&[(0., 0.), (200., 0.)], &[(0., 2.), (200., 2.)]];
    assert_eq!(laws(&city(graph(&pair))).get("overlap_share").unwrap().value, Some(1.0));
    let part = Some(Arc::from("7"));
    let copied = Provenance { origin: Origin::Example, source: None, part };
    let street = Street { provenance: copied, ..Street::default() };
    let together = graph_of(pair.map(|line| (line, street.clone())));
    assert_eq!(laws(&city(together)).get("overlap_share").unwrap().value, Some(0.0));
}

#[test]
fn an_island_touches_neither_the_border_nor_the_largest_component() {
    let streets =
        graph(&[&[(0., 0.), (0., 300.)], &[(50., 0.), (50., 60.)], &[(300., 0.), (600., 0.)]]);
    let report = laws(&city(streets));
    // The third street is cut at 500 m and so runs on.
    let share = |law: &str| report.get(law).unwrap().value.unwrap();
    assert!((share("largest_component_share") - 300.0 / 560.0).abs() < 1e-9);
    assert!((share("island_share") - 60.0 / 560.0).abs() < 1e-9);
    assert_eq!(count(&report, "largest_component_share"), 2);
}

#[test]
fn stars_and_stubs_are_counted() {
    let spokes: Vec<Vec<(f64, f64)>> = (0..6)
        .map(|i| {
            let at = exurb_geom::trig::unit(f64::from(i)) * if i == 0 { 4.0 } else { 90.0 };
            vec![(0., 0.), (at.x, at.y)]
        })
        .collect();
    let lines: Vec<Line> = spokes.iter().map(|l| &l[..]).collect();
    let report = laws(&city(graph(&lines)));
    assert_eq!(count(&report, "degree_6_share"), 1);
    assert_eq!(report.get("short_edge_share").unwrap().value, Some(1.0 / 6.0));
}

fn block(id: u32, polygon: Polygon) -> Block {
    Block {
        id,
        face_area_m2: polygon.area_m2(),
        pavement_m: 2.0,
        land_use: None,
        class: BlockClass::Block,
        sides: Vec::new(),
        dead_ends: Vec::new(),
        provenance: Provenance::default(),
        polygon,
    }
}

fn parcel(id: u32, polygon: Polygon, street_access: bool) -> Parcel {
    let provenance = Provenance::default();
    Parcel { id, block: 1, polygon, street_access, land_use: None, provenance }
}

#[test]
fn parcels_tile_their_block_less_the_pavement() {
    let mut city = city(StreetGraph::new());
    city.blocks = Arc::new(vec![block(1, rectangle(0., 0., 104., 54.))]);
    let halves = |gap: f64| {
        vec![
            parcel(1, rectangle(2., 2., 52., 52.), true),
            parcel(2, rectangle(52. + gap, 2., 102., 52.), true),
        ]
    };
    city.parcels = Arc::new(halves(0.0));
    assert!(laws(&city).is_valid(), "{:?}", laws(&city).breaches);
    city.parcels = Arc::new(halves(1.0));
    let report = laws(&city);
    assert!((report.get("parcels_tile_block").unwrap().value.unwrap() - 0.01).abs() < 1e-6);
    city.parcels = Arc::new(halves(-1.0));
    assert_eq!(count(&laws(&city), "parcels_overlapping"), 2);
    let locked = halves(0.0).into_iter().map(|p| Parcel { street_access: p.id == 1, ..p });
    city.parcels = Arc::new(locked.collect());
    assert_eq!(laws(&city).get("street_access_share").unwrap().value, Some(0.5));
}

#[test]
fn buildings_stand_apart_inside_their_block_and_off_the_street() {
    let mut city = city(graph(&[&[(-50., 20.), (200., 20.)]]));
    city.blocks = Arc::new(vec![block(1, rectangle(0., 30., 100., 100.))]);
    let building = |id, polygon| Building::new(id, polygon, Provenance::default());
    let row = vec![
        building(1, rectangle(10., 40., 20., 50.)),
        building(2, rectangle(20., 40., 30., 50.)), // shares a wall
        building(3, rectangle(25., 49., 35., 60.)), // 5 m² of the second
        building(4, rectangle(90., 80., 101., 90.)), // 10 m² outside
        building(5, rectangle(110., 10., 120., 30.)), // in no block, on the street
    ];
    city.buildings = Arc::new(row);
    let report = laws(&city);
    let ids = |law: &str| -> Vec<u32> {
        report.breaches.iter().filter(|b| b.law == law).map(|b| b.id).collect()
    };
    assert_eq!(ids("buildings_overlapping"), [2, 3]);
    assert_eq!(ids("buildings_outside_block"), [4]);
    assert_eq!(ids("buildings_crossed_by_street"), [5]);
    assert_eq!(ids("invalid_buildings"), []);
}

#[test]
fn a_building_around_a_hole_of_its_block_is_outside() {
    let mut city = city(StreetGraph::new());
    let outer = rectangle(0., 0., 100., 100.);
    let hole = rectangle(45., 45., 55., 55.).exterior().to_vec();
    let ring = Polygon::new(outer.exterior().to_vec(), vec![hole]).unwrap();
    city.blocks = Arc::new(vec![block(1, ring)]);
    let mut over = Building::new(1, rectangle(30., 30., 70., 70.), Provenance::default());
    over.block = 1;
    city.buildings = Arc::new(vec![over]);
    assert_eq!(count(&laws(&city), "buildings_outside_block"), 1);
}

#[test]
fn gates_leave_out_what_the_border_cuts() {
    let mut streets = vec![Street::default(); 3];
    streets[2].class = Class::Tertiary; // a change of class is no node that counts
    let lines: [Line; 3] =
        [&[(0., 0.), (0., 100.)], &[(0., 0.), (-100., 0.)], &[(0., 0.), (600., 0.)]];
    let values = gates(&city(graph_of(lines.into_iter().zip(streets))));
    // Two dead ends and a junction; the third end is cut.
    assert!((values["dead_end_share"] - 2.0 / 3.0).abs() < 1e-12);
    assert_eq!(values["near_miss_share"], 0.0);
    assert_eq!(values["legs_under_30"], 0.0);
    assert!(!values.contains_key("slivers_per_100_blocks"));
}

#[test]
fn narrow_legs_slivers_and_near_misses_are_measured() {
    let values = gates(&city(graph(&[
        &[(0., 0.), (100., 0.)],
        &[(0., 0.), (100., 20.)],
        &[(100., 0.), (100., 20.)],
        &[(0., 0.), (-80., 0.)],
        &[(-80., 0.), (-80., -70.)],
        &[(-80., -70.), (0., -70.)],
        &[(0., -70.), (0., 0.)],
        &[(0., -70.), (50., -70.), (50., -9.)],
    ])));
    // Junctions at (0, 0) and (0, -70); the wedge at (0, 0) is 11.3° wide and 9 m on average.
    assert_eq!((values["legs_under_15"], values["legs_under_30"]), (0.5, 0.5));
    assert_eq!(values["slivers_per_100_blocks"], 100.0);
    assert_eq!(values["near_miss_share"], 1.0);
}

#[test]
fn gates_compare_with_an_example_and_without_one_they_are_open() {
    let values: std::collections::BTreeMap<String, f64> =
        gates::NAMES.iter().map(|name| ((*name).to_owned(), 0.1)).collect();
    let alone = super::compare_gates(&values, None);
    assert!(alone.values().all(|g| g.value == Some(0.1) && g.limit.is_none() && g.pass.is_none()));
    assert!(super::compare_gates(&values, Some(&values)).values().all(|g| g.pass == Some(true)));
    let few = [("dead_end_share".to_owned(), 0.26)].into_iter().collect();
    assert_eq!(super::compare_gates(&values, Some(&few))["dead_end_share"].pass, Some(false));
}
