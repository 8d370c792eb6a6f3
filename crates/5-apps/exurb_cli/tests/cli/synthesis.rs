//! Streets, blocks and buildings: reports, seeds, threads.

#![allow(clippy::print_stdout, reason = "a skip says why")]

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
fn one_seed_gives_one_city_whatever_the_threads_and_file_names() {
    let folder = tempdir().unwrap();
    let make = |name: &str, threads: &str, seed: &str| {
        let common = format!("-e builtin:helsinki --threads {threads} --seed {seed} -o {name}");
        let mut commands = vec![format!("streets grow --size 800 {common}")];
        commands.extend(STAGES.map(|stage| format!("{stage} {name} {common}")));
        for command in commands {
            exurb(folder.path(), &command.split(' ').collect::<Vec<_>>()).ends(0);
        }
        fs::read(folder.path().join(name)).unwrap()
    };
    let one = make("one.gpkg", "1", "4");
    assert!(one == make("two.gpkg", "2", "4"), "threads or names change the city");
    assert!(one != make("two.gpkg", "2", "5"), "the seed changes nothing");
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

#[test]
fn a_target_elsewhere_on_earth_is_filled_there() {
    let folder = tempdir().unwrap();
    let area = r#"{"type":"Polygon","coordinates":[[[139.70,35.60],[139.71,35.60],[139.705,35.61],[139.70,35.60]]]}"#;
    fs::write(folder.path().join("area.geojson"), area).unwrap();
    let args = "streets grow -e builtin:helsinki --target area.geojson -o c.geojson --json";
    let report = exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0).json();
    let km2 = report["area_km2"].as_f64().unwrap();
    assert!((km2 - 0.502).abs() < 0.01, "{km2}");
    let text = fs::read_to_string(folder.path().join("c.geojson")).unwrap();
    let city: Value = serde_json::from_str(&text).unwrap();
    let side = |i: usize| city["bbox"][i].as_f64().unwrap();
    assert!(139.70 <= side(0) && 35.60 <= side(1) && side(2) <= 139.71 && side(3) <= 35.61);
    // The city that was made is a target, too.
    let args = "streets grow -e builtin:grid --target c.geojson -o d.gpkg --json";
    let again = exurb(folder.path(), &args.split(' ').collect::<Vec<_>>()).ends(0).json();
    let difference = again["area_km2"].as_f64().unwrap() - km2;
    assert!(difference.abs() < 0.001, "{difference}");
}

#[test]
fn targets_that_are_no_area_are_refused() {
    let folder = tempdir().unwrap();
    for (name, area) in [
        ("empty", r#"{"type":"FeatureCollection","features":[]}"#),
        ("line", r#"{"type":"LineString","coordinates":[[1,1],[2,2]]}"#),
        ("flat", r#"{"type":"Polygon","coordinates":[[[1,1],[1.001,1],[1,1]]]}"#),
        (
            "bow",
            r#"{"type":"Polygon","coordinates":[[[1,1],[1.01,1.01],[1.01,1],[1,1.01],[1,1]]]}"#,
        ),
        ("huge", r#"{"type":"Polygon","coordinates":[[[1,1],[5,1],[5,5],[1,5],[1,1]]]}"#),
        ("nowhere", r#"{"type":"Polygon","coordinates":[[[null,1],[5,1],[5,5],[1,1]]]}"#),
    ] {
        let file = format!("{name}.geojson");
        fs::write(folder.path().join(&file), area).unwrap();
        let args = ["streets", "grow", "-e", "builtin:grid", "-o", "c.gpkg", "--target", &file];
        exurb(folder.path(), &args).ends(2).says(&file);
    }
    assert!(!folder.path().join("c.gpkg").exists());
}

#[test]
fn an_interrupt_ends_the_work_cleanly() {
    if !cfg!(unix) {
        println!("skipped: no interrupts to send on this system");
        return;
    }
    let folder = tempdir().unwrap();
    let args = "streets grow -e builtin:helsinki --size 60000 -o c.gpkg";
    let child = std::process::Command::new(env!("CARGO_BIN_EXE_exurb"))
        .args(args.split(' '))
        .current_dir(folder.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // The work has begun when the file under way is there.
    while listing(folder.path()).is_empty() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let id = child.id().to_string();
    std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
    let ended = child.wait_with_output().unwrap();
    let message = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(1), "{message}");
    assert!(message.contains("stopped; nothing was written"), "{message}");
    assert!(listing(folder.path()).is_empty());
}

#[test]
fn a_sketch_becomes_ground_and_given_streets_stay_in_a_scope() {
    let folder = tempdir().unwrap();
    // Degrees around the built-in grid's own place are as good as any.
    let square = |west: f64, south: f64, side: f64, properties: Value| {
        let ring = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side], [0.0, 0.0]]
            .map(|[x, y]| [10.0 + west + x, 1.0 + south + y]);
        serde_json::json!({
            "type": "Feature", "properties": properties,
            "geometry": { "type": "Polygon", "coordinates": [ring] },
        })
    };
    let write = |name: &str, features: Vec<Value>| {
        let document = serde_json::json!({ "type": "FeatureCollection", "features": features });
        fs::write(folder.path().join(name), document.to_string()).unwrap();
    };
    let none = || serde_json::json!({});
    write("target.geojson", vec![square(0.0, 0.0, 0.012, none())]);
    let drawn = vec![
        square(0.008, -0.01, 0.03, serde_json::json!({ "use": "mountain" })),
        square(-0.02, -0.0195, 0.02, serde_json::json!({ "use": "water" })),
        square(0.003, 0.007, 0.002, serde_json::json!({ "use": "park" })),
    ];
    write("sketch.geojson", drawn);
    let run = |line: &str| exurb(folder.path(), &line.split(' ').collect::<Vec<_>>());
    let grow = "streets grow -e builtin:grid --target target.geojson --terrain sketch.geojson";
    let report = run(&format!("{grow} -o c.gpkg --json")).ends(0).json();
    assert_eq!(report["valid"], true, "{report}");
    assert_eq!(report["on_land"]["in_water_m"], 0.0);
    assert!(report["on_land"]["steepest_grade"].as_f64().unwrap() <= 0.2);
    assert!(report["terrain"]["highest"].as_f64().unwrap() > 30.0);

    // A hill more in the north-west: streets change there and nowhere else.
    let mut drawn: Vec<Value> = serde_json::from_str::<Value>(
        &fs::read_to_string(folder.path().join("sketch.geojson")).unwrap(),
    )
    .unwrap()["features"]
        .as_array()
        .unwrap()
        .clone();
    drawn.push(square(-0.01, 0.009, 0.0125, serde_json::json!({ "use": "mountain" })));
    write("edited.geojson", drawn);
    let again = "streets grow c.gpkg -e builtin:grid --changed --terrain edited.geojson";
    let report = run(&format!("{again} -o f.gpkg --json")).ends(0).json();
    assert_eq!(report["valid"], true, "{report}");
    assert!(report["on_land"]["steepest_grade"].as_f64().unwrap() <= 0.2);
    let lines = |city: &str| -> std::collections::BTreeSet<String> {
        run(&format!("export {city}.gpkg --layer streets -o {city}.geojson")).ends(0);
        let text = fs::read_to_string(folder.path().join(format!("{city}.geojson"))).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        let features = document["features"].as_array().unwrap().iter();
        features.map(|f| f["geometry"]["coordinates"].to_string()).collect()
    };
    let (before, after) = (lines("c"), lines("f"));
    let stayed = before.intersection(&after).count();
    assert!(stayed * 2 > before.len() && stayed < before.len(), "{stayed} of {}", before.len());
    let outcome =
        run("streets grow c.gpkg -e builtin:grid --changed --terrain sketch.geojson -o g.gpkg");
    assert!(outcome.ends(0).err.contains("the ground is as it was"));

    let path = serde_json::json!({
        "type": "Feature", "properties": { "highway": "primary" },
        "geometry": { "type": "LineString", "coordinates": [[10.004, 1.003], [10.0065, 1.0062]] },
    });
    write("fixed.geojson", vec![path]);
    write("scope.geojson", vec![square(0.0035, 0.0025, 0.004, none())]);
    let again = "streets grow c.gpkg -e builtin:saltlake --scope scope.geojson";
    let report = run(&format!("{again} --fixed fixed.geojson -o d.gpkg --json")).ends(0).json();
    assert_eq!(report["valid"], true, "{report}");
    assert!(report["streets"]["km_by_class"]["primary"].as_f64().unwrap() > 0.4, "{report}");

    write("wrong.geojson", vec![square(0.0, 0.0, 0.01, serde_json::json!({ "use": "lava" }))]);
    let wrong = "streets grow -e builtin:grid --target target.geojson --terrain wrong.geojson";
    let outcome = run(&format!("{wrong} -o e.gpkg"));
    assert!(outcome.ends(2).err.contains("`use` is `lava`"));
}

#[test]
fn a_drawn_fragment_chooses_from_a_library() {
    let folder = tempdir().unwrap();
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data");
    fs::create_dir(folder.path().join("maps")).unwrap();
    for name in ["helsinki.osm.pbf", "grid.osm.pbf", "suburb.osm.pbf"] {
        fs::copy(data.join(name), folder.path().join("maps").join(name)).unwrap();
    }
    fs::write(folder.path().join("maps/notes.txt"), "no map").unwrap();
    fs::write(folder.path().join("maps/broken.osm"), "<osm><node id=").unwrap();
    let line = |points: [[f64; 2]; 2]| {
        serde_json::json!({
            "type": "Feature", "properties": {},
            "geometry": { "type": "LineString", "coordinates": points },
        })
    };
    // Four streets each way, 100 m apart.
    let at = |k: i32| f64::from(k) * 0.0009;
    let features: Vec<Value> = (0..4)
        .flat_map(|k| [line([[at(k), 0.0], [at(k), at(3)]]), line([[0.0, at(k)], [at(3), at(k)]])])
        .collect();
    let document = serde_json::json!({ "type": "FeatureCollection", "features": features });
    fs::write(folder.path().join("like.geojson"), document.to_string()).unwrap();
    let run = |line: &str| exurb(folder.path(), &line.split(' ').collect::<Vec<_>>());
    let grow = "streets grow --example-library maps --size 800x800";
    let outcome = run(&format!("{grow} --like like.geojson -o c.gpkg --json")).ends(0);
    assert!(outcome.err.contains("like those of `grid`"), "{}", outcome.err);
    assert!(outcome.err.contains("broken.osm"), "{}", outcome.err);
    assert_eq!(outcome.json()["valid"], true);
    // The city remembers the example that was chosen, not the library.
    fs::copy(data.join("grid.osm.pbf"), folder.path().join("grid.osm.pbf")).unwrap();
    run("blocks parcels c.gpkg -o d.gpkg").ends(0);
    let error = run(&format!("{grow} -o e.gpkg")).ends(2);
    assert!(error.err.contains("nothing tells which example of the library fits"), "{}", error.err);
}
