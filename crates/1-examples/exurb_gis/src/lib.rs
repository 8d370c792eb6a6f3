//! GeoPackage and GeoJSON both ways.

mod assembly;
mod beside;
mod error;
pub mod fuzz;
mod gathering;
pub mod geojson;
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
pub use geojson::{
    read_geojson, read_geojson_many, read_target, write_geojson, write_geojson_file,
};
pub use geopackage::{read_geopackage, write_geopackage};
