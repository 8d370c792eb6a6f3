//! `exurb import INPUT -o CITY.gpkg`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_city::{City, Imported};
use exurb_operation::Run;
use exurb_recipe::{Export, Seconds, Source};

use crate::options::{DryOptions, OutputOptions, PartOptions, RunOptions, TerrainOptions};
use crate::output::Outputs;
use crate::pending::is_one_of;
use crate::problem::Problem;
use crate::{job, summary};

#[derive(Args)]
struct Options {
    /// Map to read: .osm, .osm.gz, .osm.bz2, .osm.pbf, Overpass JSON, GeoJSON or GeoPackage;
    /// several GeoJSON files make one city
    #[arg(required = true, value_name = "INPUT")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    part: PartOptions,
    #[command(flatten)]
    terrain: TerrainOptions,
    #[command(flatten)]
    dry: DryOptions,
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
    let OutputOptions { output, to } = options.output.clone();
    if is_one_of(&output, options.inputs.iter().map(PathBuf::as_path)) {
        let message = "it is the map to import and would be lost; name another file with -o";
        return Err(Problem::usage(format!("{}: {message}", output.display())));
    }
    let export = Export { file: output.clone(), to, ..Export::default() };
    let (city, seconds) = job::work(&options.run, 1, |run| {
        let outputs = Outputs::prepare(&[export], Path::new(""))?;
        let started = Instant::now();
        let city = read(&options, run)?;
        let read = started.elapsed().as_secs_f64();
        let write = if options.dry.dry_run { 0.0 } else { outputs.write(&city, run)? };
        Ok((city, Seconds { read, write, ..Seconds::default() }))
    })?;
    let files: &[&PathBuf] = if options.dry.dry_run { &[] } else { &[&output] };
    summary::report(&city, None, seconds, &Default::default(), files, &options.run)
}

fn read(options: &Options, run: &Run) -> Result<City, Problem> {
    if let [input] = &options.inputs[..] {
        let terrain = options.terrain.source();
        let source = Source { terrain, ..options.part.apply(Source::new(input)) };
        return Ok(exurb_recipe::read_source(&source, Path::new(""), run)?);
    }
    run.phase("reading");
    let taken = options.part.apply(Source::new("")).import_options();
    let Imported { mut city, warnings } = exurb_recipe::open_all(&options.inputs, &taken)?;
    warnings.into_iter().for_each(|warning| run.warn(warning));
    if let Some(source) = options.terrain.source() {
        exurb_recipe::lay_terrain(&mut city, &source, Path::new(""), run)?;
    }
    run.check()?;
    Ok(city)
}
