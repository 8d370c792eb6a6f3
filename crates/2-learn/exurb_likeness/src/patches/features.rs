//! Patches of a picture and their features.

use exurb_operation::{Rng, rng};
use ndarray::{Array2, ArrayView2, Axis};
use rand::RngExt;
use rayon::prelude::*;

use super::dictionary::{FILTERS, all_pieces};
use super::{Dictionary, Image};

/// Side of a patch in pixels.
pub const SIDE: usize = 64;
/// Patches a city.
pub const PATCHES: usize = 160;
/// Steps between pieces at the two scales.
const STRIDES: [usize; 2] = [2, 1];
/// How much the mean and the spread of the plain patch count.
const PLAIN: f32 = 10.0;
/// Features a patch: mean and root mean square of every filter at two scales, mean and spread.
pub const FEATURES: usize = 4 * FILTERS + 2;

/// Keys of the random places of patches: alike for all that is compared with a held-out part, so
/// that the same city gives the same patches again.
pub const CANDIDATE: u64 = 0;
/// See [`CANDIDATE`].
pub const HELD_OUT: u64 = 1;

/// Features of the patches of a city.
#[derive(Clone, Debug, PartialEq)]
pub struct Patches {
    /// A row a patch.
    pub features: Array2<f32>,
    /// Does the patch lie in the west half of its city, in the south half?
    pub halves: Vec<[bool; 2]>,
    /// South-west corner of every patch in pixels.
    pub places: Vec<[u32; 2]>,
}

impl Patches {
    /// Cuts random patches from a picture and looks at them. `set` keys the random places. On
    /// rayon's current pool; the same on any number of threads.
    pub fn of(image: &Image, dictionary: &Dictionary, seed: u64, set: u64) -> Self {
        let mut rng = rng::stream(seed, "likeness patches", set);
        let cuts: Vec<Cut> = (0..PATCHES).map(|_| Cut::random(image, &mut rng)).collect();
        let rows: Vec<Vec<f32>> =
            cuts.par_iter().map(|cut| features(&cut.pixels(image), dictionary)).collect();
        let features = Array2::from_shape_vec((PATCHES, FEATURES), rows.concat())
            .expect("every patch has the same number of features");
        let half = |cut: &Cut| {
            let west = 2 * cut.x + SIDE < image.width;
            [west, 2 * cut.y + SIDE < image.height]
        };
        let places = cuts.iter().map(|cut| [cut.x as u32, cut.y as u32]).collect();
        Self { features, halves: cuts.iter().map(half).collect(), places }
    }
}

/// Where a patch is cut, and which of the eight symmetries of the square it goes through.
struct Cut {
    x: usize,
    y: usize,
    symmetry: u8,
}

impl Cut {
    fn random(image: &Image, rng: &mut Rng) -> Self {
        let x = rng.random_range(0..=image.width - SIDE);
        let y = rng.random_range(0..=image.height - SIDE);
        Self { x, y, symmetry: rng.random_range(0..8) }
    }

    fn pixels(&self, image: &Image) -> Vec<f32> {
        let bit = |b: u8| self.symmetry & (1 << b) != 0;
        let (swap, flip_x, flip_y) = (bit(0), bit(1), bit(2));
        let mut out = Vec::with_capacity(SIDE * SIDE);
        for v in 0..SIDE {
            for u in 0..SIDE {
                let (a, b) = if swap { (v, u) } else { (u, v) };
                let a = if flip_x { SIDE - 1 - a } else { a };
                let b = if flip_y { SIDE - 1 - b } else { b };
                out.push(image.pixels[(self.y + b) * image.width + self.x + a]);
            }
        }
        out
    }
}

/// The features of one patch.
fn features(pixels: &[f32], dictionary: &Dictionary) -> Vec<f32> {
    let fine = Image { width: SIDE, height: SIDE, pixels: pixels.to_vec() };
    let coarse = fine.coarse();
    let mut out = Vec::with_capacity(FEATURES);
    for ((image, filters), stride) in [fine, coarse].iter().zip(&dictionary.scales).zip(STRIDES) {
        let answers = filters.activations(all_pieces(&image.pixels, image.width, stride));
        out.extend(pooled(answers.view()));
    }
    let n = pixels.len() as f32;
    let mean = pixels.iter().sum::<f32>() / n;
    let variance = pixels.iter().map(|p| (p - mean) * (p - mean)).sum::<f32>() / n;
    out.extend([PLAIN * mean, PLAIN * variance.sqrt()]);
    out
}

/// Mean and root mean square of every filter.
fn pooled(answers: ArrayView2<f32>) -> Vec<f32> {
    let n = answers.nrows() as f32;
    let mean = answers.sum_axis(Axis(0)) / n;
    let square = answers.mapv(|v| v * v).sum_axis(Axis(0)) / n;
    mean.into_iter().chain(square.mapv(f32::sqrt)).collect()
}
