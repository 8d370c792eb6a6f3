//! GeoPackage both ways.

mod schema;
mod write;

pub use write::write_geopackage;

#[cfg(test)]
mod tests;
