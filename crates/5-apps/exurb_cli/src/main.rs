//! The `exurb` command: parse, run operations, show.
//!
//! | part | what it does |
//! |---|---|
//! | `commands` | one file for each command |
//! | `options` | options that several commands share |
//! | `flags` | parameters of operations as flags, from their JSON Schema |
//! | `job` | threads, progress, Ctrl-C, limit of memory |
//! | `output`, `pending` | files to write: whole or not at all |
//! | `format`, `layer`, `picture` | what is in them |
//! | `report`, `summary` | what a user reads |
//! | `problem` | exit status: 0 done, 1 the work failed, 2 wrong usage or unreadable input |

mod commands;
mod flags;
mod format;
mod job;
mod layer;
mod memory;
mod options;
mod output;
mod pending;
mod picture;
mod problem;
mod report;
mod summary;

use std::process::ExitCode;

use exurb_recipe::Registry;

fn main() -> ExitCode {
    let registry = Registry::all();
    // A parse error ends the program here: message on standard error, status 2.
    let matches = commands::app(&registry).get_matches();
    match commands::dispatch(&matches, &registry) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            report::problem(&problem);
            ExitCode::from(problem.status)
        }
    }
}
