use exurb_operation::{AnyOperation, erase};

use crate::{footprints, parcels};

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![erase::<parcels::Parcels>(), erase::<footprints::Footprints>()]
}
