//! One layer of a city alone.

use std::sync::Arc;

use exurb_city::City;
use exurb_gis::Streets;

use crate::format::Format;
use crate::problem::Problem;

/// The layers that can be written alone.
const LAYERS: [&str; 9] = [
    "streets",
    "intersections",
    "blocks",
    "parcels",
    "buildings",
    "features",
    "water",
    "land_use",
    TERRAIN,
];
/// The layer that is a raster.
pub const TERRAIN: &str = "terrain";

/// Is there a layer of that name, and has it a place in the format?
pub fn check(name: &str, format: Format) -> Result<(), Problem> {
    if !LAYERS.contains(&name) {
        let known = LAYERS.join(", ");
        return Err(Problem::usage(format!("there is no layer `{name}`; there are {known}")));
    }
    if format == Format::GeoTiff && name != TERRAIN {
        return Err(Problem::usage("GeoTIFF takes the layer terrain alone"));
    }
    if name == "intersections" && !matches!(format, Format::GeoPackage | Format::GeoJson) {
        let message = "intersections alone are written as .gpkg or .geojson";
        return Err(Problem::usage(message));
    }
    Ok(())
}

/// What of the street graph belongs to the layer.
pub fn streets(name: Option<&str>) -> Streets {
    if name == Some("intersections") { Streets::INTERSECTIONS } else { Streets::ALL }
}

/// The city with every other layer empty.
pub fn alone(city: &City, name: &str) -> City {
    let mut alone = City::empty(city.frame.clone(), city.target.clone());
    alone.metadata = city.metadata.clone();
    match name {
        // Streets come with their intersections: without them they would be no graph.
        "streets" => {
            alone.streets = Arc::clone(&city.streets);
            alone.other_ways = Arc::clone(&city.other_ways);
        }
        "intersections" => alone.streets = Arc::clone(&city.streets),
        "blocks" => alone.blocks = Arc::clone(&city.blocks),
        "parcels" => alone.parcels = Arc::clone(&city.parcels),
        "buildings" => alone.buildings = Arc::clone(&city.buildings),
        "features" => alone.features = Arc::clone(&city.features),
        TERRAIN => alone.terrain = city.terrain.clone(),
        "water" => alone.water = Arc::clone(&city.water),
        _ => alone.land_use = Arc::clone(&city.land_use),
    }
    alone
}
