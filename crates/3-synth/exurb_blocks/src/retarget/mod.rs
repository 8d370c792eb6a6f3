//! `blocks retarget`: layouts laid out anew in blocks of another shape, or in a block whose outline was
//! changed.
//!
//! Source: Hartmann, Krüger, Klein 2015, *Content-Aware Re-targeting of Discrete Element Layouts*;
//! Hartmann 2018, section 5.2. Steps: 1 elements fall into groups along the sides of the outline, rows
//! inside, and single ones ([`groups`], [`rows`]); 2 which place of the old outline belongs to which of
//! the new one is told by vertices that stayed, else by the time warp ([`correspondence`]); 3 the inside
//! follows the outline: the guidance map ([`guidance`]); 4 along each side of the new outline, largest
//! group first, the cheapest sequence of elements is found: what covers its own image and leaves gaps
//! where the map has gaps ([`label`], [`synthesize`]); 5 elements are brought to where their images lie,
//! closed rows are closed again ([`spacing`]); 6 sides that are built on less than they were are filled
//! up, single elements go where the map takes them; 7 the layout is refined (crate `refine`).
//!
//! Departures, each told where it is made: which elements stand at a side, and at a corner; what stands
//! behind a house stays with it; costs are lengths, so that long and short elements and gaps compare; gaps
//! of the map cost when they are built on, so that a stretched map does not close them; sequences have
//! exactly the length of the side; where the paper forbids the convex hulls of earlier sequences, elements
//! that share walls may be cut where they meet what stands (`cut`), so that packed blocks stay packed, and
//! refinement parts the others; what is left of a side becomes one gap, which a further element fills; rows
//! inside and single elements are not lost; layouts of few large buildings are fitted as a whole. Units:
//! metres. Complexity: O(elements · steps) a side, after O(elements · outline) for the map.

mod correspondence;
mod editor;
mod error;
mod groups;
mod guidance;
mod label;
mod line;
mod params;
mod path;
mod rows;
mod spacing;
mod synthesize;
#[cfg(test)]
mod tests;
mod things;
mod whole;

use exurb_city::{Block, City, Edit, Feature, FeatureShape, Origin, Provenance};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

pub use correspondence::Correspondence;
pub use editor::Editor;
pub(crate) use editor::{source_of, wishes};
pub use error::Error;
pub use groups::{Groups, Kind};
pub use params::{Params, Settings};
pub(crate) use path::Path;
pub use synthesize::{Placement, Source};
pub(crate) use things::things;
pub(crate) use whole::is_whole;

use crate::choice::{Learned, Ways};
use crate::database::BlockDatabase;
use crate::fill::{Limits, blocks_of, fill};
use crate::filling::{self, Filling, written};
use crate::lay::Spacing;
use crate::library::OpenLand;
use crate::transfer::{check, learn};

/// The operation.
pub struct Retarget;

impl Operation for Retarget {
    const CARD: Card = Card {
        stage: "blocks",
        method: "retarget",
        summary: "lays layouts out anew: of like example blocks in all blocks, or of one block whose \
                  outline changed",
        source: "Hartmann, Krüger, Klein 2015 [hartmann2015]; Hartmann 2018, section 5.2 [hartmann2018]",
        needs_example: false,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
        if params.block != 0 {
            // The block is its own example.
            return Learned::of(&[], run);
        }
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
        if params.block != 0 {
            let failed =
                |e: Error| Failure::City { operation: Self::CARD.name(), message: e.to_string() };
            return edited(city, params, run).map_err(failed);
        }
        let ways = Ways {
            transfer: false,
            retarget: true,
            deviation_m: 0.0,
            settings: params.settings.clone(),
            limits: Limits::NONE,
        };
        Ok(fill(city, scope, learned, &params.choosing, &ways, run)?.edit)
    }
}

/// The city with one block in its new outline.
fn edited(city: &City, params: &Params, run: &Run) -> Result<Edit, Error> {
    let mut blocks = blocks_of(city);
    let at = blocks.iter().position(|b| b.id == params.block);
    let at = at.ok_or(Error::NoSuchBlock { block: params.block, count: blocks.len() })?;
    let layout = BlockDatabase::layout_of(city, &blocks, at).ok_or(Error::Island(params.block))?;
    let outline = match params.outline.is_none() {
        true => blocks[at].polygon.clone(),
        false => {
            let read = params.outline.polygon().ok_or(Error::Outline)?;
            editor::snapped(&read, &blocks[at].polygon).ok_or(Error::Outline)?
        }
    };
    if !outline.is_valid() {
        return Err(Error::Outline);
    }
    let crossed =
        city.streets.edges().filter(|(_, e)| e.data.crossing_level() == 0).any(|(_, e)| {
            e.line().iter().any(|p| outline.contains(*p) && !blocks[at].polygon.contains(*p))
        });
    if crossed {
        run.warn(
            "the new outline reaches over streets; move them, too, before anything else is done",
        );
    }
    let choosing = &params.choosing;
    let spacing = Spacing { cut: params.settings.cut, ..choosing.spacing() };
    let editor = Editor::of(&layout, &params.settings, spacing);
    let laid = editor.laid(&outline, &OpenLand::of(city));
    run.tally("footprints placed", laid.buildings.iter().filter(|b| !b.is_part).count() as u64);
    run.tally("footprints of the layout", layout.footprints.len() as u64);
    let (mut buildings, mut things) = (laid.buildings, laid.things);
    filling::trim(&mut buildings);
    if params.guidance {
        let guiding = editor.guidance_map(&outline);
        things.extend(guiding.into_iter().map(|polygon| guidance_feature(polygon, &blocks[at])));
    }
    let provenance = Provenance { origin: Origin::Edited, ..Provenance::default() };
    let filling = Filling {
        buildings,
        things,
        land_use: blocks[at].land_use.clone(),
        pavement_m: blocks[at].pavement_m,
        provenance,
        ..Filling::default()
    };
    let mut fillings: Vec<Option<Filling>> = vec![None; blocks.len()];
    blocks[at].polygon = outline;
    let cut = choosing.parcels && !city.parcels.is_empty();
    let filling = if cut { filling.with_cadastre(&blocks[at], choosing.pavement) } else { filling };
    fillings[at] = Some(filling);
    Ok(written(city, blocks, fillings))
}

fn guidance_feature(polygon: exurb_geom::Polygon, block: &Block) -> Feature {
    Feature {
        id: 0,
        kind: "guidance".into(),
        shape: FeatureShape::Polygon(polygon),
        block: block.id,
        provenance: Provenance::of(Origin::Edited),
    }
}
