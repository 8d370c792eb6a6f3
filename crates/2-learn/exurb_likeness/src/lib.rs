//! Likeness measured: how far a city is from an unseen part of its example.
//!
//! Every property of a city is a distribution, every comparison a distance between two of them, and
//! every distance is read against two others: that of the example's own other part (the ceiling) and
//! that of other cities (the floor).
//!
//! | part | what it holds |
//! |---|---|
//! | [`measures`] | the measures with their families, distances and constants |
//! | [`measured`] | all measures of one window of a city |
//! | [`distance`], [`draws`] | distances of distributions, equal draws |
//! | [`mod@patches`] | the discriminator |
//! | [`explain`], [`words`] | what a score means, in a sentence |
//! | [`document`] | what a comparison found, as JSON and as a table |
//! | [`columns`] | a candidate beside several examples |
//! | [`held_out`] | the part that is compared with |
//! | [`comparison`] | a candidate against an example: windows, floor, result |
//! | [`copying`] | how much of a city stands in its example |
//! | [`panel`] | what was measured of nine cities, for floors |
//! | [`scorecard`] | ceilings, floors, scores |
//! | [`unlikely`] | where a candidate differs, block by block |
//! | [`mod@windows`] | windows of equal size |
//! | [`nets`] | streets by rule, with and without a city: what a scale must put in order |
//! | [`yardstick_table`] | the table that shows whether it does |

pub mod columns;
pub mod comparison;
pub mod copying;
pub mod distance;
pub mod document;
pub mod draws;
pub mod explain;
pub mod held_out;
pub mod measured;
mod measured_built;
pub mod measures;
pub mod nets;
pub mod panel;
pub mod patches;
pub mod scorecard;
pub mod unlikely;
pub mod windows;
pub mod words;
pub mod yardstick_table;

pub use comparison::{Floor, Likeness, Place, Reference, Subject};
pub use document::Document;
pub use held_out::{HeldOut, Side};
pub use measured::Measured;
pub use measures::{BUILT, Family, Measure, STREETS};
pub use panel::Panel;
pub use scorecard::{Score, Scorecard, Yardstick};
