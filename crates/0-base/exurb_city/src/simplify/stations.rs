//! Nodes on one carriageway and their counterparts on the other.

use exurb_geom::{GridPoint, Vec2, polyline};
use exurb_graph::{Dart, EdgeId, NodeId};

use super::{Simplify, pairing::Carriageways, rebuild::Groups};
use crate::StreetGraph;

/// A counterpart this near an existing node, along the carriageway, is that node. Metres.
const NEAR_NODE_M: f64 = 12.0;
/// Directions at nodes are taken over this much of a street, in metres.
const LEG_M: f64 = 15.0;
/// Carriageways are no nearer to each other than a street across is long, in metres.
const LEAST_LINK_M: f64 = 3.0;
/// Splits of one carriageway nearer than this are one, in metres.
const NEAR_SPLIT_M: f64 = 6.0;

/// Step 4: finds the counterpart of every node on a carriageway with a partner, splits the partner
/// there, and groups the two. Returns the graph with the splits, and which of its edges are halves.
pub fn zip(
    mut graph: StreetGraph,
    mut dual: Vec<bool>,
    options: &Simplify,
) -> (StreetGraph, Vec<bool>, Groups) {
    let (pairs, mut splits) = counterparts(&graph, &dual, options);
    splits.sort_by(|a, b| a.edge.cmp(&b.edge).then(a.along_m.total_cmp(&b.along_m)));
    let mut found: Vec<(NodeId, NodeId)> = pairs;
    for on_edge in splits.chunk_by(|a, b| a.edge == b.edge) {
        split_all(&mut graph, &mut dual, on_edge, &mut found);
    }
    let mut groups = Groups::new(&graph);
    for (a, b) in found {
        groups.unite(a, b);
    }
    (graph, dual, groups)
}

/// A place where the counterpart of `node` is to be made.
struct Split {
    edge: EdgeId,
    along_m: f64,
    node: NodeId,
}

fn split_all(
    graph: &mut StreetGraph,
    dual: &mut Vec<bool>,
    splits: &[Split],
    found: &mut Vec<(NodeId, NodeId)>,
) {
    let line = graph.edge(splits[0].edge).line_m();
    let mut rest = splits[0].edge;
    let mut last: Option<(f64, NodeId)> = None;
    for split in splits {
        if let Some((along_m, made)) = last
            && split.along_m - along_m < NEAR_SPLIT_M
        {
            found.push((split.node, made));
            continue;
        }
        let at = GridPoint::round(polyline::point_at(&line, split.along_m));
        if let Some((made, head, tail)) = graph.split_edge(rest, at) {
            dual.resize(graph.edge_bound(), false);
            dual[head.index()] = true;
            dual[tail.index()] = true;
            rest = tail;
            last = Some((split.along_m, made));
            found.push((split.node, made));
        }
    }
}

/// Nodes that are each other's counterparts, and counterparts to be made.
fn counterparts(
    graph: &StreetGraph,
    dual: &[bool],
    options: &Simplify,
) -> (Vec<(NodeId, NodeId)>, Vec<Split>) {
    let carriageways = Carriageways::of(graph, options);
    let (mut pairs, mut splits) = (Vec::new(), Vec::new());
    for (node, data) in graph.nodes() {
        let halves: Vec<Dart> =
            graph.darts(node).iter().copied().filter(|d| dual[d.edge().index()]).collect();
        let mut roads: Vec<Vec2> = Vec::new();
        for dart in &halves {
            let leaving = graph.direction(*dart, LEG_M);
            // Both directions of one road need one counterpart; a road and its partner that meet
            // here are joined already.
            let is_new = roads.iter().all(|r| r.dot(leaving).abs() < 0.7);
            let is_apex =
                halves.iter().any(|d| d != dart && graph.direction(*d, LEG_M).dot(leaving) > 0.5);
            if is_apex || !is_new {
                continue;
            }
            let travel = if dart.is_forward() { leaving } else { -leaving };
            if let Some(other) = linked(graph, dual, *dart, options.gap_m) {
                roads.push(leaving);
                pairs.push((node, other));
                continue;
            }
            let own = |id: EdgeId| graph.darts(node).iter().any(|d| d.edge() == id);
            let counts = |id: EdgeId| dual[id.index()] && !own(id);
            let Some(beside) = carriageways.partner(dart.edge(), data.at.to_m(), travel, counts)
            else {
                continue;
            };
            roads.push(leaving);
            let edge = graph.edge(beside.edge);
            let line = edge.line_m();
            let along_m = polyline::nearest(&line, beside.at).1;
            let left_m = polyline::length(&line) - along_m;
            if along_m.min(left_m) < NEAR_NODE_M {
                pairs.push((node, if along_m < left_m { edge.from } else { edge.to }));
            } else {
                splits.push(Split { edge: beside.edge, along_m, node });
            }
        }
    }
    (pairs, splits)
}

/// The node on the other carriageway that a short street across leads to from the tail of `half`.
fn linked(graph: &StreetGraph, dual: &[bool], half: Dart, gap_m: f64) -> Option<NodeId> {
    let node = graph.tail(half);
    let leaving = graph.direction(half, LEG_M);
    let travel = if half.is_forward() { leaving } else { -leaving };
    let oneway = graph.edge(half.edge()).data.oneway;
    let is_other_half = |dart: &Dart| {
        let leaving = graph.direction(*dart, LEG_M);
        let their_travel = if dart.is_forward() { leaving } else { -leaving };
        let turn = their_travel.dot(travel);
        dual[dart.edge().index()] && if oneway { turn < -0.85 } else { turn.abs() > 0.85 }
    };
    graph
        .darts(node)
        .iter()
        .filter(|d| {
            let length_m = graph.edge(d.edge()).length_m();
            let head = graph.head(**d);
            (LEAST_LINK_M..gap_m * 1.3).contains(&length_m)
                && graph.direction(**d, LEG_M).dot(leaving).abs() < 0.6
                && head != node
                && graph
                    .darts(head)
                    .iter()
                    .any(|other| other.edge() != d.edge() && is_other_half(other))
        })
        .min_by(|a, b| graph.edge(a.edge()).length_m().total_cmp(&graph.edge(b.edge()).length_m()))
        .map(|d| graph.head(*d))
}
