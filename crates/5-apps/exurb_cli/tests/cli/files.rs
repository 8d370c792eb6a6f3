//! What is written, where, and what is left when it cannot be.

use std::fs;

use tempfile::tempdir;

use crate::{exurb, listing, small_city};

#[test]
fn an_output_that_cannot_be_written_ends_with_1_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("folder.gpkg")).unwrap();
    fs::write(folder.path().join("file"), b"").unwrap();
    let before = listing(folder.path());
    for output in ["no/folder/c.gpkg", "folder.gpkg", "file/c.gpkg"] {
        for command in ["import builtin:helsinki", "streets grow -e builtin:helsinki --size 300"] {
            let args: Vec<&str> = command.split(' ').chain(["-o", output]).collect();
            exurb(folder.path(), &args).ends(1).says(output);
        }
    }
    assert_eq!(listing(folder.path()), before);
    assert!(listing(&folder.path().join("folder.gpkg")).is_empty());
}

#[test]
fn a_failure_leaves_the_file_that_was_there() {
    let folder = tempdir().unwrap();
    let city = folder.path().join("c.gpkg");
    fs::write(&city, b"precious").unwrap();
    let args = ["import", "missing.osm", "-o", "c.gpkg"];
    exurb(folder.path(), &args).ends(2);
    assert_eq!(fs::read(&city).unwrap(), b"precious");
    assert_eq!(listing(folder.path()), ["c.gpkg"]);
}

#[test]
fn every_format_is_written_and_the_readable_ones_are_read_again() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    let km = |file: &str| {
        let info = exurb(folder.path(), &["info", file, "--json"]).ends(0).json();
        info["streets"]["km"].as_f64().unwrap()
    };
    let expected = km("c.gpkg");
    assert!(expected > 1.0);
    for ending in ["gpkg", "geojson", "osm", "osm.gz", "osm.pbf", "glb", "obj", "svg", "png"] {
        let name = format!("out.{ending}");
        exurb(folder.path(), &["export", "c.gpkg", "-o", &name]).ends(0);
        let size = fs::metadata(folder.path().join(&name)).unwrap().len();
        assert!(size > 100, "{name} has {size} bytes");
        if ["gpkg", "geojson", "osm", "osm.gz", "osm.pbf"].contains(&ending) {
            let again = km(&name);
            assert!((again - expected).abs() < 0.1 * expected, "{name}: {again} of {expected} km");
        }
    }
    exurb(folder.path(), &["export", "c.gpkg", "-o", "model.dat", "--to", "glb"]).ends(0);
    let glb = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(glb("model.dat"), glb("out.glb"));
}

#[test]
fn a_layer_can_be_exported_alone() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    let args = ["export", "c.gpkg", "-o", "blocks.geojson", "--layer", "blocks"];
    exurb(folder.path(), &args).ends(0);
    let text = fs::read_to_string(folder.path().join("blocks.geojson")).unwrap();
    assert!(text.contains("\"element\":\"block\"") || text.contains("\"element\": \"block\""));
    assert!(!text.contains("\"street\""));
    exurb(folder.path(), &["export", "c.gpkg", "-o", "x.geojson", "--layer", "roofs"])
        .ends(2)
        .says("buildings");
}

#[test]
fn pictures_are_drawn_in_every_style() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    for (name, extra) in [
        ("map.png", vec!["--width", "400"]),
        ("map.svg", vec!["--style", "figure"]),
        ("dark.svg", vec!["--style", "dark", "--color-by", "origin"]),
        ("view.png", vec!["--view", "3d", "--width", "400"]),
    ] {
        let args: Vec<&str> = ["render", "c.gpkg", "-o", name].into_iter().chain(extra).collect();
        exurb(folder.path(), &args).ends(0);
        let bytes = fs::read(folder.path().join(name)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") == name.ends_with(".png"), "{name}");
    }
    exurb(folder.path(), &["render", "c.gpkg", "-o", "v.svg", "--view", "3d"]).ends(2).says(".png");
    exurb(folder.path(), &["render", "c.gpkg", "-o", "v.svg", "--style", "baroque"])
        .ends(2)
        .says("dark");
}

#[test]
fn the_geojson_files_of_one_place_are_imported_together() {
    let folder = tempdir().unwrap();
    let layers = ["streets", "parcels", "buildings"];
    for layer in layers {
        let file = format!("{layer}.geojson");
        let args = ["export", "builtin:prague", "-o", &file, "--layer", layer];
        exurb(folder.path(), &args).ends(0);
    }
    let files = layers.map(|layer| format!("{layer}.geojson"));
    let args = ["import", &files[0], &files[1], &files[2], "-o", "c.gpkg", "--json"];
    let report = exurb(folder.path(), &args).ends(0).json();
    let whole = exurb(folder.path(), &["info", "builtin:prague", "--json"]).ends(0).json();
    for layer in layers {
        assert_eq!(report[layer]["count"], whole[layer]["count"], "{layer}");
    }
    exurb(folder.path(), &["import", &files[0], "c.gpkg", "-o", "d.gpkg"]).ends(2).says("c.gpkg");
}
