//! Other programs read what exurb wrote, without errors and at the right place and scale.
//!
//! `cargo xtask test` installs them and says where they are; a plain `cargo test` skips these tests
//! aloud. Once the place is named, a missing program is a failure.

#![allow(clippy::print_stdout, reason = "what tests report")]

use std::path::Path;
use std::process::{Command, Stdio};

use exurb_scenarios::{demo, root};

/// Runs a script of `consumers/` on files; what it prints is shown when it fails.
fn check(interpreter: &str, script: &str, files: &[&Path]) {
    let Some(program) = std::env::var_os(interpreter) else {
        println!("skipped: no {interpreter}; `cargo xtask test` installs it");
        return;
    };
    let mut command = Command::new(program);
    if let Some(modules) = std::env::var_os("EXURB_NODE_MODULES") {
        command.env("NODE_PATH", modules);
    }
    let script_path = root().join("tests/consumers").join(script);
    let output = command
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .arg(script_path)
        .args(files)
        .stdin(Stdio::null())
        .output()
        .expect("the installed program starts");
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    println!("{}", said(&output.stdout));
    assert!(output.status.success(), "{script}: {}", said(&output.stderr));
}

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
