//! Laws of the drawing: streets meet at nodes only, and no street is delivered twice.

use exurb_geom::{GridPoint, Vec2, grid, polyline, trig};
use exurb_graph::EdgeId;
use rayon::prelude::*;

use super::{Breach, LawReport, pieces::Pieces};
use crate::City;

/// A vertex nearer than this to a street that it does not join touches it, in metres.
const TOUCH_M: f64 = 0.02;
/// Streets side by side within this distance and angle overlap.
const OVERLAP_M: f64 = 3.0;
const OVERLAP_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// Points along streets are about this far apart, and this far from their ends at least, in metres.
const SAMPLE_M: f64 = 10.0;
const ENDS_M: f64 = 15.0;
/// Work is handed to threads in pieces of at least this many.
const LEAST_WORK: usize = 512;

pub fn add_laws(report: &mut LawReport, city: &City, pieces: &Pieces) {
    let (crossings, own) = crossings(pieces);
    let per_100_km = |count: usize| {
        (pieces.length_m > 0.0).then(|| count as f64 / (pieces.length_m / 100_000.0))
    };
    report.at_most("crossings_without_node", per_100_km(crossings.len()), 0.0, crossings);
    let touching = touching(pieces);
    report.at_most("touching_vertices", per_100_km(touching.len()), 0.0, touching);
    report.none_of("self_intersecting_edges", own);
    let (share, twice) = duplicates(pieces);
    report.at_most("duplicate_length_share", share, 0.0, twice);
    let (share, overlaps) = overlaps(pieces, city);
    report.at_most("overlap_share", share, 0.003, overlaps);
}

fn breach(law: &'static str, edge: EdgeId, at: GridPoint, message: String) -> Breach {
    Breach { law, layer: "streets", id: edge.0 + 1, at, message }
}

/// Crossings of different streets, and streets that meet themselves (each once).
fn crossings(pieces: &Pieces) -> (Vec<Breach>, Vec<Breach>) {
    let found: Vec<Vec<(EdgeId, EdgeId, GridPoint)>> = (0..pieces.owners.len() as u32)
        .into_par_iter()
        .with_min_len(LEAST_WORK)
        .map_init(Vec::new, |near, i| {
            let (a, b) = pieces.grid.segment(i);
            let (edge, segment) = pieces.owners[i as usize];
            pieces.grid.near(a, b, 0, near);
            let mut out = Vec::new();
            for j in near.iter().copied().filter(|j| *j > i) {
                let (other, other_segment) = pieces.owners[j as usize];
                let (c, d) = pieces.grid.segment(j);
                if other == edge {
                    let next = other_segment == segment + 1;
                    let closes = segment == 0 && pieces.is_last(j) && a == d;
                    if meets_itself((a, b), (c, d), next, closes) {
                        out.push((edge, edge, c));
                    }
                } else if pieces.level(edge) == pieces.level(other)
                    && grid::cross_properly(a, b, c, d)
                {
                    let at = grid::line_intersection(a, b, c, d).map_or(a, GridPoint::round);
                    out.push((edge, other, at));
                }
            }
            out
        })
        .collect();
    let (mut own, mut others) = (Vec::new(), Vec::new());
    for (edge, other, at) in found.into_iter().flatten() {
        if edge != other {
            let message = format!("crosses street {} without a node", other.0 + 1);
            others.push(breach("crossings_without_node", edge, at, message));
        } else if own.last().is_none_or(|b: &Breach| b.id != edge.0 + 1) {
            let message = "crosses, touches or folds back on itself".to_owned();
            own.push(breach("self_intersecting_edges", edge, at, message));
        }
    }
    (others, own)
}

/// Do two segments of one line share more than the vertex between them? `next`: the second follows
/// the first; `closes`: the second ends where the first begins, as in a loop.
fn meets_itself(
    (a, b): (GridPoint, GridPoint),
    (c, d): (GridPoint, GridPoint),
    next: bool,
    closes: bool,
) -> bool {
    let folds = |at: GridPoint, p: GridPoint, q: GridPoint| {
        let (u, v) = (p.to_m() - at.to_m(), q.to_m() - at.to_m());
        grid::orient(at, p, q) == 0 && u.dot(v) > 0.0
    };
    match (next, closes) {
        (true, true) => true, // there and back
        (true, false) => folds(b, a, d),
        (false, true) => folds(a, b, c),
        (false, false) => grid::intersects(a, b, c, d),
    }
}

/// Vertices that lie on or within 2 cm of a street that does not end there.
fn touching(pieces: &Pieces) -> Vec<Breach> {
    let graph = pieces.graph;
    let nodes: Vec<_> = graph.nodes().collect();
    let at_nodes: Vec<Option<Breach>> = nodes
        .par_iter()
        .with_min_len(LEAST_WORK)
        .map_init(Vec::new, |near, (id, node)| {
            let own: Vec<EdgeId> = graph.darts(*id).iter().map(|d| d.edge()).collect();
            let on_level = |f| own.iter().any(|e| pieces.level(*e) == pieces.level(f));
            let other = touched(pieces, node.at, near, |f| !own.contains(&f) && on_level(f))?;
            let edge = *own.first()?;
            let message = format!("ends on street {} without joining it", other.0 + 1);
            Some(breach("touching_vertices", edge, node.at, message))
        })
        .collect();
    let edges: Vec<_> = graph.edges().collect();
    let inner: Vec<Vec<Breach>> = edges
        .par_iter()
        .with_min_len(LEAST_WORK)
        .map_init(Vec::new, |near, (id, edge)| {
            let line = edge.line();
            let ends = [line[0].to_m(), line[line.len() - 1].to_m()];
            let mut out = Vec::new();
            for p in &line[1..line.len() - 1] {
                // Right beside its own end the vertex touches whatever meets there.
                if ends.iter().any(|end| end.distance(p.to_m()) < TOUCH_M) {
                    continue;
                }
                let level = pieces.level(*id);
                if let Some(other) =
                    touched(pieces, *p, near, |f| f != *id && pieces.level(f) == level)
                {
                    let message = format!("touches street {} without joining it", other.0 + 1);
                    out.push(breach("touching_vertices", *id, *p, message));
                }
            }
            out
        })
        .collect();
    at_nodes.into_iter().flatten().chain(inner.into_iter().flatten()).collect()
}

/// The first street that `counts` and passes within 2 cm of `p`.
fn touched(
    pieces: &Pieces,
    p: GridPoint,
    near: &mut Vec<u32>,
    counts: impl Fn(EdgeId) -> bool,
) -> Option<EdgeId> {
    pieces.grid.near(p, p, (TOUCH_M * 1000.0) as i32, near);
    near.iter().find_map(|j| {
        let edge = pieces.owners[*j as usize].0;
        let (a, b) = pieces.grid.segment(*j);
        let close = || {
            let (q, _) = polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m());
            q.distance(p.to_m()) < TOUCH_M
        };
        (counts(edge) && close()).then_some(edge)
    })
}

/// Share of the length delivered between a pair of vertices that was delivered before.
fn duplicates(pieces: &Pieces) -> (Option<f64>, Vec<Breach>) {
    let mut keys: Vec<(GridPoint, GridPoint, u32)> = (0..pieces.owners.len() as u32)
        .map(|i| {
            let (a, b) = pieces.grid.segment(i);
            (a.min(b), a.max(b), i)
        })
        .collect();
    keys.par_sort_unstable();
    let mut length_m = 0.0;
    let mut twice: Vec<(EdgeId, GridPoint, EdgeId)> = Vec::new();
    for w in keys.windows(2) {
        let ((a, b, first), (c, d, second)) = (w[0], w[1]);
        if (a, b) == (c, d) {
            length_m += a.distance_m(b);
            let owner = |i: u32| pieces.owners[i as usize].0;
            twice.push((owner(second), a, owner(first)));
        }
    }
    twice.sort_unstable();
    let breaches = twice
        .into_iter()
        .map(|(edge, at, first)| {
            let message = format!("repeats a piece of street {}", first.0 + 1);
            breach("duplicate_length_share", edge, at, message)
        })
        .collect();
    ((pieces.length_m > 0.0).then(|| length_m / pieces.length_m), breaches)
}

/// Share of points along streets inside the target, away from their ends, beside which another
/// street runs, on whatever level. Streets copied together from one patch of an example keep their
/// distance, whatever it is.
fn overlaps(pieces: &Pieces, city: &City) -> (Option<f64>, Vec<Breach>) {
    let edges: Vec<_> = pieces.graph.edges().collect();
    let per_edge: Vec<(usize, Vec<Breach>)> = edges
        .par_iter()
        .with_min_len(64)
        .map_init(Vec::new, |near, (id, edge)| {
            let line = edge.line_m();
            let length = polyline::length(&line);
            let count = ((length - 2.0 * ENDS_M) / SAMPLE_M).ceil().max(0.0);
            let (mut points, mut out) = (0, Vec::new());
            for i in 0..count as usize {
                let along = ENDS_M + (i as f64 + 0.5) * (length - 2.0 * ENDS_M) / count;
                let at = polyline::point_at(&line, along);
                if !city.target.contains(GridPoint::round(at)) {
                    continue;
                }
                points += 1;
                let point = |offset_m| polyline::point_at(&line, along + offset_m);
                if let Some(other) = beside(pieces, *id, at, point(0.5) - point(-0.5), near) {
                    let message = format!("runs on top of street {}", other.0 + 1);
                    out.push(breach("overlap_share", *id, GridPoint::round(at), message));
                }
            }
            (points, out)
        })
        .collect();
    let total: usize = per_edge.iter().map(|(points, _)| points).sum();
    let breaches: Vec<Breach> = per_edge.into_iter().flat_map(|(_, out)| out).collect();
    ((total > 0).then(|| breaches.len() as f64 / total as f64), breaches)
}

/// Another street within 3 m and 15° of the point `at` of street `id` running along `direction`.
fn beside(
    pieces: &Pieces,
    id: EdgeId,
    at: Vec2,
    direction: Vec2,
    near: &mut Vec<u32>,
) -> Option<EdgeId> {
    let p = GridPoint::round(at);
    let own = &pieces.graph.edge(id).data;
    pieces.grid.near(p, p, (OVERLAP_M * 1000.0) as i32, near);
    near.iter().find_map(|j| {
        let (other, _) = pieces.owners[*j as usize];
        let (a, b) = pieces.grid.segment(*j);
        let (a, b) = (a.to_m(), b.to_m());
        let (q, _) = polyline::nearest_on_segment(a, b, at);
        let angle = trig::angle_between(direction, b - a);
        let parallel = angle.min(std::f64::consts::PI - angle) <= OVERLAP_RAD;
        let counts = other != id && parallel && q.distance(at) <= OVERLAP_M;
        (counts && !own.copied_with(&pieces.graph.edge(other).data)).then_some(other)
    })
}

impl crate::Street {
    /// Were both copied from one patch of one example?
    fn copied_with(&self, other: &Self) -> bool {
        let (p, q) = (&self.provenance, &other.provenance);
        p.origin == crate::Origin::Example && p.part.is_some() && p == q
    }
}
