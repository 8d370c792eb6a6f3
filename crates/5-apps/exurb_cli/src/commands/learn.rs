//! `exurb learn EXAMPLE`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::Source;

use crate::options::{PartOptions, RunOptions};
use crate::pending::Pending;
use crate::problem::Problem;
use crate::{job, report, summary};

#[derive(Args)]
struct Options {
    /// City or map of any readable format
    example: PathBuf,
    /// File to write the report to; standard output when absent
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "What an example teaches: its statistics, as JSON";
    Options::augment_args(Command::new("learn")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let source = options.part.apply(Source::new(&options.example));
    let lesson = job::work(&options.run, 1, |run| {
        let pending = options.output.as_deref().map(Pending::new).transpose()?;
        let city = exurb_recipe::read_source(&source, Path::new(""), run)?;
        run.phase("measuring");
        let lesson = summary::info(&city, None)?;
        run.check()?;
        match pending {
            None => Ok(Some(lesson)),
            Some(pending) => {
                pending.write(format!("{lesson:#}\n").as_bytes())?;
                pending.commit()?;
                Ok(None)
            }
        }
    })?;
    match (lesson, &options.output) {
        (Some(lesson), _) => report::json(&lesson),
        (None, Some(file)) => summary::written(&[file], &options.run),
        (None, None) => Ok(()),
    }
}
