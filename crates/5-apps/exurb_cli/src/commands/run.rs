//! `exurb run RECIPE.toml`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::{Export, Recipe, Registry};

use crate::options::RunOptions;
use crate::output::{Folder, Outputs};
use crate::problem::Problem;
use crate::{job, summary};

#[derive(Args)]
struct Options {
    /// Recipe to run; `exurb schema` tells the parameters of its steps
    recipe: PathBuf,
    /// Folder for what it exports, made when it is not there
    #[arg(long, short, value_name = "DIR", default_value = ".")]
    output: PathBuf,
    /// Random seed instead of the recipe's
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Read and check everything, print the recipe, write nothing
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "Run a recipe: operations in order, with what they read and write";
    Options::augment_args(Command::new("run")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let name = options.recipe.display().to_string();
    let text = std::fs::read_to_string(&options.recipe)
        .map_err(|e| Problem::usage(format!("{name} cannot be read: {e}")))?;
    let mut recipe = Recipe::parse_with(&text, &name, registry)?;
    recipe.seed = options.seed.unwrap_or(recipe.seed);
    if recipe.exports.is_empty() {
        recipe.exports.push(Export { file: "city.gpkg".into(), ..Export::default() });
    }
    let mut running = options.run.clone();
    running.threads = running.threads.or(recipe.threads.and_then(|n| u16::try_from(n).ok()));
    let folder = options.recipe.parent().unwrap_or(Path::new(""));
    if options.dry_run {
        job::work(&running, recipe.seed, |run| Ok(recipe.read(folder, registry, run)?))?;
        return summary::recipe(&recipe, &running);
    }
    perform(&recipe, folder, &options.output, &running, registry)
}

/// Runs a recipe and writes its exports into `into`; then reports.
pub fn perform(
    recipe: &Recipe,
    folder: &Path,
    into: &Path,
    options: &RunOptions,
    registry: &Registry,
) -> Result<(), Problem> {
    let folder_made = Folder::make(into)?;
    let (made, example) = job::work(options, recipe.seed, |run| {
        let outputs = Outputs::prepare(&recipe.exports, into)?;
        let inputs = recipe.read(folder, registry, run)?;
        let example = inputs.examples.first().map(|e| e.city.clone());
        let mut made = recipe.make(inputs, folder, registry, run)?;
        made.seconds.write = outputs.write(&made.city, run)?;
        Ok((made, example))
    })?;
    folder_made.keep();
    let files: Vec<PathBuf> = recipe.exports.iter().map(|e| into.join(&e.file)).collect();
    let files: Vec<&PathBuf> = files.iter().collect();
    summary::report(&made.city, example.as_deref(), made.seconds, &files, options)
}
