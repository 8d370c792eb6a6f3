//! Growth as in table 2 of Nishida et al. 2015: each length with that row's operation, learning and
//! synthesising on one thread, against the paper's time; and 14 km x 14 km on two threads.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::process::Command;

use exurb_benches::{Better, bench_folder, heading, note, root, row, shared_maps};
use serde_json::Value;

/// The row's name, the paper's kilometres and seconds, and the arguments of `streets grow`: `{osm}`
/// is the folder of the shared maps, `{streets}` that of the gallery's drawings, `{out}` a folder.
struct Row {
    what: &'static str,
    km: f64,
    seconds: f64,
    arguments: &'static str,
}

const ROWS: [Row; 10] = [
    Row {
        what: "one start (figure 10 a)",
        km: 35.0,
        seconds: 1.0,
        arguments: "--example {osm}/paris_center.osm.pbf --size 1380x1380 --continuation 1",
    },
    Row {
        what: "three starts (figure 10 b)",
        km: 150.0,
        seconds: 7.0,
        arguments: "--example {osm}/paris_center.osm.pbf --size 2850x2850 --continuation 1 --starts 3",
    },
    Row {
        what: "two styles (figure 1)",
        km: 278.0,
        seconds: 49.0,
        arguments: "--example {osm}/madrid_center.osm.pbf --example {osm}/san_francisco.osm.pbf \
                    --size 3600x3600 --starts 2 --blend 0.2",
    },
    Row {
        what: "blend (figure 11 e)",
        km: 195.0,
        seconds: 28.0,
        arguments: "--example {osm}/canberra.osm.pbf --example {osm}/tokyo_ichigaya.osm.pbf \
                    --size 4600x2600 --starts 2 --blend 0.1",
    },
    Row {
        what: "blend (figure 11 f)",
        km: 228.0,
        seconds: 40.0,
        arguments: "--example {osm}/canberra.osm.pbf --example {osm}/tokyo_ichigaya.osm.pbf \
                    --size 4900x2800 --starts 2 --blend 0.25",
    },
    Row {
        what: "blend (figure 11 g)",
        km: 314.0,
        seconds: 128.0,
        arguments: "--example {osm}/canberra.osm.pbf --example {osm}/tokyo_ichigaya.osm.pbf \
                    --size 5700x3300 --starts 2 --blend 0.6",
    },
    Row {
        what: "warp (figure 12)",
        km: 210.0,
        seconds: 83.0,
        arguments: "--example {osm}/paris_center.osm.pbf --target {streets}/tall.geojson \
                    --guide 9.9916149,49.9829183=2.3415,48.840 \
                    --guide 10.0069876,49.9919087=2.3415,48.848 \
                    --guide 9.9930124,50=2.3415,48.856 \
                    --guide 10.0069876,50.0080913=2.3415,48.864 \
                    --guide 9.9958074,50.0170817=2.3415,48.872",
    },
    Row {
        what: "terrain of a sketch (figure 13 c)",
        km: 330.0,
        seconds: 90.0,
        arguments: "--target {streets}/sketch_target.geojson --terrain {streets}/sketch.geojson \
                    --areas {streets}/domains.geojson \
                    --example {osm}/barcelona_eixample_santmarti.osm.pbf \
                    --example {osm}/canberra.osm.pbf --example {osm}/helsinki_center.osm.pbf \
                    --example {osm}/paris_center.osm.pbf --example {osm}/quito.osm.pbf",
    },
    Row {
        what: "terrain edited (figure 13 f)",
        km: 337.0,
        seconds: 131.0,
        arguments: "--target {streets}/sketch_target.geojson \
                    --terrain {streets}/sketch_edited.geojson \
                    --areas {streets}/domains_edited.geojson \
                    --example {osm}/barcelona_eixample_santmarti.osm.pbf \
                    --example {osm}/canberra.osm.pbf --example {osm}/helsinki_center.osm.pbf \
                    --example {osm}/paris_center.osm.pbf --example {osm}/quito.osm.pbf",
    },
    Row {
        what: "redevelopment (figure 14), the whole network",
        km: 342.0,
        seconds: 130.0,
        arguments: "{osm}/salt_lake_city.osm.pbf --scope {streets}/salt_area.geojson \
                    --example {osm}/canberra.osm.pbf --example {osm}/tel_aviv.osm.pbf",
    },
];

fn main() {
    heading("growth as in the paper's table 2 (learn and synthesise, one thread)");
    if shared_maps().is_empty() {
        note("skipped: no shared data");
        return;
    }
    for Row { what, km, seconds, arguments } in &ROWS {
        match grown(arguments, "1") {
            Some((ours_km, ours)) => {
                let what = format!("{what}: {ours_km:.0} km in {ours:.2} s");
                let paper = format!("paper: {km} km in {seconds} s");
                row(&what, "km/s", ours_km / ours, km / seconds, &paper, Better::More);
            }
            None => note(&format!("{what}: failed")),
        }
    }
    let large = "--example {osm}/san_francisco.osm.pbf --size 14000x14000 --starts 9";
    if let Some((km, seconds)) = grown(large, "2") {
        let what = format!("14 km x 14 km, {km:.0} km, two threads");
        row(&what, "s", seconds, 4.0, "4 s", Better::Less);
    }
}

/// Kilometres of the network and seconds of learning and synthesising.
fn grown(arguments: &str, threads: &str) -> Option<(f64, f64)> {
    let exurb = std::env::var("EXURB_BIN").expect("`cargo xtask bench` names the program");
    let osm = root().join("../shared/data/osm");
    let streets = root().join("docs/gallery/streets");
    let filled = |word: &str| {
        word.replace("{osm}", &osm.display().to_string())
            .replace("{streets}", &streets.display().to_string())
    };
    let out = bench_folder().join("table.gpkg");
    let mut command = Command::new(exurb);
    command.args(["streets", "grow"]).args(arguments.split_whitespace().map(filled));
    command.args(["--json", "--quiet", "--threads", threads, "-o"]).arg(&out);
    let said: Value = serde_json::from_slice(&command.output().ok()?.stdout).ok()?;
    let seconds = &said["seconds"];
    let seconds = seconds["learn"].as_f64()? + seconds["synthesise"].as_f64()?;
    Some((said["streets"]["km"].as_f64()?, seconds))
}
