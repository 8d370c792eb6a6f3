//! Straight skeleton: what a polygon's corners trace while all sides move inwards at one speed.
//!
//! Source: Aichholzer, Aurenhammer, Alberts, Gärtner 1995, *A Novel Type of Skeleton for Polygons*;
//! the wavefront is played event by event. An *edge event* takes a side that has shrunk to nothing,
//! a *split event* cuts the front where a reflex corner runs into a side. Departures: sides that
//! meet head-on leave a ridge at once, so that rectangles and crosses need no perturbation; the
//! next event is found by looking at all of them, O(n) events of O(n·r) each with r reflex corners,
//! which is quick for footprints and blocks and slow beyond some hundred corners. Whatever fails
//! the checks at the end (faces must tile the polygon) is refused rather than returned.

use crate::{Polygon, Vec2, polygon};

/// Lengths and times below this are nothing, in metres.
const EPSILON_M: f64 = 1e-6;
/// Events nearer in time are taken as one moment, at which sides go before corners.
const SAME_MOMENT_M: f64 = 1e-7;
/// Nodes nearer than this become one.
const WELD_M: f64 = 1e-3;

/// A point of the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Where it lies, in metres.
    pub at: Vec2,
    /// When the front passes: the distance from the sides it belongs to, in metres; 0 at corners.
    pub time_m: f64,
}

/// The skeleton as the faces that the sides sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// The polygon's corners, ring by ring, then the nodes inside.
    pub nodes: Vec<Node>,
    /// One face per side, in order of [`Polygon::segments`]: nodes counter-clockwise, beginning
    /// with the side's two corners. Together they tile the polygon.
    pub faces: Vec<Vec<usize>>,
}

impl Skeleton {
    /// The skeleton of a polygon, holes and all; `None` where the polygon is not simple or the
    /// front degenerates.
    pub fn of(polygon: &Polygon) -> Option<Self> {
        let mut front = Front::new(polygon)?;
        front.run()?;
        front.finish(polygon)
    }

    /// The last moment: the largest distance that a point of the polygon has from its sides, as the
    /// skeleton measures it.
    pub fn last_m(&self) -> f64 {
        self.nodes.iter().map(|n| n.time_m).fold(0.0, f64::max)
    }
}

/// A side of the polygon.
#[derive(Clone, Copy)]
struct Side {
    at: Vec2,
    along: Vec2,
    /// Corners at its ends, as nodes.
    nodes: [usize; 2],
}

impl Side {
    /// Unit normal, inwards.
    fn inward(&self) -> Vec2 {
        self.along.perp()
    }
}

/// A stretch of a moving side, and the corner at its start, between the stretch before and it.
#[derive(Clone, Copy)]
struct Stretch {
    side: usize,
    prev: usize,
    next: usize,
    alive: bool,
    corner: Corner,
}

#[derive(Clone, Copy)]
struct Corner {
    /// Node where it was born.
    node: usize,
    at: Vec2,
    born_m: f64,
    velocity: Vec2,
    is_reflex: bool,
    /// Between sides that move against each other: it has no course of its own.
    is_head_on: bool,
}

impl Corner {
    fn at(&self, time_m: f64) -> Vec2 {
        self.at + self.velocity * (time_m - self.born_m)
    }
}

#[derive(Clone, Copy)]
enum Event {
    /// The stretch has shrunk to nothing.
    Edge(usize),
    /// The corner of the first stretch runs into the second stretch.
    Split(usize, usize),
}

struct Front {
    sides: Vec<Side>,
    stretches: Vec<Stretch>,
    nodes: Vec<Node>,
    /// Arcs of the skeleton by the side whose face they bound.
    arcs: Vec<Vec<[usize; 2]>>,
    now_m: f64,
    has_holes: bool,
}

impl Front {
    fn new(polygon: &Polygon) -> Option<Self> {
        let mut front = Self {
            sides: Vec::new(),
            stretches: Vec::new(),
            nodes: Vec::new(),
            arcs: Vec::new(),
            now_m: 0.0,
            has_holes: !polygon.interiors().is_empty(),
        };
        for ring in polygon.rings() {
            let (first, n) = (front.nodes.len(), ring.len());
            for (i, p) in ring.iter().enumerate() {
                let (at, to) = (p.to_m(), ring[(i + 1) % n].to_m());
                let along = (to - at).try_normalize()?;
                front.nodes.push(Node { at, time_m: 0.0 });
                front.sides.push(Side { at, along, nodes: [first + i, first + (i + 1) % n] });
            }
            for i in 0..n {
                let (prev, next) = (first + (i + n - 1) % n, first + (i + 1) % n);
                let corner = front.corner(prev, first + i, first + i);
                if corner.is_head_on {
                    return None;
                }
                let side = first + i;
                front.stretches.push(Stretch { side, prev, next, alive: true, corner });
            }
        }
        front.arcs = vec![Vec::new(); front.sides.len()];
        Some(front)
    }

    /// The corner between two sides that is born now at a node.
    fn corner(&self, before: usize, after: usize, node: usize) -> Corner {
        let (a, b) = (self.sides[before], self.sides[after]);
        let (n, m) = (a.inward(), b.inward());
        let share = 1.0 + n.dot(m);
        let is_head_on = share < 1e-9;
        Corner {
            node,
            at: self.nodes[node].at,
            born_m: self.now_m,
            // Moves 1 along both normals.
            velocity: if is_head_on { Vec2::ZERO } else { (n + m) / share },
            is_reflex: !is_head_on && a.along.perp_dot(b.along) < -1e-9,
            is_head_on,
        }
    }

    fn run(&mut self) -> Option<()> {
        // Each event takes a stretch or adds one at a reflex corner that is then gone.
        for _ in 0..4 * self.sides.len() + 16 {
            let Some((time_m, event)) = self.next_event() else {
                return self.stretches.iter().all(|s| !s.alive).then_some(());
            };
            self.now_m = time_m.max(self.now_m);
            match event {
                Event::Edge(stretch) => {
                    let after = self.stretches[self.stretches[stretch].next].corner;
                    let before = self.stretches[stretch].corner;
                    let at = (before.at(self.now_m) + after.at(self.now_m)) / 2.0;
                    let next = self.collapse(stretch, at);
                    self.settle(next)?;
                }
                Event::Split(stretch, hit) => {
                    let [one, other] = self.split(stretch, hit);
                    self.settle(one)?;
                    self.settle(other)?;
                }
            }
        }
        None
    }

    fn next_event(&self) -> Option<(f64, Event)> {
        let mut best: Option<(f64, Event)> = None;
        let mut offer = |time_m: f64, margin_m: f64, event| {
            if best.as_ref().is_none_or(|(t, _)| time_m < t - margin_m) {
                best = Some((time_m, event));
            }
        };
        for (i, s) in self.alive() {
            if let Some(time_m) = self.edge_event(s) {
                offer(time_m, 0.0, Event::Edge(i));
            }
        }
        for (i, s) in self.alive().filter(|(_, s)| s.corner.is_reflex) {
            for j in self.opposite(i) {
                if let Some(time_m) = self.split_event(s, j) {
                    offer(time_m, SAME_MOMENT_M, Event::Split(i, j));
                }
            }
        }
        best
    }

    fn alive(&self) -> impl Iterator<Item = (usize, &Stretch)> {
        self.stretches.iter().enumerate().filter(|(_, s)| s.alive)
    }

    /// Stretches that the corner of `i` may run into: those of its ring, and of all while holes are
    /// rings of their own.
    fn opposite(&self, i: usize) -> Vec<usize> {
        let prev = self.stretches[i].prev;
        let own = |j: &usize| *j != i && *j != prev;
        if self.has_holes {
            return self.alive().map(|(j, _)| j).filter(own).collect();
        }
        let mut out = Vec::new();
        let mut j = self.stretches[i].next;
        while j != i {
            out.extend(Some(j).filter(own));
            j = self.stretches[j].next;
        }
        out
    }

    /// When a stretch shrinks to nothing.
    fn edge_event(&self, s: &Stretch) -> Option<f64> {
        let (start, end) = (s.corner, self.stretches[s.next].corner);
        let along = self.sides[s.side].along;
        let length_m = (end.at(self.now_m) - start.at(self.now_m)).dot(along);
        let growth = (end.velocity - start.velocity).dot(along);
        if growth >= -1e-12 {
            return None;
        }
        Some(self.now_m + (length_m / -growth).max(0.0))
    }

    /// When the reflex corner of `s` meets stretch `j`.
    fn split_event(&self, s: &Stretch, j: usize) -> Option<f64> {
        let hit = &self.stretches[j];
        let side = self.sides[hit.side];
        let inward = side.inward();
        let gap_m = inward.dot(s.corner.at(self.now_m) - side.at) - self.now_m;
        let closing = 1.0 - inward.dot(s.corner.velocity);
        if closing <= 1e-12 || gap_m < -EPSILON_M {
            return None;
        }
        let time_m = self.now_m + (gap_m / closing).max(0.0);
        let at = s.corner.at(time_m);
        let from_start = (at - hit.corner.at(time_m)).dot(side.along);
        let from_end = (self.stretches[hit.next].corner.at(time_m) - at).dot(side.along);
        (from_start >= -EPSILON_M && from_end >= -EPSILON_M).then_some(time_m)
    }

    fn node(&mut self, at: Vec2) -> usize {
        self.nodes.push(Node { at, time_m: self.now_m });
        self.nodes.len() - 1
    }

    /// The way of the corner at the start of `stretch` ends at `node`.
    fn end_corner(&mut self, stretch: usize, node: usize) {
        let s = self.stretches[stretch];
        let before = self.stretches[s.prev].side;
        self.arc(before, s.side, [s.corner.node, node]);
    }

    fn arc(&mut self, left: usize, right: usize, arc: [usize; 2]) {
        self.arcs[left].push(arc);
        if left != right {
            self.arcs[right].push(arc);
        }
    }

    /// Takes a stretch out at a point; returns the next one, whose corner is new.
    fn collapse(&mut self, stretch: usize, at: Vec2) -> usize {
        let Stretch { prev, next, .. } = self.stretches[stretch];
        let node = self.node(at);
        self.end_corner(stretch, node);
        self.end_corner(next, node);
        self.stretches[stretch].alive = false;
        self.stretches[prev].next = next;
        self.stretches[next].prev = prev;
        let (before, after) = (self.stretches[prev].side, self.stretches[next].side);
        self.stretches[next].corner = self.corner(before, after, node);
        next
    }

    /// Cuts stretch `hit` where the corner of `stretch` has met it; returns the two stretches with
    /// a new corner.
    fn split(&mut self, stretch: usize, hit: usize) -> [usize; 2] {
        let node = self.node(self.stretches[stretch].corner.at(self.now_m));
        self.end_corner(stretch, node);
        let (before, after_hit) = (self.stretches[stretch].prev, self.stretches[hit].next);
        let (side, second) = (self.stretches[hit].side, self.stretches.len());
        let corner = self.corner(self.stretches[before].side, side, node);
        self.stretches.push(Stretch { side, prev: before, next: after_hit, alive: true, corner });
        self.stretches[before].next = second;
        self.stretches[after_hit].prev = second;
        self.stretches[hit].next = stretch;
        self.stretches[stretch].prev = hit;
        self.stretches[stretch].corner = self.corner(side, self.stretches[stretch].side, node);
        [second, stretch]
    }

    /// Closes rings of two stretches and zips up sides that meet head-on, from the new corner of
    /// `stretch`.
    fn settle(&mut self, mut stretch: usize) -> Option<()> {
        while self.stretches[stretch].alive {
            let s = self.stretches[stretch];
            if s.prev == stretch {
                return None;
            }
            if s.prev == s.next {
                self.close(stretch);
                return Some(());
            }
            if !s.corner.is_head_on {
                return Some(());
            }
            // The shorter of the two is used up along the ridge.
            let start = self.stretches[s.prev].corner.at(self.now_m);
            let end = self.stretches[s.next].corner.at(self.now_m);
            let from = s.corner.at;
            stretch = if start.distance(from) <= end.distance(from) {
                self.collapse(s.prev, start)
            } else {
                self.collapse(stretch, end)
            };
        }
        Some(())
    }

    /// Ends a ring of two stretches with a ridge between their corners.
    fn close(&mut self, stretch: usize) {
        let other = self.stretches[stretch].next;
        let ends = [stretch, other].map(|s| {
            let corner = self.stretches[s].corner;
            let at = if corner.is_head_on { corner.at } else { corner.at(self.now_m) };
            let node = self.node(at);
            self.end_corner(s, node);
            node
        });
        self.arc(self.stretches[stretch].side, self.stretches[other].side, ends);
        self.stretches[stretch].alive = false;
        self.stretches[other].alive = false;
    }

    /// Joins arcs to faces and checks them.
    fn finish(self, polygon: &Polygon) -> Option<Skeleton> {
        let weld = self.weld();
        let mut faces = Vec::with_capacity(self.sides.len());
        let mut total_m2 = 0.0;
        for (side, arcs) in self.sides.iter().zip(&self.arcs) {
            let mut face = walk(side.nodes, arcs)?;
            face.iter_mut().for_each(|n| *n = weld[*n]);
            face.dedup();
            while face.len() > 2 && face.first() == face.last() {
                face.pop();
            }
            let points: Vec<Vec2> = face.iter().map(|n| self.nodes[*n].at).collect();
            let area_m2 = area_m2(&points);
            if area_m2 < -1e-3 {
                return None;
            }
            total_m2 += area_m2;
            faces.push(face);
        }
        let expected_m2: f64 = polygon.rings().map(polygon::signed_area_m2).sum();
        let tiles = (total_m2 - expected_m2).abs() <= 1e-4 * expected_m2 + 1e-3;
        tiles.then_some(Skeleton { nodes: self.nodes, faces })
    }

    /// For each node the one it becomes: nodes that an arc of no length joins are one; corners stay.
    fn weld(&self) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.nodes.len()).collect();
        fn root(parent: &[usize], mut n: usize) -> usize {
            while parent[n] != n {
                n = parent[n];
            }
            n
        }
        let corners = self.sides.len();
        for [a, b] in self.arcs.iter().flatten() {
            let (p, q) = (root(&parent, *a), root(&parent, *b));
            let (low, high) = (p.min(q), p.max(q));
            // Two corners of the polygon never become one.
            if high >= corners && self.nodes[*a].at.distance(self.nodes[*b].at) < WELD_M {
                parent[high] = low;
            }
        }
        (0..parent.len()).map(|n| root(&parent, n)).collect()
    }
}

/// The nodes of a face: along its side, then along the arcs back to the start.
fn walk(side: [usize; 2], arcs: &[[usize; 2]]) -> Option<Vec<usize>> {
    let mut used = vec![false; arcs.len()];
    let mut face = vec![side[0], side[1]];
    let mut at = side[1];
    while at != side[0] {
        let next = arcs.iter().enumerate().find(|(i, arc)| !used[*i] && arc.contains(&at));
        let (i, [a, b]) = next?;
        used[i] = true;
        at = if *a == at { *b } else { *a };
        face.push(at);
    }
    face.pop();
    used.into_iter().all(|u| u).then_some(face)
}

fn area_m2(ring: &[Vec2]) -> f64 {
    let Some(first) = ring.first() else { return 0.0 };
    let pairs = ring.windows(2);
    pairs.map(|w| (w[0] - *first).perp_dot(w[1] - *first)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests;
