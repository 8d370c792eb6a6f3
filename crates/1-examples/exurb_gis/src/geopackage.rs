//! GeoPackage both ways.

mod outlines;
mod read;
mod schema;
mod write;

pub(crate) use outlines::{is_geopackage, outlines};
pub(crate) use read::read_database;
pub use read::read_geopackage;
pub use write::write_geopackage;

#[cfg(test)]
mod tests;
