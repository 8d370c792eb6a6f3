//! The street network inside the target, as shares are measured on it: clipped, cut ends marked,
//! nodes of degree 2 dissolved.

use exurb_graph::{EdgeId, Graph, NodeId};

use crate::{City, Junction, street_graph};

/// The network inside the target; each edge names the (first) street that it is a part of.
pub struct Inside {
    pub graph: Graph<Junction, EdgeId>,
}

impl Inside {
    pub fn of(city: &City) -> Self {
        let mut graph = clipped(city);
        let nodes: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
        for node in nodes {
            if !graph.node(node).data.cut {
                graph.dissolve(node);
            }
        }
        Self { graph }
    }

    pub fn is_cut(&self, node: NodeId) -> bool {
        self.graph.node(node).data.cut
    }

    /// Does the border cut the edge?
    pub fn is_cut_edge(&self, edge: EdgeId) -> bool {
        let edge = self.graph.edge(edge);
        self.is_cut(edge.from) || self.is_cut(edge.to)
    }

    /// Nodes that the border did not make.
    pub fn own_nodes(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.graph.nodes().filter(|(_, n)| !n.data.cut).map(|(id, _)| id)
    }
}

/// The streets inside the target, each naming the one it is a part of, cut ends marked.
pub fn clipped(city: &City) -> Graph<Junction, EdgeId> {
    let mut graph = Graph::new();
    let mut new_id = vec![NodeId(u32::MAX); city.streets.node_bound()];
    for (id, node) in city.streets.nodes() {
        new_id[id.index()] = graph.add_node(node.at, node.data.clone());
    }
    let mut leaves = false;
    for (id, edge) in city.streets.edges() {
        leaves |= edge.line().iter().any(|p| !city.target.contains(*p));
        let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
        graph.add_edge(from, to, edge.line().to_vec(), id);
    }
    if leaves {
        for node in graph.clip(&city.target) {
            graph.node_mut(node).data.cut = true;
        }
    }
    graph.remove_isolated_nodes();
    street_graph::mark_ends_on_border(&mut graph, &city.target);
    graph
}
