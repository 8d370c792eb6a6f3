//! Parcels: lots that tile their block.

use exurb_geom::Polygon;

use crate::Provenance;

/// A lot.
#[derive(Clone, Debug, PartialEq)]
pub struct Parcel {
    /// Its number, from 1.
    pub id: u32,
    /// Number of its block, 0 when it lies in none.
    pub block: u32,
    /// Its outline.
    pub polygon: Polygon,
    /// Does it share at least 3 m of boundary with the street side of its block?
    pub street_access: bool,
    /// Zoning or use where known (`residential`, `retail`, ...).
    pub land_use: Option<std::sync::Arc<str>>,
    /// Where it came from.
    pub provenance: Provenance,
}
