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
//! ([`finish`]); 6 local edits bring the whole nearer to the example ([`polish`]); 7 oneways that are
//! traps become two-way ([`oneways`]).
//!
//! Which example grows where, and how it is turned, says the [`plan`], with [`domains`] where areas
//! have examples of their own ([`character`] chooses by ground, [`like`] by a drawn fragment); what is given and what lies around, the [`ground`]; what water and
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
mod character;
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
mod like;
mod network;
mod oneways;
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
use exurb_city::{City, Edit, block};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

use character::Character;
use domains::Domains;
pub use error::Error;
pub use ground::Ground;
pub use learn::{Vocabulary, learn};
use like::{Found, Fragment};
pub use params::Params;
pub use plan::{Guide, Motion, Plan, Start};
use starts::Like;
pub use synthesize::synthesize;

/// `streets grow`.
#[derive(Debug)]
pub struct Grow;

/// What the examples taught, with their frames.
#[derive(Debug)]
pub struct Learned {
    vocabularies: Vec<Vocabulary>,
    frames: Vec<exurb_geom::Frame>,
    /// Where the only example is like the drawn fragment.
    like: Option<Found>,
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
        let mut cities: Vec<(Arc<City>, f64)> =
            examples.iter().map(|e| (e.city.clone(), e.weight)).collect();
        let mut like = None;
        if let Some(lines) = params.like.lines() {
            let fragment = Fragment::of(lines, None).map_err(failure)?;
            let found = cities.iter().map(|(city, _)| fragment.place_in(city)).collect();
            let (i, found) = like::likest(found).ok_or_else(|| failure(Error::NotLike))?;
            cities = vec![(Arc::new(fragment.around(&cities[i].0, found.source)), 1.0)];
            like = Some(found);
        }
        let mut vocabularies = Vec::new();
        for (city, weight) in &cities {
            run.check()?;
            let vocabulary = learn(city, params).map_err(failure)?;
            let character = Character { weight: *weight, ..vocabulary.character };
            vocabularies.push(Vocabulary { character, ..vocabulary });
        }
        let frames = cities.iter().map(|(city, _)| city.frame.clone()).collect();
        Ok(Learned { vocabularies, frames, like })
    }

    fn choose(
        city: &City,
        scope: &Scope,
        library: &[Example],
        params: &Params,
        run: &Run,
    ) -> Result<Vec<usize>, Failure> {
        if let Some(lines) = params.like.lines() {
            let fragment = Fragment::of(lines, Some(city)).map_err(failure)?;
            let found = library.iter().map(|example| fragment.place_in(&example.city));
            let found = like::likest(found.collect());
            return found.map(|(i, _)| vec![i]).ok_or_else(|| failure(Error::NotLike));
        }
        let area = match scope {
            Scope::Inside(polygon) => polygon,
            Scope::All | Scope::Blocks(_) => &city.target,
        };
        let library: Vec<Character> =
            library.iter().map(|e| Character::of(&e.city, e.weight)).collect();
        Domains::serving(city, area, &library, params, run).map_err(failure)
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
        let mut edit = if ground.around.is_some() {
            ground.restore_levels(&mut streets);
            exurb_city::redevelop(city, streets, &ground.target)
        } else {
            let blocks = block::derive(&streets);
            let example_gates = learned.vocabularies.first().map(|v| v.gates.clone());
            let (streets, blocks) = (Some(streets), Some(blocks));
            Edit { streets, blocks, example_gates, ..Edit::default() }
        };
        let mut land_use = edit.land_use.take().unwrap_or_else(|| city.land_use.to_vec());
        land_use.extend(relief::parks(params));
        land_use.iter_mut().zip(1..).for_each(|(area, id)| area.id = id);
        Ok(Edit { land_use: Some(land_use), ..edit })
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
        let characters: Vec<Character> = examples.iter().map(|v| v.character.clone()).collect();
        let domains = Domains::of(city, &ground.area, &characters, params, run)?;
        let like = self.like(city, params, run)?;
        let turn = if params.rotate == 0.0 { like.map_or(0.0, |l| l.turn_rad) } else { 0.0 };
        Ok(Plan {
            examples,
            params,
            starts: starts::starts(city, ground, self, &domains, like, params)?,
            domains,
            blend_m: params.blend * target.bounds().size().max_element(),
            interpolation: params.interpolation,
            rotate_rad: params.rotate.to_radians() + turn,
            guide: starts::guide(city, frames, params)?,
            seed: run.seed(),
        })
    }
}

impl Learned {
    /// Where growth begins with the place that is like the drawn fragment, if there is one.
    fn like(&self, city: &City, params: &Params, run: &Run) -> Result<Option<Like>, Error> {
        let (Some(lines), Some(found)) = (params.like.lines(), self.like) else { return Ok(None) };
        let Found { source, turn_rad, apart_m, .. } = found;
        let place = self.frames[0].unproject(source);
        run.warn(format!(
            "drawn streets: like those of `{}` at {:.5},{:.5}, turned by {:.0}°, {apart_m:.0} m apart in the mean",
            self.vocabularies[0].character.name,
            place.lon,
            place.lat,
            turn_rad.to_degrees(),
        ));
        Ok(Some(Like { at: Fragment::of(lines, Some(city))?.at, source, turn_rad }))
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
        Error::Library | Error::Like(_) | Error::NotLike => Failure::Params { operation, message },
        Error::Nothing { .. } | Error::NoLand => Failure::City { operation, message },
        Error::Cancelled => Failure::Cancelled,
    }
}
