//! What the tests of the whole program share: the program itself, and where its inputs lie.
//!
//! - `scenarios.rs` runs a folder of `scenarios/` each and compares what came out;
//! - `determinism.rs` runs the same work twice and with other thread counts;
//! - `consumers.rs` lets other programs read what exurb wrote;
//! - `likeness.rs` lets other programs measure what exurb measured;
//! - `fuzz_corpus.rs` feeds the corpus of `fuzz/` to the readers.

#![allow(clippy::print_stdout, reason = "what tests report")]

mod consumer;
mod program;
mod sample;

pub use consumer::check;
pub use program::{Finished, exurb, root, shared_data};
pub use sample::{Sample, demo};
