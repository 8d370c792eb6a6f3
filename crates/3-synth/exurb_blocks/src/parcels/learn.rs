use exurb_operation::{Example, Failure, Run};

use crate::library::{ExampleBlock, Library};

use super::synthesize::Input;

/// What parcels are learned from.
pub type Learned = Library;

/// Frontage of a lot where no example tells, in metres: a detached house.
const FRONTAGE_M: f64 = 20.0;
/// Depth of a lot where no example tells, in metres.
const DEPTH_M: f64 = 30.0;

/// Learns the example's blocks.
pub fn learn(examples: &[Example], run: &Run) -> Result<Learned, Failure> {
    let library = Library::of(examples, run)?;
    if !library.has_parcels && !library.has_buildings {
        run.warn(format!(
            "the example has neither parcels nor buildings; parcels are cut {FRONTAGE_M} m wide and \
             {DEPTH_M} m deep, and lower or higher with the size of their block"
        ));
    }
    if !library.has_land_use {
        run.warn("the example has no land use; no block becomes a park or a field");
    }
    Ok(library)
}

/// The lots of a block that takes after `donors`, the first one before all others.
pub fn input(donors: &[&ExampleBlock], block_area_m2: f64) -> Input {
    let telling = |b: &&&ExampleBlock| !b.frontages_m.is_empty() && b.open.is_none();
    let Some(first) = donors.iter().find(telling) else {
        return default_input(block_area_m2);
    };
    let mut frontages_m = first.frontages_m.clone();
    // A handful of frontages tells too little of a long block: like blocks help out.
    for other in donors.iter().filter(telling).filter(|d| !std::ptr::eq(**d, *first)) {
        if frontages_m.len() >= 4 {
            break;
        }
        frontages_m.extend(&other.frontages_m);
    }
    Input { frontages_m, depth_m: first.depth_m, fronted_share: first.fronted_share }
}

/// Small blocks stand where streets are dense, and so have smaller lots.
fn default_input(block_area_m2: f64) -> Input {
    let scale = (block_area_m2 / 10_000.0).sqrt().clamp(0.6, 1.5);
    let widths = [0.9, 1.1, 1.0, 0.8, 1.2].map(|w| w * FRONTAGE_M * scale);
    Input { frontages_m: widths.to_vec(), depth_m: DEPTH_M * scale, fronted_share: 1.0 }
}
