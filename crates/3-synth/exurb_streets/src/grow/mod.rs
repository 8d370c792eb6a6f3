//! Growth of streets by patches of an example.
//!
//! Source: Nishida, Garcia-Dorado, Aliaga 2015, *Example-Driven Procedural Urban Roads*, Computer
//! Graphics Forum, sections 3 to 5.
//!
//! Steps: 1 the example is prepared ([`prepare`]) and divided into main and local streets
//! ([`layer`]); 2 both are cut into patches ([`detect`], [`patch`]) and measured; 3 main streets grow
//! from the starts over the whole target ([`growth`]: [`placing`] copies, [`drawing`] chooses,
//! [`procedural`] makes and connects); 4 local streets grow in every cell between them ([`cells`]);
//! both passes fill what was left empty ([`fill`]); 5 dangling ends go and the target cuts
//! ([`finish`]); 6 local edits bring the whole nearer to the example ([`polish`]).
//!
//! Which example grows where, and how it is turned, says the [`plan`], with [`domains`] where areas
//! have examples of their own; what is given and what lies around, the [`ground`]; what water and
//! slopes allow, its [`relief`], and [`bridges`] cross the water.
//!
//! Departures: a patch whose connectors would cross a street is not refused, they end there in a
//! junction; local streets never leave their cell, so that cells grow on all cores and the result
//! does not depend on how many there are; local pieces that alone tie main streets together grow
//! with these; every street keeps its distance from others, and corners their angle, so that the
//! laws of the city model hold after every step. The example is followed as far as a piece reaches,
//! not from vertex to vertex by chance.
//!
//! Units: metres, radians. Complexity: O(streets grown · streets nearby). Same seed, same streets.

mod bridges;
mod cells;
mod claims;
mod detect;
mod domains;
mod drawing;
mod edge;
mod error;
mod extent;
mod fill;
mod finish;
mod fit;
mod ground;
mod growth;
mod layer;
mod learn;
mod lesson;
mod network;
mod params;
mod patch;
mod placing;
mod plan;
mod polish;
mod prepare;
mod procedural;
mod relief;
mod seams;
mod starts;
mod synthesize;
#[cfg(test)]
mod tests;
mod unreached;

use std::sync::Arc;

use exurb_city::hierarchy::{Hierarchy, assign_levels};
use exurb_city::street_graph::StreetGraph;
use exurb_city::{Area, City, Edit, block};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

use domains::Domains;
pub use error::Error;
pub use ground::Ground;
pub use learn::{Vocabulary, learn};
pub use params::Params;
pub use plan::{Guide, Motion, Plan, Start};
pub use synthesize::synthesize;

/// `streets grow`.
#[derive(Debug)]
pub struct Grow;

/// What the examples taught, with their frames.
#[derive(Debug)]
pub struct Learned {
    vocabularies: Vec<Vocabulary>,
    frames: Vec<exurb_geom::Frame>,
}

impl Operation for Grow {
    const CARD: Card = Card {
        stage: "streets",
        method: "grow",
        summary: "grows streets by copying patches of an example, and from its statistics",
        source: "nishida2015, sections 3-5",
        needs_example: true,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
        let mut vocabularies = Vec::new();
        for example in examples {
            run.check()?;
            let vocabulary = learn(&example.city, params).map_err(failure)?;
            vocabularies.push(Vocabulary { weight: example.weight, ..vocabulary });
        }
        let frames = examples.iter().map(|e| e.city.frame.clone()).collect();
        Ok(Learned { vocabularies, frames })
    }

    fn describe(learned: &Learned) -> serde_json::Value {
        lesson::describe(&learned.vocabularies)
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let ground = match scope {
            Scope::Inside(polygon) => Ground::inside(city, polygon, params),
            Scope::All | Scope::Blocks(_) => Ground::open(
                city,
                &city.target,
                synthesize::margin_m(&learned.vocabularies),
                params,
            ),
        };
        let plan = learned.plan(city, &ground, params, run).map_err(failure)?;
        let streets = synthesize(&ground, &plan, run).map_err(failure)?;
        let mut streets = lawful(city, &ground, streets, run);
        assign_levels(&mut streets, &Hierarchy::default());
        run.phase("blocks");
        let mut land_use: Vec<Area> =
            city.land_use.iter().cloned().chain(relief::parks(params)).collect();
        land_use.iter_mut().zip(1..).for_each(|(area, id)| area.id = id);
        if ground.around.is_some() {
            ground.restore_levels(&mut streets);
            let edit = exurb_city::redevelop(city, streets, &ground.target);
            return Ok(Edit { land_use: Some(land_use), ..edit });
        }
        let blocks = block::derive(&streets);
        let gates = learned.vocabularies.first().map(|v| v.gates.clone());
        Ok(Edit {
            streets: Some(streets),
            blocks: Some(blocks),
            example_gates: gates,
            land_use: Some(land_use),
            ..Edit::default()
        })
    }
}

impl Learned {
    /// What grows where in `target`.
    fn plan<'a>(
        &'a self,
        city: &City,
        ground: &Ground,
        params: &'a Params,
        run: &Run,
    ) -> Result<Plan<'a>, Error> {
        let target = &ground.target;
        let (examples, frames) = (&self.vocabularies[..], &self.frames[..]);
        if params.interpolation.is_some() && examples.len() != 2 {
            let count = examples.len();
            return Err(Error::Params(format!(
                "`interpolation` mixes two examples, not {count}; name two with --example"
            )));
        }
        Ok(Plan {
            examples,
            params,
            domains: Domains::of(city, &ground.area, examples, params, run)?,
            starts: starts::starts(city, ground, examples, frames, params)?,
            blend_m: params.blend * target.bounds().size().max_element(),
            interpolation: params.interpolation,
            rotate_rad: params.rotate.to_radians(),
            guide: starts::guide(city, frames, params)?,
            seed: run.seed(),
        })
    }
}

/// The streets without those that break a law of the city model. Growth lays none; what the target's
/// edge cuts off and turns outwards can meet by a hair.
fn lawful(city: &City, ground: &Ground, streets: StreetGraph, run: &Run) -> StreetGraph {
    const LAWS: [&str; 4] = [
        "crossings_without_node",
        "touching_vertices",
        "self_intersecting",
        "duplicate_length_share",
    ];
    let mut checked = City::empty(city.frame.clone(), ground.target.clone());
    checked.streets = Arc::new(streets);
    for _ in 0..4 {
        let report = exurb_city::laws::laws(&checked);
        let broken = report.breaches.iter().filter(|b| LAWS.contains(&b.law)).map(|b| b.id - 1);
        let mut broken: Vec<u32> =
            broken.filter(|id| ground.may_remove(&checked.streets, *id)).collect();
        broken.sort_unstable();
        broken.dedup();
        if broken.is_empty() {
            break;
        }
        run.warn(format!(
            "{} streets were removed because they met others too closely",
            broken.len()
        ));
        let mut graph = (*checked.streets).clone();
        for id in broken {
            graph.remove_edge(exurb_graph::EdgeId(id));
        }
        graph.remove_isolated_nodes();
        ground.dissolve(&mut graph);
        checked.streets = Arc::new(graph.compacted());
    }
    Arc::unwrap_or_clone(checked.streets)
}

fn failure(error: Error) -> Failure {
    let (operation, message) = (Grow::CARD.name(), error.to_string());
    match error {
        Error::NoStreets(_) | Error::NoPatch(_) => Failure::Example { operation, message },
        Error::Params(_) | Error::StartOutside(_) | Error::StartInWater(_) => {
            Failure::Params { operation, message }
        }
        Error::Nothing { .. } | Error::NoLand => Failure::City { operation, message },
        Error::Cancelled => Failure::Cancelled,
    }
}
