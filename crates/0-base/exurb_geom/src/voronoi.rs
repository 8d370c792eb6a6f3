//! Borders between groups of points: the edges of a Voronoi diagram whose two sides belong to
//! different groups.

use spade::handles::VoronoiVertex;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::{Bounds, GridPoint, Vec2};

/// A point and the group it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Where it stands, in metres.
    pub at: Vec2,
    /// Its group.
    pub label: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

/// The borders between the cells of different groups inside `bounds`, as lines in metres between
/// the points where three groups meet or a border leaves the bounds.
///
/// Sites that share a millimetre count once, the first one stays. With one site for each group these
/// are the edges of the Voronoi diagram; with many sites along a line they approach the Voronoi
/// diagram of lines. O(n log n) in sites. Sites that are not finite are left out.
pub fn borders(sites: &[Site], bounds: Bounds) -> Vec<Vec<Vec2>> {
    let mut seen = std::collections::BTreeSet::new();
    let distinct: Vec<Site> = sites
        .iter()
        .filter(|s| GridPoint::checked(s.at).is_some_and(|p| seen.insert(p)))
        .copied()
        .collect();
    let Ok(triangulation) = DelaunayTriangulation::<Site>::bulk_load_stable(distinct) else {
        return Vec::new();
    };
    let reach_m = bounds.size().length() * 2.0 + 1.0;
    let mut pieces = Vec::new();
    for edge in triangulation.undirected_voronoi_edges() {
        let [u, v] = edge.as_delaunay_edge().vertices();
        let (u, v) = (*u.data(), *v.data());
        if u.label == v.label {
            continue;
        }
        let middle = (u.at + v.at) / 2.0;
        let [from, to] = edge.vertices().map(|vertex| match vertex {
            VoronoiVertex::Inner(face) => {
                let p = face.circumcenter();
                (Vec2::new(p.x, p.y), Some(face.index() as u32))
            }
            VoronoiVertex::Outer(outer) => {
                let d = outer.direction_vector();
                let d = Vec2::new(d.x, d.y).normalize_or_zero();
                (middle + d * reach_m, None)
            }
        });
        if let Some(piece) = clipped(from, to, bounds) {
            pieces.push(piece);
        }
    }
    chained(&pieces)
}

type End = (Vec2, Option<u32>);

/// The part of a segment inside the box (Liang–Barsky); ends that are cut off lose their vertex.
fn clipped(from: End, to: End, bounds: Bounds) -> Option<(End, End)> {
    let d = to.0 - from.0;
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (delta, low, high) in [
        (d.x, bounds.min.x - from.0.x, bounds.max.x - from.0.x),
        (d.y, bounds.min.y - from.0.y, bounds.max.y - from.0.y),
    ] {
        if delta == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = (low / delta, high / delta);
        t0 = t0.max(a.min(b));
        t1 = t1.min(a.max(b));
    }
    if t0.partial_cmp(&t1) != Some(std::cmp::Ordering::Less) {
        return None;
    }
    let start = if t0 > 0.0 { (from.0 + d * t0, None) } else { from };
    let end = if t1 < 1.0 { (from.0 + d * t1, None) } else { to };
    Some((start, end))
}

/// Joins segments where exactly two meet in a Voronoi vertex.
fn chained(pieces: &[(End, End)]) -> Vec<Vec<Vec2>> {
    // By vertex the pieces that end there, up to three.
    let vertices = pieces.iter().flat_map(|(a, b)| [a.1, b.1]).flatten().max().map_or(0, |v| v + 1);
    let mut at = vec![(0u8, [0usize; 3]); vertices as usize];
    for (i, (a, b)) in pieces.iter().enumerate() {
        for vertex in [a.1, b.1].into_iter().flatten() {
            let (count, list) = &mut at[vertex as usize];
            list[usize::from(*count).min(2)] = i;
            *count += 1;
        }
    }
    let next = |vertex: Option<u32>, from: usize| {
        let (count, list) = at[vertex? as usize];
        (count == 2).then(|| if list[0] == from { list[1] } else { list[0] })
    };
    let mut used = vec![false; pieces.len()];
    let mut out = Vec::new();
    // Chains from their ends first, then closed loops.
    for pass in 0..2 {
        for start in 0..pieces.len() {
            let (a, b) = pieces[start];
            let (open_a, open_b) = (next(a.1, start).is_none(), next(b.1, start).is_none());
            if used[start] || (pass == 0 && !open_a && !open_b) {
                continue;
            }
            let (first, mut tip) = if open_a || pass == 1 { (a, b) } else { (b, a) };
            let mut line = vec![first.0, tip.0];
            used[start] = true;
            let mut here = start;
            while let Some(there) = next(tip.1, here).filter(|n| !used[*n]) {
                let (c, d) = pieces[there];
                tip = if c.1 == tip.1 { d } else { c };
                line.push(tip.0);
                used[there] = true;
                here = there;
            }
            out.push(line);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyline;

    fn bounds(side: f64) -> Bounds {
        Bounds { min: Vec2::ZERO, max: Vec2::splat(side) }
    }

    fn site(x: f64, y: f64, label: u32) -> Site {
        Site { at: Vec2::new(x, y), label }
    }

    #[test]
    fn sites_on_one_line_are_parted_by_perpendiculars() {
        let row: Vec<Site> = (0..4).map(|i| site(5.0 + 10.0 * f64::from(i), 20.0, i)).collect();
        let mut found = borders(&row, bounds(40.0));
        found.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        assert_eq!(found.len(), 3);
        for (line, x) in found.iter().zip([10.0, 20.0, 30.0]) {
            assert!(line.iter().all(|p| (p.x - x).abs() < 1e-9));
            assert!((polyline::length(line) - 40.0).abs() < 1e-9);
        }
    }

    #[test]
    fn every_border_point_is_as_near_to_two_groups() {
        let sites: Vec<Site> = (0..60)
            .map(|i| {
                let k = f64::from(i);
                site((k * 37.7) % 97.0, (k * 61.3) % 89.0, i as u32 % 5)
            })
            .collect();
        let lines = borders(&sites, bounds(97.0));
        assert!(!lines.is_empty());
        for p in lines.iter().flat_map(|l| polyline::resample(l, 2.0)) {
            let nearest = |label| {
                let of = sites.iter().filter(|s| s.label == label);
                of.map(|s| s.at.distance(p)).fold(f64::INFINITY, f64::min)
            };
            let mut distances: Vec<f64> = (0..5).map(nearest).collect();
            distances.sort_by(f64::total_cmp);
            assert!(distances[1] - distances[0] < 1e-6, "{p} {distances:?}");
        }
    }

    #[test]
    fn one_group_has_no_border_and_bad_sites_are_left_out() {
        assert!(borders(&[site(1.0, 1.0, 0), site(2.0, 5.0, 0)], bounds(9.0)).is_empty());
        assert!(borders(&[site(f64::NAN, 1.0, 0), site(2.0, 5.0, 1)], bounds(9.0)).is_empty());
        assert!(borders(&[], bounds(9.0)).is_empty());
        assert!(borders(&[site(1.0, 1.0, 0), site(1.0, 1.0, 1)], bounds(9.0)).is_empty());
    }
}
