//! Small roundabouts → junctions.

use exurb_geom::{GridPoint, Vec2};
use exurb_graph::{EdgeId, NodeId};

use super::{Simplify, rebuild::Groups, rebuild::rebuild};
use crate::{StreetGraph, block};

/// `4π·area / perimeter²` of a circle is 1, of a square 0.79.
const CIRCLE_COMPACTNESS: f64 = 0.88;

/// Shrinks every roundabout under the limit to a node at its centre.
pub fn shrink(graph: &StreetGraph, options: &Simplify) -> StreetGraph {
    let mut ring = vec![false; graph.edge_bound()];
    for (id, edge) in graph.edges() {
        ring[id.index()] = edge.data.roundabout;
    }
    if options.by_geometry {
        mark_circular_faces(graph, options.roundabout_m, &mut ring);
    }
    let mut groups = Groups::new(graph);
    let mut gone = vec![false; graph.edge_bound()];
    let mut seen = vec![false; graph.edge_bound()];
    for (first, _) in graph.edges() {
        if !ring[first.index()] || seen[first.index()] {
            continue;
        }
        let (edges, nodes) = component(graph, first, &ring, &mut seen);
        let points: Vec<GridPoint> =
            edges.iter().flat_map(|id| graph.edge(*id).line().iter().copied()).collect();
        let (center, across_m) = extent(&points);
        // An arc alone is no roundabout: a part of one at the border of the map, or a bend.
        let closed = edges.len() >= nodes.len();
        if closed && across_m < options.roundabout_m {
            for pair in nodes.windows(2) {
                groups.unite(pair[0], pair[1]);
            }
            groups.place(nodes[0], center);
            for id in &edges {
                gone[id.index()] = true;
            }
        }
    }
    rebuild(graph, &mut groups, |id| !gone[id.index()])
}

/// Edges and nodes connected with `first` by marked edges.
fn component(
    graph: &StreetGraph,
    first: EdgeId,
    marked: &[bool],
    seen: &mut [bool],
) -> (Vec<EdgeId>, Vec<NodeId>) {
    let mut edges = Vec::new();
    let mut nodes = vec![graph.edge(first).from];
    let mut next = 0;
    while let Some(node) = nodes.get(next).copied() {
        next += 1;
        for dart in graph.darts(node) {
            let id = dart.edge();
            if !marked[id.index()] {
                continue;
            }
            if !std::mem::replace(&mut seen[id.index()], true) {
                edges.push(id);
            }
            let head = graph.head(*dart);
            if !nodes.contains(&head) {
                nodes.push(head);
            }
        }
    }
    (edges, nodes)
}

/// Centre and longer side of the box around points, in metres.
fn extent(points: &[GridPoint]) -> (Vec2, f64) {
    let (mut lo, mut hi) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for p in points {
        (lo, hi) = (lo.min(p.to_m()), hi.max(p.to_m()));
    }
    ((lo + hi) / 2.0, (hi - lo).max_element())
}

/// Marks the edges around small faces as round as a circle, with at least three streets.
fn mark_circular_faces(graph: &StreetGraph, most_m: f64, ring: &mut [bool]) {
    for face in &block::faces(graph).list {
        let perimeter_m = face.polygon.perimeter_m();
        let compactness =
            4.0 * std::f64::consts::PI * face.polygon.area_m2() / (perimeter_m * perimeter_m);
        let small = face.polygon.bounds().size().max_element() < most_m;
        if small && compactness > CIRCLE_COMPACTNESS && face.outline.len() >= 3 {
            for dart in &face.outline {
                ring[dart.edge().index()] = true;
            }
        }
    }
}
