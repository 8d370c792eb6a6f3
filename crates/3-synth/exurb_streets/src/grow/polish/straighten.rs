//! A street with a kink becomes straight.

use std::collections::BTreeSet;

use exurb_city::street_graph::StreetGraph;
use exurb_geom::{Vec2, trig};
use exurb_graph::EdgeId;
use exurb_operation::rng::place_key;

use super::super::relief::Verdict;
use super::profile::legs;
use super::{LEAST_ANGLE_RAD, Polish};

/// Kinks from this on may go, in radians.
const KINK_RAD: f64 = 0.3;

impl Polish<'_> {
    /// Streets with a kink, the sharpest first.
    pub fn kinked(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<EdgeId> {
        let mut found: Vec<(f64, u64, EdgeId)> = self
            .streets
            .edges()
            .filter(|(id, e)| {
                e.line().len() > 2 && !e.data.roundabout && may_change(self.streets, *id)
            })
            .map(|(id, e)| (kink_rad(&e.line_m()), place_key(e.line()[0]), id))
            .filter(|(kink, ..)| *kink >= KINK_RAD)
            .collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        found.into_iter().map(|(_, _, id)| id).collect()
    }

    pub fn straighten(&mut self, id: EdgeId) {
        let Some(edge) = self.streets.get_edge(id) else { return };
        let ends = [edge.from, edge.to];
        let [a, b] = ends.map(|n| self.streets.node(n).at.to_m());
        let length = edge.length_m();
        let chord = a.distance(b);
        if !ends.iter().all(|n| self.is_free(*n)) || chord < 20.0 || length > 1.4 * chord {
            return;
        }
        let ahead = (b - a) / chord;
        let own = BTreeSet::from([id]);
        let turned = [(ends[0], ahead), (ends[1], -ahead)];
        let fits = turned.iter().all(|(n, d)| {
            let others = self.streets.darts(*n).iter().filter(|dart| dart.edge() != id);
            let mut angles =
                others.map(|dart| trig::angle_between(self.streets.direction(*dart, 15.0), *d));
            angles.all(|angle| angle >= LEAST_ANGLE_RAD)
        });
        if !fits
            || self.ground.relief.verdict(&[a, b]) != Verdict::Fine
            || !self.is_clear(&[a, b], &own, &ends)
        {
            return;
        }
        let streets = &*self.streets;
        let old = ends.map(|n| legs(streets, n, None));
        let new = turned.map(|(n, d)| legs(streets, n, Some((id, d))));
        let helps = self.helps(|profile| {
            profile.count_line(length, chord, -1.0);
            profile.count_line(chord, chord, 1.0);
            old.iter().for_each(|legs| profile.count_legs(legs, -1.0));
            new.iter().for_each(|legs| profile.count_legs(legs, 1.0));
        });
        if helps {
            self.index.remove_line(id.0, &self.streets.edge(id).line_m());
            let line = ends.map(|n| self.streets.node(n).at).to_vec();
            self.streets.set_line(id, line);
            self.index.insert_line(id.0, &[a, b]);
        }
    }
}

/// The sharpest turn of a line, in radians.
pub fn kink_rad(line: &[Vec2]) -> f64 {
    let turns = line.windows(3).map(|w| {
        let (before, after) = (w[1] - w[0], w[2] - w[1]);
        if before.length().min(after.length()) < 3.0 {
            return 0.0;
        }
        trig::angle_between(before, after)
    });
    turns.fold(0.0, f64::max)
}
