//! Growth of one layer inside one area: the queues and their turns.
//!
//! Source: Nishida et al. 2015, algorithm 1 and sections 4.3.1-4.3.4. Inside a piece of the example
//! that is being copied a vertex follows the example's own next patch; where the piece ends, a
//! vertex 1 is connected to what lies straight ahead, else 2 takes a patch drawn by eq. (2), with
//! which the next piece begins, else 3 grows from statistics. The printed algorithm knows 2 and 3
//! only; the authors' program follows the example wherever it can, and connects before all else.

use std::collections::VecDeque;
use std::sync::Arc;

use exurb_city::{Origin, Provenance, Street};
use exurb_geom::{GridPoint, Polygon, RowPolygon, Vec2, polyline, trig};
use exurb_graph::{EdgeId, NodeId};
use exurb_measure::statistics::StreetStatistics;
use exurb_operation::{Rng, Run};
use rand::RngExt;

use super::bridges::Ford;
use super::claims::Claims;
use super::error::Error;
use super::layer::{ChainEnd, NodeKind};
use super::learn::Style;
use super::network::{Coherent, Landing, Network, Piece, Vertex, Wish};
use super::params::{Order, Params};
use super::plan::Plan;
use super::relief::{Relief, Verdict};
use super::seams::{Leaving, Seams};
use super::{drawing, placing, procedural, seams};

/// How far a copied piece reaches with a `continuation` of one half, in metres.
const REACH_M: f64 = 250.0;

/// Streets that no piece holds keep this many times the example's spacing from others.
const SPACING: f64 = 1.2;

/// Streets leave the border of a part of a city at this angle at least, in radians.
const RIM_RAD: f64 = 0.25;

/// Growth of one layer.
pub struct Growth<'a> {
    /// The network grown into.
    pub net: Network,
    /// What grows where.
    pub plan: &'a Plan<'a>,
    /// Main streets (or local ones)?
    pub is_main: bool,
    /// The area to fill: places outside are not grown on.
    pub area: &'a Polygon,
    /// The same, for asking what lies inside.
    pub inside: RowPolygon<'a>,
    /// What the user set.
    pub params: &'a Params,
    /// The stream of this area.
    pub rng: Rng,
    /// Places to grow on: those of the piece that is being copied.
    pub queue: VecDeque<Place>,
    /// Places where that piece ended and another may begin.
    pub frontier: VecDeque<Open>,
    /// Streets that leave their pieces.
    pub seams: Seams,
    /// Which piece every place belongs to.
    pub claims: Claims,
    /// The ground.
    pub relief: &'a Relief,
    /// Main streets that came to water.
    pub fords: Vec<Ford>,
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

/// A place where a piece ended.
#[derive(Clone, Copy, Debug)]
pub enum Open {
    /// A node.
    Node(NodeId),
    /// A street that leaves the piece, by its number in [`Growth::seams`].
    Street(usize),
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
        plan: &'a Plan<'a>,
        is_main: bool,
        area: &'a Polygon,
        relief: &'a Relief,
        claims: Claims,
        rng: Rng,
    ) -> Self {
        let (queue, frontier) = (VecDeque::new(), VecDeque::new());
        let seams = Seams::new();
        let fords = Vec::new();
        Self {
            net,
            plan,
            is_main,
            area,
            inside: RowPolygon::new(area),
            params: plan.params,
            rng,
            queue,
            frontier,
            seams,
            claims,
            relief,
            fords,
            batch: 1,
        }
    }

    /// The layer's style in an example.
    pub fn style(&self, example: usize) -> &'a Style {
        self.plan.examples[example].style(self.is_main)
    }

    /// The statistics of the layer's streets at a node.
    pub fn statistics(&self, node: NodeId) -> StreetStatistics {
        let n = self.net.graph.node(node);
        let own = n.data.piece.map(|piece| piece.example);
        let example = own.unwrap_or_else(|| self.plan.example_at(n.at.to_m()));
        self.plan.statistics(example, self.is_main)
    }

    /// Mean length of the layer's streets at a node, in metres.
    pub fn street_m(&self, node: NodeId) -> f64 {
        let mean = self.statistics(node).length_mean_m;
        if mean > 0.0 { mean } else { 100.0 }
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
                None => match self.next_open() {
                    Some(Open::Node(node)) => self.break_off(node),
                    Some(Open::Street(number)) => {
                        if let Some(leaving) = self.seams.take(number) {
                            seams::leave(self, leaving);
                        }
                    }
                    None => return Ok(()),
                },
            }
        }
    }

    /// Takes the place where the next piece may begin.
    fn next_open(&mut self) -> Option<Open> {
        /// Of so many that have waited longest one is chosen.
        const CHOSEN_AMONG: usize = 64;
        /// Streets that wait this near to a place wait for a piece there, in metres.
        const ANSWERED_M: f64 = 150.0;
        let start_m = |p: Vec2| {
            let starts = self.plan.starts.iter().map(|start| start.at.distance(p));
            starts.fold(f64::INFINITY, f64::min)
        };
        let cost = |p: Vec2| match self.params.order {
            Order::First => 0.0,
            Order::Nearest => start_m(p),
            Order::Fit => -(self.seams.near(p, ANSWERED_M).count() as f64),
        };
        let place = |open: &Open| match open {
            Open::Node(node) => self.net.graph.get_node(*node).map(|n| n.at.to_m()),
            Open::Street(number) => self.seams.exit(*number),
        };
        if self.params.order == Order::First {
            return self.frontier.pop_front();
        }
        let waiting = self.frontier.iter().take(CHOSEN_AMONG).enumerate();
        // What has gone since costs least, so that it is soon out of the way.
        let costs = waiting.map(|(i, open)| (i, place(open).map_or(f64::NEG_INFINITY, cost)));
        let best = costs.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))?.0;
        self.frontier.remove(best)
    }

    /// One turn inside a piece: follows the example, or leaves the place for later.
    fn turn(&mut self, node: NodeId) {
        let Some(n) = self.net.graph.get_node(node) else { return };
        let (at, vertex) = (n.at, n.data.clone());
        if vertex.outside || vertex.dead_end || !self.inside.contains(at) {
            return;
        }
        let at = at.to_m();
        if let (Some(piece), Some(link)) = (vertex.piece, vertex.link)
            && self.holds(&piece, at)
            && piece.example == self.plan.example_at(at)
            && !self.rng.random_bool(self.params.procedural)
            && let Some(own) = self.style(piece.example).layer.of_example[link.index()]
            && placing::continuation(self, node, piece, own)
        {
            return;
        }
        self.frontier.push_back(Open::Node(node));
    }

    /// Lets a street wait that leaves its piece.
    pub fn let_wait(&mut self, leaving: Leaving) {
        let number = self.seams.push(leaving);
        self.frontier.push_back(Open::Street(number));
    }

    /// Does the ground at `p` belong to `piece`, or does nobody claim it so near to the piece?
    pub fn is_own(&mut self, piece: &Coherent, p: Vec2) -> bool {
        // A piece that has not begun yet claims what it reaches.
        match self.claims.owner(p) {
            None => p.distance(piece.at) < piece.reach_m,
            Some(owner) => owner == piece.id,
        }
    }

    /// One turn where a piece ended.
    pub fn break_off(&mut self, node: NodeId) {
        let Some(n) = self.net.graph.get_node(node) else { return };
        let is_linked = n.data.link.is_some();
        let degree = self.net.streets_at(node).count();
        let procedural = self.rng.random_bool(self.params.procedural);
        if degree > 2 || degree == 0 && !is_linked {
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

    /// A piece of `example` that may begin at `at`; it claims nothing yet. How far it reaches is drawn
    /// around [`REACH_M`] · c / (1 - c), where c is the parameter `continuation`.
    pub fn piece(&mut self, example: usize, at: Vec2) -> Coherent {
        let c = self.params.continuation;
        let spread = self.rng.random_range(0.7..1.3);
        let reach_m = if c < 1.0 { REACH_M * c / (1.0 - c) * spread } else { f64::INFINITY };
        let motion = self.plan.motion_at(at, example);
        Coherent { id: self.claims.next_id(), example, motion, source: Vec2::ZERO, at, reach_m }
    }

    /// Claims ground for a piece that begins.
    pub fn begin(&mut self, piece: &Coherent) {
        let extent = &self.plan.examples[piece.example].extent;
        self.claims.begin(piece, |p| extent.covers(piece.original(p)));
    }

    /// Does growth of `piece` go on at `p`?
    pub fn holds(&mut self, piece: &Coherent, p: Vec2) -> bool {
        let extent = &self.plan.examples[piece.example].extent;
        self.claims.holds(piece, p, |p| extent.covers(piece.original(p)))
    }

    /// Queues a node that has just been made, unless it is to stay as it is.
    pub fn enqueue(&mut self, node: NodeId) {
        let vertex = &self.net.graph.node(node).data;
        if !vertex.outside && !vertex.dead_end {
            self.queue.push_back(Place::Node(node));
        }
    }

    /// The vertex of a copy of the layer's node `own` in `piece`.
    pub fn copy_of(&self, own: usize, piece: Coherent) -> Vertex {
        let node = &self.style(piece.example).layer.nodes[own];
        Vertex {
            // Beyond the example's edge there is nothing to follow.
            link: (node.kind != NodeKind::Cut).then_some(node.example),
            dead_end: node.kind == NodeKind::DeadEnd,
            outside: false,
            piece: Some(piece),
        }
    }

    /// A street copied from an example.
    pub fn copied(&self, street: &Street, example: usize, part: &Arc<str>, batch: u32) -> Piece {
        let mut street = street.clone();
        street.provenance = Provenance {
            origin: Origin::Example,
            source: Some(self.plan.examples[example].character.name.clone()),
            part: Some(part.clone()),
        };
        street.name = None;
        Piece { batch, ..Piece::of(street) }
    }

    /// A street made without a patch.
    pub fn made(&self, street: &Street, origin: Origin) -> Piece {
        let street = Street { provenance: Provenance::of(origin), name: None, ..street.clone() };
        Piece::of(street)
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
        match self.relief.verdict(&probe.line) {
            Verdict::Fine => (),
            Verdict::Wet => {
                self.note_ford(node, &probe.line, &piece.street);
                return None;
            }
            Verdict::Kept => return None,
            Verdict::Steep => return self.lay_bent(node, line, wish, &piece.street),
        }
        let is_whole = probe.landing == Landing::Free && probe.kept > 0.999;
        let landed = polyline::length(&probe.line);
        let whole = probe.line.len() == line.len();
        let stops: Vec<(Vec2, NodeId)> = via
            .iter()
            .filter(|(i, _)| whole || polyline::length(&line[..=*i]) < landed - 12.0)
            .filter_map(|(i, n)| Some((*probe.line.get(*i)?, *n)))
            .collect();
        let coherent = vertex.piece;
        let (to, mut edge) = self.net.commit(node, probe, piece, vertex)?;
        if !self.inside.contains(self.net.graph.node(to).at) {
            self.net.graph.node_mut(to).data.outside = true;
        }
        for (at, link) in stops {
            let at = GridPoint::round(at);
            if let Some(middle) = self.net.split(edge, at) {
                let data = &mut self.net.graph.node_mut(middle).data;
                (data.link, data.piece) = (Some(link), coherent);
                // The rest of the line is the newest edge.
                edge = EdgeId(self.net.graph.edge_bound() as u32 - 1);
            }
        }
        Some(Laid { to, is_whole })
    }

    /// Lays a street that would be too steep along the slope instead. Where it ends nothing of the
    /// example follows, so another patch may begin there.
    fn lay_bent(
        &mut self,
        node: NodeId,
        line: &[Vec2],
        wish: Wish,
        street: &Street,
    ) -> Option<Laid> {
        if wish.to.is_some() || wish.dead_end {
            return None;
        }
        let line = self.relief.along_slope(line);
        if !self.keeps_spacing(node, &line) {
            return None;
        }
        let probe = self.net.probe(node, &line, Wish::free(0))?;
        if self.relief.verdict(&probe.line) != Verdict::Fine {
            return None;
        }
        let is_free = probe.landing == Landing::Free;
        let piece = self.made(street, Origin::Procedural);
        let (to, _) = self.net.commit(node, probe, piece, Vertex::default())?;
        if !self.inside.contains(self.net.graph.node(to).at) {
            self.net.graph.node_mut(to).data.outside = true;
        } else if is_free {
            self.frontier.push_back(Open::Node(to));
        }
        Some(Laid { to, is_whole: false })
    }

    /// A main street that comes to water may cross it later.
    fn note_ford(&mut self, node: NodeId, line: &[Vec2], street: &Street) {
        const STEP_M: f64 = 8.0;
        if !self.is_main {
            return;
        }
        let steps = (polyline::length(line) / STEP_M).ceil() as usize;
        let places = (0..=steps).map(|i| polyline::point_at(line, i as f64 * STEP_M));
        let direction = places.map(|p| (p, p - line[0])).find(|(p, _)| self.relief.is_wet(*p));
        if let Some(direction) = direction.and_then(|(_, d)| d.try_normalize()) {
            self.fords.push(Ford { node, direction, street: street.clone() });
        }
    }

    /// Does a line from a node of the cell's border begin outside the cell, where the cell sees no
    /// streets, or along the border of a part of a city, where both sides would lay one?
    fn leaves_cell(&self, node: NodeId, line: &[Vec2]) -> bool {
        let graph = &self.net.graph;
        let darts = graph.darts(node);
        let on_border = darts.iter().any(|d| graph.edge(d.edge()).data.is_fixed());
        let leaving = polyline::point_at(line, 15.0) - line[0];
        let along_rim = darts.iter().any(|d| {
            graph.edge(d.edge()).data.is_rim()
                && trig::angle_between(graph.direction(*d, 15.0), leaving) < RIM_RAD
        });
        along_rim
            || (on_border && !self.inside.contains(GridPoint::round(polyline::point_at(line, 0.5))))
    }

    /// Does a line keep so far from other streets that no block becomes narrower than the example's?
    /// Towards its ends it may come nearer.
    pub fn keeps_spacing(&self, node: NodeId, line: &[Vec2]) -> bool {
        let n = self.net.graph.node(node);
        let own = n.data.piece.map(|piece| piece.example);
        let example = own.unwrap_or_else(|| self.plan.example_at(n.at.to_m()));
        let spacing_m = SPACING * self.style(example).spacing_m;
        let total = polyline::length(line);
        let count = (total / 12.0).ceil();
        (1..count as usize).all(|i| {
            let along = total * i as f64 / count;
            let wanted = spacing_m.min(0.6 * along.min(total - along));
            self.net.street_near(polyline::point_at(line, along), wanted).is_none()
        })
    }

    /// Is a free place there: nothing in the way on the first metres of this direction?
    pub fn is_open(&self, node: NodeId, direction: Vec2, least_rad: f64) -> bool {
        self.net.streets_at(node).all(|dart| {
            trig::angle_between(self.net.graph.direction(dart, 15.0), direction) >= least_rad
        })
    }
}
