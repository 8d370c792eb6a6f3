//! Copying patches: continuation, branches, and the placing of one patch.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Vec2};
use exurb_graph::NodeId;

use super::growth::Growth;
use super::layer::ChainEnd;
use super::network::{Coherent, JOIN_M, Vertex, Wish};
use super::patch::Patch;

/// Copies that come to lie this near to an existing node are that node.
const SAME_M: f64 = 1.0;
/// Angle under which an edge of a patch repeats one that is there, in radians.
const REDUNDANT_RAD: f64 = 0.3;
/// Edges of the patch may meet others at a sharper angle than procedural ones: the example's own.
const PATCH_ANGLE_RAD: f64 = 0.45;

/// Follows the example: places the patch that owns the original of `node` (the layer's node `own`)
/// with its copy on `node`. False when there is none or it may not lie there.
pub fn continuation(growth: &mut Growth, node: NodeId, own: usize) -> bool {
    let vertex = &growth.net.graph.node(node).data;
    let (start, piece) = (vertex.start, vertex.piece);
    let style = growth.style(start);
    match style.layer.nodes[own].patch {
        Some(patch) => place(growth, node, patch, own, piece),
        None => false,
    }
}

/// Lays the example's local street `end` from a node of a main street, in the piece that this belongs
/// to, and lets growth go on at its other end.
pub fn branch(growth: &mut Growth, node: NodeId, end: ChainEnd) {
    let Some(n) = growth.net.graph.get_node(node) else { return };
    let (start, coherent) = (n.data.start, n.data.piece);
    let at = n.at.to_m();
    let style = growth.style(start);
    let line = style.layer.line(end);
    let shift = at - line[0];
    let line: Vec<Vec2> = line.into_iter().map(|p| p + shift).collect();
    let far = style.layer.head(end);
    let vertex = growth.copy_of(far, start, coherent);
    let part = match style.layer.nodes[far].patch {
        Some(patch) => style.patches[patch].label.clone(),
        None => "between main streets".into(),
    };
    let batch = growth.next_batch();
    let piece = growth.copied(&style.layer.chains[end.chain].street, start, &part, batch);
    let dead_end = vertex.dead_end;
    let wish = Wish { least_angle_rad: PATCH_ANGLE_RAD, dead_end, ..Wish::free(batch) };
    if let Some(laid) = growth.lay(node, &line, wish, piece, vertex, &[])
        && laid.is_whole
    {
        growth.enqueue(laid.to);
    }
}

/// Places `patch` with its core node `root` on `node` as part of `coherent`. Inner chains lie as in the example or the
/// patch is refused; connectors are cut where they meet a street. Returns whether anything was laid.
pub fn place(
    growth: &mut Growth,
    node: NodeId,
    patch: usize,
    root: usize,
    coherent: Option<Coherent>,
) -> bool {
    let (at, start) = {
        let n = growth.net.graph.node(node);
        (n.at.to_m(), n.data.start)
    };
    let style = growth.style(start);
    let (layer, patch) = (&style.layer, &style.patches[patch]);
    let shift = at - layer.nodes[root].at;

    // Core nodes: those that are there already, and places for the others.
    let mut inside = 0;
    let mut nodes: BTreeMap<usize, Option<NodeId>> = BTreeMap::new();
    for &core in &patch.core {
        let place = layer.nodes[core].at + shift;
        inside += usize::from(growth.area.contains(GridPoint::round(place)));
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
    let batch = growth.next_batch();
    let copy = Copy { patch, shift, batch, start, coherent };
    let Some(made) = lay_inner(growth, &copy, &mut nodes) else {
        return false;
    };
    let mut laid = made;

    for &end in &patch.outer {
        let Some(Some(from)) = nodes.get(&layer.tail(end)).copied() else { continue };
        let line: Vec<Vec2> = layer.line(end).into_iter().map(|p| p + shift).collect();
        if growth.net.angle_at(from, &line, batch) < REDUNDANT_RAD {
            continue;
        }
        let far = layer.head(end);
        let vertex = growth.copy_of(far, start, coherent);
        let piece = growth.copied(&layer.chains[end.chain].street, start, &patch.label, batch);
        let via = layer.via(end);
        let dead_end = vertex.dead_end;
        let wish = Wish { least_angle_rad: PATCH_ANGLE_RAD, dead_end, ..Wish::free(batch) };
        let exists = growth.net.node_near(line[line.len() - 1], SAME_M, Some(from));
        let wish = if exists.is_some() { Wish { to: exists, ..wish } } else { wish };
        let result =
            growth.lay(from, &line, wish, piece.clone(), vertex.clone(), &via).or_else(|| {
                exists?;
                growth.lay(from, &line, Wish { to: None, ..wish }, piece, vertex, &via)
            });
        if let Some(line) = result {
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
    shift: Vec2,
    batch: u32,
    start: usize,
    coherent: Option<Coherent>,
}

/// Lays the inner chains, or nothing. `None` when one of them may not lie there; else whether
/// anything was laid.
fn lay_inner(
    growth: &mut Growth,
    copy: &Copy,
    nodes: &mut BTreeMap<usize, Option<NodeId>>,
) -> Option<bool> {
    let &Copy { patch, shift, batch, start, coherent } = copy;
    let style = growth.style(start);
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
        let line: Vec<Vec2> = layer.line(end).into_iter().map(|p| p + shift).collect();
        let head = layer.head(end);
        let to = nodes.get(&head).copied().flatten();
        let back: Vec<Vec2> = line.iter().rev().copied().collect();
        let repeats = growth.net.angle_at(from, &line, batch) < REDUNDANT_RAD
            && to.is_some_and(|n| growth.net.angle_at(n, &back, batch) < REDUNDANT_RAD);
        if repeats {
            continue;
        }
        let piece = growth.copied(&layer.chains[chain].street, start, &patch.label, batch);
        // Inner chains arrive exactly: their far node is made first.
        let arrives = to.unwrap_or_else(|| {
            let vertex = growth.copy_of(head, start, coherent);
            growth.net.add_node(GridPoint::round(line[line.len() - 1]), vertex)
        });
        let wish = Wish { to: Some(arrives), least_angle_rad: 0.2, ..Wish::free(batch) };
        let edges = growth.net.graph.edge_bound();
        let via = layer.via(end);
        let vertex = Vertex { start, piece: coherent, ..Vertex::default() };
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

/// Mean length of the layer's streets, for scales.
pub fn street_m(growth: &Growth, start: usize) -> f64 {
    let mean = growth.style(start).statistics.length_mean_m;
    if mean > 0.0 { mean } else { 100.0 }
}
