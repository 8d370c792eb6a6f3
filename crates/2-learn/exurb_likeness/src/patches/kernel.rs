//! Kernel distance between the patches of two cities.

use ndarray::{Array2, Axis};

use super::Patches;
use super::classifier::Standard;

/// Unbiased squared maximum mean discrepancy under the kernel (a·b / d + 1)³, not below 0, of
/// features standardised over both cities. O(patches² · features).
pub fn kernel_distance(a: &Patches, b: &Patches) -> f64 {
    let of = |p: &Patches| p.features.mapv(f64::from);
    let (a, b) = (of(a), of(b));
    let both = ndarray::concatenate(Axis(0), &[a.view(), b.view()]);
    let Some(standard) = both.ok().as_ref().and_then(Standard::of) else { return 0.0 };
    let (a, b) = (standard.apply(a), standard.apply(b));
    let between = kernel(&a, &b).sum() / (a.nrows() * b.nrows()) as f64;
    (within(&a) + within(&b) - 2.0 * between).max(0.0)
}

fn kernel(x: &Array2<f64>, y: &Array2<f64>) -> Array2<f64> {
    let d = x.ncols() as f64;
    let cube = |v: f64| v * v * v;
    x.dot(&y.t()).mapv(|v| cube(v / d + 1.0))
}

/// Mean over all pairs of two different rows.
fn within(x: &Array2<f64>) -> f64 {
    let (n, all) = (x.nrows() as f64, kernel(x, x));
    (all.sum() - all.diag().sum()) / (n * (n - 1.0))
}
