use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_geom::{Frame, Polygon};

use crate::{Area, Block, Building, Feature, Parcel, StreetGraph, Terrain, Way};

/// A city: one document, imported or synthesised.
#[derive(Clone, Debug)]
pub struct City {
    /// The local frame of all coordinates.
    pub frame: Frame,
    /// The modelled area: the target of a synthesis, the extent of an imported map. Streets may run
    /// past it; nodes beyond it are cut ends.
    pub target: Polygon,
    /// Streets that count: main and local roles (and service roads where asked for).
    pub streets: Arc<StreetGraph>,
    /// Streets of role other, as they were imported: drawn and exported, never learned.
    pub other_ways: Arc<Vec<Way>>,
    /// Blocks.
    pub blocks: Arc<Vec<Block>>,
    /// Parcels.
    pub parcels: Arc<Vec<Parcel>>,
    /// Buildings and parts of buildings.
    pub buildings: Arc<Vec<Building>>,
    /// Trees, lamps and the like.
    pub features: Arc<Vec<Feature>>,
    /// Water.
    pub water: Arc<Vec<Area>>,
    /// Land use.
    pub land_use: Arc<Vec<Area>>,
    /// The ground; flat at height 0 without one.
    pub terrain: Option<Arc<Terrain>>,
    /// What travels with the city.
    pub metadata: Metadata,
}

/// What travels with a city into every file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// A short name, usually the stem of the file it came from; the `source` of what is copied.
    pub name: Arc<str>,
    /// Attributions of the data it was made from, without doubles, in order of use.
    pub attribution: Vec<String>,
    /// The recipe that made it, as TOML; empty for an import.
    pub recipe: String,
    /// The example's values of the likeness gates; empty for an import.
    pub example_gates: BTreeMap<String, f64>,
    /// Are the buildings complete enough to learn coverage and empty parcels from?
    pub buildings_complete: bool,
}

impl Metadata {
    /// Adds attributions that are not there yet.
    pub fn credit<'a>(&mut self, attributions: impl IntoIterator<Item = &'a String>) {
        for attribution in attributions {
            if !self.attribution.contains(attribution) {
                self.attribution.push(attribution.clone());
            }
        }
    }
}

impl City {
    /// An empty city over `target`.
    pub fn empty(frame: Frame, target: Polygon) -> Self {
        Self {
            frame,
            target,
            streets: Arc::default(),
            other_ways: Arc::default(),
            blocks: Arc::default(),
            parcels: Arc::default(),
            buildings: Arc::default(),
            features: Arc::default(),
            water: Arc::default(),
            land_use: Arc::default(),
            terrain: None,
            metadata: Metadata::default(),
        }
    }

    /// Area of the target in km².
    pub fn area_km2(&self) -> f64 {
        self.target.area_m2() / 1e6
    }
}
