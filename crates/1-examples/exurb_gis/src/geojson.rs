//! GeoJSON both ways (RFC 7946), and outlines drawn in it.

mod outlines;
mod read;
mod stream;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use outlines::{outlines, outlines_of};
pub(crate) use read::read_stream;
pub use read::{read_geojson, read_geojson_many};
pub use write::{write_geojson, write_geojson_file, write_geojson_streets};
