//! Values with weights: what every measure of a distribution gives.

/// Values of one measure, each with the weight it counts with. Never holds what is not finite.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    values: Vec<f64>,
    weights: Vec<f64>,
}

impl Sample {
    /// Pairs of value and weight. Pairs that are not finite or have no weight are left out.
    pub fn weighted(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let sound =
            |(value, weight): &(f64, f64)| value.is_finite() && weight.is_finite() && *weight > 0.0;
        let (values, weights) = pairs.into_iter().filter(sound).unzip();
        Self { values, weights }
    }

    /// Values that count alike.
    pub fn plain(values: impl IntoIterator<Item = f64>) -> Self {
        Self::weighted(values.into_iter().map(|value| (value, 1.0)))
    }

    /// The values, in the order they were measured.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The weights, one for each value.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The same values in ascending order.
    pub fn sorted(&self) -> Self {
        let order = self.order();
        Self {
            values: order.iter().map(|i| self.values[*i]).collect(),
            weights: order.iter().map(|i| self.weights[*i]).collect(),
        }
    }

    fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by(|i, j| self.values[*i].total_cmp(&self.values[*j]).then(i.cmp(j)));
        order
    }

    /// Weighted mean; `None` when empty.
    pub fn mean(&self) -> Option<f64> {
        let total: f64 = self.weights.iter().sum();
        let sum: f64 = self.values.iter().zip(&self.weights).map(|(v, w)| v * w).sum();
        (total > 0.0).then(|| sum / total)
    }

    /// Weighted quantiles, `shares` in `0..=1`: linear between the middles of the values' weights,
    /// so that equal weights give every value its usual rank. Empty when the sample is.
    pub fn quantiles(&self, shares: &[f64]) -> Vec<f64> {
        let order = self.order();
        let total: f64 = self.weights.iter().sum();
        let mut middles = Vec::with_capacity(order.len());
        let mut before = 0.0;
        for i in &order {
            middles.push((before + self.weights[*i] / 2.0) / total);
            before += self.weights[*i];
        }
        let at = |share: f64| {
            let above = middles.partition_point(|m| *m < share);
            let value = |k: usize| self.values[order[k]];
            match above {
                0 => value(0),
                k if k == order.len() => value(k - 1),
                k => {
                    let (a, b) = (middles[k - 1], middles[k]);
                    let t = if b > a { (share - a) / (b - a) } else { 1.0 };
                    value(k - 1) + (value(k) - value(k - 1)) * t
                }
            }
        };
        if order.is_empty() { Vec::new() } else { shares.iter().map(|s| at(*s)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_double_weight_is_two_values() {
        let twice = Sample::weighted([(1.0, 1.0), (5.0, 2.0), (9.0, 1.0)]);
        assert_eq!(twice.mean(), Some(5.0));
        assert_eq!(twice.quantiles(&[0.0, 0.5, 1.0]), [1.0, 5.0, 9.0]);
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let sample =
            Sample::weighted([(f64::NAN, 1.0), (1.0, f64::INFINITY), (1.0, 0.0), (2.0, 1.0)]);
        assert_eq!(sample.values(), [2.0]);
        assert!(Sample::default().quantiles(&[0.5]).is_empty());
        assert_eq!(Sample::default().mean(), None);
    }
}
