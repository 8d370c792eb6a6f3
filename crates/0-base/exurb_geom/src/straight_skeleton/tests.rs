use proptest::prelude::*;

use super::*;
use crate::{GridPoint, offset, overlay, trig};

fn polygon(ring: &[(f64, f64)]) -> Polygon {
    let points = ring.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
    Polygon::new(points, vec![]).expect("has area")
}

/// Area of the faces' parts that the front reaches after `time_m`.
fn area_after(skeleton: &Skeleton, time_m: f64) -> f64 {
    let clipped = |face: &Vec<usize>| {
        let mut out = Vec::new();
        for (i, n) in face.iter().enumerate() {
            let (a, b) = (skeleton.nodes[*n], skeleton.nodes[face[(i + 1) % face.len()]]);
            if a.time_m >= time_m {
                out.push(a.at);
            }
            if (a.time_m >= time_m) != (b.time_m >= time_m) {
                let share = (time_m - a.time_m) / (b.time_m - a.time_m);
                out.push(a.at.lerp(b.at, share));
            }
        }
        area_m2(&out)
    };
    skeleton.faces.iter().map(clipped).sum()
}

/// The front at any moment is the polygon's inset.
fn agrees_with_insets(polygon: &Polygon, skeleton: &Skeleton) {
    for share in [0.1, 0.35, 0.6, 0.85] {
        let time_m = skeleton.last_m() * share;
        let inset: f64 = offset::inset(polygon, time_m).iter().map(Polygon::area_m2).sum();
        let ours = area_after(skeleton, time_m);
        let slack = 0.002 * polygon.area_m2() + 0.02 * polygon.perimeter_m() * 0.05;
        assert!((ours - inset).abs() < slack, "at {time_m}: {ours} and {inset} of {polygon:?}");
    }
}

#[test]
fn a_rectangle_has_two_triangles_and_two_trapezoids() {
    let skeleton = Skeleton::of(&polygon(&[(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (0.0, 8.0)]));
    let skeleton = skeleton.expect("simple");
    assert_eq!(skeleton.faces.iter().map(Vec::len).collect::<Vec<_>>(), [4, 3, 4, 3]);
    assert_eq!(skeleton.last_m(), 4.0);
}

#[test]
fn a_square_is_a_pyramid() {
    let square = polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)]);
    let skeleton = Skeleton::of(&square).expect("simple");
    assert!(skeleton.faces.iter().all(|f| f.len() == 3));
}

#[test]
fn shapes_of_houses_agree_with_their_insets() {
    let cross = [
        (10.0, 0.0),
        (20.0, 0.0),
        (20.0, 10.0),
        (30.0, 10.0),
        (30.0, 20.0),
        (20.0, 20.0),
        (20.0, 30.0),
        (10.0, 30.0),
        (10.0, 20.0),
        (0.0, 20.0),
        (0.0, 10.0),
        (10.0, 10.0),
    ];
    let l = [(0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (12.0, 10.0), (12.0, 25.0), (0.0, 25.0)];
    let u = [
        (0.0, 0.0),
        (40.0, 0.0),
        (40.0, 30.0),
        (30.0, 30.0),
        (30.0, 10.0),
        (10.0, 10.0),
        (10.0, 22.0),
        (0.0, 22.0),
    ];
    let t = [
        (0.0, 0.0),
        (36.0, 0.0),
        (36.0, 10.0),
        (23.0, 10.0),
        (23.0, 30.0),
        (13.0, 30.0),
        (13.0, 10.0),
        (0.0, 10.0),
    ];
    let bay = [
        (0.0, 0.0),
        (14.0, 0.0),
        (14.0, 12.0),
        (9.0, 12.0),
        (9.0, 14.0),
        (5.0, 14.0),
        (5.0, 12.0),
        (0.0, 12.0),
    ];
    for ring in [&cross[..], &l, &u, &t, &bay] {
        for turn in [0.0, 0.3, 1.1] {
            let turned = polygon(ring).map(|p| trig::rotate(p, turn)).expect("has area");
            let skeleton = Skeleton::of(&turned).unwrap_or_else(|| panic!("{turned:?}"));
            agrees_with_insets(&turned, &skeleton);
        }
    }
}

#[test]
fn a_courtyard_is_swept_from_both_sides() {
    let outer = polygon(&[(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]);
    let hole = polygon(&[(10.0, 8.0), (28.0, 8.0), (28.0, 20.0), (10.0, 20.0)]);
    let house = Polygon::new(outer.exterior().to_vec(), vec![hole.exterior().to_vec()]);
    for turn in [0.0, 0.7] {
        let house = house.clone().and_then(|h| h.map(|p| trig::rotate(p, turn))).expect("area");
        let skeleton = Skeleton::of(&house).expect("simple");
        assert_eq!(skeleton.faces.len(), 8);
        agrees_with_insets(&house, &skeleton);
    }
}

/// A star-shaped polygon of radii around a circle.
fn star(radii: &[f64]) -> Polygon {
    let step = std::f64::consts::TAU / radii.len() as f64;
    let points = radii.iter().zip(0..).map(|(r, i)| trig::unit(step * f64::from(i)) * *r);
    Polygon::new(points.map(GridPoint::round).collect(), vec![]).expect("has area")
}

/// A side that has vanished next to a reflex corner cuts a mitred inset short but not the front;
/// rounded corners cut least.
fn lies_between_insets(polygon: &Polygon, skeleton: &Skeleton) {
    let corners = polygon.exterior().len();
    let first_m = skeleton.nodes[corners..].iter().map(|n| n.time_m).fold(f64::MAX, f64::min);
    let slack = 0.003 * polygon.area_m2();
    for time_m in [0.5, 0.95].map(|share| share * first_m) {
        let inset: f64 = offset::inset(polygon, time_m).iter().map(Polygon::area_m2).sum();
        let ours = area_after(skeleton, time_m);
        assert!((ours - inset).abs() < slack, "at {time_m}: {ours} and {inset} of {polygon:?}");
    }
    let mut outline = crate::polyline::to_m(polygon.exterior());
    outline.push(outline[0]);
    for share in [0.2, 0.5, 0.8] {
        let time_m = share * skeleton.last_m();
        let mitred: f64 = offset::inset(polygon, time_m).iter().map(Polygon::area_m2).sum();
        let swept = offset::carriageway(&outline, time_m, offset::Cap::Round);
        let rounded: f64 = overlay::difference(polygon, &swept).iter().map(Polygon::area_m2).sum();
        let ours = area_after(skeleton, time_m);
        let between = mitred - slack < ours && ours < rounded + slack;
        assert!(between, "at {time_m}: {mitred} < {ours} < {rounded} of {polygon:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn random_stars_lie_between_their_insets(
        radii in prop::collection::vec(4.0..20.0f64, 4..16),
    ) {
        let star = star(&radii);
        // Almost all succeed; what is returned is right.
        if let Some(skeleton) = Skeleton::of(&star) {
            lies_between_insets(&star, &skeleton);
        }
    }

    #[test]
    fn what_is_not_simple_does_no_harm(
        points in prop::collection::vec((0..40i32, 0..40i32), 3..14),
    ) {
        let ring = points.iter().map(|(x, y)| GridPoint { x: x * 500, y: y * 500 }).collect();
        if let Some(polygon) = Polygon::new(ring, vec![]) {
            let skeleton = Skeleton::of(&polygon);
            prop_assert!(skeleton.is_none_or(|s| s.faces.len() == polygon.exterior().len()));
        }
    }
}

#[test]
fn random_stars_almost_all_have_a_skeleton() {
    let mut state = 1u64;
    let mut draw = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        4.0 + (state >> 40) as f64 / f64::from(1u32 << 24) * 16.0
    };
    let made = (0..400).filter(|k| {
        let radii: Vec<f64> = (0..5 + k % 20).map(|_| draw()).collect();
        Skeleton::of(&star(&radii)).is_some()
    });
    assert!(made.count() >= 396);
}
