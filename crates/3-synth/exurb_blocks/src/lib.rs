//! Blocks filled by example: parcels and footprints.
//!
//! | room | what it does |
//! |---|---|
//! | [`parcels`] | cuts blocks into lots that front on their streets |
//! | [`footprints`] | stands one building on each lot |
//!
//! Both learn from whole blocks of the example ([`library`]) and let each new block take after one
//! of them. [`operations()`] lists the rooms for the command line, recipes and the studio.

pub mod database;
mod filling;
pub mod footprints;
mod kerb;
pub mod library;
mod operations;
pub mod parcels;
pub mod refine;
mod ring;
mod scoped;
#[cfg(test)]
mod test_city;
pub mod transfer;

pub use operations::operations;
