//! The 1 mm grid: integer points and exact predicates on them.

use crate::Vec2;

/// Coordinates stay within this many millimetres of the frame's origin (1,000 km), so that every
/// cross product of differences fits into an `i64` and the predicates below are exact.
pub const LIMIT_MM: i32 = 1_000_000_000;

/// A point of the local frame in whole millimetres, x east and y north.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GridPoint {
    /// Millimetres east of the frame's origin.
    pub x: i32,
    /// Millimetres north of the frame's origin.
    pub y: i32,
}

impl GridPoint {
    /// The grid point nearest to (`x`, `y`) in metres; see [`GridPoint::round`].
    pub fn m(x: f64, y: f64) -> Self {
        Self::round(Vec2::new(x, y))
    }

    /// The grid point nearest to `p` in metres. Points beyond the limit are clamped to it and NaN
    /// becomes 0: readers check with [`GridPoint::checked`] instead.
    pub fn round(p: Vec2) -> Self {
        let limit = f64::from(LIMIT_MM);
        let mm = |v: f64| (v * 1000.0).round().clamp(-limit, limit) as i32;
        Self { x: mm(p.x), y: mm(p.y) }
    }

    /// The grid point nearest to `p` in metres, or `None` if `p` is not finite or out of range.
    pub fn checked(p: Vec2) -> Option<Self> {
        let limit_m = f64::from(LIMIT_MM) / 1000.0;
        (p.x.abs() <= limit_m && p.y.abs() <= limit_m).then(|| Self::round(p))
    }

    /// The same point in metres.
    pub fn to_m(self) -> Vec2 {
        Vec2::new(f64::from(self.x) / 1000.0, f64::from(self.y) / 1000.0)
    }

    /// Distance to `other` in metres.
    pub fn distance_m(self, other: Self) -> f64 {
        self.to_m().distance(other.to_m())
    }
}

/// Twice the signed area of the triangle `a b c` in mm²: positive when `c` lies left of `a → b`.
/// Exact within the coordinate limit.
pub fn orient(a: GridPoint, b: GridPoint, c: GridPoint) -> i64 {
    let d = |p: i32, q: i32| i64::from(p) - i64::from(q);
    d(b.x, a.x) * d(c.y, a.y) - d(b.y, a.y) * d(c.x, a.x)
}

/// Do the open segments `a b` and `c d` cross in one inner point of both? Touching does not count.
pub fn cross_properly(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> bool {
    let (abc, abd) = (orient(a, b, c).signum(), orient(a, b, d).signum());
    let (cda, cdb) = (orient(c, d, a).signum(), orient(c, d, b).signum());
    abc * abd < 0 && cda * cdb < 0
}

/// Does `p` lie on the closed segment `a b`, exactly?
pub fn on_segment(a: GridPoint, b: GridPoint, p: GridPoint) -> bool {
    let within = |lo: i32, hi: i32, v: i32| lo.min(hi) <= v && v <= lo.max(hi);
    within(a.x, b.x, p.x) && within(a.y, b.y, p.y) && orient(a, b, p) == 0
}

/// Do the closed segments share at least one point?
pub fn intersects(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> bool {
    cross_properly(a, b, c, d)
        || on_segment(a, b, c)
        || on_segment(a, b, d)
        || on_segment(c, d, a)
        || on_segment(c, d, b)
}

/// Where the lines through `a b` and `c d` meet, in metres; `None` when they are parallel.
pub fn line_intersection(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> Option<Vec2> {
    let (a, b, c, d) = (a.to_m(), b.to_m(), c.to_m(), d.to_m());
    let (r, s) = (b - a, d - c);
    let cross = r.perp_dot(s);
    (cross != 0.0).then(|| a + r * ((c - a).perp_dot(s) / cross))
}

/// Compares directions `u` and `v` by their angle from east, counter-clockwise, exactly.
/// Zero directions sort first.
pub fn compare_angles(u: (i64, i64), v: (i64, i64)) -> std::cmp::Ordering {
    let half = |(x, y): (i64, i64)| match (x, y) {
        (0, 0) => 0,
        _ if y > 0 || (y == 0 && x > 0) => 1,
        _ => 2,
    };
    half(u).cmp(&half(v)).then_with(|| {
        let cross = i128::from(u.0) * i128::from(v.1) - i128::from(u.1) * i128::from(v.0);
        0.cmp(&cross)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cmp::Ordering;

    #[test]
    fn predicates_are_exact_at_the_limit() {
        let l = LIMIT_MM;
        let (a, b) = (GridPoint { x: -l, y: -l }, GridPoint { x: l, y: l });
        assert!(orient(a, b, GridPoint { x: 0, y: 1 }) > 0);
        assert_eq!(orient(a, b, GridPoint { x: 5, y: 5 }), 0);
        assert!(cross_properly(a, b, GridPoint { x: -1, y: 1 }, GridPoint { x: 1, y: -1 }));
        assert!(!cross_properly(a, b, GridPoint { x: 0, y: 0 }, GridPoint { x: 1, y: -1 }));
    }

    #[test]
    fn angles_turn_counter_clockwise_from_east() {
        let ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
        for (i, u) in ring.iter().enumerate() {
            for (j, v) in ring.iter().enumerate() {
                assert_eq!(compare_angles(*u, *v), i.cmp(&j), "{u:?} {v:?}");
            }
        }
        assert_eq!(compare_angles((2, 2), (1, 1)), Ordering::Equal);
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        assert_eq!(GridPoint::checked(Vec2::new(f64::NAN, 0.0)), None);
        assert_eq!(GridPoint::checked(Vec2::new(1e9, 0.0)), None);
        assert_eq!(
            GridPoint::checked(Vec2::new(1.0004, -2.0)),
            Some(GridPoint { x: 1000, y: -2000 })
        );
    }
}
