//! Bridges: where main streets cross water.
//!
//! The paper lets a street that has come to water look for the other side for itself, and names the
//! poorly connected streets and sharp turns that come of it. Here streets that came to water wait
//! until nothing else grows; then bridges are chosen over all of it together, cheapest first by
//! length, by the turns at both heads and by the rise between them, and apart from each other. What
//! they reach grows on, comes to water elsewhere, and so in rounds.

use exurb_city::{Origin, Provenance, Street};
use exurb_geom::{GridPoint, Vec2, polyline, trig};
use exurb_graph::{EdgeId, NodeId};
use exurb_operation::Run;

use super::error::Error;
use super::growth::{Growth, Open};
use super::network::{Landing, Piece, Standing, Vertex, Wish};
use super::relief::Verdict;

/// No bridge is longer over water, in metres.
const LONGEST_M: f64 = 420.0;
/// How far from the water its first head may lie, and the street it meets beyond, in metres.
const APPROACH_M: f64 = 260.0;
const BEYOND_M: f64 = 120.0;
/// Where no street is near beyond, the bridge ends so far from the shore, in metres.
const LANDING_M: f64 = 30.0;
/// The deck begins and ends so far from the water, in metres.
const DECK_M: f64 = 9.0;
/// Places along a crossing that are looked at, in metres.
const STEP_M: f64 = 5.0;
/// Directions that are tried to both sides of a street's own, in radians (the authors' program).
const MOST_TURN_RAD: f64 = 0.5;
const TURNS: i32 = 5;
/// What a bridge costs in metres of length: a radian of turn at a head, a metre of rise.
const TURN_COST_M: f64 = 150.0;
const RISE_COST_M: f64 = 12.0;
/// Bridges keep apart by the example's empty distance of main streets times this, in these bounds.
const APART: f64 = 1.5;
const APART_M: std::ops::RangeInclusive<f64> = 180.0..=700.0;
/// Rounds at most.
const ROUNDS: usize = 12;

/// A main street that came to water.
#[derive(Clone, Debug)]
pub struct Ford {
    /// Where it comes from.
    pub node: NodeId,
    /// The direction in which it came to the water.
    pub direction: Vec2,
    /// The street.
    pub street: Street,
}

/// A bridge that could be.
struct Crossing {
    cost_m: f64,
    ford: usize,
    line: Vec<Vec2>,
    /// Where along the line its deck begins and ends.
    deck: [f64; 2],
}

/// Lays bridges, and what grows from them, until none is left worth laying.
pub fn lay(growth: &mut Growth, run: &Run) -> Result<(), Error> {
    if !growth.relief.has_water() {
        return Ok(());
    }
    let mut built: Vec<Vec2> = Vec::new();
    for _ in 0..ROUNDS {
        let fords = std::mem::take(&mut growth.fords);
        let mut crossings: Vec<Crossing> =
            (0..fords.len()).flat_map(|i| crossings_at(growth, i, &fords[i])).collect();
        crossings.sort_by(|a, b| a.cost_m.total_cmp(&b.cost_m).then(a.ford.cmp(&b.ford)));
        let mut grew = false;
        for crossing in crossings {
            let middle =
                polyline::point_at(&crossing.line, (crossing.deck[0] + crossing.deck[1]) / 2.0);
            let apart_m = apart_m(growth, middle);
            if built.iter().all(|b| b.distance(middle) >= apart_m)
                && build(growth, &fords[crossing.ford], &crossing)
            {
                built.push(middle);
                grew = true;
            }
        }
        if !grew {
            break;
        }
        growth.run(run)?;
    }
    Ok(())
}

fn apart_m(growth: &Growth, at: Vec2) -> f64 {
    let example = growth.plan.example_at(at);
    let empty_m = growth.plan.examples[example].main.empty_m;
    (APART * empty_m).clamp(*APART_M.start(), *APART_M.end())
}

/// The crossings of one street, in all directions that are tried.
fn crossings_at(growth: &Growth, number: usize, ford: &Ford) -> Vec<Crossing> {
    if growth.net.graph.get_node(ford.node).is_none() {
        return Vec::new();
    }
    let turns = (-TURNS..=TURNS).map(|k| f64::from(k) * MOST_TURN_RAD / f64::from(TURNS));
    turns.filter_map(|turn| crossing(growth, number, ford, turn)).collect()
}

fn crossing(growth: &Growth, number: usize, ford: &Ford, turn_rad: f64) -> Option<Crossing> {
    let at = growth.net.graph.node(ford.node).at.to_m();
    let direction = trig::rotate(ford.direction, turn_rad);
    let (near, far) = shores(growth, at, direction)?;
    let longest = [at, at + direction * (far + BEYOND_M)];
    let probe = growth.net.probe(ford.node, &longest, Wish::free(0))?;
    let met = polyline::length(&probe.line);
    let line = if probe.landing == Landing::Free || met > far + BEYOND_M {
        vec![at, at + direction * (far + LANDING_M)]
    } else if met > far + DECK_M {
        probe.line
    } else {
        // It meets a street on this side, or another bridge.
        return None;
    };
    let end = line[line.len() - 1];
    let is_free = line.len() == 2 && probe.landing == Landing::Free;
    // Where the map ends the other side is not known: there may be none.
    let landing = at + direction * (far + DECK_M);
    if !growth.relief.is_known(landing)
        || !growth.claims.is_inside(end)
        || is_free && !growth.relief.bears(end)
    {
        return None;
    }
    let landing_turn = match probe.landing {
        Landing::Node(node) => turn_at(growth, node, -direction),
        Landing::Edge(..) => std::f64::consts::FRAC_PI_4,
        Landing::Free | Landing::Rim => 0.0,
    };
    let turn = turn_at(growth, ford.node, direction) + landing_turn;
    let rise_m = (growth.relief.height_m(end) - growth.relief.height_m(at)).abs();
    let cost_m = (far - near) + 0.3 * near + TURN_COST_M * turn + RISE_COST_M * rise_m;
    let total = polyline::length(&line);
    let deck = [(near - DECK_M).max(0.0), (far + DECK_M).min(total)];
    let approaches = [polyline::part(&line, 0.0, deck[0]), polyline::part(&line, deck[1], total)];
    if approaches.iter().any(|part| growth.relief.verdict(part) == Verdict::Steep) {
        return None;
    }
    Some(Crossing { cost_m, ford: number, line, deck })
}

/// Where a ray from dry ground comes to water and where it leaves it, if that is near enough.
fn shores(growth: &Growth, at: Vec2, direction: Vec2) -> Option<(f64, f64)> {
    let steps = ((APPROACH_M + LONGEST_M) / STEP_M) as usize;
    let wet = |i: usize| growth.relief.is_wet(at + direction * (i as f64 * STEP_M));
    let near = (0..=(APPROACH_M / STEP_M) as usize).find(|i| wet(*i))?;
    // A strip of land within reach of the deck is an island that the bridge passes over.
    let dry_for = (LANDING_M / STEP_M) as usize + 1;
    let far = (near + 1..=steps).find(|i| (0..dry_for).all(|k| !wet(i + k)))?;
    let over = (far - near) as f64 * STEP_M;
    (over <= LONGEST_M && near > 0).then_some((near as f64 * STEP_M, far as f64 * STEP_M))
}

/// By how much one turns from the straightest street at a node to `direction`, in radians.
fn turn_at(growth: &Growth, node: NodeId, direction: Vec2) -> f64 {
    let streets = growth.net.streets_at(node);
    let turns =
        streets.map(|d| trig::angle_between(-growth.net.graph.direction(d, 15.0), direction));
    turns.fold(std::f64::consts::FRAC_PI_2, f64::min)
}

/// Lays a bridge with its approaches. False where a bridge laid before stands in its way.
fn build(growth: &mut Growth, ford: &Ford, crossing: &Crossing) -> bool {
    if growth.net.graph.get_node(ford.node).is_none() {
        return false;
    }
    let wish = Wish::free(0);
    let Some(probe) = growth.net.probe(ford.node, &crossing.line, wish) else { return false };
    if probe.kept < 0.99 || matches!(probe.landing, Landing::Rim) {
        return false;
    }
    let ground = Street {
        provenance: Provenance::of(Origin::Joined),
        name: None,
        roundabout: false,
        ..ford.street.clone()
    };
    let deck = Street {
        provenance: Provenance::of(Origin::Bridge),
        bridge: true,
        layer: 1,
        ..ground.clone()
    };
    let is_free = probe.landing == Landing::Free;
    let Some((to, whole)) =
        growth.net.commit(ford.node, probe, Piece::of(ground), Vertex::default())
    else {
        return false;
    };
    let head = |along: f64| GridPoint::round(polyline::point_at(&crossing.line, along));
    let [from, until] = crossing.deck.map(head);
    let rest = cut(growth, whole, from)[1];
    let over = cut(growth, rest, until)[0];
    let piece = Piece { standing: Standing::Bridge, ..Piece::of(deck) };
    growth.net.graph.edge_mut(over).data = piece;
    if is_free {
        growth.frontier.push_back(Open::Node(to));
    }
    true
}

/// The parts of an edge before and after a place; both are the whole where that is an end.
fn cut(growth: &mut Growth, edge: EdgeId, at: GridPoint) -> [EdgeId; 2] {
    match growth.net.split(edge, at) {
        // Both are new.
        Some(_) => [2, 1].map(|back| EdgeId(growth.net.graph.edge_bound() as u32 - back)),
        None => [edge; 2],
    }
}
