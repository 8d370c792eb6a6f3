//! `buildings extrude`: gives footprints height, storeys, roof shape and use. Never moves a footprint.
//!
//! No paper; the plain baseline. Steps: 1 every building is described by what one sees from above:
//! area, shorter side, coverage of its block, usual footprint nearby, shared walls ([`likeness`]);
//! 2 its height is drawn among the example's buildings most like it, at a quantile that it shares with
//! its block as much as the example's blocks do, so that the marginal distribution is the example's
//! and neighbours are as alike as there; 3 roof and use are drawn in the same way, garages and the like
//! stay low; where the example tells none, documented defaults ([`defaults`]), said in a warning. Known values stay, unless
//! asked. Units: metres. Complexity: O(buildings · samples). Each block has its own random stream by
//! place.

mod defaults;
mod learn;
mod likeness;
mod params;
mod synthesize;
#[cfg(test)]
mod tests;

use exurb_city::{Building, City, Edit};
use exurb_geom::GridPoint;
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope, rng};
use rayon::prelude::*;

pub use learn::{Learned, Sample};
pub use likeness::Likeness;
pub use params::Params;
pub use synthesize::{BlockDraw, Shape, synthesize};

/// The operation.
pub struct Extrude;

impl Operation for Extrude {
    const CARD: Card = Card {
        stage: "buildings",
        method: "extrude",
        summary: "completes height, storeys, roof and use of footprints",
        source: "own method",
        needs_example: false,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
        learn::learn(examples, params, run)
    }

    fn describe(learned: &Learned) -> serde_json::Value {
        learn::describe(learned)
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let chosen: Vec<usize> =
            (0..city.buildings.len()).filter(|i| !city.buildings[*i].is_part).collect();
        let block_of = learn::blocks_of(city, &city.blocks, &chosen);
        let likeness = likeness::of_city(city, &city.blocks, &chosen, &block_of);
        let work: Vec<(usize, &Likeness, Option<usize>)> = chosen
            .iter()
            .zip(&likeness)
            .zip(&block_of)
            .map(|((i, likeness), block)| (*i, likeness, *block))
            .filter(|(i, _, block)| in_scope(city, &city.buildings[*i], *block, scope))
            .collect();
        let shapes: Vec<Result<Shape, Failure>> = work
            .par_iter()
            .map(|(i, likeness, block)| {
                run.check()?;
                let at = |p: exurb_geom::Vec2| rng::place_key(GridPoint::round(p));
                let own = at(city.buildings[*i].polygon.centroid());
                let key = block.map_or(own, |b| at(city.blocks[b].polygon.centroid()));
                let shared = BlockDraw::new(&mut run.stream(key));
                Ok(synthesize(likeness, learned, &shared, params, &mut run.stream(own ^ 1)))
            })
            .collect();
        let mut buildings = city.buildings.to_vec();
        for ((i, ..), shape) in work.iter().zip(shapes) {
            complete(&mut buildings[*i], shape?, params);
        }
        Ok(Edit { buildings: Some(buildings), ..Edit::default() })
    }
}

fn in_scope(city: &City, building: &Building, block: Option<usize>, scope: &Scope) -> bool {
    match scope {
        Scope::All => true,
        Scope::Inside(area) => area.contains(GridPoint::round(building.polygon.interior_point())),
        Scope::Blocks(ids) => block.is_some_and(|b| ids.contains(&city.blocks[b].id)),
    }
}

/// Fills what is unknown; everything where `replace` is set. Height and storeys go together.
fn complete(building: &mut Building, shape: Shape, params: &Params) {
    let replace = params.replace;
    match (building.height_m, building.levels) {
        _ if replace => {
            (building.height_m, building.levels) = (Some(shape.height_m), Some(shape.levels))
        }
        (None, None) => {
            (building.height_m, building.levels) = (Some(shape.height_m), Some(shape.levels))
        }
        (Some(h), None) => building.levels = Some((h / params.storey_height).round().max(1.0)),
        (None, Some(l)) => building.height_m = Some(l.max(0.5) * params.storey_height),
        (Some(_), Some(_)) => {}
    }
    if replace || building.roof.is_none() {
        building.roof = Some(shape.roof);
    }
    let is_high = building.height_m.is_some_and(|h| h > synthesize::LOW_M);
    let usage = shape.usage.filter(|usage| !(is_high && synthesize::is_low(usage)));
    if (replace || building.usage.is_none()) && usage.is_some() {
        building.usage = usage;
    }
}
