//! The one trait of every method, and what a method is handed: parameters, a run, examples.
//!
//! An [`Operation`] looks at a city, examples, parameters and a seed, and gives an edit of the city.
//! Command line, recipes, studio and Python reach it as an [`AnyOperation`], which takes parameters
//! as a document and checks them against the schema that the parameters' type gives.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Operation`], [`AnyOperation`] | the trait, and the same without its types |
//! | [`Params`], [`params`] | parameters: defaults, ranges, units, docs, defined once |
//! | [`PolygonFile`], [`DomainsFile`], [`StyleMap`] | parameters whose values lie in files |
//! | [`Run`] | seeded streams, progress, cancel, warnings |
//! | [`rng`] | one stream of random numbers for each operation and element |
//! | [`Card`] | what an operation is called and where it comes from |
//! | [`Failure`] | why an operation did not do its work |

mod attachment;
mod card;
mod failure;
mod operation;
pub mod params;
pub mod rng;
mod run;

pub use attachment::{Domain, DomainsFile, Lines, LinesFile, PolygonFile, StyleArea, StyleMap};
pub use card::Card;
pub use failure::Failure;
pub use operation::{AnyOperation, Example, Operation, Outcome, Scope, Seconds, erase};
pub use params::Params;
pub use rng::Rng;
pub use run::{Run, Warning};
