//! `blocks auto`: each block filled the way that suits it.

mod params;

use exurb_city::{City, Edit};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

pub use params::Params;

use crate::choice::{Learned, Ways};
use crate::fill::{Limits, fill};
use crate::footprints::{self, Footprints};
use crate::lawful::lawful;
use crate::library::Library;
use crate::parcels::{self, Parcels};
use crate::retarget::Settings;
use crate::transfer::{check, learn};

/// The operation.
pub struct Auto;

/// What is learned for all ways.
pub struct AllLearned {
    layouts: Learned,
    /// Blocks that parcels take after: those that are built on.
    library: Library,
}

impl Operation for Auto {
    const CARD: Card = Card {
        stage: "blocks",
        method: "auto",
        summary: "fills each block the way that suits it: transfer, re-target, or parcels and footprints",
        source: "Hartmann 2018, chapter 5 [hartmann2018]",
        needs_example: true,
    };
    type Params = Params;
    type Learned = AllLearned;

    fn learn(examples: &[Example], _: &Params, run: &Run) -> Result<AllLearned, Failure> {
        Ok(AllLearned {
            layouts: learn(examples, &Self::CARD, run)?,
            library: Library::of(examples, run)?.built(),
        })
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &AllLearned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        check(city, &Self::CARD)?;
        let ways = Ways {
            transfer: true,
            retarget: true,
            deviation_m: params.alike,
            settings: Settings::default(),
            limits: Limits { most_cost: params.most_cost, least_kept: params.least_kept },
        };
        let filled = fill(city, scope, &learned.layouts, &params.choosing, &ways, run)?;
        if filled.left.is_empty() {
            return Ok(filled.edit);
        }
        let rest = Scope::Blocks(filled.left);
        let city = filled.edit.apply(city);
        let cut = parcels::Params { open_land: false, ..parcels::Params::default() };
        let city = Parcels::edit(&city, &rest, &learned.library, &cut, run)?.apply(&city);
        let stand = footprints::Params::default();
        // Slivers have no parcels.
        let city = match city.parcels.is_empty() {
            true => city,
            false => Footprints::edit(&city, &rest, &learned.library, &stand, run)?.apply(&city),
        };
        let edit = Edit {
            blocks: Some(city.blocks.to_vec()),
            parcels: Some(city.parcels.to_vec()),
            buildings: Some(city.buildings.to_vec()),
            features: Some(city.features.to_vec()),
            land_use: Some(city.land_use.to_vec()),
            ..Edit::default()
        };
        Ok(lawful(&city, edit, run))
    }
}
