//! Junctions: how many streets meet, at which angles. O(n log n).

use exurb_geom::trig;
use exurb_graph::NodeId;

use crate::{Network, Sample};

/// Directions of legs are taken over this much of them, in metres.
const LEG_M: f64 = 15.0;

/// Number of nodes by degree: 1, 2, 3, 4, 5 and more. Cut ends are left out.
pub fn degrees(network: &Network) -> [usize; 5] {
    let mut counts = [0; 5];
    for node in network.ends() {
        counts[network.graph.degree(node).clamp(1, 5) - 1] += 1;
    }
    counts
}

/// Angles between neighbouring legs of all junctions, in degrees.
pub fn angles(network: &Network) -> Sample {
    Sample::plain(network.junctions().flat_map(|node| leg_angles(network, node)))
}

/// The widest angle of every junction of three legs, in degrees: 180 = T, 120 = Y.
pub fn tee_angles(network: &Network) -> Sample {
    let tees = network.junctions().filter(|node| network.graph.degree(*node) == 3);
    Sample::plain(tees.map(|node| leg_angles(network, node).into_iter().fold(0.0, f64::max)))
}

/// Angles between the legs of one node, counter-clockwise, in degrees; they add up to 360.
pub fn leg_angles(network: &Network, node: NodeId) -> Vec<f64> {
    let graph = &network.graph;
    let direction = |d| trig::angle(graph.direction(d, LEG_M)).to_degrees();
    let mut legs: Vec<f64> = graph.darts(node).iter().map(|d| direction(*d)).collect();
    legs.sort_by(f64::total_cmp);
    let Some(first) = legs.first().copied() else { return Vec::new() };
    legs.push(first + 360.0);
    legs.windows(2).map(|w| w[1] - w[0]).collect()
}
