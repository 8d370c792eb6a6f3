//! Shape contexts: for each sample of an outline, where the other samples lie.
//!
//! Source: Belongie, Malik, Puzicha 2000, *Shape Context: A New Descriptor for Shape Matching and
//! Object Recognition*; Hartmann 2018, sections 4.1.3 and 5.1.6: 8 angular by 5 distance bins, turned
//! with the tangent so that a turned outline is the same outline. Departures: distances are absolute,
//! since size counts; so both outlines get the radii of the query, log-spaced from 1/8 to twice its
//! mean distance between samples. Angular bins are centred on the tangent: with their border there,
//! the samples of a straight side would fall to either side of it by rounding. O(samples²).

use exurb_geom::Vec2;

use crate::Outline;

/// Angular bins.
pub const ANGLES: usize = 8;
/// Distance bins.
pub const RADII: usize = 5;
/// Bins of one histogram.
pub const BINS: usize = ANGLES * RADII;

/// Outer border of the outermost bin, in mean distances of the query's samples.
const OUTER: f64 = 2.0;
/// Cosine and sine of half an angular bin.
const HALF_BIN: Vec2 = Vec2::new(0.923_879_532_511_286_7, 0.382_683_432_365_089_8);

/// The shape contexts of an outline's samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Contexts {
    /// One histogram a sample; each sums to 1.
    histograms: Vec<[f32; BINS]>,
}

/// The outer radius for comparisons with `query`, in metres.
pub fn outer_radius_m(query: &Outline) -> f64 {
    OUTER * query.mean_distance_m()
}

impl Contexts {
    /// The contexts of `outline` with samples farther than `outer_radius_m` left out.
    pub fn of(outline: &Outline, outer_radius_m: f64) -> Self {
        let points = outline.points();
        let squares: [f64; RADII] = std::array::from_fn(|k| {
            let radius = outer_radius_m / f64::from(1u32 << (RADII - 1 - k));
            radius * radius
        });
        let histogram = |(i, tangent): (usize, Vec2)| {
            let mut counts = [0.0f32; BINS];
            // To the tangent's frame, half a bin on.
            let frame = Vec2::new(tangent.x, -tangent.y).rotate(HALF_BIN);
            let mut total = 0.0;
            for (j, p) in points.iter().enumerate() {
                let offset = *p - points[i];
                let square = offset.length_squared();
                if j == i || square > squares[RADII - 1] {
                    continue;
                }
                let radius = squares.iter().take_while(|s| square > **s).count();
                counts[octant(frame.rotate(offset)) * RADII + radius] += 1.0;
                total += 1.0;
            }
            if total > 0.0 {
                counts.iter_mut().for_each(|c| *c /= total);
            }
            counts
        };
        let histograms = outline.tangents().into_iter().enumerate().map(histogram).collect();
        Self { histograms }
    }

    /// The histogram of sample `i`.
    pub fn histogram(&self, i: usize) -> &[f32; BINS] {
        &self.histograms[i]
    }

    /// How unlike each sample of `self` is each of `other`, in `0..=1`: half the chi-square distance
    /// of their histograms.
    pub fn costs(&self, other: &Self) -> Costs {
        let columns = other.histograms.len();
        let mut values = Vec::with_capacity(self.histograms.len() * columns);
        for a in &self.histograms {
            values.extend(other.histograms.iter().map(|b| chi_square(a, b)));
        }
        Costs { columns, values }
    }
}

/// A cost for each pair of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Costs {
    columns: usize,
    values: Vec<f32>,
}

impl Costs {
    /// Costs given row by row; `values` holds a whole number of rows.
    pub fn new(columns: usize, values: Vec<f32>) -> Self {
        Self { columns, values }
    }

    /// Number of samples of the first outline.
    pub fn rows(&self) -> usize {
        self.values.len() / self.columns
    }

    /// Number of samples of the second outline.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The costs of sample `i` of the first outline.
    pub fn row(&self, i: usize) -> &[f32] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// `weight` of these costs and the rest of `other`, pair by pair (eq. 4.1).
    pub fn mixed(mut self, weight: f32, other: &Self) -> Self {
        for (a, b) in self.values.iter_mut().zip(&other.values) {
            *a = *a * weight + *b * (1.0 - weight);
        }
        self
    }
}

fn chi_square(a: &[f32; BINS], b: &[f32; BINS]) -> f32 {
    let mut sum = [0.0f32; ANGLES];
    for (a, b) in a.chunks_exact(ANGLES).zip(b.chunks_exact(ANGLES)) {
        for k in 0..ANGLES {
            let difference = a[k] - b[k];
            // Bins that are empty in both add 0 / tiny.
            sum[k] += difference * difference / (a[k] + b[k] + f32::MIN_POSITIVE);
        }
    }
    0.5 * sum.iter().sum::<f32>()
}

/// Which eighth of a turn a direction lies in, counted from east.
fn octant(v: Vec2) -> usize {
    let (mut v, mut out) = (v, 0);
    if v.y < 0.0 || (v.y == 0.0 && v.x < 0.0) {
        (v, out) = (-v, 4);
    }
    if v.x <= 0.0 {
        (v, out) = (Vec2::new(v.y, -v.x), out + 2);
    }
    out + usize::from(v.y >= v.x)
}

#[cfg(test)]
mod tests {
    use exurb_geom::{GridPoint, Rigid, trig};

    use super::*;

    const SHAPE: [(f64, f64); 6] =
        [(0.0, 0.0), (90.0, 10.0), (100.0, 60.0), (55.0, 45.0), (50.0, 95.0), (5.0, 80.0)];

    fn outline(motion: &Rigid) -> Outline {
        let corners = SHAPE.map(|(x, y)| GridPoint::round(motion.apply(Vec2::new(x, y))));
        Outline::of(&corners)
    }

    #[test]
    fn octants_go_around_from_east() {
        for k in 0..64 {
            let at = trig::unit((f64::from(k) + 0.5) * std::f64::consts::TAU / 64.0);
            assert_eq!(octant(at), k as usize / 8, "{at}");
        }
    }

    #[test]
    fn a_turned_outline_has_the_same_contexts() {
        let plain = outline(&Rigid::IDENTITY);
        let turned = outline(&Rigid::about(Vec2::ZERO, trig::unit(1.1), Vec2::new(500.0, 70.0)));
        let radius = outer_radius_m(&plain);
        let (a, b) = (Contexts::of(&plain, radius), Contexts::of(&turned, radius));
        let costs = a.costs(&b);
        let diagonal: f32 = (0..costs.rows()).map(|i| costs.row(i)[i]).sum();
        assert!(diagonal / 100.0 < 0.02, "{diagonal}");
    }

    #[test]
    fn costs_lie_between_0_and_1_and_are_0_for_equal_histograms() {
        let plain = outline(&Rigid::IDENTITY);
        let contexts = Contexts::of(&plain, outer_radius_m(&plain));
        let costs = contexts.costs(&contexts);
        for i in 0..costs.rows() {
            assert_eq!(costs.row(i)[i], 0.0);
            assert!(costs.row(i).iter().all(|c| (0.0..=1.0).contains(c)));
            assert!((contexts.histogram(i).iter().sum::<f32>() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn size_counts() {
        let (plain, radius) =
            (outline(&Rigid::IDENTITY), outer_radius_m(&outline(&Rigid::IDENTITY)));
        let double = SHAPE.map(|(x, y)| GridPoint::m(x * 2.0, y * 2.0));
        let (a, b) = (Contexts::of(&plain, radius), Contexts::of(&Outline::of(&double), radius));
        let costs = a.costs(&b);
        assert!((0..costs.rows()).map(|i| costs.row(i)[i]).sum::<f32>() > 20.0);
    }
}
