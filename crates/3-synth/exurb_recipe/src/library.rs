//! Examples chosen from a folder of many.
//!
//! Source: Nishida et al. 2015, section 3: every part of the target takes after examples of like
//! terrain and density. There a user picks them; here the first step's method does.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use exurb_city::City;
use exurb_geom::Polygon;
use exurb_operation::{Example, Run};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{Error, Recipe, Registry, Source, TerrainSource, attached, open, read_example, run};

/// Endings of height maps that say where they lie.
const HEIGHT_MAPS: [&str; 4] = ["tif", "tiff", "hgt", "asc"];

/// A folder of examples, of which those serve that the first step's method finds fitting.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Library {
    /// The folder: maps and cities of any readable format, each with a height map of the same name
    /// beside it or without.
    pub folder: PathBuf,
}

impl Library {
    /// The maps in the folder, by name.
    fn sources(&self, folder: &Path) -> Result<Vec<Source>, Error> {
        let path = open::locate(&self.folder, folder)?;
        let wrong = |message: &str| Error::Input(open::named(&path, message));
        let entries = std::fs::read_dir(&path)
            .map_err(|e| wrong(&format!("is no folder that can be read: {e}")))?;
        let mut files: Vec<PathBuf> =
            entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|p| p.is_file()).collect();
        files.sort();
        let mut sources: Vec<Source> = files
            .iter()
            .filter(|file| open::format_of(file).is_ok())
            .map(|file| Source::new(file.clone()))
            .collect();
        for source in &mut sources {
            let stem = source.name();
            let beside = HEIGHT_MAPS.iter().map(|ending| path.join(format!("{stem}.{ending}")));
            source.terrain = beside
                .into_iter()
                .find(|file| file.is_file())
                .map(|file| TerrainSource { file, ..TerrainSource::default() });
        }
        if sources.is_empty() {
            return Err(wrong("holds no map that can be read"));
        }
        Ok(Source::distinct(sources))
    }
}

impl Recipe {
    /// This recipe with the examples of its library that serve for `city` where the first step works, in
    /// place of the library, and all examples. Maps of the library that cannot be read or hold no streets are left out with a
    /// warning.
    pub(crate) fn with_library(
        &self,
        mut examples: Vec<Example>,
        city: &City,
        changed: &[Polygon],
        folder: &Path,
        registry: &Registry,
        run: &Run,
    ) -> Result<(Self, Vec<Example>), Error> {
        let mut recipe = Self { library: None, ..self.clone() };
        let (Some(library), Some(step)) = (&self.library, self.steps.first()) else {
            return Ok((recipe, examples));
        };
        let sources = library.sources(folder)?;
        run.phase("reading the library");
        // What readers warn of matters for what is chosen only.
        let read: Vec<(Run, Result<Example, Error>)> = sources
            .par_iter()
            .map(|source| {
                let aside = Run::new(run.seed());
                let example = run.check().map_err(Error::from);
                let example = example.and_then(|()| read_example(source, folder, &aside));
                (aside, example)
            })
            .collect();
        let mut known: Vec<(Source, Example, Run)> = Vec::new();
        for (source, (aside, example)) in sources.into_iter().zip(read) {
            match example {
                Ok(example) if example.city.streets.edge_count() > 0 => {
                    known.push((source, example, aside));
                }
                Ok(_) => run.warn(format!("{}: left out, it has no streets", source.name())),
                Err(Error::Input(message)) => run.warn(format!("left out: {message}")),
                Err(error) => return Err(error),
            }
        }
        let operation = registry.find(&step.op).map_err(Error::Recipe)?;
        let params = attached::read(&step.params, &operation.schema(), &city.frame, folder, run)?;
        let offered: Vec<Example> = known.iter().map(|(_, example, _)| example.clone()).collect();
        let mut chosen = BTreeSet::new();
        for scope in run::scopes(&step.scope, city, changed, folder, run)? {
            let params = Value::Object(params.clone());
            chosen.extend(operation.choose(city, &scope, &offered, params, run)?);
        }
        for i in chosen {
            let (source, example, aside) = &known[i];
            for warning in aside.take_warnings() {
                run.named(&warning.from).warn(warning.message);
            }
            recipe.examples.push(source.clone());
            examples.push(example.clone());
        }
        Ok((recipe, examples))
    }
}
