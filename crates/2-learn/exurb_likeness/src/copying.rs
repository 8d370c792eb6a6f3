//! Copying: how much of a city stands in its example, junction for junction.
//!
//! A junction is copied when some junction of the example has the same leg lengths and, once it is
//! turned onto the same leg, nearly all nodes around it fall on nodes of the example. A leg that the
//! window cuts is as long as what is left of it, or longer.

use exurb_geom::{PointIndex, Vec2};
use exurb_graph::NodeId;
use exurb_measure::Network;
use rayon::prelude::*;

/// Legs of the same length differ by less than this, nodes that fall on each other lie within this
/// and this share of their distance from the junction, in metres.
const SAME_M: f64 = 12.0;
const SAME_SHARE: f64 = 0.02;
/// Junctions of this many legs are looked at, with at least so many nodes around.
const LEGS: std::ops::RangeInclusive<usize> = 3..=5;
const FEW_NODES: usize = 6;
/// More than this share of the nodes around must fall on nodes.
const MOST: f64 = 0.9;

/// An example to look for copies of.
#[derive(Debug)]
pub struct Original {
    nodes: PointIndex,
    /// By number of legs, from three.
    junctions: [Vec<Junction>; 3],
}

/// A junction and its legs, counter-clockwise.
#[derive(Clone, Debug)]
struct Junction {
    at: Vec2,
    legs: Vec<Leg>,
}

/// A leg: its length in metres, the way to its other end, and whether the window cuts it there.
#[derive(Clone, Copy, Debug)]
struct Leg {
    length_m: f64,
    chord: Vec2,
    is_cut: bool,
}

impl Original {
    /// Prepares an example.
    pub fn new(example: &Network) -> Self {
        let mut nodes = PointIndex::new(2.0 * SAME_M);
        let mut junctions = [const { Vec::new() }; 3];
        for id in example.ends() {
            nodes.insert(id.0, example.at(id));
        }
        for junction in example.junctions().filter_map(|id| Junction::of(example, id)) {
            junctions[junction.legs.len() - LEGS.start()].push(junction);
        }
        Self { nodes, junctions }
    }

    /// Share of the candidate's junctions of three to five legs, at least `radius_m` from the border
    /// and with at least six nodes within it, that are copied with what lies within. `None` when
    /// there are no such junctions. O(junctions · junctions) cheap tests; on rayon's current pool.
    pub fn copy_rate(&self, candidate: &Network, radius_m: f64) -> Option<f64> {
        let mut places = PointIndex::new(radius_m);
        for id in candidate.ends() {
            places.insert(id.0, candidate.at(id));
        }
        let inner: Vec<NodeId> =
            candidate.junctions().filter(|id| candidate.edge_distance_m(*id) >= radius_m).collect();
        let copied: Vec<Option<bool>> = inner
            .par_iter()
            .map(|id| {
                let junction = Junction::of(candidate, *id)?;
                let around = places.within(junction.at, radius_m);
                let offsets: Vec<Vec2> =
                    around.iter().map(|(n, _)| candidate.at(NodeId(*n)) - junction.at).collect();
                (offsets.len() >= FEW_NODES).then(|| self.holds(&junction, &offsets))
            })
            .collect();
        let looked_at: Vec<bool> = copied.into_iter().flatten().collect();
        let count = looked_at.iter().filter(|c| **c).count();
        (!looked_at.is_empty()).then(|| count as f64 / looked_at.len() as f64)
    }

    fn holds(&self, junction: &Junction, offsets: &[Vec2]) -> bool {
        let n = junction.legs.len();
        self.junctions[n - LEGS.start()].iter().any(|original| {
            (0..n).any(|turn| {
                original.has_legs_of(junction, turn) && {
                    let (from, to) = (junction.legs[0].chord, original.legs[turn].chord);
                    let rotation = to.rotate(Vec2::new(from.x, -from.y)).normalize_or_zero();
                    self.falls_on(original.at, rotation, offsets)
                }
            })
        })
    }

    /// Do the offsets, turned and put around `at`, fall on nodes?
    fn falls_on(&self, at: Vec2, rotation: Vec2, offsets: &[Vec2]) -> bool {
        let may_miss = ((1.0 - MOST) * offsets.len() as f64).ceil() as usize;
        let mut missed = 0;
        offsets.iter().all(|offset| {
            let reach_m = SAME_M + SAME_SHARE * offset.length();
            let hit = self.nodes.nearest(at + rotation.rotate(*offset), reach_m).is_some();
            missed += usize::from(!hit);
            missed < may_miss.max(1)
        })
    }
}

impl Junction {
    fn of(network: &Network, id: NodeId) -> Option<Self> {
        let graph = &network.graph;
        let darts = graph.darts_by_angle(id);
        let at = network.at(id);
        let leg = |d: &exurb_graph::Dart| Leg {
            length_m: graph.edge(d.edge()).length_m(),
            chord: network.at(graph.head(*d)) - at,
            is_cut: network.is_cut(graph.head(*d)),
        };
        let mut legs: Vec<Leg> = darts.iter().map(leg).collect();
        // Junctions are turned onto the first leg, which had better be whole.
        let whole = legs.iter().position(|leg| !leg.is_cut)?;
        legs.rotate_left(whole);
        LEGS.contains(&legs.len()).then_some(Self { at, legs })
    }

    /// Are its legs, from number `turn` on, as long as those of `other`?
    fn has_legs_of(&self, other: &Self, turn: usize) -> bool {
        let n = self.legs.len();
        (0..n).all(|i| {
            let (own, wanted) = (self.legs[(i + turn) % n], other.legs[i]);
            let longer_m = own.length_m - wanted.length_m;
            longer_m.abs() < SAME_M || (wanted.is_cut && longer_m > 0.0)
        })
    }
}
