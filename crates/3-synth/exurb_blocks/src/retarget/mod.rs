//! `blocks retarget`: a layout laid out anew in another outline.

mod correspondence;
mod groups;
mod guidance;
mod label;
mod params;
mod path;
mod rows;
mod slices;
mod spacing;
mod synthesize;
#[cfg(test)]
mod tests;
mod things;

pub use correspondence::Correspondence;
pub use groups::{Groups, Kind};
pub use params::Settings;
pub use synthesize::{Placement, Source};
pub(crate) use things::things;
