//! Height maps both ways: files to the terrain of a city and back.
//!
//! [`read()`] takes GeoTIFF, SRTM tiles, ESRI ASCII grids and grey PNG, told by content, as a [`Dem`]:
//! a raster in its own coordinates. [`Dem::onto`] makes it a terrain in a city's frame.
//! [`to_geotiff`] and [`to_png`] write the terrain of a city for GIS programs and game engines; both
//! are read back as they were written (PNG within half a step of its 65,536).
//!
//! | part | what it holds |
//! |---|---|
//! | `geotiff`, `geokeys`, `lzw` | GeoTIFF, the coordinate systems of its keys, its LZW tiles |
//! | `hgt`, `ascii`, `png16` | the other formats |
//! | `beside` | world files and `.prj` |
//! | [`Options`] | what a file may not say about itself |
//! | `place` | raster → terrain |
//! | `write` | terrain → files |
//! | [`tile`] | tiles of rasters inside other files |
//! | [`fuzz`] | what fuzzing calls |

mod ascii;
mod beside;
mod dem;
mod error;
pub mod fuzz;
mod geokeys;
mod geotiff;
mod hgt;
mod lzw;
mod options;
mod place;
mod png16;
mod read;
#[cfg(test)]
mod tests;
pub mod tile;
mod write;

pub use dem::{Affine, Dem, Place};
pub use error::Error;
pub use options::{Edges, Options};
pub use png16::Description;
pub use read::read;
pub use write::{HeightMap, to_geotiff, to_png};
