//! What the benches share: measuring a process, finding inputs, printing rows.
//!
//! Every figure is a whole process measured from outside (seconds by the clock, peak memory as the
//! system reports it), or what a process says of its own work where starting it would drown that.
//! `cargo xtask bench` installs the yardsticks and names them in the environment.

#![allow(clippy::print_stdout, reason = "a program that reports")]

mod inputs;
mod measure;
mod row;
mod settings;

pub use inputs::{bench_folder, largest_maps, made_once, root, shared_maps};
pub use measure::{Measured, measure, osmium, peer, python_says, work_says};
pub use row::{Better, heading, note, row};
pub use settings::set;
