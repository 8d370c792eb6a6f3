//! A boundary ring measured along its length, and the sides between its corners.

use exurb_geom::{GridPoint, Vec2, polyline, trig};

/// A turn of at least this much is a corner, in radians (40°).
const CORNER_RAD: f64 = 0.7;
/// Directions at a corner are taken over this length, so that chamfers count as one corner. Metres.
const REACH_M: f64 = 8.0;

/// A closed line with positions along it; the block lies to its left.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    points: Vec<Vec2>,
    starts_m: Vec<f64>,
}

/// A stretch of a ring between two corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Where it begins, in metres along the ring.
    pub start_m: f64,
    /// Where it ends; beyond the ring's length when it runs over its start.
    pub end_m: f64,
    /// Turn at its start in radians, positive where the block's corner sticks out.
    pub turn_before_rad: f64,
    /// Turn at its end.
    pub turn_after_rad: f64,
}

impl Side {
    /// Its length in metres.
    pub fn length_m(&self) -> f64 {
        self.end_m - self.start_m
    }
}

impl Ring {
    /// The ring through `points`, which are open (the last differs from the first).
    pub fn of(points: &[GridPoint]) -> Self {
        let mut points: Vec<Vec2> = polyline::to_m(points);
        points.extend(points.first().copied());
        let mut starts_m = Vec::with_capacity(points.len());
        let mut at = 0.0;
        for (i, p) in points.iter().enumerate() {
            if i > 0 {
                at += points[i - 1].distance(*p);
            }
            starts_m.push(at);
        }
        Self { points, starts_m }
    }

    /// Its length in metres.
    pub fn length_m(&self) -> f64 {
        self.starts_m.last().copied().unwrap_or(0.0)
    }

    /// The point `at_m` along it, counted on over its start.
    pub fn point_at(&self, at_m: f64) -> Vec2 {
        let at = at_m.rem_euclid(self.length_m());
        let i = self.segment_at(at);
        let step = self.starts_m[i + 1] - self.starts_m[i];
        let t = if step > 0.0 { ((at - self.starts_m[i]) / step).clamp(0.0, 1.0) } else { 0.0 };
        self.points[i].lerp(self.points[i + 1], t)
    }

    /// Does it go around `p`?
    pub fn winds_around(&self, p: Vec2) -> bool {
        self.points.windows(2).fold(false, |inside, w| {
            let (a, b) = (w[0], w[1]);
            let crossed =
                (a.y > p.y) != (b.y > p.y) && ((b - a).perp_dot(p - a) > 0.0) == (b.y > a.y);
            inside ^ crossed
        })
    }

    /// The sides between corners; one from 0 around when there is no corner.
    pub fn sides(&self) -> Vec<Side> {
        let corners = self.corners();
        let length = self.length_m();
        let Some(&(first_m, first_turn)) = corners.first() else {
            let none = 0.0;
            return vec![Side {
                start_m: 0.0,
                end_m: length,
                turn_before_rad: none,
                turn_after_rad: none,
            }];
        };
        let next = corners.iter().skip(1).copied().chain([(first_m + length, first_turn)]);
        corners
            .iter()
            .zip(next)
            .map(|(before, after)| Side {
                start_m: before.0,
                end_m: after.0,
                turn_before_rad: before.1,
                turn_after_rad: after.1,
            })
            .collect()
    }

    /// Corners as position and signed turn, in order along the ring. Of vertices near each other the
    /// sharpest is the corner.
    pub fn corners(&self) -> Vec<(f64, f64)> {
        let length = self.length_m();
        let reach = REACH_M.min(length / 8.0);
        let turn_at = |at: f64| {
            let p = self.point_at(at);
            let (u, v) = (p - self.point_at(at - reach), self.point_at(at + reach) - p);
            trig::atan2(u.perp_dot(v), u.dot(v))
        };
        let vertices = &self.starts_m[..self.starts_m.len().saturating_sub(1)];
        let mut found: Vec<(f64, f64)> = vertices
            .iter()
            .map(|at| (*at, turn_at(*at)))
            .filter(|(_, turn)| turn.abs() >= CORNER_RAD)
            .collect();
        found.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.total_cmp(&b.0)));
        let apart = |a: f64, b: f64| {
            let d = (a - b).abs();
            d.min(length - d)
        };
        let mut corners: Vec<(f64, f64)> = Vec::new();
        for corner in found {
            if corners.iter().all(|c| apart(c.0, corner.0) > reach * 0.9) {
                corners.push(corner);
            }
        }
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        corners
    }

    /// Position of vertex `i` in metres.
    pub fn vertex_m(&self, i: usize) -> f64 {
        self.starts_m[i]
    }

    /// Positions of the vertices that tell the line to within `tolerance_m`, ascending.
    pub fn outline_m(&self, tolerance_m: f64) -> Vec<f64> {
        let n = self.points.len();
        let far = (0..n).max_by(|i, j| {
            let from_first = |k: usize| self.points[k].distance(self.points[0]);
            from_first(*i).total_cmp(&from_first(*j))
        });
        let far = far.unwrap_or(0);
        let mut keep: Vec<Vec2> = polyline::simplify(&self.points[..=far], tolerance_m);
        keep.extend(polyline::simplify(&self.points[far..], tolerance_m));
        let mut out = Vec::with_capacity(keep.len());
        let mut kept = keep.iter().peekable();
        for (p, at) in self.points[..n - 1].iter().zip(&self.starts_m) {
            if kept.peek() == Some(&p) {
                out.push(*at);
                while kept.peek() == Some(&p) {
                    kept.next();
                }
            }
        }
        out
    }

    /// The line from `from_m` on to `to_m`, which lies ahead by at most once around.
    pub fn part(&self, from_m: f64, to_m: f64) -> Vec<Vec2> {
        let length = self.length_m();
        let mut out = vec![self.point_at(from_m)];
        let n = self.starts_m.len() - 1;
        let turn = (from_m / length).floor();
        let first = self.starts_m[..n].partition_point(|s| *s + turn * length <= from_m);
        for k in first..first + n {
            let at = self.starts_m[k % n] + (turn + (k / n) as f64) * length;
            if at >= to_m {
                break;
            }
            out.push(self.points[k % n]);
        }
        out.push(self.point_at(to_m));
        out.dedup();
        out
    }

    /// The segment that holds `at_m`, which lies in `0..length`.
    fn segment_at(&self, at_m: f64) -> usize {
        let after = self.starts_m.partition_point(|s| *s <= at_m);
        after.saturating_sub(1).min(self.points.len().saturating_sub(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        Ring::of(&points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect::<Vec<_>>())
    }

    const RECTANGLE: [(f64, f64); 4] = [(0., 0.), (100., 0.), (100., 40.), (0., 40.)];

    #[test]
    fn a_rectangle_has_four_sides_with_convex_corners() {
        let lengths: Vec<f64> = ring(&RECTANGLE).sides().iter().map(Side::length_m).collect();
        assert_eq!(lengths, [100.0, 40.0, 100.0, 40.0]);
        assert!(ring(&RECTANGLE).sides().iter().all(|s| s.turn_before_rad > 1.5));
    }

    #[test]
    fn an_l_has_one_corner_that_sticks_in_and_a_chamfer_is_one_corner() {
        let l = ring(&[(0., 0.), (60., 0.), (60., 20.), (20., 20.), (20., 60.), (0., 60.)]);
        assert_eq!(l.sides().iter().filter(|s| s.turn_before_rad < 0.0).count(), 1);
        let chamfer = ring(&[(0., 0.), (97., 0.), (100., 3.), (100., 40.), (0., 40.)]);
        assert_eq!(chamfer.sides().len(), 4);
    }

    #[test]
    fn a_circle_is_one_side() {
        let points: Vec<(f64, f64)> = (0..60)
            .map(|i| trig::unit(f64::from(i) * std::f64::consts::TAU / 60.0) * 50.0)
            .map(|p| (p.x, p.y))
            .collect();
        assert_eq!(ring(&points).sides().len(), 1);
    }

    #[test]
    fn positions_run_over_the_start() {
        assert_eq!(ring(&RECTANGLE).point_at(-10.0), Vec2::new(0.0, 10.0));
    }
}
