//! The city model: one document type for what was imported and what was synthesised.
//!
//! A [`City`] holds streets, blocks, parcels, buildings, features, water and land use in a local
//! frame on the millimetre grid, and for every element where it came from. An example is just a
//! city. Layers are shared (`Arc`), so that a city is cheap to copy.
//!
//! | part | what it holds |
//! |---|---|
//! | [`City`] | the document |
//! | [`StreetMap`] | streets as imported: ways with every tag we keep |
//! | [`StreetGraph`] | streets as every learner, synthesiser and measure sees them |
//! | [`role`] | which OSM classes are main, local, other |
//! | [`block`] | blocks: the faces of the graph less the carriageways |
//! | [`parcel`], [`building`], [`feature`], [`area`] | what lies in the blocks |
//! | [`provenance`] | origin and source of elements |
//! | [`mod@simplify`] | dual carriageways → one street, small roundabouts → junctions |
//! | [`terrain`] | the ground: heights on a grid |
//! | [`land`] | what methods ask of the ground: height, slope, wet or dry |
//! | [`hierarchy`] | levels of streets, and strokes |
//! | [`mod@laws`] | what every city keeps, and its likeness gates |
//! | [`densest_square`] | the window that stands for a city in comparisons |
//! | [`Edit`] | what an operation changes |

pub mod area;
pub mod block;
pub mod building;
mod city;
pub mod completeness;
mod cut;
pub mod densest_square;
mod draft;
mod edit;
mod facades;
pub mod feature;
pub mod given;
pub mod hierarchy;
pub mod land;
pub mod laws;
mod lonlat_bbox;
pub mod parcel;
mod placing;
pub mod provenance;
mod redevelop;
pub mod role;
pub mod simplify;
pub mod street_graph;
pub mod street_map;
pub mod terrain;

pub use area::Area;
pub use block::{Block, BlockClass};
pub use building::{Building, Roof};
pub use city::{City, Metadata};
pub use draft::{Draft, DraftError, ImportOptions, Imported, Part};
pub use edit::Edit;
pub use feature::{Feature, FeatureShape};
pub use hierarchy::{Hierarchy, Stroke, assign_levels, strokes};
pub use land::Land;
pub use laws::{LawReport, laws};
pub use parcel::Parcel;
pub use provenance::{Origin, Provenance};
pub use redevelop::redevelop;
pub use role::{Class, Role};
pub use simplify::{Simplify, simplify};
pub use street_graph::{Junction, Street, StreetGraph};
pub use street_map::{StreetMap, Way};
pub use terrain::{Terrain, TerrainError};
