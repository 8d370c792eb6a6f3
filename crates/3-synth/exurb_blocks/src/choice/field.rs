//! How densely and how high each block is to be built: a smooth field learned from the example.
//!
//! A block's own value is the mean over the example's blocks most like it; neighbours pull each other
//! as much as the example's neighbours are alike; built blocks that stay pull theirs.

use crate::library::Features;

/// Values by block.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Share to be built on.
    pub coverage: Vec<f64>,
    /// Mean height in metres, where the example tells.
    pub height_m: Vec<Option<f64>>,
}

/// What one example block teaches.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// What blocks are compared by.
    pub features: Features,
    /// Share built on.
    pub coverage: f64,
    /// Mean height.
    pub height_m: Option<f64>,
    /// Weight of its example.
    pub weight: f64,
}

/// A block to be given values.
#[derive(Clone, Debug)]
pub struct Place {
    /// What it is compared by.
    pub features: Features,
    /// Its neighbours.
    pub neighbours: Vec<usize>,
    /// What stands there already and stays.
    pub given: Option<(f64, Option<f64>)>,
}

/// Like blocks that are averaged.
const NEAREST: usize = 6;
/// Rounds of smoothing.
const ROUNDS: usize = 40;

/// The field over `places`. `pull` in `0..1` is how much neighbours are alike. O(places · samples).
pub fn field(places: &[Place], samples: &[Sample], pull: f64) -> Field {
    let spread = Features::spread(samples.iter().map(|s| &s.features));
    let own: Vec<(f64, Option<f64>)> = places
        .iter()
        .map(|place| place.given.unwrap_or_else(|| averaged(&place.features, samples, &spread)))
        .collect();
    let coverage = smooth(places, &own.iter().map(|o| Some(o.0)).collect::<Vec<_>>(), pull);
    let height_m = smooth(places, &own.iter().map(|o| o.1).collect::<Vec<_>>(), pull);
    Field { coverage: coverage.into_iter().map(|c| c.unwrap_or(0.0)).collect(), height_m }
}

fn averaged(features: &Features, samples: &[Sample], spread: &Features) -> (f64, Option<f64>) {
    let mut near: Vec<(f64, &Sample)> =
        samples.iter().map(|s| (s.features.distance(features, spread), s)).collect();
    let order = |a: &(f64, &Sample), b: &(f64, &Sample)| a.0.total_cmp(&b.0);
    if near.len() > NEAREST {
        near.select_nth_unstable_by(NEAREST, order);
        near.truncate(NEAREST);
    }
    near.sort_by(order);
    let mean = |value: &dyn Fn(&Sample) -> Option<f64>| {
        let known = near.iter().filter_map(|(_, s)| Some((value(s)?, s.weight)));
        let (sum, total) = known.fold((0.0, 0.0), |(s, t), (v, w)| (s + v * w, t + w));
        (total > 0.0).then(|| sum / total)
    };
    (mean(&|s| Some(s.coverage)).unwrap_or(0.0), mean(&|s| s.height_m))
}

/// Every value drawn towards the mean of its neighbours, given ones staying (Jacobi's method).
fn smooth(places: &[Place], own: &[Option<f64>], pull: f64) -> Vec<Option<f64>> {
    let pull = pull.clamp(0.0, 0.95);
    let mut now = own.to_vec();
    for _ in 0..ROUNDS {
        let next = |(i, place): (usize, &Place)| {
            let around = place.neighbours.iter().filter_map(|j| now[*j]);
            let (sum, count) = around.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
            match own[i] {
                value if place.given.is_some() || count == 0.0 => value,
                Some(value) => Some(value * (1.0 - pull) + sum / count * pull),
                None => Some(sum / count),
            }
        };
        now = places.iter().enumerate().map(next).collect();
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(coverage: f64) -> Sample {
        Sample {
            features: Features::default(),
            coverage,
            height_m: Some(coverage * 40.0),
            weight: 1.0,
        }
    }

    fn row(given: &[(usize, f64)]) -> Vec<Place> {
        let place = |i: usize| Place {
            features: Features::default(),
            neighbours: [i.checked_sub(1), (i < 8).then_some(i + 1)]
                .into_iter()
                .flatten()
                .collect(),
            given: given.iter().find(|g| g.0 == i).map(|g| (g.1, None)),
        };
        (0..9).map(place).collect()
    }

    #[test]
    fn without_neighbours_pull_each_block_has_its_own_mean() {
        let field = field(&row(&[]), &[sample(0.2), sample(0.4)], 0.0);
        assert!(field.coverage.iter().all(|c| (c - 0.3).abs() < 1e-12));
        assert!(field.height_m.iter().all(|h| (h.expect("known") - 12.0).abs() < 1e-9));
    }

    #[test]
    fn built_blocks_that_stay_pull_their_neighbours_less_and_less() {
        let field = field(&row(&[(0, 0.9)]), &[sample(0.1)], 0.8);
        assert_eq!(field.coverage[0], 0.9);
        assert!(field.coverage.windows(2).all(|w| w[0] > w[1]), "{:?}", field.coverage);
        assert!(field.coverage[1] > 0.3 && field.coverage[8] < 0.15, "{:?}", field.coverage);
    }
}
