//! What is fuzzed: plain functions of bytes. The libFuzzer targets call them, and so does a test
//! over the corpus (`tests/fuzz_corpus.rs`).
//!
//! A body passes when it returns: broken input is an error, never a panic, and what is read keeps
//! the laws of the graph.

use std::path::Path;

use exurb_city::{ImportOptions, Imported};
use exurb_osm::Format;
use exurb_recipe::{Recipe, Registry, Target};

/// Every body by the name of its target.
pub const BODIES: [(&str, fn(&[u8])); 7] = [
    ("geojson", geojson),
    ("geopackage", geopackage),
    ("overpass", overpass),
    ("pbf", pbf),
    ("recipe", recipe),
    ("target", target),
    ("xml", xml),
];

/// OSM XML, plain or packed.
pub fn xml(data: &[u8]) {
    osm(data, Format::Xml);
}

/// OSM PBF.
pub fn pbf(data: &[u8]) {
    osm(data, Format::Pbf);
}

/// Overpass JSON.
pub fn overpass(data: &[u8]) {
    osm(data, Format::Overpass);
}

fn osm(data: &[u8], format: Format) {
    keeps_the_laws(exurb_osm::read_bytes(data, "fuzz", Some(format), &ImportOptions::default()));
}

/// GeoJSON.
pub fn geojson(data: &[u8]) {
    with_file("map.geojson", data, |path| {
        keeps_the_laws(exurb_gis::read_geojson(path, &ImportOptions::default()));
    });
}

/// GeoPackage.
pub fn geopackage(data: &[u8]) {
    with_file("map.gpkg", data, |path| {
        keeps_the_laws(exurb_gis::read_geopackage(path, &ImportOptions::default()));
    });
}

/// The area of a new city.
pub fn target(data: &[u8]) {
    with_file("area.geojson", data, |path| {
        let target = Target::File(path.to_owned());
        let recipe = Recipe { target: Some(target), ..Recipe::default() };
        let run = exurb_operation::Run::new(1);
        let _ = recipe.run(Path::new(""), &run);
    });
}

/// A recipe's text: what is read prints to a recipe that reads the same.
pub fn recipe(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(recipe) = Recipe::parse_with(text, "recipe.toml", &Registry::all()) else { return };
    let Ok(printed) = recipe.print() else { return };
    let again = Recipe::parse(&printed, "printed.toml");
    assert_eq!(again.ok().as_ref(), Some(&recipe), "{printed}");
}

fn keeps_the_laws<E>(read: Result<Imported, E>) {
    if let Ok(imported) = read {
        let breaches = exurb_graph::laws::breaches(&imported.city.streets);
        assert!(breaches.is_empty(), "{breaches:?}");
    }
}

/// Readers that want a file get one of their own, in memory where the system has such a place.
fn with_file(name: &str, data: &[u8], read: impl FnOnce(&Path)) {
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
    let folder = folder.expect("a temporary folder can be made");
    let path = folder.path().join(name);
    std::fs::write(&path, data).expect("a temporary file can be written");
    read(&path);
}
