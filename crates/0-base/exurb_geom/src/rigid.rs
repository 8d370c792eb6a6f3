//! Rigid motions: turn and shift, with or without a mirror.

use crate::{Polygon, Vec2};

/// A motion that keeps lengths: mirror at the y axis (if any), then turn, then shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Cosine and sine of the turn.
    pub turn: Vec2,
    /// The shift in metres, after the turn.
    pub shift: Vec2,
    /// Is x negated first?
    pub mirrored: bool,
}

impl Rigid {
    /// The motion that moves nothing.
    pub const IDENTITY: Self = Self { turn: Vec2::X, shift: Vec2::ZERO, mirrored: false };

    /// Turns by the angle of the unit vector `turn` about `center` and shifts by `shift`.
    pub fn about(center: Vec2, turn: Vec2, shift: Vec2) -> Self {
        Self { turn, shift: center + shift - turn.rotate(center), mirrored: false }
    }

    /// The motion without mirror that brings the first points of pairs nearest to the second ones, by
    /// least squares; the identity without pairs. Weights are positive.
    ///
    /// Source: Hartmann 2018, section 5.1.3; the closed form in the plane. O(pairs).
    pub fn fit(pairs: impl Iterator<Item = (Vec2, Vec2, f64)> + Clone) -> Self {
        let (mut from, mut to, mut total) = (Vec2::ZERO, Vec2::ZERO, 0.0);
        for (p, q, weight) in pairs.clone() {
            (from, to, total) = (from + p * weight, to + q * weight, total + weight);
        }
        if total <= 0.0 {
            return Self::IDENTITY;
        }
        let (from, to) = (from / total, to / total);
        let mut sum = Vec2::ZERO;
        for (p, q, weight) in pairs {
            let (p, q) = (p - from, q - to);
            sum += Vec2::new(p.dot(q), p.perp_dot(q)) * weight;
        }
        let turn = sum.try_normalize().unwrap_or(Vec2::X);
        Self { turn, shift: to - turn.rotate(from), mirrored: false }
    }

    /// Where `p` goes.
    pub fn apply(&self, p: Vec2) -> Vec2 {
        self.turn.rotate(self.flip(p)) + self.shift
    }

    /// Where the direction `v` goes.
    pub fn apply_direction(&self, v: Vec2) -> Vec2 {
        self.turn.rotate(self.flip(v))
    }

    /// Where a polygon goes, on the grid; `None` where rounding leaves no area.
    pub fn apply_polygon(&self, polygon: &Polygon) -> Option<Polygon> {
        polygon.map(|p| self.apply(p))
    }

    /// This motion, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        // A mirror turns a turn before it around.
        let turn = if next.mirrored { Vec2::new(self.turn.x, -self.turn.y) } else { self.turn };
        Self {
            turn: next.turn.rotate(turn),
            shift: next.apply(self.shift),
            mirrored: self.mirrored != next.mirrored,
        }
    }

    fn flip(&self, p: Vec2) -> Vec2 {
        if self.mirrored { Vec2::new(-p.x, p.y) } else { p }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::trig;

    fn motion() -> impl Strategy<Value = Rigid> {
        (0.0..6.3, -90.0..90.0, -90.0..90.0, any::<bool>()).prop_map(|(angle, x, y, mirrored)| {
            Rigid { turn: trig::unit(angle), shift: Vec2::new(x, y), mirrored }
        })
    }

    proptest! {
        #[test]
        fn one_after_the_other_is_both(a in motion(), b in motion(), x in -9.0..9.0, y in -9.0..9.0) {
            let p = Vec2::new(x, y);
            prop_assert!(a.then(&b).apply(p).distance(b.apply(a.apply(p))) < 1e-9);
        }

        #[test]
        fn a_motion_is_found_again(a in motion()) {
            let a = Rigid { mirrored: false, ..a };
            let points = [(0.0, 0.0), (9.0, 1.0), (4.0, 7.0)].map(|(x, y)| Vec2::new(x, y));
            let found = Rigid::fit(points.iter().map(|p| (*p, a.apply(*p), 1.0)));
            prop_assert!(points.iter().all(|p| found.apply(*p).distance(a.apply(*p)) < 1e-9));
        }
    }

    #[test]
    fn no_pairs_move_nothing() {
        assert_eq!(Rigid::fit(std::iter::empty()), Rigid::IDENTITY);
        let same = Vec2::new(2.0, 3.0);
        assert_eq!(Rigid::fit([(same, same, 1.0)].into_iter()), Rigid::IDENTITY);
    }
}
