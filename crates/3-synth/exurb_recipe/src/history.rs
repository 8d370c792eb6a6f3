//! The recipe inside a city file: portable, and continued when a city is worked on again.

use std::path::{Path, PathBuf};
use std::time::Instant;

use exurb_operation::Run;

use crate::{
    Error, Inputs, Recipe, Registry, Source, Step, Target, TerrainSource, Within, attached, open,
    read_example,
};

impl Recipe {
    /// The recipe as it goes into a city's metadata: files by their names alone, no threads and no
    /// exports, so that the same work gives the same bytes in whatever folder it is done.
    pub fn portable(&self, registry: &Registry) -> Self {
        let mut recipe = Self { threads: None, exports: Vec::new(), ..self.clone() };
        let mut terrains: Vec<&mut TerrainSource> = recipe.terrain.iter_mut().collect();
        for source in recipe.examples.iter_mut().chain(&mut recipe.city) {
            source.file = file_name(&source.file);
            terrains.extend(&mut source.terrain);
        }
        terrains.into_iter().for_each(|terrain| terrain.file = file_name(&terrain.file));
        if let Some(Target::File(file)) = &mut recipe.target {
            *file = file_name(file);
        }
        for step in &mut recipe.steps {
            if let Within::File(file) = &mut step.scope {
                *file = file_name(file);
            }
            step.fixed = step.fixed.as_deref().map(file_name);
            if let Ok(operation) = registry.find(&step.op) {
                attached::by_name(&mut step.params, &operation.schema());
            }
        }
        recipe.normalise(registry);
        recipe
    }

    /// This recipe as the continuation of the one that made its city: one recipe from the first
    /// step to the last. A city without a recipe (an import) stays named as the beginning.
    pub fn after(self, history: &str, registry: &Registry) -> Self {
        let Some(city) = &self.city else { return self };
        let taken_whole = Source { file: city.file.clone(), ..Source::new("") }
            == Source { id: None, name: None, weight: 1.0, ..city.clone() };
        let earlier = Self::parse_with(history, "", registry);
        let (true, Ok(mut whole)) = (taken_whole && !history.is_empty(), earlier) else {
            return self;
        };
        // On other ground the earlier steps would not make this city.
        if self.terrain.is_some() && self.terrain != whole.terrain {
            return self;
        }
        let was = whole.examples.len();
        // The weight of an only example says nothing.
        let alone = self.examples.len() == 1;
        let names: Vec<String> =
            self.examples.iter().map(|source| whole.adopt(source.clone(), alone)).collect();
        if whole.examples.len() > was {
            let before: Vec<String> = whole.examples[..was].iter().map(Source::key).collect();
            limit(&mut whole.steps, &before);
        }
        let mut steps = self.steps;
        limit(&mut steps, &names);
        for mut step in steps {
            step.seed = step.seed.or(Some(self.seed));
            whole.steps.push(step);
        }
        whole.normalise(registry);
        whole
    }

    /// Where the recipe names no example, takes those of the recipe inside the city, if all are
    /// still there: beside the city or in the current folder. Otherwise gives the name of the first
    /// that is not. A city without a recipe names none.
    pub fn recall_examples(
        &mut self,
        inputs: &mut Inputs,
        folder: &Path,
        run: &Run,
    ) -> Result<Result<(), String>, Error> {
        let history = &inputs.city.metadata.recipe;
        if !self.examples.is_empty() || self.library.is_some() || history.is_empty() {
            return Ok(Ok(()));
        }
        let Ok(earlier) = toml::from_str::<Self>(history) else { return Ok(Ok(())) };
        let started = Instant::now();
        let mut sources = earlier.examples;
        for source in &mut sources {
            match open::locate(&source.file, folder) {
                Ok(path) => source.file = path,
                Err(_) => return Ok(Err(source.file.display().to_string())),
            }
        }
        for source in &sources {
            inputs.examples.push(read_example(source, folder, run)?);
        }
        self.examples = sources;
        inputs.read_seconds += started.elapsed().as_secs_f64();
        Ok(Ok(()))
    }

    /// The key under which the recipe has a source, which it gets if it lacks it. Its name stays,
    /// since what was copied bears it.
    fn adopt(&mut self, source: Source, alone: bool) -> String {
        let same = |known: &&Source| {
            let weight = if alone { source.weight } else { known.weight };
            Source { id: source.id.clone(), weight, ..(*known).clone() } == source
        };
        if let Some(known) = self.examples.iter().find(same) {
            return known.key();
        }
        let plain = source.name();
        let mut source = Source { id: None, ..source };
        let mut number = 2;
        while self.examples.iter().any(|known| known.key() == source.key()) {
            source.id = Some(format!("{plain}-{number}"));
            number += 1;
        }
        let key = source.key();
        self.examples.push(source);
        key
    }
}

/// Steps that learn from all examples learn from these only.
fn limit(steps: &mut [Step], names: &[String]) {
    for step in steps.iter_mut().filter(|step| step.examples.is_none()) {
        step.examples = Some(names.to_vec());
    }
}

fn file_name(path: &Path) -> PathBuf {
    path.file_name().map_or_else(|| path.to_owned(), PathBuf::from)
}

#[cfg(test)]
#[path = "history_tests.rs"]
mod tests;
