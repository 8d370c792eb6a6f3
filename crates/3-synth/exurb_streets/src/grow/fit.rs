//! How well a piece of the example would lie among the streets that are there.
//!
//! The paper judges a patch by the one connector that arrives (eq. 2), which leaves it to chance
//! whether the streets around it meet. We look at the whole surroundings of the place in the example:
//! its streets, shifted, should coincide with streets that are there or lie in the open, and not run
//! close by others or across them.

use exurb_geom::{GridPoint, PointIndex, Vec2, polyline};

use super::growth::Growth;

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

/// Points along the example's streets.
#[derive(Debug)]
pub struct Samples {
    points: Vec<Sample>,
    index: PointIndex,
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
        let mut samples = Self { points: Vec::new(), index: PointIndex::new(LOOK_M / 2.0) };
        for (line, is_main) in lines {
            for w in polyline::resample(&line, STEP_M).windows(2) {
                let (at, direction) = (w[0].midpoint(w[1]), (w[1] - w[0]).normalize_or_zero());
                samples.index.insert(samples.points.len() as u32, at);
                samples.points.push(Sample { at, direction, is_main });
            }
        }
        samples
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

/// How the surroundings of the example's place `root` would lie with that on `at`.
pub fn of(growth: &Growth, start: usize, root: Vec2, at: Vec2) -> Fit {
    let samples = &growth.example(start).samples;
    let shift = at - root;
    let mut fit = Fit::default();
    samples.index.visit(root, LOOK_M, |id| {
        let sample = samples.points[id as usize];
        let p = sample.at + shift;
        if growth.is_main && !sample.is_main || !growth.area.contains(GridPoint::round(p)) {
            return;
        }
        match growth.net.street_near(p, NEAR_M) {
            Some((distance, direction))
                if distance < SAME_M && sample.direction.dot(direction).abs() > SAME_COSINE =>
            {
                fit.same += 1;
            }
            Some(_) => fit.amiss += 1,
            // The example's main streets have no place inside a cell.
            None if sample.is_main != growth.is_main => fit.amiss += 1,
            None => fit.open += 1,
        }
    });
    fit
}
