//! Drawing the next patch by how well it continues the street that arrives (eq. 2) and by how its
//! surroundings fit.

use exurb_geom::{Vec2, polyline, trig};
use exurb_graph::NodeId;
use rand::RngExt;

use super::growth::Growth;
use super::layer::{ChainEnd, NodeKind};
use super::learn::{self, SAMPLES};
use super::network::Coherent;
use super::params::Params;
use super::plan::Motion;
use super::{fit, placing, procedural};

/// Connectors compared at least; more, if they lie as near.
const COMPARED: usize = 96;
/// What a waiting street that goes on in the patch's surroundings adds to the exponent, and what one
/// that does not takes away.
const MET_GAIN: f64 = 1.5;
const MISSED_LOSS: f64 = 0.5;
/// What streets of one grain add to the exponent.
const GRAIN_GAIN: f64 = 4.0;
/// Patches whose surroundings are looked at.
const LOOKED_AT: usize = 96;
/// Patches tried before growth falls back to statistics.
const TRIES: usize = 6;
/// The unit of the distance in eq. (2) as a share of the mean length of a street. The printed unit,
/// one metre, lets a difference of ten metres decide everything; a whole length lets a street turn
/// off at any angle.
const UNIT: f64 = 0.12;
/// The unit of what is amiss around a patch, as a share of the streets there.
const FIT_UNIT: f64 = 0.05;

/// Turns that are tried where pieces may be turned.
const TURNS: i32 = 4;

/// A connector that may continue a street: the distance of eq. (2), then its weight; its patch,
/// itself, and the number of the motion.
type Candidate = (f64, usize, ChainEnd, usize);

/// Draws patches for `node` by eq. (2) until one lies, at most [`TRIES`].
///
/// The paper sets the probability of illegal patches to 0 before the draw; drawing without
/// replacement until a legal one comes is the same distribution and looks at fewer.
pub fn draw(growth: &mut Growth, node: NodeId) -> bool {
    let at = growth.net.graph.node(node).at.to_m();
    let example = growth.plan.example_at(at);
    let piece = growth.piece(example, at);
    let pieces: Vec<Coherent> = motions(growth.params, piece.motion)
        .into_iter()
        .map(|motion| Coherent { motion, ..piece })
        .collect();
    let style = growth.style(example);
    let mut weighted = candidates(growth, node, &pieces);
    let Some(least) = weighted.first().map(|c| c.0) else { return false };
    let unit_m = UNIT * growth.street_m(node);
    for (distance, _, end, motion) in &mut weighted {
        let root = style.layer.nodes[style.layer.tail(*end)].at;
        let piece = Coherent { source: root, ..pieces[*motion] };
        let amiss = 1.0 - fit::of(growth, &piece).quality();
        let (met, missed) = fit::met(growth, &piece);
        let grain = GRAIN_GAIN * fit::grain(growth, &piece);
        let gain = grain + MET_GAIN * f64::from(met) - MISSED_LOSS * f64::from(missed);
        *distance = trig::exp(-(*distance - least) / unit_m - amiss / FIT_UNIT + gain);
    }
    for _ in 0..TRIES.min(weighted.len()) {
        let (_, patch, end, motion) = weighted.remove(pick(&weighted, growth));
        let root = style.layer.tail(end);
        let piece = Coherent { source: style.layer.nodes[root].at, ..pieces[motion] };
        if placing::place(growth, node, patch, root, piece) {
            growth.begin(&piece);
            let vertex = &mut growth.net.graph.node_mut(node).data;
            vertex.link = Some(style.layer.nodes[root].example);
            vertex.piece = Some(piece);
            placing::adopt(growth, end, piece);
            return true;
        }
    }
    false
}

/// The motions that a piece may have by the user's will: its own, turned, and these mirrored.
fn motions(params: &Params, own: Motion) -> Vec<Motion> {
    let mut motions = vec![own];
    if params.turn_pieces > 0.0 {
        let step = params.turn_pieces.to_radians() / f64::from(TURNS);
        let turns = (1..=TURNS).flat_map(|k| [k, -k]);
        motions.extend(
            turns.map(|k| Motion { turn: trig::unit(f64::from(k) * step).rotate(own.turn), ..own }),
        );
    }
    if params.mirror_pieces {
        let mirrored = |motion: &Motion| Motion { mirrored: !motion.mirrored, ..*motion };
        motions.extend(motions.clone().iter().map(mirrored));
    }
    motions
}

/// The nearest connectors to the streets that arrive at `node`, one of each patch, nearest first.
fn candidates(growth: &Growth, node: NodeId, pieces: &[Coherent]) -> Vec<Candidate> {
    let mut best: Vec<Candidate> = Vec::new();
    for line in growth.net.arriving(node) {
        let arriving = learn::arriving_shape(&line);
        for (number, piece) in pieces.iter().enumerate() {
            let connectors = &growth.style(piece.example).connectors;
            let shape: Vec<Vec2> = arriving.iter().map(|p| piece.motion.undo(*p)).collect();
            for index in connectors.near(shape[SAMPLES - 1], COMPARED) {
                let connector = &connectors.list[index as usize];
                let distance = polyline::hausdorff(&shape, &connector.shape);
                best.push((distance, connector.patch, connector.end, number));
            }
        }
    }
    best.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut seen = Vec::new();
    best.retain(|(_, patch, ..)| {
        let new = !seen.contains(patch);
        if new {
            seen.push(*patch);
        }
        new
    });
    best.truncate(LOOKED_AT);
    best
}

/// Lays a local street away from a main street in about `direction`: one of the example's own side
/// streets that leaves likewise, else one from statistics.
pub fn away(growth: &mut Growth, node: NodeId, direction: Vec2) {
    if !growth.is_open(node, direction, 0.8) {
        return;
    }
    let at = growth.net.graph.node(node).at.to_m();
    let example = growth.plan.example_at(at);
    let piece = growth.piece(example, at);
    let layer = &growth.style(example).layer;
    let wanted = piece.motion.undo(direction);
    let mut branches: Vec<Candidate> = Vec::new();
    for node in layer.nodes.iter().filter(|n| n.kind == NodeKind::OnMain) {
        for &end in &node.ends {
            let off = trig::angle_between(layer.direction(end), wanted);
            if off < 0.35 && layer.chains[end.chain].length_m > 20.0 {
                branches.push((trig::exp(-off / 0.1), 0, end, 0));
            }
        }
    }
    for _ in 0..3.min(branches.len()) {
        let (_, _, end, _) = branches.remove(pick(&branches, growth));
        let source = layer.nodes[layer.tail(end)].at;
        let piece = Coherent { source, ..piece };
        let batch = growth.next_batch();
        if let Some(laid) = placing::connector(growth, node, end, piece, batch) {
            growth.begin(&piece);
            if laid.is_whole {
                growth.enqueue(laid.to);
            }
            return;
        }
    }
    procedural::step(growth, node, direction);
}

/// An index drawn by weight.
fn pick(weighted: &[Candidate], growth: &mut Growth) -> usize {
    let total: f64 = weighted.iter().map(|w| w.0).sum();
    let mut left = growth.rng.random_range(0.0..1.0) * total;
    for (i, (weight, ..)) in weighted.iter().enumerate() {
        left -= weight;
        if left < 0.0 {
            return i;
        }
    }
    weighted.len() - 1
}
