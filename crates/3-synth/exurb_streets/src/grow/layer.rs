//! One layer of the example (main or local streets) as a graph of chains.
//!
//! A chain is a street between two nodes where the layer's streets meet, end, or touch the other
//! layer; nodes of degree 2 lie inside chains. Patches are made of whole chains.

use exurb_city::street_graph::StreetGraph;
use exurb_city::{Role, Street};
use exurb_geom::{GridPoint, Vec2, polyline};
use exurb_graph::{Dart, EdgeId, NodeId};

/// What a node of a layer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeKind {
    /// Streets of the layer meet here, or one of them goes on in the other layer.
    Junction,
    /// A dead end of the example.
    DeadEnd,
    /// A local street meets a main street here.
    OnMain,
    /// The example was cut here; the street runs on outside.
    Cut,
}

/// A node of a layer.
#[derive(Clone, Debug)]
pub struct LayerNode {
    /// Position in the example, metres.
    pub at: Vec2,
    /// The node of the prepared example graph.
    pub example: NodeId,
    /// What it is.
    pub kind: NodeKind,
    /// Chains that end here.
    pub ends: Vec<ChainEnd>,
    /// The patch whose core holds it.
    pub patch: Option<usize>,
}

/// A chain seen from one of its ends: it leaves from its start when `forward`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ChainEnd {
    /// Index of the chain.
    pub chain: usize,
    /// Along the chain's line?
    pub forward: bool,
}

impl ChainEnd {
    /// The same chain from its other end.
    pub fn reversed(self) -> Self {
        Self { forward: !self.forward, ..self }
    }
}

/// A street between two nodes of a layer.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Node at the start of the line.
    pub from: usize,
    /// Node at the end of the line.
    pub to: usize,
    /// Its line in metres.
    pub line: Vec<Vec2>,
    /// Length in metres.
    pub length_m: f64,
    /// What the street is (of the longest piece).
    pub street: Street,
    /// Nodes of the other layer along it: index into `line` and node of the example graph.
    pub via: Vec<(usize, NodeId)>,
}

/// A layer of the example.
#[derive(Clone, Debug, Default)]
pub struct Layer {
    /// Its nodes.
    pub nodes: Vec<LayerNode>,
    /// Its chains.
    pub chains: Vec<Chain>,
    /// Index of the layer's node for a node of the example graph.
    pub of_example: Vec<Option<usize>>,
}

impl Layer {
    /// The layer of the edges for which `is_main` equals (`role` is main).
    pub fn of(graph: &StreetGraph, role: Role, is_main: &[bool]) -> Self {
        let own = |id: EdgeId| is_main[id.index()] == (role == Role::Main);
        let mut layer = Self { of_example: vec![None; graph.node_bound()], ..Self::default() };
        let mut used = vec![false; graph.edge_bound()];
        let ends = |node: NodeId| -> Vec<Dart> {
            graph.darts(node).iter().copied().filter(|d| own(d.edge())).collect()
        };
        let kind_of = |node: NodeId| -> Option<NodeKind> {
            let darts = ends(node);
            let touches_other = graph.degree(node) > darts.len();
            if darts.is_empty() {
                None
            } else if graph.node(node).data.cut {
                Some(NodeKind::Cut)
            } else if role != Role::Main && touches_other {
                Some(NodeKind::OnMain)
            } else if darts.len() == 2 {
                None
            } else if darts.len() == 1 && !touches_other {
                Some(NodeKind::DeadEnd)
            } else {
                Some(NodeKind::Junction)
            }
        };
        for (node, _) in graph.nodes() {
            if let Some(kind) = kind_of(node) {
                layer.add_node(graph, node, kind);
            }
        }
        for index in 0..layer.nodes.len() {
            for dart in ends(layer.nodes[index].example) {
                layer.walk_chain(graph, index, dart, &ends, &mut used);
            }
        }
        // Rings without any node: begin them anywhere.
        for (id, edge) in graph.edges().filter(|(id, _)| own(*id)) {
            if !used[id.index()] {
                let node = layer.add_node(graph, edge.from, NodeKind::Junction);
                layer.walk_chain(graph, node, id.forward(), &ends, &mut used);
            }
        }
        layer
    }

    fn add_node(&mut self, graph: &StreetGraph, node: NodeId, kind: NodeKind) -> usize {
        let at = graph.node(node).at.to_m();
        let index = self.nodes.len();
        self.of_example[node.index()] = Some(index);
        self.nodes.push(LayerNode { at, example: node, kind, ends: Vec::new(), patch: None });
        index
    }

    fn walk_chain(
        &mut self,
        graph: &StreetGraph,
        from: usize,
        start: Dart,
        ends: &impl Fn(NodeId) -> Vec<Dart>,
        used: &mut [bool],
    ) {
        if used[start.edge().index()] {
            return;
        }
        let mut points: Vec<GridPoint> = vec![graph.node(graph.tail(start)).at];
        let mut via = Vec::new();
        let mut longest = (0.0, &graph.edge(start.edge()).data);
        let mut dart = start;
        let to = loop {
            used[dart.edge().index()] = true;
            let edge = graph.edge(dart.edge());
            if edge.length_m() > longest.0 {
                longest = (edge.length_m(), &edge.data);
            }
            points.extend(&graph.dart_line(dart)[1..]);
            let head = graph.head(dart);
            if let Some(node) = self.of_example[head.index()] {
                break node;
            }
            let darts = ends(head);
            if graph.degree(head) > darts.len() {
                via.push((points.len() - 1, head));
            }
            match darts.iter().find(|d| **d != dart.twin()) {
                Some(next) => dart = *next,
                None => break self.add_node(graph, head, NodeKind::Junction),
            }
        };
        let line = polyline::to_m(&points);
        let length_m = polyline::length(&line);
        let chain = self.chains.len();
        let street = longest.1.clone();
        self.chains.push(Chain { from, to, line, length_m, street, via });
        self.nodes[from].ends.push(ChainEnd { chain, forward: true });
        self.nodes[to].ends.push(ChainEnd { chain, forward: false });
    }

    /// The node where `end` leaves from.
    pub fn tail(&self, end: ChainEnd) -> usize {
        let chain = &self.chains[end.chain];
        if end.forward { chain.from } else { chain.to }
    }

    /// The node where `end` leads to.
    pub fn head(&self, end: ChainEnd) -> usize {
        self.tail(end.reversed())
    }

    /// The chain's line as seen from `end`.
    pub fn line(&self, end: ChainEnd) -> Vec<Vec2> {
        let mut line = self.chains[end.chain].line.clone();
        if !end.forward {
            line.reverse();
        }
        line
    }

    /// The chain's nodes of the other layer as seen from `end`: index into [`Layer::line`].
    pub fn via(&self, end: ChainEnd) -> Vec<(usize, NodeId)> {
        let chain = &self.chains[end.chain];
        if end.forward {
            return chain.via.clone();
        }
        let last = chain.line.len() - 1;
        chain.via.iter().rev().map(|(i, n)| (last - i, *n)).collect()
    }

    /// Unit direction in which `end` leaves, over its first 15 m.
    pub fn direction(&self, end: ChainEnd) -> Vec2 {
        let line = self.line(end);
        (polyline::point_at(&line, 15.0) - line[0]).normalize_or(Vec2::X)
    }
}
