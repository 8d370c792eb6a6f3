//! The demo: all files, a whole city, and its recipe.

use std::fs;

use tempfile::tempdir;

use crate::{exurb, listing};

const FILES: [&str; 10] = [
    "ATTRIBUTION.txt",
    "city.geojson",
    "city.glb",
    "city.gpkg",
    "city.osm",
    "city.osm.pbf",
    "map.png",
    "map.svg",
    "recipe.toml",
    "view.png",
];

#[test]
fn the_demo_writes_a_whole_city_and_the_recipe_that_makes_it_again() {
    let folder = tempdir().unwrap();
    let report = exurb(folder.path(), &["demo", "--json"]).ends(0).json();
    let demo = folder.path().join("exurb-demo");
    assert_eq!(listing(&demo), FILES);
    assert_eq!(report["area_km2"], 4.0);
    assert!(report["buildings"]["count"].as_u64() >= Some(500), "{}", report["buildings"]);
    assert_eq!(report["valid"], true, "{}", report["problems"]);
    let attribution = fs::read_to_string(demo.join("ATTRIBUTION.txt")).unwrap();
    assert!(attribution.contains("© OpenStreetMap contributors, ODbL 1.0"), "{attribution}");

    exurb(folder.path(), &["run", "exurb-demo/recipe.toml", "-o", "again"]).ends(0);
    let again = folder.path().join("again");
    for name in listing(&again) {
        let same = fs::read(demo.join(&name)).unwrap() == fs::read(again.join(&name)).unwrap();
        assert!(same, "{name} differs");
    }
    assert_eq!(listing(&again).len(), 8);
}

#[test]
fn unknown_styles_are_refused() {
    let folder = tempdir().unwrap();
    exurb(folder.path(), &["demo", "--style", "atlantis"]).ends(2).says("helsinki");
    assert!(listing(folder.path()).is_empty());
}

#[test]
fn the_demo_takes_a_map_of_ones_own() {
    let folder = tempdir().unwrap();
    exurb(folder.path(), &["export", "builtin:karhula", "-o", "mine.osm.pbf"]).ends(0);
    let args = "demo --example mine.osm.pbf --size 700x500 -o city --json";
    let report = exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0).json();
    assert_eq!(report["area_km2"], 0.35);
    assert_eq!(listing(&folder.path().join("city")), FILES);
    exurb(folder.path(), &["demo", "--example", "a.osm", "--style", "grid"]).ends(2);
}
