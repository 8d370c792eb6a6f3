//! Copying patches: continuation, branches, and the placing of one patch.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_geom::{GridPoint, Vec2};
use exurb_graph::NodeId;

use super::growth::{Growth, Laid};
use super::layer::{ChainEnd, NodeKind};
use super::network::{Coherent, JOIN_M, Vertex, Wish};
use super::patch::Patch;
use super::seams;

/// Copies that come to lie this near to an existing node are that node.
const SAME_M: f64 = 1.0;
/// Side streets of a connector are moved by at most this to the street that it is copied onto.
const ADOPTED_M: f64 = 25.0;
/// Angle under which an edge of a patch repeats one that is there, in radians.
const REDUNDANT_RAD: f64 = 0.3;
/// Edges of the patch may meet others at a sharper angle than procedural ones: the example's own.
const PATCH_ANGLE_RAD: f64 = 0.45;

/// Follows the example: places the patch that owns the original of `node` (the layer's node `own`)
/// with its copy on `node`. False when there is none or it may not lie there.
pub fn continuation(growth: &mut Growth, node: NodeId, piece: Coherent, own: usize) -> bool {
    match growth.style(piece.example).layer.nodes[own].patch {
        Some(patch) => place(growth, node, patch, own, piece),
        None => false,
    }
}

/// Lays the example's local street `end` from a node of a main street, in the piece that this belongs
/// to, and lets growth go on at its other end.
pub fn branch(growth: &mut Growth, node: NodeId, end: ChainEnd) {
    let Some(n) = growth.net.graph.get_node(node) else { return };
    let (Some(coherent), at) = (n.data.piece, n.at.to_m()) else { return };
    if !growth.holds(&coherent, at) {
        return;
    }
    let batch = growth.next_batch();
    if let Some(laid) = connector(growth, node, end, coherent, batch)
        && laid.is_whole
    {
        growth.enqueue(laid.to);
    }
}

/// The patch that a chain belongs to, for provenance.
pub fn part_of(growth: &Growth, end: ChainEnd, example: usize) -> Arc<str> {
    let style = growth.style(example);
    let ends = [style.layer.tail(end), style.layer.head(end)];
    match ends.into_iter().find_map(|n| style.layer.nodes[n].patch) {
        Some(patch) => style.patches[patch].label.clone(),
        None => "between main streets".into(),
    }
}

/// Makes the side streets along the connector by which a piece was chosen begin on the street that
/// arrived, where it runs through the piece's own ground.
pub fn adopt(growth: &mut Growth, end: ChainEnd, piece: Coherent) {
    let layer = &growth.style(piece.example).layer;
    let line = layer.line(end);
    for (i, link) in layer.via(end) {
        let p = piece.place(line[i]);
        let Some((edge, at)) = growth.net.edge_near(p, ADOPTED_M) else { continue };
        if !growth.holds(&piece, at) || growth.net.graph.edge(edge).data.is_fixed() {
            continue;
        }
        if let Some(middle) = growth.net.split(edge, GridPoint::round(at)) {
            let data = &mut growth.net.graph.node_mut(middle).data;
            (data.link, data.piece) = (Some(link), Some(piece));
        }
    }
}

/// Lays the connector or dead end `end` of `coherent` from `node`, as far as it gets.
pub fn connector(
    growth: &mut Growth,
    node: NodeId,
    end: ChainEnd,
    coherent: Coherent,
    batch: u32,
) -> Option<Laid> {
    let at = growth.net.graph.get_node(node)?.at.to_m();
    let style = growth.style(coherent.example);
    let layer = &style.layer;
    let line = layer.line(end);
    let line = coherent.motion.lay(&line, line[0], at);
    if growth.net.angle_at(node, &line, batch) < REDUNDANT_RAD {
        return None;
    }
    let vertex = growth.copy_of(layer.head(end), coherent);
    let part = part_of(growth, end, coherent.example);
    let piece = growth.copied(&layer.chains[end.chain].street, coherent.example, &part, batch);
    let via = layer.via(end);
    let dead_end = vertex.dead_end;
    let wish = Wish { least_angle_rad: PATCH_ANGLE_RAD, dead_end, ..Wish::free(batch) };
    let exists = growth.net.node_near(line[line.len() - 1], SAME_M, Some(node));
    if exists.is_some() {
        let wish = Wish { to: exists, ..wish };
        let laid = growth.lay(node, &line, wish, piece.clone(), vertex.clone(), &via);
        if laid.is_some() {
            return laid;
        }
    }
    growth.lay(node, &line, wish, piece, vertex, &via)
}

/// Places `patch` with its core node `root` on `node` as part of `coherent`. Inner chains lie as in the example or the
/// patch is refused; connectors are cut where they meet a street. Returns whether anything was laid.
pub fn place(
    growth: &mut Growth,
    node: NodeId,
    patch: usize,
    root: usize,
    coherent: Coherent,
) -> bool {
    let at = growth.net.graph.node(node).at.to_m();
    let style = growth.style(coherent.example);
    let (layer, patch) = (&style.layer, &style.patches[patch]);
    let copy = Copy { patch, root: layer.nodes[root].at, at, batch: growth.next_batch(), coherent };

    // Core nodes: those that are there already, and places for the others.
    let mut inside = 0;
    let mut nodes: BTreeMap<usize, Option<NodeId>> = BTreeMap::new();
    for &core in &patch.core {
        let place = copy.place(layer.nodes[core].at);
        inside += usize::from(growth.inside.contains(GridPoint::round(place)));
        let there =
            if core == root { Some(node) } else { growth.net.node_near(place, SAME_M, None) };
        if there.is_none() && core != root && !patch.inner.is_empty() {
            // A core node beside a street that is not its own would be a near miss.
            if let Some((_, q)) = growth.net.edge_near(place, JOIN_M * 0.5)
                && q.distance(at) > JOIN_M
            {
                return false;
            }
        }
        nodes.insert(core, there);
    }
    // The authors' program asks for half of the patch inside.
    if inside * 2 < patch.core.len() {
        return false;
    }
    let batch = copy.batch;
    let Some(made) = lay_inner(growth, &copy, &mut nodes) else {
        return false;
    };
    let mut laid = made;

    for &end in &patch.outer {
        let Some(Some(from)) = nodes.get(&layer.tail(end)).copied() else { continue };
        let far = &layer.nodes[layer.head(end)];
        let place = copy.place(far.at);
        let leaves = far.kind == NodeKind::Junction && !growth.is_own(&coherent, place);
        if leaves && growth.net.node_near(place, SAME_M, None).is_none() {
            // The street leaves the piece: it waits until it is known what lies there.
            seams::wait(growth, from, end, coherent);
            laid = true;
        } else if let Some(line) = connector(growth, from, end, coherent, batch) {
            laid = true;
            if line.is_whole {
                growth.enqueue(line.to);
            }
        }
    }
    laid
}

/// A patch as it is to lie.
struct Copy<'a> {
    patch: &'a Patch,
    /// The place in the example that comes to lie on `at`.
    root: Vec2,
    at: Vec2,
    batch: u32,
    coherent: Coherent,
}

impl Copy<'_> {
    fn place(&self, p: Vec2) -> Vec2 {
        self.at + self.coherent.motion.apply(p - self.root)
    }

    fn line(&self, line: &[Vec2]) -> Vec<Vec2> {
        self.coherent.motion.lay(line, self.root, self.at)
    }
}

/// Lays the inner chains, or nothing. `None` when one of them may not lie there; else whether
/// anything was laid.
fn lay_inner(
    growth: &mut Growth,
    copy: &Copy,
    nodes: &mut BTreeMap<usize, Option<NodeId>>,
) -> Option<bool> {
    let &Copy { patch, batch, coherent, .. } = copy;
    let style = growth.style(coherent.example);
    let layer = &style.layer;
    let mut undo: Vec<exurb_graph::EdgeId> = Vec::new();
    let mut laid = false;
    // From the root outwards, so that every chain begins at a node that is there.
    let mut open: Vec<usize> = patch.inner.clone();
    while !open.is_empty() {
        let ready = open.iter().position(|c| {
            let chain = &layer.chains[*c];
            nodes.get(&chain.from).copied().flatten().is_some()
                || nodes.get(&chain.to).copied().flatten().is_some()
        });
        // What hangs together with nothing that is there cannot be laid.
        let Some(ready) = ready else { break };
        let chain = open.remove(ready);
        let forward = nodes.get(&layer.chains[chain].from).copied().flatten().is_some();
        let end = ChainEnd { chain, forward };
        let from = nodes.get(&layer.tail(end)).copied().flatten()?;
        let line = copy.line(&layer.line(end));
        let head = layer.head(end);
        let to = nodes.get(&head).copied().flatten();
        let back: Vec<Vec2> = line.iter().rev().copied().collect();
        let repeats = growth.net.angle_at(from, &line, batch) < REDUNDANT_RAD
            && to.is_some_and(|n| growth.net.angle_at(n, &back, batch) < REDUNDANT_RAD);
        if repeats {
            continue;
        }
        let street = &layer.chains[chain].street;
        let piece = growth.copied(street, coherent.example, &patch.label, batch);
        // Inner chains arrive exactly: their far node is made first.
        let arrives = to.unwrap_or_else(|| {
            let vertex = growth.copy_of(head, coherent);
            growth.net.add_node(GridPoint::round(line[line.len() - 1]), vertex)
        });
        let wish = Wish { to: Some(arrives), least_angle_rad: 0.2, ..Wish::free(batch) };
        let edges = growth.net.graph.edge_bound();
        let via = layer.via(end);
        let vertex = Vertex { piece: Some(coherent), ..Vertex::default() };
        if growth.lay(from, &line, wish, piece, vertex, &via).is_some() {
            laid = true;
            nodes.insert(head, Some(arrives));
            let new = edges..growth.net.graph.edge_bound();
            undo.extend(new.map(|e| exurb_graph::EdgeId(e as u32)));
        } else {
            if to.is_none() {
                growth.net.remove_lonely(arrives);
            }
            for edge in undo.into_iter().rev() {
                if growth.net.graph.get_edge(edge).is_some() {
                    growth.net.remove_edge(edge);
                }
            }
            return None;
        }
    }
    Some(laid)
}
