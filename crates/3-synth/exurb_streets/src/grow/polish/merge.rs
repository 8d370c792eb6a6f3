//! Two junctions of three streets close together become one of four.

use std::collections::BTreeSet;

use exurb_city::street_graph::StreetGraph;
use exurb_geom::{Vec2, polyline, trig};
use exurb_graph::{Dart, EdgeId, NodeId};
use exurb_operation::rng::place_key;

use super::super::relief::Verdict;
use super::profile::legs;
use super::{LEAST_ANGLE_RAD, Polish};

/// Junctions nearer than this may become one, in metres.
const MERGED_M: f64 = 30.0;

impl Polish<'_> {
    /// Streets between two close junctions of three whose side streets lie opposite, the shortest
    /// first, with their middle.
    pub fn pairs(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<(EdgeId, Vec2)> {
        let mut found: Vec<(f64, u64, EdgeId, Vec2)> = Vec::new();
        for (id, edge) in self.streets.edges() {
            let (u, v) = (edge.from, edge.to);
            let length = edge.length_m();
            if length > MERGED_M || u == v || !may_change(self.streets, id) {
                continue;
            }
            let [Some(a), Some(b)] = [id.forward(), id.backward()].map(|d| self.side(d)) else {
                continue;
            };
            let along = (self.streets.node(v).at.to_m() - self.streets.node(u).at.to_m())
                .normalize_or_zero();
            let (a, b) = [a, b].map(|d| self.streets.direction(d, 15.0)).into();
            if a.dot(b) < -0.5 && along.perp_dot(a) * along.perp_dot(b) < 0.0 {
                let middle = polyline::point_at(&edge.line_m(), length / 2.0);
                found.push((length, place_key(edge.line()[0]), id, middle));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        found.into_iter().map(|(_, _, id, middle)| (id, middle)).collect()
    }

    /// The street at the tail of `dart` that turns off it, where three meet and the third goes on.
    fn side(&self, dart: Dart) -> Option<Dart> {
        let node = self.streets.tail(dart);
        let own = self.streets.direction(dart, 15.0);
        let others: Vec<Dart> =
            self.streets.darts(node).iter().copied().filter(|d| d.edge() != dart.edge()).collect();
        let [a, b] = others[..] else { return None };
        let (p, q) = (self.streets.direction(a, 15.0), self.streets.direction(b, 15.0));
        let (through, side, is) = if p.dot(own) < q.dot(own) { (p, q, b) } else { (q, p, a) };
        (through.dot(own) < -0.85 && side.dot(own).abs() < 0.6).then_some(is)
    }

    pub fn merge(
        &mut self,
        id: EdgeId,
        middle: Vec2,
        may_change: &impl Fn(&StreetGraph, EdgeId) -> bool,
    ) {
        let Some(edge) = self.streets.get_edge(id) else { return };
        let ends = [edge.from, edge.to];
        let around: Vec<Dart> = ends
            .iter()
            .flat_map(|n| self.streets.darts(*n).iter().copied())
            .filter(|d| d.edge() != id)
            .collect();
        let far: Vec<NodeId> = around.iter().map(|d| self.streets.head(*d)).collect();
        let distinct: BTreeSet<EdgeId> = around.iter().map(|d| d.edge()).collect();
        if !ends.iter().all(|n| self.is_free(*n))
            || distinct.len() != 4
            || far.iter().any(|n| ends.contains(n))
            || !distinct.iter().all(|e| may_change(self.streets, *e))
        {
            return;
        }
        let lines: Vec<Vec<Vec2>> = around
            .iter()
            .map(|d| {
                let mut line = self.streets.dart_line_m(*d);
                line[0] = middle;
                line
            })
            .collect();
        let leaving: Vec<Vec2> = lines
            .iter()
            .map(|line| (polyline::point_at(line, 15.0) - middle).normalize_or_zero())
            .collect();
        let apart = (0..4).all(|i| {
            (0..i).all(|k| trig::angle_between(leaving[i], leaving[k]) >= LEAST_ANGLE_RAD)
        });
        let own: BTreeSet<EdgeId> = distinct.iter().copied().chain([id]).collect();
        if !apart
            || lines.iter().zip(&far).any(|(line, n)| {
                self.ground.relief.verdict(line) != Verdict::Fine
                    || !self.is_clear(&line[..2], &own, &[*n])
            })
        {
            return;
        }
        let before: Vec<(f64, f64)> = around.iter().map(|d| self.size(d.edge())).collect();
        let streets = &*self.streets;
        let old_legs = ends.map(|n| legs(streets, n, None));
        let (length, chord) = self.size(id);
        let helps = self.helps(|profile| {
            profile.count_line(length, chord, -1.0);
            old_legs.iter().for_each(|legs| profile.count_legs(legs, -1.0));
            profile.count_legs(&leaving, 1.0);
            for ((length, chord), line) in before.iter().zip(&lines) {
                profile.count_line(*length, *chord, -1.0);
                let (new, end) = (polyline::length(line), line[line.len() - 1]);
                profile.count_line(new, middle.distance(end), 1.0);
            }
        });
        if !helps {
            return;
        }
        for edge in &own {
            self.index.remove_line(edge.0, &self.streets.edge(*edge).line_m());
        }
        let Some(node) = self.streets.collapse_edge(id) else { return };
        for dart in self.streets.darts(node).to_vec() {
            let line = self.streets.edge(dart.edge()).line_m();
            self.index.insert_line(dart.edge().0, &line);
        }
    }
}
