//! `exurb learn EXAMPLE`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_city::{City, Role};
use exurb_measure::{Info, street_statistics};
use exurb_recipe::Source;
use serde_json::{Value, json};

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
        let city = exurb_recipe::read_example(&source, Path::new(""), run)?.city;
        run.phase("measuring");
        let lesson = lesson(&city);
        run.check()?;
        if let Some(pending) = pending {
            pending.write(format!("{lesson:#}\n").as_bytes())?;
            pending.commit()?;
        }
        Ok(lesson)
    })?;
    match &options.output {
        Some(file) if !options.run.json => summary::written(&[file], &options.run),
        _ => report::json(&lesson),
    }
}

/// Length and curvature of streets by role, and all that `exurb info` tells.
fn lesson(city: &City) -> Value {
    let streets = |role| street_statistics(&city.streets, role);
    json!({
        "name": &*city.metadata.name,
        "attribution": city.metadata.attribution,
        "buildings_complete": city.metadata.buildings_complete,
        "streets": {"main": streets(Role::Main), "local": streets(Role::Local)},
        "info": Info::of(city, None),
    })
}
