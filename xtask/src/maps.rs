//! `maps`: grows a city from every shared map and writes the table `docs/maps.md`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::shell::{self, Outcome, cargo, output_of, root, target};

const HEADER: &str = "\
# Every shared map as an example

`cargo xtask maps` grows 2 km x 2 km from each map (`exurb streets grow --example MAP --size 2000x2000`,
seed 1) and writes this page. *Laws*: all hold (`valid`). *Gates*: likeness gates that the city passes
against its example. *Same*: the files of a second run and of a run on one thread are identical, byte for
byte, and seed 2 gives another file. *Copied*: share of street length laid by patches, by default and with
`--continuation 1`. Time is learning and growing together, one thread, as the program reports it.

| map | km | example km/km² | laws | gates | same | copied | copied, continuation 1 | s | km/s |
|---|---|---|---|---|---|---|---|---|---|
";

/// Writes the table; an error when a map's city breaks a law or is not reproducible.
pub fn run() -> Outcome {
    let data = root().join("../shared/data/osm");
    let Ok(folder) = std::fs::read_dir(&data) else {
        println!("skipped: no shared data");
        return Ok(());
    };
    shell::run(&mut cargo("build --release --locked --package exurb_cli"))?;
    let mut maps: Vec<PathBuf> = folder.flatten().map(|entry| entry.path()).collect();
    maps.sort();
    let mut page = HEADER.to_owned();
    let (mut lawful, mut alike, mut broken) = (0, 0, Vec::new());
    for map in &maps {
        let row = row(map)?;
        println!("{}", row.line.trim_end());
        page.push_str(&row.line);
        lawful += usize::from(row.lawful);
        alike += usize::from(row.alike);
        if !row.lawful || !row.same {
            broken.push(row.name);
        }
    }
    let _ = writeln!(
        page,
        "\nOf {} maps {lawful} give a city that keeps all laws, {alike} one that passes all gates.",
        maps.len()
    );
    std::fs::write(root().join("docs/maps.md"), page).map_err(|e| e.to_string())?;
    if broken.is_empty() { Ok(()) } else { Err(format!("broken: {}", broken.join(", "))) }
}

struct Row {
    name: String,
    line: String,
    lawful: bool,
    alike: bool,
    same: bool,
}

fn row(map: &Path) -> Outcome<Row> {
    let file = map.file_name().unwrap_or_default().to_string_lossy();
    let name = file.split('.').next().unwrap_or_default().to_owned();
    let (one, json) = grow(map, &["--threads", "1"])?;
    let (two, _) = grow(map, &["--threads", "2"])?;
    let (again, _) = grow(map, &["--threads", "2"])?;
    let (other, _) = grow(map, &["--seed", "2"])?;
    let same = one == two && two == again && two != other;
    let (_, followed) = grow(map, &["--continuation", "1"])?;
    let number = |json: &Value, path: &str| json.pointer(path).and_then(Value::as_f64);
    let number_or_0 = |path| number(&json, path).unwrap_or_default();
    let lawful = json["valid"] == Value::Bool(true);
    let gates = json["likeness_gates"].as_object();
    let passes: Vec<bool> =
        gates.into_iter().flatten().map(|(_, g)| g["pass"] != Value::Bool(false)).collect();
    let passed = passes.iter().filter(|p| **p).count();
    let km = number_or_0("/streets/km");
    let seconds = number_or_0("/seconds/learn") + number_or_0("/seconds/synthesise");
    let source = info(map)?;
    let density = number(&source, "/streets/km").unwrap_or_default()
        / number(&source, "/area_km2").unwrap_or(1.0);
    let line = format!(
        "| {name} | {km:.1} | {density:.1} | {} | {passed} of {} | {} | {:.2} | {:.2} | {seconds:.2} | {:.0} |\n",
        if lawful { "yes" } else { "**no**" },
        passes.len(),
        if same { "yes" } else { "**no**" },
        number_or_0("/provenance/example_share"),
        number(&followed, "/provenance/example_share").unwrap_or_default(),
        km / seconds,
    );
    Ok(Row { name, line, lawful, alike: passed == passes.len(), same })
}

fn exurb() -> Command {
    Command::new(target().join("release/exurb"))
}

/// The city file and the report of one growth.
fn grow(map: &Path, options: &[&str]) -> Outcome<(Vec<u8>, Value)> {
    let out = target().join("maps.gpkg");
    let mut command = exurb();
    command.args(["streets", "grow", "--size", "2000x2000", "--json", "--quiet", "--example"]);
    command.arg(map).args(options).arg("-o").arg(&out);
    let json = output_of(&mut command).map_err(|e| format!("{}: {e}", map.display()))?;
    let file = std::fs::read(&out).map_err(|e| e.to_string())?;
    Ok((file, serde_json::from_str(&json).map_err(|e| e.to_string())?))
}

fn info(map: &Path) -> Outcome<Value> {
    let json = output_of(exurb().arg("info").arg(map).args(["--json", "--quiet"]))?;
    serde_json::from_str(&json).map_err(|e| e.to_string())
}
