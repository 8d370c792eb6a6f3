use exurb_operation::{AnyOperation, erase};

use crate::grow;

/// The rooms of this crate.
pub fn operations() -> Vec<Box<dyn AnyOperation>> {
    vec![erase::<grow::Grow>()]
}
