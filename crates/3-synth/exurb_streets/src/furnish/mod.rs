//! `streets furnish`: trees and lamps along streets, trees in parks and woods.
//!
//! Source: the program of Nishida, Garcia-Dorado, Aliaga 2015, *Example-Driven Procedural Urban Roads*
//! (trees and lamps by turns every 31·U(0.4, 0.6) m on the pavement; 0.002 trees per m² of park).
//! Steps: 1 spacing and share of streets are learned where the example's trees and lamps are mapped
//! well enough, else the above holds; 2 each street draws whether it has trees and lamps, both its
//! sides alike; 3 the pavement of every block is walked around; 4 open land gets trees by its class.
//! Departures: rows are walked one for trees and one for lamps, so that each has its own spacing;
//! nothing stands at corners, under bridges, in water, in buildings or in another tree.
//! Units: metres. Complexity: linear in kerbs. Each block has its own random stream by place.

mod learn;
mod params;
mod synthesize;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use exurb_city::{
    Block, BlockClass, City, Class, Edit, Feature, FeatureShape, Origin, Provenance, area, block,
};
use exurb_geom::{Bounds, BoxGrid, GridPoint, Polygon, SegmentGrid, SegmentIndex, Vec2, polyline};
use exurb_graph::EdgeId;
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope, rng};
use rand::RngExt;
use rayon::prelude::*;

pub use learn::{Learned, Row};
pub use params::Params;
pub use synthesize::{Ground, Kind, Standing};

/// The operation.
pub struct Furnish;

impl Operation for Furnish {
    const CARD: Card = Card {
        stage: "streets",
        method: "furnish",
        summary: "plants trees and sets lamps along streets and in parks",
        source: "Nishida, Garcia-Dorado, Aliaga 2015, the authors' program [nishida2015]",
        needs_example: false,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], _: &Params, run: &Run) -> Result<Learned, Failure> {
        learn::learn(examples, run)
    }

    fn describe(learned: &Learned) -> serde_json::Value {
        let park_trees = learned.park_trees.iter().map(|(class, per_m2)| (&**class, per_m2));
        serde_json::json!({
            "example": learned.source.as_deref(),
            "trees": learned.trees,
            "lamps": learned.lamps,
            "trees_per_m2_of_open_land": park_trees.collect::<BTreeMap<_, _>>(),
        })
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let derived = city.blocks.is_empty().then(|| block::derive(&city.streets));
        let blocks: &[Block] = derived.as_deref().unwrap_or(&city.blocks);
        let held: Vec<bool> = blocks.iter().map(|b| is_held(city, b, scope)).collect();
        let replaced = |f: &Feature| {
            let ours = f.provenance.origin != Origin::Imported;
            let of_block = blocks.iter().position(|b| b.id == f.block);
            ours && matches!(&*f.kind, "tree" | "lamp") && of_block.is_some_and(|b| held[b])
        };
        let mut features: Vec<Feature> =
            city.features.iter().filter(|f| !replaced(f)).cloned().collect();
        let site = Site::of(city, learned, params, run, &features);
        let placed: Vec<Result<Standing, Failure>> = blocks
            .par_iter()
            .zip(&held)
            .map(|(block, held)| {
                run.check()?;
                Ok(if *held { site.furnish(block) } else { Standing::new([], 1.0) })
            })
            .collect();
        let provenance =
            Provenance { origin: Origin::Procedural, source: learned.source.clone(), part: None };
        for (block, standing) in blocks.iter().zip(placed) {
            features.extend(standing?.things.into_iter().map(|(kind, at)| Feature {
                id: 0,
                kind: if kind == Kind::Tree { "tree".into() } else { "lamp".into() },
                shape: FeatureShape::Point(at),
                block: block.id,
                provenance: provenance.clone(),
            }));
        }
        for (feature, id) in features.iter_mut().zip(1..) {
            feature.id = id;
        }
        Ok(Edit { features: Some(features), blocks: derived, ..Edit::default() })
    }
}

fn is_held(city: &City, block: &Block, scope: &Scope) -> bool {
    let inside = |area: &Polygon| area.contains(GridPoint::round(block.polygon.interior_point()));
    block.class == BlockClass::Block
        && inside(&city.target)
        && match scope {
            Scope::All => true,
            Scope::Inside(area) => inside(area),
            Scope::Blocks(ids) => ids.contains(&block.id),
        }
}

/// Half of the widest street and its pavement, in metres.
const WIDEST_M: f64 = 30.0;

/// What all blocks share.
struct Site<'a> {
    city: &'a City,
    learned: &'a Learned,
    params: &'a Params,
    run: &'a Run,
    buildings: BoxGrid,
    land_use: BoxGrid,
    water: BoxGrid,
    there: Vec<Vec2>,
    /// Streets that bound blocks or end in them.
    streets: SegmentIndex,
    /// Streets that pass over or under blocks.
    over: SegmentIndex,
}

impl<'a> Site<'a> {
    fn of(
        city: &'a City,
        learned: &'a Learned,
        params: &'a Params,
        run: &'a Run,
        features: &[Feature],
    ) -> Self {
        let bounding = block::bounding_edges(&city.streets);
        let (mut streets, mut over) = (SegmentIndex::new(50.0), SegmentIndex::new(50.0));
        for (id, edge) in city.streets.edges().filter(|(_, e)| !e.data.tunnel) {
            let index = if bounding[id.index()] { &mut streets } else { &mut over };
            index.insert_line(id.0, &edge.line_m());
        }
        let point = |f: &Feature| match &f.shape {
            FeatureShape::Point(p) => Some(p.to_m()),
            _ => None,
        };
        Self {
            city,
            learned,
            params,
            run,
            buildings: BoxGrid::of(city.buildings.iter().map(|b| &b.polygon)),
            land_use: BoxGrid::of(city.land_use.iter().map(|a| &a.polygon)),
            water: BoxGrid::of(city.water.iter().map(|a| &a.polygon)),
            there: features.iter().filter_map(point).collect(),
            streets,
            over,
        }
    }

    fn furnish(&self, block: &Block) -> Standing {
        let key = rng::place_key(GridPoint::round(block.polygon.centroid()));
        let mut rng = self.run.stream(key);
        let mut near = Vec::new();
        self.buildings.meeting_polygon(&block.polygon, &mut near);
        let buildings = near.iter().map(|n| &self.city.buildings[*n as usize].polygon).collect();
        let street_has = |kind, p| self.street_has(kind, p);
        let is_taken = |p| self.is_taken(p);
        let ground = Ground {
            block: &block.polygon,
            kerb: SegmentGrid::new(block.polygon.segments().collect()),
            pavement_m: block.pavement_m,
            buildings,
            street_has: &street_has,
            is_taken: &is_taken,
        };
        let bounds = block.polygon.bounds();
        let there = self.there.iter().copied().filter(|p| bounds.contains(*p));
        let mut standing = Standing::new(there, self.params.min_distance);
        let (learned, params) = (self.learned, self.params);
        standing.along_kerb(Kind::Lamp, &learned.lamps, params.lamps, &ground, params, &mut rng);
        let trees = params.street_trees;
        standing.along_kerb(Kind::Tree, &learned.trees, trees, &ground, params, &mut rng);
        self.land_use.meeting_polygon(&block.polygon, &mut near);
        for area in near.iter().map(|n| &self.city.land_use[*n as usize]) {
            let density = learned.park_trees.get(&area.class).copied().unwrap_or(0.0);
            if density > 0.0 && area::is_open(&area.class) {
                let density = density * params.park_trees;
                standing.scatter(&area.polygon, density, &ground, params, &mut rng);
            }
        }
        standing
    }

    /// Has the street at the kerb near `p` such things? Both sides of a street draw alike.
    fn street_has(&self, kind: Kind, p: Vec2) -> bool {
        let mut nearest: Option<(f64, u32)> = None;
        self.streets.visit(Bounds { min: p, max: p }.grown(WIDEST_M), |e| {
            let distance = polyline::nearest_on_segment(e.a, e.b, p).0.distance(p);
            let nearer = |(least, id): (f64, u32)| (distance, e.id) < (least, id);
            if nearest.is_none_or(nearer) {
                nearest = Some((distance, e.id));
            }
            true
        });
        let edge = nearest.and_then(|(_, id)| self.city.streets.get_edge(EdgeId(id)));
        let Some(edge) = edge else { return false };
        if edge.data.class.is_given_only() || edge.data.class == Class::Service {
            return false;
        }
        let line = edge.line();
        let middle = line[line.len() / 2];
        let row = if kind == Kind::Tree { &self.learned.trees } else { &self.learned.lamps };
        let key = rng::place_key(middle) ^ (kind as u64 + 1);
        self.run.stream(key).random::<f64>() < row.street_share
    }

    /// In water or under a bridge?
    fn is_taken(&self, p: Vec2) -> bool {
        let at = GridPoint::round(p);
        let mut near = Vec::new();
        self.water.meeting(at, at, &mut near);
        let wet = near.iter().any(|n| self.city.water[*n as usize].polygon.contains(at));
        let mut covered = false;
        let around = Bounds { min: p, max: p }.grown(10.0);
        self.over.visit(around, |e| {
            covered |= polyline::nearest_on_segment(e.a, e.b, p).0.distance(p) < 6.0;
            !covered
        });
        wet || covered
    }
}
