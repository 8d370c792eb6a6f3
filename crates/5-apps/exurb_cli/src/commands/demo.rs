//! `exurb demo`: a whole city from an example that comes with the program, or from one's own. The
//! demo is a recipe like any other; it writes that recipe, too.

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_recipe::{Export, Recipe, Registry, Source, Step, builtin};

use crate::options::{ExampleOptions, RunOptions, SeedOptions, TargetOptions, TerrainOptions};
use crate::output::{Folder, Outputs};
use crate::pending::Pending;
use crate::problem::Problem;
use crate::{job, report, summary};

#[derive(Args)]
struct Options {
    /// Folder to write into, made when it is not there
    #[arg(long, short, value_name = "DIR", default_value = "exurb-demo")]
    output: PathBuf,
    /// Built-in example to learn from
    #[arg(long, value_name = "NAME", default_value = builtin::NAMES[0],
          value_parser = builtin::NAMES, conflicts_with = "examples")]
    style: String,
    #[command(flatten)]
    examples: ExampleOptions,
    #[command(flatten)]
    target: TargetOptions,
    #[command(flatten)]
    terrain: TerrainOptions,
    #[command(flatten)]
    seed: SeedOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// The operations of the demo, in order. Trees come last: parcels tell where the parks are, and
/// footprints where no tree can stand.
const STEPS: [&str; 5] =
    ["streets grow", "blocks parcels", "blocks footprints", "buildings extrude", "streets furnish"];
/// What it writes beside the recipe and the credits; the last is a perspective picture.
const FILES: [&str; 8] = [
    "city.gpkg",
    "city.geojson",
    "city.osm",
    "city.osm.pbf",
    "city.glb",
    "map.svg",
    "map.png",
    "view.png",
];

/// The command.
pub fn command() -> Command {
    let about =
        "Make a whole city, by default 2 km x 2 km from a built-in example, in every format";
    Options::augment_args(Command::new("demo")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let (here, folder) = (Path::new(""), &options.output);
    let recipe = recipe(&options);
    if options.seed.dry_run {
        job::work(&options.run, recipe.seed, |run| Ok(recipe.read(here, registry, run)?))?;
        return summary::recipe(&recipe, &options.run);
    }
    let made_folder = Folder::make(folder)?;
    let (made, example) = job::work(&options.run, recipe.seed, |run| {
        let outputs = Outputs::prepare(&recipe.exports, folder)?;
        let texts = ["recipe.toml", "ATTRIBUTION.txt"].map(|name| Pending::new(&folder.join(name)));
        let [recipe_file, attribution_file] = texts;
        let inputs = recipe.read(here, registry, run)?;
        let example = inputs.examples.first().map(|e| e.city.clone());
        let mut made = recipe.make(inputs, here, registry, run)?;
        made.seconds.write = outputs.write(&made.city, run)?;
        for (file, text) in
            [(recipe_file?, recipe.print()?), (attribution_file?, credits(&made.city))]
        {
            file.write(text.as_bytes())?;
            file.commit()?;
        }
        Ok((made, example))
    })?;
    made_folder.keep();
    summary::report(
        &made.city,
        example.as_deref(),
        made.seconds,
        &made.tallies,
        &[],
        &options.run,
    )?;
    if !options.run.json && !options.run.quiet {
        report::result(&next_steps(folder))?;
    }
    Ok(())
}

fn recipe(options: &Options) -> Recipe {
    let mut exports: Vec<Export> =
        FILES.iter().map(|file| Export { file: file.into(), ..Export::default() }).collect();
    if let Some(view) = exports.last_mut() {
        view.view = Some("3d".to_owned());
    }
    let mut examples = options.examples.sources();
    if examples.is_empty() {
        let style = format!("{}{}", builtin::PREFIX, options.style);
        examples.push(options.examples.part.apply(Source::new(style)));
    }
    Recipe {
        seed: options.seed.seed,
        target: Some(options.target.target()),
        terrain: options.terrain.source(),
        examples,
        steps: STEPS.into_iter().map(Step::new).collect(),
        exports,
        ..Recipe::default()
    }
}

fn credits(city: &exurb_city::City) -> String {
    let lines = city.metadata.attribution.join("\n");
    format!("This city was synthesised by exurb from:\n{lines}\n")
}

fn next_steps(folder: &Path) -> String {
    let dir = folder.display();
    format!(
        "
Look at {dir}/map.png and {dir}/view.png.
Open {dir}/city.gpkg in QGIS, {dir}/city.glb in Blender or a browser, {dir}/city.osm in JOSM.

Next, with a map of your own (.osm.pbf, .osm, .geojson, ...):
  exurb streets grow --example YOUR_MAP -o city.gpkg
  exurb blocks auto city.gpkg --example YOUR_MAP -o city.gpkg
  exurb buildings auto city.gpkg --example YOUR_MAP -o city.gpkg
  exurb streets furnish city.gpkg --example YOUR_MAP -o city.gpkg
  exurb render city.gpkg --view 3d -o view.png
or all of it at once, as here:
  exurb demo --example YOUR_MAP --size 3000x2000 -o DIR
Or change {dir}/recipe.toml and run it:
  exurb run {dir}/recipe.toml -o DIR"
    )
}
