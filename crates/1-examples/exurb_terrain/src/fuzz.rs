//! What fuzzing calls: readers of any bytes, which may fail but never panic or run away. The tests
//! run them over mutated files.

use crate::options::{Edges, Options, Said};
use crate::read::read_bytes;

/// A raster of more pixels than this would only cost time.
const MOST: usize = 1 << 20;

fn read(bytes: &[u8], name: &str) {
    let options = Options { range_m: Some([0.0, 100.0]), ..Options::default() };
    let stretched = Options { edges: Some(Edges::Target), ..options.clone() };
    for options in [options, stretched] {
        // Errors are an answer, too.
        if let Ok(dem) = read_bytes(bytes, name, Said::default(), &options) {
            assert!(dem.heights.len() == dem.columns * dem.rows());
            place(dem);
        }
    }
}

/// Lays what was read where it says it lies.
fn place(dem: crate::Dem) {
    let middle = dem.extent().map(|[a, b]| exurb_geom::LonLat {
        lon: (a.lon + b.lon) / 2.0,
        lat: (a.lat + b.lat) / 2.0,
    });
    let frame = middle.and_then(|middle| exurb_geom::Frame::new(middle).ok());
    let frame = frame.unwrap_or_else(exurb_geom::Frame::null_island);
    let half = exurb_geom::Vec2::splat(100.0);
    if dem.heights.len() <= MOST {
        let _ = dem.onto(&frame, exurb_geom::Bounds { min: -half, max: half }, None);
    }
}

/// Reads bytes as a GeoTIFF.
pub fn geotiff(bytes: &[u8]) {
    read(bytes, "dem.tif");
}

/// Reads bytes as an SRTM tile.
pub fn hgt(bytes: &[u8]) {
    read(bytes, "N43E007.hgt");
}

/// Reads bytes as an ASCII grid.
pub fn ascii_grid(bytes: &[u8]) {
    read(bytes, "dem.asc");
}

/// Reads bytes as a PNG.
pub fn height_png(bytes: &[u8]) {
    read(bytes, "dem.png");
}
