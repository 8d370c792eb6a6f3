//! A street goes that was made to join others.

use std::collections::{BTreeSet, VecDeque};

use exurb_city::street_graph::StreetGraph;
use exurb_city::{Origin, Role};
use exurb_geom::Vec2;
use exurb_graph::{Dart, EdgeId};
use exurb_operation::rng::place_key;

use super::Polish;
use super::profile::legs;

/// Junctions looked at in search of another way around a street that would go.
const DETOUR: usize = 300;

impl Polish<'_> {
    /// Local streets that were made to join others, between junctions.
    pub fn joints(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<EdgeId> {
        let mut found: Vec<(u64, EdgeId)> = self
            .streets
            .edges()
            .filter(|(_, e)| {
                e.data.provenance.origin == Origin::Joined && e.data.role() == Role::Local
            })
            .filter(|(id, e)| {
                let ends = [e.from, e.to];
                e.from != e.to
                    && ends.iter().all(|n| self.streets.degree(*n) > 2)
                    && may_change(self.streets, *id)
            })
            .map(|(id, e)| (place_key(e.line()[0]), id))
            .collect();
        found.sort_unstable();
        found.into_iter().map(|(_, id)| id).collect()
    }

    pub fn remove(&mut self, id: EdgeId) {
        let Some(edge) = self.streets.get_edge(id) else { return };
        let ends = [edge.from, edge.to];
        if !ends.iter().all(|n| self.is_free(*n) && self.streets.degree(*n) > 2)
            || !self.has_detour(id)
        {
            return;
        }
        let streets = &*self.streets;
        let old = ends.map(|n| legs(streets, n, None));
        let new = ends.map(|n| {
            let left = streets.darts(n).iter().filter(|d| d.edge() != id);
            left.map(|d| streets.direction(*d, 15.0)).collect::<Vec<Vec2>>()
        });
        let (length, chord) = self.size(id);
        // Where two streets are left they become one.
        let joined: Vec<[(f64, f64); 3]> = ends
            .iter()
            .filter(|n| streets.degree(**n) == 3)
            .map(|n| {
                let left: Vec<Dart> =
                    streets.darts(*n).iter().copied().filter(|d| d.edge() != id).collect();
                let [a, b] = [left[0], left[1]].map(|d| self.size(d.edge()));
                let far = [left[0], left[1]].map(|d| streets.node(streets.head(d)).at);
                [a, b, (a.0 + b.0, far[0].distance_m(far[1]))]
            })
            .collect();
        let helps = self.helps(|profile| {
            profile.count_line(length, chord, -1.0);
            old.iter().for_each(|legs| profile.count_legs(legs, -1.0));
            new.iter().for_each(|legs| profile.count_legs(legs, 1.0));
            for [a, b, one] in &joined {
                profile.count_line(a.0, a.1, -1.0);
                profile.count_line(b.0, b.1, -1.0);
                profile.count_line(one.0, one.1, 1.0);
            }
        });
        if helps {
            self.index.remove_line(id.0, &self.streets.edge(id).line_m());
            self.streets.remove_edge(id);
            // Where two streets are left they count as one already.
            let passed = ends.into_iter().filter(|n| self.streets.degree(*n) == 2);
            self.passed.extend(passed);
        }
    }

    /// Is there another way between the ends of a street, and not far?
    fn has_detour(&self, id: EdgeId) -> bool {
        let edge = self.streets.edge(id);
        let mut seen = BTreeSet::from([edge.from]);
        let mut open = VecDeque::from([edge.from]);
        while let Some(node) = open.pop_front() {
            if node == edge.to {
                return true;
            }
            if seen.len() > DETOUR {
                return false;
            }
            let darts = self.streets.darts(node).iter().filter(|d| d.edge() != id);
            // What hangs together beyond the target only falls apart in it.
            let inside = darts.filter(|d| self.inside.get(d.edge().index()) == Some(&true));
            let heads = inside.map(|d| self.streets.head(*d));
            open.extend(heads.filter(|n| seen.insert(*n)));
        }
        false
    }
}
