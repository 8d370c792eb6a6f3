//! Buildings and building parts.

use std::sync::Arc;

use exurb_geom::Polygon;

use crate::Provenance;

/// Shapes of roofs, after OSM's `roof:shape`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the names are those of OSM")]
pub enum Roof {
    Flat,
    Gabled,
    Hipped,
    Pyramidal,
    Skillion,
    HalfHipped,
    Gambrel,
    Mansard,
    Round,
    Dome,
}

impl Roof {
    /// All shapes.
    pub const ALL: [Self; 10] = [
        Self::Flat,
        Self::Gabled,
        Self::Hipped,
        Self::Pyramidal,
        Self::Skillion,
        Self::HalfHipped,
        Self::Gambrel,
        Self::Mansard,
        Self::Round,
        Self::Dome,
    ];

    /// The value of OSM's `roof:shape` key.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gabled => "gabled",
            Self::Hipped => "hipped",
            Self::Pyramidal => "pyramidal",
            Self::Skillion => "skillion",
            Self::HalfHipped => "half-hipped",
            Self::Gambrel => "gambrel",
            Self::Mansard => "mansard",
            Self::Round => "round",
            Self::Dome => "dome",
        }
    }

    /// The shape of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|r| r.as_str() == name)
    }
}

/// A building, or a part of one (`building:part`).
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    /// Its number, from 1.
    pub id: u32,
    /// Number of its block, 0 when it lies in none.
    pub block: u32,
    /// Number of its parcel, 0 when it lies in none.
    pub parcel: u32,
    /// Footprint, courtyards as holes.
    pub polygon: Polygon,
    /// Height of the top above ground in metres.
    pub height_m: Option<f64>,
    /// Height where the building begins above ground in metres (`min_height`), usually 0.
    pub min_height_m: f64,
    /// Storeys above ground.
    pub levels: Option<f64>,
    /// Roof shape.
    pub roof: Option<Roof>,
    /// Use: the value of `building`, or of `shop`, `amenity`, `office` where `building=yes`.
    pub usage: Option<Arc<str>>,
    /// Is it a `building:part`? Parts lie inside buildings and are no building of their own.
    pub is_part: bool,
    /// Where it came from.
    pub provenance: Provenance,
}

impl Building {
    /// A building of that outline with everything else unknown.
    pub fn new(id: u32, polygon: Polygon, provenance: Provenance) -> Self {
        Self {
            id,
            block: 0,
            parcel: 0,
            polygon,
            height_m: None,
            min_height_m: 0.0,
            levels: None,
            roof: None,
            usage: None,
            is_part: false,
            provenance,
        }
    }

    /// Height in metres by tag, else levels of 3 m; `None` when neither is known.
    pub fn known_height_m(&self) -> Option<f64> {
        self.height_m.or(self.levels.map(|l| l * 3.0))
    }
}
