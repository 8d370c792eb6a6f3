//! Running a recipe: read, then step by step.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use exurb_city::{City, Imported, completeness};
use exurb_geom::Polygon;
use exurb_operation::{Example, Run, Scope};
use serde_json::Value;

use crate::{
    Error, Recipe, Registry, Source, Step, Target, Within, attached, fixed, open, registry, target,
    terrain,
};

/// What a recipe reads before it works.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// The city the first step begins with.
    pub city: City,
    /// Where the terrain changed the city's ground.
    pub changed: Vec<Polygon>,
    /// The examples, in the recipe's order.
    pub examples: Vec<Example>,
    /// How long reading took, in seconds.
    pub read_seconds: f64,
}

/// What a recipe made.
#[derive(Clone, Debug)]
pub struct Made {
    /// The city; its metadata hold the recipe.
    pub city: City,
    /// Seconds taken by each kind of work.
    pub seconds: Seconds,
    /// What the steps did and why, counted.
    pub tallies: BTreeMap<String, u64>,
}

/// How long each kind of work took, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Seconds {
    /// Reading the examples and the city.
    pub read: f64,
    /// Learning from the examples.
    pub learn: f64,
    /// Editing the city.
    pub synthesise: f64,
    /// Writing files.
    pub write: f64,
}

impl Recipe {
    /// Reads what the recipe names and runs its steps. Files lie in `folder` or in the current one.
    /// Warnings go to `run`, which also cancels.
    pub fn run(&self, folder: &Path, run: &Run) -> Result<City, Error> {
        let registry = Registry::all();
        let inputs = self.read(folder, &registry, run)?;
        Ok(self.make(inputs, folder, &registry, run)?.city)
    }

    /// Reads the city and the examples, and checks that the steps can begin.
    pub fn read(&self, folder: &Path, registry: &Registry, run: &Run) -> Result<Inputs, Error> {
        let started = Instant::now();
        let mut examples = Vec::new();
        for source in &self.examples {
            examples.push(read_example(source, folder, run)?);
        }
        let mut city = self.first_city(&examples, folder, registry, run)?;
        let before = city.clone();
        if let Some(source) = &self.terrain {
            terrain::lay(&mut city, source, folder, run)?;
        }
        let asks = self.steps.iter().any(|step| step.scope == Within::Changed);
        let changed = if asks { changed_ground(&before, &city, run)? } else { Vec::new() };
        run.check()?;
        Ok(Inputs { city, changed, examples, read_seconds: started.elapsed().as_secs_f64() })
    }

    fn first_city(
        &self,
        examples: &[Example],
        folder: &Path,
        registry: &Registry,
        run: &Run,
    ) -> Result<City, Error> {
        let first = self.steps.first().map(|step| registry.find(&step.op)).transpose();
        let card = first.map_err(Error::Recipe)?.map(|operation| operation.card());
        match (&self.city, card) {
            (Some(source), _) => read_source(source, folder, run),
            (None, Some(card)) if registry::needs_city(&card) => Err(Error::Recipe(format!(
                "`{}` works on a city; begin the recipe with `[city]` or with a step that makes streets",
                card.name()
            ))),
            (None, None) => Err(Error::Recipe(
                "the recipe has neither `[[steps]]` nor a `[city]`: there is nothing to make"
                    .to_owned(),
            )),
            (None, _) => {
                let target = self.target.clone().unwrap_or(Target::Size(Default::default()));
                target::begin(&target, examples.first().map(|e| &*e.city), folder, run)
            }
        }
    }

    /// Runs the steps on what was read. The city's metadata get the recipe in its portable form.
    pub fn make(
        &self,
        inputs: Inputs,
        folder: &Path,
        registry: &Registry,
        run: &Run,
    ) -> Result<Made, Error> {
        let Inputs { mut city, changed, examples, read_seconds } = inputs;
        let started = Instant::now();
        let (recipe, examples) =
            self.with_library(examples, &city, &changed, folder, registry, run)?;
        let read = read_seconds + started.elapsed().as_secs_f64();
        let history = city.metadata.recipe.clone();
        let mut seconds = Seconds { read, ..Seconds::default() };
        for step in &recipe.steps {
            let operation = registry.find(&step.op).map_err(Error::Recipe)?;
            let scopes = scopes(&step.scope, &city, &changed, folder, run)?;
            let chosen = recipe.choose(step, &city, &examples);
            run.phase(&step.op);
            let run = run.seeded(step.seed.unwrap_or(recipe.seed));
            let read =
                attached::read(&step.params, &operation.schema(), &city.frame, folder, &run)?;
            for scope in &scopes {
                if let Some(file) = &step.fixed {
                    fixed::lay(&mut city, file, scope, folder, &run)?;
                }
                let params = Value::Object(read.clone());
                let outcome = operation.run(&city, scope, &chosen, params, &run)?;
                seconds.learn += outcome.seconds.learn;
                seconds.synthesise += outcome.seconds.synthesise;
                city = outcome.city;
            }
        }
        run.check()?;
        // A made city is an example, too: have its streets their houses by now?
        city.metadata.buildings_complete =
            completeness::is_complete(&city.streets, &city.buildings);
        city.metadata.recipe = recipe.portable(registry).after(&history, registry).print()?;
        Ok(Made { city, seconds, tallies: run.tallies() })
    }

    /// The examples a step learns from.
    fn choose(&self, step: &Step, city: &City, examples: &[Example]) -> Vec<Example> {
        match &step.examples {
            None if !self.examples.is_empty() => examples.to_vec(),
            None if self.city.is_none() => Vec::new(),
            Some(names) if !names.is_empty() => {
                let named = self.examples.iter().zip(examples);
                let chosen = named.filter(|(source, _)| names.contains(&source.key()));
                chosen.map(|(_, example)| example.clone()).collect()
            }
            _ => vec![itself(city)],
        }
    }
}

/// Where new ground differs from the old.
fn changed_ground(old: &City, new: &City, run: &Run) -> Result<Vec<Polygon>, Error> {
    let parts = exurb_city::terrain::changed(old, new).map_err(|e| Error::Input(e.to_string()))?;
    let ha: f64 = parts.iter().map(|part| part.area_m2() / 1e4).sum();
    run.warn(match parts.len() {
        0 => "the ground is as it was, so nothing grows anew".to_owned(),
        count => format!("{count} part(s) of {ha:.1} ha have other ground and grow anew"),
    });
    Ok(parts)
}

/// Where a step may change the city: it works on one part after the other.
pub(crate) fn scopes(
    within: &Within,
    city: &City,
    changed: &[Polygon],
    folder: &Path,
    run: &Run,
) -> Result<Vec<Scope>, Error> {
    Ok(match within {
        Within::All => vec![Scope::All],
        Within::Changed => changed.iter().cloned().map(Scope::Inside).collect(),
        Within::Blocks(blocks) => vec![Scope::Blocks(blocks.clone())],
        Within::File(file) => {
            vec![Scope::Inside(target::read_in_frame(file, &city.frame, folder, run)?)]
        }
    })
}

/// The city of a source; what its reader warns of goes to `run`. A city that a recipe made keeps
/// the name it has, whatever its file is called; others bear the source's name.
pub fn read_source(source: &Source, folder: &Path, run: &Run) -> Result<City, Error> {
    let path = open::locate(&source.file, folder)?;
    run.phase(&format!("reading {}", source.name()));
    let Imported { mut city, warnings } = open::open_city(&path, &source.import_options())?;
    if source.name.is_some() || city.metadata.recipe.is_empty() {
        city.metadata.name = source.name().into();
    }
    let run = run.named(&source.name());
    warnings.into_iter().for_each(|warning| run.warn(warning));
    if let Some(source) = &source.terrain {
        terrain::lay(&mut city, source, folder, &run)?;
    }
    run.check()?;
    Ok(city)
}

/// [`read_source`] for an example: what is copied from it bears the source's name.
pub fn read_example(source: &Source, folder: &Path, run: &Run) -> Result<Example, Error> {
    let mut city = read_source(source, folder, run)?;
    city.metadata.name = source.name().into();
    Ok(Example { city: Arc::new(city), weight: source.weight })
}

/// A city as its own example, under a name that no file's name changes.
fn itself(city: &City) -> Example {
    let mut city = city.clone();
    if city.metadata.name.is_empty() {
        city.metadata.name = "city".into();
    }
    Example::new(city)
}
