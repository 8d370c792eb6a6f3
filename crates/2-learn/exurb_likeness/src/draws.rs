//! Equal draws: both sides of a comparison are drawn to the same number of values, so that neither
//! size nor weights bias their distance.

use exurb_measure::Sample;
use exurb_operation::Rng;
use rand::RngExt;

/// At most so many values are drawn.
pub const MOST: usize = 2500;
/// At least so many values are drawn.
pub const LEAST: usize = 20;

/// How many to draw when the smallest real set has `smallest` values.
pub fn size(smallest: usize) -> usize {
    smallest.clamp(LEAST, MOST)
}

/// Indices of items drawn with replacement by weight.
#[derive(Clone, Debug)]
pub struct ByWeight {
    cumulative: Vec<f64>,
}

impl ByWeight {
    /// Of items with these weights, all positive.
    pub fn new(weights: &[f64]) -> Self {
        let mut sum = 0.0;
        let cumulative = weights.iter().map(|w| {
            sum += w;
            sum
        });
        Self { cumulative: cumulative.collect() }
    }

    /// One index; there is at least one item.
    pub fn draw(&self, rng: &mut Rng) -> usize {
        let last = self.cumulative.len() - 1;
        let at = rng.random::<f64>() * self.cumulative[last];
        self.cumulative.partition_point(|c| *c <= at).min(last)
    }
}

/// `count` values drawn by weight, ascending.
pub fn sorted(sample: &Sample, count: usize, rng: &mut Rng) -> Vec<f64> {
    let by_weight = ByWeight::new(sample.weights());
    let mut values: Vec<f64> = (0..count).map(|_| sample.values()[by_weight.draw(rng)]).collect();
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_the_weights() {
        let sample = Sample::weighted([(1.0, 1.0), (2.0, 3.0)]);
        let drawn = sorted(&sample, 4000, &mut exurb_operation::rng::stream(1, "test", 0));
        let twos = drawn.iter().filter(|v| **v == 2.0).count();
        assert!((2900..3100).contains(&twos), "{twos}");
    }
}
