//! Drawing the next patch by how well it continues the street that arrives (eq. 2).

use exurb_geom::{Vec2, polyline, trig};
use exurb_graph::NodeId;
use rand::RngExt;

use super::growth::Growth;
use super::layer::{ChainEnd, NodeKind};
use super::learn::{self, SAMPLES};
use super::{fit, placing, procedural};

/// Connectors compared at least; more, if they lie as near.
const COMPARED: usize = 48;
/// Patches tried before growth falls back to statistics.
const TRIES: usize = 6;
/// The unit of the distance in eq. (2) as a share of the mean length of a street. The printed unit,
/// one metre, lets a difference of ten metres decide everything; a whole length lets a street turn
/// off at any angle.
const UNIT: f64 = 0.12;
/// Patches whose surroundings are looked at.
const LOOKED_AT: usize = 24;
/// The unit of what is amiss around a patch, as a share of the streets there.
const FIT_UNIT: f64 = 0.05;

/// Draws patches for `node` by eq. (2) until one lies, at most [`TRIES`].
///
/// The paper sets the probability of illegal patches to 0 before the draw; drawing without
/// replacement until a legal one comes is the same distribution and looks at fewer.
pub fn draw(growth: &mut Growth, node: NodeId) -> bool {
    let (at, start) = {
        let n = growth.net.graph.node(node);
        (n.at.to_m(), n.data.start)
    };
    let style = growth.style(start);
    let arriving = growth.net.arriving(node);
    let unit_m = UNIT * placing::street_m(growth, start);
    // Distance of the best connector of each patch to any of the arriving streets.
    let mut best: Vec<(f64, usize, ChainEnd)> = Vec::new();
    for line in &arriving {
        let shape = learn::arriving_shape(line);
        for index in style.connectors.near(shape[SAMPLES - 1], COMPARED) {
            let connector = &style.connectors.list[index as usize];
            let distance = polyline::hausdorff(&shape, &connector.shape);
            best.push((distance, connector.patch, connector.end));
        }
    }
    best.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut seen = Vec::new();
    best.retain(|(_, patch, _)| {
        let new = !seen.contains(patch);
        if new {
            seen.push(*patch);
        }
        new
    });
    best.truncate(LOOKED_AT);
    let Some(least) = best.first().map(|b| b.0) else { return false };
    let mut weighted: Vec<(f64, usize, ChainEnd)> = best
        .into_iter()
        .map(|(d, patch, end)| {
            let root = style.layer.nodes[style.layer.tail(end)].at;
            let amiss = 1.0 - fit::of(growth, start, root, at).quality();
            (trig::exp(-(d - least) / unit_m - amiss / FIT_UNIT), patch, end)
        })
        .collect();
    for _ in 0..TRIES.min(weighted.len()) {
        let (_, patch, end) = weighted.remove(pick(&weighted, growth));
        let root = style.layer.tail(end);
        let piece = Some(growth.begin_piece(at));
        if placing::place(growth, node, patch, root, piece) {
            let vertex = &mut growth.net.graph.node_mut(node).data;
            (vertex.link, vertex.piece) = (Some(style.layer.nodes[root].example), piece);
            return true;
        }
    }
    false
}

/// Lays a local street away from a main street in about `direction`: one of the example's own side
/// streets that leaves likewise, else one from statistics.
pub fn away(growth: &mut Growth, node: NodeId, direction: Vec2) {
    let start = growth.net.graph.node(node).data.start;
    if !growth.is_open(node, direction, 0.8) {
        return;
    }
    let style = growth.style(start);
    let layer = &style.layer;
    let mut branches: Vec<(f64, usize, ChainEnd)> = Vec::new();
    for node in layer.nodes.iter().filter(|n| n.kind == NodeKind::OnMain) {
        for &end in &node.ends {
            let off = trig::angle_between(layer.direction(end), direction);
            if off < 0.35 && layer.chains[end.chain].length_m > 20.0 {
                branches.push((trig::exp(-off / 0.1), 0, end));
            }
        }
    }
    let piece = growth.begin_piece(growth.net.graph.node(node).at.to_m());
    growth.net.graph.node_mut(node).data.piece = Some(piece);
    for _ in 0..3.min(branches.len()) {
        let (_, _, end) = branches.remove(pick(&branches, growth));
        let before = growth.net.graph.degree(node);
        placing::branch(growth, node, end);
        if growth.net.graph.degree(node) > before {
            return;
        }
    }
    procedural::step(growth, node, direction);
}

/// An index drawn by weight.
fn pick<T, U>(weighted: &[(f64, T, U)], growth: &mut Growth) -> usize {
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
