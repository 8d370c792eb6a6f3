//! Oneways that traffic can enter and not leave, or leave and not enter.
//!
//! Pieces bring their oneways along, and where a piece ends its counterpart may be missing. Such streets
//! become two-way, no others: every place can then be reached from every other, as far as streets hang
//! together. Streets that run on outside hang together there.

use exurb_city::StreetGraph;
use exurb_graph::{EdgeId, NodeId};
use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

/// Makes oneways between parts of the network that are not strongly connected two-way, where they
/// `may_change`; at nodes that `run_on` traffic comes and goes. O(streets).
pub fn open_traps(
    streets: &mut StreetGraph,
    runs_on: impl Fn(&StreetGraph, NodeId) -> bool,
    may_change: impl Fn(&StreetGraph, EdgeId) -> bool,
) {
    let part = strong_parts(streets, runs_on);
    let apart =
        |e: &exurb_graph::Edge<exurb_city::Street>| part[e.from.index()] != part[e.to.index()];
    let traps: Vec<EdgeId> = streets
        .edges()
        .filter(|(id, e)| e.data.oneway && apart(e) && may_change(streets, *id))
        .map(|(id, _)| id)
        .collect();
    for id in traps {
        let street = &mut streets.edge_mut(id).data;
        // What is left of a roundabout is a street.
        (street.oneway, street.roundabout) = (false, false);
    }
}

/// The number of the strongly connected part of every node.
fn strong_parts(
    streets: &StreetGraph,
    runs_on: impl Fn(&StreetGraph, NodeId) -> bool,
) -> Vec<usize> {
    let bound = streets.node_bound();
    let mut graph = DiGraph::<(), ()>::new();
    let nodes: Vec<NodeIndex> = (0..=bound).map(|_| graph.add_node(())).collect();
    let outside = nodes[bound];
    for (_, edge) in streets.edges() {
        let (from, to) = (nodes[edge.from.index()], nodes[edge.to.index()]);
        graph.add_edge(from, to, ());
        if !edge.data.oneway {
            graph.add_edge(to, from, ());
        }
    }
    for (id, _) in streets.nodes().filter(|(id, _)| runs_on(streets, *id)) {
        graph.add_edge(nodes[id.index()], outside, ());
        graph.add_edge(outside, nodes[id.index()], ());
    }
    let mut part = vec![0; bound + 1];
    for (number, members) in kosaraju_scc(&graph).into_iter().enumerate() {
        members.into_iter().for_each(|node| part[node.index()] = number);
    }
    part
}

#[cfg(test)]
mod tests {
    use exurb_city::{Street, street_graph};
    use exurb_geom::GridPoint;
    use proptest::prelude::*;

    use super::*;

    /// A grid of 5 by 5 junctions; `oneway` tells which streets are.
    fn grid(oneway: &[bool]) -> StreetGraph {
        let at = |x: i32, y: i32| GridPoint::m(f64::from(x) * 100.0, f64::from(y) * 100.0);
        let mut lines = Vec::new();
        for i in 0..5 {
            for j in 0..4 {
                lines.push([at(i, j), at(i, j + 1)]);
                lines.push([at(j, i), at(j + 1, i)]);
            }
        }
        let lines = lines.into_iter().zip(oneway);
        let street = |oneway: &bool| Street { oneway: *oneway, ..Street::default() };
        street_graph::from_lines(lines.map(|(line, oneway)| (line.to_vec(), street(oneway))))
    }

    fn is_corner(streets: &StreetGraph, id: NodeId) -> bool {
        streets.node(id).at == GridPoint::m(0.0, 0.0)
    }

    proptest! {
        /// Everything can be reached, nothing else became two-way, and a second look finds nothing.
        #[test]
        fn every_place_can_be_reached(oneway in prop::collection::vec(any::<bool>(), 40)) {
            let before = grid(&oneway);
            let parts = strong_parts(&before, is_corner);
            let mut after = before.clone();
            open_traps(&mut after, is_corner, |_, _| true);
            let joined = strong_parts(&after, is_corner);
            prop_assert!(after.nodes().all(|(id, _)| joined[id.index()] == joined[0]));
            for ((_, a), (_, b)) in before.edges().zip(after.edges()) {
                let was_trap = parts[a.from.index()] != parts[a.to.index()];
                prop_assert_eq!(b.data.oneway, a.data.oneway && !was_trap);
            }
            let mut kept = before.clone();
            open_traps(&mut kept, is_corner, |_, _| false);
            prop_assert!(kept.edges().zip(before.edges()).all(|(a, b)| a.1.data == b.1.data));
        }
    }
}
