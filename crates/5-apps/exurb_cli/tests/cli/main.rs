//! The `exurb` command as its users see it: what it prints, what it writes, how it ends.
#![allow(clippy::unwrap_used, reason = "these are tests")]

mod compare;
mod demo;
mod files;
mod recipes;
mod synthesis;
mod terrain;
mod usage;

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// What a run of the program gave.
struct Ran {
    status: i32,
    out: String,
    err: String,
}

impl Ran {
    /// Asserts the exit status.
    #[track_caller]
    fn ends(self, status: i32) -> Self {
        assert_eq!(self.status, status, "standard error: {}", self.err);
        self
    }

    /// Asserts that an error holds these words and is one line.
    #[track_caller]
    fn says(self, words: &str) -> Self {
        assert!(self.err.contains(words), "`{words}` is not in: {}", self.err);
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}: {}", self.out))
    }
}

/// Runs the program in `folder`.
fn exurb(folder: &Path, args: &[&str]) -> Ran {
    let program = env!("CARGO_BIN_EXE_exurb");
    let Output { status, stdout, stderr } =
        Command::new(program).args(args).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran { status: status.code().unwrap_or(-1), out: text(stdout), err: text(stderr) }
}

/// A small city of 600 m x 600 m in `folder`.
#[track_caller]
fn small_city(folder: &Path, name: &str) {
    let args =
        ["streets", "grow", "--example", "builtin:helsinki", "--size", "600x600", "-o", name];
    exurb(folder, &args).ends(0);
}

/// Names in a folder, sorted.
fn listing(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
