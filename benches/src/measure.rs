//! Running a process and reading what it took.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::root;

/// What a process took.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    /// By the clock; the best of the runs.
    pub seconds: f64,
    /// The most of the runs, in MB.
    pub peak_mb: f64,
}

/// Measures `runs` runs of a command; `None` when one fails.
pub fn measure<S: AsRef<OsStr>>(runs: usize, command: &[S]) -> Option<Measured> {
    let mut all = Measured { seconds: f64::INFINITY, peak_mb: 0.0 };
    for _ in 0..runs {
        let mut measured = Command::new(from_environment("EXURB_PYTHON"));
        measured.arg(script("measure.py")).args(command).env("RAYON_NUM_THREADS", "2");
        let said = says(&mut measured)?;
        if said["status"] != 0 {
            return None;
        }
        all.seconds = all.seconds.min(said["seconds"].as_f64()?);
        all.peak_mb = all.peak_mb.max(said["peak_mb"].as_f64()?);
    }
    Some(all)
}

/// What a script of `scripts/` prints as JSON.
pub fn python_says<S: AsRef<OsStr>>(name: &str, arguments: &[S]) -> Option<Value> {
    says(Command::new(from_environment("EXURB_PYTHON")).arg(script(name)).args(arguments))
}

/// What our own work (`src/work.rs`) prints as JSON, on so many threads.
pub fn work_says<S: AsRef<OsStr>>(work: &str, threads: u32, arguments: &[S]) -> Option<Value> {
    let mut command = Command::new(work);
    says(command.env("RAYON_NUM_THREADS", threads.to_string()).args(arguments))
}

/// The last line of a command's output, as JSON.
fn says(command: &mut Command) -> Option<Value> {
    let command = command.stdin(Stdio::null()).stderr(Stdio::null());
    let output = command.output().ok().filter(|output| output.status.success())?;
    serde_json::from_str(String::from_utf8_lossy(&output.stdout).lines().last()?).ok()
}

fn script(name: &str) -> PathBuf {
    root().join("benches/scripts").join(name)
}

/// The `osmium` tool.
pub fn osmium() -> PathBuf {
    from_environment("EXURB_OSMIUM")
}

/// A program of `benches/peers`.
pub fn peer(name: &str) -> PathBuf {
    from_environment("EXURB_PEERS").join(name)
}

fn from_environment(key: &str) -> PathBuf {
    let value = std::env::var_os(key);
    Path::new(&value.expect("`cargo xtask bench` names the yardsticks")).to_owned()
}
