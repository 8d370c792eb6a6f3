use exurb_geom::{GridPoint, Vec2, grid, polyline};
use smallvec::SmallVec;

use crate::{Dart, EdgeId, NodeId};

/// A node: a place where edges end.
#[derive(Clone, Debug, PartialEq)]
pub struct Node<N> {
    /// Position on the grid.
    pub at: GridPoint,
    /// The owner's payload.
    pub data: N,
    darts: SmallVec<[Dart; 4]>,
}

/// An edge: a line between two nodes (which may be one and the same).
#[derive(Clone, Debug, PartialEq)]
pub struct Edge<E> {
    /// Node at the start of the line.
    pub from: NodeId,
    /// Node at the end of the line.
    pub to: NodeId,
    line: Vec<GridPoint>,
    /// The owner's payload.
    pub data: E,
}

impl<E> Edge<E> {
    /// The line from `from` to `to`, both positions included; at least two points.
    pub fn line(&self) -> &[GridPoint] {
        &self.line
    }

    /// Length in metres.
    pub fn length_m(&self) -> f64 {
        polyline::grid_length_m(&self.line)
    }

    /// The line in metres.
    pub fn line_m(&self) -> Vec<Vec2> {
        polyline::to_m(&self.line)
    }

    /// Line and payload.
    pub fn into_parts(self) -> (Vec<GridPoint>, E) {
        (self.line, self.data)
    }
}

/// An undirected graph drawn in the plane, with parallel edges and loops.
///
/// It is the caller's business that edges cross at nodes only ([`crate::noding`] prepares linework,
/// [`crate::laws`] tells); bridges may cross. Node and edge order is the order of insertion.
#[derive(Clone, Debug, PartialEq)]
pub struct Graph<N, E> {
    nodes: Vec<Option<Node<N>>>,
    edges: Vec<Option<Edge<E>>>,
}

impl<N, E> Default for Graph<N, E> {
    fn default() -> Self {
        Self { nodes: Vec::new(), edges: Vec::new() }
    }
}

impl<N, E> Graph<N, E> {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node.
    pub fn add_node(&mut self, at: GridPoint, data: N) -> NodeId {
        self.nodes.push(Some(Node { at, data, darts: SmallVec::new() }));
        NodeId(self.nodes.len() as u32 - 1)
    }

    /// Adds an edge along `line`, whose ends are moved onto the nodes; equal neighbours go.
    /// `None`, and nothing is added, when the line has no length.
    ///
    /// # Panics
    /// When a node does not exist.
    pub fn add_edge(
        &mut self,
        from: NodeId,
        to: NodeId,
        mut line: Vec<GridPoint>,
        data: E,
    ) -> Option<EdgeId> {
        let (a, b) = (self.node(from).at, self.node(to).at);
        match line.len() {
            0 | 1 => line = vec![a, b],
            n => (line[0], line[n - 1]) = (a, b),
        }
        line.dedup();
        if line.len() < 2 {
            return None;
        }
        let id = EdgeId(self.edges.len() as u32);
        self.node_mut(from).darts.push(id.forward());
        self.node_mut(to).darts.push(id.backward());
        self.edges.push(Some(Edge { from, to, line, data }));
        Some(id)
    }

    /// Removes an edge; its nodes stay. Returns it, or `None` when it was gone.
    pub fn remove_edge(&mut self, id: EdgeId) -> Option<Edge<E>> {
        let edge = self.edges.get_mut(id.index())?.take()?;
        for node in [edge.from, edge.to] {
            self.node_mut(node).darts.retain(|d| d.edge() != id);
        }
        Some(edge)
    }

    /// Removes a node without edges; `None` when it has some or was gone.
    pub fn remove_isolated_node(&mut self, id: NodeId) -> Option<Node<N>> {
        let slot = self.nodes.get_mut(id.index())?;
        slot.take_if(|n| n.darts.is_empty())
    }

    /// The node `id`.
    ///
    /// # Panics
    /// When it does not exist.
    pub fn node(&self, id: NodeId) -> &Node<N> {
        self.nodes[id.index()].as_ref().expect("the node exists")
    }

    /// The node `id`, to change. Moving it leaves its edges' lines behind: use
    /// [`Graph::move_node`].
    pub fn node_mut(&mut self, id: NodeId) -> &mut Node<N> {
        self.nodes[id.index()].as_mut().expect("the node exists")
    }

    /// The edge `id`.
    ///
    /// # Panics
    /// When it does not exist.
    pub fn edge(&self, id: EdgeId) -> &Edge<E> {
        self.edges[id.index()].as_ref().expect("the edge exists")
    }

    /// The edge `id`, to change its payload.
    pub fn edge_mut(&mut self, id: EdgeId) -> &mut Edge<E> {
        self.edges[id.index()].as_mut().expect("the edge exists")
    }

    /// The edge `id`, if it exists.
    pub fn get_edge(&self, id: EdgeId) -> Option<&Edge<E>> {
        self.edges.get(id.index())?.as_ref()
    }

    /// The node `id`, if it exists.
    pub fn get_node(&self, id: NodeId) -> Option<&Node<N>> {
        self.nodes.get(id.index())?.as_ref()
    }

    /// All nodes in order.
    pub fn nodes(&self) -> impl DoubleEndedIterator<Item = (NodeId, &Node<N>)> + Clone {
        self.nodes.iter().enumerate().filter_map(|(i, n)| Some((NodeId(i as u32), n.as_ref()?)))
    }

    /// All edges in order.
    pub fn edges(&self) -> impl DoubleEndedIterator<Item = (EdgeId, &Edge<E>)> + Clone {
        self.edges.iter().enumerate().filter_map(|(i, e)| Some((EdgeId(i as u32), e.as_ref()?)))
    }

    /// All nodes and all edges, in order.
    #[allow(clippy::type_complexity, reason = "two lists that are taken apart at once")]
    pub fn into_parts(
        self,
    ) -> (impl Iterator<Item = (NodeId, Node<N>)>, impl Iterator<Item = (EdgeId, Edge<E>)>) {
        let nodes = self.nodes.into_iter().enumerate();
        let edges = self.edges.into_iter().enumerate();
        (
            nodes.filter_map(|(i, n)| Some((NodeId(i as u32), n?))),
            edges.filter_map(|(i, e)| Some((EdgeId(i as u32), e?))),
        )
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.iter().flatten().count()
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.edges.iter().flatten().count()
    }

    /// One more than the largest node index ever used: the size of a table by node.
    pub fn node_bound(&self) -> usize {
        self.nodes.len()
    }

    /// One more than the largest edge index ever used: the size of a table by edge.
    pub fn edge_bound(&self) -> usize {
        self.edges.len()
    }

    /// Darts that leave `node`, in order of insertion.
    pub fn darts(&self, node: NodeId) -> &[Dart] {
        &self.node(node).darts
    }

    /// Number of edge ends at `node`; a loop counts twice.
    pub fn degree(&self, node: NodeId) -> usize {
        self.node(node).darts.len()
    }

    /// The node where `dart` starts.
    pub fn tail(&self, dart: Dart) -> NodeId {
        let edge = self.edge(dart.edge());
        if dart.is_forward() { edge.from } else { edge.to }
    }

    /// The node where `dart` ends.
    pub fn head(&self, dart: Dart) -> NodeId {
        self.tail(dart.twin())
    }

    /// The line of `dart` from its tail to its head.
    pub fn dart_line(&self, dart: Dart) -> Vec<GridPoint> {
        let mut line = self.edge(dart.edge()).line.clone();
        if !dart.is_forward() {
            line.reverse();
        }
        line
    }

    /// The line of `dart` in metres.
    pub fn dart_line_m(&self, dart: Dart) -> Vec<Vec2> {
        polyline::to_m(&self.dart_line(dart))
    }

    /// Unit direction in which `dart` leaves its tail, towards the point `within_m` along its line.
    pub fn direction(&self, dart: Dart, within_m: f64) -> Vec2 {
        let line = self.dart_line_m(dart);
        let d = polyline::point_at(&line, within_m) - line[0];
        // A loop of just this length comes back to its start; its first segment never does.
        if d.length() > 0.0 { d.normalize() } else { (line[1] - line[0]).normalize() }
    }

    /// Darts that leave `node`, counter-clockwise from east by their first segment, exactly;
    /// overlapping first segments keep the order of edges.
    pub fn darts_by_angle(&self, node: NodeId) -> SmallVec<[Dart; 4]> {
        let mut darts = self.node(node).darts.clone();
        let first = |dart: &Dart| {
            let line = &self.edge(dart.edge()).line;
            let (a, b) = if dart.is_forward() {
                (line[0], line[1])
            } else {
                (line[line.len() - 1], line[line.len() - 2])
            };
            (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y))
        };
        darts.sort_by(|d, e| grid::compare_angles(first(d), first(e)).then(d.cmp(e)));
        darts
    }

    /// Neighbours of `node`, one for each dart.
    pub fn neighbors(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        self.node(node).darts.iter().map(|d| self.head(*d))
    }

    /// Replaces an edge's line; the ends stay on its nodes. The line is left as it was when the new
    /// one has no length.
    pub fn set_line(&mut self, id: EdgeId, mut line: Vec<GridPoint>) {
        let (a, b) = {
            let e = self.edge(id);
            (self.node(e.from).at, self.node(e.to).at)
        };
        let n = line.len();
        if n < 2 {
            line = vec![a, b];
        } else {
            (line[0], line[n - 1]) = (a, b);
        }
        line.dedup();
        if line.len() >= 2 {
            self.edge_mut(id).line = line;
        }
    }

    /// Total length of all edges in metres.
    pub fn length_m(&self) -> f64 {
        // Not `sum`, whose nothing is -0.
        self.edges().fold(0.0, |sum, (_, e)| sum + e.length_m())
    }
}
