//! What a row of somebody else's file is, by its geometry, its columns and the name of its
//! layer: the table in the crate's documentation.

mod attributes;
mod polygons;
mod streets;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use exurb_city::{Roof, Street};

use crate::geometry::Geometry;
pub use attributes::Attributes;

/// What a row becomes.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A street; `backward` when it is driven against its line.
    Street { street: Street, backward: bool },
    /// A building or a part of one.
    Building(Walls),
    /// A parcel and its zoning.
    Parcel(Option<Arc<str>>),
    /// Water of a class.
    Water(Arc<str>),
    /// A land use.
    LandUse(Arc<str>),
    /// A feature of a kind.
    Feature(Arc<str>),
}

/// What is known of a building.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    pub height_m: Option<f64>,
    pub min_height_m: f64,
    pub levels: Option<f64>,
    pub roof: Option<Roof>,
    pub usage: Option<Arc<str>>,
    pub is_part: bool,
}

/// What the row is; `None` when exurb has no place for it. `hint` is the name of its layer or file.
pub fn recognise(geometry: &Geometry, attributes: &Attributes<'_>, hint: &str) -> Option<Kind> {
    let theme = Theme::of(hint);
    match simple(geometry)? {
        Geometry::Point(_) => point(attributes, theme).map(Kind::Feature),
        Geometry::Line(_) => streets::line(attributes, theme),
        _ => polygons::polygon(attributes, theme),
    }
}

fn simple(geometry: &Geometry) -> Option<&Geometry> {
    match geometry {
        Geometry::Many(parts) => parts.first().and_then(simple),
        simple => Some(simple),
    }
}

/// What the name of a layer or file says.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Theme {
    Unknown,
    Streets,
    Buildings,
    Parcels,
    Water,
    LandUse,
    Trees,
    Lamps,
    /// Something exurb derives itself or has no place for.
    Other,
}

/// Parts of names in English, French, German and Spanish; the first that fits decides.
const THEMES: [(Theme, &[&str]); 8] = [
    (
        Theme::Other,
        &["intersection", "block", "tessellation", "target", "rail", "contour", "bound"],
    ),
    (
        Theme::Buildings,
        &[
            "building",
            "batiment",
            "bâtiment",
            "gebaeude",
            "gebäude",
            "footprint",
            "edificio",
            "house",
        ],
    ),
    (Theme::Parcels, &["parcel", "plot", "lots", "cadast", "flurst", "parzelle"]),
    (Theme::LandUse, &["landuse", "land_use", "zoning", "zonage", "zones", "nutzung", "parks"]),
    (
        Theme::Water,
        &["water", "river", "lake", "stream", "hydro", "gewaesser", "gewässer", "coast"],
    ),
    (Theme::Trees, &["tree", "arbre", "baum", "bäume", "baeume"]),
    (Theme::Lamps, &["lamp", "roadlight", "road_light"]),
    (Theme::Streets, &["road", "edges", "highway", "route", "strasse", "straße"]),
];

impl Theme {
    fn of(name: &str) -> Self {
        // A street is no tree.
        let name = name.to_lowercase().replace("street", "road");
        let fits = |words: &[&str]| words.iter().any(|word| name.contains(word));
        THEMES.iter().find(|(_, words)| fits(words)).map_or(Self::Unknown, |(theme, _)| *theme)
    }
}

fn point(attributes: &Attributes<'_>, theme: Theme) -> Option<Arc<str>> {
    let word = |key: &str| attributes.word(&[key]);
    let own = word("element").filter(|e| e != "feature" && e != "intersection");
    let kind = match (word("natural").as_deref(), word("highway").as_deref()) {
        (Some("tree"), _) => Some("tree".to_owned()),
        (_, Some("street_lamp")) => Some("lamp".to_owned()),
        _ => own.or_else(|| word("kind")).or_else(|| word("leisure")).or_else(|| word("amenity")),
    };
    let by_theme = || match theme {
        Theme::Trees => Some("tree".to_owned()),
        Theme::Lamps => Some("lamp".to_owned()),
        _ => None,
    };
    // Junctions and the like of a street layer are no things that stand there.
    if theme == Theme::Other {
        return None;
    }
    kind.or_else(by_theme).map(Arc::from)
}
