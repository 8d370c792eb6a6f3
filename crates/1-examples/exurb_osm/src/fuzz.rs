//! Bodies of the fuzz targets: whatever the bytes, a reader returns a city or an error.
//!
//! Tests run them over damaged files of their own making.

use exurb_city::ImportOptions;

use crate::{Format, read_bytes};

/// OSM XML.
pub fn xml(bytes: &[u8]) {
    as_format(bytes, Format::Xml);
}

/// PBF.
pub fn pbf(bytes: &[u8]) {
    as_format(bytes, Format::Pbf);
}

/// Overpass JSON.
pub fn overpass(bytes: &[u8]) {
    as_format(bytes, Format::Overpass);
}

fn as_format(bytes: &[u8], format: Format) {
    // Cities the size of a continent are no concern of a reader's test.
    let _ = read_bytes(bytes, "fuzz", Some(format), &ImportOptions::default());
}
