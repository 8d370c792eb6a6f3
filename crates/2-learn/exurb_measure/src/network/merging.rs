//! What the drawing of a map splits and a measure should not: wide junctions, carriageways, loops.

use exurb_city::StreetGraph;
use exurb_geom::{GridPoint, Vec2, polyline};
use exurb_graph::{EdgeId, NodeId};

/// Junctions nearer than this along a street are one, in metres.
const CLOSE_M: f64 = 10.0;
/// Shorter loops are turning places, in metres.
const LOOP_M: f64 = 40.0;
/// Twins have mid-points nearer than this, in metres.
const TWIN_APART_M: f64 = 25.0;
/// Twins differ in length by no more than this share and this many metres.
const TWIN_SHARE: f64 = 0.2;
const TWIN_SLACK_M: f64 = 2.0;

/// Junctions joined by streets under 10 m move to their common middle and become one.
pub fn merge_close_junctions(graph: &mut StreetGraph) {
    let is_junction = |n: NodeId| graph.degree(n) >= 3 && !graph.node(n).data.cut;
    let mut group: Vec<u32> = (0..graph.node_bound() as u32).collect();
    let mut short: Vec<EdgeId> = Vec::new();
    for (id, edge) in graph.edges() {
        let apart = edge.from != edge.to && is_junction(edge.from) && is_junction(edge.to);
        if apart && edge.length_m() < CLOSE_M {
            let (a, b) = (root(&mut group, edge.from.0), root(&mut group, edge.to.0));
            group[a.max(b) as usize] = a.min(b);
            short.push(id);
        }
    }
    let mut members: Vec<(u32, NodeId)> = Vec::new();
    for id in &short {
        let edge = graph.edge(*id);
        members.extend([edge.from, edge.to].map(|n| (root(&mut group, n.0), n)));
    }
    members.sort_unstable();
    members.dedup();
    for id in short {
        graph.remove_edge(id);
    }
    for cluster in members.chunk_by(|a, b| a.0 == b.0) {
        let at = cluster.iter().map(|(_, n)| graph.node(*n).at.to_m()).sum::<Vec2>();
        let middle = GridPoint::round(at / cluster.len() as f64);
        let kept = cluster[0].1;
        graph.move_node(kept, middle);
        for (_, gone) in &cluster[1..] {
            graph.merge_nodes(kept, *gone);
        }
    }
}

/// The first node of the group of `of`; groups are chains of smaller numbers.
fn root(group: &mut [u32], mut of: u32) -> u32 {
    while group[of as usize] != of {
        group[of as usize] = group[group[of as usize] as usize];
        of = group[of as usize];
    }
    of
}

/// Streets under 40 m that come back to where they begin go.
pub fn drop_small_loops(graph: &mut StreetGraph) {
    let loops = graph.edges().filter(|(_, e)| e.from == e.to && e.length_m() < LOOP_M);
    for id in loops.map(|(id, _)| id).collect::<Vec<_>>() {
        graph.remove_edge(id);
    }
}

/// Of streets between the same two nodes that are about as long and lie side by side the first stays.
pub fn drop_twins(graph: &mut StreetGraph) {
    let mut ends: Vec<(NodeId, NodeId, EdgeId)> = graph
        .edges()
        .filter(|(_, e)| e.from != e.to)
        .map(|(id, e)| (e.from.min(e.to), e.from.max(e.to), id))
        .collect();
    ends.sort_unstable();
    for parallel in ends.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|p| p.len() > 1) {
        let mut kept: Vec<(f64, Vec2)> = Vec::new();
        for (_, _, id) in parallel {
            let line = graph.edge(*id).line_m();
            let length_m = polyline::length(&line);
            let middle = polyline::point_at(&line, length_m / 2.0);
            let is_twin = |(other_m, other): &(f64, Vec2)| {
                let slack_m = TWIN_SHARE * length_m.max(*other_m) + TWIN_SLACK_M;
                (length_m - other_m).abs() <= slack_m && middle.distance(*other) < TWIN_APART_M
            };
            if kept.iter().any(is_twin) {
                graph.remove_edge(*id);
            } else {
                kept.push((length_m, middle));
            }
        }
    }
}
