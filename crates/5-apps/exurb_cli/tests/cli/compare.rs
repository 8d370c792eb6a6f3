//! `exurb compare`: what it prints and writes, and what it does with bad input.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::tempdir;

use crate::{Ran, exurb, listing};

/// An example of 2 km x 1.5 km, enough for most measures.
const EXAMPLE: &str = "builtin:karhula";

fn grown(folder: &Path, example: &str, size: &str, name: &str) {
    let args = ["streets", "grow", "--example", example, "--size", size, "-o", name];
    exurb(folder, &args).ends(0);
}

fn compared(folder: &Path, args: &[&str]) -> Ran {
    exurb(folder, &[&["compare"], args].concat())
}

/// The document, and that no figure in it is anything but a number or null.
#[track_caller]
fn document(folder: &Path, args: &[&str]) -> Value {
    let ran = compared(folder, &[args, &["--json"]].concat()).ends(0);
    let text = compared(folder, args).ends(0).out;
    let words = text.split(|c: char| !c.is_alphanumeric()).chain(ran.out.split(['"', ' ', ',']));
    for word in words {
        assert!(word != "NaN" && word != "inf", "{word} in {text}");
    }
    ran.json()
}

fn notes(document: &Value) -> String {
    document["notes"].to_string()
}

#[test]
fn the_document_has_the_keys_of_the_contract() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "1000x1000", "city.gpkg");
    let found = document(folder.path(), &["city.gpkg", "--with", EXAMPLE]);
    for key in ["total", "core", "copy_rate_150m", "copy_rate_300m"] {
        assert!(found.as_object().unwrap().contains_key(key), "{key}");
    }
    assert!(found["total"].is_f64() && found["families"]["segments"].is_f64(), "{found}");
    let measures = found["measures"].as_object().unwrap();
    assert!(measures.len() >= 30);
    for (name, measure) in measures {
        for key in ["ceiling", "floor", "distance", "score"] {
            let value = &measure[key];
            assert!(value.is_null() || value.as_f64().unwrap().is_finite(), "{name} {key}");
        }
        // Between marks that do not separate, a score would mean nothing.
        assert!(measure["informative"].as_bool().unwrap() || measure["score"].is_null(), "{name}");
    }
    assert!(notes(&found).contains("was not unseen"), "{}", notes(&found));
    assert!(found["laws"]["crossings_without_node"]["pass"].as_bool().unwrap());
    assert!(found["likeness_gates"]["dead_end_share"].is_object());
    assert!(found["example_share"].as_f64().unwrap() > 0.5);
    let again = document(folder.path(), &["city.gpkg", "--with", EXAMPLE, "--threads", "1"]);
    assert_eq!(found, again, "threads decide");
}

#[test]
fn every_example_has_its_column() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "1000x1000", "city.gpkg");
    let args = ["city.gpkg", "--with", EXAMPLE, "--with", "builtin:suburb"];
    let found = document(folder.path(), &args);
    let examples = found["examples"].as_array().unwrap();
    assert_eq!(examples.len(), 2);
    assert!(examples[0]["example_share"].as_f64().unwrap() > 0.5);
    assert_eq!(examples[1]["example_share"], 0.0);
    assert_eq!(found["total"], examples[0]["total"]);
    let text = compared(folder.path(), &args).ends(0).out;
    let head = text.lines().nth(1).unwrap();
    assert!(head.contains("karhula") && head.contains("suburb"), "{head}");
    assert!(text.contains("laid from it"), "{text}");
    compared(folder.path(), &[&args[..], &["--held-out", EXAMPLE]].concat())
        .ends(2)
        .says("one --held-out for each --with");
}

#[test]
fn other_cities_can_be_the_floor() {
    let folder = tempdir().unwrap();
    let args = [
        "builtin:suburb",
        "--with",
        EXAMPLE,
        "--floor",
        "builtin:grid",
        "--floor",
        "builtin:saltlake",
    ];
    let found = document(folder.path(), &args);
    assert_eq!(found["floor"].as_array().unwrap().len(), 2);
    assert!(!notes(&found).contains("is no other city"), "{}", notes(&found));
    // The example as its own floor: as far as itself, so that nothing separates.
    let itself = ["--held-out", "builtin:grid", "--floor", EXAMPLE];
    let own =
        document(folder.path(), &[&["builtin:suburb", "--with", EXAMPLE], &itself[..]].concat());
    assert!(notes(&own).contains("is no other city"), "{}", notes(&own));
    assert!(own["total"].is_null() && notes(&own).contains("there is no score"), "{own}");
}

#[test]
fn the_page_and_the_map_are_whole_or_not_there() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "1000x1000", "city.gpkg");
    let args = ["city.gpkg", "--with", EXAMPLE, "--report", "page.html", "--map", "map.gpkg"];
    compared(folder.path(), &args).ends(0);
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    // Nothing is fetched: no address, no script, no style or picture that is not inside.
    for word in ["http:", "https:", "//", "<script", "<link", "@import", "url("] {
        let plain: String =
            page.split("base64,").map(|part| part.split_once('"').map_or(part, |p| p.1)).collect();
        assert!(!plain.contains(word), "{word}");
    }
    for words in ["What differs most", "Side by side", "OpenStreetMap contributors", "city"] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(page.matches("<img ").count(), 3);
    let map = fs::read(folder.path().join("map.gpkg")).unwrap();
    assert!(map.starts_with(b"SQLite format 3"));
    for word in ["unlikely", "junctions", "blocks", "rectangularity"] {
        assert!(map.windows(word.len()).any(|w| w == word.as_bytes()), "{word}");
    }
    let before = listing(folder.path());
    let nowhere = ["city.gpkg", "--with", EXAMPLE, "--report", "nowhere/page.html"];
    compared(folder.path(), &nowhere).ends(1).says("nowhere");
    assert_eq!(listing(folder.path()), before);
}

#[test]
fn what_is_written_replaces_no_city() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "1000x1000", "city.gpkg");
    let before = fs::read(folder.path().join("city.gpkg")).unwrap();
    for (args, words) in [
        (["city.gpkg", "--with", EXAMPLE, "--report", "city.gpkg"], "name a .html file"),
        (["city.gpkg", "--with", EXAMPLE, "--map", "city.gpkg"], "would be lost"),
        ([EXAMPLE, "--with", "city.gpkg", "--map", "./city.gpkg"], "would be lost"),
        (["city.gpkg", "--with", EXAMPLE, "--map", "map.html"], "name a .gpkg file"),
    ] {
        compared(folder.path(), &args).ends(2).says(words);
    }
    assert_eq!(listing(folder.path()), ["city.gpkg"]);
    assert_eq!(fs::read(folder.path().join("city.gpkg")).unwrap(), before);
}

/// A window that is smaller by a few metres counts whole and does not cut the others.
#[test]
fn about_the_same_size_is_the_same_size() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "1000x1000", "part.gpkg");
    let window = |size: &str| {
        grown(folder.path(), EXAMPLE, size, "city.gpkg");
        let args = ["city.gpkg", "--with", EXAMPLE, "--held-out", "part.gpkg"];
        let found = document(folder.path(), &args);
        let is_noted = notes(&found).contains("the most that city holds");
        ([0, 1].map(|i| found["window_m"][i].as_f64().unwrap().round()), is_noted)
    };
    assert_eq!(window("985x1000"), ([1000.0, 1000.0], false));
    assert_eq!(window("900x1000"), ([900.0, 1000.0], true));
}

#[test]
fn small_windows_leave_measures_out_and_say_so() {
    let folder = tempdir().unwrap();
    grown(folder.path(), EXAMPLE, "300x300", "small.gpkg");
    let found = document(folder.path(), &["small.gpkg", "--with", EXAMPLE]);
    assert!(notes(&found).contains("left out, too few values"), "{}", notes(&found));
    assert!(notes(&found).contains("fewer than 30"), "{}", notes(&found));
    assert!(found["measures"]["order_phi_1km"]["score"].is_null());
    assert!(found["measures"]["patch_c2st_auc"]["distance"].is_null());
    let [width, height] = [0, 1].map(|i| found["window_m"][i].as_f64().unwrap());
    assert!(width <= 301.0 && height <= 301.0, "{width} {height}");
    assert!(notes(&found).contains("cut to"), "{}", notes(&found));
}

#[test]
fn a_copy_of_the_example_is_called_one() {
    let folder = tempdir().unwrap();
    let found = document(folder.path(), &[EXAMPLE, "--with", EXAMPLE]);
    assert_eq!(found["copy_rate_150m"], 1.0);
    assert!(notes(&found).contains("is a copy of the example"), "{}", notes(&found));
    let whole = document(folder.path(), &[EXAMPLE, "--with", EXAMPLE, "--held-out", EXAMPLE]);
    assert!(notes(&whole).contains("not unseen"), "{}", notes(&whole));
}

/// Streets that meet nowhere: no junctions, no blocks. Every other one ends inside.
#[test]
fn a_city_without_blocks_is_judged_by_what_it_has() {
    let folder = tempdir().unwrap();
    let street = |i: u32| {
        let (y, from, to) = (60 * i, 100 * (i % 2), 1200 - 100 * (i % 2));
        format!(
            r#"{{"type":"Feature","properties":{{"highway":"residential"}},
            "geometry":{{"type":"LineString","coordinates":[[{from},{y}],[{to},{y}]]}}}}"#
        )
    };
    let streets: Vec<String> = (0..20).map(street).collect();
    let text = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, streets.join(","));
    fs::write(folder.path().join("rows.geojson"), text).unwrap();
    let found = document(folder.path(), &["rows.geojson", "--with", EXAMPLE]);
    let lacking = "which score -1: Length of streets within a walk of 500 m";
    assert!(notes(&found).contains(lacking), "{}", notes(&found));
    assert_eq!(found["measures"]["reach_500m"]["score"], -1.0);
    assert!(found["measures"]["block_area"]["distance"].is_null());
    assert!(found["measures"]["seg_length"]["distance"].is_number());
}

#[test]
fn a_city_without_streets_cannot_be_compared() {
    let folder = tempdir().unwrap();
    let point = r#"{"type":"FeatureCollection","features":[{"type":"Feature",
        "properties":{"element":"tree"},"geometry":{"type":"Point","coordinates":[1,1]}}]}"#;
    fs::write(folder.path().join("tree.geojson"), point).unwrap();
    compared(folder.path(), &["tree.geojson", "--with", EXAMPLE]).ends(2).says("tree.geojson");
    compared(folder.path(), &["gone.gpkg", "--with", EXAMPLE]).ends(2).says("gone.gpkg");
    compared(folder.path(), &["--yardstick", EXAMPLE]).ends(2).says("at least two");
    compared(folder.path(), &[EXAMPLE]).ends(2).says("--with");
}

/// What stands between two cities and a regular grid: copies that are spoilt more score less, and each
/// row says how far it lies below the one before.
#[test]
fn the_yardstick_puts_spoilt_copies_in_order() {
    let folder = tempdir().unwrap();
    let args = ["--yardstick", EXAMPLE, "builtin:suburb", "--json"];
    let found = compared(folder.path(), &args).ends(0).json();
    let rows = found["rows"].as_array().unwrap();
    let total = |i: usize| rows[i]["total"][0].as_f64().unwrap();
    assert_eq!((rows.len(), total(0)), (9, 1.0));
    let names: Vec<&str> = rows.iter().map(|r| r["candidate"].as_str().unwrap()).collect();
    let at = |words: &str| names.iter().position(|n| n.contains(words)).unwrap();
    for kinds in [
        ["10 m node noise", "25 m node noise"],
        ["10 % of segments removed", "30 % of segments removed"],
    ] {
        let [little, much] = kinds.map(|kind| total(at(kind)));
        assert!(1.0 > little && little > much, "{kinds:?}: {little} {much}");
    }
    assert!(total(0) > total(at("regular grid")), "{found}");
    // With two cities there is no third as the floor of another real city.
    let (step, other) = (|i: usize| rows[i]["lower"]["by"].as_f64(), at("another real city"));
    assert_eq!((step(0), step(other), step(other + 1)), (None, None, None));
    assert!(rows[other]["total"].is_null() && rows[other]["core"].is_null(), "{found}");
    for i in (1..rows.len()).filter(|i| *i != other && *i != other + 1) {
        let apart = total(i - 1) - total(i);
        assert!((step(i).unwrap() - apart).abs() < 1e-9, "both cities have a TOTAL: {found}");
    }
}

/// The same streets in metres without a place, and delivered once in each direction.
#[test]
fn metres_and_streets_delivered_twice_measure_as_the_city_does() {
    let folder = tempdir().unwrap();
    let export = ["export", "builtin:grid", "-o", "grid.geojson", "--layer", "streets"];
    exurb(folder.path(), &export).ends(0);
    let file = folder.path().join("grid.geojson");
    let mut city: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    let features = city["features"].as_array().unwrap().clone();
    let turned = features.iter().cloned().map(|mut f| {
        if let Some(line) = f["geometry"]["coordinates"].as_array_mut() {
            line.reverse();
        }
        f
    });
    let twice: Vec<Value> = features.iter().cloned().chain(turned).collect();
    city["features"] = twice.into();
    fs::write(folder.path().join("twice.geojson"), city.to_string()).unwrap();
    let of = |name: &str| {
        let found = document(folder.path(), &[name, "--with", "builtin:grid"]);
        let distance = |m: &str| found["measures"][m]["distance"].as_f64().unwrap();
        ["seg_length", "node_degree", "block_area", "density_length"].map(distance)
    };
    assert_eq!(of("grid.geojson"), of("twice.geojson"));
}
