//! Blocks filled by example: layouts, parcels and footprints.
//!
//! | room | what it does |
//! |---|---|
//! | [`transfer`] | moves the layouts of like example blocks into blocks as a whole |
//! | [`retarget`] | lays layouts out anew in another outline; [`retarget::Editor`] for a dragging hand |
//! | [`auto`] | chooses for each block between these two, and parcels with a footprint each |
//! | [`parcels`] | cuts blocks into lots that front on their streets |
//! | [`footprints`] | stands one building on each lot |
//!
//! The first three share the layouts of example blocks ([`database`]), their choice for all blocks
//! together ([`choice`]) and what brings footprints apart and off the street ([`refine`]). The last two
//! learn from whole blocks, too ([`library`]), and let each new block take after one of them. [`operations()`] lists the rooms for the command line, recipes and the studio.

pub mod auto;
pub mod choice;
pub mod database;
mod fill;
mod filling;
pub mod footprints;
mod infill;
mod kerb;
mod lawful;
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
mod slices;
#[cfg(test)]
mod test_city;
pub mod transfer;

pub use lay::{Laid, Spacing};
pub use motion::Motion;
pub use operations::operations;
pub use outline::plain_outline;
