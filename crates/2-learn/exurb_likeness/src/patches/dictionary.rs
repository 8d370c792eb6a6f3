//! Filters learned from pictures without labels: k-means on whitened pieces.

use exurb_operation::{Rng, rng};
use linfa::DatasetBase;
use linfa::traits::Fit;
use linfa_clustering::KMeans;
use linfa_linalg::eigh::{EigSort, EighInto};
use ndarray::{Array1, Array2, Axis};
use rand::RngExt;
use rand_xoshiro::Xoshiro256Plus;
use rand_xoshiro::rand_core::SeedableRng;

use super::Image;

/// Side of a piece in pixels, and its number of pixels.
pub const PIECE: usize = 8;
const PIXELS: usize = PIECE * PIECE;
/// Filters a scale.
pub const FILTERS: usize = 80;
/// Pieces drawn from each picture and scale.
const DRAWN: usize = 2500;
/// Added to the variance of a piece, and to the variances of all pieces along their axes.
const CONTRAST: f32 = 0.001;
const WHITENING: f32 = 0.1;
/// Rounds of k-means at most.
const ROUNDS: u64 = 40;

/// Filters at two scales.
#[derive(Clone, Debug, PartialEq)]
pub struct Dictionary {
    /// Of the picture, and of its means of 3 x 3 pixels.
    pub scales: [Filters; 2],
}

/// Whitening and filters of one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Filters {
    /// Mean piece.
    pub(crate) mean: Array1<f32>,
    /// What makes pieces uncorrelated.
    pub(crate) whitening: Array2<f32>,
    /// Centres of the filters in the whitened space, a row each.
    pub(crate) centres: Array2<f32>,
}

/// Why no filters could be learned.
#[derive(Debug, thiserror::Error)]
#[error("no filters can be learned from these pictures: {0}")]
pub struct LearnError(String);

impl Dictionary {
    /// Learns from pictures of real cities; at least one. About a second per ten pictures.
    pub fn learn(images: &[&Image], seed: u64) -> Result<Self, LearnError> {
        let fine = images.iter().map(|i| (*i).clone()).collect();
        let coarse = images.iter().map(|image| image.coarse()).collect();
        let [fine, coarse]: [Vec<Image>; 2] = [fine, coarse];
        let (fine, coarse) =
            rayon::join(|| Filters::learn(&fine, seed), || Filters::learn(&coarse, seed));
        Ok(Self { scales: [fine?, coarse?] })
    }
}

impl Filters {
    /// Filters of their numbers, row by row; `None` when there are too few or too many.
    pub(crate) fn from_rows(
        mean: Vec<f32>,
        whitening: Vec<f32>,
        centres: Vec<f32>,
    ) -> Option<Self> {
        Some(Self {
            mean: (mean.len() == PIXELS).then(|| Array1::from(mean))?,
            whitening: Array2::from_shape_vec((PIXELS, PIXELS), whitening).ok()?,
            centres: Array2::from_shape_vec((FILTERS, PIXELS), centres).ok()?,
        })
    }

    fn learn(images: &[Image], seed: u64) -> Result<Self, LearnError> {
        let mut pieces = Array2::zeros((images.len() * DRAWN, PIXELS));
        for (i, image) in images.iter().enumerate() {
            let mut rng = rng::stream(seed, "likeness pieces", i as u64);
            for row in i * DRAWN..(i + 1) * DRAWN {
                let (x, y) = place(image, &mut rng);
                let mut piece = pieces.row_mut(row);
                let out = piece.as_slice_mut().expect("rows of a new array lie in one piece");
                cut(&image.pixels, image.width, x, y, out);
            }
        }
        level_contrast(&mut pieces);
        let (mean, whitening) = whitening(&pieces)?;
        let white = (&pieces - &mean).dot(&whitening);
        let generator = Xoshiro256Plus::seed_from_u64(seed);
        let means = KMeans::params_with_rng(FILTERS, generator)
            .n_runs(1)
            .max_n_iterations(ROUNDS)
            .tolerance(1e-3)
            .fit(&DatasetBase::from(white))
            .map_err(|e| LearnError(e.to_string()))?;
        Ok(Self { mean, whitening, centres: means.centroids().clone() })
    }

    /// How much each filter answers to each piece: how much nearer than the mean its centre is, in
    /// the whitened space, and 0 where it is farther. One row a piece.
    pub fn activations(&self, mut pieces: Array2<f32>) -> Array2<f32> {
        level_contrast(&mut pieces);
        let white = (&pieces - &self.mean).dot(&self.whitening);
        let square = |m: &Array2<f32>| m.map_axis(Axis(1), |row| row.dot(&row));
        let (here, there) = (square(&white), square(&self.centres));
        let mut out = white.dot(&self.centres.t());
        for (mut row, here) in out.rows_mut().into_iter().zip(&here) {
            for (v, there) in row.iter_mut().zip(&there) {
                *v = (here + there - 2.0 * *v).max(0.0).sqrt();
            }
            let mean = row.sum() / FILTERS as f32;
            row.mapv_inplace(|distance| (mean - distance).max(0.0));
        }
        out
    }
}

/// South-west corner of a random piece.
fn place(image: &Image, rng: &mut Rng) -> (usize, usize) {
    let mut along = |length: usize| rng.random_range(0..=length.saturating_sub(PIECE));
    (along(image.width), along(image.height))
}

/// The pixels of a piece, row by row.
pub fn cut(pixels: &[f32], width: usize, x: usize, y: usize, out: &mut [f32]) {
    for (row, out) in out.chunks_exact_mut(PIECE).enumerate() {
        let start = (y + row) * width + x;
        out.copy_from_slice(&pixels[start..start + PIECE]);
    }
}

/// Every row centred and divided by the root of its variance.
fn level_contrast(pieces: &mut Array2<f32>) {
    for mut row in pieces.rows_mut() {
        let mean = row.sum() / PIXELS as f32;
        row.mapv_inplace(|v| v - mean);
        let variance = row.dot(&row) / PIXELS as f32;
        let by = 1.0 / (variance + CONTRAST).sqrt();
        row.mapv_inplace(|v| v * by);
    }
}

/// Mean of the pieces, and the symmetric matrix that makes them uncorrelated (ZCA).
fn whitening(pieces: &Array2<f32>) -> Result<(Array1<f32>, Array2<f32>), LearnError> {
    let n = pieces.nrows() as f32;
    let mean = pieces.sum_axis(Axis(0)) / n;
    let centred = pieces - &mean;
    let covariance: Array2<f64> = (centred.t().dot(&centred) / n).mapv(f64::from);
    let (values, vectors) =
        covariance.eigh_into().map_err(|e| LearnError(e.to_string()))?.sort_eig_asc();
    let scaled = &vectors * &values.mapv(|v| 1.0 / (v.max(0.0) + f64::from(WHITENING)).sqrt());
    Ok((mean, scaled.dot(&vectors.t()).mapv(|v| v as f32)))
}

/// Pieces at every `stride` of a square picture.
pub fn all_pieces(pixels: &[f32], side: usize, stride: usize) -> Array2<f32> {
    let places = (side - PIECE) / stride + 1;
    let mut out = Array2::zeros((places * places, PIXELS));
    for (i, mut row) in out.rows_mut().into_iter().enumerate() {
        let slot = row.as_slice_mut().expect("rows of a new array lie in one piece");
        cut(pixels, side, i % places * stride, i / places * stride, slot);
    }
    out
}
