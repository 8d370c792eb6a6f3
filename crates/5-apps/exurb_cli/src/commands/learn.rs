//! `exurb learn EXAMPLE`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_city::{City, Role};
use exurb_measure::{Info, street_statistics};
use exurb_operation::{Example, Failure, Run};
use exurb_recipe::{Registry, Source};
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
    let about =
        "What an example teaches each method: statistics, patches, blocks, buildings; as JSON";
    Options::augment_args(Command::new("learn")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let source = options.part.apply(Source::new(&options.example));
    let lesson = job::work(&options.run, 1, |run| {
        let pending = options.output.as_deref().map(Pending::new).transpose()?;
        let example = exurb_recipe::read_example(&source, Path::new(""), run)?;
        let methods = methods(&example, registry, run)?;
        run.phase("measuring");
        let lesson = lesson(&example.city, methods);
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

/// What each method learns; null, with a warning, where the example does not serve one.
fn methods(example: &Example, registry: &Registry, run: &Run) -> Result<Value, Problem> {
    let mut lessons = serde_json::Map::new();
    for operation in registry.iter() {
        let name = operation.card().name();
        run.phase(&name);
        let lesson = match operation.lesson(std::slice::from_ref(example), run) {
            Ok(lesson) => lesson,
            Err(failure @ Failure::Example { .. }) => {
                run.warn(failure.to_string());
                Value::Null
            }
            Err(failure) => return Err(failure.into()),
        };
        lessons.insert(name, lesson);
    }
    Ok(Value::Object(lessons))
}

/// Length and curvature of streets by role, what the methods learn, and all that `exurb info` tells.
fn lesson(city: &City, methods: Value) -> Value {
    let streets = |role| street_statistics(&city.streets, role);
    json!({
        "name": &*city.metadata.name,
        "attribution": city.metadata.attribution,
        "buildings_complete": city.metadata.buildings_complete,
        "streets": {"main": streets(Role::Main), "local": streets(Role::Local)},
        "methods": methods,
        "info": Info::of(city, None),
    })
}
