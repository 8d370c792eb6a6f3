//! Operations in order: recipes.
//!
//! A [`Recipe`] says what to read, where and how large the new city is, which operations to run with
//! which parameters, and what to write. Command line, studio and Python make recipes and run them;
//! every city holds the recipe that made it. Files are written by whoever runs the recipe: this
//! crate only reads.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Recipe`], [`Step`], [`Source`], [`Target`], [`Export`] | the document |
//! | `document` | TOML both ways, with errors that name the line |
//! | `run` | reading the inputs, running the steps |
//! | [`Library`] | examples chosen from a folder of many |
//! | `history` | the recipe inside a city file: portable, continued |
//! | [`open_city`], `format` | any readable file to a city |
//! | [`builtin`] | the examples that come with the program |
//! | [`Registry`] | every operation of the stage crates |
//! | [`Size`], `target` | where a new city lies |
//! | [`TerrainSource`] | the ground, from a height map |
//!
//! ```
//! use exurb_recipe::{Recipe, Registry};
//! let text = "exurb = 1\nseed = 7\n\n[target]\nsize = \"800x600\"\n";
//! let recipe = Recipe::parse(text, "recipe.toml").unwrap();
//! assert_eq!(recipe.print().unwrap(), text);
//! let wrong = Recipe::parse("exurb = 1\nsead = 7\n", "recipe.toml").unwrap_err();
//! assert!(wrong.to_string().starts_with("recipe.toml, line 2: unknown field `sead`"));
//! ```

mod attached;
pub mod builtin;
mod document;
mod error;
mod fixed;
mod format;
mod history;
mod library;
mod open;
mod recipe;
mod registry;
mod run;
mod size;
mod sketch;
mod target;
mod terrain;
#[cfg(test)]
mod test_operation;

pub use error::Error;
pub use format::READABLE;
pub use library::Library;
pub use open::{open_all, open_city};
pub use recipe::{Export, Half, Recipe, Source, Step, Target, VERSION, Within};
pub use registry::{Registry, needs_city};
pub use run::{Inputs, Made, Seconds, read_example, read_source};
pub use size::Size;
pub use terrain::lay as lay_terrain;
pub use terrain::{Gaps, TargetWord, TerrainBounds, TerrainSource};
