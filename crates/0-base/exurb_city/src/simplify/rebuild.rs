//! Groups of nodes → a graph with one node each.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Vec2, polyline};
use exurb_graph::{Edge, EdgeId, NodeId, noding};

use super::Simplify;
use crate::{Junction, Street, StreetGraph, street_graph};

/// A street that parts from a joined one is bent over this many times the distance its end moves.
const BEND: f64 = 5.0;
/// Joined lines keep vertices that stand off by more than this, in metres.
const STRAIGHT_M: f64 = 0.25;

/// Nodes that become one: a union-find with places.
pub struct Groups {
    parent: Vec<u32>,
    place: BTreeMap<u32, Vec2>,
}

impl Groups {
    pub fn new(graph: &StreetGraph) -> Self {
        Self { parent: (0..graph.node_bound() as u32).collect(), place: BTreeMap::new() }
    }

    pub fn root(&mut self, node: NodeId) -> NodeId {
        let mut at = node.0;
        while self.parent[at as usize] != at {
            let up = self.parent[self.parent[at as usize] as usize];
            self.parent[at as usize] = up;
            at = up;
        }
        NodeId(at)
    }

    pub fn unite(&mut self, a: NodeId, b: NodeId) {
        let (a, b) = (self.root(a).0, self.root(b).0);
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Says where the group of `node` shall stand; otherwise it does half way between its two
    /// farthest nodes.
    pub fn place(&mut self, node: NodeId, at: Vec2) {
        let root = self.root(node).0;
        self.place.insert(root, at);
    }
}

/// One node for every group; `new_id` by node of the old graph.
fn nodes_of(graph: &StreetGraph, groups: &mut Groups) -> (StreetGraph, Vec<NodeId>) {
    let mut members: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
    for (id, _) in graph.nodes() {
        members.entry(groups.root(id)).or_default().push(id);
    }
    let mut out = StreetGraph::new();
    let mut new_id = vec![NodeId(u32::MAX); graph.node_bound()];
    for (root, nodes) in members {
        let at = match groups.place.get(&root.0) {
            Some(at) => GridPoint::round(*at),
            None => middle(graph, &nodes),
        };
        let cut = nodes.iter().any(|n| graph.node(*n).data.cut);
        let z_m = nodes.iter().map(|n| graph.node(*n).data.z_m).sum::<f64>() / nodes.len() as f64;
        let id = out.add_node(at, Junction { cut, z_m });
        for node in nodes {
            new_id[node.index()] = id;
        }
    }
    (out, new_id)
}

/// Half way between the two farthest nodes.
fn middle(graph: &StreetGraph, nodes: &[NodeId]) -> GridPoint {
    let at = |n: &NodeId| graph.node(*n).at;
    let mut best = (0.0, at(&nodes[0]), at(&nodes[0]));
    for (i, a) in nodes.iter().enumerate() {
        for b in &nodes[i + 1..] {
            let d = at(a).distance_m(at(b));
            if d > best.0 {
                best = (d, at(a), at(b));
            }
        }
    }
    if best.0 == 0.0 { best.1 } else { GridPoint::round((best.1.to_m() + best.2.to_m()) / 2.0) }
}

/// The graph with one node for every group and the edges that `keep` accepts.
pub fn rebuild(
    graph: &StreetGraph,
    groups: &mut Groups,
    keep: impl Fn(EdgeId) -> bool,
) -> StreetGraph {
    let (mut out, new_id) = nodes_of(graph, groups);
    for (_, edge) in graph.edges().filter(|(id, _)| keep(*id)) {
        let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
        let line = bent(edge, out.node(from).at, out.node(to).at);
        out.add_edge(from, to, line, edge.data.clone());
    }
    out.remove_isolated_nodes();
    out
}

/// Step 5: joins the halves between the same two stations; drops what lies inside a station.
pub fn join(
    graph: &StreetGraph,
    dual: &[bool],
    mut groups: Groups,
    options: &Simplify,
) -> StreetGraph {
    let (mut out, new_id) = nodes_of(graph, &mut groups);
    // Halves by the stations they join.
    let mut halves: BTreeMap<(NodeId, NodeId), Vec<EdgeId>> = BTreeMap::new();
    for (id, edge) in graph.edges() {
        let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
        if from == to && edge.from != edge.to && edge.length_m() < options.gap_m * 2.0 {
            continue;
        }
        if dual[id.index()] && from != to {
            halves.entry((from.min(to), from.max(to))).or_default().push(id);
        } else {
            let line = bent(edge, out.node(from).at, out.node(to).at);
            out.add_edge(from, to, line, edge.data.clone());
        }
    }
    for ids in halves.into_values() {
        let mut left = ids;
        while let Some(first) = left.first().copied() {
            left.remove(0);
            let edge = graph.edge(first);
            let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
            let partner = left.iter().position(|id| {
                let other = graph.edge(*id);
                let forward = new_id[other.from.index()] == from;
                (!forward || !edge.data.oneway)
                    && separation_m(edge, other, forward) < options.gap_m * 1.2
            });
            match partner {
                Some(at) => {
                    let other = graph.edge(left.remove(at));
                    let forward = new_id[other.from.index()] == from;
                    let line = polyline::round(&between(edge, other, forward));
                    out.add_edge(from, to, line, joined(&edge.data, &other.data));
                }
                None => {
                    let line = bent(edge, out.node(from).at, out.node(to).at);
                    out.add_edge(from, to, line, edge.data.clone());
                }
            }
        }
    }
    out.remove_isolated_nodes();
    out
}

/// The line of an edge whose ends move. Along the street an end just moves; sideways the street is
/// bent towards it over some distance.
fn bent(edge: &Edge<Street>, from: GridPoint, to: GridPoint) -> Vec<GridPoint> {
    let mut line = edge.line_m();
    bend_start(&mut line, from.to_m());
    line.reverse();
    bend_start(&mut line, to.to_m());
    line.reverse();
    polyline::round(&line)
}

fn bend_start(line: &mut Vec<Vec2>, to: Vec2) {
    let shift = to - line[0];
    let length = polyline::length(line);
    if shift.length() < 1e-3 {
        return;
    }
    let ahead = polyline::point_at(line, shift.length().min(length)) - line[0];
    let sideways = shift.perp_dot(ahead).abs() > 0.7 * shift.length() * ahead.length();
    let reach = (BEND * shift.length()).min(length / 2.0);
    if !sideways || reach < 1.0 {
        line[0] = to;
        return;
    }
    let head = polyline::resample(&polyline::part(line, 0.0, reach), 10.0);
    let rest = polyline::part(line, reach, length);
    let count = (head.len() - 1) as f64;
    let eased = head.iter().enumerate().map(|(i, p)| {
        let left = 1.0 - i as f64 / count;
        *p + shift * (left * left * (3.0 - 2.0 * left))
    });
    *line = eased.chain(rest.into_iter().skip(1)).collect();
}

/// Largest distance between two lines at equal shares of their lengths.
fn separation_m(a: &Edge<Street>, b: &Edge<Street>, forward: bool) -> f64 {
    let (p, q) = side_by_side(a, b, forward);
    let (m, n) = (polyline::length(&p), polyline::length(&q));
    (0..=10)
        .map(|i| {
            let share = f64::from(i) / 10.0;
            polyline::point_at(&p, share * m).distance(polyline::point_at(&q, share * n))
        })
        .fold(0.0, f64::max)
}

fn side_by_side(a: &Edge<Street>, b: &Edge<Street>, forward: bool) -> (Vec<Vec2>, Vec<Vec2>) {
    let mut other = b.line_m();
    if !forward {
        other.reverse();
    }
    (a.line_m(), other)
}

/// The line half way between two edges.
fn between(a: &Edge<Street>, b: &Edge<Street>, forward: bool) -> Vec<Vec2> {
    let (p, q) = side_by_side(a, b, forward);
    let (m, n) = (polyline::length(&p), polyline::length(&q));
    let mut shares: Vec<f64> = places(&p, m).chain(places(&q, n)).collect();
    shares.sort_by(f64::total_cmp);
    shares.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let middle: Vec<Vec2> = shares
        .iter()
        .map(|s| (polyline::point_at(&p, s * m) + polyline::point_at(&q, s * n)) / 2.0)
        .collect();
    polyline::simplify(&middle, STRAIGHT_M)
}

/// The vertices of a line as shares of its length.
fn places(line: &[Vec2], length: f64) -> impl Iterator<Item = f64> + '_ {
    let steps = line.windows(2).map(|w| w[0].distance(w[1]));
    std::iter::once(0.0).chain(steps.scan(0.0, move |at, step| {
        *at += step;
        Some((*at / length).min(1.0))
    }))
}

/// One street of two carriageways: lanes and widths of both, driven both ways.
pub fn joined(a: &Street, b: &Street) -> Street {
    Street {
        class: a.class.min(b.class),
        level: a.level.min(b.level),
        lanes: a.lanes().saturating_add(b.lanes()),
        width_m: a.width_m() + b.width_m(),
        oneway: false,
        name: a.name.clone().or_else(|| b.name.clone()),
        ..a.clone()
    }
}

/// Step 6: makes nodes where moved streets cross or touch, and dissolves those no longer needed.
pub fn node_again(graph: &StreetGraph) -> StreetGraph {
    let lines = graph.edges().map(|(_, edge)| noding::Line {
        points: edge.line().to_vec(),
        level: edge.data.crossing_level(),
        data: edge.data.clone(),
    });
    let noded =
        noding::node(lines.collect(), noding::Options { snap_m: 0.02, ..Default::default() });
    let known: BTreeMap<GridPoint, Junction> =
        graph.nodes().map(|(_, node)| (node.at, node.data.clone())).collect();
    let mut out = street_graph::from_lines(noded.into_iter().map(|l| (l.points, l.data)));
    let nodes: Vec<NodeId> = out.nodes().map(|(id, _)| id).collect();
    for id in nodes {
        if let Some(data) = known.get(&out.node(id).at) {
            out.node_mut(id).data = data.clone();
        }
    }
    street_graph::dissolve_all(&mut out);
    out.compacted()
}
