//! Areas that polygons share, or that stick out of one another, with quick answers where an overlay is
//! not needed.

use crate::{Bounds, GridPoint, Polygon, Vec2, grid, overlay};

/// Area that two polygons share, in m²; 0 where a quick look tells that it is below `slack_m2`.
pub fn shared_m2(a: &Polygon, b: &Polygon, slack_m2: f64) -> f64 {
    let (p, q) = (a.bounds(), b.bounds());
    let both = Bounds { min: p.min.max(q.min), max: p.max.min(q.max) };
    let size = both.size().max(Vec2::ZERO);
    if size.x * size.y <= slack_m2 || apart(a, b, both) {
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
/// the other. Neighbours with a common wall are told apart so. Only what reaches the box that `both`
/// have in common is looked at.
fn apart(a: &Polygon, b: &Polygon, both: Bounds) -> bool {
    let (near_a, near_b) = (sides_in(a, both), sides_in(b, both));
    let crossing =
        near_a.iter().any(|&(p, q)| near_b.iter().any(|&(r, s)| grid::cross_properly(p, q, r, s)));
    !crossing
        && !reaches_into(&near_a, b, &near_b, both)
        && !reaches_into(&near_b, a, &near_a, both)
        && a.exterior() != b.exterior()
}

/// Sides whose boxes meet a box.
fn sides_in(polygon: &Polygon, both: Bounds) -> Vec<(GridPoint, GridPoint)> {
    let meets = |&(p, q): &(GridPoint, GridPoint)| {
        let (p, q) = (p.to_m(), q.to_m());
        Bounds { min: p.min(q), max: p.max(q) }.intersects(both)
    };
    polygon.segments().filter(meets).collect()
}

fn reaches_into(
    sides: &[(GridPoint, GridPoint)],
    other: &Polygon,
    sides_of_other: &[(GridPoint, GridPoint)],
    both: Bounds,
) -> bool {
    let inside = |p: GridPoint| {
        both.contains(p.to_m())
            && other.contains(p)
            && !sides_of_other.iter().any(|&(r, s)| grid::on_segment(r, s, p))
    };
    sides.iter().any(|&(p, q)| inside(p) || inside(GridPoint::round((p.to_m() + q.to_m()) / 2.0)))
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
