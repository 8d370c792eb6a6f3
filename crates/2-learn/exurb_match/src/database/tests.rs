use std::sync::Arc;

use exurb_geom::{GridPoint, Vec2, trig};
use proptest::prelude::*;

use super::*;

fn ring(corners: &[(f64, f64)]) -> Vec<GridPoint> {
    corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
}

/// Quadrilaterals of many sizes and shapes.
fn quadrilateral(k: u32) -> Vec<GridPoint> {
    let wave = |f: f64| 0.5 + 0.5 * trig::sin(f64::from(k) * f + f);
    let (w, d) = (40.0 + 200.0 * wave(1.7), 40.0 + 120.0 * wave(2.3));
    let skew = 30.0 * wave(0.9);
    ring(&[(0.0, 0.0), (w, skew * 0.3), (w + skew, d), (skew * 0.5, d - skew * 0.2)])
}

fn database(count: u32) -> Database {
    let entry = |k| Entry {
        outline: Outline::of(&quadrilateral(k)),
        attributes: Attributes { density: Some(f64::from(k % 10) / 10.0), ..Attributes::default() },
    };
    Database::new((0..count).map(entry).collect())
}

#[test]
fn an_entry_asked_for_is_found_at_no_cost_and_stays_in_place() {
    let database = database(200);
    for k in [0, 57, 199] {
        let ring = quadrilateral(k);
        let (outline, attributes) = (Outline::of(&ring), Attributes::default());
        let found = database.query(&Query::new(&outline, &attributes), |_| true);
        assert_eq!((found[0].entry, found.len()), (k, 10));
        assert_eq!(found[0].cost, 0.0);
        assert!(found.windows(2).all(|w| w[0].cost <= w[1].cost));
        let moved = found[0].motion.apply(Vec2::new(30.0, 40.0));
        assert!(moved.distance(Vec2::new(30.0, 40.0)) < 1e-9);
    }
}

#[test]
fn what_may_not_serve_is_passed_over() {
    let database = database(200);
    let (outline, attributes) = (Outline::of(&quadrilateral(57)), Attributes::default());
    let found = database.query(&Query::new(&outline, &attributes), |id| id % 2 == 0);
    assert!(found.iter().all(|m| m.entry % 2 == 0));
    assert!(Database::default().query(&Query::new(&outline, &attributes), |_| true).is_empty());
}

#[test]
fn a_mirrored_block_is_found_when_asked_for() {
    let database = database(60);
    let mirrored: Vec<GridPoint> =
        quadrilateral(13).iter().rev().map(|p| GridPoint { x: -p.x, y: p.y }).collect();
    let (outline, attributes) = (Outline::of(&mirrored), Attributes::default());
    let plain = Query::new(&outline, &attributes);
    let found = database.query(&Query { mirrored: true, ..plain }, |_| true);
    assert_eq!(found[0].entry, 13);
    assert!(found[0].motion.mirrored && found[0].cost < 0.03, "{}", found[0].cost);
    let back = crate::align::refine(found[0].motion, &Outline::of(&quadrilateral(13)), &mirrored);
    assert!(back.apply(Vec2::new(10.0, 20.0)).distance(Vec2::new(-10.0, 20.0)) < 0.05);
}

#[test]
fn density_decides_among_like_shapes_and_is_dropped_where_unknown() {
    let square = ring(&[(0.0, 0.0), (80.0, 0.0), (80.0, 80.0), (0.0, 80.0)]);
    let entry = |density| Entry {
        outline: Outline::of(&square),
        attributes: Attributes {
            density,
            land_use: Some("retail".into()),
            ..Attributes::default()
        },
    };
    let database = Database::new([Some(0.1), Some(0.5), None].map(entry).to_vec());
    let outline = Outline::of(&square);
    let asked = |density| Attributes { density, ..Attributes::default() };
    let weights = Weights { shape: 0.5, density: 0.5, land_use: 0.5, ..Weights::default() };
    let wanted = asked(Some(0.5));
    let costs = database.query(&Query { weights, ..Query::new(&outline, &wanted) }, |_| true);
    assert_eq!(costs.iter().map(|m| m.entry).collect::<Vec<_>>(), [1, 2, 0]);
    assert!((costs[2].cost - 0.5 * (0.4 / 0.6)).abs() < 1e-6, "{}", costs[2].cost);
    let unknown = asked(None);
    let costs = database.query(&Query { weights, ..Query::new(&outline, &unknown) }, |_| true);
    assert!(costs.iter().all(|m| m.cost == 0.0));
}

#[test]
fn relief_counts_where_both_know_it() {
    let square = ring(&[(0.0, 0.0), (80.0, 0.0), (80.0, 80.0), (0.0, 80.0)]);
    let outline = Outline::of(&square);
    let slope = |by: fn(Vec2) -> f64| Some(outline.points().iter().map(|p| by(*p)).collect());
    let entry = |relief_m: Option<Vec<f64>>| Entry {
        outline: outline.clone(),
        attributes: Attributes { relief_m, ..Attributes::default() },
    };
    let (hill, flat) = (slope(|p| (p.x * 0.2).min(10.0)), slope(|_| 5.0));
    let database = Database::new([flat, hill.clone(), None].map(entry).to_vec());
    let asked = Attributes { relief_m: hill, ..Attributes::default() };
    let weights = Weights { shape: 0.5, relief: 0.5, ..Weights::default() };
    let found = database.query(&Query { weights, ..Query::new(&outline, &asked) }, |_| true);
    let cost = |id| found.iter().find(|m| m.entry == id).map(|m| m.cost).expect("found");
    assert!(cost(1) < 1e-6 && cost(0) > 0.005 && cost(2) == 0.0, "{} {}", cost(1), cost(0));
}

proptest! {
    #[test]
    fn the_index_gives_the_nearest_by_area_length_and_aspect(k in 0u32..1000) {
        let database = database(150);
        let outline = Outline::of(&quadrilateral(k + 150));
        let attributes = Attributes { land_use: Some(Arc::from("any")), ..Attributes::default() };
        let query = Query { candidates: 5, ..Query::new(&outline, &attributes) };
        let mut found: Vec<u32> = database.candidates(&query, |_| true);
        let asked = place(&outline);
        let square = |id: &u32| -> f64 {
            let there = place(&database.entries()[*id as usize].outline);
            asked.iter().zip(there).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let mut all: Vec<u32> = (0..150).collect();
        all.sort_by(|a, b| square(a).total_cmp(&square(b)).then(a.cmp(b)));
        all.truncate(5);
        found.sort_unstable();
        all.sort_unstable();
        prop_assert_eq!(found, all);
    }
}
