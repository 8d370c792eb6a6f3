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
    let folds = [(0, true), (0, false), (1, true), (1, false)];
    let areas: Vec<Option<f64>> =
        folds.par_iter().map(|(axis, half)| fold(a, b, *axis, *half)).collect();
    let areas: Vec<f64> = areas.into_iter().flatten().collect();
    let mean = areas.iter().sum::<f64>() / areas.len() as f64;
    (!areas.is_empty()).then_some(mean.max(0.5))
}

fn fold(a: &Patches, b: &Patches, axis: usize, half: bool) -> Option<f64> {
    let (train, train_is_b) = rows(a, b, axis, half)?;
    let (test, test_is_b) = rows(a, b, axis, !half)?;
    let standard = Standard::of(&train)?;
    let labels = Array1::from_iter(train_is_b.iter().map(|b| usize::from(*b)));
    let model = LogisticRegression::default()
        .alpha(PENALTY)
        .max_iterations(ROUNDS)
        .fit(&DatasetBase::new(standard.apply(train), labels))
        .ok()?;
    let scores = standard.apply(test).dot(model.params());
    // The model calls one of the two labels positive.
    let sign = if model.labels().pos.class == 1 { 1.0 } else { -1.0 };
    let scores: Vec<f64> = scores.iter().map(|s| s * sign).collect();
    Some(area_under_curve(&scores, &test_is_b))
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

/// Features of the patches of both cities in one half, and which are of `b`. `None` where one has
/// fewer than two there.
fn rows(a: &Patches, b: &Patches, axis: usize, half: bool) -> Option<(Array2<f64>, Vec<bool>)> {
    let inside = |p: &Patches| -> Vec<usize> {
        (0..p.halves.len()).filter(|i| p.halves[*i][axis] == half).collect()
    };
    let (of_a, of_b) = (inside(a), inside(b));
    if of_a.len() < 2 || of_b.len() < 2 {
        return None;
    }
    let chosen = |p: &Patches, rows: &[usize]| p.features.select(Axis(0), rows).mapv(f64::from);
    let both = ndarray::concatenate(Axis(0), &[chosen(a, &of_a).view(), chosen(b, &of_b).view()]);
    let labels = of_a.iter().map(|_| false).chain(of_b.iter().map(|_| true)).collect();
    Some((both.ok()?, labels))
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
