//! `exurb export CITY -o FILE`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::{Export, Source};

use crate::options::{DryOptions, OutputOptions, PartOptions, RunOptions};
use crate::output::Outputs;
use crate::problem::Problem;
use crate::{job, summary};

#[derive(Args)]
struct Options {
    /// City or map of any readable format
    city: PathBuf,
    #[command(flatten)]
    output: OutputOptions,
    /// Write this layer alone: streets, intersections, blocks, parcels, buildings, features, water,
    /// land_use or terrain (.tif or .png: a height map)
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    dry: DryOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "Write a city in another format, by the ending of the file";
    Options::augment_args(Command::new("export")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let export = Export {
        file: options.output.output.clone(),
        to: options.output.to.clone(),
        layer: options.layer.clone(),
        ..Export::default()
    };
    let source = options.part.apply(Source::new(&options.city));
    job::work(&options.run, 1, |run| {
        let outputs = Outputs::prepare(&[export], Path::new(""))?;
        let city = exurb_recipe::read_source(&source, Path::new(""), run)?;
        if options.dry.dry_run { Ok(()) } else { outputs.write(&city, run).map(|_| ()) }
    })?;
    let files: &[&PathBuf] = if options.dry.dry_run { &[] } else { &[&options.output.output] };
    summary::written(files, &options.run)
}
