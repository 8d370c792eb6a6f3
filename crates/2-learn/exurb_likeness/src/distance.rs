//! Distances between distributions.

use exurb_geom::trig;
use exurb_measure::Sample;

/// 1-Wasserstein distance of two weighted samples: the area between their cumulative shares. `None`
/// when one is empty. O(n log n).
pub fn wasserstein(a: &Sample, b: &Sample) -> Option<f64> {
    let mut area = 0.0;
    walk(a, b, |gap, width| area += gap * width)?;
    Some(area)
}

/// Kolmogorov-Smirnov distance of two weighted samples: the widest gap between their cumulative
/// shares, in `0..=1`. `None` when one is empty. O(n log n).
pub fn kolmogorov_smirnov(a: &Sample, b: &Sample) -> Option<f64> {
    let mut widest: f64 = 0.0;
    walk(a, b, |gap, _| widest = widest.max(gap))?;
    Some(widest)
}

/// Calls `step` with the gap between cumulative shares and the width it reaches over, from the
/// least value on.
fn walk(a: &Sample, b: &Sample, mut step: impl FnMut(f64, f64)) -> Option<()> {
    let total = |s: &Sample| s.weights().iter().sum::<f64>();
    let (total_a, total_b) = (total(a), total(b));
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let signed = |s: &Sample, sign: f64| -> Vec<(f64, f64)> {
        s.values().iter().zip(s.weights()).map(|(v, w)| (*v, sign * w)).collect()
    };
    let mut steps = signed(a, 1.0 / total_a);
    steps.extend(signed(b, -1.0 / total_b));
    steps.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut gap = 0.0_f64;
    for (i, (value, share)) in steps.iter().enumerate() {
        gap += share;
        let width = steps.get(i + 1).map_or(0.0, |next| next.0 - value);
        // Between equal values the shares are not all in yet.
        if width > 0.0 {
            step(gap.abs(), width);
        }
    }
    Some(())
}

/// 1-Wasserstein distance of two ascending lists of the same length.
pub fn wasserstein_of_sorted(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).sum::<f64>() / a.len() as f64
}

/// Total variation of two lists of shares: half the sum of differences.
pub fn total_variation(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).sum::<f64>() / 2.0
}

/// The least total variation over all rotations of one of two histograms on a circle.
pub fn total_variation_rotated(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len();
    let turned = |turn: usize| (0..n).map(|i| (a[(i + turn) % n] - b[i]).abs()).sum::<f64>() / 2.0;
    (0..n).map(turned).fold(f64::INFINITY, f64::min)
}

/// Unbiased squared maximum mean discrepancy of two sets of points in the plane under the kernel
/// exp(-d²/2). At least two points each. O(n²).
///
/// Source: Gretton et al. 2012, *A kernel two-sample test*, eq. (3).
pub fn squared_discrepancy(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let kernel = |p: &[f64; 2], q: &[f64; 2]| {
        let (x, y) = (p[0] - q[0], p[1] - q[1]);
        trig::exp(-(x * x + y * y) / 2.0)
    };
    let within = |set: &[[f64; 2]]| {
        let n = set.len() as f64;
        let pairs = set.iter().enumerate().flat_map(|(i, p)| set[..i].iter().map(move |q| (p, q)));
        2.0 * pairs.map(|(p, q)| kernel(p, q)).sum::<f64>() / (n * (n - 1.0))
    };
    let between: f64 = a.iter().flat_map(|p| b.iter().map(move |q| kernel(p, q))).sum();
    within(a) + within(b) - 2.0 * between / (a.len() * b.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_is_its_own_distance() {
        let a = Sample::plain([1.0, 2.0, 4.0]);
        let b = Sample::plain([2.5, 3.5, 5.5]);
        assert!((wasserstein(&a, &b).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(wasserstein(&a, &a), Some(0.0));
        assert_eq!(kolmogorov_smirnov(&a, &Sample::plain([9.0])), Some(1.0));
        assert_eq!(wasserstein(&a, &Sample::default()), None);
    }

    #[test]
    fn weights_are_repetitions() {
        let weighted = Sample::weighted([(1.0, 3.0), (5.0, 1.0)]);
        let repeated = Sample::plain([1.0, 1.0, 1.0, 5.0]);
        let other = Sample::plain([0.0, 7.0]);
        let of = |f: fn(&Sample, &Sample) -> Option<f64>| {
            (f(&weighted, &other).unwrap() - f(&repeated, &other).unwrap()).abs()
        };
        assert!(of(wasserstein) < 1e-12 && of(kolmogorov_smirnov) < 1e-12);
    }

    #[test]
    fn a_turned_rose_is_the_same_rose() {
        let (a, b) = ([0.5, 0.25, 0.25, 0.0], [0.25, 0.0, 0.5, 0.25]);
        assert_eq!(total_variation_rotated(&a, &b), 0.0);
        assert_eq!(total_variation(&a, &b), 0.5);
    }
}
