use exurb_city::{Block, StreetGraph};
use exurb_geom::{GridPoint, trig};
use exurb_operation::rng;
use rand::RngExt;

use super::{ExampleBlock, Features, Library, Surroundings};

/// Like blocks drawn from.
const NEAREST: usize = 8;

/// Which example blocks a city's blocks take after.
pub struct Donors<'a> {
    library: &'a Library,
    surroundings: Surroundings,
    seed: u64,
}

impl Library {
    /// Donors for a city with `blocks`, the same for equal `seed` and place.
    pub fn donors(&self, blocks: &[Block], seed: u64) -> Donors<'_> {
        Donors { library: self, surroundings: Surroundings::of(blocks), seed }
    }
}

impl<'a> Donors<'a> {
    /// The example blocks most like `block`, the drawn one first, then by likeness; empty when the
    /// library is. O(library).
    pub fn of(&self, block: &Block, streets: &StreetGraph) -> Vec<&'a ExampleBlock> {
        let features = self.surroundings.features(block, streets);
        let mut ranked = self.ranked(&features);
        let key = rng::place_key(GridPoint::round(block.polygon.centroid()));
        let mut rng = rng::stream(self.seed, "blocks", key);
        let least = ranked.first().map_or(0.0, |r| r.0);
        let weight = |d: f64, b: &ExampleBlock| trig::exp(least - d) * b.weight;
        let total: f64 = ranked.iter().map(|(d, b)| weight(*d, b)).sum();
        let mut left = rng.random::<f64>() * total;
        let drawn = ranked.iter().position(|(d, b)| {
            left -= weight(*d, b);
            left < 0.0
        });
        if !ranked.is_empty() {
            ranked[..=drawn.unwrap_or(0)].rotate_right(1);
        }
        ranked.into_iter().map(|(_, b)| b).collect()
    }

    fn ranked(&self, features: &Features) -> Vec<(f64, &'a ExampleBlock)> {
        let mut all: Vec<(f64, &ExampleBlock)> = self
            .library
            .blocks
            .iter()
            .map(|b| (b.features.distance(features, &self.library.spread), b))
            .collect();
        let nearest = NEAREST.min(all.len());
        if nearest < all.len() {
            all.select_nth_unstable_by(nearest, order);
            all.truncate(nearest);
        }
        all.sort_by(order);
        all
    }
}

fn order(a: &(f64, &ExampleBlock), b: &(f64, &ExampleBlock)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then_with(|| a.1.source.cmp(&b.1.source)).then(a.1.id.cmp(&b.1.id))
}
