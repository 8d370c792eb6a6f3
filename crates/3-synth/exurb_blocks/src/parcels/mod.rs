//! `blocks parcels`: cuts blocks into lots that front on their streets, and leaves some of them open.
//!
//! Source: Aliaga, Vanegas, Beneš 2008, *Interactive Example-Based Urban Layout Synthesis*, section
//! 3.1.2. Steps: 1 each block takes after one of the example blocks most like it (crate `library`);
//! after a park, it is a park; 2 nearly rectangular blocks of one or two rows get Voronoi sites along
//! their main axis ([`axis_voronoi`]), all others along their kerb ([`stretches`]); 3 the borders
//! between the sites' cells cut the block ([`tiling`]); 4 pieces without frontage, and slivers, join
//! the neighbour of the longest shared border.
//!
//! Departures: the paper has the axis only. In L-shaped, curved and deep blocks its cells are cut off
//! from the street, so there the sites stand on the kerb, close enough that their diagram is that of
//! the kerb itself, and each lot reaches back to the middle of the block; land far behind the rows
//! falls to one of them. Frontages come in the order of the example's kerb, not from a normal
//! distribution. Blocks whose example is built on one side only get a row and leave the rest.
//! Units: metres. Complexity: O(n²) in the vertices of a block, linear in blocks. Each block has its
//! own random stream by place.

mod axis_voronoi;
mod box_split;
mod cadastre;
mod error;
mod learn;
mod owners;
mod params;
mod skeleton;
mod stretches;
mod synthesize;
#[cfg(test)]
mod tests;
mod tiling;

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{
    Area, Block, BlockClass, Building, City, Edit, Feature, Origin, Parcel, Provenance, block,
};
use exurb_geom::{GridPoint, offset};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope, rng};
use rayon::prelude::*;

pub use cadastre::{Holding, cadastre};
pub use error::Error;
pub use learn::Learned;
pub use params::{Method, Params};
pub(crate) use stretches::flanks;
pub use synthesize::{Input, Lot, synthesize};

use crate::filling::{self, Filling};
use crate::library::{Donors, OpenLand};
use crate::scoped::Scoped;

/// The operation.
pub struct Parcels;

/// Parcels with less frontage have no street access, in metres.
pub(crate) const ACCESS_M: f64 = 3.0;

impl Operation for Parcels {
    const CARD: Card = Card {
        stage: "blocks",
        method: "parcels",
        summary: "cuts blocks into parcels that front on their streets",
        source: "Aliaga, Vanegas, Benes 2008, section 3.1.2 [aliaga2008]",
        needs_example: false,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
        if params.method == Method::Footprints {
            return Ok(Learned::default());
        }
        learn::learn(examples, run)
    }

    fn describe(learned: &Learned) -> serde_json::Value {
        learned.describe_blocks()
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let failed =
            |e: Error| Failure::City { operation: Self::CARD.name(), message: e.to_string() };
        params.validate().map_err(failed)?;
        let blocks = match city.blocks.is_empty() {
            true => block::derive(&city.streets),
            false => city.blocks.to_vec(),
        };
        if blocks.is_empty() {
            return Err(failed(Error::NoBlocks));
        }
        let scoped = Scoped::of(city, &blocks, scope);
        if params.method == Method::Footprints {
            return Ok(around_buildings(city, blocks, &scoped, params));
        }
        let open = OpenLand::of(city);
        let donors = learned.donors(&blocks, run.seed());
        let cut: Vec<Result<Option<CutBlock>, Failure>> = blocks
            .par_iter()
            .map(|block| {
                run.check()?;
                let inside = scoped.holds(block.id) && block.class == BlockClass::Block;
                Ok(inside.then(|| cut_block(city, block, &donors, &open, params, run)))
            })
            .collect();
        let cut: Vec<Option<CutBlock>> = cut.into_iter().collect::<Result<_, _>>()?;
        Ok(written(city, blocks, cut, &scoped))
    }
}

/// Parcels around the buildings that stand; everything else stays.
fn around_buildings(city: &City, blocks: Vec<Block>, scoped: &Scoped, params: &Params) -> Edit {
    let mut buildings: BTreeMap<u32, Vec<Building>> = BTreeMap::new();
    for building in city.buildings.iter() {
        buildings.entry(building.block).or_default().push(building.clone());
    }
    let mut things: BTreeMap<u32, Vec<Feature>> = BTreeMap::new();
    for thing in city.features.iter() {
        things.entry(thing.block).or_default().push(thing.clone());
    }
    let of = |block: &Block| Filling {
        buildings: buildings.get(&block.id).cloned().unwrap_or_default(),
        things: things.get(&block.id).cloned().unwrap_or_default(),
        land_use: block.land_use.clone(),
        provenance: block.provenance.clone(),
        ..Filling::default()
    };
    let fillings: Vec<Option<Filling>> = blocks
        .par_iter()
        .map(|block| {
            let wanted = scoped.holds(block.id) && block.class == BlockClass::Block;
            wanted.then(|| of(block).with_cadastre(block, params.pavement))
        })
        .collect();
    filling::written(city, blocks, fillings)
}

/// What becomes of one block.
struct CutBlock {
    lots: Vec<Lot>,
    land_use: Option<Arc<str>>,
    /// Use of the land that the rows leave.
    rest_use: Option<Arc<str>>,
    pavement_m: f64,
    /// Is the open land new, and to be written as an area?
    is_new_area: bool,
    provenance: Provenance,
}

/// Narrowest pavement taken over from an example, in metres.
const LEAST_PAVEMENT_M: f64 = 0.5;

fn cut_block(
    city: &City,
    block: &Block,
    donors: &Donors<'_>,
    open: &OpenLand,
    params: &Params,
    run: &Run,
) -> CutBlock {
    let donors = donors.of(block, &city.streets);
    let donor = donors.first();
    let provenance = Provenance {
        origin: if donor.is_some() { Origin::Example } else { Origin::Procedural },
        source: donor.map(|d| d.source.clone()),
        part: donor.map(|d| format!("block {}", d.id).into()),
    };
    let given = open.keeps_open(&block.polygon);
    let drawn = donor.and_then(|d| d.open.clone()).filter(|_| params.open_land);
    // Where the example's houses stand at the kerb, the pavement is as narrow.
    let setback_m = donor.and_then(|d| d.setback_m).unwrap_or(params.pavement);
    let pavement_m = params.pavement.min(setback_m.max(LEAST_PAVEMENT_M));
    let ground = offset::inset(&block.polygon, pavement_m);
    if let Some(land_use) = given.clone().or(drawn) {
        let lots = ground.into_iter().map(whole_lot).collect();
        let (land_use, is_new_area) = (Some(land_use), given.is_none());
        return CutBlock { lots, land_use, rest_use: None, pavement_m, is_new_area, provenance };
    }
    let input = learn::input(&donors, block.polygon.area_m2());
    let key = rng::place_key(GridPoint::round(block.polygon.centroid()));
    let mut rng = run.stream(key);
    let lots = ground.iter().flat_map(|g| synthesize(g, &input, params, &mut rng)).collect();
    let rest_use = donors.iter().find_map(|d| d.open.clone()).unwrap_or_else(|| "grass".into());
    let (land_use, rest_use) = (None, Some(rest_use));
    CutBlock { lots, land_use, rest_use, pavement_m, is_new_area: true, provenance }
}

fn whole_lot(polygon: exurb_geom::Polygon) -> Lot {
    Lot { frontage_m: polygon.perimeter_m(), polygon, is_rest: false }
}

/// The edit: blocks with land use, parcels numbered in order, land use areas; what lies outside the
/// scope stays.
fn written(
    city: &City,
    mut blocks: Vec<Block>,
    cut: Vec<Option<CutBlock>>,
    scoped: &Scoped,
) -> Edit {
    let mut parcels: Vec<Parcel> =
        city.parcels.iter().filter(|p| !scoped.holds(p.block)).cloned().collect();
    let mut buildings: Vec<_> =
        city.buildings.iter().filter(|b| !scoped.holds(b.block)).cloned().collect();
    let mut land_use: Vec<Area> = city.land_use.to_vec();
    let mut next_area = land_use.iter().map(|a| a.id).max().unwrap_or(0) + 1;
    for (block, cut) in blocks.iter_mut().zip(cut) {
        let Some(cut) = cut else { continue };
        block.pavement_m = cut.pavement_m;
        block.land_use.clone_from(&cut.land_use);
        block.provenance.clone_from(&cut.provenance);
        for lot in cut.lots {
            let class = if lot.is_rest { &cut.rest_use } else { &cut.land_use };
            if let Some(class) = class.as_ref().filter(|_| cut.is_new_area) {
                let (polygon, class) = (lot.polygon.clone(), class.clone());
                land_use.push(Area { id: next_area, polygon, class });
                next_area += 1;
            }
            parcels.push(Parcel {
                id: 0,
                block: block.id,
                street_access: lot.frontage_m >= ACCESS_M,
                land_use: class.clone(),
                polygon: lot.polygon,
                provenance: cut.provenance.clone(),
            });
        }
    }
    filling::number_parcels(&mut parcels, &mut buildings);
    Edit {
        blocks: Some(blocks),
        parcels: Some(parcels),
        buildings: Some(buildings),
        land_use: Some(land_use),
        ..Edit::default()
    }
}
