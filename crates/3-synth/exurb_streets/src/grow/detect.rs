//! Detectors: small functions from a layer to groups of nodes that must stay together.

use exurb_geom::{Bounds, GridPoint, PointIndex, Polygon, SegmentIndex, Vec2, polyline};

use super::layer::Layer;

/// Samples along streets are this far apart.
const STEP_M: f64 = 10.0;
/// Cells of the vote for centres, and the width of the ring a street must keep to.
const CELL_M: f64 = 8.0;
/// Share of a chain's samples that lie on the ring (the authors' program).
const ON_RING: f64 = 0.8;
/// Share of the circle that streets must cover (the authors' program).
const COVERED: f64 = 0.7;
/// Circles smaller than this are junctions.
const LEAST_RADIUS_M: f64 = 12.0;

/// Circles of streets up to `most_m` in radius: plazas, roundabouts, ring roads.
///
/// Source: Nishida et al. 2015, section 4.1 (Hough transform). We vote with the streets themselves,
/// not with pixels: the normals at two samples of one chain a quarter to half a turn apart meet in
/// the centre. A chain belongs to a circle when four fifths of its samples lie within a tenth of
/// the radius (8 m at least, 20 m at most) of it; a circle counts when its chains cover 0.7 of it.
/// O(samples · votes per sample).
pub fn circles(layer: &Layer, most_m: f64) -> Vec<Vec<usize>> {
    let mut votes: Vec<(Vec2, f64)> = Vec::new();
    let samples: Vec<Vec<Vec2>> =
        layer.chains.iter().map(|c| polyline::resample(&c.line, STEP_M)).collect();
    for chain in &samples {
        vote(chain, most_m, &mut votes);
    }
    let mut index = PointIndex::new(CELL_M * 2.0);
    for (i, (center, _)) in votes.iter().enumerate() {
        index.insert(i as u32, *center);
    }
    let mut chain_index = SegmentIndex::new(100.0);
    for (number, chain) in layer.chains.iter().enumerate() {
        chain_index.insert_line(number as u32, &chain.line);
    }
    // Centres by number of votes of like radius nearby.
    let mut ranked: Vec<(usize, usize)> = (0..votes.len())
        .map(|i| {
            let (center, radius) = votes[i];
            let like = index
                .within(center, CELL_M)
                .into_iter()
                .filter(|(j, _)| (votes[*j as usize].1 - radius).abs() < CELL_M)
                .count();
            (like, i)
        })
        .collect();
    ranked.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));

    let mut taken = vec![false; layer.chains.len()];
    let mut tried: Vec<(Vec2, f64)> = Vec::new();
    let mut groups = Vec::new();
    for (_, i) in ranked.into_iter().take(2000) {
        let (center, radius) = votes[i];
        let near =
            |(c, r): &(Vec2, f64)| c.distance(center) < CELL_M && (r - radius).abs() < CELL_M;
        if tried.iter().any(near) {
            continue;
        }
        tried.push((center, radius));
        let tolerance_m = (radius * 0.1).clamp(CELL_M, 20.0);
        let reach = Vec2::splat(radius + tolerance_m);
        let ring = Bounds { min: center - reach, max: center + reach };
        let on_ring = |chain: &usize| {
            let points = &samples[*chain];
            let near = |p: &&Vec2| (p.distance(center) - radius).abs() < tolerance_m;
            points.iter().filter(near).count() as f64 >= ON_RING * points.len() as f64
        };
        let mut chains: Vec<usize> = Vec::new();
        chain_index.visit(ring, |e| {
            chains.push(e.id as usize);
            true
        });
        chains.sort_unstable();
        chains.dedup();
        chains.retain(|c| !taken[*c] && on_ring(c));
        let covered: f64 = chains.iter().map(|c| layer.chains[*c].length_m).sum();
        if covered < COVERED * std::f64::consts::TAU * radius {
            continue;
        }
        let mut nodes = Vec::new();
        for &c in &chains {
            taken[c] = true;
            nodes.extend([layer.chains[c].from, layer.chains[c].to]);
        }
        nodes.sort_unstable();
        nodes.dedup();
        groups.push(nodes);
    }
    groups
}

/// Votes of one chain: for samples a growing distance apart, where their normals meet.
fn vote(points: &[Vec2], most_m: f64, votes: &mut Vec<(Vec2, f64)>) {
    let n = points.len();
    if n < 4 {
        return;
    }
    let tangent =
        |i: usize| (points[(i + 1).min(n - 1)] - points[i.saturating_sub(1)]).normalize_or_zero();
    for (step, stride) in [(2, 1), (4, 1), (8, 2), (16, 4), (32, 8)] {
        for i in (0..n.saturating_sub(step)).step_by(stride) {
            let (a, b) = (points[i], points[i + step]);
            let (u, v) = (tangent(i), tangent(i + step));
            let turn = u.perp_dot(v);
            // Under a quarter radian the normals are too parallel for a centre.
            if turn.abs() < 0.25 {
                continue;
            }
            // a + n_a·r = b + n_b·r on one side, with normals to the inside of the turn.
            let side = turn.signum();
            let (na, nb) = (u.perp() * side, v.perp() * side);
            let (d, e) = (na - nb, b - a);
            let radius = d.dot(e) / d.length_squared();
            let center = ((a + na * radius) + (b + nb * radius)) / 2.0;
            if (LEAST_RADIUS_M..=most_m).contains(&radius) {
                votes.push((center, radius));
            }
        }
    }
}

/// Nodes inside each of the user's polygons.
pub fn kept(layer: &Layer, polygons: &[Polygon]) -> Vec<Vec<usize>> {
    polygons
        .iter()
        .map(|polygon| {
            (0..layer.nodes.len())
                .filter(|n| polygon.contains(GridPoint::round(layer.nodes[*n].at)))
                .collect()
        })
        .collect()
}
