//! Seams: where streets leave the ground of their piece.
//!
//! A street that leaves its piece waits. When its turn comes and another piece has taken the ground
//! beyond, it is joined with a street of that piece that comes towards it, else it goes on to the first
//! street it meets, else it is given up. Where the ground is free, it goes to its end, and the next
//! piece begins there (Nishida et al. 2015, section 4.3.1).

use exurb_geom::{PointIndex, Vec2, polyline, trig};
use exurb_graph::NodeId;

use super::growth::Growth;
use super::layer::ChainEnd;
use super::network::{Coherent, Landing, Piece, Wish, bend};
use super::placing;

/// Streets that leave their pieces this near to each other may be joined, in metres.
const JOINED_M: f64 = 45.0;
/// They come towards each other: the cosine between their directions is at most this (154°).
const FACING: f64 = -0.9;
/// Steps along a street in search of the place where it leaves its piece, in metres.
const STEP_M: f64 = 10.0;
/// A street that meets nothing on foreign ground goes on by the mean length of a street and at most by
/// this, in metres; it meets others at this angle at least.
const BEYOND_M: f64 = 300.0;
const LEAST_ANGLE_RAD: f64 = 0.7;
/// A street that would end this near to a junction of three ends in it, in metres.
const JUNCTION_M: f64 = 32.0;
/// Two streets make a bend when the cosine between them is above this (145°).
const BEND_COSINE: f64 = -0.82;

/// A street that leaves its piece from a node.
#[derive(Clone, Copy, Debug)]
pub struct Leaving {
    /// The node.
    pub node: NodeId,
    /// The chain as seen from there.
    pub end: ChainEnd,
    /// The piece.
    pub piece: Coherent,
    /// Where it leaves the piece's ground, and in which direction.
    pub exit: Vec2,
    /// See `exit`.
    pub direction: Vec2,
}

/// Streets that wait.
#[derive(Debug)]
pub struct Seams {
    waiting: Vec<Option<Leaving>>,
    exits: PointIndex,
}

impl Seams {
    /// None.
    pub fn new() -> Self {
        Self { waiting: Vec::new(), exits: PointIndex::new(JOINED_M) }
    }

    /// Adds one; returns its number.
    pub fn push(&mut self, leaving: Leaving) -> usize {
        let number = self.waiting.len();
        self.exits.insert(number as u32, leaving.exit);
        self.waiting.push(Some(leaving));
        number
    }

    /// Takes one out.
    pub fn take(&mut self, number: usize) -> Option<Leaving> {
        let leaving = self.waiting[number].take()?;
        self.exits.remove(number as u32, leaving.exit);
        Some(leaving)
    }

    /// Where the street of that number leaves its piece; `None` when it waits no more.
    pub fn exit(&self, number: usize) -> Option<Vec2> {
        self.waiting[number].as_ref().map(|leaving| leaving.exit)
    }

    /// Those that wait within `radius_m` of `p`.
    pub fn near(&self, p: Vec2, radius_m: f64) -> impl Iterator<Item = (usize, &Leaving)> {
        let found = self.exits.within(p, radius_m).into_iter();
        found.filter_map(|(number, _)| {
            let number = number as usize;
            Some((number, self.waiting[number].as_ref()?))
        })
    }
}

/// Lets the street `end` wait that leaves `piece` from `node`.
pub fn wait(growth: &mut Growth, node: NodeId, end: ChainEnd, piece: Coherent) {
    let line = line_of(growth, node, end, &piece);
    let total = polyline::length(&line);
    let mut along = 0.0;
    while along < total && growth.is_own(&piece, polyline::point_at(&line, along)) {
        along += STEP_M;
    }
    let exit = polyline::point_at(&line, along.min(total));
    let before = polyline::point_at(&line, (along - 2.0 * STEP_M).max(0.0));
    let direction = (exit - before).normalize_or(Vec2::X);
    growth.let_wait(Leaving { node, end, piece, exit, direction });
}

fn line_of(growth: &Growth, node: NodeId, end: ChainEnd, piece: &Coherent) -> Vec<Vec2> {
    let line = growth.style(piece.example).layer.line(end);
    piece.motion.lay(&line, line[0], growth.net.graph.node(node).at.to_m())
}

/// Lays a street that has waited.
pub fn leave(growth: &mut Growth, leaving: Leaving) {
    if growth.net.graph.get_node(leaving.node).is_none() {
        return;
    }
    let is_foreign =
        growth.claims.owner(leaving.exit).is_some_and(|owner| owner != leaving.piece.id);
    if is_foreign {
        if !join(growth, &leaving) {
            go_on(growth, &leaving);
        }
        return;
    }
    let Leaving { node, end, piece, .. } = leaving;
    let batch = growth.next_batch();
    if let Some(laid) = placing::connector(growth, node, end, piece, batch)
        && laid.is_whole
        && !growth.net.graph.node(laid.to).data.outside
    {
        growth.break_off(laid.to);
    }
}

/// Joins a street with one of another piece that comes towards it.
fn join(growth: &mut Growth, leaving: &Leaving) -> bool {
    let mut facing: Vec<(f64, usize, Leaving)> = growth
        .seams
        .near(leaving.exit, JOINED_M)
        .filter(|(_, other)| other.piece.id != leaving.piece.id && other.node != leaving.node)
        .filter(|(_, other)| other.direction.dot(leaving.direction) < FACING)
        .map(|(number, other)| {
            let between = other.exit - leaving.exit;
            let offset = between.perp_dot(leaving.direction).abs();
            (offset + 0.2 * between.length(), number, *other)
        })
        .collect();
    facing.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (_, number, other) in facing {
        let Some(line) = joined_line(growth, leaving, &other) else { continue };
        let layer = &growth.style(leaving.piece.example).layer;
        let street = &layer.chains[leaving.end.chain].street;
        let part = placing::part_of(growth, leaving.end, leaving.piece.example);
        let street = growth.copied(street, leaving.piece.example, &part, 0);
        let wish = Wish { to: Some(other.node), ..Wish::free(0) };
        if growth.lay(leaving.node, &line, wish, street, Default::default(), &[]).is_some() {
            growth.seams.take(number);
            return true;
        }
    }
    false
}

/// The one street up to where it meets the other, then that back; both are bent a little to meet.
fn joined_line(growth: &Growth, one: &Leaving, other: &Leaving) -> Option<Vec<Vec2>> {
    let ahead = (other.exit - one.exit).dot(one.direction);
    // Streets that pass by each other are cut back.
    let back_m = (-ahead / 2.0).max(0.0);
    let cut = |leaving: &Leaving| {
        let line = line_of(growth, leaving.node, leaving.end, &leaving.piece);
        let (_, along, _) = polyline::nearest(&line, leaving.exit);
        polyline::part(&line, 0.0, (along - back_m).max(1.0))
    };
    let (first, second) = (cut(one), cut(other));
    let meeting = first.last()?.midpoint(*second.last()?);
    let mut line = bend(&first, meeting);
    line.pop();
    line.extend(bend(&second, meeting).into_iter().rev());
    Some(line)
}

/// Leads a street on to the first one it meets on foreign ground, straight ahead or a little to a side:
/// to a junction there, where one is near, else to the street.
fn go_on(growth: &mut Growth, leaving: &Leaving) {
    let line = line_of(growth, leaving.node, leaving.end, &leaving.piece);
    let (last, before) = (line[line.len() - 1], line[line.len() - 2]);
    let ahead = (last - before).normalize_or_zero() * growth.street_m(leaving.node).min(BEYOND_M);
    let wish = Wish { least_angle_rad: LEAST_ANGLE_RAD, ..Wish::free(0) };
    // Without this street there would be a bend where the example has a junction.
    let is_needed = leaves_bend(growth, leaving.node);
    for turn in [0.0, 0.15, -0.15, 0.3, -0.3, 0.5, -0.5] {
        let mut line = line.clone();
        line.push(last + trig::rotate(ahead, turn));
        let Some(probe) = growth.net.probe(leaving.node, &line, wish) else { continue };
        if probe.landing == Landing::Free
            || !is_needed && !growth.keeps_spacing(leaving.node, &probe.line)
        {
            continue;
        }
        let layer = &growth.style(leaving.piece.example).layer;
        let street = &layer.chains[leaving.end.chain].street;
        let part = placing::part_of(growth, leaving.end, leaving.piece.example);
        let street = growth.copied(street, leaving.piece.example, &part, 0);
        if let Landing::Edge(..) = probe.landing
            && to_junction(growth, leaving.node, &probe.line, wish, &street)
        {
            return;
        }
        growth.lay(leaving.node, &line, wish, street, Default::default(), &[]);
        return;
    }
}

/// Would the node be a bend of one street, or an end, as it is?
fn leaves_bend(growth: &Growth, node: NodeId) -> bool {
    match growth.net.graph.darts(node) {
        [] | [_] => true,
        [a, b] => {
            let [u, v] = [a, b].map(|d| growth.net.graph.direction(*d, 15.0));
            u.dot(v) > BEND_COSINE
        }
        _ => false,
    }
}

/// Leads a line that would end on a street to a junction of three streets nearby instead.
fn to_junction(
    growth: &mut Growth,
    from: NodeId,
    line: &[Vec2],
    wish: Wish,
    street: &Piece,
) -> bool {
    let end = line[line.len() - 1];
    let near: Vec<NodeId> = growth.net.nodes_near(end, JUNCTION_M).collect();
    near.into_iter().filter(|n| *n != from).any(|node| {
        growth.net.graph.degree(node) == 3 && {
            let bent = bend(line, growth.net.graph.node(node).at.to_m());
            let wish = Wish { to: Some(node), ..wish };
            growth.lay(from, &bent, wish, street.clone(), Default::default(), &[]).is_some()
        }
    })
}
