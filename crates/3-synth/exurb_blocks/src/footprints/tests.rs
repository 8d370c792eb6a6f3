use std::sync::Arc;

use exurb_city::{Area, City};
use exurb_geom::{GridPoint, Polygon, Vec2, overlay};
use exurb_operation::{Example, Failure, Run, Scope, erase};
use serde_json::{Value, json};

use super::Footprints;
use crate::parcels::Parcels;
use crate::test_city::{Style, grid, odd_block, with_parks};

fn area(polygons: &[Polygon]) -> f64 {
    polygons.iter().map(Polygon::area_m2).sum()
}

fn parcelled(city: &City, example: &City, seed: u64) -> City {
    let examples = [Example::new(example.clone())];
    erase::<Parcels>().run(city, &Scope::All, &examples, Value::Null, &Run::new(seed)).unwrap().city
}

fn built(city: &City, example: &City, params: Value, seed: u64) -> City {
    let examples = [Example::new(example.clone())];
    let run = Run::new(seed);
    erase::<Footprints>().run(city, &Scope::All, &examples, params, &run).unwrap().city
}

/// Valid, in their parcel and block, apart from each other, one for each parcel.
fn check_laws(city: &City, case: &str) {
    let mut seen = std::collections::BTreeSet::new();
    for (i, building) in city.buildings.iter().enumerate() {
        let parcel = city.parcels.iter().find(|p| p.id == building.parcel).unwrap();
        let block = city.blocks.iter().find(|b| b.id == building.block).unwrap();
        assert!(building.polygon.is_valid(), "{case}: {}", building.id);
        assert!(building.polygon.area_m2() >= 20.0, "{case}: {}", building.id);
        assert!(seen.insert(building.parcel), "{case}: parcel {} twice", building.parcel);
        for outer in [&parcel.polygon, &block.polygon] {
            let outside = area(&overlay::difference(&building.polygon, [outer]));
            assert!(outside < 0.1, "{case}: {} outside by {outside}", building.id);
        }
        for other in &city.buildings[i + 1..] {
            let shared = area(&overlay::intersection(&building.polygon, &other.polygon));
            assert!(shared < 0.1, "{case}: {} and {} share {shared}", building.id, other.id);
        }
    }
}

/// Share of buildings that touch another.
fn touching(city: &City) -> f64 {
    let near = |a: &Polygon, b: &Polygon| {
        let within = |p: &GridPoint| b.boundary_distance_m(p.to_m()) < 0.05;
        a.exterior().iter().any(within)
    };
    let touches = |i: usize| {
        let own = &city.buildings[i].polygon;
        city.buildings
            .iter()
            .enumerate()
            .any(|(j, other)| i != j && (near(own, &other.polygon) || near(&other.polygon, own)))
    };
    let count = city.buildings.len();
    (0..count).filter(|i| touches(*i)).count() as f64 / count.max(1) as f64
}

const BLOCK: Vec2 = Vec2::new(140.0, 95.0);

#[test]
fn rows_give_rows_and_detached_houses_detached_houses() {
    for (style, least, most) in [(Style::Rows, 0.9, 1.0), (Style::Detached, 0.0, 0.02)] {
        let example = grid(3, 3, BLOCK, style);
        let city = parcelled(&grid(3, 3, BLOCK, Style::Empty), &example, 1);
        let made = built(&city, &example, json!({}), 1);
        check_laws(&made, &format!("{style:?}"));
        let share = touching(&made);
        assert!((least..=most).contains(&share), "{style:?}: {share} touch");
        let covered = |city: &City| city.buildings.iter().map(|b| b.polygon.area_m2()).sum::<f64>();
        let ratio = covered(&made) / covered(&example);
        assert!((0.8..1.2).contains(&ratio), "{style:?}: {ratio} of the example's coverage");
    }
}

#[test]
fn houses_stand_as_far_from_the_kerb_as_in_the_example() {
    for (style, setback) in [(Style::Rows, 3.0), (Style::Detached, 7.0)] {
        let example = grid(3, 3, BLOCK, style);
        let city = parcelled(&grid(3, 3, BLOCK, Style::Empty), &example, 1);
        let made = built(&city, &example, json!({}), 1);
        let kerb = |block: u32| &made.blocks.iter().find(|b| b.id == block).unwrap().polygon;
        let mut found: Vec<f64> = made
            .buildings
            .iter()
            .map(|b| {
                let corners = b.polygon.exterior().iter();
                let far = corners.map(|p| kerb(b.block).boundary_distance_m(p.to_m()));
                far.fold(f64::INFINITY, f64::min)
            })
            .collect();
        found.sort_by(f64::total_cmp);
        let middle = found[found.len() / 2];
        assert!((middle - setback).abs() < 0.5, "{style:?}: {middle}");
    }
}

#[test]
fn footprints_keep_their_laws_on_blocks_of_any_shape() {
    for style in [Style::Rows, Style::Detached] {
        let example = grid(3, 3, BLOCK, style);
        for number in 0..72 {
            let Some(polygon) = odd_block(number) else { continue };
            let mut city = grid(1, 1, BLOCK, Style::Empty);
            let mut block = city.blocks[0].clone();
            city.target = Polygon::rectangle(GridPoint::m(-900., -900.), GridPoint::m(900., 900.));
            block.polygon = polygon;
            city.blocks = Arc::new(vec![block]);
            let city = parcelled(&city, &example, 4);
            // A sliver is all pavement.
            if city.parcels.is_empty() {
                continue;
            }
            let made = built(&city, &example, json!({}), 4);
            check_laws(&made, &format!("{style:?} {number}"));
        }
    }
}

#[test]
fn parks_and_water_stay_free() {
    let example = with_parks(grid(4, 4, BLOCK, Style::Rows), 3);
    let mut city = parcelled(&grid(4, 4, BLOCK, Style::Empty), &example, 2);
    let pond = city.parcels[city.parcels.len() / 2].polygon.clone();
    city.water = Arc::new(vec![Area { id: 1, polygon: pond.clone(), class: "lake".into() }]);
    let made = built(&city, &example, json!({}), 2);
    assert!(!made.buildings.is_empty());
    for building in made.buildings.iter() {
        let parcel = made.parcels.iter().find(|p| p.id == building.parcel).unwrap();
        assert_eq!(parcel.land_use, None);
        assert!(area(&overlay::intersection(&building.polygon, &pond)) < 0.1);
    }
}

#[test]
fn as_many_lots_stay_empty_as_asked() {
    let example = grid(3, 3, BLOCK, Style::Detached);
    let city = parcelled(&grid(3, 3, BLOCK, Style::Empty), &example, 1);
    assert!(built(&city, &example, json!({"empty_share": 1.0}), 1).buildings.is_empty());
    let half = built(&city, &example, json!({"empty_share": 0.5}), 1).buildings.len() as f64;
    let all = built(&city, &example, json!({"empty_share": 0.0}), 1).buildings.len() as f64;
    assert!((0.35..0.65).contains(&(half / all)), "{half} of {all}");
}

#[test]
fn equal_seeds_give_equal_footprints_on_one_thread_and_two() {
    let example = grid(4, 4, BLOCK, Style::Rows);
    let city = parcelled(&grid(4, 4, BLOCK, Style::Empty), &example, 1);
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| built(&city, &example, json!({}), seed).buildings)
    };
    assert_eq!(with(1, 7), with(2, 7));
    assert_ne!(with(1, 7), with(1, 8));
}

#[test]
fn without_buildings_to_learn_from_defaults_are_used_and_said() {
    let run = Run::new(1);
    let example = grid(2, 2, BLOCK, Style::Empty);
    let city = parcelled(&example, &example, 1);
    let made = erase::<Footprints>()
        .run(&city, &Scope::All, &[Example::new(example)], Value::Null, &run)
        .unwrap()
        .city;
    check_laws(&made, "defaults");
    assert!(made.buildings.len() * 2 > made.parcels.len());
    assert!(run.take_warnings().iter().any(|w| w.message.contains("has no buildings")));
}

#[test]
fn cancelling_and_missing_parcels_are_errors() {
    let city = grid(2, 2, BLOCK, Style::Rows);
    let operation = erase::<Footprints>();
    let refused = operation.run(&city, &Scope::All, &[], Value::Null, &Run::new(1)).unwrap_err();
    assert!(refused.to_string().contains("`blocks parcels`"));
    let run = Run::new(1);
    run.cancel();
    let stopped = operation.run(&city, &Scope::All, &[], Value::Null, &run);
    assert!(matches!(stopped, Err(Failure::Cancelled)));
}
