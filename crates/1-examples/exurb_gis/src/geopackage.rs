//! GeoPackage both ways.

mod read;
mod schema;
mod terrain;
mod write;

pub(crate) use read::read_database;
pub use read::read_geopackage;
pub use write::write_geopackage;

#[cfg(test)]
mod tests;
