//! What example blocks teach: how they are cut into lots, what stands on them, and which block of the
//! example a new block should take after.
//!
//! A block of the example is kept whole: its frontages in order along the kerb, its lot depth, its
//! open land, its buildings with their place relative to street and neighbours. A new block draws
//! one of the example blocks most like it ([`Library::donors`]) and takes everything from there, so
//! that what belongs together (narrow lots, shared walls, small setbacks) stays together. The draw
//! hangs on the run's seed and the block's place alone: parcels and footprints find the same donor.
//! Units: metres and square metres. Learning is O(buildings · kerb segments of their block).

mod block_features;
mod building_sample;
mod donor;
mod example_block;
mod fronts;
mod lesson;
mod open_land;

pub use block_features::{Features, Surroundings};
pub use building_sample::BuildingSample;
pub use donor::Donors;
pub use example_block::{ExampleBlock, OPEN_COVERAGE, OPEN_SHARE, median};
pub(crate) use fronts::{are_near, main_direction};
pub use open_land::{OpenLand, OpenNearby};

use exurb_city::{City, block};
use exurb_operation::{Example, Failure, Run};
use rayon::prelude::*;

/// Blocks of all examples.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// The blocks, in order of examples and blocks.
    pub blocks: Vec<ExampleBlock>,
    /// Does any example tell where buildings stand?
    pub has_buildings: bool,
    /// Does any example have parcels?
    pub has_parcels: bool,
    /// Does any example tell which land is open?
    pub has_land_use: bool,
    /// Standard deviation of each feature over the blocks.
    spread: Features,
}

impl Library {
    /// Learns the blocks of all examples.
    pub fn of(examples: &[Example], run: &Run) -> Result<Self, Failure> {
        let mut library = Self::default();
        for example in examples {
            let city = &*example.city;
            run.check()?;
            library.blocks.extend(blocks_of(city, example.weight, run)?);
            library.has_buildings |= !city.buildings.is_empty();
            library.has_parcels |= !city.parcels.is_empty();
            library.has_land_use |= !city.land_use.is_empty();
        }
        library.spread = Features::spread(library.blocks.iter().map(|b| &b.features));
        Ok(library)
    }

    /// The same without blocks that are next to empty.
    pub fn built(&self) -> Self {
        let is_built = |b: &&ExampleBlock| b.open.is_none() && b.coverage > OPEN_COVERAGE;
        let blocks: Vec<ExampleBlock> = self.blocks.iter().filter(is_built).cloned().collect();
        if blocks.is_empty() { self.clone() } else { Self { blocks, ..self.clone() } }
    }

    /// All building samples.
    pub fn buildings(&self) -> impl Iterator<Item = &BuildingSample> {
        self.blocks.iter().flat_map(|b| &b.buildings)
    }
}

fn blocks_of(city: &City, weight: f64, run: &Run) -> Result<Vec<ExampleBlock>, Failure> {
    let derived;
    let blocks = if city.blocks.is_empty() {
        derived = block::derive(&city.streets);
        &derived
    } else {
        &*city.blocks
    };
    let contents = fronts::Contents::of(city, blocks);
    let surroundings = Surroundings::of(blocks);
    let open = OpenLand::of(city);
    let measured: Vec<Result<Option<ExampleBlock>, Failure>> = blocks
        .par_iter()
        .enumerate()
        .map(|(i, block)| {
            run.check()?;
            let features = surroundings.features(block, &city.streets);
            Ok(example_block::measure(city, block, &contents.of_block[i], features, &open, weight))
        })
        .collect();
    measured.into_iter().filter_map(Result::transpose).collect()
}
