//! GeoPackage both ways.

mod outlines;
mod read;
mod schema;
mod terrain;
mod write;

pub(crate) use outlines::{is_geopackage, outlines};
pub(crate) use read::read_database;
pub use read::read_geopackage;
pub use write::{forget_journals, write_geopackage, write_geopackage_streets, write_themes};

#[cfg(test)]
mod tests;
