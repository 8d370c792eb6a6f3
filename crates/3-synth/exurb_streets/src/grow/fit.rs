//! How well a piece of the example would lie among the streets that are there.
//!
//! The paper judges a patch by the one connector that arrives (eq. 2), which leaves it to chance
//! whether the streets around it meet. We look at the whole surroundings of the place in the example:
//! its streets, shifted, should coincide with streets that are there or lie in the open, and not run
//! close by others or across them.

use exurb_geom::{PointGrid, Vec2, polyline};

use super::growth::Growth;
use super::network::Coherent;

/// Streets of the example are looked at every so many metres.
const STEP_M: f64 = 18.0;
/// Nearer than this to a street of the same direction they coincide with it, in metres.
const SAME_M: f64 = 4.0;
/// Nearer than this to any other they are in its way, in metres.
const NEAR_M: f64 = 22.0;
/// Cosine of the angle up to which directions are the same (20°).
const SAME_COSINE: f64 = 0.94;
/// How far around its root a piece is looked at, in metres.
const LOOK_M: f64 = 160.0;
/// The grain is that of the streets within so many metres.
const GRAIN_M: f64 = 200.0;
/// Waiting streets are looked at up to this, in metres; they go on in a street at most so far beside
/// them and turned by at most so much (18°).
const MET_WITHIN_M: f64 = 300.0;
const MET_M: f64 = 9.0;
const MET_COSINE: f64 = 0.95;

/// Points along the example's streets.
#[derive(Debug)]
pub struct Samples {
    points: Vec<Sample>,
    index: PointGrid,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Vec2,
    direction: Vec2,
    is_main: bool,
}

impl Samples {
    /// The samples of some lines, main streets or not.
    pub fn of(lines: impl Iterator<Item = (Vec<Vec2>, bool)>) -> Self {
        let mut points = Vec::new();
        for (line, is_main) in lines {
            for w in polyline::resample(&line, STEP_M).windows(2) {
                let (at, direction) = (w[0].midpoint(w[1]), (w[1] - w[0]).normalize_or_zero());
                points.push(Sample { at, direction, is_main });
            }
        }
        let places: Vec<Vec2> = points.iter().map(|sample| sample.at).collect();
        Self { index: PointGrid::new(&places, 2.0 * STEP_M), points }
    }
}

/// What became of the example's streets around a root if it lay there, in samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// Coincide with a street.
    pub same: u32,
    /// Lie in the open.
    pub open: u32,
    /// Are in the way of another street.
    pub amiss: u32,
}

impl Fit {
    /// 0 when all is amiss, 1 when nothing is.
    pub fn quality(self) -> f64 {
        let total = f64::from(self.same + self.open + self.amiss);
        if total == 0.0 { 0.5 } else { 1.0 - f64::from(self.amiss) / total }
    }
}

/// How well the grain of the streets around a piece's beginning agrees with that of the streets that
/// are there: 1 when both run in the same two directions, -1 when they cross at half a right angle, near
/// 0 where one of them has no grain.
pub fn grain(growth: &Growth, piece: &Coherent) -> f64 {
    let there = growth.net.grain_near(piece.at, GRAIN_M);
    let samples = &growth.plan.examples[piece.example].samples;
    let mut own = Vec2::ZERO;
    let mut count = 0.0;
    samples.index.visit(piece.source, GRAIN_M, |id| {
        own += fourfold(piece.motion.apply(samples.points[id as usize].direction));
        count += 1.0;
    });
    if count > 0.0 { there.dot(own / count) } else { 0.0 }
}

/// A direction with its angle multiplied by four, so that those at right angles are one; a unit vector.
pub fn fourfold(direction: Vec2) -> Vec2 {
    let double = direction.rotate(direction);
    double.rotate(double).normalize_or_zero()
}

/// Waiting streets that lead onto a piece's ground, as far as it is looked at: how many would go on in
/// one of its streets, and how many would not.
pub fn met(growth: &Growth, piece: &Coherent) -> (u32, u32) {
    let samples = &growth.plan.examples[piece.example].samples;
    let (mut met, mut missed) = (0, 0);
    let reach_m = piece.reach_m.min(MET_WITHIN_M);
    for (_, leaving) in growth.seams.near(piece.at, reach_m) {
        if growth.claims.owner(leaving.exit).is_some_and(|owner| owner != leaving.piece.id) {
            continue;
        }
        let (at, direction) = (piece.original(leaving.exit), piece.motion.undo(leaving.direction));
        let direction = direction.normalize_or_zero();
        let mut found = false;
        samples.index.visit(at, STEP_M, |id| {
            let sample = samples.points[id as usize];
            let offset = (sample.at - at).perp_dot(direction).abs();
            found |= sample.is_main == growth.is_main
                && offset < MET_M
                && sample.direction.dot(direction).abs() > MET_COSINE;
        });
        if found {
            met += 1;
        } else {
            missed += 1;
        }
    }
    (met, missed)
}

/// How the surroundings of a piece's beginning would lie.
pub fn of(growth: &Growth, piece: &Coherent) -> Fit {
    let samples = &growth.plan.examples[piece.example].samples;
    let mut fit = Fit::default();
    samples.index.visit(piece.source, LOOK_M, |id| {
        let sample = samples.points[id as usize];
        let p = piece.place(sample.at);
        if growth.is_main && !sample.is_main || !growth.claims.is_inside(p) {
            return;
        }
        match growth.net.street_near(p, NEAR_M) {
            Some((distance, direction))
                if distance < SAME_M
                    && piece.motion.apply(sample.direction).dot(direction).abs() > SAME_COSINE =>
            {
                fit.same += 1;
            }
            // On ground that another piece has claimed nothing will be laid.
            _ if growth.claims.owner(p).is_some() => {}
            Some(_) => fit.amiss += 1,
            // The example's main streets have no place inside a cell.
            None if sample.is_main != growth.is_main => fit.amiss += 1,
            None => fit.open += 1,
        }
    });
    fit
}
