//! Help, wrong usage, unreadable input.

use std::fs;

use tempfile::tempdir;

use crate::{exurb, listing};

#[test]
fn help_lists_the_commands_that_are_there_and_no_others() {
    let folder = tempdir().unwrap();
    let help = exurb(folder.path(), &["--help"]).ends(0).out;
    for command in [
        "demo",
        "run",
        "import",
        "info",
        "streets",
        "blocks",
        "buildings",
        "export",
        "render",
        "compare",
        "learn",
        "schema",
        "completions",
    ] {
        assert!(help.contains(&format!("\n  {command} ")), "{command} is missing in {help}");
    }
    for later in ["imagery", "studio"] {
        assert!(!help.contains(later), "{later}");
    }
    assert!(exurb(folder.path(), &["--version"]).ends(0).out.starts_with("exurb 0."));
}

#[test]
fn every_parameter_of_the_schema_is_a_flag_with_help() {
    let folder = tempdir().unwrap();
    let all = exurb(folder.path(), &["schema"]).ends(0).json();
    assert!(all.as_object().unwrap().contains_key("streets grow"));
    for (name, schema) in all.as_object().unwrap() {
        let words: Vec<&str> = name.split(' ').chain(["--help"]).collect();
        let help = exurb(folder.path(), &words).ends(0).out;
        for (parameter, property) in schema["properties"].as_object().unwrap() {
            let flag = format!("--{}", parameter.replace('_', "-"));
            assert!(help.contains(&flag), "{name} lacks {flag}");
            assert!(property["description"].is_string(), "{name} {parameter} is not described");
        }
        let one: Vec<&str> = ["schema"].into_iter().chain(name.split(' ')).collect();
        assert_eq!(&exurb(folder.path(), &one).ends(0).json(), schema);
    }
}

#[test]
fn wrong_usage_ends_with_2_and_says_what_is_wrong() {
    let folder = tempdir().unwrap();
    let run = |args: &str| exurb(folder.path(), &args.split(' ').collect::<Vec<_>>());
    run("grow").ends(2).says("grow");
    run("streets").ends(2);
    run("streets grow --example builtin:helsinki --sise 9 -o c.gpkg").ends(2).says("--sise");
    run("streets grow --example builtin:helsinki").ends(2).says("--output");
    run("streets grow -o c.gpkg").ends(2).says("--example");
    run("streets grow --example builtin:nowhere -o c.gpkg").ends(2).says("helsinki, karhula");
    run("streets grow --example builtin:helsinki --continuation 7 -o c.gpkg")
        .ends(2)
        .says("`continuation` is 7, expected 0 to 1");
    run("streets grow --example builtin:helsinki --size 0x0 -o c.gpkg").ends(2).says("too small");
    run("streets grow --example builtin:helsinki --size 200000x200000 -o c.gpkg")
        .ends(2)
        .says("10,000 km²");
    run("streets grow --example builtin:helsinki --bbox 1,2,3 -o c.gpkg").ends(2).says("--bbox");
    run("export builtin:helsinki -o city.dwg").ends(2).says(".gpkg");
    run("render builtin:helsinki -o city.glb").ends(2).says(".png or .svg");
    run("schema streets fly").ends(2).says("streets grow");
    assert!(listing(folder.path()).is_empty());
}

#[test]
fn unreadable_input_ends_with_2_and_names_the_file() {
    let folder = tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("empty.osm.pbf", b"");
    write("text.txt", b"hello");
    write("broken.osm.pbf", b"\0\0\0\x0d\x0a\x09OSMHeader\x18\xff");
    write("broken.osm", b"<osm><node id='1'");
    write("broken.osm.gz", b"\x1f\x8b\x08 not really");
    write("broken.geojson", b"{\"type\":\"FeatureCollection\",\"features\":[");
    write("broken.gpkg", b"SQLite format 3\0 and then nothing");
    write("broken.json", b"{\"version\": 0.6, \"elements\": [");
    let before = listing(folder.path());
    for file in before.iter().map(String::as_str).chain(["missing.osm.pbf", "."]) {
        for command in ["info FILE", "import FILE -o c.gpkg", "streets grow -e FILE -o c.gpkg"] {
            let command = command.replace("FILE", file);
            let args: Vec<&str> = command.split(' ').collect();
            let ran = exurb(folder.path(), &args).ends(2).says(file);
            assert!(!ran.err.contains("panicked"), "{}", ran.err);
            assert_eq!(ran.err.trim_end().lines().count(), 1, "{}", ran.err);
            assert_eq!(ran.out, "");
        }
    }
    assert_eq!(listing(folder.path()), before);
}

#[test]
fn an_example_teaches_every_method() {
    let folder = tempdir().unwrap();
    let lesson = exurb(folder.path(), &["learn", "builtin:prague"]).ends(0).json();
    let methods = &lesson["methods"];
    assert!(methods["streets grow"][0]["local"]["patches"].as_u64() > Some(5), "{methods}");
    assert!(methods["blocks parcels"]["frontage_m"].as_f64() > Some(5.0), "{methods}");
    assert!(methods["blocks footprints"]["buildings"].as_u64() > Some(50), "{methods}");
    assert!(methods["buildings extrude"]["known_heights"].is_u64(), "{methods}");
    assert!(methods["streets furnish"]["trees"]["spacing_m"].is_number(), "{methods}");
    exurb(folder.path(), &["learn", "builtin:prague", "-o", "l.json"]).ends(0);
    let kept = fs::read_to_string(folder.path().join("l.json")).unwrap();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&kept).unwrap(), lesson);
}

#[test]
fn figures_of_nothing_are_nothing() {
    let folder = tempdir().unwrap();
    let house = r#"{"type":"Feature","properties":{"building":"yes"},"geometry":{"type":"Polygon",
        "coordinates":[[[14.4,50.1],[14.401,50.1],[14.401,50.101],[14.4,50.1]]]}}"#;
    fs::write(folder.path().join("house.geojson"), house).unwrap();
    let text = exurb(folder.path(), &["info", "house.geojson"]).ends(0).out;
    assert!(text.contains("0 of 0.0 km"), "{text}");
    let report = exurb(folder.path(), &["import", "house.geojson", "-o", "c.gpkg"]).ends(0).out;
    assert!(!report.contains("likeness gates"), "no example to be like: {report}");
}

#[test]
fn completions_name_the_methods() {
    let folder = tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = exurb(folder.path(), &["completions", shell]).ends(0).out;
        assert!(script.contains("grow"), "{shell}");
    }
}
