//! Lines that are streets, and what is known of them.

use std::sync::Arc;

use exurb_city::{Class, Street};

use super::{Attributes, Kind, Theme};

const CLASS_COLUMNS: [&str; 6] = ["highway", "class", "fclass", "road_class", "type", "importance"];

/// A street or a row of trees; `None` for any other line.
pub fn line(attributes: &Attributes<'_>, theme: Theme) -> Option<Kind> {
    if attributes.word(&["natural", "kind"]).as_deref() == Some("tree_row") {
        return Some(Kind::Feature("tree_row".into()));
    }
    if !may_be_a_street(attributes, theme) {
        return None;
    }
    let class = class(attributes)?;
    let (oneway, backward) = direction(attributes);
    let layer = attributes.get(&["layer"]).and_then(|v| v.real()).unwrap_or(0.0);
    let nature = attributes.word(&["nature"]).unwrap_or_default();
    let roundabout =
        attributes.word(&["junction"]).is_some_and(|j| j == "roundabout") || nature == "rond-point";
    let street = Street {
        class,
        lanes: attributes.positive(&["lanes", "nb_voies"]).map_or(0, |n| n.min(60.0) as u8),
        width_m: attributes
            .positive(&["width", "largeur", "width_m"])
            .map_or(0.0, |w| w.min(200.0)),
        oneway: oneway || roundabout,
        bridge: attributes.flag(&["bridge"]),
        tunnel: attributes.flag(&["tunnel"]),
        layer: layer.clamp(-9.0, 9.0) as i8,
        roundabout,
        name: attributes.text(&["name", "nom", "street_name", "nom_voie"]).map(Arc::from),
        ..Street::default()
    };
    Some(Kind::Street { street, backward })
}

/// Keys of OSM whose lines are something else.
const OTHER_LINES: [&str; 14] = [
    "waterway",
    "railway",
    "power",
    "barrier",
    "natural",
    "aeroway",
    "aerialway",
    "boundary",
    "man_made",
    "route",
    "landuse",
    "leisure",
    "building",
    "amenity",
];

/// Has the line a class, or nothing that speaks against a street? Where a file has a column for
/// `highway`, a line that leaves it empty is something else.
fn may_be_a_street(attributes: &Attributes<'_>, theme: Theme) -> bool {
    if attributes.get(&["highway"]).is_some() {
        return true;
    }
    attributes.get(&OTHER_LINES).is_none()
        && matches!(theme, Theme::Streets | Theme::Unknown)
        && (!attributes.has("highway") || attributes.get(&CLASS_COLUMNS).is_some())
}

/// The class of a line; `None` for paths and what is no street. Lines that do not tell are
/// residential streets.
fn class(attributes: &Attributes<'_>) -> Option<Class> {
    if let Some(nature) = attributes.word(&["nature"]) {
        return class_of_bd_topo(&nature, attributes);
    }
    let names = attributes.words(&CLASS_COLUMNS);
    let is_osm = attributes.get(&["highway"]).is_some();
    match names.iter().find_map(|name| Class::parse(name)) {
        Some(class) => Some(class),
        None if is_osm => None,
        None if names.iter().any(|name| NO_STREETS.contains(&name.as_str())) => None,
        None => Some(Class::Residential),
    }
}

/// Values of class columns after OSM that are no streets.
const NO_STREETS: [&str; 14] = [
    "footway",
    "path",
    "cycleway",
    "steps",
    "track",
    "track_grade1",
    "track_grade2",
    "track_grade3",
    "track_grade4",
    "track_grade5",
    "bridleway",
    "corridor",
    "sidewalk",
    "crosswalk",
];

/// IGN's BD TOPO: `NATURE` names the kind of road, `IMPORTANCE` its rank from 1 (national) to 5.
fn class_of_bd_topo(nature: &str, attributes: &Attributes<'_>) -> Option<Class> {
    let no_street = ["sentier", "chemin", "escalier", "piste cyclable", "bac", "arete"];
    if no_street.iter().any(|word| nature.starts_with(word)) {
        return None;
    }
    if nature.contains("autorouti") || nature == "autoroute" {
        return Some(Class::Motorway);
    }
    if nature == "quasi-autoroute" {
        return Some(Class::Trunk);
    }
    if nature.contains("empierr") {
        return Some(Class::Service);
    }
    let rank = attributes.get(&["importance"]).and_then(|v| v.integer::<i64>());
    let (street, link) = match rank {
        Some(1) => (Class::Primary, Class::PrimaryLink),
        Some(2) => (Class::Secondary, Class::SecondaryLink),
        Some(3) => (Class::Tertiary, Class::TertiaryLink),
        Some(4) => (Class::Unclassified, Class::Unclassified),
        _ => (Class::Residential, Class::Residential),
    };
    Some(if nature == "bretelle" { link } else { street })
}

/// Driven one way only, and against the line?
fn direction(attributes: &Attributes<'_>) -> (bool, bool) {
    let Some(word) = attributes.word(&["oneway", "one_way", "sens"]) else { return (false, false) };
    match word.as_str() {
        // Geofabrik's F, T, B; BD TOPO's `sens`.
        "-1" | "reverse" | "t" | "tf" | "inverse" | "sens inverse" => (true, true),
        "yes" | "true" | "1" | "f" | "ft" | "direct" | "sens direct" | "unique" => (true, false),
        _ => (false, false),
    }
}
