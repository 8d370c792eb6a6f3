//! `fuzz [TARGET] [SECONDS]`: libFuzzer on one target or all, one after the other.
//!
//! The targets live in `fuzz/`, a workspace of its own. libFuzzer needs unstable compiler flags:
//! `RUSTC_BOOTSTRAP=1` opens them on the stable compiler. The corpus in the repository is only read;
//! what a run finds goes to `target/fuzz`.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::shell::{self, Outcome, root, target};

const SECONDS: u32 = 60;

/// Coverage counters that libFuzzer reads.
const FLAGS: &str = "--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
                     -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
                     -Cllvm-args=-sanitizer-coverage-pc-table \
                     -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 \
                     -Cdebug-assertions=on -Coverflow-checks=on";

/// Runs `[TARGET] [SECONDS]`.
pub fn run(args: &[&str]) -> Outcome {
    let known = targets()?;
    let (chosen, seconds) = match *args {
        [] => (known, SECONDS),
        [target] => (only(known, target)?, SECONDS),
        [target, seconds] => {
            (only(known, target)?, seconds.parse().map_err(|_| "SECONDS is no number")?)
        }
        _ => return Err("usage: cargo xtask fuzz [TARGET|all] [SECONDS]".into()),
    };
    let found: Vec<String> = chosen.iter().filter_map(|name| fuzz(name, seconds).err()).collect();
    if found.is_empty() { Ok(()) } else { Err(found.join("\n")) }
}

fn only(known: Vec<String>, target: &str) -> Outcome<Vec<String>> {
    if target == "all" {
        return Ok(known);
    }
    if known.iter().any(|name| name == target) {
        return Ok(vec![target.to_owned()]);
    }
    Err(format!("there is no fuzz target `{target}`; there are {}", known.join(", ")))
}

/// A file of `fuzz/fuzz_targets` each.
fn targets() -> Outcome<Vec<String>> {
    let folder = root().join("fuzz/fuzz_targets");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let names = entries.filter_map(Result::ok).filter_map(|entry| {
        let path = entry.path();
        Some(path.file_stem()?.to_str()?.to_owned())
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    Ok(names)
}

fn fuzz(name: &str, seconds: u32) -> Outcome {
    let built = target().join("fuzz");
    let triple = host()?;
    // The versions of the workspace; libFuzzer's own crate is added to them.
    fs::copy(root().join("Cargo.lock"), root().join("fuzz/Cargo.lock"))
        .map_err(|e| e.to_string())?;
    let mut build = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    build.current_dir(root().join("fuzz")).env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", FLAGS);
    build.args(["build", "--release", "--bin", name, "--target", &triple]);
    shell::run(build.arg("--target-dir").arg(&built))?;

    let found = built.join("corpus").join(name);
    let crashes = built.join("crashes").join(name);
    for folder in [&found, &crashes] {
        fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    let mut fuzzer = Command::new("nice");
    fuzzer.arg(built.join(triple).join("release").join(name));
    fuzzer.arg(&found).arg(root().join("fuzz/corpus").join(name));
    fuzzer.args([format!("-max_total_time={seconds}"), "-rss_limit_mb=2048".into()]);
    fuzzer.args(["-timeout=30", "-max_len=65536", "-print_final_stats=1", "-verbosity=0"]);
    fuzzer.arg(format!("-artifact_prefix={}/", Path::new(&crashes).display()));
    shell::run(&mut fuzzer).map_err(|e| format!("{e}: see {}", crashes.display()))
}

/// The machine's target triple.
fn host() -> Outcome<String> {
    let text = shell::output_of(Command::new("rustc").arg("-vV"))?;
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc does not name its host".into())
}
