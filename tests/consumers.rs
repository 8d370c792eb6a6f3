//! Other programs read what exurb wrote, without errors and at the right place and scale.
//!
//! `cargo xtask test` installs them and says where they are; a plain `cargo test` skips these tests
//! aloud. Once the place is named, a missing program is a failure.

use std::path::Path;

use exurb_scenarios::{check, demo};

fn python(script: &str, files: &[&str]) {
    let files: Vec<_> = files.iter().map(|name| demo().file(name)).collect();
    let files: Vec<&Path> = files.iter().map(|file| file.as_path()).collect();
    check("EXURB_PYTHON", script, &files);
}

fn node(script: &str, files: &[&str]) {
    let files: Vec<_> = files.iter().map(|name| demo().file(name)).collect();
    let files: Vec<&Path> = files.iter().map(|file| file.as_path()).collect();
    check("EXURB_NODE", script, &files);
}

#[test]
fn osmium_reads_the_osm_files() {
    python("osm_osmium.py", &["city.osm", "city.osm.pbf", "city.geojson"]);
}

#[test]
fn osmnx_builds_the_street_graph() {
    python("osm_osmnx.py", &["city.osm", "city.geojson"]);
}

#[test]
fn sumo_builds_a_network() {
    python("osm_sumo.py", &["city.osm"]);
}

#[test]
fn gdal_reads_the_geopackage_at_its_place_and_scale() {
    python("gis_geopackage.py", &["city.gpkg", "city.geojson"]);
}

#[test]
fn the_geojson_is_valid() {
    python("gis_geojson.py", &["city.geojson"]);
}

#[test]
fn the_glb_passes_the_khronos_validator() {
    node("glb_validator.cjs", &["city.glb"]);
}

#[test]
fn three_js_draws_the_glb() {
    node("glb_three.cjs", &["city.glb"]);
}
