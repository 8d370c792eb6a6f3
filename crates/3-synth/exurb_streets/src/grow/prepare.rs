//! The example as growth wants it: what can be copied without breaking a law.

use std::collections::BTreeSet;
use std::sync::Arc;

use exurb_city::simplify::{self, Simplify};
use exurb_city::street_graph::{self, StreetGraph};
use exurb_city::{Building, Junction, Role, Street, block};
use exurb_geom::{Bounds, GridPoint, SegmentIndex, grid};
use exurb_graph::{EdgeId, Graph, NodeId};

/// Edges shorter than this are collapsed: copies of them would be stubs.
const SHORTEST_M: f64 = 8.0;

/// Streets that growth learns from: no motorways (never grown), no tunnels, nothing that passes over
/// another street, no stubs; the carriageways of a street as one. On flat land what is left of bridges
/// lies on the ground.
pub fn learnable(streets: &StreetGraph, buildings: &Arc<Vec<Building>>) -> StreetGraph {
    let options = Simplify {
        keep_circles: true,
        by_geometry: !simplify::knows_oneways(streets),
        buildings: buildings.clone(),
        ..Simplify::default()
    };
    let streets = &simplify::simplify(streets, &options);
    let on_ground = block::bounding_edges(streets);
    let mut graph = street_graph::subgraph(streets, |id, street| {
        on_ground[id.index()] && !street.class.is_given_only() && street.role() != Role::Other
    });
    let ids: Vec<EdgeId> = graph.edges().map(|(id, _)| id).collect();
    for id in ids {
        let street = &mut graph.edge_mut(id).data;
        (street.bridge, street.layer, street.level) = (false, 0, 0);
    }
    collapse_short(&mut graph);
    straighten_loops(&mut graph);
    street_graph::dissolve_all(&mut graph);
    mark_severed(&mut graph, streets);
    graph.compacted()
}

/// Marks ends where a street went on that is not learned, such as a motorway or a tunnel: they are no
/// dead ends of the example.
fn mark_severed(graph: &mut StreetGraph, whole: &StreetGraph) {
    let junctions: BTreeSet<GridPoint> =
        whole.nodes().filter(|(id, _)| whole.degree(*id) > 1).map(|(_, n)| n.at).collect();
    let severed: Vec<NodeId> = graph
        .nodes()
        .filter(|(id, n)| graph.degree(*id) == 1 && junctions.contains(&n.at))
        .map(|(id, _)| id)
        .collect();
    for node in severed {
        graph.node_mut(node).data.cut = true;
    }
}

/// Collapses short edges one by one, as long as no collapse makes streets cross.
fn collapse_short(graph: &mut StreetGraph) {
    let mut short: Vec<(f64, EdgeId)> = graph
        .edges()
        .map(|(id, e)| (e.length_m(), id))
        .filter(|(length, _)| *length < SHORTEST_M)
        .collect();
    short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    if short.is_empty() {
        return;
    }
    for (_, id) in short {
        let Some(edge) = graph.get_edge(id) else { continue };
        if edge.length_m() >= SHORTEST_M {
            continue;
        }
        let (from, to) = (edge.from, edge.to);
        let fixed = |n: NodeId| graph.node(n).data.cut;
        // A stub that ends at the map's edge stays: its end is where the street runs on.
        if fixed(from) || fixed(to) {
            continue;
        }
        if from == to || graph.degree(from) == 1 || graph.degree(to) == 1 {
            graph.remove_edge(id);
        } else {
            graph.collapse_edge(id);
        }
    }
    graph.remove_isolated_nodes();
    remove_crossing(graph);
}

/// Removes the shorter of two edges that cross (collapsing can bend one over another), and edges
/// between the same nodes along the same line.
fn remove_crossing(graph: &mut Graph<Junction, Street>) {
    let mut index = SegmentIndex::new(60.0);
    let mut by_length: Vec<(f64, EdgeId)> =
        graph.edges().map(|(id, e)| (e.length_m(), id)).collect();
    by_length.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (_, id) in by_length {
        let line = graph.edge(id).line().to_vec();
        let hit = line.windows(2).any(|w| {
            let (a, b) = (w[0].to_m(), w[1].to_m());
            let mut hit = false;
            index.visit(Bounds { min: a.min(b), max: a.max(b) }, |e| {
                let (c, d) = (GridPoint::round(e.a), GridPoint::round(e.b));
                hit |= grid::cross_properly(w[0], w[1], c, d)
                    || (w[0] == c && w[1] == d)
                    || (w[0] == d && w[1] == c);
                !hit
            });
            hit
        });
        if hit {
            graph.remove_edge(id);
        } else {
            index.insert_line(id.0, &graph.edge(id).line_m());
        }
    }
    graph.remove_isolated_nodes();
}

/// Removes loops shorter than 40 m: turning circles and lay-bys.
fn straighten_loops(graph: &mut StreetGraph) {
    let loops: Vec<EdgeId> = graph
        .edges()
        .filter(|(_, e)| e.from == e.to && e.length_m() < 40.0)
        .map(|(id, _)| id)
        .collect();
    for id in loops {
        graph.remove_edge(id);
    }
    graph.remove_isolated_nodes();
}
