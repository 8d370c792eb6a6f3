//! The global finish: local edits that bring a grown network nearer to its example.
//!
//! Growth looks at one place at a time; where pieces meet, streets come out with kinks, junctions in
//! pairs, joints too many. Each edit here is taken only if it brings the profile of the whole network
//! nearer to the example's ([`Profile::distance`]) and breaks no law. Nishida et al. 2015 have no such
//! step and name near misses and small blocks as what is left to do (section 7).
//!
//! | edit | what it does |
//! |---|---|
//! | merge | two junctions of three streets close together become one of four |
//! | remove | a street goes that was made to join others |
//! | straighten | a street with a kink becomes straight |

mod profile;

use std::collections::{BTreeSet, VecDeque};

use exurb_city::street_graph::StreetGraph;
use exurb_city::{Origin, Role};
use exurb_geom::{Bounds, GridPoint, SegmentIndex, Vec2, polyline, trig};
use exurb_graph::{Dart, EdgeId, NodeId};
use exurb_operation::rng::place_key;

use super::ground::Ground;
use super::network::CLEARANCE_M;
use super::relief::Verdict;
use profile::legs;
pub use profile::{Profile, Weights};

/// Junctions nearer than this may become one, in metres.
const MERGED_M: f64 = 30.0;
/// Kinks from this on may go, in radians.
const KINK_RAD: f64 = 0.3;
/// Near a shared node clearance is not asked for, in metres.
const CORNER_M: f64 = 16.0;
/// Streets meet at this angle at least, in radians.
const LEAST_ANGLE_RAD: f64 = 0.6;
/// Places along a street that are looked at, in metres.
const INSIDE_STEP_M: f64 = 15.0;
/// Junctions looked at in search of another way around a street that would go.
const DETOUR: usize = 300;

/// The network that is finished.
struct Polish<'a> {
    streets: &'a mut StreetGraph,
    index: SegmentIndex,
    now: Profile,
    wanted: &'a Profile,
    weights: &'a Weights,
    ground: &'a Ground,
    /// Does the street lie in the target as a whole? By number; later ones do not count.
    inside: Vec<bool>,
    /// Nodes that two streets pass through, which count as one.
    passed: BTreeSet<NodeId>,
}

/// Edits the streets that `may_change` accepts until no edit of the list helps, once over.
/// O(streets · log).
pub fn polish(
    streets: &mut StreetGraph,
    wanted: &Profile,
    weights: &Weights,
    ground: &Ground,
    may_change: impl Fn(&StreetGraph, EdgeId) -> bool,
) {
    let mut index = SegmentIndex::new(50.0);
    for (id, edge) in streets.edges() {
        index.insert_line(id.0, &edge.line_m());
    }
    let now = Profile::of(streets);
    let mut inside = vec![false; streets.edge_bound()];
    for (id, edge) in streets.edges() {
        let places = polyline::resample(&edge.line_m(), INSIDE_STEP_M);
        inside[id.index()] = places.iter().all(|p| ground.target.contains(GridPoint::round(*p)));
    }
    let passed = BTreeSet::new();
    let mut work = Polish { streets, index, now, wanted, weights, ground, inside, passed };
    for (id, middle) in work.pairs(&may_change) {
        work.merge(id, middle, &may_change);
    }
    for id in work.joints(&may_change) {
        work.remove(id);
    }
    for id in work.kinked(&may_change) {
        work.straighten(id);
    }
}

impl Polish<'_> {
    /// Takes the change of profile that `change` makes, if it helps.
    fn helps(&mut self, change: impl Fn(&mut Profile)) -> bool {
        let mut then = self.now.clone();
        change(&mut then);
        let better = then.distance(self.wanted, self.weights)
            < self.now.distance(self.wanted, self.weights) - 1e-9;
        if better {
            self.now = then;
        }
        better
    }

    fn is_free(&self, node: NodeId) -> bool {
        !self.passed.contains(&node) && !self.streets.node(node).data.cut
    }

    /// Streets between two close junctions of three whose side streets lie opposite, the shortest
    /// first, with their middle.
    fn pairs(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<(EdgeId, Vec2)> {
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

    fn merge(
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

    /// Length and chord of a street.
    fn size(&self, id: EdgeId) -> (f64, f64) {
        let edge = self.streets.edge(id);
        let chord = self.streets.node(edge.from).at.distance_m(self.streets.node(edge.to).at);
        (edge.length_m(), chord)
    }

    /// Local streets that were made to join others, between junctions.
    fn joints(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<EdgeId> {
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

    fn remove(&mut self, id: EdgeId) {
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

    /// Streets with a kink, the sharpest first.
    fn kinked(&self, may_change: &impl Fn(&StreetGraph, EdgeId) -> bool) -> Vec<EdgeId> {
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

    fn straighten(&mut self, id: EdgeId) {
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

    /// Does a straight piece keep clear of all streets but `own`, corners at `ends` apart?
    fn is_clear(&self, piece: &[Vec2], own: &BTreeSet<EdgeId>, ends: &[NodeId]) -> bool {
        let (a, b) = (piece[0], piece[1]);
        let length = a.distance(b);
        if length < 1e-6 {
            return true;
        }
        let mut clear = true;
        let bounds = Bounds { min: a.min(b), max: a.max(b) }.grown(CLEARANCE_M);
        self.index.visit(bounds, |e| {
            let id = EdgeId(e.id);
            let Some(edge) = self.streets.get_edge(id) else { return true };
            if own.contains(&id) {
                return true;
            }
            if self.crosses(a, b, e.a, e.b, [edge.from, edge.to], ends) {
                clear = false;
                return false;
            }
            let corner = |p: Vec2| {
                let meets = [edge.from, edge.to].into_iter().filter(|n| ends.contains(n));
                let mut meets = meets.map(|n| self.streets.node(n).at.to_m());
                if meets.any(|at| at.distance(p) < 0.01) { CORNER_M / length } else { 0.0 }
            };
            let (from, to) = (corner(a), 1.0 - corner(b));
            if from < to {
                let (p, q) = (a.lerp(b, from), a.lerp(b, to));
                clear &= polyline::segment_distance(p, q, e.a, e.b) >= CLEARANCE_M;
            }
            clear
        });
        clear
    }

    /// Does the piece `a b` meet the segment `c d` anywhere but at a node that both streets end at?
    fn crosses(
        &self,
        a: Vec2,
        b: Vec2,
        c: Vec2,
        d: Vec2,
        street_ends: [NodeId; 2],
        ends: &[NodeId],
    ) -> bool {
        if polyline::segment_distance(a, b, c, d) > 0.01 {
            return false;
        }
        let shared = street_ends.into_iter().filter(|n| ends.contains(n));
        let mut shared = shared.map(|n| self.streets.node(n).at.to_m());
        !shared.any(|at| {
            // Near the shared node they touch; a little away from it they must not.
            let off = |p: Vec2, q: Vec2| {
                let (near, far) = if p.distance(at) < q.distance(at) { (p, q) } else { (q, p) };
                near + (far - near).normalize_or_zero() * 0.5_f64.min(near.distance(far) / 2.0)
            };
            let far = |p: Vec2, q: Vec2| if p.distance(at) < q.distance(at) { q } else { p };
            let touches = a.distance(at).min(b.distance(at)) < 0.01
                && c.distance(at).min(d.distance(at)) < 0.01;
            touches && polyline::segment_distance(off(a, b), far(a, b), off(c, d), far(c, d)) > 0.05
        })
    }
}

/// The sharpest turn of a line, in radians.
fn kink_rad(line: &[Vec2]) -> f64 {
    let turns = line.windows(3).map(|w| {
        let (before, after) = (w[1] - w[0], w[2] - w[1]);
        if before.length().min(after.length()) < 3.0 {
            return 0.0;
        }
        trig::angle_between(before, after)
    });
    turns.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use exurb_city::{Street, street_graph};

    use super::*;

    const WEIGHTS: Weights = Weights { lengths: 1.0, bends: 1.0, junctions: 1.0, density: 1.0 };

    fn level() -> Ground {
        let corners = (GridPoint::m(-900.0, -900.0), GridPoint::m(900.0, 900.0));
        let target = exurb_geom::Polygon::rectangle(corners.0, corners.1);
        let city = exurb_city::City::empty(exurb_geom::Frame::null_island(), target);
        Ground::open(&city, &city.target, 100.0, &Default::default())
    }

    fn line(points: &[(f64, f64)]) -> (Vec<GridPoint>, Street) {
        (points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), Street::default())
    }

    /// A grid of 4 x 4 blocks of 100 m; every second street from the south begins `off` m farther
    /// east in the north, and streets bend by `bend` m.
    fn grid(off: f64, bend: f64) -> StreetGraph {
        let mut lines = Vec::new();
        let x_of = |column: i32, row: i32| {
            f64::from(column) * 100.0 + if row % 2 == 1 { off } else { 0.0 }
        };
        for row in 0..5 {
            let y = f64::from(row) * 100.0;
            let mut xs: Vec<f64> = vec![-30.0, 450.0];
            xs.extend((0..5).flat_map(|column| [x_of(column, row), x_of(column, row - 1)]));
            xs.sort_by(f64::total_cmp);
            xs.dedup();
            lines.extend(xs.windows(2).map(|w| line(&[(w[0], y), (w[1], y)])));
        }
        for (column, row) in (0..5).flat_map(|c| (0..4).map(move |r| (c, r))) {
            let (x, y) = (x_of(column, row), f64::from(row) * 100.0);
            lines.push(line(&[(x, y), (x + bend, y + 50.0), (x, y + 100.0)]));
        }
        street_graph::from_lines(lines)
    }

    #[test]
    fn offset_junctions_become_crossings_where_the_example_has_crossings() {
        let wanted = Profile::of(&grid(0.0, 0.0));
        let mut streets = grid(18.0, 0.0);
        let before = Profile::of(&streets).distance(&wanted, &WEIGHTS);
        polish(&mut streets, &wanted, &WEIGHTS, &level(), |_, _| true);
        street_graph::dissolve_all(&mut streets);
        let after = Profile::of(&streets).distance(&wanted, &WEIGHTS);
        assert!(after < 0.6 * before, "{before} {after}");
        assert_eq!(exurb_graph::laws::breaches(&streets), []);
        // Where the example itself has pairs, they stay.
        let mut same = grid(18.0, 0.0);
        polish(&mut same, &Profile::of(&grid(18.0, 0.0)), &WEIGHTS, &level(), |_, _| true);
        assert_eq!(same, grid(18.0, 0.0));
    }

    #[test]
    fn kinks_go_where_the_example_has_none() {
        let wanted = Profile::of(&grid(0.0, 0.0));
        let mut streets = grid(0.0, 12.0);
        polish(&mut streets, &wanted, &WEIGHTS, &level(), |_, _| true);
        let bent = |g: &StreetGraph| g.edges().filter(|(_, e)| kink_rad(&e.line_m()) > 0.3).count();
        assert!(bent(&streets) * 2 < bent(&grid(0.0, 12.0)), "{}", bent(&streets));
        let mut kept = grid(0.0, 12.0);
        polish(&mut kept, &wanted, &WEIGHTS, &level(), |_, _| false);
        assert_eq!(kept, grid(0.0, 12.0));
    }
}
