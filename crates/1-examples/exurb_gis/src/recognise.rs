//! What a row of somebody else's file is, by its geometry, its columns and the name of its
//! layer: the table in the crate's documentation.

use std::borrow::Cow;
use std::sync::Arc;

use exurb_city::{Class, Roof, Street};

use crate::geometry::Geometry;
use crate::value::Value;

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

/// The columns of a row, by lower-case name.
#[derive(Debug, Default)]
pub struct Attributes<'a>(Vec<(Cow<'a, str>, Value<'a>)>);

impl<'a> Attributes<'a> {
    /// Of names and values.
    pub fn new(columns: impl IntoIterator<Item = (Cow<'a, str>, Value<'a>)>) -> Self {
        Self(columns.into_iter().filter(|(_, value)| !value.is_null()).collect())
    }

    /// The first known value among the columns of these names.
    fn get(&self, names: &[&str]) -> Option<&Value<'a>> {
        names.iter().find_map(|name| {
            self.0.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, value)| value)
        })
    }

    fn text(&self, names: &[&str]) -> Option<String> {
        Some(self.get(names)?.text()?.trim().to_owned()).filter(|t| !t.is_empty())
    }

    /// A text in lower case, as classes are written.
    fn word(&self, names: &[&str]) -> Option<String> {
        self.text(names).map(|t| t.to_lowercase())
    }

    fn positive(&self, names: &[&str]) -> Option<f64> {
        self.get(names)?.real().filter(|n| *n > 0.0)
    }

    fn flag(&self, names: &[&str]) -> bool {
        // OSM has `bridge=viaduct` and the like: whatever is not a no is a yes.
        self.get(names).is_some_and(|value| value.flag().unwrap_or(true))
    }
}

/// What the row is; `None` when exurb has no place for it. `hint` is the name of its layer or file.
pub fn recognise(geometry: &Geometry, attributes: &Attributes<'_>, hint: &str) -> Option<Kind> {
    let theme = Theme::of(hint);
    match simple(geometry)? {
        Geometry::Point(_) => point(attributes, theme).map(Kind::Feature),
        Geometry::Line(_) => line(attributes, theme),
        _ => polygon(attributes, theme),
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

const CLASS_COLUMNS: [&str; 6] = ["highway", "class", "fclass", "road_class", "type", "importance"];

fn line(attributes: &Attributes<'_>, theme: Theme) -> Option<Kind> {
    if attributes.word(&["natural", "kind"]).as_deref() == Some("tree_row") {
        return Some(Kind::Feature("tree_row".into()));
    }
    let highway = attributes.get(&["highway"]).is_some();
    if !highway {
        let other = ["waterway", "railway", "power", "barrier", "natural", "aeroway", "boundary"];
        if attributes.get(&other).is_some() || !matches!(theme, Theme::Streets | Theme::Unknown) {
            return None;
        }
    }
    let class = class(attributes)?;
    let (oneway, backward) = direction(attributes);
    let layer = attributes.get(&["layer"]).and_then(Value::real).unwrap_or(0.0);
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

/// The class of a line; `None` for paths and what is no street. Lines that do not tell are
/// residential streets.
fn class(attributes: &Attributes<'_>) -> Option<Class> {
    if let Some(nature) = attributes.word(&["nature"]) {
        return class_of_bd_topo(&nature, attributes);
    }
    let Some(name) = CLASS_COLUMNS.iter().find_map(|column| attributes.word(&[column])) else {
        return Some(Class::Residential);
    };
    let is_osm = attributes.get(&["highway"]).is_some();
    match Class::parse(&name) {
        Some(class) => Some(class),
        None if is_osm || NO_STREETS.contains(&name.as_str()) => None,
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
    let rank = attributes.get(&["importance"]).and_then(Value::integer::<i64>);
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

fn polygon(attributes: &Attributes<'_>, theme: Theme) -> Option<Kind> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn row(columns: &[(&'static str, &'static str)]) -> Attributes<'static> {
        Attributes::new(columns.iter().map(|(k, v)| (Cow::Borrowed(*k), Value::from(*v))))
    }

    fn line(columns: &[(&'static str, &'static str)], hint: &str) -> Option<Street> {
        match recognise(&Geometry::Line(vec![]), &row(columns), hint) {
            Some(Kind::Street { street, .. }) => Some(street),
            _ => None,
        }
    }

    fn area(columns: &[(&'static str, &'static str)], hint: &str) -> Option<Kind> {
        recognise(&Geometry::Polygon(vec![]), &row(columns), hint)
    }

    #[test]
    fn untagged_lines_are_residential_streets_and_rivers_are_none() {
        assert_eq!(line(&[], "anything").map(|s| s.class), Some(Class::Residential));
        assert_eq!(line(&[], "rivers"), None);
        assert_eq!(line(&[("waterway", "river")], "lines"), None);
        assert_eq!(line(&[("highway", "footway")], "streets"), None);
        assert_eq!(
            line(&[("fclass", "primary")], "gis_roads").map(|s| s.class),
            Some(Class::Primary)
        );
    }

    #[test]
    fn roads_of_a_national_map() {
        let road = [("NATURE", "Route à 2 chaussées"), ("IMPORTANCE", "2"), ("LARGEUR", "7,5")];
        let road = line(&road, "roads").expect("a street");
        assert_eq!((road.class, road.width_m), (Class::Secondary, 7.5));
        assert_eq!(line(&[("NATURE", "Sentier")], "roads"), None);
    }

    #[test]
    fn polygons_by_columns_first_and_names_second() {
        assert!(matches!(area(&[("building", "yes")], "parcels"), Some(Kind::Building(_))));
        assert!(
            matches!(area(&[("HAUTEUR", "7")], "layer"), Some(Kind::Building(w)) if w.height_m == Some(7.0))
        );
        assert_eq!(area(&[], "cz_plots"), Some(Kind::Parcel(None)));
        assert_eq!(area(&[("zoning", "R1")], "layer"), Some(Kind::Parcel(Some("r1".into()))));
        assert_eq!(
            area(&[("TYPEZONE", "N")], "town_zoning"),
            Some(Kind::LandUse("nature_reserve".into()))
        );
        assert_eq!(area(&[("natural", "water")], "x"), Some(Kind::Water("water".into())));
        assert_eq!(area(&[], "layer"), None);
        assert_eq!(area(&[], "tessellation"), None);
        assert!(matches!(area(&[("building", "house")], "blocks"), Some(Kind::Building(_))));
    }
}
