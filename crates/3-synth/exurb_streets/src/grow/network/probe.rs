//! Where a line may lie: what it would meet, where it would end, what it would come too near to.

use exurb_geom::{Bounds, GridPoint, Vec2, grid, polyline, trig};
use exurb_graph::{Dart, EdgeId, NodeId};

use super::{CLEARANCE_M, JOIN_M, Network, SHORTEST_M, Standing};

/// Near a shared node clearance is not asked for: corners are judged by their angle.
const CORNER_M: f64 = 16.0;
/// Streets of different origin meet at this angle at least.
const LEAST_ANGLE_RAD: f64 = 0.6;
/// A street that comes to the border of the ground is led to the end of a street of the city around
/// within this.
const GATE_M: f64 = 70.0;

/// Where a line may end.
#[derive(Clone, Debug)]
pub struct Probe {
    /// The line as it would be laid, cut and bent as needed.
    pub line: Vec<Vec2>,
    /// Where it ends.
    pub landing: Landing,
    /// How much of the wanted line is left, 0 to 1.
    pub kept: f64,
}

/// The end of a probed line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Landing {
    /// In the open.
    Free,
    /// At a node that exists.
    Node(NodeId),
    /// On an edge, to be split there.
    Edge(EdgeId, GridPoint),
    /// At the edge of the grown area.
    Rim,
}

/// What a line wants.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    /// Its batch: edges of the same batch do not stand in its way but by crossing. 0 is none.
    pub batch: u32,
    /// It must arrive at this node, whole.
    pub to: Option<NodeId>,
    /// The smallest angle to other streets at both ends.
    pub least_angle_rad: f64,
    /// It ends in the open: where it would meet a street it is cut short of it.
    pub dead_end: bool,
}

impl Wish {
    /// A line of that batch that may be cut short.
    pub fn free(batch: u32) -> Self {
        Self { batch, to: None, least_angle_rad: LEAST_ANGLE_RAD, dead_end: false }
    }
}

struct Contact {
    along_m: f64,
    edge: EdgeId,
    at: Vec2,
}

impl Network {
    /// Finds out how `line`, which begins at node `from`, may be laid. `None` when it may not.
    pub fn probe(&self, from: NodeId, line: &[Vec2], wish: Wish) -> Option<Probe> {
        let wanted = polyline::length(line);
        if wanted < 0.5 || line.len() < 2 {
            return None;
        }
        if self.crowded(from) || !self.angle_fits(from, line, wish) {
            return None;
        }
        let (line, landing) = match wish.to {
            Some(to) => {
                if self.first_contact(from, Some(to), line).is_some() {
                    return None;
                }
                (line.to_vec(), Landing::Node(to))
            }
            None if wish.dead_end => (self.stop_short(from, line)?, Landing::Free),
            None => self.land(from, line)?,
        };
        let length = polyline::length(&line);
        if length < SHORTEST_M && wish.to.is_none() {
            return None;
        }
        if let Landing::Node(to) = landing {
            if to == from && length < 40.0 {
                return None;
            }
            let back: Vec<Vec2> = line.iter().rev().copied().collect();
            if self.crowded(to) || !self.angle_fits(to, &back, wish) {
                return None;
            }
        }
        if let Landing::Edge(edge, at) = landing
            && !self.edge_angle_fits(edge, at, &line, wish.least_angle_rad)
        {
            return None;
        }
        self.is_clear(from, landing, &line, wish.batch).then(|| Probe {
            kept: (length / wanted).min(1.0),
            line,
            landing,
        })
    }

    /// The nearest place within reach of `p` where a street of the city around ends and nothing has
    /// come from this side.
    fn gate_near(&self, p: Vec2) -> Option<NodeId> {
        self.nodes_near(p, GATE_M).find(|node| {
            let mut streets = self.streets_at(*node);
            let is_beyond = |d: Dart| self.graph.edge(d.edge()).data.standing == Standing::Beyond;
            streets.next().is_some_and(is_beyond) && streets.next().is_none()
        })
    }

    /// The smallest angle between the start of `line` and the streets at `node`, in radians. Streets of
    /// `batch` were laid with it: the example answers for their angle.
    pub fn angle_at(&self, node: NodeId, line: &[Vec2], batch: u32) -> f64 {
        let d = (polyline::point_at(line, 15.0) - line[0]).normalize_or_zero();
        self.graph
            .darts(node)
            .iter()
            .filter(|dart| {
                let piece = &self.graph.edge(dart.edge()).data;
                !piece.is_rim() && (batch == 0 || piece.batch != batch)
            })
            .map(|dart| trig::angle_between(self.graph.direction(*dart, 15.0), d))
            .fold(f64::INFINITY, f64::min)
    }

    fn angle_fits(&self, node: NodeId, line: &[Vec2], wish: Wish) -> bool {
        self.angle_at(node, line, wish.batch) >= wish.least_angle_rad
    }

    fn edge_angle_fits(&self, edge: EdgeId, at: GridPoint, line: &[Vec2], least_rad: f64) -> bool {
        let back: Vec<Vec2> = line.iter().rev().copied().collect();
        let d = (polyline::point_at(&back, 15.0) - back[0]).normalize_or_zero();
        let e = self.graph.edge(edge).line_m();
        let (_, along, _) = polyline::nearest(&e, at.to_m());
        let ahead = polyline::point_at(&e, along + 10.0) - polyline::point_at(&e, along);
        let behind = polyline::point_at(&e, along - 10.0) - polyline::point_at(&e, along);
        [ahead, behind].iter().all(|u| trig::angle_between(*u, d) >= least_rad)
    }

    /// The part of `line` that keeps off other streets at its end, if enough is left of it.
    fn stop_short(&self, from: NodeId, line: &[Vec2]) -> Option<Vec<Vec2>> {
        let total = polyline::length(line);
        let mut end = self.first_contact(from, None, line).map_or(total, |c| c.along_m - JOIN_M);
        let touches = |e: EdgeId| {
            let edge = self.graph.edge(e);
            edge.from == from || edge.to == from
        };
        for _ in 0..4 {
            if end < 2.0 * SHORTEST_M {
                return None;
            }
            let tip = polyline::point_at(line, end);
            match self.edge_near(tip, JOIN_M) {
                Some((edge, _)) if !touches(edge) => end -= JOIN_M / 2.0,
                _ => return Some(polyline::part(line, 0.0, end)),
            }
        }
        None
    }

    /// Follows `line` to its first contact, or to its end, and bends it onto what is near there.
    fn land(&self, from: NodeId, line: &[Vec2]) -> Option<(Vec<Vec2>, Landing)> {
        let Some(contact) = self.first_contact(from, None, line) else {
            let tip = line[line.len() - 1];
            if let Some(node) = self.node_near(tip, JOIN_M, Some(from)) {
                return Some((bend(line, self.graph.node(node).at.to_m()), Landing::Node(node)));
            }
            return match self.edge_near(tip, JOIN_M) {
                Some((edge, at)) => self.land_on(from, line, edge, at),
                None => Some((line.to_vec(), Landing::Free)),
            };
        };
        // Blocked from its first point on.
        if contact.along_m < 0.001 {
            return None;
        }
        if self.graph.edge(contact.edge).data.is_rim() {
            let cut = polyline::part(line, 0.0, contact.along_m);
            if let Some(gate) = self.gate_near(contact.at) {
                let bent = bend(&cut, self.graph.node(gate).at.to_m());
                if self.first_contact(from, Some(gate), &bent).is_none() {
                    return Some((bent, Landing::Node(gate)));
                }
            }
            let end = (contact.along_m - 0.1).max(0.0);
            return Some((polyline::part(line, 0.0, end), Landing::Rim));
        }
        // A street that passes close by a node before the contact ends there.
        let cut = polyline::part(line, 0.0, contact.along_m);
        self.land_on(from, &cut, contact.edge, contact.at)
    }

    fn land_on(
        &self,
        from: NodeId,
        line: &[Vec2],
        edge: EdgeId,
        at: Vec2,
    ) -> Option<(Vec<Vec2>, Landing)> {
        let e = self.graph.edge(edge);
        if e.data.is_rim() {
            return None;
        }
        let mut ends = [e.from, e.to].map(|n| (self.graph.node(n).at.to_m().distance(at), n));
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (distance, node) = ends[0];
        if e.data.is_fixed() || distance < JOIN_M {
            if node == from || distance > 2.0 * JOIN_M {
                return None;
            }
            return Some((bend(line, self.graph.node(node).at.to_m()), Landing::Node(node)));
        }
        let at = GridPoint::round(at);
        Some((bend(line, at.to_m()), Landing::Edge(edge, at)))
    }

    /// The first place where `line` crosses or touches a street, not counting its own ends.
    fn first_contact(&self, from: NodeId, to: Option<NodeId>, line: &[Vec2]) -> Option<Contact> {
        let mut start = 0.0;
        let last = line.len() - 2;
        let at_end = |id: EdgeId, node: Option<NodeId>| {
            node.is_some_and(|n| {
                let e = self.graph.edge(id);
                e.from == n || e.to == n
            })
        };
        for (i, w) in line.windows(2).enumerate() {
            let (a, b) = (w[0], w[1]);
            let bounds = Bounds { min: a.min(b), max: a.max(b) }.grown(0.1);
            let mut first: Option<Contact> = None;
            self.segments.visit(bounds, |e| {
                let id = EdgeId(e.id);
                let Some((t, at)) = meet(a, b, e.a, e.b) else { return true };
                let along = start + t * a.distance(b);
                let own_start = i == 0 && along < 0.2 && at_end(id, Some(from));
                let own_end = i == last && (1.0 - t) * a.distance(b) < 0.2 && at_end(id, to);
                if !own_start && !own_end {
                    let better = first
                        .as_ref()
                        .is_none_or(|f| along < f.along_m || (along == f.along_m && id < f.edge));
                    if better {
                        first = Some(Contact { along_m: along, edge: id, at });
                    }
                }
                true
            });
            if first.is_some() {
                return first;
            }
            start += a.distance(b);
        }
        None
    }

    /// Does the line keep its distance from all streets but those of its batch, corners apart, and
    /// cross nothing but where it lands?
    fn is_clear(&self, from: NodeId, landing: Landing, line: &[Vec2], batch: u32) -> bool {
        let total = polyline::length(line);
        let to = if let Landing::Node(n) = landing { Some(n) } else { None };
        let split = if let Landing::Edge(e, _) = landing { Some(e) } else { None };
        let end = line[line.len() - 1];
        let mut start = 0.0;
        for (i, w) in line.windows(2).enumerate() {
            let (a, b) = (w[0], w[1]);
            let length = a.distance(b);
            let bounds = Bounds { min: a.min(b), max: a.max(b) }.grown(CLEARANCE_M);
            let mut clear = true;
            self.segments.visit(bounds, |e| {
                let id = EdgeId(e.id);
                let edge = self.graph.edge(id);
                if edge.data.is_rim() {
                    return true;
                }
                let touches_from = edge.from == from || edge.to == from;
                let touches_to =
                    to.is_some_and(|n| edge.from == n || edge.to == n) || split == Some(id);
                if let Some((t, _)) = meet(a, b, e.a, e.b) {
                    let along = start + t * length;
                    let at_start = touches_from && along < 0.2 && i == 0;
                    let at_end = touches_to && total - along < 0.2;
                    if !at_start && !at_end {
                        clear = false;
                        return false;
                    }
                }
                if batch != 0 && edge.data.batch == batch {
                    return true;
                }
                // The part of this segment that lies outside the corners must keep its distance.
                let lo = if touches_from { CORNER_M - start } else { 0.0 };
                let hi = if touches_to { total - CORNER_M - start } else { length };
                let (lo, hi) = (lo.max(0.0), hi.min(length));
                if lo < hi {
                    let (p, q) = (a.lerp(b, lo / length), a.lerp(b, hi / length));
                    if polyline::segment_distance(p, q, e.a, e.b) < CLEARANCE_M {
                        clear = false;
                        return false;
                    }
                }
                true
            });
            if !clear {
                return false;
            }
            start += length;
        }
        // A free end keeps farther off, so that it is no near miss.
        if landing == Landing::Free {
            let own = |id: EdgeId| {
                let e = self.graph.edge(id);
                e.from == from || e.to == from || batch != 0 && e.data.batch == batch
            };
            let mut clear = true;
            self.segments.visit(Bounds { min: end - JOIN_M, max: end + JOIN_M }, |e| {
                let near =
                    polyline::nearest_on_segment(e.a, e.b, end).0.distance(end) < JOIN_M - 1.0;
                clear &= !near || own(EdgeId(e.id)) || self.graph.edge(EdgeId(e.id)).data.is_rim();
                clear
            });
            return clear;
        }
        true
    }
}

/// Where segments `a b` and `c d` share a point: place along `a b` and the point. Parallel overlaps
/// report their first common end.
fn meet(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> Option<(f64, Vec2)> {
    let (r, s) = (b - a, d - c);
    let cross = r.perp_dot(s);
    if cross != 0.0 {
        let t = (c - a).perp_dot(s) / cross;
        let u = (c - a).perp_dot(r) / cross;
        // A millimetre of margin: rounding must not turn a miss into a crossing.
        let (e, f) = (0.002 / r.length(), 0.002 / s.length());
        return ((-e..=1.0 + e).contains(&t) && (-f..=1.0 + f).contains(&u))
            .then(|| (t.clamp(0.0, 1.0), a + r * t));
    }
    let (a, b, c, d) =
        (GridPoint::round(a), GridPoint::round(b), GridPoint::round(c), GridPoint::round(d));
    let first = [c, d].into_iter().filter(|p| grid::on_segment(a, b, *p)).min_by_key(|p| {
        let (dx, dy) = (i64::from(p.x) - i64::from(a.x), i64::from(p.y) - i64::from(a.y));
        dx * dx + dy * dy
    });
    let p = first.or_else(|| grid::on_segment(c, d, a).then_some(a))?;
    Some((p.distance_m(a) / b.distance_m(a).max(1e-3), p.to_m()))
}

/// Moves the end of `line` to `end`; the shift fades out towards the start, over at most the last
/// 60 m and at least four times its own length where the line has it.
pub fn bend(line: &[Vec2], end: Vec2) -> Vec<Vec2> {
    let total = polyline::length(line);
    let shift = end - line[line.len() - 1];
    if shift.length() < 1e-9 {
        return line.to_vec();
    }
    let reach = (shift.length() * 4.0).max(60.0).min(total).max(1e-6);
    let mut along = 0.0;
    let mut out = vec![line[0]];
    for w in line.windows(2) {
        along += w[0].distance(w[1]);
        let t = ((along - (total - reach)) / reach).clamp(0.0, 1.0);
        out.push(w[1] + shift * t);
    }
    if let Some(last) = out.last_mut() {
        *last = end;
    }
    out
}

#[cfg(test)]
mod tests {
    use exurb_city::Street;

    use super::super::{Piece, Vertex};
    use super::*;

    fn piece(batch: u32) -> Piece {
        Piece { batch, ..Piece::of(Street::default()) }
    }

    fn with_street() -> (Network, NodeId) {
        let mut net = Network::new(100.0);
        let [a, b] = [(-100., 0.), (100., 0.)]
            .map(|(x, y)| net.add_node(GridPoint::m(x, y), Vertex::default()));
        net.add_edge(a, b, vec![], piece(1)).expect("has length");
        let from = net.add_node(GridPoint::m(0., 100.), Vertex::default());
        (net, from)
    }

    #[test]
    fn a_line_that_would_cross_ends_in_a_junction() {
        let (mut net, from) = with_street();
        let line = [Vec2::new(0., 100.), Vec2::new(5., -80.)];
        let probe = net.probe(from, &line, Wish::free(2)).expect("lands");
        assert!(matches!(probe.landing, Landing::Edge(..)), "{probe:?}");
        let (node, _) = net.commit(from, probe, piece(2), Vertex::default()).expect("laid");
        assert_eq!(net.graph.degree(node), 3);
        assert_eq!(net.graph.node(node).at.y, 0);
    }

    #[test]
    fn a_line_that_nearly_arrives_joins() {
        let (net, from) = with_street();
        let probe = net.probe(from, &[Vec2::new(0., 100.), Vec2::new(0., 9.)], Wish::free(2));
        assert!(matches!(probe.expect("lands").landing, Landing::Edge(..)));
    }

    #[test]
    fn parallel_and_acute_lines_are_refused() {
        let (mut net, _) = with_street();
        let from = net.add_node(GridPoint::m(-90., 4.), Vertex::default());
        let beside = [Vec2::new(-90., 4.), Vec2::new(90., 4.5)];
        assert!(net.probe(from, &beside, Wish::free(2)).is_none());
        let far = net.add_node(GridPoint::m(-300., 60.), Vertex::default());
        let acute = [Vec2::new(-300., 60.), Vec2::new(90., -2.)];
        assert!(net.probe(far, &acute, Wish::free(2)).is_none());
    }
}
