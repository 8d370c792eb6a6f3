//! What grows where: which example, and how it is turned and stretched.
//!
//! Source: Nishida et al. 2015, sections 5.1 (warping), 5.2 (blending), 5.3 (interpolation).
//! Departures: the example is drawn for places, not for every vertex anew, from numbers that are the
//! same over about [`PATCHINESS_M`], so that styles mix piece by piece; the rotation of a warp
//! changes evenly along the guideline, where the paper gives every start one of its own; eq. (4) is
//! read as in `docs/methods.md`. Interpolation mixes patches too, stretched towards the mean of both
//! styles, unless growth is asked to be procedural.

use exurb_geom::{Vec2, polyline, trig};
use exurb_measure::statistics::StreetStatistics;
use exurb_operation::rng::fnv1a;

use super::domains::Domains;
use super::learn::{Style, Vocabulary};
use super::params::Params;

/// Styles mix in patches of about this size, in metres.
const PATCHINESS_M: f64 = 220.0;
/// Interpolation stretches by no more than this, and by no less than its inverse.
const MOST_STRETCH: f64 = 1.6;
/// Interpolation bends streets by no more than this many times their own curvature.
const MOST_BOW: f64 = 3.0;

/// A place where growth begins.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// The place in the target.
    pub at: Vec2,
    /// Number of the example.
    pub example: usize,
    /// The place in the example that it begins with.
    pub source: Vec2,
}

/// How an example is moved: mirrored, turned and stretched; where to, each copy decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Cosine and sine of the turn.
    pub turn: Vec2,
    /// Is x negated first?
    pub mirrored: bool,
    /// Lengths are multiplied by this.
    pub stretch: f64,
    /// Deviations of streets from their chords are multiplied by this.
    pub bow: f64,
}

impl Motion {
    /// Moves nothing.
    pub const IDENTITY: Self = Self { turn: Vec2::X, mirrored: false, stretch: 1.0, bow: 1.0 };

    /// Where the vector `v` of the example goes.
    pub fn apply(&self, v: Vec2) -> Vec2 {
        let v = if self.mirrored { Vec2::new(-v.x, v.y) } else { v };
        self.turn.rotate(v) * self.stretch
    }

    /// The vector of the example that goes to `v`.
    pub fn undo(&self, v: Vec2) -> Vec2 {
        let v = Vec2::new(self.turn.x, -self.turn.y).rotate(v) / self.stretch;
        if self.mirrored { Vec2::new(-v.x, v.y) } else { v }
    }

    /// A line of the example as it lies when the example's place `root` lies on `at`.
    pub fn lay(&self, line: &[Vec2], root: Vec2, at: Vec2) -> Vec<Vec2> {
        let (first, last) = (line[0], line[line.len() - 1]);
        let total = polyline::length(line);
        let mut along = 0.0;
        let mut before = first;
        line.iter()
            .map(|p| {
                along += p.distance(before);
                before = *p;
                let chord = first.lerp(last, along / total.max(1e-9));
                let bowed = if self.bow == 1.0 { *p } else { chord + (*p - chord) * self.bow };
                at + self.apply(bowed - root)
            })
            .collect()
    }
}

/// A guideline through the target and the line of the example that should follow it (section 5.1).
#[derive(Clone, Debug, Default)]
pub struct Guide {
    /// The line in the target.
    pub target: Vec<Vec2>,
    /// The rotation at each of its points, in radians, without jumps of a full turn.
    turns_rad: Vec<f64>,
}

impl Guide {
    /// The guide of two lines of as many points each, at least two.
    pub fn new(target: Vec<Vec2>, example: &[Vec2]) -> Self {
        let turn = |w: (&[Vec2], &[Vec2])| {
            let (to, from) = ((w.0[1] - w.0[0]).normalize_or_zero(), w.1[1] - w.1[0]);
            Vec2::new(from.dot(to), from.perp_dot(to)).normalize_or(Vec2::X)
        };
        let segments: Vec<Vec2> = target.windows(2).zip(example.windows(2)).map(turn).collect();
        let mut turns_rad: Vec<f64> = Vec::new();
        for i in 0..target.len() {
            // Eq. (3), as the mean of directions, which is safe across half a turn.
            let (before, after) =
                (segments[i.max(1) - 1], segments[i.min(segments.len().saturating_sub(1))]);
            let angle = trig::angle((before + after).normalize_or(before));
            let last = turns_rad.last().copied().unwrap_or(angle);
            let jump = ((angle - last) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            turns_rad.push(angle - jump);
        }
        Self { target, turns_rad }
    }

    /// The rotation at the place of the guideline that is nearest to `p`.
    fn turn_rad(&self, p: Vec2) -> f64 {
        let (_, along, _) = polyline::nearest(&self.target, p);
        let mut start = 0.0;
        for (i, w) in self.target.windows(2).enumerate() {
            let length = w[0].distance(w[1]);
            if along <= start + length {
                let t = (along - start) / length.max(1e-9);
                return self.turns_rad[i] + (self.turns_rad[i + 1] - self.turns_rad[i]) * t;
            }
            start += length;
        }
        self.turns_rad.last().copied().unwrap_or(0.0)
    }
}

/// What grows where.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// The examples.
    pub examples: &'a [Vocabulary],
    /// What the user set.
    pub params: &'a Params,
    /// Where growth begins.
    pub starts: Vec<Start>,
    /// The width of the transition between examples: σ·D of eq. (4), in metres.
    pub blend_m: f64,
    /// Share of the first of two examples where they are interpolated.
    pub interpolation: Option<f64>,
    /// Turns everything, in radians.
    pub rotate_rad: f64,
    /// The guideline of a warp.
    pub guide: Option<Guide>,
    /// Parts of the target with examples of their own.
    pub domains: Domains,
    /// The random seed.
    pub seed: u64,
}

impl Plan<'_> {
    /// The example to copy at `p`.
    pub fn example_at(&self, p: Vec2) -> usize {
        let first = self.starts.first().map_or(0, |s| s.example);
        let weights = match (self.domains.weights_at(p), self.interpolation) {
            (Some(own), _) => own.to_vec(),
            (None, Some(share)) => vec![share, 1.0 - share],
            _ if self.starts.is_empty() => {
                self.examples.iter().map(|e| e.character.weight).collect()
            }
            _ if self.starts.iter().all(|s| s.example == first) => return first,
            _ => self.weights(p),
        };
        let mut left = self.noise(p) * weights.iter().sum::<f64>();
        for (example, weight) in weights.iter().enumerate() {
            left -= weight;
            if left < 0.0 {
                return example;
            }
        }
        first
    }

    /// The examples with their shares of the whole.
    pub fn shares(&self) -> impl Iterator<Item = (&Vocabulary, f64)> {
        self.examples.iter().enumerate().map(|(i, example)| match self.interpolation {
            Some(share) => (example, if i == 0 { share } else { 1.0 - share }),
            None => (example, example.character.weight),
        })
    }

    /// Eq. (4): the weights of the examples at `p`.
    fn weights(&self, p: Vec2) -> Vec<f64> {
        let squares: Vec<f64> = self.starts.iter().map(|s| s.at.distance_squared(p)).collect();
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let mut weights = vec![0.0; self.examples.len()];
        for (start, square) in self.starts.iter().zip(squares) {
            let unit = 2.0 * self.blend_m * self.blend_m;
            let near = if unit > 0.0 {
                trig::exp(-(square - least) / unit)
            } else {
                f64::from(u8::from(square == least))
            };
            weights[start.example] += self.examples[start.example].character.weight * near;
        }
        weights
    }

    /// A number in 0..1 for `p`, the same all around it: Voronoi cells of scattered points.
    fn noise(&self, p: Vec2) -> f64 {
        let (x, y) = ((p.x / PATCHINESS_M).floor() as i64, (p.y / PATCHINESS_M).floor() as i64);
        let mut best = (f64::INFINITY, 0);
        for (column, row) in (-1..=1).flat_map(|r| (-1..=1).map(move |c| (x + c, y + r))) {
            let key = [self.seed.to_le_bytes(), column.to_le_bytes(), row.to_le_bytes()].concat();
            let hash = fnv1a(&key);
            let part = |shift: u32| ((hash >> shift) & 0xFFFF) as f64 / 65_536.0;
            let site = Vec2::new(column as f64 + part(0), row as f64 + part(16)) * PATCHINESS_M;
            let square = site.distance_squared(p);
            if square < best.0 {
                best = (square, hash >> 32);
            }
        }
        (best.1 & 0xFFFF) as f64 / 65_536.0
    }

    /// How that example is moved at `p`.
    pub fn motion_at(&self, p: Vec2, example: usize) -> Motion {
        let guide = self.guide.as_ref().map_or(0.0, |guide| guide.turn_rad(p));
        let turn = trig::unit(self.rotate_rad + guide);
        let mut motion = Motion { turn, ..Motion::IDENTITY };
        if self.interpolation.is_some() {
            let (own, mean) =
                (self.examples[example].local.statistics, self.statistics(example, false));
            let stretch = mean.length_mean_m / own.length_mean_m.max(1.0);
            motion.stretch = stretch.clamp(1.0 / MOST_STRETCH, MOST_STRETCH);
            motion.bow = (mean.curvature_mean / own.curvature_mean.max(1e-6)).min(MOST_BOW);
        }
        motion
    }

    /// The statistics of one example's main or local streets; eq. (5) where examples are interpolated.
    pub fn statistics(&self, example: usize, is_main: bool) -> StreetStatistics {
        let of = |example: usize| {
            let style = self.examples[example].style(is_main);
            style.statistics
        };
        match (self.interpolation, self.examples) {
            (Some(share), [_, _]) => of(0).mixed(of(1), share),
            _ => of(example),
        }
    }
}

impl Vocabulary {
    /// Main or local streets.
    pub fn style(&self, is_main: bool) -> &Style {
        if is_main { &self.main } else { &self.local }
    }
}
