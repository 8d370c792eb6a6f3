//! Blocks: re-targeting, queries, filling, parcels, and their parts, against the papers' times, numpy
//! versions of the parts, and momepy's tessellation.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::path::{Path, PathBuf};

use exurb_benches::{
    Better, bench_folder, heading, measure, note, python_says, root, row, shared_maps, work_says,
};
use serde_json::Value;

const WORK: &str = env!("CARGO_BIN_EXE_exurb_bench_work");
/// A result of Hartmann et al. 2015, at most, in seconds.
const PAPER_RETARGET: f64 = 0.15;
/// What this project wants of a query and of filling, in seconds; no published figure is known.
const AIM_QUERY: f64 = 0.005;
const AIM_FILL: f64 = 5.0;

fn main() {
    heading("blocks");
    parts();
    let maps = shared_maps();
    let named = |name: &str| {
        let file = format!("{name}.osm.pbf");
        maps.iter().find(|m| m.file_name().is_some_and(|n| *n == *file)).cloned()
    };
    if let Some(map) = named("karlsruhe_kirchfeld") {
        retarget(&map);
    }
    query(&maps);
    for (city, example) in [("bucaramanga", "garmisch"), ("porto_alegre", "porto_east")] {
        if let (Some(city), Some(example)) = (named(city), named(example)) {
            fill(&city, &example);
        }
    }
    if let Some(map) = named("monaco_menton_east") {
        cadastre(&map);
    }
}

fn seconds(said: &Value, key: &str) -> f64 {
    said[key].as_f64().unwrap_or(f64::NAN)
}

fn parts() {
    let file = bench_folder().join("outlines.json");
    let ours = work_says(WORK, 1, &["outlines".as_ref(), file.as_os_str()]);
    let theirs = python_says("outlines.py", &[&file]);
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        return note("outlines: a program failed");
    };
    for (what, key) in [
        ("shape contexts and costs, 10 pairs", "contexts"),
        ("cyclic time warps, 10 pairs of 100", "warps"),
        ("mean value map, 10,000 points, 24 corners", "mean_value"),
    ] {
        let (us, them) = (seconds(&ours, key) * 1e3, seconds(&theirs, key) * 1e3);
        row(what, "ms", us, them, "numpy", Better::Less);
    }
}

fn retarget(map: &Path) {
    let Some(said) = work_says(WORK, 1, &["retarget".as_ref(), map.as_os_str()]) else {
        return note("retarget: the program failed");
    };
    let what = format!("re-target a block of {} footprints", said["footprints"]);
    let ms = seconds(&said, "seconds") * 1e3;
    row(&what, "ms", ms, PAPER_RETARGET * 1e3, "Hartmann 2015, at most", Better::Less);
}

fn query(maps: &[PathBuf]) {
    let mut arguments: Vec<&std::ffi::OsStr> = vec!["query".as_ref()];
    arguments.extend(maps.iter().map(|m| m.as_os_str()));
    if maps.is_empty() {
        return;
    }
    let Some(said) = work_says(WORK, 1, &arguments) else {
        return note("query: the program failed");
    };
    let what = format!("query against {} blocks", said["blocks"]);
    row(&what, "ms", seconds(&said, "seconds") * 1e3, AIM_QUERY * 1e3, "aim", Better::Less);
}

/// A whole process on two cores, from reading to the written file.
fn fill(city: &Path, example: &Path) {
    let exurb = std::env::var_os("EXURB_BIN").unwrap_or_default();
    let out = bench_folder().join("filled.gpkg");
    let words: [&std::ffi::OsStr; 9] = [
        &exurb,
        "blocks".as_ref(),
        "transfer".as_ref(),
        city.as_os_str(),
        "--example".as_ref(),
        example.as_os_str(),
        "-o".as_ref(),
        out.as_os_str(),
        "--quiet".as_ref(),
    ];
    let Some(measured) = measure(3, &words) else { return note("fill: the program failed") };
    let Some((blocks, footprints)) = filled(&out) else { return note("fill: nothing was written") };
    let stem = |p: &Path| p.file_name().map(|n| n.to_string_lossy().replace(".osm.pbf", ""));
    let what = format!(
        "fill {} from {}, for each 1,000 blocks, 2 cores",
        stem(city).unwrap_or_default(),
        stem(example).unwrap_or_default(),
    );
    let thousands = blocks as f64 / 1000.0;
    row(&what, "s", measured.seconds / thousands, AIM_FILL, "aim", Better::Less);
    note(&format!(
        "{blocks} blocks, {footprints} footprints, {:.1} s in all, at most {:.0} MB",
        measured.seconds, measured.peak_mb
    ));
}

/// Blocks that are no islands, and footprints in them.
fn filled(city: &Path) -> Option<(usize, usize)> {
    let city = exurb_recipe::open_city(city, &exurb_city::ImportOptions::default()).ok()?.city;
    let blocks = city.blocks.iter().filter(|b| b.class == exurb_city::BlockClass::Block).count();
    let footprints = city.buildings.iter().filter(|b| !b.is_part && b.block != 0).count();
    Some((blocks, footprints))
}

fn cadastre(map: &Path) {
    let file = bench_folder().join("footprints.json");
    let words: [&std::ffi::OsStr; 4] =
        [WORK.as_ref(), "cadastre".as_ref(), map.as_os_str(), file.as_os_str()];
    let Some(ours) = work_says(WORK, 1, &words[1..]) else {
        return note("cadastre: the program failed");
    };
    let whole = measure(1, &words);
    let python = std::env::var_os("EXURB_PYTHON").unwrap_or_default();
    let script = root().join("benches/scripts/tessellation.py");
    let peak = measure(1, &[&python, script.as_os_str(), file.as_os_str()]);
    let Some(theirs) = python_says("tessellation.py", &[&file]) else {
        return note("cadastre: momepy failed");
    };
    let what = format!("parcels around {} footprints", ours["footprints"]);
    let which = "momepy enclosed_tessellation";
    row(&what, "s", seconds(&ours, "seconds"), seconds(&theirs, "seconds"), which, Better::Less);
    if let (Some(us), Some(them)) = (whole, peak) {
        row("the same, memory of the process", "MB", us.peak_mb, them.peak_mb, which, Better::Less);
    }
}
