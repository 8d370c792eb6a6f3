//! The streets grown so far, and the one way to add to them.
//!
//! Everything that growth lays goes through [`Network::probe`], which finds where a line may end and
//! refuses what would break a law: a crossing without a node, streets side by side, acute corners,
//! crowded junctions. So the network is legal after every step.

mod probe;

use exurb_city::Street;
use exurb_geom::{Bounds, GridPoint, PointIndex, SegmentIndex, Vec2, polyline};
use exurb_graph::{Dart, EdgeId, Graph, NodeId};

pub use probe::{Landing, Probe, Wish, bend};

use super::fit::fourfold;
use super::plan::Motion;

/// No two streets run nearer than this, but where they meet.
pub const CLEARANCE_M: f64 = 7.0;
/// A free end nearer than this to another street joins it.
pub const JOIN_M: f64 = 14.0;
/// No street is shorter.
pub const SHORTEST_M: f64 = 10.0;
/// No more streets than this meet in one place.
const MOST_STREETS: usize = 5;

/// Where a node of the new network comes from, and whether it may grow on.
#[derive(Clone, Debug, Default)]
pub struct Vertex {
    /// The node of the example it is a copy of.
    pub link: Option<NodeId>,
    /// A dead end in the example too: stays.
    pub dead_end: bool,
    /// Lies at or beyond the edge of the grown area: not grown on, no dead end.
    pub outside: bool,
    /// The copied piece it belongs to.
    pub piece: Option<Coherent>,
}

/// A piece of the example that is copied without a break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coherent {
    /// Its number in [`super::claims::Claims`].
    pub id: u32,
    /// Number of the example.
    pub example: usize,
    /// How the example is moved.
    pub motion: Motion,
    /// The place in the example that lies on `at`.
    pub source: Vec2,
    /// Where it began.
    pub at: Vec2,
    /// How far from there it reaches.
    pub reach_m: f64,
}

impl Coherent {
    /// Where the example's place `p` lies.
    pub fn place(&self, p: Vec2) -> Vec2 {
        self.at + self.motion.apply(p - self.source)
    }

    /// The place of the example that lies on `p`.
    pub fn original(&self, p: Vec2) -> Vec2 {
        self.source + self.motion.undo(p - self.at)
    }
}

/// A piece of street in the new network.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The street.
    pub street: Street,
    /// Pieces laid in one go: taken from one place of the example, they may be as near to each other
    /// as they were there.
    pub batch: u32,
    /// What may be done with it.
    pub standing: Standing,
}

/// What growth may do with a piece of street.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Grown: may be split, and may go in the end.
    Grown,
    /// Given: may be split, stays.
    Given,
    /// Of the main streets around a cell: streets may end on it at its nodes only.
    Main,
    /// A bridge: streets meet it at its ends only.
    Bridge,
    /// Beyond the border of the ground: in view only.
    Beyond,
    /// Not a street but the border of the ground.
    Rim,
}

impl Piece {
    /// A grown piece of that street, laid alone.
    pub fn of(street: Street) -> Self {
        Self { street, batch: 0, standing: Standing::Grown }
    }

    /// A piece that is no street.
    pub fn standing(standing: Standing) -> Self {
        Self { standing, ..Self::of(Street::default()) }
    }

    /// Not a street?
    pub fn is_rim(&self) -> bool {
        self.standing == Standing::Rim
    }

    /// May streets end on it at its nodes only?
    pub fn is_fixed(&self) -> bool {
        !matches!(self.standing, Standing::Grown | Standing::Given)
    }
}

/// The growing network.
#[derive(Clone, Debug)]
pub struct Network {
    /// Nodes and edges.
    pub graph: Graph<Vertex, Piece>,
    segments: SegmentIndex,
    points: PointIndex,
}

impl Network {
    /// An empty network whose streets are about `street_m` long.
    pub fn new(street_m: f64) -> Self {
        let cell_m = street_m.clamp(25.0, 80.0);
        Self {
            graph: Graph::new(),
            segments: SegmentIndex::new(cell_m),
            points: PointIndex::new(cell_m),
        }
    }

    /// Adds a node.
    pub fn add_node(&mut self, at: GridPoint, vertex: Vertex) -> NodeId {
        let id = self.graph.add_node(at, vertex);
        self.points.insert(id.0, at.to_m());
        id
    }

    /// Adds an edge without asking; for what is given.
    pub fn add_edge(
        &mut self,
        from: NodeId,
        to: NodeId,
        line: Vec<GridPoint>,
        piece: Piece,
    ) -> Option<EdgeId> {
        let id = self.graph.add_edge(from, to, line, piece)?;
        self.segments.insert_line(id.0, &self.graph.edge(id).line_m());
        Some(id)
    }

    /// Splits an edge.
    pub fn split(&mut self, edge: EdgeId, at: GridPoint) -> Option<NodeId> {
        let line = self.graph.edge(edge).line_m();
        let (node, first, second) = self.graph.split_edge(edge, at)?;
        self.segments.remove_line(edge.0, &line);
        for id in [first, second] {
            self.segments.insert_line(id.0, &self.graph.edge(id).line_m());
        }
        self.points.insert(node.0, at.to_m());
        Some(node)
    }

    /// The nearest node within `radius_m` of `p`, other than `except`.
    pub fn node_near(&self, p: Vec2, radius_m: f64, except: Option<NodeId>) -> Option<NodeId> {
        self.points
            .within(p, radius_m)
            .into_iter()
            .map(|(id, _)| NodeId(id))
            .find(|id| Some(*id) != except && self.graph.get_node(*id).is_some())
    }

    /// All nodes within `radius_m` of `p`, nearest first.
    pub fn nodes_near(&self, p: Vec2, radius_m: f64) -> impl Iterator<Item = NodeId> + '_ {
        self.points.within(p, radius_m).into_iter().map(|(id, _)| NodeId(id))
    }

    /// The nearest street within `radius_m` of `p`, and where.
    pub fn edge_near(&self, p: Vec2, radius_m: f64) -> Option<(EdgeId, Vec2)> {
        let mut best: Option<(f64, u32, Vec2)> = None;
        self.segments.visit(Bounds { min: p - radius_m, max: p + radius_m }, |e| {
            let q = polyline::nearest_on_segment(e.a, e.b, p).0;
            let d = q.distance(p);
            let better = best.is_none_or(|(least, id, _)| d < least || (d == least && e.id < id));
            if d <= radius_m && better && !self.graph.edge(EdgeId(e.id)).data.is_rim() {
                best = Some((d, e.id, q));
            }
            true
        });
        best.map(|(_, id, q)| (EdgeId(id), q))
    }

    /// Is the border of the ground nearer to `p` than this?
    pub fn rim_near(&self, p: Vec2, near_m: f64) -> bool {
        let mut is_near = false;
        self.segments.visit(Bounds { min: p - near_m, max: p + near_m }, |e| {
            is_near |= self.graph.edge(EdgeId(e.id)).data.is_rim()
                && polyline::nearest_on_segment(e.a, e.b, p).0.distance(p) < near_m;
            !is_near
        });
        is_near
    }

    /// The mean of the directions of streets near `p`, each with its angle multiplied by four: long
    /// where they run in two directions at right angles, short where they run anyhow.
    pub fn grain_near(&self, p: Vec2, radius_m: f64) -> Vec2 {
        let (mut sum, mut total) = (Vec2::ZERO, 0.0);
        self.segments.visit(Bounds { min: p - radius_m, max: p + radius_m }, |e| {
            if !self.graph.edge(EdgeId(e.id)).data.is_rim() {
                let length = e.a.distance(e.b);
                sum += fourfold((e.b - e.a) / length.max(1e-9)) * length;
                total += length;
            }
            true
        });
        if total > 0.0 { sum / total } else { Vec2::ZERO }
    }

    /// Distance and direction of the nearest street within `radius_m` of `p`.
    pub fn street_near(&self, p: Vec2, radius_m: f64) -> Option<(f64, Vec2)> {
        let mut best: Option<(f64, Vec2)> = None;
        self.segments.visit(Bounds { min: p - radius_m, max: p + radius_m }, |e| {
            let d = polyline::nearest_on_segment(e.a, e.b, p).0.distance(p);
            let nearer = best.is_none_or(|(least, _)| d < least);
            if d <= radius_m && nearer && !self.graph.edge(EdgeId(e.id)).data.is_rim() {
                best = Some((d, (e.b - e.a).normalize_or_zero()));
            }
            true
        });
        best
    }

    /// Lays a probed line: splits where it lands and adds the edge. Returns its last node, new or
    /// not, and the edge. `vertex` becomes the last node's when that is new.
    pub fn commit(
        &mut self,
        from: NodeId,
        probe: Probe,
        piece: Piece,
        vertex: Vertex,
    ) -> Option<(NodeId, EdgeId)> {
        let mut line = polyline::round(&probe.line);
        let last = line.len().checked_sub(1)?;
        let to = match probe.landing {
            Landing::Node(node) => node,
            Landing::Free => self.add_node(line[last], vertex),
            Landing::Rim => {
                self.add_node(line[last], Vertex { outside: true, link: None, ..vertex })
            }
            Landing::Edge(edge, at) => {
                line[last] = at;
                match self.split(edge, at) {
                    Some(node) => node,
                    // The point rounds to an end of the edge.
                    None => {
                        let e = self.graph.edge(edge);
                        if self.graph.node(e.from).at == at { e.from } else { e.to }
                    }
                }
            }
        };
        let edge = self.add_edge(from, to, line, piece)?;
        Some((to, edge))
    }

    /// Removes an edge; nodes left without any go too.
    pub fn remove_edge(&mut self, id: EdgeId) {
        let line = self.graph.edge(id).line_m();
        self.segments.remove_line(id.0, &line);
        let Some(edge) = self.graph.remove_edge(id) else { return };
        for node in [edge.from, edge.to] {
            self.remove_lonely(node);
        }
    }

    /// Removes a node if it has no edge.
    pub fn remove_lonely(&mut self, node: NodeId) {
        if let Some(n) = self.graph.get_node(node)
            && self.graph.degree(node) == 0
        {
            self.points.remove(node.0, n.at.to_m());
            self.graph.remove_isolated_node(node);
        }
    }

    /// The streets at a node: all but the border of the ground.
    pub fn streets_at(&self, node: NodeId) -> impl Iterator<Item = Dart> + '_ {
        let darts = self.graph.darts(node).iter().copied();
        darts.filter(|dart| !self.graph.edge(dart.edge()).data.is_rim())
    }

    /// Is the node full?
    pub fn crowded(&self, node: NodeId) -> bool {
        self.streets_at(node).count() >= MOST_STREETS
    }

    /// Streets that end at `node`, as lines that arrive there, each up to the next node that is not
    /// of degree 2.
    pub fn arriving(&self, node: NodeId) -> Vec<Vec<Vec2>> {
        self.streets_at(node).map(|dart| self.arriving_along(dart)).collect()
    }

    fn arriving_along(&self, leaving: Dart) -> Vec<Vec2> {
        let mut line = self.graph.dart_line_m(leaving);
        let mut dart = leaving;
        for _ in 0..32 {
            let head = self.graph.head(dart);
            let [a, b] = self.graph.darts(head) else { break };
            dart = if *a == dart.twin() { *b } else { *a };
            if dart.edge() == leaving.edge() {
                break;
            }
            line.extend(&self.graph.dart_line_m(dart)[1..]);
        }
        line.reverse();
        line
    }
}
