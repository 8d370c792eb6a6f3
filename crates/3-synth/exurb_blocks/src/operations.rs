use exurb_operation::{AnyOperation, erase};

use crate::auto::Auto;
use crate::footprints::Footprints;
use crate::parcels::Parcels;
use crate::retarget::Retarget;
use crate::transfer::Transfer;

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![
        erase::<Auto>(),
        erase::<Transfer>(),
        erase::<Retarget>(),
        erase::<Parcels>(),
        erase::<Footprints>(),
    ]
}
