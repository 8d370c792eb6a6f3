//! Growth: learning and synthesising streets on one thread, against the paper's program,
//! netgenerate and symbios-tensor.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::path::PathBuf;
use std::process::{Command, Stdio};

use exurb_benches::{Better, heading, note, peer, python_says, root, row, shared_maps, work_says};
use serde_json::Value;

const WORK: &str = env!("CARGO_BIN_EXE_exurb_bench_work");
/// Nishida et al. 2015, section 6: 278 km of streets in 49 s on one Core i7.
const PAPER_KM_PER_S: f64 = 278.0 / 49.0;

fn main() {
    heading("growth (learn and synthesise, one thread)");
    let example = example();
    note(&format!("example: {}", example.file_name().unwrap_or_default().display()));
    let peers = [
        ("paper: 278 km in 49 s", Some(PAPER_KM_PER_S)),
        ("netgenerate --rand, 982 km", rate(python_says("netgenerate.py", &["5000"]))),
        ("symbios-tensor, flat 2 km x 2 km", rate(symbios())),
    ];
    for km in [10.0, 100.0, 1000.0, 10_000.0] {
        let Some((km, seconds)) = grown(&example, km) else {
            note(&format!("growing about {km} km failed"));
            continue;
        };
        for (which, theirs) in &peers {
            let what = format!("{km:.0} km in {seconds:.3} s");
            match theirs {
                Some(theirs) => row(&what, "km/s", km / seconds, *theirs, which, Better::More),
                None => note(&format!("{which}: failed")),
            }
        }
    }
}

/// A complete North American grid of 35 km2 where the real maps are there, else a built-in one.
fn example() -> PathBuf {
    let portland = |map: &PathBuf| map.ends_with("portland_central.osm.pbf");
    shared_maps().into_iter().find(portland).unwrap_or_else(|| root().join("data/grid.osm.pbf"))
}

/// Kilometres and seconds of a square chosen to hold about so many kilometres: a first square tells
/// how dense the streets of this example come out.
fn grown(example: &std::path::Path, km: f64) -> Option<(f64, f64)> {
    let grow = |side_m: f64| {
        let side = side_m.round().to_string();
        let said = work_says(WORK, 1, &["grow".as_ref(), example.as_os_str(), side.as_ref()])?;
        let seconds = said["learn"].as_f64()? + said["synthesise"].as_f64()?;
        Some((said["km"].as_f64()?, seconds))
    };
    let (probe_km, _) = grow(2000.0)?;
    grow(2000.0 * (km / probe_km).sqrt())
}

fn rate(said: Option<Value>) -> Option<f64> {
    let said = said?;
    Some(said["km"].as_f64()? / said["seconds"].as_f64()?)
}

fn symbios() -> Option<Value> {
    let output = Command::new(peer("symbios")).stdin(Stdio::null()).stderr(Stdio::null()).output();
    serde_json::from_slice(&output.ok()?.stdout).ok()
}
