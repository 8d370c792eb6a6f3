//! All measures of one window of a city.

use std::collections::BTreeMap;

use exurb_city::StreetGraph;
use exurb_geom::Bounds;
use exurb_measure::block_shapes::{self, BlockShape};
use exurb_measure::{Network, Sample, bearings, junctions, moving_windows, natural_streets};
use exurb_measure::{paths, segments};
use exurb_operation::rng;

use crate::patches::Image;

/// Bands of distances at which directions are compared, in metres.
const BANDS_M: [(f64, f64); 3] = [(20.0, 150.0), (150.0, 400.0), (400.0, 900.0)];
/// A set of this many values or fewer is absent.
const FEW: usize = 5;
/// Random sources and pairs are the same in every run.
const SEED: u64 = 1;

/// What is measured of the streets and blocks of one window.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Measures that are distributions of one number, by name; those with five values or fewer are
    /// absent. Ascending.
    pub samples: BTreeMap<&'static str, Sample>,
    /// Number of values by measure, before any were left out of a summary.
    pub sizes: BTreeMap<&'static str, usize>,
    /// Shares of nodes by degree: 1, 2, 3, 4, 5 and more.
    pub degrees: Option<[f64; 5]>,
    /// Histogram of bearings.
    pub bearings: Option<[f64; bearings::HALF_BINS]>,
    /// log10 of the area in m², Φ, and weight of blocks.
    pub fingerprint: Vec<([f64; 2], f64)>,
    /// The streets drawn, for the discriminator; `None` where the window is smaller than a patch.
    pub image: Option<Image>,
}

impl Measured {
    /// Measures the streets in a window. O(n log n), on rayon's current pool; the same on any number
    /// of threads.
    pub fn of(streets: &StreetGraph, window: Bounds) -> Self {
        Self::of_network(&Network::of(streets, window))
    }

    /// [`Measured::of`] for streets that were cut and cleaned already.
    pub fn of_network(network: &Network) -> Self {
        let ((blocks, aligned), (paths, image)) = rayon::join(
            || (block_shapes::blocks(network), aligned(network)),
            || {
                let mut rng = rng::stream(SEED, "likeness paths", 0);
                (paths::paths(network, &mut rng), Image::draw(network))
            },
        );
        let [detour_near, detour_far] = paths.detour;
        let named = [
            ("seg_length", segments::length(network)),
            ("seg_sinuosity", segments::sinuosity(network)),
            ("seg_curvature", segments::curvature(network)),
            ("junction_angle", junctions::angles(network)),
            ("tee_angle", junctions::tee_angles(network)),
            ("deadend_length", segments::dead_end_length(network)),
            ("fourway_share_1km", moving_windows::four_way_share(network)),
            ("block_area", block_shapes::sample(&blocks, block_shapes::log_area)),
            ("block_shape_phi", block_shapes::sample(&blocks, |b| b.phi)),
            ("block_compactness", block_shapes::sample(&blocks, |b| b.compactness)),
            ("block_aspect", block_shapes::sample(&blocks, |b| b.aspect)),
            ("block_rectangularity", block_shapes::sample(&blocks, |b| b.rectangularity)),
            ("order_phi_1km", moving_windows::order(network)),
            ("density_junction", moving_windows::junction_density(network)),
            ("density_deadend", moving_windows::dead_end_density(network)),
            ("density_length", moving_windows::street_density(network)),
            ("reach_500m", paths.reach),
            ("detour_150_500m", detour_near),
            ("detour_500_1200m", detour_far),
            ("meshedness_1km", moving_windows::meshedness(network)),
            ("betweenness_local", paths.betweenness),
            ("natural_street_length", natural_streets::length(network)),
        ];
        let all = named.into_iter().chain(aligned);
        let samples: BTreeMap<_, _> = all
            .filter(|(_, sample)| sample.len() > FEW)
            .map(|(name, sample)| (name, sample.sorted()))
            .collect();
        Self {
            sizes: samples.iter().map(|(name, sample)| (*name, sample.len())).collect(),
            samples,
            degrees: degree_shares(network),
            bearings: bearings::histogram(network),
            fingerprint: fingerprint(&blocks),
            image,
        }
    }
}

fn aligned(network: &Network) -> [(&'static str, Sample); 3] {
    let mut rng = rng::stream(SEED, "likeness alignment", 0);
    let mut bands = bearings::alignment(network, &BANDS_M, &mut rng).into_iter();
    ["align_20_150m", "align_150_400m", "align_400_900m"]
        .map(|name| (name, bands.next().unwrap_or_default()))
}

fn degree_shares(network: &Network) -> Option<[f64; 5]> {
    let counts = junctions::degrees(network);
    let total: usize = counts.iter().sum();
    (total > FEW).then(|| counts.map(|count| count as f64 / total as f64))
}

fn fingerprint(blocks: &[BlockShape]) -> Vec<([f64; 2], f64)> {
    if blocks.len() <= FEW {
        return Vec::new();
    }
    blocks.iter().map(|b| ([block_shapes::log_area(b), b.phi], b.weight)).collect()
}
