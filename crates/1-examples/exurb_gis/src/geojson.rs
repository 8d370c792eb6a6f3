//! GeoJSON both ways (RFC 7946), and targets drawn in it.

mod read;
mod stream;
mod target;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use read::read_stream;
pub use read::{read_geojson, read_geojson_many};
pub use target::read_target;
pub(crate) use target::read_target_stream;
pub use write::{write_geojson, write_geojson_file};
