//! Plain measures of a city, the same for learners, synthesisers and reports.
//!
//! | part | what it holds |
//! |---|---|
//! | [`statistics`] | mean and variance of length and curvature of streets |

pub mod statistics;

pub use statistics::{StreetStatistics, street_statistics};
