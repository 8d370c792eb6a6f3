use exurb_operation::{AnyOperation, erase};

use crate::auto::Auto;
use crate::footprints::Footprints;
use crate::parcels::Parcels;
use crate::transfer::Transfer;

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![erase::<Auto>(), erase::<Transfer>(), erase::<Parcels>(), erase::<Footprints>()]
}
