use exurb_operation::{AnyOperation, erase};

use crate::parcels;

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![erase::<parcels::Parcels>()]
}
