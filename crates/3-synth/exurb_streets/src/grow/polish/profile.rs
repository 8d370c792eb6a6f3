//! What a network's streets and junctions are like, as counts that an edit changes in place.

use exurb_city::street_graph::StreetGraph;
use exurb_geom::{Vec2, trig};
use exurb_graph::{EdgeId, NodeId};

/// Bins of a family at most.
const BINS: usize = 24;
/// Lengths, each bin a quarter longer than the last.
const LENGTHS: usize = 24;
/// Sixteenths of the root of length over chord less 1.
const BENDS: usize = 16;
/// Degrees 1 to 5 and more.
const DEGREES: usize = 5;
/// Widest angles of junctions of three streets, from 120° in steps of 5°.
const TEES: usize = 13;

/// Counts by family: lengths, bends, degrees, tees.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    counts: [[f64; BINS]; 4],
    length_m: f64,
}

/// How much each criterion counts.
#[derive(Clone, Copy, Debug)]
pub struct Weights {
    /// Lengths of streets.
    pub lengths: f64,
    /// How streets bend.
    pub bends: f64,
    /// Degrees of junctions, and angles of those of three streets.
    pub junctions: f64,
    /// Junctions for each kilometre of streets.
    pub density: f64,
}

impl Profile {
    /// Nothing.
    pub const EMPTY: Self = Self { counts: [[0.0; BINS]; 4], length_m: 0.0 };

    /// The profile of a network whose nodes of degree 2 are dissolved. Ends that are cut count for
    /// nothing. O(streets).
    pub fn of(streets: &StreetGraph) -> Self {
        let mut out = Self::EMPTY;
        for (id, _) in streets.edges() {
            out.count_street(streets, id, 1.0);
        }
        for (id, _) in streets.nodes() {
            out.count_node(streets, id, 1.0);
        }
        out
    }

    /// The mean of several by their shares.
    pub fn mixed<'a>(parts: impl Iterator<Item = (&'a Self, f64)>) -> Self {
        let mut out = Self::EMPTY;
        for (part, share) in parts {
            let share = share / part.length_m.max(1.0);
            for (to, from) in out.counts.iter_mut().flatten().zip(part.counts.iter().flatten()) {
                *to += share * from;
            }
            out.length_m += share * part.length_m;
        }
        out
    }

    /// Adds a street `times` times, which may be negative.
    pub fn count_street(&mut self, streets: &StreetGraph, id: EdgeId, times: f64) {
        let edge = streets.edge(id);
        if [edge.from, edge.to].iter().any(|n| streets.node(*n).data.cut) {
            return;
        }
        let chord = streets.node(edge.from).at.distance_m(streets.node(edge.to).at);
        self.count_line(edge.length_m(), chord, times);
    }

    /// Adds a street of that length and chord.
    pub fn count_line(&mut self, length_m: f64, chord_m: f64, times: f64) {
        // Bins whose bounds grow by a quarter, from 6.3 m.
        let bound = |k: &usize| 6.3 * 1.25_f64.powi(*k as i32 + 1);
        let bin = (0..LENGTHS - 1).find(|k| length_m < bound(k)).unwrap_or(LENGTHS - 1);
        self.counts[0][bin] += times;
        if chord_m > 5.0 {
            let bend = (length_m / chord_m - 1.0).max(0.0).sqrt() * 16.0;
            self.counts[1][(bend as usize).min(BENDS - 1)] += times;
        }
        self.length_m += times * length_m;
    }

    /// Adds a node.
    pub fn count_node(&mut self, streets: &StreetGraph, id: NodeId, times: f64) {
        if streets.node(id).data.cut {
            return;
        }
        let legs = legs(streets, id, None);
        self.count_legs(&legs, times);
    }

    /// Adds a junction whose streets leave in these directions.
    pub fn count_legs(&mut self, legs: &[Vec2], times: f64) {
        if legs.is_empty() || legs.len() == 2 {
            return;
        }
        self.counts[2][(legs.len() - 1).min(DEGREES - 1)] += times;
        if legs.len() == 3 {
            let tee = (widest(legs).to_degrees() - 120.0) / 5.0;
            self.counts[3][(tee.max(0.0) as usize).min(TEES - 1)] += times;
        }
    }

    /// How far this profile is from `wanted`: for ordered families the earth mover's distance in
    /// units of the wanted spread, for degrees the total variation, for density the ratio of
    /// the larger to the smaller less 1.
    pub fn distance(&self, wanted: &Self, weights: &Weights) -> f64 {
        let moved = |family: usize| moved(&self.counts[family], &wanted.counts[family]);
        let degrees = variation(&self.counts[2], &wanted.counts[2]);
        let density = |p: &Self| p.counts[2].iter().sum::<f64>().max(1e-9) / p.length_m.max(1e-9);
        let ratio = density(self) / density(wanted);
        let ratio = ratio.max(1.0 / ratio) - 1.0;
        weights.lengths * moved(0)
            + weights.bends * moved(1)
            + weights.junctions * (4.0 * degrees + moved(3))
            + weights.density * 2.0 * ratio
    }
}

/// Directions in which streets leave a node; of one of them another than it has.
pub fn legs(streets: &StreetGraph, node: NodeId, other: Option<(EdgeId, Vec2)>) -> Vec<Vec2> {
    let direction = |dart: &exurb_graph::Dart| match other {
        Some((id, direction)) if dart.edge() == id => direction,
        _ => streets.direction(*dart, 15.0),
    };
    streets.darts(node).iter().map(direction).collect()
}

/// The widest angle between neighbours of three directions.
fn widest(legs: &[Vec2]) -> f64 {
    let mut angles: Vec<f64> = legs.iter().map(|d| trig::angle(*d)).collect();
    angles.sort_by(f64::total_cmp);
    let turn = std::f64::consts::TAU;
    let gaps = [angles[1] - angles[0], angles[2] - angles[1], turn + angles[0] - angles[2]];
    gaps.into_iter().fold(0.0, f64::max).min(turn / 2.0)
}

fn moved(have: &[f64; BINS], want: &[f64; BINS]) -> f64 {
    let (a, b) = (have.iter().sum::<f64>(), want.iter().sum::<f64>());
    if a <= 0.0 || b <= 0.0 {
        return 0.0;
    }
    let mean = want.iter().enumerate().map(|(i, n)| i as f64 * n).sum::<f64>() / b;
    let square = want.iter().enumerate().map(|(i, n)| (i as f64 - mean).powi(2) * n).sum::<f64>();
    let spread = (square / b).sqrt().max(1.0);
    let (mut behind, mut sum) = (0.0, 0.0);
    for (x, y) in have.iter().zip(want) {
        behind += x / a - y / b;
        sum += f64::abs(behind);
    }
    sum / spread
}

fn variation(have: &[f64; BINS], want: &[f64; BINS]) -> f64 {
    let (a, b) = (have.iter().sum::<f64>().max(1e-9), want.iter().sum::<f64>().max(1e-9));
    have.iter().zip(want).map(|(x, y)| (x / a - y / b).abs()).sum::<f64>() / 2.0
}
