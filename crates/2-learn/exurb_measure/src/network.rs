//! The street network of a window, as every measure of streets and blocks sees it.
//!
//! Steps: 1 what lies outside the window goes, streets that cross its border end in cut ends there;
//! 2 nodes of degree 2 are dissolved, whatever class or level changes there; 3, twice: junctions
//! less than 10 m apart along a street become one, loops under 40 m go, of twin carriageways
//! between the same two junctions one stays. Cut ends never count as dead ends, junctions or ends of
//! a street. The order of streets decides which twin stays, nothing else. O(n log n).

use exurb_city::{StreetGraph, street_graph};
use exurb_geom::{Bounds, GridPoint, Polygon, Vec2, polyline};
use exurb_graph::{Edge, EdgeId, NodeId};

mod merging;

/// The streets of a window.
#[derive(Clone, Debug)]
pub struct Network {
    /// The axis-parallel rectangle they were cut to, in metres.
    pub window: Bounds,
    /// The streets; nodes of degree 2 remain on closed streets only.
    pub graph: StreetGraph,
}

/// An edge of a network.
pub type Segment = Edge<exurb_city::Street>;

impl Network {
    /// The network of the streets in a window.
    pub fn of(streets: &StreetGraph, window: Bounds) -> Self {
        let Self { mut graph, .. } = Self::unmerged(streets, window);
        for _ in 0..2 {
            merging::merge_close_junctions(&mut graph);
            merging::drop_small_loops(&mut graph);
            merging::drop_twins(&mut graph);
            dissolve(&mut graph);
        }
        Self { window, graph: graph.into_compacted() }
    }

    /// Steps 1 and 2 alone: the streets as they were delivered.
    pub fn unmerged(streets: &StreetGraph, window: Bounds) -> Self {
        let mut graph = within(streets, window);
        dissolve(&mut graph);
        Self { window, graph: graph.into_compacted() }
    }

    /// Area of the window in km².
    pub fn area_km2(&self) -> f64 {
        self.window.size().x * self.window.size().y / 1e6
    }

    /// Does the window's border cut the street that ends here?
    pub fn is_cut(&self, node: NodeId) -> bool {
        self.graph.node(node).data.cut
    }

    /// Nodes where at least three streets meet.
    pub fn junctions(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.ends().filter(|n| self.graph.degree(*n) >= 3)
    }

    /// Nodes where a street ends.
    pub fn dead_ends(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.ends().filter(|n| self.graph.degree(*n) == 1)
    }

    /// All nodes but cut ends.
    pub fn ends(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.graph.nodes().filter(|(_, n)| !n.data.cut).map(|(id, _)| id)
    }

    /// Streets between two junctions or dead ends; those that the border cuts are left out.
    pub fn segments(&self) -> impl Iterator<Item = (EdgeId, &Segment)> + '_ {
        self.graph.edges().filter(|(_, e)| !self.is_cut(e.from) && !self.is_cut(e.to))
    }

    /// Position of a node in metres.
    pub fn at(&self, node: NodeId) -> Vec2 {
        self.graph.node(node).at.to_m()
    }

    /// Distance of a node from the window's border in metres.
    pub fn edge_distance_m(&self, node: NodeId) -> f64 {
        let at = self.at(node);
        (at - self.window.min).min(self.window.max - at).min_element()
    }

    /// Weight of a thing of this box: see [`inclusion_weight`].
    pub fn weight_of(&self, points: &[GridPoint]) -> f64 {
        let size = Bounds::of(points.iter().copied()).map_or(Vec2::ZERO, Bounds::size);
        inclusion_weight(size, self.window.size())
    }

    /// Every street in straight pieces of at most `step_m`, cut ones as far as they reach.
    pub fn straight_pieces(&self, step_m: f64) -> Vec<(Vec2, Vec2)> {
        let mut out = Vec::new();
        for (_, edge) in self.graph.edges() {
            for w in edge.line().windows(2) {
                let points = polyline::resample(&[w[0].to_m(), w[1].to_m()], step_m);
                out.extend(points.windows(2).map(|p| (p[0], p[1])));
            }
        }
        out
    }

    /// Length of all streets, cut ones as far as they reach, in metres.
    pub fn length_m(&self) -> f64 {
        self.graph.length_m()
    }
}

/// Inverse of the chance that a thing of this size lies wholly inside a window of that size, at most
/// 20: large blocks and long streets are cut more often, and those that are not stand for them.
pub fn inclusion_weight(thing: Vec2, window: Vec2) -> f64 {
    const MOST: f64 = 20.0;
    let chance = (1.0 - thing.x / window.x) * (1.0 - thing.y / window.y);
    if chance > 1.0 / MOST { 1.0 / chance } else { MOST }
}

/// The streets inside the window, cut ends marked.
fn within(streets: &StreetGraph, window: Bounds) -> StreetGraph {
    let mut graph = StreetGraph::new();
    let mut new_id = vec![None; streets.node_bound()];
    let mut leaves = false;
    for (_, edge) in streets.edges() {
        let Some(bounds) = Bounds::of(edge.line().iter().copied()) else { continue };
        if !bounds.intersects(window) {
            continue;
        }
        leaves |= !window.contains(bounds.min) || !window.contains(bounds.max);
        let [from, to] = [edge.from, edge.to].map(|id| {
            let node = streets.node(id);
            *new_id[id.index()].get_or_insert_with(|| graph.add_node(node.at, node.data.clone()))
        });
        graph.add_edge(from, to, edge.line().to_vec(), edge.data.clone());
    }
    let area = rectangle(window);
    if leaves {
        for node in graph.clip(&area) {
            graph.node_mut(node).data.cut = true;
        }
    }
    street_graph::mark_ends_on_border(&mut graph, &area);
    graph
}

/// The window as a polygon.
pub fn rectangle(window: Bounds) -> Polygon {
    Polygon::rectangle(GridPoint::round(window.min), GridPoint::round(window.max))
}

/// Dissolves every node of degree 2 but cut ends.
fn dissolve(graph: &mut StreetGraph) {
    let nodes: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
    for node in nodes {
        if !graph.node(node).data.cut {
            graph.dissolve(node);
        }
    }
    graph.remove_isolated_nodes();
}
