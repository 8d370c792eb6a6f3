//! The held-out part that everything is compared with, and distances from it.

use std::collections::BTreeMap;

use exurb_measure::Sample;
use exurb_operation::rng;

use crate::draws::{self, ByWeight};
use crate::measures::{Distance, Measure};
use crate::patches::{Patches, kernel_distance, told_apart};
use crate::scorecard::mean;
use crate::{Measured, distance};

/// Repetitions of a draw of values, of a draw of blocks.
const REPETITIONS: u64 = 6;
const BLOCK_REPETITIONS: u64 = 4;
/// Blocks drawn at most.
const MOST_BLOCKS: usize = 500;
/// Spreads of log area and Φ count as at least this.
const LEAST_SPREADS: [f64; 2] = [0.15, 0.05];

/// One city of a comparison: what was measured of it, and its patches.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    /// Streets and blocks.
    pub measured: &'a Measured,
    /// Patches, where the discriminator takes part.
    pub patches: Option<&'a Patches>,
}

/// A held-out part, prepared for comparing many cities with it.
#[derive(Debug)]
pub struct HeldOut {
    measured: Measured,
    patches: Option<Patches>,
    /// How many values are drawn, by measure.
    draws: BTreeMap<&'static str, usize>,
    /// What is drawn of the part, and where of others, by measure and repetition.
    drawn: BTreeMap<&'static str, Vec<Drawn>>,
    seed: u64,
}

/// One draw of the part, and the places of one draw of whatever it is compared with.
#[derive(Debug)]
struct Drawn {
    own: Vec<f64>,
    places: Vec<f64>,
}

impl HeldOut {
    /// Prepares a part. `real` are all real sets of the comparison, this one among them or not: the
    /// smallest tells how many values are drawn.
    pub fn new<'a>(
        measured: Measured,
        patches: Option<Patches>,
        real: impl IntoIterator<Item = &'a Measured>,
        seed: u64,
    ) -> Self {
        let mut smallest: BTreeMap<&'static str, usize> = BTreeMap::new();
        let real = real.into_iter().flat_map(|m| m.sizes.iter());
        for (name, size) in real.chain(measured.sizes.iter()) {
            smallest.entry(*name).and_modify(|s| *s = *size.min(s)).or_insert(*size);
        }
        let draws: BTreeMap<_, _> =
            smallest.into_iter().map(|(name, size)| (name, draws::size(size))).collect();
        let drawn = measured.samples.iter().map(|(name, sample)| {
            let count = draws.get(name).copied().unwrap_or(draws::LEAST);
            let draw = |repetition: u64| {
                let places = |side: u64| {
                    draws::places(count, &mut rng::stream(seed, name, 2 * repetition + side))
                };
                Drawn { own: draws::at_places(sample, &places(1)), places: places(0) }
            };
            (*name, (0..REPETITIONS).map(draw).collect())
        });
        Self { drawn: drawn.collect(), measured, patches, draws, seed }
    }

    /// What was measured of the part.
    pub fn measured(&self) -> &Measured {
        &self.measured
    }

    /// Its patches.
    pub fn patches(&self) -> Option<&Patches> {
        self.patches.as_ref()
    }

    /// Has the part what this measure looks at?
    pub fn has(&self, measure: &Measure) -> bool {
        let m = &self.measured;
        match measure.distance {
            Distance::Wasserstein(_) => m.samples.contains_key(measure.name),
            Distance::Variation => m.degrees.is_some(),
            Distance::Rotation => m.bearings.is_some(),
            Distance::Discrepancy => !m.fingerprint.is_empty(),
            Distance::Classifier | Distance::Kernel => self.patches.is_some(),
        }
    }

    /// How far `other` is from the part; `None` where one of both lacks what is measured. The same
    /// city gives the same distance again.
    pub fn distance(&self, measure: &Measure, other: Side) -> Option<f64> {
        let (own, its) = (&self.measured, other.measured);
        let patches = || Some((other.patches?, self.patches.as_ref()?));
        match measure.distance {
            Distance::Wasserstein(least) => {
                let (a, b) = (its.samples.get(measure.name)?, own.samples.get(measure.name)?);
                Some(self.wasserstein(measure.name, a)? / sigma(b).max(least))
            }
            Distance::Variation => Some(distance::total_variation(&its.degrees?, &own.degrees?)),
            Distance::Rotation => {
                Some(distance::total_variation_rotated(&its.bearings?, &own.bearings?))
            }
            Distance::Discrepancy => self.discrepancy(&its.fingerprint, &own.fingerprint),
            Distance::Classifier => patches().and_then(|(a, b)| told_apart(a, b)),
            Distance::Kernel => patches().map(|(a, b)| kernel_distance(a, b)),
        }
    }

    /// Mean over six draws, equal in number, by weight.
    fn wasserstein(&self, name: &'static str, other: &Sample) -> Option<f64> {
        mean(self.drawn.get(name)?.iter().map(|drawn| {
            let its = draws::at_places(other, &drawn.places);
            distance::wasserstein_of_sorted(&its, &drawn.own)
        }))
    }

    fn discrepancy(&self, a: &Fingerprint, b: &Fingerprint) -> Option<f64> {
        if a.is_empty() || b.is_empty() {
            return None;
        }
        let spreads = spreads(b);
        let count = self.draws.get("block_area").copied().unwrap_or(MOST_BLOCKS).min(MOST_BLOCKS);
        let once = |repetition: u64| {
            let drawn = |set: &Fingerprint, side: u64| -> Vec<[f64; 2]> {
                let weights: Vec<f64> = set.iter().map(|(_, weight)| *weight).collect();
                let by_weight = ByWeight::new(&weights);
                let mut rng = rng::stream(self.seed, "block_fingerprint", 2 * repetition + side);
                let unit = |[x, y]: [f64; 2]| [x / spreads[0], y / spreads[1]];
                (0..count).map(|_| unit(set[by_weight.draw(&mut rng)].0)).collect()
            };
            distance::squared_discrepancy(&drawn(a, 0), &drawn(b, 1)).max(0.0).sqrt()
        };
        Some((0..BLOCK_REPETITIONS).map(once).sum::<f64>() / BLOCK_REPETITIONS as f64)
    }
}

type Fingerprint = Vec<([f64; 2], f64)>;

/// Robust standard deviation (p90 - p10) / 2.56.
pub fn sigma(sample: &Sample) -> f64 {
    match sample.quantiles(&[0.1, 0.9])[..] {
        [low, high] => (high - low) / 2.56,
        _ => 0.0,
    }
}

/// Weighted standard deviations, at least those of [`LEAST_SPREADS`].
fn spreads(set: &Fingerprint) -> [f64; 2] {
    let total: f64 = set.iter().map(|(_, w)| w).sum();
    [0, 1].map(|axis| {
        let mean = set.iter().map(|(p, w)| p[axis] * w).sum::<f64>() / total;
        let square = set.iter().map(|(p, w)| w * (p[axis] - mean) * (p[axis] - mean)).sum::<f64>();
        (square / total).sqrt().max(LEAST_SPREADS[axis])
    })
}
