//! Single things in the street space and in blocks: trees, lamps, playgrounds, post boxes.

use std::sync::Arc;

use exurb_geom::{GridPoint, Polygon};

use crate::Provenance;

/// Where a feature stands.
#[derive(Clone, Debug, PartialEq)]
pub enum FeatureShape {
    /// A point.
    Point(GridPoint),
    /// A line, such as a tree row.
    Line(Vec<GridPoint>),
    /// An area, such as a playground.
    Polygon(Polygon),
}

/// A feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Its number, from 1.
    pub id: u32,
    /// What it is, in OSM's word: `tree`, `tree_row`, `street_lamp` → `lamp`, `playground`, ...
    pub kind: Arc<str>,
    /// Where it stands.
    pub shape: FeatureShape,
    /// Number of its block, 0 when it stands in none.
    pub block: u32,
    /// Where it came from.
    pub provenance: Provenance,
}
