//! `blocks transfer`: fills blocks with the layouts of like blocks of the examples.
//!
//! Source: Hartmann 2018, *Example-Based Urban Modeling*, sections 5.1.3 and 5.1.4.

mod error;
mod lay;
mod params;
#[cfg(test)]
mod tests;

use exurb_city::{Block, City, Edit, Origin, Provenance, block};
use exurb_match::{Attributes, Outline, Query, align};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};
use rayon::prelude::*;

pub use error::Error;
pub use lay::{Laid, lay};
pub use params::Params;

use crate::database::{BY_SHAPE, BlockDatabase};
use crate::filling::{Filling, may_fill, written};
use crate::kerb::Kerb;
use crate::library::OpenLand;
use crate::refine::Ground;
use crate::scoped::Scoped;

/// The operation.
pub struct Transfer;

impl Operation for Transfer {
    const CARD: Card = Card {
        stage: "blocks",
        method: "transfer",
        summary: "fills blocks with the layouts of like blocks of the examples",
        source: "Hartmann 2018, sections 5.1.3 and 5.1.4 [hartmann2018]",
        needs_example: true,
    };
    type Params = Params;
    type Learned = BlockDatabase;

    fn learn(examples: &[Example], _: &Params, run: &Run) -> Result<BlockDatabase, Failure> {
        let database = BlockDatabase::of(examples, run)?;
        if database.layouts.is_empty() {
            let (operation, message) = (Self::CARD.name(), Error::EmptyDatabase.to_string());
            return Err(Failure::Example { operation, message });
        }
        Ok(database)
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &BlockDatabase,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let blocks = match city.blocks.is_empty() {
            true => block::derive(&city.streets),
            false => city.blocks.to_vec(),
        };
        if blocks.is_empty() {
            let (operation, message) = (Self::CARD.name(), Error::NoBlocks.to_string());
            return Err(Failure::City { operation, message });
        }
        let scoped = Scoped::of(city, &blocks, scope);
        let open = OpenLand::of(city);
        let fillings: Vec<Result<Option<Filling>, Failure>> = blocks
            .par_iter()
            .map(|block| {
                run.check()?;
                let wanted = may_fill(block, &scoped);
                Ok(wanted.then(|| fill(block, learned, &open, params)))
            })
            .collect();
        let fillings = fillings.into_iter().collect::<Result<_, _>>()?;
        Ok(written(city, blocks, fillings))
    }
}

fn fill(block: &Block, database: &BlockDatabase, open: &OpenLand, params: &Params) -> Filling {
    let outline = Outline::of(block.polygon.exterior());
    let attributes = Attributes::default();
    let query = Query {
        weights: BY_SHAPE,
        candidates: params.candidates as usize,
        mirrored: params.mirrored,
        ..Query::new(&outline, &attributes)
    };
    let found = database.query(&query, |_| true);
    let Some(best) = found.first() else { return Filling::default() };
    let layout = &database.layouts[best.entry as usize];
    let ring = block.polygon.exterior();
    let motion = align::refine(best.motion, database.outline(best.entry), ring);
    let kerb = Kerb::of(&block.polygon);
    let ground = Ground { block: &block.polygon, kerb: &kerb };
    let open = open.near(&block.polygon);
    let laid = lay(layout, &motion, &ground, &open, params.pavement, params.tolerance);
    Filling {
        buildings: laid.buildings,
        things: laid.things,
        land_use: layout.land_use.clone(),
        pavement_m: params.pavement,
        provenance: Provenance {
            origin: Origin::Example,
            source: Some(layout.source.clone()),
            part: Some(format!("block {}", layout.id).into()),
        },
        ..Filling::default()
    }
}
