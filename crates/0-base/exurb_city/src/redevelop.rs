//! New streets in a part of a city: what stands elsewhere stays.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Polygon, Vec2};

use crate::{Block, City, Edit, FeatureShape, StreetGraph, block, placing};

/// The edit that gives `city` these streets, which differ from its own inside `area` only. Blocks that
/// are the same afterwards keep what they are and their parcels; buildings and features outside `area`
/// stay; what lay inside goes.
pub fn redevelop(city: &City, streets: StreetGraph, area: &Polygon) -> Edit {
    let key =
        |block: &Block| (block.polygon.exterior().to_vec(), block.polygon.interiors().to_vec());
    let before: BTreeMap<_, &Block> = city.blocks.iter().map(|b| (key(b), b)).collect();
    let mut blocks = block::derive(&streets);
    let mut unchanged: BTreeMap<u32, u32> = BTreeMap::new();
    for block in &mut blocks {
        if let Some(old) = before.get(&key(block)) {
            unchanged.insert(old.id, block.id);
            block.land_use.clone_from(&old.land_use);
            block.pavement_m = old.pavement_m;
            block.provenance = old.provenance.clone();
        }
    }
    let is_outside = |p: Vec2| !area.contains(GridPoint::round(p));
    let mut parcels: Vec<_> =
        city.parcels.iter().filter(|p| unchanged.contains_key(&p.block)).cloned().collect();
    let mut buildings: Vec<_> =
        city.buildings.iter().filter(|b| is_outside(b.polygon.interior_point())).cloned().collect();
    let mut features: Vec<_> = city
        .features
        .iter()
        .filter(|feature| {
            is_outside(match &feature.shape {
                FeatureShape::Point(p) => p.to_m(),
                FeatureShape::Line(line) => line.first().map_or(Vec2::ZERO, |p| p.to_m()),
                FeatureShape::Polygon(polygon) => polygon.interior_point(),
            })
        })
        .cloned()
        .collect();
    placing::place(&blocks, &mut parcels, &mut buildings, &mut features);
    Edit {
        streets: Some(streets),
        blocks: Some(blocks),
        parcels: Some(parcels),
        buildings: Some(buildings),
        features: Some(features),
        ..Edit::default()
    }
}
