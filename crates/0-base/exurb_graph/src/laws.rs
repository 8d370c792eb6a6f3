//! What every finished graph keeps.

use std::fmt;

use crate::{EdgeId, Graph, NodeId};

/// A broken law and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breach {
    /// A dart list names an edge that does not start there.
    Topology(NodeId),
    /// A line does not begin and end at its nodes.
    Ends(EdgeId),
    /// A line has equal neighbouring points or fewer than two points.
    Degenerate(EdgeId),
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Topology(n) => write!(f, "node {} lists a dart that is not its own", n.0),
            Self::Ends(e) => write!(f, "the line of edge {} does not end at its nodes", e.0),
            Self::Degenerate(e) => write!(f, "the line of edge {} has no length somewhere", e.0),
        }
    }
}

/// Every breach of the structure's own laws; empty for a sound graph. O(n).
pub fn breaches<N, E>(graph: &Graph<N, E>) -> Vec<Breach> {
    let mut out = Vec::new();
    for (node, _) in graph.nodes() {
        let sound = graph
            .darts(node)
            .iter()
            .all(|d| graph.get_edge(d.edge()).is_some() && graph.tail(*d) == node);
        if !sound {
            out.push(Breach::Topology(node));
        }
    }
    for (id, edge) in graph.edges() {
        let line = edge.line();
        let listed = graph.darts(edge.from).contains(&id.forward())
            && graph.darts(edge.to).contains(&id.backward());
        if !listed {
            out.push(Breach::Topology(edge.from));
        }
        if line.len() < 2 || line.windows(2).any(|w| w[0] == w[1]) {
            out.push(Breach::Degenerate(id));
        } else if line[0] != graph.node(edge.from).at
            || line[line.len() - 1] != graph.node(edge.to).at
        {
            out.push(Breach::Ends(id));
        }
    }
    out
}
