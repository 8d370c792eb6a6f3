use exurb_operation::{AnyOperation, erase};

use crate::extrude;

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![erase::<extrude::Extrude>()]
}
