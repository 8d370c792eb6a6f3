//! `blocks transfer`: fills blocks with the layouts of like blocks of the examples.
//!
//! Source: Hartmann 2018, *Example-Based Urban Modeling*, sections 5.1.3 and 5.1.4. Steps: 1 like blocks
//! are found by shape and chosen together (crate `choice`); 2 the chosen layout is moved as a whole onto
//! the block, by the least squares of the two outlines; 3 what comes to lie on the street or in each
//! other is refined or dropped (crate `refine`). Height, storeys, roof, use and land use travel, and so
//! do trees, lamps and other features.
//!
//! Departures: see the rooms named; kerbs are matched, not centrelines (crate `database`). Footprints in
//! no closed block, and islands, stay as they are. Units: metres. Complexity: one query, a few time warps
//! and refinements a block.

mod error;
mod params;
#[cfg(test)]
mod tests;

use exurb_city::{City, Edit};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

pub use error::Error;
pub use params::Params;

use crate::choice::{Learned, Ways};
use crate::fill::{Limits, blocks_of, fill};
use crate::retarget::Settings;

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
    type Learned = Learned;

    fn learn(examples: &[Example], _: &Params, run: &Run) -> Result<Learned, Failure> {
        learn(examples, &Self::CARD, run)
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        check(city, &Self::CARD)?;
        let ways = Ways {
            transfer: true,
            retarget: false,
            deviation_m: f64::INFINITY,
            settings: Settings::default(),
            limits: Limits::NONE,
        };
        Ok(fill(city, scope, learned, &params.choosing, &ways, run)?.edit)
    }
}

/// The block database, or why there is none.
pub fn learn(examples: &[Example], card: &Card, run: &Run) -> Result<Learned, Failure> {
    let learned = Learned::of(examples, run)?;
    if learned.database.layouts.is_empty() {
        let (operation, message) = (card.name(), Error::EmptyDatabase.to_string());
        return Err(Failure::Example { operation, message });
    }
    Ok(learned)
}

/// Is there anything to fill?
pub fn check(city: &City, card: &Card) -> Result<(), Failure> {
    if blocks_of(city).is_empty() {
        let (operation, message) = (card.name(), Error::NoBlocks.to_string());
        return Err(Failure::City { operation, message });
    }
    Ok(())
}
