//! Likeness: the measures of streets and blocks against momepy, OSMnx and networkx on the same
//! streets, and two cities of 25 km² compared, against the time and memory it should take.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::path::{Path, PathBuf};

use exurb_benches::{
    Better, bench_folder, heading, measure, note, python_says, row, shared_maps, work_says,
};
use serde_json::Value;

const WORK: &str = env!("CARGO_BIN_EXE_exurb_bench_work");
/// What two cities may take: seconds without and with the discriminator, megabytes.
const PLAIN_S: f64 = 2.0;
const WHOLE_S: f64 = 10.0;
const PEAK_MB: f64 = 500.0;

fn main() {
    heading("likeness (densest 5 km squares)");
    let maps = shared_maps();
    let map = |name: &str| maps.iter().find(|m| m.ends_with(format!("{name}.osm.pbf"))).cloned();
    for name in ["liege", "bucaramanga"] {
        if let Some(map) = map(name) {
            measures(name, &map);
        }
    }
    // A dense one and one of usual density.
    if let (Some(one), Some(other)) = (map("aleppo"), map("bucaramanga")) {
        compared(&one, &other);
    }
}

/// All measures on one thread, against those that the others have.
fn measures(name: &str, map: &Path) {
    let streets = bench_folder().join("streets.json");
    let ours = work_says(WORK, 1, &["measures".as_ref(), map.as_os_str(), streets.as_os_str()]);
    let theirs = python_says("measures.py", &[&streets]);
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        return note(&format!("{name}: a program failed"));
    };
    let what = format!("{name}, {} streets, one thread", ours["edges"]);
    let which = "momepy + OSMnx + networkx";
    row(&what, "s", seconds(&ours, "seconds"), seconds(&theirs, "seconds"), which, Better::Less);
    let parts = theirs["parts"].as_object().into_iter().flatten();
    let parts: Vec<String> = parts.map(|(name, s)| format!("{name} {s}")).collect();
    note(&format!("there, of them: {} s", parts.join(", ")));
}

fn compared(one: &Path, other: &Path) {
    let said = work_says(WORK, 2, &["likeness".as_ref(), one.as_os_str(), other.as_os_str()]);
    let Some(said) = said else { return note("a comparison failed") };
    let what = "two cities of 25 km2, two threads";
    row(what, "s", seconds(&said, "plain"), PLAIN_S, "wanted, no discriminator", Better::Less);
    row(what, "s", seconds(&said, "whole"), WHOLE_S, "wanted, all", Better::Less);
    let exurb = PathBuf::from(std::env::var_os("EXURB_BIN").unwrap_or_default());
    let command = [exurb.as_os_str(), "compare".as_ref(), one.as_os_str(), "--with".as_ref()];
    let command =
        [&command[..], &[other.as_os_str(), "--held-out".as_ref(), other.as_os_str()]].concat();
    match measure(1, &command) {
        Some(took) => {
            let what = "exurb compare --held-out, maps read";
            row(what, "s", took.seconds, WHOLE_S, "wanted, all", Better::Less);
            row(what, "MB", took.peak_mb, PEAK_MB, "wanted", Better::Less);
        }
        None => note("exurb compare failed"),
    }
}

fn seconds(said: &Value, key: &str) -> f64 {
    said[key].as_f64().unwrap_or(f64::NAN)
}
