use std::sync::Arc;

use crate::{Area, Block, Building, City, Feature, Parcel, StreetGraph, terrain};

/// What an operation changes: whole layers, each shared with whoever made it. Layers that are
/// `None` stay as they are, and stay shared with the city before.
#[derive(Clone, Debug, Default)]
pub struct Edit {
    /// New streets.
    pub streets: Option<StreetGraph>,
    /// New blocks.
    pub blocks: Option<Vec<Block>>,
    /// New parcels.
    pub parcels: Option<Vec<Parcel>>,
    /// New buildings.
    pub buildings: Option<Vec<Building>>,
    /// New features.
    pub features: Option<Vec<Feature>>,
    /// New land use.
    pub land_use: Option<Vec<Area>>,
    /// Attributions to add.
    pub attribution: Vec<String>,
    /// Values of the likeness gates of the examples, to keep in the metadata.
    pub example_gates: Option<std::collections::BTreeMap<String, f64>>,
}

impl Edit {
    /// The next city. New junctions of height 0 get the terrain's. What hangs on a replaced layer and is not replaced with it goes: new streets
    /// drop blocks, parcels and buildings; new blocks drop parcels and buildings; new parcels drop
    /// nothing.
    pub fn apply(self, city: &City) -> City {
        let mut next = city.clone();
        if let Some(mut streets) = self.streets {
            if let Some(terrain) = &city.terrain {
                terrain::elevate(&mut streets, terrain);
            }
            next.streets = Arc::new(streets);
            (next.blocks, next.parcels, next.buildings) = Default::default();
            next.features = Arc::default();
        }
        if let Some(blocks) = self.blocks {
            next.blocks = Arc::new(blocks);
            (next.parcels, next.buildings) = Default::default();
        }
        if let Some(parcels) = self.parcels {
            next.parcels = Arc::new(parcels);
        }
        if let Some(buildings) = self.buildings {
            next.buildings = Arc::new(buildings);
        }
        if let Some(features) = self.features {
            next.features = Arc::new(features);
        }
        if let Some(land_use) = self.land_use {
            next.land_use = Arc::new(land_use);
        }
        next.metadata.credit(&self.attribution);
        if let Some(gates) = self.example_gates {
            next.metadata.example_gates = gates;
        }
        next
    }
}
