//! A city out of the rows of its own file, whatever the format.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use exurb_city::{
    Area, Block, BlockClass, Building, City, Draft, Feature, FeatureShape, ImportOptions, Imported,
    Metadata, Parcel, Provenance, Role, StreetGraph, Terrain, Way,
};
use exurb_geom::{Bounds, Frame, GridPoint, Polygon};
use exurb_graph::{EdgeId, NodeId};

use crate::Error;
use crate::layers::{self, IntersectionRow, Layer, StreetRow, TargetRow};
use crate::value::Value;

/// The rows read so far.
pub struct Assembly {
    file: String,
    frame: Frame,
    metadata: Metadata,
    target: Option<Polygon>,
    intersections: Vec<(IntersectionRow, GridPoint)>,
    streets: Vec<(StreetRow, Vec<GridPoint>)>,
    blocks: Vec<Block>,
    parcels: Vec<Parcel>,
    buildings: Vec<Building>,
    features: Vec<Feature>,
    water: Vec<Area>,
    land_use: Vec<Area>,
    /// The ground.
    pub terrain: Option<Arc<Terrain>>,
}

/// A street's line may end this far from its intersections: other programs round to centimetres. A
/// line farther off was drawn by hand.
const END_TOLERANCE_M: f64 = 0.05;

/// Why a row is none of its layer.
pub type BadRow = String;

impl Assembly {
    /// No rows yet, of the city file `file`.
    pub fn new(file: String, frame: Frame, metadata: Metadata) -> Self {
        Self {
            file,
            frame,
            metadata,
            target: None,
            intersections: Vec::new(),
            streets: Vec::new(),
            blocks: Vec::new(),
            parcels: Vec::new(),
            buildings: Vec::new(),
            features: Vec::new(),
            water: Vec::new(),
            land_use: Vec::new(),
            terrain: None,
        }
    }

    /// The frame of its coordinates.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Takes a row of `layer` over; `value` gives the column of that number and name.
    pub fn add<'v>(
        &mut self,
        layer: &str,
        shape: FeatureShape,
        value: impl FnMut(usize, &'static str) -> Value<'v>,
    ) -> Result<(), BadRow> {
        let provenance = Provenance::default();
        match (layer, shape) {
            ("streets", FeatureShape::Line(line)) => {
                let row = take(&layers::STREETS, StreetRow::default(), value)?;
                self.streets.push((row, line));
            }
            ("intersections", FeatureShape::Point(at)) => {
                let row = take(&layers::INTERSECTIONS, IntersectionRow::default(), value)?;
                self.intersections.push((row, at));
            }
            ("blocks", FeatureShape::Polygon(polygon)) => {
                self.blocks.push(take(&layers::BLOCKS, empty_block(polygon), value)?);
            }
            ("parcels", FeatureShape::Polygon(polygon)) => {
                let (street_access, land_use) = (false, None);
                let parcel =
                    Parcel { id: 0, block: 0, polygon, street_access, land_use, provenance };
                self.parcels.push(take(&layers::PARCELS, parcel, value)?);
            }
            ("buildings", FeatureShape::Polygon(polygon)) => {
                let building = Building::new(0, polygon, provenance);
                self.buildings.push(take(&layers::BUILDINGS, building, value)?);
            }
            ("features", shape) => {
                let feature = Feature { id: 0, kind: Arc::default(), shape, block: 0, provenance };
                self.features.push(take(&layers::FEATURES, feature, value)?);
            }
            ("water", FeatureShape::Polygon(polygon)) => {
                self.water.push(take(&layers::WATER, empty_area(polygon), value)?);
            }
            ("land_use", FeatureShape::Polygon(polygon)) => {
                self.land_use.push(take(&layers::LAND_USE, empty_area(polygon), value)?);
            }
            ("target", FeatureShape::Polygon(polygon)) => {
                take(&layers::TARGET, TargetRow::default(), value)?;
                self.target = Some(polygon);
            }
            (layer, _) => return Err(format!("the geometry is none of the layer `{layer}`")),
        }
        Ok(())
    }

    /// The city. As it was written, when nothing else is asked for and every street still ends at
    /// its intersections; else the streets are noded and the blocks derived anew.
    pub fn finish(mut self, options: &ImportOptions) -> Result<Imported, Error> {
        self.number();
        if self.was_drawn_in() {
            let mut imported = self.derive_anew(options)?;
            imported.warnings.push(
                "streets were drawn, moved or removed outside exurb: noded them and derived the \
                 blocks anew"
                    .to_owned(),
            );
            return Ok(imported);
        }
        if *options != ImportOptions::default() {
            return self.derive_anew(options);
        }
        Ok(Imported { city: self.into_city()?, warnings: Vec::new() })
    }

    /// Rows that another program added have no number yet.
    fn number(&mut self) {
        fn number<T>(rows: &mut [T], id: fn(&mut T) -> &mut u32) {
            let mut last = rows.iter_mut().map(|row| *id(row)).max().unwrap_or(0);
            for row in rows.iter_mut().map(id).filter(|id| **id == 0) {
                last = last.saturating_add(1);
                *row = last;
            }
        }
        number(&mut self.parcels, |p| &mut p.id);
        number(&mut self.buildings, |b| &mut b.id);
        number(&mut self.features, |f| &mut f.id);
        number(&mut self.water, |a| &mut a.id);
        number(&mut self.land_use, |a| &mut a.id);
    }

    fn nodes(&self) -> BTreeMap<u32, usize> {
        self.intersections.iter().enumerate().map(|(i, (row, _))| (row.id, i)).collect()
    }

    /// Did another program draw, move or remove streets?
    fn was_drawn_in(&self) -> bool {
        let streets: BTreeSet<u32> = self.streets.iter().map(|(row, _)| row.id).collect();
        let mut sides = self.blocks.iter().flat_map(|b| b.sides.iter().chain(&b.dead_ends));
        sides.any(|side| !streets.contains(&(side.0 + 1))) || self.ends_elsewhere()
    }

    /// Does a street of the graph end elsewhere than at its intersections?
    fn ends_elsewhere(&self) -> bool {
        let nodes = self.nodes();
        let at = |id: u32| nodes.get(&id).map(|i| self.intersections[*i].1);
        self.streets.iter().any(|(row, line)| {
            let ends = row.ends.into_iter().zip([line[0], line[line.len() - 1]]);
            let ends_there = ends.into_iter().all(|(id, end)| {
                at(id).is_some_and(|node| node.distance_m(end) <= END_TOLERANCE_M)
            });
            !is_way(row) && !ends_there
        })
    }

    /// The same city as a map, to be cut and derived as any other.
    fn derive_anew(self, options: &ImportOptions) -> Result<Imported, Error> {
        let mut draft = Draft::new(self.frame);
        draft.extent = self.target;
        draft.runs_past = true;
        let cut = self.intersections.iter().filter(|(row, _)| row.junction.cut);
        draft.broken_ends = cut.map(|(_, at)| *at).collect();
        draft.streets.ways =
            self.streets.into_iter().zip(1..).map(|((row, line), id)| way(row, line, id)).collect();
        draft.buildings = self.buildings;
        draft.parcels = self.parcels;
        draft.features = self.features;
        draft.water = self.water;
        draft.land_use = self.land_use;
        draft.terrain = self.terrain;
        draft.metadata = self.metadata;
        draft.assemble(options).map_err(|source| Error::Draft { file: self.file, source })
    }

    fn into_city(self) -> Result<City, Error> {
        let nodes = self.nodes();
        if nodes.len() < self.intersections.len() {
            return Err(Error::Content {
                file: self.file,
                place: "layer `intersections`".to_owned(),
                what: "two rows have the same `id`; give every row its own".to_owned(),
            });
        }
        let mut graph = StreetGraph::new();
        let place = |(row, at): (IntersectionRow, _)| graph.add_node(at, row.junction);
        let ids: Vec<NodeId> = self.intersections.into_iter().map(place).collect();
        let mut ways = Vec::new();
        let mut new_id: BTreeMap<u32, EdgeId> = BTreeMap::new();
        for (row, line) in self.streets {
            if is_way(&row) {
                ways.push(way(row, line, 0));
                continue;
            }
            let [from, to] = row.ends.map(|id| ids[nodes[&id]]);
            if let Some(edge) = graph.add_edge(from, to, line, row.street) {
                new_id.insert(row.id, edge);
            }
        }
        let mut blocks = self.blocks;
        for block in &mut blocks {
            for list in [&mut block.sides, &mut block.dead_ends] {
                *list = list.iter().filter_map(|e| new_id.get(&(e.0 + 1)).copied()).collect();
            }
        }
        let target = self.target.or_else(|| bounds_of(&graph, &self.buildings));
        let target = target.ok_or(Error::Empty { file: self.file })?;
        let mut city = City::empty(self.frame, target);
        city.streets = Arc::new(graph);
        city.other_ways = Arc::new(ways);
        city.blocks = Arc::new(blocks);
        city.parcels = Arc::new(self.parcels);
        city.buildings = Arc::new(self.buildings);
        city.features = Arc::new(self.features);
        city.water = Arc::new(self.water);
        city.land_use = Arc::new(self.land_use);
        city.terrain = self.terrain;
        city.metadata = self.metadata;
        Ok(city)
    }
}

fn take<'v, T>(
    layer: &Layer<T>,
    mut row: T,
    value: impl FnMut(usize, &'static str) -> Value<'v>,
) -> Result<T, BadRow> {
    match layer.take(&mut row, value) {
        Ok(()) => Ok(row),
        Err((column, value)) => {
            let value = value.text().unwrap_or("nothing".into()).into_owned();
            Err(format!("the column `{column}` cannot hold `{value}`; mend or empty it"))
        }
    }
}

/// Ways of role other stand beside the graph.
fn is_way(row: &StreetRow) -> bool {
    row.ends == [0, 0] && (row.way.is_some() || row.street.role() == Role::Other)
}

fn way(row: StreetRow, line: Vec<GridPoint>, id: i64) -> Way {
    Way { id: row.way.unwrap_or(id), line, nodes: row.nodes, street: row.street }
}

fn empty_block(polygon: Polygon) -> Block {
    Block {
        id: 0,
        face_area_m2: 0.0,
        pavement_m: 0.0,
        land_use: None,
        class: BlockClass::Block,
        sides: Vec::new(),
        dead_ends: Vec::new(),
        provenance: Provenance::default(),
        polygon,
    }
}

fn empty_area(polygon: Polygon) -> Area {
    Area { id: 0, polygon, class: Arc::default() }
}

/// The rectangle around what there is, for a file whose target is gone.
fn bounds_of(streets: &StreetGraph, buildings: &[Building]) -> Option<Polygon> {
    let lines = streets.edges().flat_map(|(_, edge)| edge.line().iter().copied());
    let walls = buildings.iter().flat_map(|b| b.polygon.exterior().iter().copied());
    let bounds = Bounds::of(lines.chain(walls))?.grown(1.0);
    Some(Polygon::rectangle(GridPoint::round(bounds.min), GridPoint::round(bounds.max)))
}
