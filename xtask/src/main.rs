//! Tasks of this repository, for people and for CI alike: `cargo xtask TASK`.
//!
//! | task | what it does |
//! |---|---|
//! | `check` | format, clippy, docs, arrows, licences |
//! | `test` | installs what the tests need, then runs all of them |
//! | `bless` | accepts what the scenarios give now as what they should give |
//! | `bench [STAGE]` | measures against named yardsticks |
//! | `fuzz [TARGET] [SECONDS]` | feeds the readers with broken files |
//! | `arrows` | crates use only what stands below them |
//! | `maps` | grows a city from every shared map and writes docs/maps.md |
//! | `likeness [OPTION ...]` | scores what is grown from every shared map; `--inside` tunes |
//! | `yardstick` | makes the table anew that shows whether the scale of likeness behaves |
//! | `gallery [FIGURE]` | makes the pictures of docs/gallery |
//! | `blocks [OPTION ...]` | scores the blocks of one half of a map filled from the other |
//! | `panel` | measures the built-in panel of `exurb compare` anew |
//! | `licences` | every dependency has a licence on the list |
//!
//! Exit status: 0 done, 1 the task failed, 2 wrong usage.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command that reports")]

mod arrows;
mod bench;
mod check;
mod fuzz;
mod gallery;
mod licences;
mod likeness;
mod maps;
mod metadata;
mod shell;
mod test;
mod tools;

use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask check | test | bless | bench [STAGE] | \
                     fuzz [TARGET] [SECONDS] | maps | likeness [OPTION ...] | yardstick | panel | \
                     blocks [OPTION ...] | gallery [FIGURE] | arrows | licences";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let outcome = match args[..] {
        ["check"] => check::run(),
        ["test"] => test::run(),
        ["bless"] => test::bless(),
        ["bench"] => bench::run(None),
        ["bench", stage] => bench::run(Some(stage)),
        ["fuzz", ref rest @ ..] => fuzz::run(rest),
        ["maps"] => maps::run(),
        ["likeness", ref options @ ..] => likeness::run(options),
        ["yardstick"] => likeness::yardstick(),
        ["gallery"] => gallery::run(None),
        ["gallery", figure] => gallery::run(Some(figure)),
        ["blocks", ref options @ ..] => likeness::blocks(options),
        ["panel"] => likeness::panel(),
        ["arrows"] => arrows::run(),
        ["licences"] => licences::run(),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
