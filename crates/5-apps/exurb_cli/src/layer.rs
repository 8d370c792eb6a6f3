//! One layer of a city alone.

use std::sync::Arc;

use exurb_city::City;

use crate::problem::Problem;

/// The layers that can be written alone.
const LAYERS: [&str; 8] =
    ["streets", "blocks", "parcels", "buildings", "features", "water", "land_use", TERRAIN];
/// The layer that is a raster.
pub const TERRAIN: &str = "terrain";

/// Is there a layer of that name?
pub fn check(name: &str) -> Result<(), Problem> {
    if LAYERS.contains(&name) {
        return Ok(());
    }
    Err(Problem::usage(format!("there is no layer `{name}`; there are {}", LAYERS.join(", "))))
}

/// The city with every other layer empty.
pub fn alone(city: &City, name: &str) -> Result<City, Problem> {
    check(name)?;
    let mut alone = City::empty(city.frame.clone(), city.target.clone());
    alone.metadata = city.metadata.clone();
    match name {
        "streets" => {
            alone.streets = Arc::clone(&city.streets);
            alone.other_ways = Arc::clone(&city.other_ways);
        }
        "blocks" => alone.blocks = Arc::clone(&city.blocks),
        "parcels" => alone.parcels = Arc::clone(&city.parcels),
        "buildings" => alone.buildings = Arc::clone(&city.buildings),
        "features" => alone.features = Arc::clone(&city.features),
        TERRAIN => alone.terrain = city.terrain.clone(),
        "water" => alone.water = Arc::clone(&city.water),
        _ => alone.land_use = Arc::clone(&city.land_use),
    }
    Ok(alone)
}
