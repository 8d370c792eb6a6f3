//! Streets as imported: ways that may overlap, cross and run side by side, with the tags we keep.

use exurb_geom::GridPoint;

use crate::Street;

/// One way of the imported map.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Its number in the source (OSM way id; a running number where there is none).
    pub id: i64,
    /// Its line; at least two points, no equal neighbours.
    pub line: Vec<GridPoint>,
    /// Source node ids of the line's points, where the source has shared nodes; else empty.
    /// Two ways meet at a point only if they share its node id (or, without ids, where they cross).
    pub nodes: Vec<i64>,
    /// What is known of the street.
    pub street: Street,
}

/// Streets as imported. The [`crate::StreetGraph`] is derived from it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreetMap {
    /// The ways, by source order.
    pub ways: Vec<Way>,
}
