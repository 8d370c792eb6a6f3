//! `exurb info CITY`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::Source;

use crate::options::{PartOptions, RunOptions};
use crate::problem::Problem;
use crate::{job, report, summary};

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
    let folder = Path::new("");
    let (city, info) = job::work(&options.run, 1, |run| {
        let city = exurb_recipe::read_source(
            &options.part.apply(Source::new(&options.city)),
            folder,
            run,
        )?;
        let example = options
            .example
            .as_ref()
            .map(|file| exurb_recipe::read_source(&Source::new(file), folder, run));
        let example = example.transpose()?;
        run.phase("measuring");
        let info =
            if options.recipe { None } else { Some(summary::info(&city, example.as_ref())?) };
        run.check()?;
        Ok((city, info))
    })?;
    match info {
        None if city.metadata.recipe.is_empty() => {
            let message =
                format!("{} holds no recipe: no exurb method made it", options.city.display());
            Err(Problem::failed(message))
        }
        None => report::result(&city.metadata.recipe),
        Some(info) if options.run.json => report::json(&info),
        Some(info) => report::result(&summary::text(&info)),
    }
}
