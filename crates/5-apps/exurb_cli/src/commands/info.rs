//! `exurb info CITY`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_city::City;
use exurb_measure::Info;
use exurb_operation::Run;
use exurb_recipe::Source;
use serde_json::json;

use crate::options::{PartOptions, RunOptions};
use crate::problem::Problem;
use crate::{job, report};

#[derive(Args)]
struct Options {
    /// City or map of any readable format
    city: PathBuf,
    /// Example to compare the likeness gates with
    #[arg(long, short, value_name = "FILE")]
    example: Option<PathBuf>,
    /// Print the recipe that made the city, and nothing else
    #[arg(long, conflicts_with = "json")]
    recipe: bool,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "What is in a city: counts, lengths, areas, laws, likeness gates, provenance";
    Options::augment_args(Command::new("info")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let read = |source: &Source, run: &Run| exurb_recipe::read_source(source, Path::new(""), run);
    let text = job::work(&options.run, 1, |run| {
        let city = read(&options.part.apply(Source::new(&options.city)), run)?;
        if options.recipe {
            return recipe(&city, &options);
        }
        let example = options.example.as_ref().map(|file| read(&Source::new(file), run));
        let example = example.transpose()?;
        run.phase("measuring");
        let info = Info::of(&city, example.as_ref());
        run.check()?;
        Ok(if options.run.json { format!("{:#}", json!(info)) } else { info.to_text() })
    })?;
    report::result(&text)
}

fn recipe(city: &City, options: &Options) -> Result<String, Problem> {
    match &city.metadata.recipe {
        none if none.is_empty() => Err(Problem::failed(format!(
            "{} holds no recipe: it was imported, not made by exurb",
            options.city.display()
        ))),
        recipe => Ok(recipe.clone()),
    }
}
