use std::sync::Arc;

use exurb_city::{
    Building, City, Origin, Provenance, Roof, Street, StreetGraph, block, street_graph,
};
use exurb_geom::{Frame, GridPoint, Polygon};
use exurb_operation::{Example, Run, Scope, erase};
use serde_json::{Value, json};

use super::Extrude;

/// Blocks of 100 m by 100 m in a row, each with ten buildings whose side is `side_m(block)`.
fn town(blocks: u32, side_m: impl Fn(u32) -> f64) -> City {
    let mut lines = Vec::new();
    let p = |x: u32, y: u32| GridPoint::m(f64::from(x) * 100.0, f64::from(y) * 100.0);
    for i in 0..=blocks {
        lines.push((vec![p(i, 0), p(i, 1)], Street::default()));
        if i < blocks {
            lines.push((vec![p(i, 0), p(i + 1, 0)], Street::default()));
            lines.push((vec![p(i, 1), p(i + 1, 1)], Street::default()));
        }
    }
    let streets: StreetGraph = street_graph::from_lines(lines);
    let mut city = City::empty(Frame::null_island(), Polygon::rectangle(p(0, 0), p(blocks, 1)));
    city.blocks = Arc::new(block::derive(&streets));
    city.streets = Arc::new(streets);
    let mut buildings = Vec::new();
    for b in 0..blocks {
        for k in 0..10 {
            let low = (
                f64::from(b) * 100.0 + 6.0 + f64::from(k % 5) * 18.0,
                10.0 + f64::from(k / 5) * 45.0,
            );
            let corner = GridPoint::m(low.0 + side_m(b), low.1 + side_m(b));
            let polygon = Polygon::rectangle(GridPoint::m(low.0, low.1), corner);
            let id = buildings.len() as u32 + 1;
            buildings.push(Building::new(id, polygon, Provenance::of(Origin::Imported)));
        }
    }
    city.buildings = Arc::new(buildings);
    city
}

/// The same town with heights of `height_m(building)`.
fn with_heights(city: &City, height_m: impl Fn(&Building) -> f64, roof: Option<Roof>) -> City {
    let mut out = city.clone();
    let mut buildings = city.buildings.to_vec();
    for building in &mut buildings {
        building.height_m = Some(height_m(building));
        building.roof = roof;
        building.usage = Some("apartments".into());
    }
    out.buildings = Arc::new(buildings);
    out
}

fn extruded(city: &City, example: Option<&City>, params: Value, seed: u64) -> City {
    let examples: Vec<Example> = example.map(|e| Example::new(e.clone())).into_iter().collect();
    let run = Run::new(seed);
    erase::<Extrude>().run(city, &Scope::All, &examples, params, &run).unwrap().city
}

fn heights(city: &City) -> Vec<f64> {
    city.buildings.iter().map(|b| b.height_m.unwrap()).collect()
}

#[test]
fn large_footprints_get_the_heights_of_large_ones() {
    let plain = town(12, |b| if b % 2 == 0 { 8.0 } else { 16.0 });
    let high = |b: &Building| if b.polygon.area_m2() > 100.0 { 21.0 } else { 6.0 };
    let example = with_heights(&plain, high, Some(Roof::Gabled));
    let made = extruded(&plain, Some(&example), json!({}), 1);
    for building in made.buildings.iter() {
        assert_eq!(building.height_m, Some(high(building)));
        assert_eq!(building.roof, Some(Roof::Gabled));
        assert_eq!(building.usage.as_deref(), Some("apartments"));
        assert_eq!(building.levels, Some((high(building) / 3.0).round()));
    }
}

#[test]
fn no_footprint_moves_and_what_is_known_stays() {
    let plain = town(4, |_| 12.0);
    let example = with_heights(&plain, |b| 5.0 + f64::from(b.id), None);
    let mut city = plain.clone();
    let mut buildings = plain.buildings.to_vec();
    (buildings[0].height_m, buildings[1].levels) = (Some(99.0), Some(2.0));
    city.buildings = Arc::new(buildings);
    let made = extruded(&city, Some(&example), json!({}), 1);
    for (before, after) in city.buildings.iter().zip(made.buildings.iter()) {
        assert_eq!((before.id, &before.polygon), (after.id, &after.polygon));
    }
    assert_eq!((made.buildings[0].height_m, made.buildings[1].height_m), (Some(99.0), Some(6.0)));
    let replaced = extruded(&city, Some(&example), json!({"replace": true}), 1);
    assert!(heights(&replaced).iter().all(|h| (6.0..=45.0).contains(h)));
}

/// Share of the variance of ln height that lies between the blocks of ten.
fn between_blocks(city: &City) -> f64 {
    let ln: Vec<f64> = heights(city).iter().map(|h| exurb_geom::trig::ln(*h)).collect();
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let square = |v: &[f64], m: f64| v.iter().map(|x| (x - m).powi(2)).sum::<f64>();
    let within: f64 = ln.chunks(10).map(|c| square(c, mean(c))).sum();
    1.0 - within / square(&ln, mean(&ln))
}

#[test]
fn neighbours_are_as_alike_as_in_the_example() {
    let plain = town(60, |_| 12.0);
    let scatter = |n: u32| 4.0 + f64::from(n * 7919 % 101) / 4.0;
    let by_block = with_heights(&plain, |b| scatter((b.id - 1) / 10), None);
    let each_alone = with_heights(&plain, |b| scatter(b.id), None);
    let alike = between_blocks(&extruded(&plain, Some(&by_block), json!({}), 1));
    let apart = between_blocks(&extruded(&plain, Some(&each_alone), json!({}), 1));
    assert!(alike > 0.8 && apart < 0.4, "{alike} {apart}");
}

#[test]
fn heights_are_spread_as_in_the_example() {
    let plain = town(60, |_| 12.0);
    let example = with_heights(&plain, |b| 3.0 + f64::from(b.id * 37 % 30), None);
    let made = extruded(&plain, Some(&example), json!({"neighbours": 1000}), 5);
    let quantile = |city: &City, q: f64| {
        let mut sorted = heights(city);
        sorted.sort_by(f64::total_cmp);
        sorted[(sorted.len() as f64 * q) as usize]
    };
    for q in [0.1, 0.25, 0.5, 0.75, 0.9] {
        let (a, b) = (quantile(&example, q), quantile(&made, q));
        assert!((a - b).abs() <= 3.0, "{q}: {a} {b}");
    }
}

#[test]
fn without_heights_defaults_are_used_and_said() {
    let run = Run::new(1);
    let city = town(6, |b| 5.0 + f64::from(b) * 2.0);
    let made = erase::<Extrude>()
        .run(&city, &Scope::All, &[Example::new(city.clone())], Value::Null, &run)
        .unwrap()
        .city;
    assert!(made.buildings.iter().all(|b| b.levels.unwrap() >= 1.0 && b.roof.is_some()));
    let warnings = run.take_warnings();
    assert!(warnings.iter().any(|w| w.message.contains("hardly any heights")), "{warnings:?}");
    assert!(warnings.iter().any(|w| w.message.contains("hardly any roof shapes")), "{warnings:?}");
}

#[test]
fn equal_seeds_give_equal_buildings_on_one_thread_and_two() {
    let plain = town(10, |_| 12.0);
    let example = with_heights(&plain, |b| 3.0 + f64::from(b.id % 9), None);
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| extruded(&plain, Some(&example), json!({}), seed).buildings)
    };
    assert_eq!(with(1, 7), with(2, 7));
    assert_ne!(with(1, 7), with(1, 8));
}

/// One storey of a few houses that mappers noted is not the height of a town.
#[test]
fn a_few_heights_are_exceptions() {
    let plain = town(60, |_| 14.0);
    let mut example = plain.clone();
    let mut buildings = plain.buildings.to_vec();
    // Five of 600: under one in a hundred.
    buildings[..5].iter_mut().for_each(|b| b.levels = Some(1.0));
    example.buildings = Arc::new(buildings);
    let made = extruded(&plain, Some(&example), json!({}), 1);
    let storeys = made.buildings.iter().map(|b| b.levels.unwrap()).sum::<f64>() / 600.0;
    assert!(storeys > 1.5, "{storeys}");
}

/// Uses are as frequent as in the example, those without one included, and garages stay low.
#[test]
fn uses_come_as_often_as_in_the_example() {
    let plain = town(60, |_| 12.0);
    let mut example = with_heights(&plain, |_| 15.0, None);
    let mut buildings = example.buildings.to_vec();
    for (i, building) in buildings.iter_mut().enumerate() {
        let usage = match i % 10 {
            0 => "kiosk",
            1..=3 => "apartments",
            4 => "ruins",
            _ => "yes",
        };
        building.usage = Some(usage.into());
    }
    example.buildings = Arc::new(buildings);
    let made = extruded(&plain, Some(&example), json!({"neighbours": 1000}), 1);
    let of = |usage: Option<&str>| {
        made.buildings.iter().filter(|b| b.usage.as_deref() == usage).collect::<Vec<_>>()
    };
    let share = |usage| of(usage).len() as f64 / made.buildings.len() as f64;
    assert!((share(Some("kiosk")) - 0.1).abs() < 0.05, "{}", share(Some("kiosk")));
    assert!((share(None) - 0.6).abs() < 0.08, "{}", share(None));
    assert!(of(Some("kiosk")).iter().all(|b| b.height_m.unwrap() <= 4.0 && b.levels == Some(1.0)));
    assert!(of(Some("apartments")).iter().all(|b| b.height_m == Some(15.0)));
}
