//! `check`: what can be told without running the program.

use crate::shell::{self, Outcome, cargo};
use crate::{arrows, licences};

/// Format, lints, docs, arrows, licences; stops at the first breach.
pub fn run() -> Outcome {
    shell::run(&mut cargo("fmt --all --check"))?;
    shell::run(&mut cargo("clippy --workspace --all-targets --locked -- -D warnings"))?;
    let mut docs = cargo("doc --workspace --no-deps --locked --document-private-items");
    // The first page of a room names its own files, which are private.
    let flags = "-D warnings -A rustdoc::private_intra_doc_links";
    shell::run(docs.env("RUSTDOCFLAGS", flags))?;
    arrows::run()?;
    licences::run()
}
