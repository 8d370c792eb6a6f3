//! The smallest circle around a set of points.
//!
//! Source: Welzl 1991, *Smallest enclosing disks (balls and ellipsoids)*, in its iterative form over
//! the corners of the convex hull. The order of the hull takes the place of a random one, so that
//! the result is always the same; hulls of city blocks are small. O(h³) at worst for h corners of
//! the hull, about O(h) in practice.

use crate::{GridPoint, Vec2, oriented_box::convex_hull};

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its middle, in metres.
    pub center: Vec2,
    /// Its radius, in metres.
    pub radius_m: f64,
}

impl Circle {
    /// The smallest circle around `points`; `None` when there are none.
    pub fn around(points: &[GridPoint]) -> Option<Self> {
        let hull = convex_hull(points);
        let mut circle = Self { center: *hull.first()?, radius_m: 0.0 };
        for i in 1..hull.len() {
            if !circle.holds(hull[i]) {
                circle = Self::through_one(hull[i], &hull[..i]);
            }
        }
        Some(circle)
    }

    /// Area in m².
    pub fn area_m2(&self) -> f64 {
        std::f64::consts::PI * self.radius_m * self.radius_m
    }

    /// Is `p` inside, but for rounding?
    fn holds(&self, p: Vec2) -> bool {
        self.center.distance(p) <= self.radius_m * (1.0 + 1e-12) + 1e-9
    }

    /// The smallest circle around `others` that goes through `a`.
    fn through_one(a: Vec2, others: &[Vec2]) -> Self {
        let mut circle = Self { center: a, radius_m: 0.0 };
        for j in 0..others.len() {
            if !circle.holds(others[j]) {
                circle = Self::through_two(a, others[j], &others[..j]);
            }
        }
        circle
    }

    /// The smallest circle around `others` that goes through `a` and `b`.
    fn through_two(a: Vec2, b: Vec2, others: &[Vec2]) -> Self {
        let mut circle = Self { center: (a + b) / 2.0, radius_m: a.distance(b) / 2.0 };
        for c in others {
            if !circle.holds(*c) {
                circle = Self::through_three(a, b, *c).unwrap_or(circle);
            }
        }
        circle
    }

    /// The circle through three points; `None` when they lie on a line.
    fn through_three(a: Vec2, b: Vec2, c: Vec2) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let twice = 2.0 * u.perp_dot(v);
        if twice == 0.0 {
            return None;
        }
        let (uu, vv) = (u.length_squared(), v.length_squared());
        let offset = Vec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
        Some(Self { center: a + offset, radius_m: offset.length() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_square_lies_in_the_circle_through_its_corners() {
        let square = [(0., 0.), (10., 0.), (10., 10.), (0., 10.)].map(|(x, y)| GridPoint::m(x, y));
        let circle = Circle::around(&square).expect("there are points");
        assert!((circle.radius_m - 50f64.sqrt()).abs() < 1e-12);
        assert_eq!(Circle::around(&[]), None);
        assert_eq!(Circle::around(&square[..1]).expect("a point").radius_m, 0.0);
    }

    proptest! {
        /// It holds all points, and no circle through two or three of them that does is smaller.
        #[test]
        fn no_smaller_circle_holds_the_points(
            points in prop::collection::vec((-5000i32..5000, -5000i32..5000), 2..9)
        ) {
            let points: Vec<GridPoint> = points.iter().map(|(x, y)| GridPoint { x: *x, y: *y }).collect();
            let circle = Circle::around(&points).expect("there are points");
            let at: Vec<Vec2> = points.iter().map(|p| p.to_m()).collect();
            prop_assert!(at.iter().all(|p| circle.holds(*p)));
            let smallest = brute_force(&at);
            prop_assert!((circle.radius_m - smallest).abs() < 1e-6, "{} {smallest}", circle.radius_m);
        }
    }

    fn brute_force(points: &[Vec2]) -> f64 {
        let mut best = f64::INFINITY;
        let mut try_circle = |circle: Circle| {
            if points.iter().all(|p| circle.center.distance(*p) <= circle.radius_m + 1e-7) {
                best = best.min(circle.radius_m);
            }
        };
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i) {
                try_circle(Circle { center: (*a + *b) / 2.0, radius_m: a.distance(*b) / 2.0 });
                for c in &points[j..] {
                    Circle::through_three(*a, *b, *c).into_iter().for_each(&mut try_circle);
                }
            }
        }
        best
    }
}
