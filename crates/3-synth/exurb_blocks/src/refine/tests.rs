use exurb_geom::{GridPoint, Polygon, Vec2, overlap, trig};
use proptest::prelude::*;

use super::{Body, Fate, Ground, Why, refine};
use crate::kerb::Kerb;

fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
    Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + w, y + h))
}

fn turned(center: Vec2, size: Vec2, angle_rad: f64) -> Polygon {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let at = |(x, y): (f64, f64)| center + trig::unit(angle_rad).rotate(Vec2::new(x, y) * size);
    Polygon::new(corners.map(at).map(GridPoint::round).to_vec(), vec![]).expect("has area")
}

fn refined(block: &Polygon, standing: &[Polygon], bodies: &[Body], tolerance: f64) -> Vec<Fate> {
    let kerb = Kerb::of(block);
    refine(&Ground { block, kerb: &kerb, standing, at_home: false }, bodies, tolerance)
}

fn body(polygon: Polygon) -> Body {
    Body { polygon, clearance_m: 2.0 }
}

#[test]
fn what_fits_stays_to_the_millimetre() {
    let bodies = [body(rectangle(5., 5., 10., 10.)), body(rectangle(15., 5., 10., 10.))];
    let fates = refined(&rectangle(0., 0., 60., 40.), &[], &bodies, 0.1);
    assert_eq!(fates, [Fate::Stays, Fate::Stays]);
}

#[test]
fn one_on_the_pavement_is_moved_as_it_is() {
    let house = rectangle(-3.0, 10.0, 12.0, 10.0);
    let fates = refined(&rectangle(0., 0., 60., 40.), &[], &[body(house.clone())], 0.1);
    let [Fate::Moved(moved)] = &fates[..] else { panic!("{fates:?}") };
    assert!(moved.bounds().min.x >= 2.0 - 0.011, "{}", moved.bounds().min.x);
    assert!((moved.area_m2() - house.area_m2()).abs() <= 0.1 * house.area_m2());
}

#[test]
fn reasons_are_told() {
    let block = rectangle(0., 0., 40., 30.);
    let bowtie = [(5., 5.), (15., 12.), (15., 5.), (6., 14.)];
    let bowtie = bowtie.map(|(x, y)| GridPoint::m(x, y)).to_vec();
    let bodies = [
        body(rectangle(60., 5., 10., 10.)),
        body(Polygon::new(bowtie, vec![]).expect("has area")),
        body(rectangle(1., 1., 38., 28.)),
    ];
    let fates = refined(&block, &[rectangle(0., 0., 40., 25.)], &bodies, 0.1);
    assert_eq!(fates[0], Fate::Dropped(Why::Outside));
    assert_eq!(fates[1], Fate::Dropped(Why::Shape));
    assert!(matches!(fates[2], Fate::Dropped(_)), "{:?}", fates[2]);
}

proptest! {
    #[test]
    fn nothing_overlaps_nothing_is_on_the_street_and_shapes_hold(
        places in prop::collection::vec((0.0..80.0, 0.0..50.0, 5.0..20.0, 5.0..14.0, 0.0..3.0), 1..14),
        corner in 20.0..80.0,
    ) {
        let block = [(0., 0.), (80., 0.), (80., 30.), (corner, 50.), (0., 50.)];
        let block = block.map(|(x, y)| GridPoint::m(x, y)).to_vec();
        let block = Polygon::new(block, vec![]).expect("has area");
        let place = |p: &(f64, f64, f64, f64, f64)| {
            body(turned(Vec2::new(p.0, p.1), Vec2::new(p.2, p.3), p.4))
        };
        let bodies: Vec<Body> = places.iter().map(place).collect();
        let fates = refined(&block, &[], &bodies, 0.1);
        prop_assert_eq!(fates.len(), bodies.len());
        let mut stand: Vec<Polygon> = Vec::new();
        for (fate, body) in fates.into_iter().zip(&bodies) {
            let polygon = match fate {
                Fate::Stays => body.polygon.clone(),
                Fate::Moved(polygon) => polygon,
                Fate::Dropped(_) => continue,
            };
            prop_assert!(polygon.is_valid());
            let change = (polygon.area_m2() / body.polygon.area_m2() - 1.0).abs();
            prop_assert!(change <= 0.1 + 1e-3, "area changed by {change}");
            prop_assert!(overlap::outside_m2(&polygon, &block) <= 0.1);
            for other in &stand {
                prop_assert!(overlap::shared_m2(&polygon, other, 0.0) <= 0.1);
            }
            stand.push(polygon);
        }
    }
}
