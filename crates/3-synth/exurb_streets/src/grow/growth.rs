//! Growth of one layer inside one area: the queue and its turns.
//!
//! Source: Nishida et al. 2015, algorithm 1 and sections 4.3.1-4.3.4. A vertex from the queue 1
//! follows its example's own next patch (with the probability `continuation`), else 2 is connected
//! to what lies straight ahead, else 3 takes a patch drawn by eq. (2), else 4 grows from statistics.
//! The printed algorithm lacks 1 and 2; the authors' program has both, and connects first. We let a
//! fitting continuation go first, because connecting pre-empts it.

use std::collections::VecDeque;

use exurb_city::{Origin, Provenance, Street};
use exurb_geom::{GridPoint, Polygon, Vec2, polyline, trig};
use exurb_graph::NodeId;
use exurb_operation::{Rng, Run};
use rand::RngExt;

use super::error::Error;
use super::layer::{ChainEnd, NodeKind};
use super::learn::{Style, Vocabulary};
use super::network::{Coherent, Landing, Network, Piece, Vertex, Wish};
use super::params::Params;
use super::{drawing, placing, procedural};

/// How far a copied piece reaches with a `continuation` of one half, in metres.
const REACH_M: f64 = 250.0;

/// Growth of one layer.
pub struct Growth<'a> {
    /// The network grown into.
    pub net: Network,
    /// Examples, by number of the start that uses them.
    pub examples: &'a [&'a Vocabulary],
    /// Main streets (or local ones)?
    pub is_main: bool,
    /// The area to fill: places outside are not grown on.
    pub area: &'a Polygon,
    /// What the user set.
    pub params: &'a Params,
    /// The stream of this area.
    pub rng: Rng,
    /// Places to grow on: those of the piece that is being copied.
    pub queue: VecDeque<Place>,
    /// Places where that piece ended and another may begin.
    pub frontier: VecDeque<NodeId>,
    batch: u32,
}

/// A line that was laid.
#[derive(Clone, Copy, Debug)]
pub struct Laid {
    /// Its last node.
    pub to: NodeId,
    /// Did it come to its own end, a new node in the open?
    pub is_whole: bool,
}

/// A place to grow on.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// A node.
    Node(NodeId),
    /// A node of a main street where the example's local street `end` leaves.
    Branch(NodeId, ChainEnd),
    /// A node of a main street where a local street should leave in this direction.
    Away(NodeId, Vec2),
}

impl<'a> Growth<'a> {
    /// Growth into `net`, with nothing queued.
    pub fn new(
        net: Network,
        examples: &'a [&'a Vocabulary],
        is_main: bool,
        area: &'a Polygon,
        params: &'a Params,
        rng: Rng,
    ) -> Self {
        Self {
            net,
            examples,
            is_main,
            area,
            params,
            rng,
            queue: VecDeque::new(),
            frontier: VecDeque::new(),
            batch: 1,
        }
    }

    /// The layer's style for what grew from `start`.
    pub fn style(&self, start: usize) -> &'a Style {
        let example = self.example(start);
        if self.is_main { &example.main } else { &example.local }
    }

    /// The example of `start`.
    pub fn example(&self, start: usize) -> &'a Vocabulary {
        self.examples[start % self.examples.len()]
    }

    /// A number for pieces laid in one go.
    pub fn next_batch(&mut self) -> u32 {
        self.batch += 1;
        self.batch
    }

    /// Grows until nothing is queued: a piece is copied to its end before the next begins.
    pub fn run(&mut self, run: &Run) -> Result<(), Error> {
        let mut turns = 0_u32;
        loop {
            turns += 1;
            if turns.is_multiple_of(64) && run.is_cancelled() {
                return Err(Error::Cancelled);
            }
            match self.queue.pop_front() {
                Some(Place::Node(node)) => self.turn(node),
                Some(Place::Branch(node, end)) => placing::branch(self, node, end),
                Some(Place::Away(node, direction)) => drawing::away(self, node, direction),
                None => match self.frontier.pop_front() {
                    Some(node) => self.break_off(node),
                    None => return Ok(()),
                },
            }
        }
    }

    /// One turn of algorithm 1 inside a piece: follows the example, or leaves the place for later.
    fn turn(&mut self, node: NodeId) {
        let Some(n) = self.net.graph.get_node(node) else { return };
        let (at, vertex) = (n.at, n.data.clone());
        if vertex.outside || vertex.dead_end || !self.area.contains(at) {
            return;
        }
        let follows = vertex.piece.is_some_and(|piece| piece.holds(at.to_m()));
        if follows && !self.rng.random_bool(self.params.procedural) {
            let link = vertex.link.and_then(|l| self.linked_node(l, vertex.start));
            if link.is_some_and(|own| placing::continuation(self, node, own)) {
                return;
            }
        }
        self.frontier.push_back(node);
    }

    /// One turn of algorithm 1 where a piece ended.
    fn break_off(&mut self, node: NodeId) {
        let Some(n) = self.net.graph.get_node(node) else { return };
        let vertex = n.data.clone();
        let degree = self.net.graph.degree(node);
        let procedural = self.rng.random_bool(self.params.procedural);
        if degree > 2 || degree == 0 && vertex.link.is_none() {
            return;
        }
        if degree > 0 && procedural::connect(self, node) {
            return;
        }
        if !procedural && drawing::draw(self, node) {
            return;
        }
        procedural::expand(self, node);
    }

    /// A piece that begins at `origin`. How far it reaches is drawn around
    /// [`REACH_M`] · c / (1 - c), where c is the parameter `continuation`.
    pub fn begin_piece(&mut self, origin: Vec2) -> Coherent {
        let c = self.params.continuation;
        let spread = self.rng.random_range(0.7..1.3);
        let reach_m = if c < 1.0 { REACH_M * c / (1.0 - c) * spread } else { f64::INFINITY };
        Coherent { origin, reach_m }
    }

    /// The layer's node that is a copy's original.
    fn linked_node(&self, link: NodeId, start: usize) -> Option<usize> {
        self.style(start).layer.of_example[link.index()]
    }

    /// Queues a node that has just been made, unless it is to stay as it is.
    pub fn enqueue(&mut self, node: NodeId) {
        let vertex = &self.net.graph.node(node).data;
        if !vertex.outside && !vertex.dead_end {
            self.queue.push_back(Place::Node(node));
        }
    }

    /// The vertex of a copy of the layer's node `own`.
    pub fn copy_of(&self, own: usize, start: usize, piece: Option<Coherent>) -> Vertex {
        let node = &self.style(start).layer.nodes[own];
        Vertex {
            // Beyond the example's edge there is nothing to follow.
            link: (node.kind != NodeKind::Cut).then_some(node.example),
            dead_end: node.kind == NodeKind::DeadEnd,
            outside: false,
            start,
            piece,
        }
    }

    /// A piece copied from the example.
    pub fn copied(
        &self,
        street: &Street,
        start: usize,
        part: &std::sync::Arc<str>,
        batch: u32,
    ) -> Piece {
        let mut street = street.clone();
        street.provenance = Provenance {
            origin: Origin::Example,
            source: Some(self.example(start).name.clone()),
            part: Some(part.clone()),
        };
        street.name = None;
        Piece { street, batch, fixed: false, rim: false }
    }

    /// A piece made without a patch.
    pub fn made(&self, street: &Street, origin: Origin) -> Piece {
        let street = Street { provenance: Provenance::of(origin), name: None, ..street.clone() };
        Piece { street, batch: 0, fixed: false, rim: false }
    }

    /// Lays a line from `node` if it may be, ending wherever it must. Nodes of the other layer at
    /// `via` (points of the line, nodes of the example) become nodes of the network too, as far as
    /// the line got.
    pub fn lay(
        &mut self,
        node: NodeId,
        line: &[Vec2],
        wish: Wish,
        piece: Piece,
        vertex: Vertex,
        via: &[(usize, NodeId)],
    ) -> Option<Laid> {
        if self.leaves_cell(node, line) {
            return None;
        }
        let probe = self.net.probe(node, line, wish)?;
        let is_whole = probe.landing == Landing::Free && probe.kept > 0.999;
        let landed = polyline::length(&probe.line);
        let whole = probe.line.len() == line.len();
        let stops: Vec<(Vec2, NodeId)> = via
            .iter()
            .filter(|(i, _)| whole || polyline::length(&line[..=*i]) < landed - 12.0)
            .filter_map(|(i, n)| Some((*probe.line.get(*i)?, *n)))
            .collect();
        let (start, coherent) = (vertex.start, vertex.piece);
        let (to, mut edge) = self.net.commit(node, probe, piece, vertex)?;
        if !self.area.contains(self.net.graph.node(to).at) {
            self.net.graph.node_mut(to).data.outside = true;
        }
        for (at, link) in stops {
            let at = GridPoint::round(at);
            if let Some(middle) = self.net.split(edge, at) {
                let data = &mut self.net.graph.node_mut(middle).data;
                (data.link, data.start, data.piece) = (Some(link), start, coherent);
                // The rest of the line is the newest edge.
                edge = exurb_graph::EdgeId(self.net.graph.edge_bound() as u32 - 1);
            }
        }
        Some(Laid { to, is_whole })
    }

    /// Does a line from a node of the cell's border begin outside the cell, where the cell sees no
    /// streets?
    fn leaves_cell(&self, node: NodeId, line: &[Vec2]) -> bool {
        let on_border =
            self.net.graph.darts(node).iter().any(|d| self.net.graph.edge(d.edge()).data.fixed);
        on_border && !self.area.contains(GridPoint::round(polyline::point_at(line, 0.5)))
    }

    /// Is a free place there: nothing in the way on the first metres of this direction?
    pub fn is_open(&self, node: NodeId, direction: Vec2, least_rad: f64) -> bool {
        self.net.graph.darts(node).iter().all(|dart| {
            trig::angle_between(self.net.graph.direction(*dart, 15.0), direction) >= least_rad
        })
    }
}
