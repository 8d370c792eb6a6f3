//! What travels with a city, as keys and values.

use std::collections::BTreeMap;

use exurb_city::{City, Metadata};
use exurb_geom::{Frame, LonLat};

/// Version of the program, in every file.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Key of the frame: longitude and latitude of the city's origin.
pub const FRAME: &str = "exurb_frame";

/// Key of the height up to which the terrain is under water, where one is set.
pub const WATER_LEVEL: &str = "exurb_water_level";

/// The entries of a city, in order; GeoJSON holds the same keys as foreign members.
///
/// `exurb_attribution` has one line for each attribution; `exurb_gates` is a JSON object of
/// numbers; `exurb_frame` is `longitude latitude` of the origin; `exurb_buildings_complete` is
/// `yes` or `no`.
pub fn entries(city: &City) -> [(&'static str, String); 7] {
    let metadata = &city.metadata;
    let gates: BTreeMap<&str, f64> = metadata
        .example_gates
        .iter()
        .filter(|(_, value)| value.is_finite())
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    let gates = serde_json::to_string(&gates).expect("finite numbers by name are JSON");
    let LonLat { lon, lat } = city.frame.origin();
    let complete = if metadata.buildings_complete { "yes" } else { "no" };
    [
        ("exurb_version", VERSION.to_owned()),
        (FRAME, format!("{lon:.7} {lat:.7}")),
        ("exurb_name", metadata.name.to_string()),
        ("exurb_attribution", metadata.attribution.join("\n")),
        ("exurb_recipe", metadata.recipe.clone()),
        ("exurb_gates", gates),
        ("exurb_buildings_complete", complete.to_owned()),
    ]
}

/// The frame and the metadata of entries by key; `None` when there is no frame, and so no city.
pub fn read(mut value: impl FnMut(&str) -> Option<String>) -> Option<(Frame, Metadata)> {
    let origin = value(FRAME)?;
    let mut numbers = origin.split_whitespace().map(|n| n.parse().ok());
    let (lon, lat) = (numbers.next()??, numbers.next()??);
    let frame = Frame::new(LonLat { lon, lat }).ok()?;
    let mut text = |key| value(key).unwrap_or_default();
    let gates: BTreeMap<String, f64> =
        serde_json::from_str(&text("exurb_gates")).unwrap_or_default();
    let metadata = Metadata {
        name: text("exurb_name").into(),
        attribution: text("exurb_attribution").lines().map(str::to_owned).collect(),
        recipe: text("exurb_recipe"),
        example_gates: gates,
        buildings_complete: text("exurb_buildings_complete") == "yes",
    };
    Some((frame, metadata))
}
