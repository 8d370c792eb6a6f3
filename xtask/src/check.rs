//! `check`: what can be told without running the program.

use crate::shell::{self, Outcome, cargo};
use crate::{arrows, licences};

/// Format, lints, docs, arrows, licences; stops at the first breach.
pub fn run() -> Outcome {
    shell::run(&mut cargo("fmt --all --check"))?;
    shell::run(&mut cargo("clippy --workspace --all-targets --locked -- -D warnings"))?;
    let mut docs = cargo("doc --workspace --no-deps --locked");
    shell::run(docs.env("RUSTDOCFLAGS", "-D warnings"))?;
    arrows::run()?;
    licences::run()
}
