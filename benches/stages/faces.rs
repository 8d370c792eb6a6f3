//! Faces of a network, against shapely's `polygonize` on the same noded lines.

#![allow(clippy::print_stdout, reason = "a program that reports")]

use exurb_benches::{
    Better, bench_folder, heading, note, python_says, row, shared_maps, work_says,
};

const WORK: &str = env!("CARGO_BIN_EXE_exurb_bench_work");

fn main() {
    heading("faces of the street graph");
    let mut maps: Vec<_> = shared_maps().into_iter().take(3).collect();
    maps.extend(Some(bench_folder().join("tiles.osm.pbf")).filter(|tiles| tiles.exists()));
    for map in maps {
        let name = map.file_name().unwrap_or_default().display().to_string();
        let lines = bench_folder().join("lines.txt");
        let ours = work_says(WORK, 1, &["faces".as_ref(), map.as_os_str(), lines.as_os_str()]);
        let theirs = python_says("polygonize.py", &[&lines]);
        let (Some(ours), Some(theirs)) = (ours, theirs) else {
            note(&format!("{name}: a program failed"));
            continue;
        };
        let seconds = |said: &serde_json::Value| said["seconds"].as_f64().unwrap_or(f64::NAN);
        let what = format!("{name}, {} edges", ours["edges"]);
        row(&what, "s", seconds(&ours), seconds(&theirs), "shapely polygonize", Better::Less);
        note(&format!("{} faces here, {} polygons there", ours["faces"], theirs["faces"]));
    }
}
