//! Import: a map file to a valid street graph, against `osmium tags-filter` on the same file (PBF)
//! and OSMnx (XML).

#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use exurb_benches::{
    Better, bench_folder, heading, largest_maps, made_once, measure, note, osmium, python_says, row,
};

const WORK: &str = env!("CARGO_BIN_EXE_exurb_bench_work");

fn main() {
    heading("import");
    if let Some(maps) = largest_maps(6) {
        against_osmium("largest map", &maps[0]);
        against_osmium("six maps tiled", &tiled(&maps));
    }
    against_osmnx(&made_once("grid.osm", write_grid));
}

/// Six maps laid side by side until the file has about 20 MB.
fn tiled(maps: &[PathBuf]) -> PathBuf {
    made_once("tiles.osm.pbf", |path| {
        let mut arguments = vec![path.as_os_str(), "24".as_ref()];
        arguments.extend(maps.iter().map(|map| map.as_os_str()));
        // The script prints a sentence, not JSON; what counts is the file.
        python_says("tile.py", &arguments);
        assert!(path.exists(), "tile.py made no file");
    })
}

fn megabytes(path: &Path) -> f64 {
    fs::metadata(path).map_or(0.0, |file| file.len() as f64 / 1e6)
}

fn against_osmium(what: &str, map: &Path) {
    let filtered = bench_folder().join("filtered.osm.pbf");
    let ours = measure(5, &[WORK.as_ref(), "read".as_ref(), map.as_os_str()]);
    let osmium = osmium();
    let theirs = measure(
        5,
        &[
            osmium.as_os_str(),
            "tags-filter".as_ref(),
            map.as_os_str(),
            "w/highway".as_ref(),
            "--overwrite".as_ref(),
            "-o".as_ref(),
            filtered.as_os_str(),
        ],
    );
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        note(&format!("{what}: a program failed on {}", map.display()));
        return;
    };
    let size_mb = megabytes(map);
    let which = "osmium tags-filter w/highway";
    row(
        &format!("{what}, {size_mb:.1} MB PBF"),
        "s",
        ours.seconds,
        theirs.seconds,
        which,
        Better::Less,
    );
    let limit_mb = 200.0 + 6.0 * size_mb;
    row(
        &format!("{what}, peak memory"),
        "MB",
        ours.peak_mb,
        limit_mb,
        "200 MB + 6 x file",
        Better::Less,
    );
}

fn against_osmnx(map: &Path) {
    let ours = measure(3, &[WORK.as_ref(), "read".as_ref(), map.as_os_str()]);
    let theirs = python_says("osmnx_graph.py", &[map]);
    let theirs = theirs.and_then(|said| said["seconds"].as_f64());
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        note(&format!("a program failed on {}", map.display()));
        return;
    };
    let what = format!("grid town, {:.1} MB XML", megabytes(map));
    row(&what, "s", ours.seconds, theirs, "OSMnx graph_from_xml", Better::Less);
}

/// A town of 60 x 60 streets with 20,000 houses, about 10 MB of XML.
fn write_grid(path: &Path) {
    const STREETS: usize = 60;
    const HOUSES: usize = 20_000;
    let (mut nodes, mut ways) = (String::new(), String::new());
    let mut id = 0;
    let mut node = |x_m: f64, y_m: f64, nodes: &mut String| {
        id += 1;
        let (lon, lat) = (x_m / 111_320.0, y_m / 110_574.0);
        writeln!(nodes, "<node id=\"{id}\" lat=\"{lat:.7}\" lon=\"{lon:.7}\"/>").expect("a string");
        id
    };
    let mut corner = vec![[0; STREETS]; STREETS];
    for (i, column) in corner.iter_mut().enumerate() {
        for (j, corner) in column.iter_mut().enumerate() {
            *corner = node(i as f64 * 110.0, j as f64 * 90.0, &mut nodes);
        }
    }
    let mut way = 0;
    let mut write_way = |refs: &[usize], key: &str, value: &str| {
        way += 1;
        let refs: String = refs.iter().map(|r| format!("<nd ref=\"{r}\"/>")).collect();
        writeln!(ways, "<way id=\"{way}\">{refs}<tag k=\"{key}\" v=\"{value}\"/></way>")
            .expect("a string");
    };
    for i in 0..STREETS {
        for j in 0..STREETS {
            if i + 1 < STREETS {
                write_way(&[corner[i][j], corner[i + 1][j]], "highway", "residential");
            }
            if j + 1 < STREETS {
                write_way(&[corner[i][j], corner[i][j + 1]], "highway", "residential");
            }
        }
    }
    for house in 0..HOUSES {
        let (block, lot) = (house / 6, house % 6);
        let x = (block % 59) as f64 * 110.0 + 12.0 + (lot % 3) as f64 * 30.0;
        let y = (block / 59) as f64 * 90.0 + 12.0 + (lot / 3) as f64 * 45.0;
        let ring = [(0.0, 0.0), (14.0, 0.0), (14.0, 11.0), (0.0, 11.0)];
        let ring: Vec<usize> = ring.map(|(dx, dy)| node(x + dx, y + dy, &mut nodes)).to_vec();
        write_way(&[&ring[..], &ring[..1]].concat(), "building", "house");
    }
    let text = format!("<?xml version=\"1.0\"?>\n<osm version=\"0.6\">\n{nodes}{ways}</osm>\n");
    fs::write(path, text).expect("the bench folder can be written");
}
