//! From what a reader delivers to a city: cut, derive, close.

use std::sync::Arc;

use exurb_geom::{Bounds, Frame, GridPoint, LonLat, Polygon};

use crate::street_graph::{self, Derive};
use crate::{Area, Building, City, Feature, Metadata, Parcel, Role, StreetMap};

/// What a reader delivers, in the local frame.
#[derive(Clone, Debug)]
pub struct Draft {
    /// The local frame.
    pub frame: Frame,
    /// Where the data are complete, as the file declares it; `None` when it does not.
    pub extent: Option<Polygon>,
    /// Streets of every role.
    pub streets: StreetMap,
    /// Ends where a street breaks off because the file lacks its next node: no dead ends.
    pub broken_ends: Vec<GridPoint>,
    /// Buildings and parts.
    pub buildings: Vec<Building>,
    /// Parcels.
    pub parcels: Vec<Parcel>,
    /// Trees, lamps and the like.
    pub features: Vec<Feature>,
    /// Water.
    pub water: Vec<Area>,
    /// Land use.
    pub land_use: Vec<Area>,
    /// What travels with the city.
    pub metadata: Metadata,
}

/// What of a file becomes the city.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportOptions {
    /// South-west and north-east corner of the part to keep.
    pub bbox: Option<[LonLat; 2]>,
    /// Half of the densest 5 km square (of the whole extent if smaller).
    pub part: Option<Part>,
    /// Let service roads and the like count as streets.
    pub with_other: bool,
}

/// A half of the densest square, for training and test parts of one city.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Part {
    West,
    East,
    North,
    South,
}

/// A city and what a user should know about how it was read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The city.
    pub city: City,
    /// One sentence each.
    pub warnings: Vec<String>,
}

/// Why a draft is no city.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum DraftError {
    /// There is nothing in the part to keep.
    #[error("nothing lies inside {0}; choose another part of the map")]
    Empty(String),
}

impl Draft {
    /// An empty draft in a frame.
    pub fn new(frame: Frame) -> Self {
        Self {
            frame,
            extent: None,
            streets: StreetMap::default(),
            broken_ends: Vec::new(),
            buildings: Vec::new(),
            parcels: Vec::new(),
            features: Vec::new(),
            water: Vec::new(),
            land_use: Vec::new(),
            metadata: Metadata::default(),
        }
    }

    /// The city of this draft.
    pub fn assemble(self, options: &ImportOptions) -> Result<Imported, DraftError> {
        let target = match (&options.bbox, &self.extent) {
            (Some([sw, ne]), _) => {
                let corner = |p: &LonLat| self.frame.project_to_grid(*p).unwrap_or_default();
                Polygon::rectangle(corner(sw), corner(ne))
            }
            (None, Some(extent)) => extent.clone(),
            (None, None) => {
                let streets = self.streets.ways.iter().flat_map(|w| w.line.iter().copied());
                let bounds = Bounds::of(streets)
                    .ok_or_else(|| DraftError::Empty("the file".to_owned()))?;
                Polygon::rectangle(GridPoint::round(bounds.min), GridPoint::round(bounds.max))
            }
        };
        let derive = Derive { with_other: options.with_other, area: Some(target.clone()) };
        let streets = street_graph::derive(&self.streets, &derive);
        let mut city = City::empty(self.frame, target);
        city.streets = Arc::new(streets);
        city.other_ways = Arc::new(
            self.streets
                .ways
                .into_iter()
                .filter(|w| !options.with_other && w.street.role() == Role::Other)
                .collect(),
        );
        city.buildings = Arc::new(self.buildings);
        city.parcels = Arc::new(self.parcels);
        city.features = Arc::new(self.features);
        city.water = Arc::new(self.water);
        city.land_use = Arc::new(self.land_use);
        city.metadata = self.metadata;
        city.blocks = Arc::new(crate::block::derive(&city.streets));
        Ok(Imported { city, warnings: Vec::new() })
    }
}
