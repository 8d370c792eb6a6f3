use std::sync::Arc;

use exurb_city::{Building, City, Origin, Provenance, laws};
use exurb_geom::{GridPoint, Polygon, Vec2};
use exurb_operation::{Example, Failure, Operation, Run, Scope, erase};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::Transfer;
use crate::auto::Auto;
use crate::retarget::Retarget;
use crate::test_city::{Style, grid, odd_block};

fn ring(corners: &[(f64, f64)]) -> Vec<GridPoint> {
    corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
}

fn polygon(corners: &[(f64, f64)]) -> Polygon {
    Polygon::new(ring(corners), vec![]).expect("has area")
}

/// The city with every building in the block that holds it.
fn housed(mut city: City) -> City {
    let mut buildings = city.buildings.to_vec();
    for (building, id) in buildings.iter_mut().zip(1..) {
        let p = GridPoint::round(building.polygon.interior_point());
        building.id = id;
        building.block =
            city.blocks.iter().find(|b| b.polygon.contains(p)).map_or(0, |block| block.id);
    }
    city.buildings = Arc::new(buildings);
    city
}

fn town(style: Style, name: &str) -> City {
    let mut city = housed(grid(4, 3, Vec2::new(100.0, 70.0), style));
    city.metadata.name = name.into();
    city
}

fn run<O: Operation + 'static>(
    city: &City,
    examples: &[City],
    params: Value,
) -> Result<City, Failure> {
    let examples: Vec<Example> = examples.iter().cloned().map(Example::new).collect();
    let made = erase::<O>().run(city, &Scope::All, &examples, params, &Run::new(1))?;
    Ok(made.city)
}

/// All ways of filling, with their names.
fn all_ways(city: &City, example: &City) -> [(&'static str, City); 3] {
    let one = std::slice::from_ref(example);
    let made = |made: Result<City, Failure>| made.unwrap_or_else(|e| panic!("{e}"));
    [
        ("transfer", made(run::<Transfer>(city, one, Value::Null))),
        ("retarget", made(run::<Retarget>(city, one, Value::Null))),
        ("auto", made(run::<Auto>(city, one, Value::Null))),
    ]
}

fn check_laws(city: &City, case: &str) {
    let report = laws(city);
    for name in [
        "invalid_buildings",
        "invalid_parcels",
        "buildings_overlapping",
        "buildings_outside_block",
        "buildings_crossed_by_street",
        "parcels_overlapping",
        "parcels_tile_block",
    ] {
        let law = report.get(name).unwrap_or_else(|| panic!("{name} is a law"));
        assert!(law.pass, "{case}: {name} {:?}, {:?}", law.value, report.breaches.first());
    }
}

#[test]
fn like_blocks_get_the_whole_layout() {
    let example = town(Style::Detached, "detached");
    let empty = town(Style::Empty, "empty");
    for (way, made) in all_ways(&empty, &example) {
        check_laws(&made, way);
        assert_eq!(made.buildings.len(), example.buildings.len(), "{way}");
        let from_example = |b: &Building| b.provenance.source.as_deref() == Some("detached");
        assert!(made.buildings.iter().all(from_example), "{way}");
    }
}

#[test]
fn an_empty_database_and_a_city_without_blocks_are_told() {
    let empty = town(Style::Empty, "empty");
    let message = run::<Transfer>(&empty, std::slice::from_ref(&empty), Value::Null);
    let message = message.expect_err("nothing to take from").to_string();
    assert!(message.contains("no block with buildings"), "{message}");
    let bare = City::empty(empty.frame.clone(), empty.target.clone());
    let example = town(Style::Rows, "rows");
    let message = run::<Auto>(&bare, &[example], Value::Null).expect_err("no blocks").to_string();
    assert!(message.contains("no blocks to fill"), "{message}");
}

#[test]
fn flawed_examples_give_flawless_fillings() {
    let mut example = town(Style::Detached, "flawed");
    let mut buildings = example.buildings.to_vec();
    let of = |p: Polygon| Building::new(0, p, Provenance::of(Origin::Imported));
    // Over another one, over a street, over two blocks, crossing and touching itself.
    let first = buildings[0].polygon.centroid();
    let around = |r: f64| {
        let (x, y) = (first.x, first.y);
        polygon(&[(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)])
    };
    buildings.push(of(around(6.0)));
    buildings.push(of(polygon(&[(95.0, 30.0), (109.0, 30.0), (109.0, 40.0), (95.0, 40.0)])));
    buildings.push(of(polygon(&[(150.0, 50.0), (160.0, 50.0), (160.0, 90.0), (150.0, 90.0)])));
    buildings.push(of(polygon(&[(240.0, 30.0), (262.0, 44.0), (262.0, 30.0), (243.0, 41.0)])));
    let touching =
        [(40., 30.), (50., 30.), (50., 40.), (60., 40.), (60., 50.), (50., 40.), (40., 40.)];
    buildings.push(of(polygon(&touching)));
    example.buildings = Arc::new(buildings);
    let example = housed(example);
    for (way, made) in all_ways(&town(Style::Empty, "empty"), &example) {
        check_laws(&made, way);
        assert!(made.buildings.len() > 100, "{way}: {}", made.buildings.len());
    }
}

#[test]
fn blocks_of_any_shape_are_filled_without_flaw() {
    let example = town(Style::Rows, "rows");
    let mut city = town(Style::Empty, "odd");
    city.streets = Arc::default();
    for number in 0..36 {
        let Some(odd) = odd_block(number).filter(Polygon::is_valid) else { continue };
        let mut block = example.blocks[0].clone();
        block.face_area_m2 = odd.area_m2();
        (block.id, block.polygon) = (1, odd);
        block.sides = Vec::new();
        city.blocks = Arc::new(vec![block]);
        city.target = city.blocks[0].polygon.clone();
        for (way, made) in all_ways(&city, &example) {
            check_laws(&made, &format!("{way}, block {number}"));
        }
    }
}

#[test]
fn a_style_map_says_which_example_serves_where() {
    let examples = [town(Style::Rows, "rows"), town(Style::Detached, "detached")];
    let half = [[-1.0, -1.0], [200.0, -1.0], [200.0, 300.0], [-1.0, 300.0]];
    let map = json!({ "areas": [{ "example": "detached", "polygon": [half] }] });
    let params = json!({ "style_map": map });
    let city = town(Style::Empty, "empty");
    let made = run::<Transfer>(&city, &examples, params).expect("both are there");
    let west = |b: &&Building| b.polygon.centroid().x < 200.0;
    let detached = |b: &Building| b.provenance.source.as_deref() == Some("detached");
    assert!(made.buildings.iter().filter(west).count() > 40);
    assert!(made.buildings.iter().filter(west).all(detached));
    let unknown = json!({ "areas": [{ "example": "none", "polygon": [half] }] });
    let failed = run::<Transfer>(&city, &examples, json!({ "style_map": unknown }));
    assert!(failed.expect_err("no such example").to_string().contains("rows, detached"));
}

#[test]
fn alternatives_are_other_fillings_of_the_same_block() {
    let mut example = town(Style::Detached, "mixed");
    // No two blocks alike: one house after the other goes.
    let keep = |b: &Building| !b.id.is_multiple_of(b.block + 2);
    example.buildings = Arc::new(example.buildings.iter().filter(|b| keep(b)).cloned().collect());
    let example = housed(example);
    // Of no block in the example.
    let city = grid(4, 3, Vec2::new(104.0, 72.0), Style::Empty);
    let params = json!({ "alternatives": 3, "pick": 3 });
    let made = run::<Transfer>(&city, &[example], params).expect("there is something");
    let count = |kind: &str| made.features.iter().filter(|f| &*f.kind == kind).count();
    assert!(count("alternative_2") > 0 && count("alternative_3") > 0);
    let mut parts: Vec<_> = made.buildings.iter().map(|b| b.provenance.part.clone()).collect();
    parts.sort();
    parts.dedup();
    assert!(parts.len() >= 3, "only {} layouts are drawn", parts.len());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_simple_blocks_are_filled_without_flaw(
        radii in prop::collection::vec(25.0..140.0, 3..12),
        style in prop::sample::select(vec![Style::Rows, Style::Detached]),
    ) {
        let example = town(style, "example");
        let step = std::f64::consts::TAU / radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| exurb_geom::trig::unit(step * i as f64) * *r;
        let star = radii.iter().enumerate().map(corner).map(GridPoint::round).collect();
        let star = Polygon::new(star, vec![]).expect("has area");
        prop_assume!(star.is_valid());
        let mut city = town(Style::Empty, "star");
        city.streets = Arc::default();
        let mut block = example.blocks[0].clone();
        (block.id, block.face_area_m2, block.polygon) = (1, star.area_m2(), star.clone());
        block.sides = Vec::new();
        (city.blocks, city.target) = (Arc::new(vec![block]), star);
        for (way, made) in all_ways(&city, &example) {
            check_laws(&made, way);
        }
    }
}
