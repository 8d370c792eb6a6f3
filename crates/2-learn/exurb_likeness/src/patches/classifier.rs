//! A classifier tries to tell the patches of two cities apart.

use linfa::DatasetBase;
use linfa::traits::Fit;
use linfa_logistic::LogisticRegression;
use ndarray::{Array1, Array2, Axis};
use rayon::prelude::*;

use super::Patches;

/// Strength of the penalty on weights: 1 / C with C = 0.003.
const PENALTY: f64 = 1.0 / 0.003;
/// Rounds of the optimiser at most.
const ROUNDS: u64 = 200;

/// How well a classifier tells patches of `a` from patches of `b`: it learns from the patches of one
/// half of both cities and is tried on the other half; mean area under the curve of the west, east,
/// south and north halves. 0.5 = cannot tell, never below; 1 = always tells. `None` where a half
/// holds too few patches.
pub fn told_apart(a: &Patches, b: &Patches) -> Option<f64> {
    let areas = folds(a, b).map(|fold| area_under_curve(&fold.scores, &fold.is_b));
    let areas: Vec<f64> = areas.collect();
    let mean = areas.iter().sum::<f64>() / areas.len() as f64;
    (!areas.is_empty()).then_some(mean.max(0.5))
}

/// How much every patch of `a` gives its city away: the mean score of the classifiers that were tried
/// on it, higher for what `b` has not. 0 for a patch that was never tried.
pub fn telling(a: &Patches, b: &Patches) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); a.halves.len()];
    for fold in folds(a, b) {
        for (row, score) in fold.rows_of_a.iter().zip(&fold.scores) {
            sums[*row].0 -= score;
            sums[*row].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 }).collect()
}

/// A classifier tried on one half of both cities.
struct Fold {
    /// Patches of `a` that it was tried on; their scores come first.
    rows_of_a: Vec<usize>,
    /// Higher for `b`.
    scores: Vec<f64>,
    is_b: Vec<bool>,
}

fn folds(a: &Patches, b: &Patches) -> impl Iterator<Item = Fold> {
    let halves = [(0, true), (0, false), (1, true), (1, false)];
    let found: Vec<Option<Fold>> =
        halves.par_iter().map(|(axis, half)| fold(a, b, *axis, *half)).collect();
    found.into_iter().flatten()
}

fn fold(a: &Patches, b: &Patches, axis: usize, half: bool) -> Option<Fold> {
    let (train, trained_on) = Rows::of(a, b, axis, half)?;
    let (test, tried_on) = Rows::of(a, b, axis, !half)?;
    let standard = Standard::of(&train)?;
    let labels = Array1::from_iter(trained_on.is_b().map(usize::from));
    let model = LogisticRegression::default()
        .alpha(PENALTY)
        .max_iterations(ROUNDS)
        .fit(&DatasetBase::new(standard.apply(train), labels))
        .ok()?;
    let scores = standard.apply(test).dot(model.params());
    // The model calls one of the two labels positive.
    let sign = if model.labels().pos.class == 1 { 1.0 } else { -1.0 };
    let scores = scores.iter().map(|s| s * sign).collect();
    Some(Fold { is_b: tried_on.is_b().collect(), rows_of_a: tried_on.of_a, scores })
}

/// Numbers of the patches of both cities in one half.
struct Rows {
    of_a: Vec<usize>,
    of_b: Vec<usize>,
}

impl Rows {
    /// With their features, those of `a` first. `None` where a city has fewer than two there.
    fn of(a: &Patches, b: &Patches, axis: usize, half: bool) -> Option<(Array2<f64>, Self)> {
        let inside = |p: &Patches| -> Vec<usize> {
            (0..p.halves.len()).filter(|i| p.halves[*i][axis] == half).collect()
        };
        let rows = Self { of_a: inside(a), of_b: inside(b) };
        if rows.of_a.len() < 2 || rows.of_b.len() < 2 {
            return None;
        }
        let chosen = |p: &Patches, rows: &[usize]| p.features.select(Axis(0), rows).mapv(f64::from);
        let (a, b) = (chosen(a, &rows.of_a), chosen(b, &rows.of_b));
        let both = ndarray::concatenate(Axis(0), &[a.view(), b.view()]).ok()?;
        Some((both, rows))
    }

    fn is_b(&self) -> impl Iterator<Item = bool> + '_ {
        self.of_a.iter().map(|_| false).chain(self.of_b.iter().map(|_| true))
    }
}

/// Features in units of their spread, from their mean.
pub(super) struct Standard {
    mean: Array1<f64>,
    spread: Array1<f64>,
}

impl Standard {
    /// Of these rows; `None` when there are none.
    pub(super) fn of(rows: &Array2<f64>) -> Option<Self> {
        let mean = rows.mean_axis(Axis(0))?;
        let spread = rows.std_axis(Axis(0), 0.0).mapv(|s| if s > 1e-9 { s } else { 1.0 });
        Some(Self { mean, spread })
    }

    pub(super) fn apply(&self, rows: Array2<f64>) -> Array2<f64> {
        (rows - &self.mean) / &self.spread
    }
}

/// Area under the receiver operating characteristic: the chance that a random positive scores higher
/// than a random negative, ties counting half. 0.5 where one of both is missing. O(n log n).
pub fn area_under_curve(scores: &[f64], positive: &[bool]) -> f64 {
    let mut order: Vec<usize> = (0..scores.len()).collect();
    order.sort_by(|i, j| scores[*i].total_cmp(&scores[*j]));
    let (mut rank_sum, mut rank) = (0.0, 0.0);
    for tied in order.chunk_by(|i, j| scores[*i] == scores[*j]) {
        let n = tied.len() as f64;
        let middle = rank + (n + 1.0) / 2.0;
        rank_sum += middle * tied.iter().filter(|i| positive[**i]).count() as f64;
        rank += n;
    }
    let positives = positive.iter().filter(|p| **p).count() as f64;
    let negatives = positive.len() as f64 - positives;
    if positives == 0.0 || negatives == 0.0 {
        return 0.5;
    }
    (rank_sum - positives * (positives + 1.0) / 2.0) / (positives * negatives)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_counts_pairs() {
        let positive = [false, false, true, true, true];
        let scores = [0.1, 0.5, 0.5, 0.4, 0.9];
        // Of six pairs four are in order, one is tied.
        assert!((area_under_curve(&scores, &positive) - 4.5 / 6.0).abs() < 1e-12);
        assert_eq!(area_under_curve(&scores, &[true; 5]), 0.5);
    }
}
