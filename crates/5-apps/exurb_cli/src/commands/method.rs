//! `exurb streets|blocks|buildings METHOD`: one command for each operation, made from its card and
//! the schema of its parameters.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use exurb_operation::{AnyOperation, Card, Run};
use exurb_recipe::{Export, Inputs, Recipe, Registry, Source, Step, Within, needs_city};

use crate::options::{
    ExampleOptions, LibraryOptions, RunOptions, SeedOptions, TargetOptions, TerrainOptions,
};
use crate::output::Outputs;
use crate::problem::Problem;
use crate::{flags, job, summary};

/// What `auto` does in a stage.
const AUTO: [(&str, &[&str]); 1] = [("buildings", &["buildings extrude"])];

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

/// What of a city that is there a method of streets changes.
#[derive(Args, Default)]
#[command(next_help_heading = "Target")]
struct InsideOptions {
    /// Grow new streets inside this GeoJSON or GeoPackage polygon of CITY; the rest stays as it is
    #[arg(long, value_name = "AREA.geojson", requires = "city")]
    scope: Option<PathBuf>,
    /// Grow new streets only where --terrain gives CITY other ground than it has; the rest stays
    #[arg(long, requires = "city", requires = "terrain", conflicts_with = "scope")]
    changed: bool,
    /// A map whose streets lie there from the beginning and stay as they are
    #[arg(long, value_name = "STREETS.geojson")]
    fixed: Option<PathBuf>,
}

/// What a command word stands for: one operation with its parameters, or `auto`, several in order
/// with none.
struct Method<'a> {
    name: &'static str,
    about: String,
    operations: Vec<&'a dyn AnyOperation>,
}

/// The methods of a stage as commands see them: its operations, then `auto` where several make a
/// whole.
fn methods<'a>(stage: &str, registry: &'a Registry) -> Vec<Method<'a>> {
    let own = registry.iter().filter(|operation| operation.card().stage == stage);
    let mut methods: Vec<Method> = own
        .map(|operation| {
            let card = operation.card();
            let about = sentence(card.summary);
            Method { name: card.method, about, operations: vec![operation] }
        })
        .collect();
    for (_, names) in AUTO.into_iter().filter(|(of, _)| *of == stage) {
        let operations: Vec<_> = names.iter().filter_map(|name| registry.find(name).ok()).collect();
        let about = format!("The usual methods in order: {}", names.join(", then "));
        methods.push(Method { name: "auto", about, operations });
    }
    methods
}

impl Method<'_> {
    fn cards(&self) -> impl Iterator<Item = Card> {
        self.operations.iter().map(|operation| operation.card())
    }

    fn needs_city(&self) -> bool {
        self.cards().next().is_some_and(|card| needs_city(&card))
    }

    fn needs_example(&self) -> bool {
        self.cards().any(|card| card.needs_example)
    }

    /// The operation whose parameters are flags.
    fn single(&self) -> Option<&dyn AnyOperation> {
        let is_list = self.operations.first().is_none_or(|o| o.card().method != self.name);
        if is_list { None } else { self.operations.first().copied() }
    }

    fn command(&self) -> Command {
        let sources: Vec<&str> = self.cards().map(|card| card.source).collect();
        let mut command =
            Command::new(self.name).after_help(format!("Source: {}", sources.join("; ")));
        let help = if self.needs_city() {
            "City to work on, any readable format"
        } else {
            "City to grow a part of anew (see --scope); without one a new city is made"
        };
        let city = Arg::new("city").value_name("CITY").required(self.needs_city()).help(help);
        command = command.arg(city.value_parser(clap::value_parser!(PathBuf)));
        command = MadeOptions::augment_args(command);
        if let Some(operation) = self.single() {
            command = flags::add(command, &operation.schema(), "Parameters");
        }
        command = LibraryOptions::augment_args(ExampleOptions::augment_args(command));
        command = if self.needs_city() {
            ScopeOptions::augment_args(command)
        } else {
            InsideOptions::augment_args(TargetOptions::augment_args(command))
        };
        command = TerrainOptions::augment_args(command);
        // The shared options bring their own doc lines, which must not stand for the method's.
        RunOptions::augment_args(SeedOptions::augment_args(command)).about(self.about.clone())
    }

    /// The steps that the arguments ask for.
    fn steps(&self, matches: &ArgMatches, scope: &Within) -> Result<Vec<Step>, Problem> {
        let mut steps: Vec<Step> = self.cards().map(|card| Step::new(card.name())).collect();
        if let (Some(operation), [step]) = (self.single(), &mut steps[..]) {
            step.params = flags::document(matches, &operation.schema()).map_err(Problem::usage)?;
            operation.check(&step.params.clone().into())?;
        }
        steps.iter_mut().for_each(|step| step.scope = scope.clone());
        Ok(steps)
    }

    /// The recipe that the arguments ask for.
    fn recipe(&self, matches: &ArgMatches, registry: &Registry) -> Result<Recipe, Problem> {
        let SeedOptions { seed, .. } = given(matches)?;
        let examples = given::<ExampleOptions>(matches)?.sources();
        let library = given::<LibraryOptions>(matches)?.library();
        let terrain = given::<TerrainOptions>(matches)?.source();
        let mut recipe = Recipe { seed, examples, library, terrain, ..Recipe::default() };
        let mut scope = Within::All;
        if self.needs_city() {
            recipe.city = matches.get_one::<PathBuf>("city").map(Source::new);
            scope = match given(matches)? {
                ScopeOptions { scope: Some(file), .. } => Within::File(file),
                ScopeOptions { blocks: Some(blocks), .. } => Within::Blocks(blocks),
                _ => Within::All,
            };
        } else if recipe.examples.is_empty() && recipe.library.is_none() && self.needs_example() {
            let message =
                format!("{} learns from an example; name one with --example FILE", self.name);
            return Err(Problem::usage(message));
        } else {
            recipe.city = matches.get_one::<PathBuf>("city").map(Source::new);
            match (&recipe.city, given(matches)?) {
                (Some(_), InsideOptions { scope: Some(file), .. }) => scope = Within::File(file),
                (Some(_), InsideOptions { changed: true, .. }) => scope = Within::Changed,
                (Some(city), _) => {
                    let message = format!(
                        "{} {} would replace all streets of {}; name the part to change with --scope AREA.geojson, or give it new ground with --changed --terrain",
                        self.cards().next().map_or("streets", |card| card.stage),
                        self.name,
                        city.file.display()
                    );
                    return Err(Problem::usage(message));
                }
                (None, _) => recipe.target = Some(given::<TargetOptions>(matches)?.target()),
            }
        }
        recipe.steps = self.steps(matches, &scope)?;
        if !self.needs_city()
            && let (Some(step), InsideOptions { fixed, .. }) =
                (recipe.steps.first_mut(), given(matches)?)
        {
            step.fixed = fixed;
        }
        let MadeOptions { output, to } = given(matches)?;
        recipe.exports = output
            .into_iter()
            .map(|file| Export { file, to: to.clone(), ..Export::default() })
            .collect();
        recipe.normalise(registry);
        Ok(recipe)
    }
}

/// The words with a capital at their head.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |head| head.to_uppercase().chain(letters).collect())
}

/// A group of options as it was given.
fn given<T: FromArgMatches>(matches: &ArgMatches) -> Result<T, Problem> {
    T::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))
}

/// The command of a stage, with its methods.
pub fn stage(stage: &'static str, about: &'static str, registry: &Registry) -> Command {
    Command::new(stage)
        .about(about)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand_value_name("METHOD")
        .subcommand_help_heading("Methods")
        .subcommands(methods(stage, registry).iter().map(Method::command))
}

/// Runs the method that was asked for.
pub fn run(stage: &str, matches: &ArgMatches, registry: &Registry) -> Result<(), Problem> {
    let (name, matches) = matches.subcommand().unwrap_or(("", matches));
    let methods = methods(stage, registry);
    let Some(method) = methods.iter().find(|method| method.name == name) else {
        return Err(Problem::usage(format!("there is no method `{stage} {name}`")));
    };
    let options: RunOptions = given(matches)?;
    let mut recipe = method.recipe(matches, registry)?;
    let here = Path::new("");
    if given::<SeedOptions>(matches)?.dry_run {
        job::work(&options, recipe.seed, |run| {
            let mut inputs = recipe.read(here, registry, run)?;
            recall(&mut recipe, &mut inputs, method, run)
        })?;
        return summary::recipe(&recipe, &options);
    }
    let exports = recipe.exports.clone();
    let (made, example) = job::work(&options, recipe.seed, |run| {
        let outputs = Outputs::prepare(&exports, here)?;
        let mut inputs = recipe.read(here, registry, run)?;
        recall(&mut recipe, &mut inputs, method, run)?;
        let example = inputs.examples.first().map(|e| e.city.clone());
        let mut made = recipe.make(inputs, here, registry, run)?;
        made.seconds.write = outputs.write(&made.city, run)?;
        Ok((made, example))
    })?;
    let files: Vec<&PathBuf> = exports.iter().map(|e| &e.file).collect();
    summary::report(&made.city, example.as_deref(), made.seconds, &made.tallies, &files, &options)
}

/// Where no example was named, a city's own ones are looked for beside it. A city that was imported
/// is its own example; so is, with a warning, one whose examples are gone.
fn recall(
    recipe: &mut Recipe,
    inputs: &mut Inputs,
    method: &Method<'_>,
    run: &Run,
) -> Result<(), Problem> {
    let Some(city) = &recipe.city else { return Ok(()) };
    let folder = city.file.parent().unwrap_or(Path::new("")).to_owned();
    let Err(missing) = recipe.recall_examples(inputs, &folder, run)? else { return Ok(()) };
    let message = format!(
        "the city was made from {missing}, which is neither beside it nor in the current folder; \
         name it with --example FILE"
    );
    if method.needs_example() {
        return Err(Problem::usage(message));
    }
    run.warn(format!("{message}. {} learns from the city itself meanwhile", method.name));
    Ok(())
}
