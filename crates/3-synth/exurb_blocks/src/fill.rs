//! Blocks filled by example: what the methods that copy whole layouts share.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{Block, BlockClass, City, Edit, Feature, FeatureShape, Origin, Provenance, block};
use exurb_geom::{GridPoint, offset};
use exurb_operation::{Failure, Run, Scope};
use rayon::prelude::*;

use crate::choice::{Candidate, Choice, Choosing, Learned, Way, Ways, choose};
use crate::filling::{self, Filling, written};
use crate::kerb::Kerb;
use crate::lawful::lawful;
use crate::refine::Why;
use crate::scoped::Scoped;

/// What was done to the blocks of a scope.
pub struct Filled {
    /// The edit.
    pub edit: Edit,
    /// Numbers of blocks that no layout suits.
    pub left: Vec<u32>,
}

/// When a layout does not suit a block.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Blocks less alike than this are not.
    pub most_cost: f64,
    /// Layouts that lose more than the rest of this share are not.
    pub least_kept: f64,
}

impl Limits {
    /// Every layout suits.
    pub const NONE: Self = Self { most_cost: f64::INFINITY, least_kept: 0.0 };

    /// Does the candidate suit its block? One without buildings suits blocks of any shape.
    pub fn admit(&self, candidate: &Candidate) -> bool {
        let is_alike = candidate.cost <= self.most_cost || candidate.laid.buildings.is_empty();
        candidate.is_same || (is_alike && candidate.kept >= self.least_kept)
    }
}

/// Features this near to the kerb, behind the pavement, stand along the street, in metres.
const ALONG_STREET_M: f64 = 1.0;

/// The blocks of a city, derived where it has none.
pub fn blocks_of(city: &City) -> Vec<Block> {
    if city.blocks.is_empty() { block::derive(&city.streets) } else { city.blocks.to_vec() }
}

/// Fills the blocks of `scope`. Islands stay as they are.
pub fn fill(
    city: &City,
    scope: &Scope,
    learned: &Learned,
    choosing: &Choosing,
    ways: &Ways,
    run: &Run,
) -> Result<Filled, Failure> {
    let blocks = blocks_of(city);
    let scoped = Scoped::of(city, &blocks, scope);
    let wanted: Vec<bool> =
        blocks.iter().map(|b| b.class == BlockClass::Block && scoped.holds(b.id)).collect();
    run.phase("choosing layouts");
    let choices = choose(city, &blocks, &wanted, learned, choosing, ways, run)?;
    let along = AlongStreets::of(city, &blocks, choosing.pavement);
    let mut left = Vec::new();
    let mut tally: BTreeMap<String, u64> = BTreeMap::new();
    let mut fillings: Vec<Option<Filling>> = Vec::with_capacity(blocks.len());
    let made: Vec<Option<Filling>> = blocks
        .par_iter()
        .zip(&choices)
        .zip(&along.of_block)
        .map(|((block, choice), along)| {
            filling(block, choice, along, learned, choosing, ways.limits)
        })
        .collect();
    for ((block, choice), made) in blocks.iter().zip(&choices).zip(made) {
        for (what, count) in counted(choice, made.is_some()) {
            *tally.entry(what).or_default() += count;
        }
        if made.is_none() && !matches!(choice, Choice::None) {
            left.push(block.id);
        }
        fillings.push(made);
    }
    tally.into_iter().for_each(|(what, count)| run.tally(&what, count));
    Ok(Filled { edit: lawful(city, written(city, blocks, fillings), run), left })
}

/// What is to be told of one block.
fn counted(choice: &Choice, filled: bool) -> Vec<(String, u64)> {
    let one = |what: &str| vec![(what.to_owned(), 1)];
    let chosen = match choice {
        Choice::None => return Vec::new(),
        Choice::Open(_) => return one("blocks kept open: the land use says so"),
        Choice::Filled(list) => list.first(),
    };
    let Some(chosen) = chosen.filter(|_| filled) else {
        return one("blocks that no layout suits: too unlike, or too little finds room");
    };
    let way = match (chosen.way, chosen.is_same) {
        (_, true) => "blocks given their own layout: they lie in an example",
        (Way::Transferred, _) => "blocks transferred: the outlines are alike",
        (Way::Retargeted, _) => "blocks re-targeted: the outlines differ",
    };
    let mut out = one(way);
    let buildings = chosen.laid.buildings.iter().filter(|b| !b.is_part).count() as u64;
    out.push(("footprints placed".to_owned(), buildings));
    out.push(("footprints moved or trimmed to fit".to_owned(), chosen.laid.moved as u64));
    for why in &chosen.laid.dropped {
        let why = match why {
            Why::Outside => "footprints dropped: outside the block",
            Why::Street => "footprints dropped: on the street",
            Why::Neighbour => "footprints dropped: over another",
            Why::Shape => "footprints dropped: outline crosses itself",
            Why::OpenLand => "footprints dropped: on water or open land",
        };
        out.push((why.to_owned(), 1));
    }
    out
}

fn filling(
    block: &Block,
    choice: &Choice,
    along: &[Feature],
    learned: &Learned,
    choosing: &Choosing,
    limits: Limits,
) -> Option<Filling> {
    let made = match choice {
        Choice::None => None,
        Choice::Open(class) => Some(Filling {
            things: along.to_vec(),
            land_use: Some(class.clone()),
            pavement_m: choosing.pavement,
            provenance: block.provenance.clone(),
            ..Filling::default()
        }),
        Choice::Filled(list) => {
            let chosen = list.first()?;
            limits.admit(chosen).then(|| of_candidates(block, list, along, learned, choosing))
        }
    };
    made.map(|f| if choosing.parcels { f.with_cadastre(block, choosing.pavement) } else { f })
}

fn of_candidates(
    block: &Block,
    list: &[Candidate],
    along: &[Feature],
    learned: &Learned,
    choosing: &Choosing,
) -> Filling {
    let chosen = &list[0];
    let layout = &learned.database.layouts[chosen.entry as usize];
    let kerb = Kerb::of(&block.polygon);
    // Street furniture that stands there stays, and none is added to it.
    let beside = |f: &Feature| kerb.nearest(crate::database::middle(&f.shape)).1.distance_m;
    let keeps = |f: &&Feature| along.is_empty() || beside(f) > choosing.pavement + ALONG_STREET_M;
    let mut things: Vec<Feature> = along.to_vec();
    things.extend(chosen.laid.things.iter().filter(keeps).cloned());
    for (number, other) in list.iter().enumerate().skip(1).take(choosing.alternatives as usize - 1)
    {
        let kind: Arc<str> = format!("alternative_{}", number + 1).into();
        things.extend(other.laid.buildings.iter().filter(|b| !b.is_part).map(|b| Feature {
            id: 0,
            kind: kind.clone(),
            shape: FeatureShape::Polygon(b.polygon.clone()),
            block: block.id,
            provenance: b.provenance.clone(),
        }));
    }
    let open = layout.open.as_ref().map(|class| {
        let ground = offset::inset(&block.polygon, choosing.pavement);
        ground.into_iter().map(|p| (p, class.clone())).collect::<Vec<_>>()
    });
    let mut buildings = chosen.laid.buildings.clone();
    if !chosen.is_same {
        filling::trim(&mut buildings);
    }
    Filling {
        buildings,
        parcels: Vec::new(),
        things,
        open: open.filter(|_| !chosen.is_same).unwrap_or_default(),
        land_use: layout.open.clone().or_else(|| layout.land_use.clone()),
        pavement_m: choosing.pavement,
        provenance: Provenance { origin: Origin::Example, ..layout.provenance() },
    }
}

/// Street furniture of each block.
struct AlongStreets {
    of_block: Vec<Vec<Feature>>,
}

impl AlongStreets {
    fn of(city: &City, blocks: &[Block], pavement_m: f64) -> Self {
        let numbers: BTreeMap<u32, usize> =
            blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
        let mut of_block: Vec<Vec<Feature>> = vec![Vec::new(); blocks.len()];
        for thing in city.features.iter() {
            let Some(i) = numbers.get(&thing.block) else { continue };
            let at = GridPoint::round(crate::database::middle(&thing.shape)).to_m();
            if blocks[*i].polygon.boundary_distance_m(at) <= pavement_m + ALONG_STREET_M {
                of_block[*i].push(thing.clone());
            }
        }
        Self { of_block }
    }
}
