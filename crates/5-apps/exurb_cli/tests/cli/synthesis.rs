//! Streets, blocks and buildings: reports, seeds, threads.

use std::fs;

use serde_json::Value;
use tempfile::tempdir;

use crate::{exurb, listing, small_city};

/// The stages after the streets, in order.
const STAGES: [&str; 4] =
    ["streets furnish", "blocks parcels", "blocks footprints", "buildings extrude"];

#[test]
fn the_report_has_the_keys_of_the_contract() {
    let folder = tempdir().unwrap();
    let args = "streets grow -e builtin:helsinki --size 600 -o c.gpkg --json";
    let report = exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0).json();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    for (part, expected) in [
        (
            "streets",
            "count km km_by_class km_by_role dead_end_share crossings_without_node components largest_component_share",
        ),
        ("intersections", "count by_degree"),
        ("blocks", "count median_area"),
        ("parcels", "count street_access_share"),
        ("buildings", "count overlapping outside_block crossed_by_street coverage median_height"),
        ("provenance", "example_share procedural_share other_share"),
        ("seconds", "read learn synthesise write"),
    ] {
        let there = keys(&report[part]);
        let missing: Vec<&str> =
            expected.split(' ').filter(|k| !there.iter().any(|t| t == k)).collect();
        assert!(missing.is_empty(), "{part} lacks {missing:?}");
    }
    for key in ["laws", "likeness_gates", "area_km2", "valid", "problems_total", "problems"] {
        assert!(report.get(key).is_some(), "{key} is missing");
    }
    assert_eq!(report["area_km2"], 0.36);
    assert_eq!(report["valid"], true);
    let info = exurb(folder.path(), &["info", "c.gpkg", "--json"]).ends(0).json();
    assert_eq!(info["streets"], report["streets"]);
    assert_eq!(info["likeness_gates"], report["likeness_gates"]);
}

#[test]
fn one_seed_gives_one_city_whatever_the_threads_and_folders() {
    let folder = tempdir().unwrap();
    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    let make = |folder: &std::path::Path, example: &str, threads: &str, seed: &str| {
        let args = format!(
            "streets grow -e {example} --size 800 --threads {threads} --seed {seed} -o c.gpkg"
        );
        exurb(folder, &args.split(' ').collect::<Vec<_>>()).ends(0);
        for stage in STAGES {
            let args =
                format!("{stage} c.gpkg -e {example} --threads {threads} --seed {seed} -o c.gpkg");
            exurb(folder, &args.split(' ').collect::<Vec<_>>()).ends(0);
        }
        fs::read(folder.join("c.gpkg")).unwrap()
    };
    let one = make(folder.path(), "builtin:helsinki", "1", "4");
    assert_eq!(one, make(&other, "builtin:helsinki", "2", "4"), "threads change the city");
    assert_ne!(one, make(&other, "builtin:helsinki", "2", "5"), "the seed changes nothing");
}

#[test]
fn a_dry_run_writes_nothing() {
    let folder = tempdir().unwrap();
    let args = "streets grow -e builtin:helsinki --size 600 --dry-run -o c.gpkg";
    exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0);
    assert!(listing(folder.path()).is_empty());
    exurb(folder.path(), &["streets", "grow", "-e", "missing.osm", "--dry-run"]).ends(2);
}

#[test]
fn quiet_prints_nothing_but_the_json() {
    let folder = tempdir().unwrap();
    small_city(folder.path(), "c.gpkg");
    let ran = exurb(folder.path(), &["import", "c.gpkg", "-o", "d.gpkg", "--quiet"]).ends(0);
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    let ran = exurb(folder.path(), &["info", "c.gpkg", "--quiet", "--json"]).ends(0);
    assert!(ran.json()["valid"].is_boolean() && ran.err.is_empty());
}

#[test]
fn too_little_memory_stops_the_work() {
    if !cfg!(target_os = "linux") {
        println!("skipped: --max-memory is kept on Linux only");
        return;
    }
    let folder = tempdir().unwrap();
    let args = "streets grow -e builtin:helsinki --size 20000 --max-memory 1M -o c.gpkg";
    exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(1).says("--max-memory");
    assert!(listing(folder.path()).is_empty());
}
