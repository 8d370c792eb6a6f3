//! What is left between two streets from one node to another.

use std::collections::BTreeMap;

use exurb_geom::Polygon;
use exurb_graph::{EdgeId, NodeId};

use super::rebuild::joined;
use crate::{StreetGraph, block::ISLAND_WIDTH_M, street_graph};

/// Loops narrower than this are folds, in metres.
const LEAST_LOOP_WIDTH_M: f64 = 2.0;

/// Joins streets between the same two nodes that enclose nothing but an island: the approaches to
/// a former roundabout, turning lanes. Drops loops that are folds.
pub fn close(graph: &StreetGraph) -> StreetGraph {
    let mut out = graph.clone();
    for (id, edge) in graph.edges().filter(|(_, e)| e.from == e.to) {
        if !Polygon::new(edge.line().to_vec(), Vec::new())
            .is_some_and(|p| p.mean_width_m() >= LEAST_LOOP_WIDTH_M)
        {
            out.remove_edge(id);
        }
    }
    let mut between: BTreeMap<(NodeId, NodeId), Vec<EdgeId>> = BTreeMap::new();
    for (id, edge) in graph.edges().filter(|(_, e)| e.from != e.to) {
        let key = (edge.from.min(edge.to), edge.from.max(edge.to));
        between.entry(key).or_default().push(id);
    }
    for ids in between.values().filter(|ids| ids.len() > 1) {
        for (i, first) in ids.iter().enumerate() {
            for second in &ids[i + 1..] {
                join_if_narrow(&mut out, *first, *second);
            }
        }
    }
    out.remove_isolated_nodes();
    street_graph::dissolve_all(&mut out);
    out.compacted()
}

/// Drops the longer of two edges with no more than an island between; the other one takes over what
/// it carried when they are opposite oneways.
fn join_if_narrow(graph: &mut StreetGraph, first: EdgeId, second: EdgeId) {
    let (Some(a), Some(b)) = (graph.get_edge(first), graph.get_edge(second)) else { return };
    if a.data.crossing_level() != b.data.crossing_level() {
        return;
    }
    let mut ring = a.line().to_vec();
    let forward = b.from == a.to;
    let back = b.line().iter().copied();
    if forward {
        ring.extend(back.skip(1));
    } else {
        ring.extend(back.rev().skip(1));
    }
    let narrow = Polygon::new(ring, Vec::new()).is_none_or(|p| p.mean_width_m() < ISLAND_WIDTH_M);
    if !narrow {
        return;
    }
    let opposite = a.data.oneway && b.data.oneway && forward;
    let (stays, goes) =
        if a.length_m() <= b.length_m() { (first, second) } else { (second, first) };
    let (kept, gone) = (graph.edge(stays).data.clone(), graph.edge(goes).data.clone());
    let mut street = if opposite { joined(&kept, &gone) } else { kept.clone() };
    street.class = kept.class.min(gone.class);
    street.oneway = kept.oneway && gone.oneway && !opposite;
    graph.remove_edge(goes);
    graph.edge_mut(stays).data = street;
}
