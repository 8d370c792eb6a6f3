//! Lines that elements stand along: sides of an outline, and rows inside it.

use exurb_geom::{Rigid, Vec2, polyline};

/// An open line with positions along it; what stands along it lies to its left.
#[derive(Clone, Debug)]
pub struct Path {
    line: Vec<Vec2>,
    length_m: f64,
    is_straight: bool,
}

/// A bent line is taken as straight up to this much, in metres.
const STRAIGHT_M: f64 = 0.2;

impl Path {
    /// The path along `line`; `None` where that has no length.
    pub fn new(line: Vec<Vec2>) -> Option<Self> {
        let length_m = polyline::length(&line);
        let (first, last) = (*line.first()?, *line.last()?);
        let off = |p: &Vec2| polyline::nearest_on_segment(first, last, *p).0.distance(*p);
        let is_straight = line.iter().all(|p| off(p) <= STRAIGHT_M);
        (length_m > 0.0).then_some(Self { line, length_m, is_straight })
    }

    /// Its length in metres.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Its points.
    pub fn line(&self) -> &[Vec2] {
        &self.line
    }

    /// Position along it and distance of the place nearest to `p`.
    pub fn nearest(&self, p: Vec2) -> (f64, f64) {
        let (foot, at_m, _) = polyline::nearest(&self.line, p);
        (at_m, foot.distance(p))
    }

    /// Position along it of the place nearest to `p`, counted on beyond its ends.
    pub fn project(&self, p: Vec2) -> f64 {
        let at_m = self.nearest(p).0;
        let n = self.line.len();
        let along = |from: Vec2, to: Vec2| (p - from).dot((to - from).normalize_or_zero());
        if at_m <= 0.0 {
            along(self.line[0], self.line[1]).min(0.0)
        } else if at_m >= self.length_m {
            self.length_m - along(self.line[n - 1], self.line[n - 2]).min(0.0)
        } else {
            at_m
        }
    }

    /// `p` as one sees it from the path: x along it, y to its left.
    pub fn unrolled(&self, p: Vec2) -> Vec2 {
        let (foot, at_m, k) = polyline::nearest(&self.line, p);
        let (a, b) = (self.line[k], self.line[k + 1]);
        let along = (b - a).normalize_or_zero();
        if at_m <= 0.0 || at_m >= self.length_m {
            return Vec2::new(at_m + (p - foot).dot(along), along.perp_dot(p - foot));
        }
        let side = along.perp_dot(p - a);
        Vec2::new(at_m, foot.distance(p).copysign(side))
    }

    /// The point `at_m` along it, carried on straight beyond its ends.
    pub fn point_at(&self, at_m: f64) -> Vec2 {
        let n = self.line.len();
        if at_m < 0.0 {
            return self.line[0] + (self.line[1] - self.line[0]).normalize_or_zero() * at_m;
        }
        let beyond = at_m - self.length_m;
        if beyond > 0.0 {
            let last = self.line[n - 1];
            return last + (last - self.line[n - 2]).normalize_or_zero() * beyond;
        }
        polyline::point_at(&self.line, at_m)
    }

    /// From the frame of the stretch between two positions to the plane: the origin in the middle of
    /// its chord, x along it, y to the left.
    pub fn frame(&self, from_m: f64, to_m: f64) -> Rigid {
        let (a, b) = (self.point_at(from_m), self.point_at(to_m));
        let turn = if self.is_straight || b.distance(a) < 0.5 {
            let middle = (from_m + to_m) / 2.0;
            let (a, b) = (self.point_at(middle - 0.5), self.point_at(middle + 0.5));
            if self.is_straight { self.line[self.line.len() - 1] - self.line[0] } else { b - a }
        } else {
            b - a
        };
        Rigid { turn: turn.normalize_or(Vec2::X), shift: (a + b) / 2.0, mirrored: false }
    }
}

/// The motion back.
pub fn inverse(motion: &Rigid) -> Rigid {
    let turn = Vec2::new(motion.turn.x, -motion.turn.y);
    Rigid { turn, shift: -turn.rotate(motion.shift), mirrored: false }
}
