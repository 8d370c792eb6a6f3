use exurb_operation::{AnyOperation, erase};

use crate::{footprints, parcels, transfer};

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![
        erase::<transfer::Transfer>(),
        erase::<parcels::Parcels>(),
        erase::<footprints::Footprints>(),
    ]
}
