//! Water and land-use areas.

use std::sync::Arc;

use exurb_geom::Polygon;

/// An area of water or of one land use.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Its number, from 1.
    pub id: u32,
    /// Its outline.
    pub polygon: Polygon,
    /// What it is: `sea`, `river`, `lake`, ...; `park`, `forest`, `residential`, ...
    pub class: Arc<str>,
}

/// Land uses that streets leave alone when they grow.
pub const WITHOUT_STREETS: [&str; 2] = ["park", "cemetery"];

/// Is this land use kept free of buildings?
pub fn is_open(class: &str) -> bool {
    matches!(
        class,
        "park"
            | "garden"
            | "forest"
            | "wood"
            | "grass"
            | "meadow"
            | "scrub"
            | "heath"
            | "farmland"
            | "orchard"
            | "vineyard"
            | "cemetery"
            | "pitch"
            | "playground"
            | "golf_course"
            | "nature_reserve"
            | "recreation_ground"
            | "village_green"
            | "allotments"
            | "wetland"
            | "beach"
            | "water"
    )
}
