//! Blocks filled by example: parcels and footprints.
//!
//! | room | what it does |
//! |---|---|
//! | [`parcels`] | cuts blocks into lots that front on their streets |
//! | [`footprints`] | stands one building on each lot |
//!
//! Both learn from whole blocks of the example ([`library`]) and let each new block take after one
//! of them. [`operations()`] lists the rooms for the command line, recipes and the studio.

pub mod auto;
pub mod choice;
pub mod database;
mod fill;
mod filling;
pub mod footprints;
mod kerb;
mod lay;
pub mod library;
mod motion;
mod neighbours;
mod operations;
mod outline;
pub mod parcels;
pub mod refine;
pub mod retarget;
mod ring;
mod scoped;
#[cfg(test)]
mod test_city;
pub mod transfer;

pub use motion::Motion;
pub use operations::operations;
pub use outline::plain_outline;
