//! Water, land use and parcels by their tags.

use exurb_city::{Origin, Parcel, Provenance};
use exurb_geom::Polygon;

use crate::tags::Tags;

/// Values of `natural` that are land use.
const NATURAL: [&str; 13] = [
    "bare_rock",
    "beach",
    "fell",
    "grassland",
    "heath",
    "mud",
    "sand",
    "scree",
    "scrub",
    "shingle",
    "tree_group",
    "wetland",
    "wood",
];

/// Values of `leisure` that are land use.
const LEISURE: [&str; 12] = [
    "common",
    "dog_park",
    "garden",
    "golf_course",
    "marina",
    "nature_reserve",
    "park",
    "pitch",
    "recreation_ground",
    "sports_centre",
    "stadium",
    "track",
];

/// The class of a water area: the value of `water` where given, else what kind of tag it has.
pub fn water(tags: &Tags) -> Option<&str> {
    let given = tags.get("water").filter(|v| !matches!(*v, "yes" | "no"));
    let kind = match (tags.get("natural"), tags.get("landuse"), tags.get("waterway")) {
        (Some("water"), ..) => "water",
        (_, Some(kind @ ("reservoir" | "basin")), _) => kind,
        (.., Some("riverbank")) => "river",
        (.., Some("dock")) => "dock",
        // `water=*` alone stands for an area of water.
        (None, None, None) => given?,
        _ => return None,
    };
    Some(given.unwrap_or(kind))
}

/// The class of a land-use area.
pub fn land_use(tags: &Tags) -> Option<&str> {
    let leisure = tags.get("leisure").filter(|v| LEISURE.contains(v));
    let land_use =
        tags.get("landuse").filter(|v| !matches!(*v, "yes" | "no" | "reservoir" | "basin"));
    let natural = tags.get("natural").filter(|v| NATURAL.contains(v));
    leisure.or(land_use).or(natural)
}

/// Key and value that make a land-use area of that class.
pub fn land_use_tag(class: &str) -> (&'static str, &str) {
    match class {
        _ if LEISURE.contains(&class) && class != "recreation_ground" => ("leisure", class),
        _ if NATURAL.contains(&class) => ("natural", class),
        _ => ("landuse", class),
    }
}

/// Is it a lot?
pub fn is_parcel(tags: &Tags) -> bool {
    matches!(tags.get("boundary"), Some("lot" | "parcel" | "plot"))
        || tags.get("place") == Some("plot")
}

/// A lot of that outline.
pub fn parcel(tags: &Tags, polygon: Polygon) -> Parcel {
    Parcel {
        id: 0,
        block: 0,
        polygon,
        street_access: false,
        land_use: tags.get("zoning").or(tags.get("landuse")).map(Into::into),
        provenance: Provenance::of(Origin::Imported),
    }
}

/// Is it the middle line of a river, canal or stream above ground?
pub fn is_waterway(tags: &Tags) -> bool {
    waterway_width_m(tags).is_some() && !tags.says("tunnel")
}

/// Is it a piece of coast?
pub fn is_coastline(tags: &Tags) -> bool {
    tags.get("natural") == Some("coastline")
}

/// Width of a waterway by its tag, else by its class.
pub fn waterway_width_m(tags: &Tags) -> Option<f64> {
    let usual = match tags.get("waterway")? {
        "river" => 20.0,
        "canal" => 12.0,
        "stream" => 3.0,
        _ => return None,
    };
    let given = tags.get("width").or(tags.get("waterway:width")).and_then(crate::tags::length_m);
    Some(given.filter(|w| (0.5..=2000.0).contains(w)).unwrap_or(usual))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(list: &[(&str, &str)]) -> Tags {
        list.iter().copied().collect()
    }

    #[test]
    fn water_has_many_tags() {
        assert_eq!(water(&of(&[("natural", "water")])), Some("water"));
        assert_eq!(water(&of(&[("natural", "water"), ("water", "lake")])), Some("lake"));
        assert_eq!(water(&of(&[("waterway", "riverbank")])), Some("river"));
        assert_eq!(water(&of(&[("landuse", "basin")])), Some("basin"));
        assert_eq!(water(&of(&[("water", "pond")])), Some("pond"));
        assert_eq!(water(&of(&[("natural", "wood"), ("water", "pond")])), None);
        assert_eq!(water(&of(&[("waterway", "river")])), None);
    }

    #[test]
    fn land_use_comes_from_three_keys() {
        for class in ["park", "wood", "residential", "recreation_ground", "forest"] {
            let (key, value) = land_use_tag(class);
            assert_eq!(land_use(&of(&[(key, value)])), Some(class));
        }
        assert_eq!(land_use(&of(&[("leisure", "park"), ("landuse", "grass")])), Some("park"));
        assert_eq!(land_use(&of(&[("natural", "coastline")])), None);
    }

    #[test]
    fn waterways_have_widths() {
        assert_eq!(waterway_width_m(&of(&[("waterway", "river"), ("width", "55 m")])), Some(55.0));
        assert_eq!(waterway_width_m(&of(&[("waterway", "canal")])), Some(12.0));
        assert_eq!(waterway_width_m(&of(&[("waterway", "weir")])), None);
        assert!(!is_waterway(&of(&[("waterway", "stream"), ("tunnel", "culvert")])));
    }
}
