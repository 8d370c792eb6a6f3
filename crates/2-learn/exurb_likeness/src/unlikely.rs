//! Where a candidate differs: how unlikely each of its blocks and junctions is under the example.
//!
//! A thing is described by a few figures in units of their spread in the example. Its strangeness is
//! the distance to its fifth-nearest thing of the example; how unlikely it is, the share of the
//! example's own things that are less strange among themselves (a conformal score: of the example's
//! own things a tenth are above 0.9). O(things · things) cheap distances, on rayon's current pool.

use exurb_geom::{Polygon, Vec2, trig};
use exurb_graph::NodeId;
use exurb_measure::block_shapes::{self, BlockShape};
use exurb_measure::{Network, junctions};
use rayon::prelude::*;

/// Strangeness is the distance to so many neighbours of the example.
const NEIGHBOURS: usize = 5;

/// A block of the candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its outline between centrelines.
    pub polygon: Polygon,
    /// 0 = ordinary, 1 = the example has nothing like it. `None` where the example has too few.
    pub unlikely: Option<f64>,
    /// What it is judged by.
    pub shape: BlockShape,
}

/// A junction of the candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    /// Where it is, in metres.
    pub at: Vec2,
    /// 0 = ordinary, 1 = the example has nothing like it. `None` where the example has too few.
    pub unlikely: Option<f64>,
    /// Number of legs.
    pub degree: usize,
    /// Its widest and narrowest angle in degrees.
    pub angles: [f64; 2],
    /// Mean length of its legs in metres.
    pub leg_m: f64,
}

/// The candidate's blocks, judged by those of the example's parts.
pub fn blocks(candidate: &Network, example: &[&Network]) -> Vec<Block> {
    let figures = |b: &BlockShape| [block_shapes::log_area(b), b.phi, b.aspect, b.rectangularity];
    let known: Vec<[f64; 4]> =
        example.iter().flat_map(|n| block_shapes::blocks(n)).map(|b| figures(&b)).collect();
    let own = block_shapes::blocks(candidate);
    let unlikely = judge(&known, &own.iter().map(figures).collect::<Vec<_>>());
    let judged = own.into_iter().zip(unlikely);
    judged
        .map(|(shape, unlikely)| Block { polygon: shape.polygon.clone(), unlikely, shape })
        .collect()
}

/// The candidate's junctions, judged by those of the example's parts.
pub fn junctions(candidate: &Network, example: &[&Network]) -> Vec<Junction> {
    let figures = |j: &Junction| {
        // One leg more or less is as much as a spread.
        [j.degree as f64 * 2.0, j.angles[0], j.angles[1], trig::log10(j.leg_m.max(1.0))]
    };
    let all = |network: &Network| -> Vec<Junction> {
        network.junctions().map(|node| junction(network, node)).collect()
    };
    let known: Vec<[f64; 4]> = example.iter().flat_map(|n| all(n)).map(|j| figures(&j)).collect();
    let own = all(candidate);
    let unlikely = judge(&known, &own.iter().map(figures).collect::<Vec<_>>());
    own.into_iter().zip(unlikely).map(|(j, unlikely)| Junction { unlikely, ..j }).collect()
}

fn junction(network: &Network, node: NodeId) -> Junction {
    let graph = &network.graph;
    let angles = junctions::leg_angles(network, node);
    let darts = graph.darts(node);
    let length: f64 = darts.iter().map(|d| graph.edge(d.edge()).length_m()).sum();
    Junction {
        at: network.at(node),
        unlikely: None,
        degree: darts.len(),
        angles: [
            angles.iter().copied().fold(0.0, f64::max),
            angles.iter().copied().fold(360.0, f64::min),
        ],
        leg_m: length / darts.len() as f64,
    }
}

/// For each of `own` the share of `known` that are less strange.
fn judge<const N: usize>(known: &[[f64; N]], own: &[[f64; N]]) -> Vec<Option<f64>> {
    if known.len() <= NEIGHBOURS {
        return vec![None; own.len()];
    }
    let spreads = spreads(known);
    let unit = |p: &[f64; N]| std::array::from_fn(|i| p[i] / spreads[i]);
    let known: Vec<[f64; N]> = known.iter().map(unit).collect();
    let own: Vec<[f64; N]> = own.iter().map(unit).collect();
    // A known thing is its own nearest neighbour.
    let mut among: Vec<f64> =
        known.par_iter().map(|p| strangeness(p, &known, NEIGHBOURS + 1)).collect();
    among.sort_by(f64::total_cmp);
    let share = |p: &[f64; N]| {
        let less = among.partition_point(|s| *s < strangeness(p, &known, NEIGHBOURS));
        Some(less as f64 / among.len() as f64)
    };
    own.par_iter().map(share).collect()
}

fn spreads<const N: usize>(points: &[[f64; N]]) -> [f64; N] {
    let n = points.len() as f64;
    std::array::from_fn(|i| {
        let mean = points.iter().map(|p| p[i]).sum::<f64>() / n;
        let variance = points.iter().map(|p| (p[i] - mean) * (p[i] - mean)).sum::<f64>() / n;
        variance.sqrt().max(1e-9)
    })
}

/// Distance to the neighbour of that rank.
fn strangeness<const N: usize>(p: &[f64; N], known: &[[f64; N]], rank: usize) -> f64 {
    let mut nearest: Vec<f64> = Vec::with_capacity(rank + 1);
    for q in known {
        let square: f64 = p.iter().zip(q).map(|(a, b)| (a - b) * (a - b)).sum();
        if nearest.len() < rank || nearest.last().is_some_and(|last| square < *last) {
            let at = nearest.partition_point(|s| *s <= square);
            nearest.insert(at, square);
            nearest.truncate(rank);
        }
    }
    nearest.last().copied().unwrap_or(f64::INFINITY).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_example_has_is_ordinary_and_what_it_lacks_is_not() {
        let known: Vec<[f64; 2]> =
            (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)]).collect();
        let found = judge(&known, &[[4.2, 4.0], [40.0, 4.0]]);
        assert!(found[0].unwrap() < 0.5, "{found:?}");
        assert_eq!(found[1], Some(1.0));
        assert_eq!(judge(&known[..3], &[[1.0, 1.0]]), [None]);
    }
}
