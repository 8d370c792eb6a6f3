//! Plain measures of a city, the same for learners, synthesisers and reports.
//!
//! Most measures are distributions: a [`Sample`] of values with weights, measured on the [`Network`]
//! of a window. Every window of one comparison has the same size.
//!
//! | part | what it holds |
//! |---|---|
//! | [`info`] | what is in a city, with its laws and likeness gates: `exurb info` |
//! | [`statistics`] | mean and variance of length and curvature of streets |
//! | [`sample`] | values with weights |
//! | [`mod@network`] | the streets of a window, cleaned for measuring |
//! | [`segments`] | length, sinuosity, curvature of streets |
//! | [`junctions`] | degrees and angles |
//! | [`block_shapes`] | area and shape of blocks |
//! | [`bearings`] | directions, and how alike they are at a distance |
//! | [`moving_windows`] | densities, order, meshedness, share of crossings of neighbourhoods |
//! | [`mod@paths`] | reach, detour, betweenness |
//! | [`natural_streets`] | streets that go on in each other |
//! | [`buildings`], [`built_blocks`] | footprints, setbacks, heights; coverage, corners, fronts |
//! | [`parcels`] | lots: size, frontage, access, how they are built on |

pub mod bearings;
pub mod block_shapes;
pub mod buildings;
pub mod built_blocks;
pub mod info;
mod info_text;
pub mod junctions;
pub mod moving_windows;
pub mod natural_streets;
mod nearest;
pub mod network;
mod on_land;
pub mod parcels;
pub mod paths;
pub mod sample;
pub mod segments;
pub mod statistics;

pub use info::Info;
pub use network::Network;
pub use sample::Sample;
pub use statistics::{StreetStatistics, street_statistics};
