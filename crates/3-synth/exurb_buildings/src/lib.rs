//! Heights, roofs and shapes of buildings by example.
//!
//! | room | what it does |
//! |---|---|
//! | [`extrude`] | completes height, storeys, roof and use of footprints |
//!
//! [`operations()`] is the only list of rooms.

pub mod extrude;
mod operations;

pub use operations::operations;
