//! `bench`: measures against named yardsticks. Nothing here can fail on a time.

use std::fs;
use std::process::Command;

use crate::shell::{self, Outcome, cargo, root, target};
use crate::tools;

/// Runs one stage, or all.
pub fn run(stage: Option<&str>) -> Outcome {
    let known = stages()?;
    let chosen: Vec<&String> =
        known.iter().filter(|name| stage.is_none_or(|stage| stage == **name)).collect();
    if chosen.is_empty() {
        return Err(format!("there is no such bench; there are {}", known.join(", ")));
    }
    let peers = build_peers()?;
    let python = tools::python("bench", &root().join("benches/requirements.txt"))?;
    let osmium = tools::debian("osmium", "osmium-tool")?;
    shell::run(&mut cargo("build --release --bin exurb"))?;
    for name in chosen {
        let mut bench = cargo("bench --package exurb_benches --bench");
        bench.arg(name).env("EXURB_BIN", target().join("release/exurb"));
        bench.env("EXURB_PYTHON", &python).env("EXURB_OSMIUM", &osmium).env("EXURB_PEERS", &peers);
        shell::run(&mut bench)?;
    }
    Ok(())
}

/// A file of `benches/stages` each.
fn stages() -> Outcome<Vec<String>> {
    let folder = root().join("benches/stages");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut names: Vec<String> = entries
        .filter_map(Result::ok)
        .filter_map(|entry| Some(entry.path().file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    Ok(names)
}

/// Builds the programs of `benches/peers`, a workspace of its own: what we measure against never
/// enters our lock file.
fn build_peers() -> Outcome<std::path::PathBuf> {
    let folder = target().join("peers");
    let mut build = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    build.current_dir(root().join("benches/peers")).args(["build", "--release", "--locked"]);
    shell::run(build.arg("--target-dir").arg(&folder))?;
    Ok(folder.join("release"))
}
