//! Areas that polygons share, or that stick out of one another, with quick answers where an overlay is
//! not needed.

use crate::{Bounds, GridPoint, Polygon, Vec2, grid, overlay};

/// Area that two polygons share, in m²; 0 where a quick look tells that it is below `slack_m2`.
pub fn shared_m2(a: &Polygon, b: &Polygon, slack_m2: f64) -> f64 {
    let (p, q) = (a.bounds(), b.bounds());
    let size = (p.max.min(q.max) - p.min.max(q.min)).max(Vec2::ZERO);
    if size.x * size.y <= slack_m2 || apart(a, b) {
        return 0.0;
    }
    overlay::intersection(a, b).iter().map(Polygon::area_m2).sum()
}

/// Area of `polygon` outside `around`, in m².
pub fn outside_m2(polygon: &Polygon, around: &Polygon) -> f64 {
    let bounds = polygon.bounds();
    if !bounds.intersects(around.bounds()) {
        return polygon.area_m2();
    }
    // Sides of the surrounding polygon that could pass through the other.
    let crossed = around.segments().any(|(r, s)| {
        let side = Bounds { min: r.to_m().min(s.to_m()), max: r.to_m().max(s.to_m()) };
        side.intersects(bounds) && polygon.segments().any(|(p, q)| grid::intersects(p, q, r, s))
    });
    // No side meets the outline: all in, all out, or around a hole.
    if !crossed && around.interiors().iter().all(|hole| !polygon.contains(hole[0])) {
        return if around.contains(polygon.exterior()[0]) { 0.0 } else { polygon.area_m2() };
    }
    overlay::difference(polygon, [around]).iter().map(Polygon::area_m2).sum()
}

/// Surely no common inside: no sides cross, and no vertex or middle of a side of one lies inside
/// the other. Neighbours with a common wall are told apart so.
fn apart(a: &Polygon, b: &Polygon) -> bool {
    let crossing =
        a.segments().any(|(p, q)| b.segments().any(|(r, s)| grid::cross_properly(p, q, r, s)));
    !crossing && !reaches_into(a, b) && !reaches_into(b, a) && a.exterior() != b.exterior()
}

fn reaches_into(a: &Polygon, b: &Polygon) -> bool {
    let inside =
        |p: GridPoint| b.contains(p) && !b.segments().any(|(r, s)| grid::on_segment(r, s, p));
    a.segments().any(|(p, q)| inside(p) || inside(GridPoint::round((p.to_m() + q.to_m()) / 2.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + side, y + side))
    }

    #[test]
    fn quick_answers_are_those_of_the_overlay() {
        for k in 0..200 {
            let (x, y) = (f64::from(k * 37 % 31) - 15.0, f64::from(k * 61 % 29) - 14.0);
            let (a, b) = (square(0.0, 0.0, 10.0), square(x, y, f64::from(k % 13) + 1.0));
            let exact: f64 = overlay::intersection(&a, &b).iter().map(Polygon::area_m2).sum();
            assert!((shared_m2(&a, &b, 0.1) - exact).abs() <= 0.1, "{x} {y}");
            assert!((outside_m2(&b, &a) - (b.area_m2() - exact)).abs() < 1e-6, "{x} {y}");
        }
    }

    #[test]
    fn a_house_in_a_courtyard_is_outside() {
        let court = square(4.0, 4.0, 10.0).exterior().to_vec();
        let ring = Polygon::new(square(0.0, 0.0, 20.0).exterior().to_vec(), vec![court]);
        let ring = ring.expect("has area");
        assert_eq!(outside_m2(&square(6.0, 6.0, 3.0), &ring), 9.0);
        assert_eq!(outside_m2(&square(2.0, 2.0, 13.0), &ring), 100.0);
        assert_eq!(shared_m2(&square(6.0, 6.0, 3.0), &ring, 0.1), 0.0);
    }
}
