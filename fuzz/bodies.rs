//! What is fuzzed: plain functions of bytes. The libFuzzer targets call them, and so does a test
//! over the corpus (`tests/fuzz_corpus.rs`). A body passes when it returns: broken input is an
//! error, never a panic.

pub use exurb_gis::fuzz::{geojson, geopackage, target};
pub use exurb_osm::fuzz::{overpass, pbf, xml};
pub use exurb_terrain::fuzz::{ascii_grid, geotiff, height_png, hgt};

use exurb_recipe::{Recipe, Registry};

/// What a fuzzer feeds with bytes.
pub type Body = fn(&[u8]);

/// Every body by the name of its target.
pub const BODIES: [(&str, Body); 11] = [
    ("ascii_grid", ascii_grid),
    ("geojson", geojson),
    ("geopackage", geopackage),
    ("geotiff", geotiff),
    ("height_png", height_png),
    ("hgt", hgt),
    ("overpass", overpass),
    ("pbf", pbf),
    ("recipe", recipe),
    ("target", target),
    ("xml", xml),
];

/// A recipe's text: what is read prints to a recipe that reads the same.
pub fn recipe(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(recipe) = Recipe::parse_with(text, "recipe.toml", &Registry::all()) else { return };
    let Ok(printed) = recipe.print() else { return };
    let again = Recipe::parse(&printed, "printed.toml");
    assert_eq!(again.ok().as_ref(), Some(&recipe), "{printed}");
}
