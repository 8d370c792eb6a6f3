//! Plain measures of a city, the same for learners, synthesisers and reports.
//!
//! | part | what it holds |
//! |---|---|
//! | [`info`] | what is in a city, with its laws and likeness gates: `exurb info` |
//! | [`statistics`] | mean and variance of length and curvature of streets |

pub mod info;
mod info_text;
pub mod statistics;

pub use info::Info;
pub use statistics::{StreetStatistics, street_statistics};
