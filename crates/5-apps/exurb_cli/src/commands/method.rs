//! `exurb streets|blocks|buildings METHOD`: one command for each operation, made from its card and
//! the schema of its parameters.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use exurb_operation::AnyOperation;
use exurb_recipe::{Export, Inputs, Recipe, Registry, Source, Step, Within, needs_city};

use crate::options::{ExampleOptions, RunOptions, SeedOptions, TargetOptions};
use crate::output::Outputs;
use crate::problem::Problem;
use crate::{flags, job, report, summary};

/// The file to write; a dry run writes none.
#[derive(Args)]
struct MadeOptions {
    /// File to write, replaced when it is there; its ending chooses the format
    #[arg(long, short, value_name = "FILE", required_unless_present = "dry_run")]
    output: Option<PathBuf>,
    /// Format, where the ending is not enough
    #[arg(long, value_name = "FORMAT", value_parser = crate::format::Format::names().collect::<Vec<_>>())]
    to: Option<String>,
}

/// Where a city may be changed.
#[derive(Args, Default)]
#[command(next_help_heading = "Target")]
struct ScopeOptions {
    /// Change the city inside this GeoJSON or GeoPackage polygon only
    #[arg(long, value_name = "AREA.geojson", conflicts_with = "blocks")]
    scope: Option<PathBuf>,
    /// Change the city in these blocks only
    #[arg(long, value_name = "N,N,...", value_delimiter = ',')]
    blocks: Option<Vec<u32>>,
}

/// The command of a stage, with its methods.
pub fn stage(stage: &'static str, about: &'static str, registry: &Registry) -> Command {
    let methods = registry.iter().filter(|o| o.card().stage == stage).map(method);
    Command::new(stage)
        .about(about)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand_value_name("METHOD")
        .subcommand_help_heading("Methods")
        .subcommands(methods)
}

fn method(operation: &dyn AnyOperation) -> Command {
    let card = operation.card();
    let mut command = Command::new(card.method).after_help(format!("Source: {}", card.source));
    if needs_city(&card) {
        let help = "City to work on, any readable format";
        let city = Arg::new("city").value_name("CITY").required(true).help(help);
        command = command.arg(city.value_parser(clap::value_parser!(PathBuf)));
    }
    command = MadeOptions::augment_args(command);
    command = flags::add(command, &operation.schema(), "Parameters");
    command = ExampleOptions::augment_args(command);
    command = if needs_city(&card) {
        ScopeOptions::augment_args(command)
    } else {
        TargetOptions::augment_args(command)
    };
    // The shared options bring their own doc lines, which must not stand for the method's.
    RunOptions::augment_args(SeedOptions::augment_args(command)).about(card.summary)
}

/// Runs the method that was asked for.
pub fn run(stage: &str, matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let Some((method, matches)) = matches.subcommand() else {
        return Err(Problem::usage(format!("no method was given; see exurb {stage} --help")));
    };
    let operation = registry.find(&format!("{stage} {method}")).map_err(Problem::usage)?;
    let usage = |e: clap::Error| Problem::usage(e.to_string());
    let made_options = MadeOptions::from_arg_matches(matches).map_err(usage)?;
    let seed_options = SeedOptions::from_arg_matches(matches).map_err(usage)?;
    let options = RunOptions::from_arg_matches(matches).map_err(usage)?;
    let mut recipe = recipe(operation, matches, registry, seed_options.seed)?;
    if let Some(file) = &made_options.output {
        let (file, to) = (file.clone(), made_options.to.clone());
        recipe.exports.push(Export { file, to, ..Export::default() });
    }

    let here = Path::new("");
    if seed_options.dry_run {
        job::work(&options, recipe.seed, |run| {
            let mut inputs = recipe.read(here, registry, run)?;
            examples(&mut recipe, &mut inputs, operation, run)
        })?;
        return report::result(&recipe.print()?);
    }
    let exports = recipe.exports.clone();
    let (made, example) = job::work(&options, recipe.seed, |run| {
        let outputs = Outputs::prepare(&exports, here)?;
        let mut inputs = recipe.read(here, registry, run)?;
        examples(&mut recipe, &mut inputs, operation, run)?;
        let example = inputs.examples.first().map(|e| e.city.clone());
        let mut made = recipe.make(inputs, here, registry, run)?;
        made.seconds.write = outputs.write(&made.city, run)?;
        Ok((made, example))
    })?;
    let files: Vec<&PathBuf> = exports.iter().map(|e| &e.file).collect();
    summary::report(&made.city, example.as_deref(), made.seconds, &files, &options)
}

/// The recipe of one step that the arguments ask for.
fn recipe(
    operation: &dyn AnyOperation,
    matches: &ArgMatches,
    registry: &Registry,
    seed: u64,
) -> Result<Recipe, Problem> {
    let card = operation.card();
    let usage = |e: clap::Error| Problem::usage(e.to_string());
    let examples = ExampleOptions::from_arg_matches(matches).map_err(usage)?.sources();
    let mut step = Step::new(card.name());
    step.params = flags::document(matches, &operation.schema()).map_err(Problem::usage)?;
    operation.check(&step.params.clone().into())?;
    let mut recipe = Recipe { seed, examples, ..Recipe::default() };
    if needs_city(&card) {
        let city: Option<&PathBuf> = matches.get_one("city");
        recipe.city = city.map(Source::new);
        step.scope = match ScopeOptions::from_arg_matches(matches).map_err(usage)? {
            ScopeOptions { scope: Some(file), .. } => Within::File(file),
            ScopeOptions { blocks: Some(blocks), .. } => Within::Blocks(blocks),
            _ => Within::All,
        };
    } else {
        recipe.target = Some(TargetOptions::from_arg_matches(matches).map_err(usage)?.target());
        if recipe.examples.is_empty() && card.needs_example {
            let message =
                format!("`{}` needs an example; name one with --example FILE", card.name());
            return Err(Problem::usage(message));
        }
    }
    recipe.steps.push(step);
    recipe.normalise(registry);
    Ok(recipe)
}

/// Where no example was named, a city's own ones are looked for beside it. A city that was imported
/// is its own example; so is, with a warning, one whose examples are gone.
fn examples(
    recipe: &mut Recipe,
    inputs: &mut Inputs,
    operation: &dyn AnyOperation,
    run: &exurb_operation::Run,
) -> Result<(), Problem> {
    let Some(city) = &recipe.city else { return Ok(()) };
    let folder = city.file.parent().unwrap_or(Path::new("")).to_owned();
    let Err(missing) = recipe.recall_examples(inputs, &folder, run)? else { return Ok(()) };
    let card = operation.card();
    let message = format!(
        "the city was made from {missing}, which is neither beside it nor in the current folder; \
         name it with --example FILE"
    );
    if card.needs_example {
        return Err(Problem::usage(message));
    }
    run.warn(format!("{message}. {} learns from the city itself meanwhile", card.name()));
    Ok(())
}
