//! From what grew to streets that keep the laws: dangling ends go, the target cuts, one piece stays.

use std::collections::VecDeque;

use exurb_city::Junction;
use exurb_city::street_graph::{self, StreetGraph};
use exurb_geom::{Bounds, GridPoint, Polygon, SegmentIndex, Vec2, grid, polyline, trig};
use exurb_graph::{EdgeId, Graph, NodeId};

use super::network::{Piece, Vertex};

/// How far streets run past the target (contract: at least 20 m).
const PAST_M: f64 = 22.0;
/// Streets leave the target at this angle to its edge at least; sharper ones turn outwards.
const LEAST_EXIT_RAD: f64 = 0.6;
/// Dead ends shorter than this are driveways.
const LEAST_DEAD_END_M: f64 = 12.0;

type Grown = Graph<Vertex, Piece>;

/// Finishes a grown network inside `target`.
pub fn finish(mut graph: Grown, target: &Polygon, remove_dangling: bool) -> StreetGraph {
    if remove_dangling {
        prune(&mut graph);
    }
    let cut = graph.clip(target);
    for node in &cut {
        graph.node_mut(*node).data.outside = true;
    }
    keep_largest_piece(&mut graph);
    run_past(&mut graph, target);
    if remove_dangling {
        prune(&mut graph);
    }
    drop_stubs(&mut graph);
    keep_largest_piece(&mut graph);
    to_streets(&graph)
}

/// Removes streets that end where the example does not, from their ends (section 4.5).
pub fn prune(graph: &mut Grown) {
    let mut open: VecDeque<NodeId> = graph.nodes().map(|(id, _)| id).collect();
    while let Some(node) = open.pop_front() {
        let Some(n) = graph.get_node(node) else { continue };
        if n.data.dead_end || n.data.outside || graph.degree(node) != 1 {
            continue;
        }
        let dart = graph.darts(node)[0];
        let head = graph.head(dart);
        graph.remove_edge(dart.edge());
        graph.remove_isolated_node(node);
        // A dead end whose street has gone is nothing by itself.
        if graph.degree(head) == 0 {
            graph.remove_isolated_node(head);
        } else {
            open.push_back(head);
        }
    }
}

/// Removes dead ends too short to be streets.
fn drop_stubs(graph: &mut Grown) {
    let stubs: Vec<NodeId> = graph
        .nodes()
        .filter(|(id, n)| !n.data.outside && graph.degree(*id) == 1)
        .map(|(id, _)| id)
        .collect();
    for node in stubs {
        let mut length = 0.0;
        let mut path = Vec::new();
        let mut dart = graph.darts(node)[0];
        let at = loop {
            length += graph.edge(dart.edge()).length_m();
            path.push(dart.edge());
            let head = graph.head(dart);
            match graph.darts(head) {
                [a, b] if length < LEAST_DEAD_END_M => {
                    dart = if *a == dart.twin() { *b } else { *a }
                }
                _ => break head,
            }
        };
        if length < LEAST_DEAD_END_M && graph.degree(at) > 2 {
            for edge in path {
                graph.remove_edge(edge);
            }
        }
    }
    graph.remove_isolated_nodes();
}

/// Removes all but the connected piece of greatest length.
fn keep_largest_piece(graph: &mut Grown) {
    let mut piece = vec![usize::MAX; graph.node_bound()];
    let mut lengths: Vec<f64> = Vec::new();
    let starts: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
    for start in starts {
        if piece[start.index()] != usize::MAX {
            continue;
        }
        let number = lengths.len();
        lengths.push(0.0);
        let mut open = vec![start];
        piece[start.index()] = number;
        while let Some(node) = open.pop() {
            for dart in graph.darts(node) {
                lengths[number] += graph.edge(dart.edge()).length_m();
                let head = graph.head(*dart);
                if piece[head.index()] == usize::MAX {
                    piece[head.index()] = number;
                    open.push(head);
                }
            }
        }
    }
    let longest =
        (0..lengths.len()).max_by(|a, b| lengths[*a].total_cmp(&lengths[*b]).then(b.cmp(a)));
    let ids: Vec<(EdgeId, NodeId)> = graph.edges().map(|(id, e)| (id, e.from)).collect();
    for (id, from) in ids {
        if Some(piece[from.index()]) != longest {
            graph.remove_edge(id);
        }
    }
    graph.remove_isolated_nodes();
}

/// Lets every street that was cut at the target's edge run past it, or removes it when another
/// stands in its way.
fn run_past(graph: &mut Grown, target: &Polygon) {
    let mut index = SegmentIndex::new(50.0);
    for (id, edge) in graph.edges() {
        index.insert_line(id.0, &edge.line_m());
    }
    let cut: Vec<NodeId> = graph
        .nodes()
        .filter(|(id, n)| n.data.outside && graph.degree(*id) == 1)
        .map(|(id, _)| id)
        .collect();
    for node in cut {
        let Some(&dart) = graph.darts(node).first() else { continue };
        let at = graph.node(node).at.to_m();
        let out = -graph.direction(dart, 3.0);
        let normal = outward(target, at);
        let lean = trig::angle_between(out, normal);
        let straight = (lean < std::f64::consts::FRAC_PI_2 - LEAST_EXIT_RAD)
            .then(|| out * (PAST_M / trig::cos(lean)));
        let end = [straight, Some(normal * PAST_M)]
            .into_iter()
            .flatten()
            .map(|v| GridPoint::round(at + v))
            .find(|p| is_free(graph, &index, dart.edge(), at, p.to_m()));
        match end {
            Some(end) => {
                let edge = graph.edge(dart.edge());
                let mut line = edge.line().to_vec();
                if dart.is_forward() {
                    line.insert(0, end);
                } else {
                    line.push(end);
                }
                graph.node_mut(node).at = end;
                graph.set_line(dart.edge(), line);
                index.insert(dart.edge().0, at, end.to_m());
            }
            None => {
                graph.remove_edge(dart.edge());
            }
        }
    }
    graph.remove_isolated_nodes();
}

fn is_free(graph: &Grown, index: &SegmentIndex, own: EdgeId, a: Vec2, b: Vec2) -> bool {
    let bounds = Bounds { min: a.min(b), max: a.max(b) }.grown(4.0);
    let mut free = true;
    index.visit(bounds, |e| {
        let other = EdgeId(e.id) != own && graph.get_edge(EdgeId(e.id)).is_some();
        // Neighbouring streets may leave side by side, but not into each other.
        free &= !other || polyline::segment_distance(a + (b - a) * 0.2, b, e.a, e.b) > 4.0;
        free &= !other || !crosses(a, b, e.a, e.b);
        free
    });
    free
}

fn crosses(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let [a, b, c, d] = [a, b, c, d].map(GridPoint::round);
    grid::intersects(a, b, c, d)
}

/// The outward normal of the side of `target` nearest to `p`.
fn outward(target: &Polygon, p: Vec2) -> Vec2 {
    let side = target.segments().map(|(a, b)| (a.to_m(), b.to_m())).min_by(|s, t| {
        let d = |(a, b): &(Vec2, Vec2)| polyline::nearest_on_segment(*a, *b, p).0.distance(p);
        d(s).total_cmp(&d(t))
    });
    // Rings have their inside on the left.
    side.map_or(Vec2::X, |(a, b)| -(b - a).perp().normalize_or(Vec2::X))
}

/// The street graph of what grew, nodes of degree 2 dissolved.
fn to_streets(graph: &Grown) -> StreetGraph {
    let mut out = StreetGraph::new();
    let mut new_id = vec![NodeId(u32::MAX); graph.node_bound()];
    for (id, node) in graph.nodes() {
        let junction = Junction { cut: node.data.outside && graph.degree(id) == 1, z_m: 0.0 };
        new_id[id.index()] = out.add_node(node.at, junction);
    }
    for (_, edge) in graph.edges() {
        let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
        out.add_edge(from, to, edge.line().to_vec(), edge.data.street.clone());
    }
    street_graph::dissolve_all(&mut out);
    out.compacted()
}
