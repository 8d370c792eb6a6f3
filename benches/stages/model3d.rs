//! A 3D model of 20,000 buildings as GLB, against `ilu` on the same Overpass JSON.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::fs;
use std::path::Path;

use exurb_benches::{Better, bench_folder, heading, made_once, measure, note, row};
use serde_json::{Value, json};

fn main() {
    heading("GLB of 20,000 buildings");
    let map = made_once("buildings.json", write_town);
    let program = |key| std::env::var(key).expect("`cargo xtask bench` names the programs");
    let (ours_glb, theirs_glb) = (bench_folder().join("exurb.glb"), bench_folder().join("ilu.glb"));
    let exurb = program("EXURB_BIN");
    let ours = measure(
        3,
        &[exurb.as_ref(), "export".as_ref(), map.as_os_str(), "-o".as_ref(), ours_glb.as_os_str()],
    );
    let ilu = Path::new(&program("EXURB_PYTHON")).with_file_name("ilu");
    let plain = ["--style", "plain", "--no-trees"].map(AsRef::as_ref);
    let command = [
        &[ilu.as_os_str(), "build".as_ref(), "--osm".as_ref(), map.as_os_str()][..],
        &["-o".as_ref(), theirs_glb.as_os_str()],
        &plain,
    ];
    let theirs = measure(1, &command.concat());
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        note("a program failed");
        return;
    };
    row("time", "s", ours.seconds, theirs.seconds, "ilu build", Better::Less);
    row("peak memory", "MB", ours.peak_mb, theirs.peak_mb, "ilu build", Better::Less);
    row("peak memory", "MB", ours.peak_mb, 300.0, "300 MB", Better::Less);
    let size = |path| fs::metadata(path).map_or(f64::NAN, |file| file.len() as f64 / 1e6);
    row("file", "MB", size(&ours_glb), size(&theirs_glb), "ilu build", Better::Less);
}

/// Overpass JSON with geometry inline, as both programs read it: 20,000 houses on a street grid.
fn write_town(path: &Path) {
    const BLOCKS: usize = 58;
    let mut elements: Vec<Value> = Vec::new();
    let (mut way, mut next_node) = (0_u64, 0_u64);
    let mut add = |points: &[(f64, f64)], tags: Value| {
        way += 1;
        let closed = points.first() == points.last();
        let first = next_node + 1;
        let nodes: Vec<u64> = (0..points.len() as u64)
            .map(|i| if closed && i + 1 == points.len() as u64 { first } else { first + i })
            .collect();
        next_node += points.len() as u64;
        let place =
            |&(x, y): &(f64, f64)| json!({"lat": 1.0 + y / 110_574.0, "lon": x / 111_320.0});
        let geometry: Vec<Value> = points.iter().map(place).collect();
        elements.push(json!({"type": "way", "id": way, "nodes": nodes,
                             "geometry": geometry, "tags": tags}));
    };
    let far = BLOCKS as f64;
    for i in 0..=BLOCKS {
        let at = i as f64;
        let street = || json!({"highway": "residential"});
        add(&[(at * 110.0, 0.0), (at * 110.0, far * 90.0)], street());
        add(&[(0.0, at * 90.0), (far * 110.0, at * 90.0)], street());
    }
    for house in 0..20_000 {
        let (block, lot) = (house / 6, house % 6);
        let x = (block % BLOCKS) as f64 * 110.0 + 12.0 + (lot % 3) as f64 * 30.0;
        let y = (block / BLOCKS) as f64 * 90.0 + 12.0 + (lot / 3) as f64 * 40.0;
        let ring = [(x, y), (x + 14.0, y), (x + 14.0, y + 11.0), (x, y + 11.0), (x, y)];
        let levels = 1 + house % 4;
        let roof = ["flat", "gabled", "hipped"][house % 3];
        let tags = json!({"building": "house", "building:levels": levels.to_string(),
                          "roof:shape": roof});
        add(&ring, tags);
    }
    let document = json!({"version": 0.6, "elements": elements});
    fs::write(path, document.to_string()).expect("the bench folder can be written");
}
