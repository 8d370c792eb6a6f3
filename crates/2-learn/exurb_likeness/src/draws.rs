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

    /// One index at random; there is at least one item.
    pub fn draw(&self, rng: &mut Rng) -> usize {
        self.at(rng.random::<f64>())
    }

    /// The index at a place in 0..1; there is at least one item.
    pub fn at(&self, place: f64) -> usize {
        let last = self.cumulative.len() - 1;
        let at = place * self.cumulative[last];
        self.cumulative.partition_point(|c| *c <= at).min(last)
    }
}

/// `count` random places in 0..1, ascending.
pub fn places(count: usize, rng: &mut Rng) -> Vec<f64> {
    let mut places: Vec<f64> = (0..count).map(|_| rng.random::<f64>()).collect();
    places.sort_by(f64::total_cmp);
    places
}

/// Values drawn by weight from a sample in ascending order, one for each place: ascending, too.
pub fn at_places(sorted: &Sample, places: &[f64]) -> Vec<f64> {
    let by_weight = ByWeight::new(sorted.weights());
    places.iter().map(|place| sorted.values()[by_weight.at(*place)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_the_weights() {
        let sample = Sample::weighted([(1.0, 1.0), (2.0, 3.0)]);
        let mut rng = exurb_operation::rng::stream(1, "test", 0);
        let drawn = at_places(&sample, &places(4000, &mut rng));
        let twos = drawn.iter().filter(|v| **v == 2.0).count();
        assert!((2900..3100).contains(&twos), "{twos}");
    }
}
