//! From what a reader delivers to a city: cut, derive, close.

use std::sync::Arc;

use exurb_geom::{Bounds, Frame, GridPoint, LonLat, Polygon, overlay};
use exurb_graph::NodeId;

use crate::hierarchy::{Hierarchy, assign_levels};
use crate::simplify::{self, Simplify};
use crate::street_graph::{self, Derive};
use crate::{Area, Building, City, Feature, Metadata, Origin, Parcel, Provenance, Role};
use crate::{StreetGraph, StreetMap, Terrain, completeness, cut, densest_square, facades, placing};

/// Terrain is kept this far around the target, where streets run on.
const AROUND_M: f64 = 200.0;

/// What a reader delivers, in the local frame.
#[derive(Clone, Debug)]
pub struct Draft {
    /// The local frame.
    pub frame: Frame,
    /// Where the data are complete, as the file declares it; `None` when it does not.
    pub extent: Option<Polygon>,
    /// What runs past the extent belongs to the city, too, as in files of our own: it is cut only
    /// where a part is asked for.
    pub runs_past: bool,
    /// Streets of every role.
    pub streets: StreetMap,
    /// Ends where a street breaks off because the file lacks its next node, or says that it runs
    /// on: no dead ends.
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
    /// The ground.
    pub terrain: Option<Arc<Terrain>>,
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
    /// Join dual carriageways into one street and shrink small roundabouts to junctions.
    pub simplify: bool,
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
    /// There is nothing at all.
    #[error("it holds no streets, buildings or areas that exurb knows")]
    Nothing,
}

impl Draft {
    /// An empty draft in a frame.
    pub fn new(frame: Frame) -> Self {
        Self {
            frame,
            extent: None,
            runs_past: false,
            streets: StreetMap::default(),
            broken_ends: Vec::new(),
            buildings: Vec::new(),
            parcels: Vec::new(),
            features: Vec::new(),
            water: Vec::new(),
            land_use: Vec::new(),
            terrain: None,
            metadata: Metadata::default(),
        }
    }

    /// The city of this draft, in steps: 1 the target; 2 what lies outside goes; 3 streets, no wider
    /// than the buildings beside them leave room; 4 blocks; 5 what lies in which block; 6 what blocks
    /// are used for.
    ///
    /// Unless all of it belongs to the city, streets are cut at the target's edge, other ways lose the segments outside, buildings and
    /// parcels stay where their centroid lies inside, areas and lines are clipped. Because ways
    /// come whole, nothing inside depends on what is dropped.
    pub fn assemble(mut self, options: &ImportOptions) -> Result<Imported, DraftError> {
        let target = self.target(options)?;
        let is_cut = !self.runs_past || options.bbox.is_some() || options.part.is_some();
        if is_cut {
            cut::cut(&mut self, &target, options.with_other);
        }
        let area = is_cut.then(|| target.clone());
        let derive = Derive { with_other: options.with_other, area };
        let mut streets = street_graph::derive(&self.streets, &derive);
        mark_broken_ends(&mut streets, self.broken_ends);
        if options.simplify {
            let buildings = Arc::new(std::mem::take(&mut self.buildings));
            let by_geometry = !simplify::knows_oneways(&streets);
            let options = Simplify { by_geometry, buildings, ..Simplify::default() };
            streets = simplify::simplify(&streets, &options);
            self.buildings = Arc::unwrap_or_clone(options.buildings);
        }
        assign_levels(&mut streets, &Hierarchy::default());
        facades::narrow_streets(&mut streets, &self.buildings);

        let mut blocks = crate::block::derive(&streets);
        for block in &mut blocks {
            block.provenance = Provenance::of(Origin::Imported);
        }
        placing::use_land(&mut blocks, &self.land_use);
        placing::place(&blocks, &mut self.parcels, &mut self.buildings, &mut self.features);
        placing::give_access(&mut self.parcels, &streets);
        for areas in [&mut self.water, &mut self.land_use] {
            for (area, id) in areas.iter_mut().zip(1..) {
                area.id = id;
            }
        }
        let mut warnings = Vec::new();
        if streets.edge_count() == 0 {
            warnings.push("the map has no streets".to_owned());
        }
        let mut city = City::empty(self.frame, target);
        city.metadata = self.metadata;
        city.metadata.buildings_complete = completeness::is_complete(&streets, &self.buildings);
        city.streets = Arc::new(streets);
        let other = |w: &crate::Way| !options.with_other && w.street.role() == Role::Other;
        city.other_ways = Arc::new(self.streets.ways.into_iter().filter(other).collect());
        city.blocks = Arc::new(blocks);
        city.parcels = Arc::new(self.parcels);
        city.buildings = Arc::new(self.buildings);
        city.features = Arc::new(self.features);
        city.water = Arc::new(self.water);
        city.land_use = Arc::new(self.land_use);
        if let Some(terrain) =
            self.terrain.and_then(|t| t.crop(city.target.bounds().grown(AROUND_M)))
        {
            city.lay(terrain);
        }
        Ok(Imported { city, warnings })
    }

    /// The extent, the part of it inside the box asked for, and the half asked for of the densest
    /// square of that.
    fn target(&self, options: &ImportOptions) -> Result<Polygon, DraftError> {
        let mut target = self.area().ok_or(DraftError::Nothing)?;
        if let Some([sw, ne]) = options.bbox {
            let name = format!("the box {},{},{},{}", sw.lon, sw.lat, ne.lon, ne.lat);
            let asked = self.frame.rectangle_inside(sw, ne).ok_or_else(|| empty(&name))?;
            let mut common = overlay::intersection(&asked, &target).into_iter();
            target = common.next().ok_or_else(|| empty(&name))?;
        }
        if let Some(part) = options.part {
            let counted = self.streets.ways.iter().filter(|w| w.street.role() != Role::Other);
            let lines = counted.map(|w| &w.line[..]);
            let square = densest_square::densest_square(lines, target.bounds());
            let half = rectangle(densest_square::half(square, part));
            let mut common =
                half.into_iter().flat_map(|half| overlay::intersection(&half, &target));
            target = common.next().ok_or_else(|| empty("the half asked for"))?;
        }
        Ok(target)
    }

    /// The extent; where the file declares none, the box of the streets, or of whatever there is,
    /// with a margin of 10 m so that a single straight street has an area, too.
    pub fn area(&self) -> Option<Polygon> {
        const MARGIN_M: f64 = 10.0;
        self.extent.clone().or_else(|| self.bounds().and_then(|b| rectangle(b.grown(MARGIN_M))))
    }

    fn bounds(&self) -> Option<Bounds> {
        let streets = Bounds::of(self.streets.ways.iter().flat_map(|w| w.line.iter().copied()));
        let polygons = self
            .buildings
            .iter()
            .map(|b| &b.polygon)
            .chain(self.parcels.iter().map(|p| &p.polygon))
            .chain(self.water.iter().chain(&self.land_use).map(|a| &a.polygon));
        streets.or_else(|| polygons.map(Polygon::bounds).reduce(Bounds::union))
    }
}

fn empty(what: &str) -> DraftError {
    DraftError::Empty(what.to_owned())
}

/// The box as a polygon; `None` without area on the grid.
fn rectangle(Bounds { min, max }: Bounds) -> Option<Polygon> {
    let (a, b) = (GridPoint::round(min), GridPoint::round(max));
    (a.x < b.x && a.y < b.y).then(|| Polygon::rectangle(a, b))
}

/// Ends where the file breaks off are cut ends.
fn mark_broken_ends(streets: &mut StreetGraph, mut broken: Vec<GridPoint>) {
    broken.sort_unstable();
    let ends: Vec<NodeId> = streets
        .nodes()
        .filter(|(id, node)| streets.degree(*id) == 1 && broken.binary_search(&node.at).is_ok())
        .map(|(id, _)| id)
        .collect();
    for id in ends {
        streets.node_mut(id).data.cut = true;
    }
}
