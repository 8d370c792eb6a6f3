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
fn an_import_does_not_replace_its_map() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    exurb(folder.path(), &["export", "c.gpkg", "-o", "map.osm.pbf"]).ends(0);
    let before = fs::read(folder.path().join("map.osm.pbf")).unwrap();
    let args = ["import", "map.osm.pbf", "-o", "./map.osm.pbf"];
    exurb(folder.path(), &args).ends(2).says("would be lost");
    assert_eq!(fs::read(folder.path().join("map.osm.pbf")).unwrap(), before);
}

#[test]
fn scopes_and_blocks_that_are_not_there_are_refused() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    let far = r#"{"type":"Polygon","coordinates":[[[24,60],[24.1,60],[24.1,60.1],[24,60]]]}"#;
    fs::write(folder.path().join("far.geojson"), far).unwrap();
    let example = ["--example", "builtin:grid", "-o", "d.gpkg"];
    let scope = ["streets", "grow", "c.gpkg", "--scope", "far.geojson"];
    exurb(folder.path(), &[&scope[..], &example].concat()).ends(2).says("outside the city");
    let blocks = ["blocks", "parcels", "c.gpkg", "--blocks", "99999"];
    exurb(folder.path(), &[&blocks[..], &example].concat()).ends(2).says("no block 99999");
    assert_eq!(listing(folder.path()), ["c.gpkg", "far.geojson"]);
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
            assert!((again / expected - 1.0).abs() < 1e-4, "{name}: {again} of {expected} km");
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
fn intersections_can_be_exported_alone() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    let args = ["export", "c.gpkg", "-o", "i.geojson", "--layer", "intersections"];
    exurb(folder.path(), &args).ends(0);
    let text = fs::read_to_string(folder.path().join("i.geojson")).unwrap();
    assert!(text.contains("\"degree\":3") && !text.contains("\"street\""));
    let args = ["export", "c.gpkg", "-o", "i.svg", "--layer", "intersections"];
    exurb(folder.path(), &args).ends(2).says(".gpkg or .geojson");
}

#[test]
fn journals_of_a_replaced_geopackage_go_with_it() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("c.gpkg"), b"old").unwrap();
    fs::write(folder.path().join("c.gpkg-wal"), b"pages of the old file").unwrap();
    exurb(folder.path(), &["import", "missing.osm", "-o", "c.gpkg"]).ends(2);
    assert_eq!(listing(folder.path()), ["c.gpkg", "c.gpkg-wal"]);
    small_city(folder.path(), "c.gpkg");
    assert_eq!(listing(folder.path()), ["c.gpkg"]);
}

#[cfg(unix)]
#[test]
fn a_device_is_written_to_and_not_replaced() {
    let folder = tempdir().unwrap();
    for format in ["gpkg", "geojson", "png"] {
        let args = ["export", "builtin:prague", "-o", "/dev/null", "--to", format];
        exurb(folder.path(), &args).ends(0);
    }
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn a_dry_run_reads_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    let run = |args: &str| exurb(folder.path(), &args.split(' ').collect::<Vec<_>>());
    run("import builtin:prague -o c.gpkg --dry-run").ends(0);
    run("export builtin:prague -o c.glb --dry-run").ends(0);
    run("render builtin:prague -o c.png --dry-run").ends(0);
    let recipe = run("demo --style prague --dry-run").ends(0).out;
    assert!(recipe.contains("builtin:prague"), "{recipe}");
    run("import missing.osm -o c.gpkg --dry-run").ends(2);
    run("demo --example missing.osm -o folder").ends(2);
    assert_eq!(listing(folder.path()), [""; 0]);
}

#[test]
fn options_of_the_other_kind_of_picture_are_refused() {
    let folder = tempdir().unwrap();
    for (options, words) in [
        ("--view 3d --color-by origin", "for maps"),
        ("--view 3d --style dark", "for maps"),
        ("--elevation 40", "view 3d"),
        ("--view 3d --elevation 100", "expected 2 to 89"),
        ("--view 3d --zoom -1", "expected 0.1 to 100"),
        ("--view 3d --width 9000", "8192"),
        ("--to gpkg", "png, svg"),
    ] {
        let args = format!("render builtin:prague -o c.png {options}");
        exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(2).says(words);
    }
    assert_eq!(listing(folder.path()), [""; 0]);
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

#[test]
fn an_import_joins_carriageways_when_asked() {
    let folder = tempdir().unwrap();
    let map = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../data/saltlake.osm.pbf")
        .display()
        .to_string();
    let km = |args: &[&str]| {
        let args = [&["import", &map, "-o", "c.gpkg", "--json"], args].concat();
        let report = exurb(folder.path(), &args).ends(0).json();
        report["streets"]["km"].as_f64().unwrap()
    };
    let (whole, simple) = (km(&[]), km(&["--simplify"]));
    assert!(simple < 0.99 * whole && simple > 0.5 * whole, "{whole} {simple}");
}
