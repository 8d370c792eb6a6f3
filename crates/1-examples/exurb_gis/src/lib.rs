//! GeoPackage and GeoJSON both ways.

mod beside;
mod error;
pub mod geopackage;
mod layers;
mod metadata;
mod numbered;
#[cfg(test)]
mod sample;
mod value;
mod wkb;

pub use error::Error;
pub use geopackage::write_geopackage;
