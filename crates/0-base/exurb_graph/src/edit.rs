//! Edits of a graph, one function each. Every edit keeps total length within what it says, never
//! leaves a dangling id, and never makes an edge without length.

use exurb_geom::{GridPoint, polyline};

use crate::{EdgeId, Graph, NodeId};

impl<N: Clone + Default, E: Clone> Graph<N, E> {
    /// Splits edge `id` at the point of its line nearest to `at`: a new node there, and two edges
    /// in place of one. Returns the node and both edges (start, end). When the point is an end of
    /// the edge, nothing changes and `None` returns.
    ///
    /// `at` becomes a vertex: when it lies off the line (by rounding, or on purpose), the line bends
    /// to it.
    pub fn split_edge(&mut self, id: EdgeId, at: GridPoint) -> Option<(NodeId, EdgeId, EdgeId)> {
        let edge = self.get_edge(id)?;
        let line = edge.line();
        if line.first() == Some(&at) || line.last() == Some(&at) {
            return None;
        }
        let segment = match line.iter().position(|p| *p == at) {
            Some(vertex) => vertex - 1,
            None => polyline::nearest(&polyline::to_m(line), at.to_m()).2,
        };
        let mut head: Vec<GridPoint> = line[..=segment].to_vec();
        head.push(at);
        let mut tail = vec![at];
        tail.extend(line[segment + 1..].iter().skip_while(|p| **p == at));
        let edge = self.remove_edge(id)?;
        let node = self.add_node(at, N::default());
        let first = self.add_edge(edge.from, node, head, edge.data.clone());
        let second = self.add_edge(node, edge.to, tail, edge.data);
        Some((node, first?, second?))
    }

    /// Moves `node` to `at`; its edges' end points follow. Edges that shrink to nothing go.
    pub fn move_node(&mut self, node: NodeId, at: GridPoint) {
        self.node_mut(node).at = at;
        let edges: Vec<EdgeId> = self.darts(node).iter().map(|d| d.edge()).collect();
        for id in edges {
            let Some(edge) = self.get_edge(id) else { continue };
            let (a, b) = (self.node(edge.from).at, self.node(edge.to).at);
            let mut line = edge.line().to_vec();
            let n = line.len();
            (line[0], line[n - 1]) = (a, b);
            line.dedup();
            if line.len() < 2 {
                self.remove_edge(id);
            } else {
                self.set_line(id, line);
            }
        }
    }

    /// Merges `gone` into `kept`: its edges end at `kept` instead. Edges that shrink to nothing go.
    pub fn merge_nodes(&mut self, kept: NodeId, gone: NodeId) {
        if kept == gone {
            return;
        }
        let edges: Vec<EdgeId> = {
            let mut ids: Vec<EdgeId> = self.darts(gone).iter().map(|d| d.edge()).collect();
            ids.sort_unstable();
            ids.dedup();
            ids
        };
        for id in edges {
            let Some(edge) = self.remove_edge(id) else { continue };
            let end = |n: NodeId| if n == gone { kept } else { n };
            let line = edge.line().to_vec();
            self.add_edge(end(edge.from), end(edge.to), line, edge.data);
        }
        self.remove_isolated_node(gone);
    }

    /// Joins dead-end or any other `node` onto `edge`: splits the edge where it is nearest to the
    /// node and merges the node into the split, or into the edge's end if that is nearest.
    /// Returns the node that stays.
    pub fn snap_node_to_edge(&mut self, node: NodeId, edge: EdgeId) -> Option<NodeId> {
        let e = self.get_edge(edge)?;
        let (near, _, _) = polyline::nearest(&e.line_m(), self.node(node).at.to_m());
        let at = GridPoint::round(near);
        let (from, to) = (e.from, e.to);
        let kept = if at == self.node(from).at {
            from
        } else if at == self.node(to).at {
            to
        } else {
            self.split_edge(edge, at)?.0
        };
        self.merge_nodes(kept, node);
        Some(kept)
    }

    /// Dissolves a node of degree 2: its two edges become one that keeps the first one's payload
    /// and direction. `None` when the node has another degree or its edge is a loop.
    pub fn dissolve(&mut self, node: NodeId) -> Option<EdgeId> {
        let [a, b] = self.darts(node) else { return None };
        let (first, second) = (a.edge().min(b.edge()), a.edge().max(b.edge()));
        if first == second {
            return None;
        }
        let (into, out) = if a.edge() == first { (*a, *b) } else { (*b, *a) };
        let (start, end) = (self.head(into), self.head(out));
        let mut line = self.dart_line(into.twin());
        line.extend(&self.dart_line(out)[1..]);
        // `into.twin()` runs to the node; keep the first edge's own direction.
        let forward = into.twin().is_forward();
        self.remove_edge(second)?;
        let data = self.remove_edge(first)?.data;
        self.remove_isolated_node(node);
        if forward {
            self.add_edge(start, end, line, data)
        } else {
            line.reverse();
            self.add_edge(end, start, line, data)
        }
    }

    /// Collapses an edge: its nodes become one, at the middle of its line. Returns that node.
    pub fn collapse_edge(&mut self, id: EdgeId) -> Option<NodeId> {
        let edge = self.remove_edge(id)?;
        let line = edge.line_m();
        let middle = polyline::point_at(&line, polyline::length(&line) / 2.0);
        if edge.from != edge.to {
            self.move_node(edge.from, GridPoint::round(middle));
            self.merge_nodes(edge.from, edge.to);
        }
        Some(edge.from)
    }

    /// Removes every node without edges.
    pub fn remove_isolated_nodes(&mut self) {
        let lonely: Vec<NodeId> =
            self.nodes().filter(|(id, _)| self.degree(*id) == 0).map(|(id, _)| id).collect();
        for id in lonely {
            self.remove_isolated_node(id);
        }
    }

    /// [`Graph::compacted`] that takes the graph, so that no line is held twice.
    pub fn into_compacted(self) -> Self {
        let mut out = Self::new();
        let mut new_id = vec![NodeId(u32::MAX); self.node_bound()];
        let (nodes, edges) = self.into_parts();
        for (id, node) in nodes {
            new_id[id.index()] = out.add_node(node.at, node.data);
        }
        for (_, edge) in edges {
            let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
            let (line, data) = edge.into_parts();
            out.add_edge(from, to, line, data);
        }
        out
    }

    /// The same graph without gaps in its ids: nodes and edges renumbered in their order.
    pub fn compacted(&self) -> Self {
        let mut out = Self::new();
        let mut new_id = vec![NodeId(u32::MAX); self.node_bound()];
        for (id, node) in self.nodes() {
            new_id[id.index()] = out.add_node(node.at, node.data.clone());
        }
        for (_, edge) in self.edges() {
            let (from, to) = (new_id[edge.from.index()], new_id[edge.to.index()]);
            out.add_edge(from, to, edge.line().to_vec(), edge.data.clone());
        }
        out
    }
}
