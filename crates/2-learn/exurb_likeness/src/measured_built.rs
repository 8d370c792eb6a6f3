//! Measures of buildings and parcels of one window of a city.

use exurb_city::City;
use exurb_geom::{Bounds, trig};
use exurb_measure::block_shapes::BlockShape;
use exurb_measure::{Sample, buildings, built_blocks, parcels};

/// Heights known of fewer buildings than this share tell of what mappers care for, not of the city.
const LEAST_KNOWN: f64 = 0.1;

/// Samples by name; nothing of what the city lacks. `blocks` are those of the window's network.
pub fn samples(city: &City, blocks: &[BlockShape], window: Bounds) -> Vec<(&'static str, Sample)> {
    let mut out = Vec::new();
    if city.buildings.iter().any(|b| !b.is_part) {
        out.extend(of_buildings(city, blocks, window));
    }
    if !city.parcels.is_empty() {
        out.extend(of_parcels(city, window));
    }
    out
}

fn of_buildings(
    city: &City,
    blocks: &[BlockShape],
    window: Bounds,
) -> [(&'static str, Sample); 13] {
    let shapes = buildings::shapes(city, window);
    let of = |value: &dyn Fn(&buildings::Shape) -> Option<f64>| buildings::sample(&shapes, value);
    let heights = of(&|s| s.height_m);
    let known = heights.len() as f64 >= LEAST_KNOWN * shapes.len() as f64;
    let built = built_blocks::built_blocks(city, blocks, &shapes, window);
    [
        ("b_area", of(&|s| Some(trig::log10(s.area_m2)))),
        ("b_elongation", of(&|s| Some(s.elongation))),
        ("b_rectangularity", of(&|s| Some(s.rectangularity))),
        ("b_corners", of(&|s| Some(s.corners as f64))),
        ("b_setback", of(&|s| Some(s.setback_m))),
        ("b_street_alignment", of(&|s| s.street_alignment)),
        ("b_nearest_building", of(&|s| Some(s.gap_m))),
        ("b_height", if known { heights } else { Sample::default() }),
        ("blk_coverage_gsi", built.coverage),
        ("blk_buildings_per_ha", built.buildings_per_ha),
        ("blk_far_fsi", built.floor_space),
        ("blk_corners_built", built.corners_built),
        ("blk_setback_variation", built.setback_variation),
    ]
}

fn of_parcels(city: &City, window: Bounds) -> [(&'static str, Sample); 6] {
    let parcels = parcels::parcels(city, window);
    let area = parcels.area.values().iter().map(|m2| trig::log10(*m2));
    [
        ("parcel_area", Sample::plain(area)),
        ("parcel_frontage", parcels.frontage),
        ("parcel_depth_ratio", parcels.depth_ratio),
        ("parcel_rectangularity", parcels.rectangularity),
        ("parcel_buildings", parcels.buildings),
        ("parcel_front_setback", parcels.front_setback),
    ]
}
