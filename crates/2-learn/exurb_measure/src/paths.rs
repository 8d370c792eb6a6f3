//! Measures along shortest paths: reach, detour, betweenness.
//!
//! From up to 300 nodes away from the border, drawn at random. O(sources · streets near · log).
//! Runs on rayon's current pool; the result does not depend on the number of threads.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use exurb_geom::trig;
use exurb_graph::NodeId;
use exurb_operation::Rng;
use rand::seq::index;
use rayon::prelude::*;

use crate::{Network, Sample};

/// Sources drawn.
const SOURCES: usize = 300;
/// Sources lie at least this far from the border, in metres, or this share of the shorter side.
const MARGIN_M: f64 = 500.0;
const MARGIN_SHARE: f64 = 0.2;
/// Reach is counted within this network distance, in metres.
const REACH_M: f64 = 500.0;
/// Bands of straight distances of detours, in metres.
const BANDS_M: [(f64, f64); 2] = [(150.0, 500.0), (500.0, 1200.0)];
/// A detour is at most this.
const MOST_DETOUR: f64 = 4.0;
/// What cannot be reached within this network distance counts as this far, in metres.
const FAR_M: f64 = 2500.0;
/// Betweenness counts shortest paths up to this length, in metres, at junctions this far from the
/// border.
const LOCAL_M: f64 = 1000.0;
const BETWEEN_MARGIN_M: f64 = 250.0;

/// What is measured along shortest paths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Paths {
    /// Kilometres of street within 500 m on the network.
    pub reach: Sample,
    /// Network distance over straight distance, at most 4, of pairs 150 to 500 m and 500 to 1200 m
    /// apart.
    pub detour: [Sample; 2],
    /// ln(1 + b / mean b) of junctions, b the number of shortest paths of up to 1 km from the
    /// sources that lead through, shared among equal ones.
    pub betweenness: Sample,
}

/// Measures along shortest paths: reach and betweenness from junctions, detours from all nodes,
/// dead ends among them, drawn at random.
pub fn paths(network: &Network, rng: &mut Rng) -> Paths {
    let roads = Roads::of(network);
    let around =
        from_each(&roads, &sources(network, network.junctions(), rng), |search, source| {
            search.run(source.0, LOCAL_M, std::iter::empty());
            (search.length_within(REACH_M) / 1000.0, search.paths_through(LOCAL_M))
        });
    let targets: Vec<NodeId> = network.ends().collect();
    let detours = from_each(&roads, &sources(network, network.ends(), rng), |search, source| {
        detours(network, search, source, &targets)
    });
    let detour = |band: usize| {
        Sample::plain(detours.iter().flat_map(|from: &[Vec<f64>; 2]| from[band].iter().copied()))
    };
    Paths {
        reach: Sample::plain(around.iter().map(|(reach_km, _)| *reach_km)),
        detour: [detour(0), detour(1)],
        betweenness: betweenness(network, around.iter().map(|(_, through)| &through[..])),
    }
}

/// What is found from every source, in their order.
fn from_each<T: Send>(
    roads: &Roads,
    sources: &[NodeId],
    find: impl Fn(&mut Search, NodeId) -> T + Sync,
) -> Vec<T> {
    let sources = sources.par_iter();
    sources.map_init(|| Search::new(roads), |search, source| find(search, *source)).collect()
}

/// Up to 300 of these nodes, away from the border.
fn sources(network: &Network, nodes: impl Iterator<Item = NodeId>, rng: &mut Rng) -> Vec<NodeId> {
    let margin_m = MARGIN_M.min(MARGIN_SHARE * network.window.size().min_element());
    let inner = |n: &NodeId| network.edge_distance_m(*n) >= margin_m;
    let candidates: Vec<NodeId> = nodes.filter(inner).collect();
    let mut drawn = index::sample(rng, candidates.len(), SOURCES.min(candidates.len())).into_vec();
    drawn.sort_unstable();
    drawn.into_iter().map(|i| candidates[i]).collect()
}

/// Network over straight distance to the targets in both bands.
fn detours(
    network: &Network,
    search: &mut Search,
    source: NodeId,
    targets: &[NodeId],
) -> [Vec<f64>; 2] {
    let from = network.at(source);
    let mut near = Vec::new();
    for target in targets.iter().filter(|t| **t != source) {
        let straight_m = from.distance(network.at(*target));
        let band = BANDS_M.iter().position(|(lo, hi)| *lo <= straight_m && straight_m < *hi);
        near.extend(band.map(|band| (*target, band, straight_m)));
    }
    search.run(source.0, FAR_M, near.iter().map(|(t, ..)| t.0));
    let mut detours = [Vec::new(), Vec::new()];
    for (target, band, straight_m) in near {
        let along_m = search.distance_m(target.0).unwrap_or(FAR_M);
        detours[band].push((along_m / straight_m).min(MOST_DETOUR));
    }
    detours
}

fn betweenness<'a>(network: &Network, through: impl Iterator<Item = &'a [(u32, f64)]>) -> Sample {
    let mut sums = vec![0.0; network.graph.node_bound()];
    for (node, share) in through.flatten() {
        sums[*node as usize] += share;
    }
    let inner = |n: &NodeId| network.edge_distance_m(*n) > BETWEEN_MARGIN_M;
    let own: Vec<f64> = network.junctions().filter(inner).map(|n| sums[n.index()]).collect();
    let mean = own.iter().sum::<f64>() / own.len() as f64;
    if mean > 0.0 {
        Sample::plain(own.into_iter().map(|b| trig::ln(1.0 + b / mean)))
    } else {
        Sample::default()
    }
}

/// The network as lists of neighbours.
struct Roads {
    /// Where each node's neighbours begin in `heads`.
    starts: Vec<u32>,
    heads: Vec<(u32, f64)>,
}

impl Roads {
    fn of(network: &Network) -> Self {
        let graph = &network.graph;
        let lengths: Vec<f64> = (0..graph.edge_bound() as u32)
            .map(|id| graph.get_edge(exurb_graph::EdgeId(id)).map_or(0.0, |e| e.length_m()))
            .collect();
        let (mut starts, mut heads) = (vec![0], Vec::new());
        for node in 0..graph.node_bound() as u32 {
            if graph.get_node(NodeId(node)).is_some() {
                let darts = graph.darts(NodeId(node)).iter();
                heads.extend(darts.map(|d| (graph.head(*d).0, lengths[d.edge().index()])));
            }
            starts.push(heads.len() as u32);
        }
        Self { starts, heads }
    }

    fn from(&self, node: u32) -> &[(u32, f64)] {
        let node = node as usize;
        &self.heads[self.starts[node] as usize..self.starts[node + 1] as usize]
    }
}

/// Dijkstra's search with room that is used again.
struct Search<'a> {
    roads: &'a Roads,
    distance_m: Vec<f64>,
    settled: Vec<bool>,
    wanted: Vec<bool>,
    /// Settled nodes, nearest first.
    order: Vec<u32>,
    touched: Vec<u32>,
}

impl<'a> Search<'a> {
    fn new(roads: &'a Roads) -> Self {
        let n = roads.starts.len() - 1;
        Self {
            roads,
            distance_m: vec![f64::INFINITY; n],
            settled: vec![false; n],
            wanted: vec![false; n],
            order: Vec::new(),
            touched: Vec::new(),
        }
    }

    /// Settles all nodes within `LOCAL_M`, and further ones up to `most_m` until all `wanted` are.
    fn run(&mut self, source: u32, most_m: f64, wanted: impl Iterator<Item = u32>) {
        self.clear();
        let mut left = 0;
        for node in wanted {
            self.wanted[node as usize] = true;
            self.touched.push(node);
            left += 1;
        }
        let mut open = BinaryHeap::new();
        self.reach(source, 0.0, &mut open);
        while let Some(Reverse((Metres(at_m), node))) = open.pop() {
            if at_m > most_m || (left == 0 && at_m > LOCAL_M) {
                break;
            }
            if std::mem::replace(&mut self.settled[node as usize], true) {
                continue;
            }
            self.order.push(node);
            left -= usize::from(self.wanted[node as usize]);
            for (head, length_m) in self.roads.from(node) {
                self.reach(*head, at_m + length_m, &mut open);
            }
        }
    }

    fn clear(&mut self) {
        for node in self.touched.drain(..) {
            self.distance_m[node as usize] = f64::INFINITY;
            self.settled[node as usize] = false;
            self.wanted[node as usize] = false;
        }
        self.order.clear();
    }

    fn reach(&mut self, node: u32, at_m: f64, open: &mut BinaryHeap<Reverse<(Metres, u32)>>) {
        if at_m < self.distance_m[node as usize] {
            self.distance_m[node as usize] = at_m;
            self.touched.push(node);
            open.push(Reverse((Metres(at_m), node)));
        }
    }

    fn distance_m(&self, node: u32) -> Option<f64> {
        self.settled[node as usize].then(|| self.distance_m[node as usize])
    }

    /// Metres of street within `most_m` of the source; of a street with both ends in reach, what
    /// either end reaches of it, at most all of it.
    fn length_within(&self, most_m: f64) -> f64 {
        let left = |node: u32| (most_m - self.distance_m[node as usize]).max(0.0);
        let mut sum = 0.0;
        for node in self.order.iter().filter(|n| left(**n) > 0.0) {
            for (head, length_m) in self.roads.from(*node) {
                let (here, there) = (left(*node), left(*head));
                let covered = (here + there).min(*length_m);
                // A street with both ends in reach is seen from both.
                sum += if there > 0.0 { covered / 2.0 } else { covered };
            }
        }
        sum
    }

    /// How many of the source's shortest paths up to `most_m` lead through each node, equal ones
    /// shared (Brandes 2001, *A faster algorithm for betweenness centrality*).
    fn paths_through(&self, most_m: f64) -> Vec<(u32, f64)> {
        let near = self.order.partition_point(|n| self.distance_m[*n as usize] <= most_m);
        let order = &self.order[..near];
        let place: std::collections::BTreeMap<u32, usize> =
            order.iter().enumerate().map(|(i, n)| (*n, i)).collect();
        let mut before: Vec<Vec<usize>> = vec![Vec::new(); order.len()];
        let mut count = vec![0.0; order.len()];
        for (i, node) in order.iter().enumerate() {
            for (neighbour, length_m) in self.roads.from(*node) {
                if let Some(j) = place.get(neighbour).copied()
                    && j < i
                    && self.distance_m[*neighbour as usize] + length_m
                        == self.distance_m[*node as usize]
                {
                    before[i].push(j);
                    count[i] += count[j];
                }
            }
            if i == 0 {
                count[0] = 1.0;
            }
        }
        let mut share = vec![0.0; order.len()];
        for i in (1..order.len()).rev() {
            for j in &before[i] {
                share[*j] += count[*j] / count[i] * (1.0 + share[i]);
            }
        }
        order.iter().copied().zip(share).skip(1).collect()
    }
}

/// A distance with the order of numbers; never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Metres(f64);

impl Eq for Metres {}

impl PartialOrd for Metres {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Metres {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
