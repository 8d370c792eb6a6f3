//! Growth of streets by patches of an example.
//!
//! Source: Nishida, Garcia-Dorado, Aliaga 2015, *Example-Driven Procedural Urban Roads*, Computer
//! Graphics Forum, sections 4.1-4.5.
//!
//! Steps: 1 the example is prepared ([`prepare`]) and divided into main and local streets
//! ([`layer`]); 2 both are cut into patches ([`detect`], [`patch`]) and measured; 3 main streets grow
//! from the starts over the whole target ([`growth`]: [`placing`] copies, [`drawing`] chooses,
//! [`procedural`] makes and connects); 4 local streets grow in every cell between them ([`cells`]);
//! both passes fill what was left empty ([`fill`]); 5 dangling ends go and the target cuts
//! ([`finish`]).
//!
//! Departures: a patch whose connectors would cross a street is not refused, they end there in a
//! junction; local streets never leave their cell, so that cells grow on all cores and the result
//! does not depend on how many there are; local pieces that alone tie main streets together grow
//! with these; every street keeps its distance from others, and corners their angle, so that the
//! laws of the city model hold after every step. Flat land, no warping, blending or interpolation
//! yet.
//!
//! Units: metres, radians. Complexity: O(streets grown · streets nearby). Same seed, same streets.

mod cells;
mod detect;
mod drawing;
mod edge;
mod error;
mod fill;
mod finish;
mod fit;
mod growth;
mod layer;
mod learn;
mod network;
mod params;
mod patch;
mod placing;
mod prepare;
mod procedural;
mod synthesize;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use exurb_city::hierarchy::{Hierarchy, assign_levels};
use exurb_city::street_graph::{self, StreetGraph};
use exurb_city::{City, Edit, block};
use exurb_geom::{GridPoint, LonLat, Polygon, Vec2};
use exurb_operation::{Card, Example, Failure, Operation, Run, Scope};

pub use error::Error;
pub use learn::{Vocabulary, learn};
pub use params::Params;
pub use synthesize::{Input, Start, synthesize};

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
        source: "nishida2015, sections 4.1-4.5",
        needs_example: true,
    };
    type Params = Params;
    type Learned = Learned;

    fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
        let mut vocabularies = Vec::new();
        for example in examples {
            run.check()?;
            vocabularies.push(learn(&example.city, params).map_err(failure)?);
        }
        let frames = examples.iter().map(|e| e.city.frame.clone()).collect();
        Ok(Learned { vocabularies, frames })
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Learned,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        let target = match scope {
            Scope::Inside(polygon) => polygon,
            Scope::All | Scope::Blocks(_) => &city.target,
        };
        let starts = starts(city, target, learned, params).map_err(failure)?;
        let input = Input { target, examples: &learned.vocabularies, starts };
        let streets = synthesize(&input, params, run).map_err(failure)?;
        let mut streets = lawful(city, target, streets, run);
        assign_levels(&mut streets, &Hierarchy::default());
        run.phase("blocks");
        let blocks = block::derive(&streets);
        let gates = learned.vocabularies.first().map(|v| v.gates.clone());
        Ok(Edit {
            streets: Some(streets),
            blocks: Some(blocks),
            example_gates: gates,
            ..Edit::default()
        })
    }
}

/// The streets without those that break a law of the city model. Growth lays none; what the target's
/// edge cuts off and turns outwards can meet by a hair.
fn lawful(city: &City, target: &Polygon, streets: StreetGraph, run: &Run) -> StreetGraph {
    const LAWS: [&str; 4] = [
        "crossings_without_node",
        "touching_vertices",
        "self_intersecting",
        "duplicate_length_share",
    ];
    let mut checked = City::empty(city.frame.clone(), target.clone());
    checked.streets = Arc::new(streets);
    for _ in 0..4 {
        let report = exurb_city::laws::laws(&checked);
        let mut broken: Vec<u32> =
            report.breaches.iter().filter(|b| LAWS.contains(&b.law)).map(|b| b.id - 1).collect();
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
        street_graph::dissolve_all(&mut graph);
        checked.streets = Arc::new(graph.compacted());
    }
    Arc::unwrap_or_clone(checked.streets)
}

/// Where growth begins: as told, else spread over the target, the first in its middle.
fn starts(
    city: &City,
    target: &Polygon,
    learned: &Learned,
    params: &Params,
) -> Result<Vec<Start>, Error> {
    let count = learned.vocabularies.len();
    let start = |i: usize, at: Vec2, source: Option<Vec2>| {
        let example = i % count;
        Start { at, example, source: source.unwrap_or(learned.vocabularies[example].center) }
    };
    if params.start.is_empty() {
        let places = spread(target, (params.starts as usize).max(count));
        return Ok(places.into_iter().enumerate().map(|(i, at)| start(i, at, None)).collect());
    }
    let mut out = Vec::new();
    for (i, text) in params.start.iter().enumerate() {
        let (place, source) = params::parse_start(text).map_err(Error::Params)?;
        let at = city
            .frame
            .project(LonLat { lon: place.0, lat: place.1 })
            .filter(|p| target.contains(GridPoint::round(*p)))
            .ok_or_else(|| Error::StartOutside(text.clone()))?;
        let source = match source {
            Some((lon, lat)) => learned.frames[i % count].project(LonLat { lon, lat }),
            None => None,
        };
        out.push(start(i, at, source));
    }
    Ok(out)
}

/// `count` places in the polygon: its interior point, then each as far as possible from the others
/// and the edge, on a grid of about 40 × 40.
fn spread(target: &Polygon, count: usize) -> Vec<Vec2> {
    let mut places = vec![target.interior_point()];
    let bounds = target.bounds();
    let step = bounds.size() / 40.0;
    let grid: Vec<Vec2> = (1..40)
        .flat_map(|y| (1..40).map(move |x| Vec2::new(f64::from(x), f64::from(y))))
        .map(|k| bounds.min + k * step)
        .filter(|p| target.contains(GridPoint::round(*p)))
        .collect();
    while places.len() < count {
        let room = |p: &Vec2| {
            let others = places.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
            others.min(2.0 * target.boundary_distance_m(*p))
        };
        let Some(next) = grid.iter().max_by(|a, b| room(a).total_cmp(&room(b))) else { break };
        places.push(*next);
    }
    places
}

fn failure(error: Error) -> Failure {
    let (operation, message) = (Grow::CARD.name(), error.to_string());
    match error {
        Error::NoStreets(_) | Error::NoPatch(_) => Failure::Example { operation, message },
        Error::Params(_) | Error::StartOutside(_) => Failure::Params { operation, message },
        Error::Nothing { .. } => Failure::City { operation, message },
        Error::Cancelled => Failure::Cancelled,
    }
}
