//! Growth from statistics, and connecting what nearly meets (Nishida et al. 2015, 4.3.3 and 4.3.4).

use std::f64::consts::{FRAC_PI_2, PI};

use exurb_city::{Class, Origin, Street};
use exurb_geom::{Vec2, trig};
use exurb_graph::NodeId;
use rand::RngExt;
use rand_distr::{Distribution, Normal};

use super::growth::Growth;
use super::network::{Landing, Standing, Vertex, Wish};
use super::relief::Verdict;

/// Pieces of a procedural street.
const STEPS: usize = 5;
/// A new direction keeps at least this from the streets that are there, in radians (60°, the
/// authors' program).
const LEAST_ANGLE_RAD: f64 = PI / 3.0;

/// Connects a vertex to what lies straight ahead of its streets: a node within 0.7 rad, or a street
/// within 0.3 rad, no farther than a mean street length (the authors' program, which tries nodes
/// straight ahead first). Returns whether it did.
pub fn connect(growth: &mut Growth, node: NodeId) -> bool {
    let n = growth.net.graph.node(node);
    let at = n.at.to_m();
    let reach_m = growth.street_m(node).min(250.0);
    let street = street_like(growth, node);
    let ahead: Vec<Vec2> =
        growth.net.streets_at(node).map(|dart| -growth.net.graph.direction(dart, 15.0)).collect();
    for direction in ahead {
        if !growth.is_open(node, direction, LEAST_ANGLE_RAD) {
            continue;
        }
        let mut candidates: Vec<(f64, NodeId)> = growth
            .net
            .nodes_near(at, reach_m)
            .filter(|other| *other != node)
            .filter_map(|other| {
                let o = growth.net.graph.get_node(other)?;
                let d = o.at.to_m() - at;
                let off = trig::angle_between(d, direction);
                let usable = off < 0.7 && !o.data.dead_end && !growth.net.crowded(other);
                // Cost of the authors' program: squared distance and angle.
                usable.then(|| (d.length_squared() + 100.0 * off, other))
            })
            .collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, other) in candidates.into_iter().take(3) {
            let line = [at, growth.net.graph.node(other).at.to_m()];
            let wish = Wish { to: Some(other), ..Wish::free(0) };
            let piece = growth.made(&street, Origin::Joined);
            if growth.lay(node, &line, wish, piece, Vertex::default(), &[]).is_some() {
                return true;
            }
        }
        if lands_ahead(growth, node, at, direction, reach_m, &street) {
            return true;
        }
    }
    false
}

/// Lays a straight street ahead if it meets another within reach.
fn lands_ahead(
    growth: &mut Growth,
    node: NodeId,
    at: Vec2,
    direction: Vec2,
    reach_m: f64,
    street: &Street,
) -> bool {
    for turn in [0.0, 0.15, -0.15, 0.3, -0.3] {
        let line = [at, at + trig::rotate(direction, turn) * reach_m];
        let Some(probe) = growth.net.probe(node, &line, Wish::free(0)) else { continue };
        if matches!(probe.landing, Landing::Edge(..) | Landing::Node(_)) {
            let piece = growth.made(street, Origin::Joined);
            return growth.lay(node, &line, Wish::free(0), piece, Vertex::default(), &[]).is_some();
        }
    }
    false
}

/// Grows streets from statistics so that the corners at `node` come close to right angles.
pub fn expand(growth: &mut Growth, node: NodeId) {
    let first = growth.net.streets_at(node).next();
    let first = match first {
        Some(dart) => growth.net.graph.direction(dart, 15.0),
        None => trig::unit(growth.rng.random_range(0.0..PI)),
    };
    for k in 0..4 {
        let direction = trig::rotate(first, f64::from(k) * FRAC_PI_2);
        if growth.is_open(node, direction, LEAST_ANGLE_RAD) {
            step(growth, node, direction);
        }
    }
}

/// Grows one street from statistics in about that direction, and queues its end.
pub fn step(growth: &mut Growth, node: NodeId, direction: Vec2) {
    let at = growth.net.graph.node(node).at.to_m();
    let statistics = growth.statistics(node);
    let mean_m = growth.street_m(node);
    let length_m = positive_normal(growth, mean_m, statistics.length_variance_m2)
        .clamp(0.5 * mean_m, 2.0 * mean_m)
        .max(30.0);
    let curvature =
        positive_normal(growth, statistics.curvature_mean, statistics.curvature_variance);
    // A street that turns by more than a right angle in one step is a loop, not a street.
    let turn = (curvature * length_m).min(FRAC_PI_2);
    let side = if growth.rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let mut line = vec![at];
    let mut heading = direction;
    for _ in 0..STEPS {
        heading = trig::rotate(heading, side * turn / STEPS as f64);
        line.push(line[line.len() - 1] + heading * (length_m / STEPS as f64));
    }
    if turn < 0.02 {
        line = vec![at, at + direction * length_m];
    }
    let line = match growth.relief.verdict(&line) {
        Verdict::Steep => growth.relief.along_slope(&line),
        Verdict::Fine | Verdict::Wet | Verdict::Kept => line,
    };
    let street = street_like(growth, node);
    let piece = growth.made(&street, Origin::Procedural);
    if let Some(laid) = growth.lay(node, &line, Wish::free(0), piece, Vertex::default(), &[])
        && laid.is_whole
    {
        growth.enqueue(laid.to);
    }
}

/// What a new street at `node` should be: like the ones there, of this layer.
fn street_like(growth: &Growth, node: NodeId) -> Street {
    let is_main = |street: &Street| street.role() == exurb_city::Role::Main;
    let like = growth
        .net
        .graph
        .darts(node)
        .iter()
        .map(|d| &growth.net.graph.edge(d.edge()).data)
        .filter(|p| p.standing != Standing::Rim && p.standing != Standing::Main)
        .filter(|p| is_main(&p.street) == growth.is_main)
        .map(|p| &p.street)
        .min_by_key(|s| s.class);
    match like {
        Some(street) => Street { roundabout: false, oneway: false, ..street.clone() },
        None => {
            let class = if growth.is_main { Class::Tertiary } else { Class::Residential };
            Street { class, ..Street::default() }
        }
    }
}

/// A draw from N(mean, variance), at least 0. The paper's second argument is the variance; since
/// deviations above the mean are common, callers clamp the draw.
fn positive_normal(growth: &mut Growth, mean: f64, variance: f64) -> f64 {
    match Normal::new(mean, variance.max(0.0).sqrt()) {
        Ok(normal) => normal.sample(&mut growth.rng).max(0.0),
        Err(_) => mean.max(0.0),
    }
}
