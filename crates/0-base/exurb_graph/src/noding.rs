//! Linework → lines that meet at their ends only.
//!
//! Lines on one level are split wherever they cross or touch; lines of different levels (bridges,
//! tunnels) pass each other. Crossings are rounded to the grid, which can bend a line by up to
//! 0.7 mm and make it touch another; the pass is repeated until nothing changes, which for street
//! data takes two or three rounds. O((n + k) log n) a round for n segments and k crossings.

use exurb_geom::{Bounds, GridPoint, SegmentIndex, Vec2, grid, polyline};

/// A line to be noded.
#[derive(Clone, Debug, PartialEq)]
pub struct Line<T> {
    /// Its points; at least two, no equal neighbours.
    pub points: Vec<GridPoint>,
    /// Lines are noded with lines of the same level only.
    pub level: i32,
    /// The owner's payload, copied to every piece.
    pub data: T,
}

/// How linework is noded.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// A line's vertex nearer than this to another line becomes a shared vertex of both. Metres.
    pub snap_m: f64,
    /// Rounds at most. Enough is enough: what is left is reported by the city's laws.
    pub max_rounds: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { snap_m: 0.0, max_rounds: 8 }
    }
}

/// Splits `lines` at their crossings and at each other's vertices. The pieces keep their line's
/// order and direction. Also splits a line where it crosses or touches itself.
pub fn node<T: Clone>(lines: Vec<Line<T>>, options: Options) -> Vec<Line<T>> {
    let mut lines = lines;
    for _ in 0..options.max_rounds {
        let cuts = find_cuts(&lines, options.snap_m);
        if cuts.iter().all(Vec::is_empty) {
            break;
        }
        lines = apply_cuts(lines, cuts);
    }
    lines
}

/// A point to insert into segment `segment` of a line, `along` from its start, and split there.
#[derive(Clone, Copy, Debug)]
struct Cut {
    segment: usize,
    along: f64,
    at: GridPoint,
}

fn find_cuts<T>(lines: &[Line<T>], snap_m: f64) -> Vec<Vec<Cut>> {
    // Segment number → (line, segment).
    let mut owners: Vec<(u32, u32)> = Vec::new();
    let mut index = SegmentIndex::new(50.0);
    for (l, line) in lines.iter().enumerate() {
        for (s, w) in line.points.windows(2).enumerate() {
            index.insert(owners.len() as u32, w[0].to_m(), w[1].to_m());
            owners.push((l as u32, s as u32));
        }
    }
    let mut cuts = vec![Vec::new(); lines.len()];
    for (i, &(l, s)) in owners.iter().enumerate() {
        let (l, s) = (l as usize, s as usize);
        let (a, b) = (lines[l].points[s], lines[l].points[s + 1]);
        let bounds = Bounds { min: a.to_m().min(b.to_m()), max: a.to_m().max(b.to_m()) };
        for j in index.ids(bounds.grown(snap_m + 0.001)) {
            let (m, t) = owners[j as usize];
            let (m, t) = (m as usize, t as usize);
            if j as usize <= i || lines[l].level != lines[m].level {
                continue;
            }
            let (c, d) = (lines[m].points[t], lines[m].points[t + 1]);
            if grid::cross_properly(a, b, c, d) {
                if let Some(p) = grid::line_intersection(a, b, c, d) {
                    let at = GridPoint::round(p);
                    push(&mut cuts[l], lines, l, s, at);
                    push(&mut cuts[m], lines, m, t, at);
                }
                continue;
            }
            let adjacent = l == m && (s + 1 == t || t + 1 == s);
            for p in [c, d] {
                if touches(a, b, p, if adjacent { 0.0 } else { snap_m }) {
                    push(&mut cuts[l], lines, l, s, p);
                    split_at_vertex(&mut cuts[m], lines, m, t + usize::from(p == d), p);
                }
            }
            for p in [a, b] {
                if touches(c, d, p, if adjacent { 0.0 } else { snap_m }) {
                    push(&mut cuts[m], lines, m, t, p);
                    split_at_vertex(&mut cuts[l], lines, l, s + usize::from(p == b), p);
                }
            }
            // Vertices that coincide: split both lines there unless it is an end of each already.
            for (p, u) in [(a, s), (b, s + 1)] {
                for (q, v) in [(c, t), (d, t + 1)] {
                    if p == q && !(l == m && u == v) {
                        split_at_vertex(&mut cuts[l], lines, l, u, p);
                        split_at_vertex(&mut cuts[m], lines, m, v, p);
                    }
                }
            }
        }
    }
    for list in &mut cuts {
        list.sort_by(|a, b| {
            a.segment.cmp(&b.segment).then(a.along.total_cmp(&b.along)).then(a.at.cmp(&b.at))
        });
        list.dedup_by(|a, b| a.segment == b.segment && a.at == b.at);
    }
    cuts
}

/// Is `p` inside segment `a b` (not one of its ends), within `snap_m` or exactly on it?
fn touches(a: GridPoint, b: GridPoint, p: GridPoint, snap_m: f64) -> bool {
    if p == a || p == b {
        return false;
    }
    if grid::on_segment(a, b, p) {
        return true;
    }
    if snap_m <= 0.0 {
        return false;
    }
    let (q, t) = polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m());
    t > 0.0 && t < 1.0 && q.distance(p.to_m()) < snap_m
}

fn push<T>(cuts: &mut Vec<Cut>, lines: &[Line<T>], l: usize, segment: usize, at: GridPoint) {
    let points = &lines[l].points;
    let (a, b) = (points[segment], points[segment + 1]);
    if at == a || at == b {
        split_at_vertex(cuts, lines, l, segment + usize::from(at == b), at);
        return;
    }
    let d: Vec2 = b.to_m() - a.to_m();
    let along = (at.to_m() - a.to_m()).dot(d) / d.length_squared();
    cuts.push(Cut { segment, along, at });
}

fn split_at_vertex<T>(
    cuts: &mut Vec<Cut>,
    lines: &[Line<T>],
    l: usize,
    vertex: usize,
    at: GridPoint,
) {
    let last = lines[l].points.len() - 1;
    if vertex > 0 && vertex < last {
        cuts.push(Cut { segment: vertex, along: 0.0, at });
    }
}

fn apply_cuts<T: Clone>(lines: Vec<Line<T>>, cuts: Vec<Vec<Cut>>) -> Vec<Line<T>> {
    let mut out = Vec::with_capacity(lines.len());
    for (line, cuts) in lines.into_iter().zip(cuts) {
        if cuts.is_empty() {
            out.push(line);
            continue;
        }
        let mut pending = cuts.into_iter().peekable();
        let mut piece: Vec<GridPoint> = Vec::new();
        let mut emit = |piece: &mut Vec<GridPoint>| {
            piece.dedup();
            if piece.len() > 1 {
                let points = piece.clone();
                out.push(Line { points, level: line.level, data: line.data.clone() });
            }
            piece.clear();
        };
        for (v, p) in line.points.iter().enumerate() {
            piece.push(*p);
            while let Some(cut) = pending.next_if(|c| c.segment == v) {
                piece.push(cut.at);
                emit(&mut piece);
                piece.push(cut.at);
            }
        }
        emit(&mut piece);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)], level: i32) -> Line<()> {
        Line { points: points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect(), level, data: () }
    }

    #[test]
    fn a_crossing_on_one_level_makes_four_pieces() {
        let cross = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., -5.), (0., 5.)], 0)];
        assert_eq!(node(cross, Options::default()).len(), 4);
    }

    #[test]
    fn a_bridge_passes_over() {
        let cross = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., -5.), (0., 5.)], 1)];
        assert_eq!(node(cross, Options::default()).len(), 2);
    }

    #[test]
    fn shared_inner_vertices_and_touching_ends_split() {
        let shared = vec![
            line(&[(-5., 0.), (0., 0.), (5., 0.)], 0),
            line(&[(0., -5.), (0., 0.), (0., 5.)], 0),
        ];
        assert_eq!(node(shared, Options::default()).len(), 4);
        let tee = vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., 5.), (0., 0.)], 0)];
        assert_eq!(node(tee, Options::default()).len(), 3);
    }

    #[test]
    fn a_near_miss_is_joined_when_asked() {
        let tee = || vec![line(&[(-5., 0.), (5., 0.)], 0), line(&[(0., 5.), (0., 0.04)], 0)];
        assert_eq!(node(tee(), Options::default()).len(), 2);
        assert_eq!(node(tee(), Options { snap_m: 0.05, ..Options::default() }).len(), 3);
    }

    #[test]
    fn a_line_that_crosses_itself_falls_into_pieces() {
        let eight = vec![line(&[(0., 0.), (10., 10.), (10., 0.), (0., 10.)], 0)];
        assert_eq!(node(eight, Options::default()).len(), 3);
    }

    #[test]
    fn after_noding_nothing_crosses() {
        // A fan of odd slopes: every crossing is rounded.
        let fan: Vec<_> = (0..40)
            .map(|i| {
                let i = f64::from(i);
                line(
                    &[(i * 7.3, (i * 13.7) % 29.0), (280.0 - i * 6.1, 300.0 + (i * 5.3) % 31.0)],
                    0,
                )
            })
            .collect();
        let noded = node(fan, Options::default());
        let segments: Vec<_> = noded.iter().flat_map(|l| l.points.windows(2)).collect();
        for (i, s) in segments.iter().enumerate() {
            for t in &segments[i + 1..] {
                assert!(!grid::cross_properly(s[0], s[1], t[0], t[1]), "{s:?} {t:?}");
            }
        }
    }
}
