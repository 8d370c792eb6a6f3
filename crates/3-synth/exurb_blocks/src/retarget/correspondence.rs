//! Which place of one outline belongs to which of another.

use exurb_geom::{GridPoint, MeanValueMap, Vec2};
use exurb_match::{Contexts, Outline, SAMPLES, Warp, outer_radius_m, time_warp};

use crate::ring::Ring;

/// A monotone map from positions along one closed line to positions along another.
#[derive(Clone, Debug)]
pub struct Correspondence {
    /// Positions that belong together, both ascending; the second ones go once around from the first.
    knots: Vec<(f64, f64)>,
    from_m: f64,
    to_m: f64,
}

/// Corners that belong together lie this near to where the time warp expects them, as a share of the
/// outline, and in metres at least.
const CORNER_SHARE: f64 = 0.06;
const CORNER_LEAST_M: f64 = 8.0;
/// Every so many samples the path gives a knot where corners do not.
const KNOT_SAMPLES: usize = 5;
/// Knots lie at least this far apart, in metres.
const LEAST_STEP_M: f64 = 0.5;
/// Outlines are followed to within this, in metres.
const FOLLOW_M: f64 = 0.3;
/// Vertices nearer than this are the same in an edited outline, in metres.
const SAME_M: f64 = 0.03;

impl Correspondence {
    /// Of an example's outline to a block's, by the path of the time warp whose first samples are the
    /// block's: corners to corners, and in between by length; stretches whose corners have no partner
    /// follow the path (method: mean position of a sample's partners, kept monotone).
    pub fn by_warp(warp: &Warp, from: &Ring, to: &Ring) -> Self {
        let path = Self {
            knots: path_knots(warp, from, to),
            from_m: from.length_m(),
            to_m: to.length_m(),
        };
        let pairs = path.paired_corners(from, to);
        if pairs.len() < 2 {
            return path;
        }
        let mut knots = Vec::new();
        for (k, &(s, t)) in pairs.iter().enumerate() {
            let next = pairs
                .get(k + 1)
                .copied()
                .unwrap_or((pairs[0].0 + path.from_m, pairs[0].1 + path.to_m));
            knots.push((s, t));
            let has_corner = |ring: &Ring, from: f64, to: f64| {
                let inside = |at: f64| (at - from).rem_euclid(ring.length_m());
                ring.corners().iter().any(|c| inside(c.0) > 1.0 && inside(c.0) < to - from - 1.0)
            };
            if has_corner(from, s, next.0) || has_corner(to, t, next.1) {
                knots.extend(path.between((s, t), next));
            }
        }
        Self { knots, ..path }.tidied()
    }

    /// [`Self::by_warp`] of two closed lines, by a time warp of their own.
    pub fn by_shape(from: &[GridPoint], to: &[GridPoint]) -> Self {
        let (a, b) = (Outline::of(from), Outline::of(to));
        let radius_m = outer_radius_m(&b);
        let costs = Contexts::of(&b, radius_m).costs(&Contexts::of(&a, radius_m));
        Self::by_warp(&time_warp::cyclic(&costs), &Ring::of(from), &Ring::of(to))
    }

    /// Of an outline to what an edit made of it: vertices that did not move belong to themselves, runs
    /// of moved ones to each other in order where they are as many, else by length. `None` where fewer
    /// than two vertices stayed.
    pub fn by_vertices(from: &[GridPoint], to: &[GridPoint]) -> Option<Self> {
        let (source, target) = (Ring::of(from), Ring::of(to));
        let stayed = stayed(from, to)?;
        let mut knots = Vec::new();
        for (k, &(i, j)) in stayed.iter().enumerate() {
            let (next_i, next_j) = stayed[(k + 1) % stayed.len()];
            let run = |at: usize, next: usize, n: usize| (next + n - at - 1) % n;
            let (moved, new) = (run(i, next_i, from.len()), run(j, next_j, to.len()));
            knots.push((source.vertex_m(i), target.vertex_m(j)));
            if moved == new {
                let at = |m: usize| {
                    (source.vertex_m((i + m) % from.len()), target.vertex_m((j + m) % to.len()))
                };
                knots.extend((1..=moved).map(at));
            }
        }
        Some(Self { knots, from_m: source.length_m(), to_m: target.length_m() }.tidied())
    }

    /// The place on the second outline that belongs to `at_m` on the first, unwrapped.
    pub fn to_target(&self, at_m: f64) -> f64 {
        interpolated(&self.knots, at_m, self.from_m, self.to_m)
    }

    /// The place on the first outline that belongs to `at_m` on the second, unwrapped.
    pub fn to_source(&self, at_m: f64) -> f64 {
        let mirrored: Vec<(f64, f64)> = self.knots.iter().map(|(s, t)| (*t, *s)).collect();
        interpolated(&mirrored, at_m, self.to_m, self.from_m)
    }

    /// The map of the first outline's inside: both outlines with a corner wherever either has one.
    pub fn map(&self, from: &Ring, to: &Ring) -> Option<MeanValueMap> {
        let mut pairs: Vec<(f64, f64)> = self.knots.clone();
        pairs.extend(from.outline_m(FOLLOW_M).into_iter().map(|s| (s, self.to_target(s))));
        pairs.extend(to.outline_m(FOLLOW_M).into_iter().map(|t| (self.to_source(t), t)));
        let wrapped = |(s, t): &(f64, f64)| (s.rem_euclid(self.from_m), t.rem_euclid(self.to_m));
        let mut pairs: Vec<(f64, f64)> = pairs.iter().map(wrapped).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        pairs.dedup_by(|a, b| (a.0 - b.0).abs() < 0.05);
        let points = |pick: fn(&(f64, f64)) -> f64, ring: &Ring| -> Vec<Vec2> {
            pairs.iter().map(|pair| ring.point_at(pick(pair))).collect()
        };
        MeanValueMap::new(points(|p| p.0, from), points(|p| p.1, to))
    }

    /// Corners of both outlines that belong together, in order.
    fn paired_corners(&self, from: &Ring, to: &Ring) -> Vec<(f64, f64)> {
        let reach_m = (CORNER_SHARE * self.to_m).max(CORNER_LEAST_M);
        let around = |d: f64| (d + self.to_m / 2.0).rem_euclid(self.to_m) - self.to_m / 2.0;
        let mut found: Vec<(f64, f64, f64)> = Vec::new();
        for (s, turn) in from.corners() {
            let expected = self.to_target(s);
            for (t, other) in to.corners() {
                let off = around(t - expected);
                if off.abs() <= reach_m && turn * other > 0.0 {
                    found.push((off.abs() + 10.0 * (turn - other).abs(), s, expected + off));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut pairs: Vec<(f64, f64)> = Vec::new();
        for (_, s, t) in found {
            let fits = |(p, q): &(f64, f64)| {
                let ahead = (s - p).rem_euclid(self.from_m);
                let there = (t - q).rem_euclid(self.to_m);
                ahead > LEAST_STEP_M
                    && there > LEAST_STEP_M
                    && self.from_m - ahead > LEAST_STEP_M
                    && self.to_m - there > LEAST_STEP_M
                    // Both are as far on, give or take.
                    && (ahead / self.from_m - there / self.to_m).abs() < 0.5
            };
            if pairs.iter().all(fits) {
                pairs.push((s, t));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        monotone(pairs, self.to_m)
    }

    /// Knots of the path strictly between two places.
    fn between(&self, from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64)> {
        let shift = |at: f64, start: f64, length: f64| start + (at - start).rem_euclid(length);
        let moved = self
            .knots
            .iter()
            .map(|(s, t)| (shift(*s, from.0, self.from_m), shift(*t, from.1, self.to_m)));
        let mut inside: Vec<(f64, f64)> =
            moved.filter(|(s, t)| *s > from.0 && *s < to.0 && *t > from.1 && *t < to.1).collect();
        inside.sort_by(|a, b| a.0.total_cmp(&b.0));
        inside
    }

    /// Knots in order, apart from each other.
    fn tidied(mut self) -> Self {
        let first = self.knots.first().copied().unwrap_or((0.0, 0.0));
        let mut out: Vec<(f64, f64)> = Vec::new();
        for (s, t) in &self.knots {
            let (s, t) = (
                first.0 + (s - first.0).rem_euclid(self.from_m),
                first.1 + (t - first.1).rem_euclid(self.to_m),
            );
            let apart = out
                .last()
                .is_none_or(|last| s - last.0 > LEAST_STEP_M && t - last.1 > LEAST_STEP_M);
            let room =
                first.0 + self.from_m - s > LEAST_STEP_M && first.1 + self.to_m - t > LEAST_STEP_M;
            if apart && (room || out.is_empty()) {
                out.push((s, t));
            }
        }
        self.knots = out;
        self
    }
}

/// The longest run of pairs whose second places go around once in order.
fn monotone(pairs: Vec<(f64, f64)>, to_m: f64) -> Vec<(f64, f64)> {
    let Some(&(_, start)) = pairs.first() else { return pairs };
    let mut out: Vec<(f64, f64)> = Vec::new();
    for (s, t) in pairs {
        let t = start + (t - start).rem_euclid(to_m);
        if out.last().is_none_or(|last| t > last.1) {
            out.push((s, t));
        }
    }
    out
}

/// Knots along the path: for every few samples of the first outline the mean place of its partners.
fn path_knots(warp: &Warp, from: &Ring, to: &Ring) -> Vec<(f64, f64)> {
    let n = SAMPLES as f64;
    let mut knots: Vec<(f64, f64)> = Vec::new();
    for same in warp.path.chunk_by(|a, b| a.1 == b.1) {
        let mean = same.iter().map(|p| f64::from(p.0)).sum::<f64>() / same.len() as f64;
        let (s, t) = (f64::from(same[0].1) / n * from.length_m(), mean / n * to.length_m());
        let apart = knots.last().is_none_or(|last| t - last.1 > LEAST_STEP_M);
        if (same[0].1 as usize).is_multiple_of(KNOT_SAMPLES) && apart {
            knots.push((s, t));
        }
    }
    while knots.len() > 1 && knots[knots.len() - 1].1 - knots[0].1 > to.length_m() - LEAST_STEP_M {
        knots.pop();
    }
    knots
}

fn interpolated(knots: &[(f64, f64)], at: f64, from_m: f64, to_m: f64) -> f64 {
    let Some(&first) = knots.first() else { return at / from_m * to_m };
    let turns = ((at - first.0) / from_m).floor();
    let local = at - turns * from_m;
    let after = knots.partition_point(|k| k.0 <= local).max(1);
    let a = knots[after - 1];
    let b = knots.get(after).copied().unwrap_or((first.0 + from_m, first.1 + to_m));
    let share = (local - a.0) / (b.0 - a.0);
    a.1 + share * (b.1 - a.1) + turns * to_m
}

/// Pairs of vertices that are the same in both rings, in cyclic order; `None` with fewer than two.
fn stayed(from: &[GridPoint], to: &[GridPoint]) -> Option<Vec<(usize, usize)>> {
    let near = |p: GridPoint| to.iter().position(|q| p.distance_m(*q) <= SAME_M);
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for (i, p) in from.iter().enumerate() {
        let Some(j) = near(*p) else { continue };
        let ahead = |j: usize| (j + to.len() - pairs[0].1) % to.len();
        if pairs.last().is_none_or(|last| ahead(j) > ahead(last.1)) {
            pairs.push((i, j));
        }
    }
    (pairs.len() >= 2).then_some(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(corners: &[(f64, f64)]) -> Vec<GridPoint> {
        corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect()
    }

    #[test]
    fn corners_go_to_corners() {
        let from = ring(&[(0., 0.), (100., 0.), (100., 40.), (0., 40.)]);
        let to = ring(&[(130., 0.), (130., 50.), (0., 45.), (0., 0.)]);
        let link = Correspondence::by_shape(&from, &to);
        let (a, b) = (Ring::of(&from), Ring::of(&to));
        for s in [0.0, 100.0, 140.0, 240.0] {
            let there = b.point_at(link.to_target(s));
            let corner = to.iter().map(|p| p.to_m().distance(there)).fold(f64::INFINITY, f64::min);
            assert!(corner < 1e-6, "{s}: {there}");
            assert!((link.to_source(link.to_target(s)) - s).abs() < 1e-9);
        }
        let map = link.map(&a, &b).expect("a map");
        assert!(map.apply(Vec2::new(50.0, 20.0)).distance(Vec2::new(65.0, 24.0)) < 3.0);
    }

    #[test]
    fn positions_only_go_forward() {
        let from = ring(&[(0., 0.), (60., 0.), (60., 20.), (20., 20.), (20., 60.), (0., 60.)]);
        let to = ring(&[(0., 0.), (90., 10.), (70., 80.), (10., 70.)]);
        let link = Correspondence::by_shape(&from, &to);
        let along: Vec<f64> = (0..480).map(|k| link.to_target(f64::from(k) * 0.5)).collect();
        assert!(along.windows(2).all(|w| w[1] > w[0]));
    }

    #[test]
    fn an_edit_keeps_what_it_does_not_touch() {
        let from = ring(&[(0., 0.), (100., 0.), (100., 40.), (0., 40.)]);
        let moved = ring(&[(0., 0.), (100., 0.), (120., 60.), (0., 40.)]);
        let link = Correspondence::by_vertices(&from, &moved).expect("vertices stayed");
        assert_eq!(link.to_target(30.0), 30.0);
        assert_eq!(link.to_target(100.0), 100.0);
        let corner = Ring::of(&moved).point_at(link.to_target(140.0));
        assert!(corner.distance(Vec2::new(120.0, 60.0)) < 1e-9);
        // A vertex inserted into a side.
        let split = ring(&[(0., 0.), (50., -20.), (100., 0.), (100., 40.), (0., 40.)]);
        let link = Correspondence::by_vertices(&from, &split).expect("vertices stayed");
        let middle = Ring::of(&split).point_at(link.to_target(50.0));
        assert!(middle.distance(Vec2::new(50.0, -20.0)) < 1e-9);
        assert!(
            Correspondence::by_vertices(&from, &ring(&[(9., 9.), (20., 9.), (9., 20.)])).is_none()
        );
    }
}
