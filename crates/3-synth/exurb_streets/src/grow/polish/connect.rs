//! A dead end that just misses a street is led on to it.

use std::collections::BTreeSet;

use exurb_city::street_graph::StreetGraph;
use exurb_geom::{Bounds, GridPoint, Vec2, grid, polyline, trig};
use exurb_graph::{Dart, EdgeId, NodeId};
use exurb_operation::rng::place_key;

use super::super::relief::Verdict;
use super::profile::legs;
use super::{LEAST_ANGLE_RAD, Polish};

/// A dead end misses a street by no more than this, in metres.
const MISSED_M: f64 = 60.0;
/// It is led on in its own direction, or turned by one or two of these to either side. Radians.
const TURN_RAD: f64 = 0.35;
/// Nearer to a junction than this, the street ends in the junction. Metres.
const JUNCTION_M: f64 = 15.0;
/// A shorter street is not led back to the street that it comes from: no block would lie between.
/// Metres.
const LOOP_M: f64 = 60.0;

/// Where a dead end is led to.
#[derive(Clone, Copy, Debug)]
struct Goal {
    at: GridPoint,
    /// The street that lies there.
    street: EdgeId,
    /// Its end, if the goal is that.
    junction: Option<NodeId>,
}

impl Polish<'_> {
    /// Dead ends in the target, each as its street leaves it.
    pub fn dead_ends(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<Dart> {
        let mut found: Vec<(u64, Dart)> = Vec::new();
        for (id, node) in self.streets.nodes() {
            let [dart] = self.streets.darts(id) else { continue };
            if self.is_inside(dart.edge())
                && self.is_free(id)
                && may_change(self.streets, dart.edge())
            {
                found.push((place_key(node.at), *dart));
            }
        }
        found.sort_unstable();
        found.into_iter().map(|(_, dart)| dart).collect()
    }

    /// Leads the dead end at the tail of `dart` on to the nearest street ahead.
    pub fn connect(&mut self, dart: Dart, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) {
        if self.streets.get_edge(dart.edge()).is_none() {
            return;
        }
        let end = self.streets.tail(dart);
        if self.streets.degree(end) != 1 || !self.is_free(end) {
            return;
        }
        let mut goals: Vec<Goal> = (-2..=2_i32)
            .filter_map(|turns| self.ahead(dart, f64::from(turns) * TURN_RAD))
            .filter(|goal| self.is_inside(goal.street) && may_change(self.streets, goal.street))
            .collect();
        let from = self.streets.node(end).at;
        goals.sort_by(|a, b| from.distance_m(a.at).total_cmp(&from.distance_m(b.at)));
        for goal in goals {
            if self.lead(dart, goal) {
                return;
            }
        }
    }

    fn is_inside(&self, id: EdgeId) -> bool {
        self.inside.get(id.index()) == Some(&true)
    }

    /// What lies ahead of a dead end in that direction.
    fn ahead(&self, dart: Dart, turn_rad: f64) -> Option<Goal> {
        let end = self.streets.node(self.streets.tail(dart)).at;
        let heading = trig::unit(turn_rad).rotate(-self.streets.direction(dart, 15.0));
        let far = GridPoint::round(end.to_m() + heading * MISSED_M);
        let (a, b) = (end.to_m(), far.to_m());
        let mut best: Option<(f64, EdgeId, Vec2)> = None;
        self.index.visit(Bounds { min: a.min(b), max: a.max(b) }, |e| {
            let (c, d) = (GridPoint::round(e.a), GridPoint::round(e.b));
            let id = EdgeId(e.id);
            if id != dart.edge()
                && self.streets.get_edge(id).is_some()
                && grid::intersects(end, far, c, d)
                && let Some(p) = grid::line_intersection(end, far, c, d)
            {
                let nearer = |(least, other, _): &(f64, EdgeId, Vec2)| {
                    (p.distance(a), id) < (*least, *other)
                };
                if best.as_ref().is_none_or(nearer) {
                    best = Some((p.distance(a), id, p));
                }
            }
            true
        });
        let (_, street, p) = best?;
        let edge = self.streets.edge(street);
        let ends = [edge.from, edge.to].map(|n| (self.streets.node(n).at, n));
        let near = ends.into_iter().find(|(at, _)| at.to_m().distance(p) < JUNCTION_M);
        Some(match near {
            Some((at, node)) => Goal { at, street, junction: Some(node) },
            None => Goal { at: GridPoint::round(p), street, junction: None },
        })
    }

    /// Leads a dead end there, if it is lawful and helps.
    fn lead(&mut self, dart: Dart, goal: Goal) -> bool {
        let streets = &*self.streets;
        let (id, street) = (dart.edge(), goal.street);
        let end = streets.tail(dart);
        let (from, at) = (streets.node(end).at.to_m(), goal.at.to_m());
        let before = streets.dart_line(dart);
        let arriving = (from - at).normalize_or_zero();
        let edge = streets.edge(street);
        let (length, chord) = self.size(id);
        let line = edge.line_m();
        let along = polyline::nearest(&line, at).1;
        // Streets that leave the goal already.
        let (own, others, ends) = match goal.junction {
            Some(node) if node == streets.head(dart) || !self.is_free(node) => return false,
            Some(node) => (BTreeSet::from([id]), legs(streets, node, None), vec![node]),
            None => {
                let leaving = [along - 15.0, along + 15.0]
                    .map(|s| (polyline::point_at(&line, s.max(0.0)) - at).normalize_or_zero());
                (BTreeSet::from([id, street]), leaving.to_vec(), vec![])
            }
        };
        let is_loop = [edge.from, edge.to].contains(&streets.head(dart));
        let meets_itself =
            before.windows(2).any(|w| grid::cross_properly(before[0], goal.at, w[0], w[1]));
        let apart = others.iter().all(|leg| trig::angle_between(*leg, arriving) >= LEAST_ANGLE_RAD);
        if !apart
            || from.distance(at) < 0.5
            || meets_itself
            || (is_loop && length < LOOP_M)
            || self.ground.relief.verdict(&[from, at]) != Verdict::Fine
            || !self.is_clear(&[from, at], &own, &ends)
        {
            return false;
        }
        let far = streets.node(streets.head(dart)).at;
        let longer = (length + from.distance(at), far.distance_m(goal.at));
        let old_end = legs(streets, end, None);
        let mut joined = others.clone();
        joined.push(arriving);
        let split: Option<[(f64, f64); 3]> = goal.junction.is_none().then(|| {
            let whole = self.size(street);
            let part =
                |length: f64, end: NodeId| (length, streets.node(end).at.distance_m(goal.at));
            [whole, part(along, edge.from), part(whole.0 - along, edge.to)]
        });
        let helps = self.helps(|profile| {
            profile.count_line(length, chord, -1.0);
            profile.count_line(longer.0, longer.1, 1.0);
            profile.count_legs(&old_end, -1.0);
            profile.count_legs(&joined, 1.0);
            match split {
                Some([whole, a, b]) => {
                    profile.count_line(whole.0, whole.1, -1.0);
                    profile.count_line(a.0, a.1, 1.0);
                    profile.count_line(b.0, b.1, 1.0);
                }
                None => profile.count_legs(&others, -1.0),
            }
        });
        if helps {
            let mut line = before;
            line.insert(0, goal.at);
            self.join(dart, goal, line);
        }
        helps
    }

    fn join(&mut self, dart: Dart, goal: Goal, mut line: Vec<GridPoint>) {
        let (id, end) = (dart.edge(), self.streets.tail(dart));
        self.index.remove_line(id.0, &self.streets.edge(id).line_m());
        let kept = match goal.junction {
            Some(node) => node,
            None => {
                let old = self.streets.edge(goal.street).line_m();
                let Some((node, a, b)) = self.streets.split_edge(goal.street, goal.at) else {
                    return self.index.insert_line(id.0, &self.streets.edge(id).line_m());
                };
                self.index.remove_line(goal.street.0, &old);
                for part in [a, b] {
                    self.index.insert_line(part.0, &self.streets.edge(part).line_m());
                }
                node
            }
        };
        self.streets.move_node(end, goal.at);
        if !dart.is_forward() {
            line.reverse();
        }
        self.streets.set_line(id, line);
        self.streets.merge_nodes(kept, end);
        let Some(joined) = self.streets.darts(kept).last().map(|d| d.edge()) else { return };
        self.index.insert_line(joined.0, &self.streets.edge(joined).line_m());
    }
}
