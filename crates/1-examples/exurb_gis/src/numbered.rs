//! Cities whose streets are numbered without gaps, as files number them.

use std::sync::Arc;

use exurb_city::{Block, City};
use exurb_graph::EdgeId;

/// The same city with nodes and edges of the street graph renumbered in their order, and the sides
/// of its blocks with them. Shares all that needs no change.
pub fn numbered(city: &City) -> City {
    let graph = &city.streets;
    let whole =
        graph.node_count() == graph.node_bound() && graph.edge_count() == graph.edge_bound();
    let mut next = city.clone();
    if whole && blocks_know_their_streets(city) {
        return next;
    }
    let mut new_id = vec![None; graph.edge_bound()];
    for ((old, _), new) in graph.edges().zip(0..) {
        new_id[old.index()] = Some(EdgeId(new));
    }
    let renumber = |ids: &[EdgeId]| -> Vec<EdgeId> {
        ids.iter().filter_map(|id| new_id.get(id.index()).copied().flatten()).collect()
    };
    let block = |b: &Block| Block {
        sides: renumber(&b.sides),
        dead_ends: renumber(&b.dead_ends),
        ..b.clone()
    };
    next.streets = Arc::new(graph.compacted());
    next.blocks = Arc::new(city.blocks.iter().map(block).collect());
    next
}

fn blocks_know_their_streets(city: &City) -> bool {
    let known = |id: &EdgeId| city.streets.get_edge(*id).is_some();
    city.blocks.iter().all(|b| b.sides.iter().chain(&b.dead_ends).all(known))
}
