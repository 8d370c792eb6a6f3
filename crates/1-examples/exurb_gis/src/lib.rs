//! GeoPackage and GeoJSON both ways.

mod assembly;
mod beside;
mod error;
mod gathering;
mod geometry;
pub mod geopackage;
mod layers;
mod metadata;
mod numbered;
mod recognise;
#[cfg(test)]
mod sample;
mod value;
mod wkb;

pub use error::Error;
pub use geopackage::{read_geopackage, write_geopackage};
