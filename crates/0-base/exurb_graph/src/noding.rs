//! Linework → lines that meet at their ends only.
//!
//! Lines on one level are split wherever they cross or touch; lines of different levels (bridges,
//! tunnels) pass each other. Steps of a round: 1 vertices that lie together within the snapping
//! distance move onto one of them; 2 lines get the vertices of others that lie on them, and the
//! crossings, rounded to the grid; 3 they are split there. Rounding can bend a line by up to 0.7 mm
//! and make it touch another, so rounds are repeated, on what changed, until nothing does; street
//! data take two or three. The result does not depend on the order of the lines but for its own.
//! O((n + k) log n) a round for n segments and k crossings.

use exurb_geom::{GridPoint, SegmentGrid, Vec2, grid, polyline};

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
    /// A line's vertex nearer than this to another line becomes a shared vertex of both; vertices
    /// nearer than one and a half times this to each other become one. Metres.
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
/// order and direction. Also splits a line where it crosses or touches itself. Lines that snapping
/// shrinks to a point go.
pub fn node<T: Clone>(lines: Vec<Line<T>>, options: Options) -> Vec<Line<T>> {
    let mut lines: Vec<Noded<T>> =
        lines.into_iter().map(|line| Noded { line, changed: true }).collect();
    for _ in 0..options.max_rounds {
        if options.snap_m > 0.0 {
            gather_vertices(&mut lines, options.snap_m * GATHER);
        }
        let cuts = find_cuts(&lines, options.snap_m);
        let done = cuts.iter().all(Vec::is_empty);
        lines = apply_cuts(lines, cuts);
        if done {
            break;
        }
    }
    lines.into_iter().map(|noded| noded.line).collect()
}

/// Vertices are gathered from this many times as far as lines are drawn to them. With less, two
/// vertices beside a third could draw each other's lines back and forth for ever.
const GATHER: f64 = 1.5;

/// A line, and whether the last round changed it.
struct Noded<T> {
    line: Line<T>,
    changed: bool,
}

/// Step 1: of vertices within `reach_m` of each other and on a common level, all move onto the first
/// by coordinates; whatever else stands there moves along.
fn gather_vertices<T>(lines: &mut Vec<Noded<T>>, reach_m: f64) {
    let mut vertices: Vec<(GridPoint, i32)> = lines
        .iter()
        .flat_map(|noded| noded.line.points.iter().map(|p| (*p, noded.line.level)))
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    let reach_mm = (reach_m * 1000.0).ceil() as i32;
    let mut moved: Vec<(GridPoint, GridPoint)> = Vec::new();
    let mut gone = vec![false; vertices.len()];
    for i in 0..vertices.len() {
        let (p, level) = vertices[i];
        if gone[i] {
            continue;
        }
        for j in i + 1..vertices.len() {
            let (q, other_level) = vertices[j];
            if q.x - p.x > reach_mm {
                break;
            }
            if p != q && level == other_level && !gone[j] && p.distance_m(q) < reach_m {
                gone[j] = true;
                moved.push((q, p));
            }
        }
    }
    if moved.is_empty() {
        return;
    }
    // A position on two levels goes where the first of them sends it.
    moved.sort_unstable();
    moved.dedup_by_key(|(from, _)| *from);
    for noded in lines.iter_mut() {
        for p in &mut noded.line.points {
            if let Ok(at) = moved.binary_search_by_key(p, |(from, _)| *from) {
                *p = moved[at].1;
                noded.changed = true;
            }
        }
        noded.line.points.dedup();
    }
    lines.retain(|noded| noded.line.points.len() > 1);
}

/// A point to insert into segment `segment` of a line, `along` from its start, and split there.
#[derive(Clone, Copy, Debug)]
struct Cut {
    segment: usize,
    along: f64,
    at: GridPoint,
}

/// Step 2: where every line is to be split. Pairs of lines that the last round left alone have been
/// looked at before.
fn find_cuts<T>(lines: &[Noded<T>], snap_m: f64) -> Vec<Vec<Cut>> {
    // Segment number → (line, segment).
    let mut owners: Vec<(u32, u32)> = Vec::new();
    let mut segments = Vec::new();
    for (l, Noded { line, .. }) in lines.iter().enumerate() {
        for (s, w) in line.points.windows(2).enumerate() {
            segments.push((w[0], w[1]));
            owners.push((l as u32, s as u32));
        }
    }
    let index = SegmentGrid::new(segments);
    let margin_mm = (snap_m * 1000.0).ceil() as i32;
    let mut near = Vec::new();
    let mut cuts = vec![Vec::new(); lines.len()];
    for (i, &(l, s)) in owners.iter().enumerate() {
        let (l, s) = (l as usize, s as usize);
        if !lines[l].changed {
            continue;
        }
        let (a, b) = index.segment(i as u32);
        let is_open = |j: u32| {
            let other = &lines[owners[j as usize].0 as usize];
            let seen_from_there = other.changed && j as usize <= i;
            !seen_from_there && lines[l].line.level == other.line.level
        };
        index.near_of(a, b, margin_mm, is_open, &mut near);
        for &j in &near {
            let (m, t) = owners[j as usize];
            cut_pair(&mut cuts, lines, (l, s), (m as usize, t as usize), snap_m);
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

/// Cuts segment `s` of line `l` and segment `t` of line `m` where they meet.
fn cut_pair<T>(
    cuts: &mut [Vec<Cut>],
    lines: &[Noded<T>],
    (l, s): (usize, usize),
    (m, t): (usize, usize),
    snap_m: f64,
) {
    let (a, b) = (lines[l].line.points[s], lines[l].line.points[s + 1]);
    let (c, d) = (lines[m].line.points[t], lines[m].line.points[t + 1]);
    let adjacent = l == m && (s + 1 == t || t + 1 == s);
    if adjacent {
        let tip = s.max(t);
        if folds_at(&lines[l].line.points, tip) {
            split_at_vertex(&mut cuts[l], lines, l, tip, lines[l].line.points[tip]);
        }
    }
    let snap_m = if adjacent { 0.0 } else { snap_m };
    let mut touching = false;
    for (p, vertex) in [(c, t), (d, t + 1)] {
        if touches(a, b, p, snap_m) {
            touching = true;
            push(&mut cuts[l], lines, l, s, p);
            split_at_vertex(&mut cuts[m], lines, m, vertex, p);
        }
    }
    for (p, vertex) in [(a, s), (b, s + 1)] {
        if touches(c, d, p, snap_m) {
            touching = true;
            push(&mut cuts[m], lines, m, t, p);
            split_at_vertex(&mut cuts[l], lines, l, vertex, p);
        }
    }
    // Where a vertex is shared now, a crossing beside it is left to the next round.
    if !touching && let Some(at) = crossing(a, b, c, d) {
        push(&mut cuts[l], lines, l, s, at);
        push(&mut cuts[m], lines, m, t, at);
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

/// Does the line turn right back at its vertex `tip`?
fn folds_at(points: &[GridPoint], tip: usize) -> bool {
    let (before, at, after) = (points[tip - 1], points[tip], points[tip + 1]);
    let (u, v) = (before.to_m() - at.to_m(), after.to_m() - at.to_m());
    grid::orient(at, before, after) == 0 && u.dot(v) > 0.0
}

/// The proper crossing of two segments on the grid, the same bits in whatever order and direction.
fn crossing(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> Option<GridPoint> {
    if !grid::cross_properly(a, b, c, d) {
        return None;
    }
    let (u, v) = ((a.min(b), a.max(b)), (c.min(d), c.max(d)));
    let (u, v) = (u.min(v), u.max(v));
    grid::line_intersection(u.0, u.1, v.0, v.1).map(GridPoint::round)
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

fn push<T>(cuts: &mut Vec<Cut>, lines: &[Noded<T>], l: usize, segment: usize, at: GridPoint) {
    let points = &lines[l].line.points;
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
    lines: &[Noded<T>],
    l: usize,
    vertex: usize,
    at: GridPoint,
) {
    let last = lines[l].line.points.len() - 1;
    if vertex > 0 && vertex < last {
        cuts.push(Cut { segment: vertex, along: 0.0, at });
    }
}

/// Step 3: inserts the cuts and splits there.
fn apply_cuts<T: Clone>(lines: Vec<Noded<T>>, cuts: Vec<Vec<Cut>>) -> Vec<Noded<T>> {
    let mut out = Vec::with_capacity(lines.len());
    for (Noded { line, .. }, cuts) in lines.into_iter().zip(cuts) {
        if cuts.is_empty() {
            out.push(Noded { line, changed: false });
            continue;
        }
        let mut pending = cuts.into_iter().peekable();
        let mut piece: Vec<GridPoint> = Vec::new();
        let mut emit = |piece: &mut Vec<GridPoint>| {
            piece.dedup();
            let points = std::mem::take(piece);
            if points.len() > 1 {
                let line = Line { points, level: line.level, data: line.data.clone() };
                out.push(Noded { line, changed: true });
            }
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
mod tests;
