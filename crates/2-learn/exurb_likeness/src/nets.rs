//! Streets by rule: what a scale of likeness must put in order.
//!
//! A part of a city with its nodes moved or some streets removed, and nets of the same street length
//! per area: Poisson-Voronoi streets, a square grid, a jittered grid.

use exurb_city::{Street, StreetGraph, street_graph};
use exurb_geom::voronoi::{self, Site};
use exurb_geom::{Bounds, GridPoint, Vec2, polyline};
use exurb_graph::NodeId;
use exurb_measure::Network;
use exurb_operation::Rng;
use rand::RngExt;
use rand::seq::index;
use rand_distr::{Distribution, Normal, Poisson};

/// Jitter of the grid's nodes by the spacing.
const JITTER: f64 = 0.18;
/// Nets reach this far beyond the window, in metres.
const MARGIN_M: f64 = 400.0;

/// The streets with every node moved by normal noise of this standard deviation along both axes;
/// lines follow their ends. Cut ends stay.
pub fn with_noise(network: &Network, sd_m: f64, rng: &mut Rng) -> StreetGraph {
    let graph = &network.graph;
    let mut moved = vec![Vec2::ZERO; graph.node_bound()];
    for (id, _) in graph.nodes() {
        let by = noise(sd_m, rng);
        if !network.is_cut(id) {
            moved[id.index()] = by;
        }
    }
    let lines = graph.edges().map(|(_, edge)| {
        let line = edge.line_m();
        let total = polyline::length(&line);
        let mut along = 0.0;
        let mut out = Vec::with_capacity(line.len());
        for (i, p) in line.iter().enumerate() {
            along += if i > 0 { line[i - 1].distance(*p) } else { 0.0 };
            let (from, to) = (moved[edge.from.index()], moved[edge.to.index()]);
            out.push(GridPoint::round(*p + from.lerp(to, along / total)));
        }
        (out, edge.data.clone())
    });
    keep_cuts(network, street_graph::from_lines(lines))
}

/// The streets without this share of them, drawn at random.
pub fn with_gaps(network: &Network, share: f64, rng: &mut Rng) -> StreetGraph {
    let mut graph = network.graph.clone();
    let ids: Vec<_> = graph.edges().map(|(id, _)| id).collect();
    let gone = (ids.len() as f64 * share).round() as usize;
    for i in index::sample(rng, ids.len(), gone) {
        graph.remove_edge(ids[i]);
    }
    graph.remove_isolated_nodes();
    graph
}

/// Edges of the Voronoi diagram of a Poisson process, with as much street per area. Such edges are
/// 2 √λ long per area for λ sites (Okabe et al. 2000, *Spatial tessellations*, table 5.5.1).
pub fn voronoi(window: Bounds, m_per_m2: f64, rng: &mut Rng) -> StreetGraph {
    let around = window.grown(MARGIN_M);
    let size = around.size();
    let expected = (m_per_m2 / 2.0) * (m_per_m2 / 2.0) * size.x * size.y;
    let count = Poisson::new(expected).map_or(0.0, |p| p.sample(rng)) as u32;
    let mut at = || around.min + Vec2::new(rng.random::<f64>(), rng.random::<f64>()) * size;
    let sites: Vec<Site> = (0..count).map(|label| Site { at: at(), label }).collect();
    lines(voronoi::borders(&sites, around))
}

/// A square grid with as much street per area, its nodes moved by normal noise of `jitter` times
/// the spacing: 0 for a regular one.
pub fn grid(window: Bounds, m_per_m2: f64, jitter: f64, rng: &mut Rng) -> StreetGraph {
    let spacing_m = 2.0 / m_per_m2;
    let around = window.grown(MARGIN_M);
    let places = (around.size() / spacing_m).ceil();
    let (columns, rows) = (places.x as usize + 1, places.y as usize + 1);
    let nodes: Vec<Vec2> = (0..columns * rows)
        .map(|i| Vec2::new((i % columns) as f64, (i / columns) as f64) * spacing_m)
        .map(|at| around.min + at + noise(jitter * spacing_m, rng))
        .collect();
    let mut out = Vec::new();
    for i in 0..nodes.len() {
        if i % columns + 1 < columns {
            out.push(vec![nodes[i], nodes[i + 1]]);
        }
        if i + columns < nodes.len() {
            out.push(vec![nodes[i], nodes[i + columns]]);
        }
    }
    lines(out)
}

/// [`grid`] with the usual jitter, 18 % of the spacing.
pub fn jittered_grid(window: Bounds, m_per_m2: f64, rng: &mut Rng) -> StreetGraph {
    grid(window, m_per_m2, JITTER, rng)
}

fn noise(sd_m: f64, rng: &mut Rng) -> Vec2 {
    let Ok(normal) = Normal::new(0.0, sd_m) else { return Vec2::ZERO };
    let x = normal.sample(rng);
    Vec2::new(x, normal.sample(rng))
}

fn lines(lines: Vec<Vec<Vec2>>) -> StreetGraph {
    street_graph::from_lines(
        lines.into_iter().map(|line| (polyline::round(&line), Street::default())),
    )
}

/// Marks the ends that were cut before.
fn keep_cuts(network: &Network, mut graph: StreetGraph) -> StreetGraph {
    let mut cuts: Vec<GridPoint> =
        network.graph.nodes().filter(|(_, n)| n.data.cut).map(|(_, n)| n.at).collect();
    cuts.sort_unstable();
    let nodes: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
    for id in nodes {
        if cuts.binary_search(&graph.node(id).at).is_ok() {
            graph.node_mut(id).data.cut = true;
        }
    }
    graph
}
