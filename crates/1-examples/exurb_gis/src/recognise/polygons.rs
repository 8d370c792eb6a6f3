//! Polygons that are buildings, parcels, water or land.

use std::sync::Arc;

use exurb_city::Roof;

use super::{Attributes, Kind, Theme, Walls};

/// A building, a parcel, water or a land use; `None` for any other polygon.
pub fn polygon(attributes: &Attributes<'_>, theme: Theme) -> Option<Kind> {
    match attributes.word(&["element"]).as_deref() {
        // Derived from the streets and given by the user.
        Some("block" | "target") => None,
        Some("building") => Some(Kind::Building(walls(attributes))),
        Some("parcel") => Some(Kind::Parcel(zoning(attributes))),
        Some("water") => Some(Kind::Water(water_class(attributes))),
        Some("land_use") => attributes.word(&["class"]).map(|class| Kind::LandUse(class.into())),
        _ => tagged(attributes).or_else(|| {
            let is_street = attributes.get(&["highway"]).is_some();
            if is_street { None } else { untagged(attributes, theme) }
        }),
    }
}

/// A polygon that says by OSM's tags what it is.
fn tagged(attributes: &Attributes<'_>) -> Option<Kind> {
    let is = |key: &str| attributes.word(&[key]).is_some_and(|value| value != "no");
    if is("building") || is("building:part") {
        return Some(Kind::Building(walls(attributes)));
    }
    let natural = attributes.word(&["natural"]);
    if is("water") || is("waterway") || natural.as_deref() == Some("water") {
        return Some(Kind::Water(water_class(attributes)));
    }
    let use_of_land = attributes.word(&["landuse", "leisure", "natural"]);
    use_of_land.map(|class| Kind::LandUse(class.into()))
}

/// A polygon that is what its layer or file is called, else what its columns suggest.
fn untagged(attributes: &Attributes<'_>, theme: Theme) -> Option<Kind> {
    let zone = zoning(attributes);
    let class = || attributes.word(&["fclass", "class", "type"]).map(Arc::from);
    match theme {
        Theme::Buildings => Some(Kind::Building(walls(attributes))),
        Theme::Parcels => Some(Kind::Parcel(zone)),
        Theme::Water => Some(Kind::Water(class().unwrap_or_else(|| "water".into()))),
        Theme::LandUse => {
            Some(Kind::LandUse(zone.or_else(class).unwrap_or_else(|| "unknown".into())))
        }
        Theme::Other => None,
        _ if attributes.get(&HEIGHT).or(attributes.get(&LEVELS)).is_some() => {
            Some(Kind::Building(walls(attributes)))
        }
        _ => zone.map(|zone| Kind::Parcel(Some(zone))),
    }
}

fn water_class(attributes: &Attributes<'_>) -> Arc<str> {
    let words = ["water", "waterway", "class"].iter().filter_map(|key| attributes.word(&[key]));
    words.into_iter().find(|word| word != "yes").map_or_else(|| "water".into(), Arc::from)
}

const HEIGHT: [&str; 6] =
    ["height", "hauteur", "building_height", "measuredheight", "height_m", "hoehe"];
const LEVELS: [&str; 6] =
    ["building:levels", "levels", "nb_etages", "num_floors", "storeys", "building_levels"];

fn walls(attributes: &Attributes<'_>) -> Walls {
    let usage = ["building", "building:part", "use", "usage", "fonction", "fclass", "type"];
    let usage = usage.iter().find_map(|key| attributes.word(&[key]).filter(|v| v != "yes"));
    let general = ["shop", "amenity", "office"].iter().find_map(|key| attributes.word(&[key]));
    let roof = attributes.word(&["roof:shape", "roof_shape", "roof"]);
    Walls {
        height_m: attributes.positive(&HEIGHT),
        min_height_m: attributes.positive(&["min_height"]).unwrap_or(0.0),
        levels: attributes.positive(&LEVELS),
        roof: roof.and_then(|r| Roof::parse(&r)),
        usage: usage.or(general).map(Arc::from),
        is_part: attributes.get(&["building:part"]).is_some()
            && attributes.get(&["building"]).is_none(),
    }
}

/// Zoning of a parcel or a zone, in OSM's words where the code is a known one: zones of French
/// plans are `U` (built), `AU` (to be built), `A` (farmed) and `N` (natural).
fn zoning(attributes: &Attributes<'_>) -> Option<Arc<str>> {
    let columns =
        ["zoning", "zone", "typezone", "land_use", "landuse", "zonage", "class", "libelle"];
    let word = attributes.word(&columns)?;
    let french = attributes.get(&["typezone"]).is_some();
    Some(match word.as_str() {
        "u" if french => "residential".into(),
        "a" | "ah" if french => "farmland".into(),
        "n" | "nh" if french => "nature_reserve".into(),
        au if french && au.starts_with("au") => "greenfield".into(),
        _ => word.into(),
    })
}
