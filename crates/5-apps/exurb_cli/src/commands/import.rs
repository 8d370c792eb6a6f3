//! `exurb import INPUT -o CITY.gpkg`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::{Export, Seconds, Source};

use crate::options::{OutputOptions, PartOptions, RunOptions};
use crate::output::Outputs;
use crate::problem::Problem;
use crate::{job, summary};

#[derive(Args)]
struct Options {
    /// Map to read: .osm, .osm.gz, .osm.bz2, .osm.pbf, Overpass JSON, GeoJSON or GeoPackage
    input: PathBuf,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "Read a map and write it as a city";
    Options::augment_args(Command::new("import")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let export = Export {
        file: options.output.output.clone(),
        to: options.output.to.clone(),
        ..Export::default()
    };
    let source = options.part.apply(Source::new(&options.input));
    let (city, seconds) = job::work(&options.run, 1, |run| {
        let started = Instant::now();
        let city = exurb_recipe::read_source(&source, Path::new(""), run)?;
        let read = started.elapsed().as_secs_f64();
        let write = Outputs::prepare(&[export], Path::new(""))?.write(&city, run)?;
        Ok((city, Seconds { read, write, ..Seconds::default() }))
    })?;
    summary::report(&city, None, seconds, &[&options.output.output], &options.run)
}
