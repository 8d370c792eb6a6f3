//! From what grew to streets that keep the laws: dangling ends go, the target cuts, one piece stays.

use std::collections::VecDeque;

use exurb_city::street_graph::{self, StreetGraph};
use exurb_city::{Junction, Origin, Role};
use exurb_geom::{Bounds, GridPoint, Polygon, SegmentIndex, Vec2, polyline};
use exurb_graph::{Dart, EdgeId, Graph, NodeId};
use exurb_operation::rng::place_key;

use super::edge;
use super::network::{Piece, Vertex};

/// Dead ends shorter than this are driveways.
const LEAST_DEAD_END_M: f64 = 12.0;

/// A street that is opened loses this much, and was at least this long.
const OPENED_M: f64 = 24.0;
const OPENED_LEAST_M: f64 = 55.0;

/// What grew.
pub type Grown = Graph<Vertex, Piece>;

/// Finishes a grown network inside `target`.
pub fn finish(
    mut graph: Grown,
    target: &Polygon,
    dead_end_share: Option<f64>,
    remove_dangling: bool,
) -> StreetGraph {
    if remove_dangling {
        match dead_end_share {
            Some(share) => settle_dead_ends(&mut graph, target, share),
            None => prune(&mut graph),
        }
    }
    thin_crowds(&mut graph);
    edge::cut(&mut graph, target);
    if remove_dangling {
        prune(&mut graph);
    }
    drop_stubs(&mut graph);
    keep_largest_piece(&mut graph, |_| true);
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

/// Removes streets that end where the example does not, and sees that as many dead ends remain as the
/// example's share asks for.
///
/// Copied dead ends that would come near another street were cut or dropped while growing, so their
/// share is too low: some dangling ends stay, and some streets that closed a loop are opened.
/// Which ones is decided by their place, not by their order.
fn settle_dead_ends(graph: &mut Grown, target: &Polygon, share: f64) {
    let mut index = index_of(graph);
    keep_off(graph, &mut index);
    let mut pruned = graph.clone();
    prune(&mut pruned);
    let wanted = missing_dead_ends(&pruned, target, share);
    let mut dangling: Vec<(u64, NodeId)> = graph
        .nodes()
        .filter(|(id, n)| is_open_end(graph, *id) && target.contains(n.at))
        .filter(|(id, n)| {
            let own = graph.darts(*id)[0].edge();
            let long = graph.edge(own).length_m() > 2.0 * LEAST_DEAD_END_M;
            long && is_alone(graph, &index, own, n.at.to_m())
        })
        .map(|(id, n)| (place_key(n.at), id))
        .collect();
    dangling.sort_unstable();
    for (_, node) in dangling.into_iter().take(wanted) {
        graph.node_mut(node).data.dead_end = true;
    }
    prune(graph);
    let wanted = missing_dead_ends(graph, target, share);
    open_loops(graph, target, &mut index, wanted);
}

fn index_of(graph: &Grown) -> SegmentIndex {
    let mut index = SegmentIndex::new(50.0);
    for (id, edge) in graph.edges() {
        index.insert_line(id.0, &edge.line_m());
    }
    index
}

fn is_open_end(graph: &Grown, node: NodeId) -> bool {
    let data = &graph.node(node).data;
    !data.dead_end && !data.outside && graph.degree(node) == 1
}

/// How many dead ends are missing inside `target` for the example's share.
fn missing_dead_ends(graph: &Grown, target: &Polygon, share: f64) -> usize {
    let degrees = || {
        let inside = graph.nodes().filter(|(_, n)| !n.data.outside && target.contains(n.at));
        inside.map(|(id, _)| graph.degree(id))
    };
    let all = degrees().filter(|d| *d != 2).count() as f64;
    let ends = degrees().filter(|d| *d == 1).count() as f64;
    (share * all - ends).max(0.0) as usize
}

/// Shortens dead ends that come too near another street, and gives up those with nothing left.
fn keep_off(graph: &mut Grown, index: &mut SegmentIndex) {
    let ends: Vec<NodeId> = graph
        .nodes()
        .filter(|(id, n)| n.data.dead_end && graph.degree(*id) == 1)
        .map(|(id, _)| id)
        .collect();
    for node in ends {
        let dart = graph.darts(node)[0];
        let length = graph.edge(dart.edge()).length_m();
        let mut cut = 0.0;
        let line = graph.dart_line_m(dart);
        while cut < 30.0 && !is_alone(graph, index, dart.edge(), polyline::point_at(&line, cut)) {
            cut += 6.0;
        }
        if cut >= 30.0 || length - cut < 2.0 * LEAST_DEAD_END_M && cut > 0.0 {
            graph.node_mut(node).data.dead_end = false;
        } else if cut > 0.0 {
            shorten(graph, index, dart, cut);
        }
    }
}

/// Opens streets that close a loop, `wanted` of them at most: each loses its last metres and becomes
/// a dead end. Streets of a spanning tree stay, so that nothing falls apart.
fn open_loops(graph: &mut Grown, target: &Polygon, index: &mut SegmentIndex, wanted: usize) {
    let spare = outside_spanning_tree(graph);
    let mut candidates: Vec<(bool, u64, EdgeId)> = spare
        .into_iter()
        .map(|id| (id, graph.edge(id)))
        .filter(|(_, e)| e.data.street.role() == Role::Local && e.length_m() > OPENED_LEAST_M)
        .filter(|(_, e)| [e.from, e.to].iter().all(|n| graph.degree(*n) > 2))
        .map(|(id, e)| {
            let copied = e.data.street.provenance.origin == Origin::Example;
            (copied, place_key(e.line()[0]), id)
        })
        .collect();
    candidates.sort_unstable();
    let mut opened = 0;
    for (_, _, id) in candidates {
        if opened == wanted {
            break;
        }
        for dart in [id.forward(), id.backward()] {
            let line = graph.dart_line_m(dart);
            let cut = OPENED_M;
            let tip = polyline::point_at(&line, cut);
            if graph.degree(graph.tail(dart)) > 2
                && target.contains(GridPoint::round(tip))
                && is_alone(graph, index, id, tip)
            {
                shorten(graph, index, dart, cut);
                opened += 1;
                break;
            }
        }
    }
}

/// Edges that a spanning tree of main streets first, then copied ones, does without.
fn outside_spanning_tree(graph: &Grown) -> Vec<EdgeId> {
    let mut edges: Vec<(bool, bool, EdgeId)> = graph
        .edges()
        .map(|(id, e)| {
            let street = &e.data.street;
            (street.role() != Role::Main, street.provenance.origin != Origin::Example, id)
        })
        .collect();
    edges.sort_unstable();
    let mut parent: Vec<usize> = (0..graph.node_bound()).collect();
    let mut out = Vec::new();
    for (_, _, id) in edges {
        let edge = graph.edge(id);
        let [a, b] = [edge.from, edge.to].map(|n| root(&mut parent, n.index()));
        if a == b {
            out.push(id);
        } else {
            parent[a.max(b)] = a.min(b);
        }
    }
    out
}

fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

/// Takes the first `cut_m` of a dart's street away; what is left begins in a dead end.
fn shorten(graph: &mut Grown, index: &mut SegmentIndex, dart: Dart, cut_m: f64) {
    let line = graph.dart_line_m(dart);
    let rest = polyline::round(&polyline::part(&line, cut_m, polyline::length(&line)));
    let (tail, head) = (graph.tail(dart), graph.head(dart));
    index.remove_line(dart.edge().0, &graph.edge(dart.edge()).line_m());
    let Some(edge) = graph.remove_edge(dart.edge()) else { return };
    graph.remove_isolated_node(tail);
    let tip = Vertex { dead_end: true, ..Vertex::default() };
    let node = graph.add_node(rest[0], tip);
    if let Some(id) = graph.add_edge(node, head, rest, edge.data) {
        index.insert_line(id.0, &graph.edge(id).line_m());
    }
}

/// Is no street but `own` so near that a dead end at `p` would miss it?
fn is_alone(graph: &Grown, index: &SegmentIndex, own: EdgeId, p: Vec2) -> bool {
    const MISS_M: f64 = 13.0;
    let mut alone = true;
    index.visit(Bounds { min: p - MISS_M, max: p + MISS_M }, |e| {
        let near = polyline::nearest_on_segment(e.a, e.b, p).0.distance(p) < MISS_M;
        alone &= EdgeId(e.id) == own || !near || graph.get_edge(EdgeId(e.id)).is_none();
        alone
    });
    alone
}

/// Removes the shortest local streets where more than five meet: two cells can each add to a node
/// of the main street between them.
fn thin_crowds(graph: &mut Grown) {
    let crowded: Vec<NodeId> =
        graph.nodes().map(|(id, _)| id).filter(|id| graph.degree(*id) > 5).collect();
    for node in crowded {
        while graph.degree(node) > 5 {
            let shortest = graph
                .darts(node)
                .iter()
                .map(|d| (d.edge(), graph.edge(d.edge())))
                .max_by(|a, b| {
                    let class = a.1.data.street.class.cmp(&b.1.data.street.class);
                    class.then(b.1.length_m().total_cmp(&a.1.length_m())).then(a.0.cmp(&b.0))
                })
                .map(|(id, _)| id);
            let Some(id) = shortest else { break };
            graph.remove_edge(id);
        }
    }
    prune(graph);
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

/// Removes all streets that `counts` accepts but the connected piece of them of greatest length.
pub fn keep_largest_piece(graph: &mut Grown, counts: impl Fn(EdgeId) -> bool) {
    let mut parent: Vec<usize> = (0..graph.node_bound()).collect();
    let counted: Vec<(EdgeId, usize, usize, f64)> = graph
        .edges()
        .filter(|(id, _)| counts(*id))
        .map(|(id, e)| (id, e.from.index(), e.to.index(), e.length_m()))
        .collect();
    for (_, from, to, _) in &counted {
        let (a, b) = (root(&mut parent, *from), root(&mut parent, *to));
        parent[a.max(b)] = a.min(b);
    }
    let mut lengths = vec![0.0; parent.len()];
    for (_, from, _, length_m) in &counted {
        lengths[root(&mut parent, *from)] += length_m;
    }
    let longest =
        (0..lengths.len()).max_by(|a, b| lengths[*a].total_cmp(&lengths[*b]).then(b.cmp(a)));
    for (id, from, ..) in counted {
        if Some(root(&mut parent, from)) != longest {
            graph.remove_edge(id);
        }
    }
    graph.remove_isolated_nodes();
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
