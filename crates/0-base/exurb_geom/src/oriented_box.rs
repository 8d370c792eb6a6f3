//! The smallest enclosing rectangle of a set of points.

use crate::{GridPoint, Vec2};

/// A rectangle in any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Its middle, in metres.
    pub center: Vec2,
    /// Unit vector along the longer side.
    pub axis: Vec2,
    /// Half the longer and half the shorter side, in metres.
    pub half: Vec2,
}

impl OrientedBox {
    /// The rectangle of least area around `points`; `None` when they all lie on one line.
    /// Rotating calipers over the convex hull, O(n log n + h²).
    pub fn of(points: &[GridPoint]) -> Option<Self> {
        let hull = convex_hull(points);
        if hull.len() < 3 {
            return None;
        }
        let mut best: Option<(f64, Self)> = None;
        for i in 0..hull.len() {
            let side = hull[(i + 1) % hull.len()] - hull[i];
            let u = side.normalize();
            let v = u.perp();
            let (mut lo, mut hi) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
            for p in &hull {
                let q = Vec2::new(p.dot(u), p.dot(v));
                (lo, hi) = (lo.min(q), hi.max(q));
            }
            let size = hi - lo;
            let area = size.x * size.y;
            // A relative margin keeps the choice among equal boxes the same after a translation.
            if best.as_ref().is_none_or(|(least, _)| area < least * (1.0 - 1e-9)) {
                let middle = (lo + hi) / 2.0;
                let center = u * middle.x + v * middle.y;
                let (axis, half) = if size.x >= size.y {
                    (u, size / 2.0)
                } else {
                    (v, Vec2::new(size.y, size.x) / 2.0)
                };
                best = Some((area, Self { center, axis, half }));
            }
        }
        best.map(|(_, b)| b)
    }

    /// Length of the longer side in metres.
    pub fn long_m(&self) -> f64 {
        self.half.x * 2.0
    }

    /// Length of the shorter side in metres.
    pub fn short_m(&self) -> f64 {
        self.half.y * 2.0
    }

    /// Shorter over longer side, in `0..=1`.
    pub fn aspect(&self) -> f64 {
        self.half.y / self.half.x
    }

    /// Area in m².
    pub fn area_m2(&self) -> f64 {
        4.0 * self.half.x * self.half.y
    }

    /// The corners, counter-clockwise.
    pub fn corners(&self) -> [Vec2; 4] {
        let (a, b) = (self.axis * self.half.x, self.axis.perp() * self.half.y);
        [self.center - a - b, self.center + a - b, self.center + a + b, self.center - a + b]
    }
}

/// The convex hull in metres, counter-clockwise, without points on its sides.
pub fn convex_hull(points: &[GridPoint]) -> Vec<Vec2> {
    let mut sorted = points.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted.iter().map(|p| p.to_m()).collect();
    }
    let half = |points: &mut dyn Iterator<Item = GridPoint>| {
        let mut chain: Vec<GridPoint> = Vec::new();
        for p in points {
            while chain.len() > 1
                && crate::grid::orient(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter().copied());
    hull.extend(half(&mut sorted.iter().rev().copied()));
    hull.iter().map(|p| p.to_m()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trig;

    #[test]
    fn a_turned_rectangle_is_its_own_box() {
        let turn = trig::unit(0.4);
        let corners = [(0.0, 0.0), (30.0, 0.0), (30.0, 12.0), (0.0, 12.0), (15.0, 6.0)];
        let points = corners.map(|(x, y)| GridPoint::round(turn.rotate(Vec2::new(x, y))));
        let found = OrientedBox::of(&points).expect("not on a line");
        assert!((found.long_m() - 30.0).abs() < 0.01 && (found.short_m() - 12.0).abs() < 0.01);
        assert!(found.axis.perp_dot(turn).abs() < 1e-3);
    }

    #[test]
    fn points_on_a_line_have_no_box() {
        let line = [0.0, 1.0, 5.0].map(|v| GridPoint::m(v, v));
        assert_eq!(OrientedBox::of(&line), None);
    }
}
