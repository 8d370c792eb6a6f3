//! Coastlines closed to sea along the edge of the map.
//!
//! OSM draws the coast with the water on its right. Inside a rectangle it falls into runs that enter
//! and leave through the boundary; from where a run leaves, the sea's outline follows the boundary
//! clockwise (the rectangle on its right) to where the next run enters. Rings wholly inside are
//! islands when counter-clockwise. O(n + runs²).

use exurb_geom::{GridPoint, Polygon, overlay, polygon::signed_area_m2};

use crate::places::Vertex;

/// Ends inside the map nearer to its edge than this are led straight to it, in metres: files cut
/// upstream lose the last nodes.
const LEAD_OUT_M: f64 = 300.0;

/// The sea, and the number of coastline pieces that could not be closed.
#[derive(Debug, Default, PartialEq)]
pub struct Sea {
    pub polygons: Vec<Polygon>,
    pub dropped: usize,
}

/// The sea inside the bounds of `map`, from coastline ways in any order, each in its direction.
pub fn close(ways: Vec<Vec<Vertex>>, map: &Polygon) -> Sea {
    let edge = Edge::of(map);
    let (mut runs, mut islands, mut seas) = (Vec::new(), Vec::new(), Vec::new());
    let mut dropped = 0;
    for line in join(ways) {
        let is_ring = line[0].0 == line[line.len() - 1].0;
        let points: Vec<GridPoint> = line.into_iter().map(|(_, p)| p).collect();
        if is_ring && points.iter().all(|p| edge.holds(*p)) {
            let land = signed_area_m2(&points[..points.len() - 1]) > 0.0;
            (if land { &mut islands } else { &mut seas }).extend(Polygon::new(points, Vec::new()));
            continue;
        }
        for run in edge.runs(&points, is_ring) {
            match edge.led_out(run) {
                Some(run) => runs.push(run),
                None => dropped += 1,
            }
        }
    }
    let (closed, left) = edge.follow(runs);
    dropped += left;
    seas.extend(closed);
    if seas.is_empty() && !islands.is_empty() && dropped == 0 {
        seas.push(map.clone());
    }
    let polygons = seas.into_iter().flat_map(|sea| with_islands(sea, &islands)).collect();
    Sea { polygons, dropped }
}

/// Joins ways at shared ends, keeping directions.
fn join(ways: Vec<Vec<Vertex>>) -> Vec<Vec<Vertex>> {
    let mut left: Vec<Option<Vec<Vertex>>> =
        ways.into_iter().filter(|w| w.len() > 1).map(Some).collect();
    let mut out: Vec<Vec<Vertex>> = Vec::new();
    for first in 0..left.len() {
        let Some(mut line) = left[first].take() else { continue };
        let take = |at: &dyn Fn(&[Vertex]) -> bool, left: &mut Vec<Option<Vec<Vertex>>>| {
            let found = left.iter().position(|l| l.as_ref().is_some_and(|l| at(l)))?;
            left[found].take()
        };
        while line[0].0 != line[line.len() - 1].0 {
            let (start, end) = (line[0].0, line[line.len() - 1].0);
            if let Some(next) = take(&|l| l[0].0 == end, &mut left) {
                line.extend(next.into_iter().skip(1));
            } else if let Some(mut before) = take(&|l| l[l.len() - 1].0 == start, &mut left) {
                before.extend(line.into_iter().skip(1));
                line = before;
            } else {
                break;
            }
        }
        out.push(line);
    }
    out
}

fn with_islands(sea: Polygon, islands: &[Polygon]) -> Vec<Polygon> {
    let inside = |island: &&Polygon| sea.contains(GridPoint::round(island.interior_point()));
    let holes = islands.iter().filter(inside).map(|i| i.exterior().to_vec()).collect();
    let whole = Polygon::new(sea.exterior().to_vec(), holes);
    whole.into_iter().flat_map(|sea| overlay::repair(&sea)).collect()
}

/// The map's edge: a rectangle, measured clockwise from its north-west corner.
struct Edge {
    lo: GridPoint,
    hi: GridPoint,
}

impl Edge {
    fn of(map: &Polygon) -> Self {
        let bounds = map.bounds();
        Self { lo: GridPoint::round(bounds.min), hi: GridPoint::round(bounds.max) }
    }

    /// Strictly inside?
    fn holds(&self, p: GridPoint) -> bool {
        self.lo.x < p.x && p.x < self.hi.x && self.lo.y < p.y && p.y < self.hi.y
    }

    fn is_on(&self, p: GridPoint) -> bool {
        !self.holds(p)
    }

    /// The parts of a line inside, in its direction.
    fn runs(&self, points: &[GridPoint], is_ring: bool) -> Vec<Vec<GridPoint>> {
        let mut out: Vec<Vec<GridPoint>> = Vec::new();
        for w in points.windows(2) {
            let Some((a, b)) = self.clip(w[0], w[1]) else { continue };
            match out.last_mut() {
                Some(run) if run.last() == Some(&a) && self.holds(a) => run.push(b),
                _ => out.push(vec![a, b]),
            }
        }
        // A ring that begins inside falls apart there.
        if is_ring && out.len() > 1 && self.holds(points[0]) {
            let mut tail = out.pop().unwrap_or_default();
            tail.extend(out[0].iter().skip(1));
            out[0] = tail;
        }
        out
    }

    /// The part of a segment inside, of some length. (After Liang and Barsky.)
    fn clip(&self, a: GridPoint, b: GridPoint) -> Option<(GridPoint, GridPoint)> {
        let (p, q) = (a.to_m(), b.to_m());
        let (lo, hi, d) = (self.lo.to_m(), self.hi.to_m(), q - p);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (d, start, lo, hi) in [(d.x, p.x, lo.x, hi.x), (d.y, p.y, lo.y, hi.y)] {
            if d == 0.0 {
                if start <= lo || start >= hi {
                    return None;
                }
            } else {
                let (t, u) = ((lo - start) / d, (hi - start) / d);
                from = from.max(t.min(u));
                to = to.min(t.max(u));
            }
        }
        let at = |t: f64| match t {
            0.0 => a,
            1.0 => b,
            t => self.snapped(GridPoint::round(p.lerp(q, t))),
        };
        let (a, b) = (at(from), at(to));
        (from < to && a != b).then_some((a, b))
    }

    /// A point on the boundary but for rounding, brought onto it.
    fn snapped(&self, p: GridPoint) -> GridPoint {
        let snap = |v: i32, lo: i32, hi: i32| match v {
            v if v <= lo + 1 => lo,
            v if v >= hi - 1 => hi,
            v => v,
        };
        GridPoint { x: snap(p.x, self.lo.x, self.hi.x), y: snap(p.y, self.lo.y, self.hi.y) }
    }

    /// The run with both ends on the boundary; `None` when an end is too far from it.
    fn led_out(&self, mut run: Vec<GridPoint>) -> Option<Vec<GridPoint>> {
        for at_start in [true, false] {
            let end = if at_start { run[0] } else { run[run.len() - 1] };
            if self.is_on(end) {
                continue;
            }
            let out = self.nearest(end);
            if out.distance_m(end) > LEAD_OUT_M {
                return None;
            }
            if at_start {
                run.insert(0, out);
            } else {
                run.push(out);
            }
        }
        Some(run)
    }

    fn nearest(&self, p: GridPoint) -> GridPoint {
        let sides = [
            GridPoint { x: self.lo.x, ..p },
            GridPoint { x: self.hi.x, ..p },
            GridPoint { y: self.lo.y, ..p },
            GridPoint { y: self.hi.y, ..p },
        ];
        let nearest = sides.into_iter().min_by(|a, b| a.distance_m(p).total_cmp(&b.distance_m(p)));
        nearest.unwrap_or(p)
    }

    /// Width, height and whole length of the boundary in millimetres.
    fn size(&self) -> (i64, i64, i64) {
        let (w, h) = (
            i64::from(self.hi.x) - i64::from(self.lo.x),
            i64::from(self.hi.y) - i64::from(self.lo.y),
        );
        (w, h, 2 * (w + h))
    }

    /// Millimetres clockwise along the boundary to a point on it.
    fn along(&self, p: GridPoint) -> i64 {
        let (w, h, _) = self.size();
        let d = |a: i32, b: i32| i64::from(a) - i64::from(b);
        match p {
            p if p.y >= self.hi.y => d(p.x, self.lo.x),
            p if p.x >= self.hi.x => w + d(self.hi.y, p.y),
            p if p.y <= self.lo.y => w + h + d(self.hi.x, p.x),
            p => 2 * w + h + d(p.y, self.lo.y),
        }
    }

    /// Joins runs along the boundary to rings; also the number of runs that give none.
    fn follow(&self, runs: Vec<Vec<GridPoint>>) -> (Vec<Polygon>, usize) {
        let (w, h, total) = self.size();
        let corners = [
            (0, GridPoint { x: self.lo.x, y: self.hi.y }),
            (w, self.hi),
            (w + h, GridPoint { x: self.hi.x, y: self.lo.y }),
            (2 * w + h, self.lo),
        ];
        let ahead = |from: i64, to: i64| (to - from).rem_euclid(total);
        let entries: Vec<i64> = runs.iter().map(|r| self.along(r[0])).collect();
        let mut used = vec![false; runs.len()];
        let (mut out, mut dropped) = (Vec::new(), 0);
        for first in 0..runs.len() {
            let mut ring: Vec<GridPoint> = Vec::new();
            let (mut run, mut count) = (first, 0);
            while !used[run] {
                used[run] = true;
                count += 1;
                ring.extend(&runs[run]);
                let exit = self.along(runs[run][runs[run].len() - 1]);
                let Some(next) = (0..runs.len()).min_by_key(|i| ahead(exit, entries[*i])) else {
                    break;
                };
                let mut turns: Vec<(i64, GridPoint)> = corners
                    .iter()
                    .map(|(at, corner)| (ahead(exit, *at), *corner))
                    .filter(|(at, _)| *at < ahead(exit, entries[next]))
                    .collect();
                turns.sort_unstable_by_key(|(at, _)| *at);
                ring.extend(turns.into_iter().map(|(_, corner)| corner));
                run = next;
            }
            // A walk that ends in another's run has taken an exit for an entry: broken data.
            if count > 0 && run == first {
                out.extend(Polygon::new(ring, Vec::new()));
            } else {
                dropped += count;
            }
        }
        (out, dropped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)]) -> Vec<Vertex> {
        let vertex = |(x, y): &(f64, f64)| {
            let p = GridPoint::m(*x, *y);
            (i64::from(p.x) * 1_000_000_000 + i64::from(p.y), p)
        };
        points.iter().map(vertex).collect()
    }

    fn map() -> Polygon {
        Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(1000.0, 1000.0))
    }

    fn area(ways: &[&[(f64, f64)]]) -> (f64, usize) {
        let sea = close(ways.iter().map(|w| line(w)).collect(), &map());
        assert!(sea.polygons.iter().all(Polygon::is_valid));
        (sea.polygons.iter().map(Polygon::area_m2).sum(), sea.dropped)
    }

    #[test]
    fn the_water_lies_on_the_right() {
        // Northwards through the middle: the east is sea; southwards: the west.
        assert_eq!(area(&[&[(600.0, -50.0), (600.0, 1050.0)]]), (400_000.0, 0));
        assert_eq!(area(&[&[(600.0, 1050.0), (600.0, -50.0)]]), (600_000.0, 0));
        // In two pieces, the second one first.
        let pieces: [&[_]; 2] =
            [&[(600.0, 500.0), (600.0, 1050.0)], &[(600.0, -50.0), (600.0, 500.0)]];
        assert_eq!(area(&pieces), (400_000.0, 0));
    }

    #[test]
    fn a_bay_and_a_peninsula() {
        // A strait between two coasts, and a corner of sea.
        let strait: [&[_]; 2] =
            [&[(400.0, -9.0), (400.0, 1009.0)], &[(600.0, 1009.0), (600.0, -9.0)]];
        assert_eq!(area(&strait), (200_000.0, 0));
        let corner: [&[_]; 1] = [&[(900.0, -9.0), (900.0, 100.0), (1009.0, 100.0)]];
        assert_eq!(area(&corner), (10_000.0, 0));
        let land: [&[_]; 1] = [&[(1009.0, 100.0), (900.0, 100.0), (900.0, -9.0)]];
        assert_eq!(area(&land), (990_000.0, 0));
    }

    #[test]
    fn islands_are_holes_and_alone_lie_in_the_sea() {
        let island: &[_] = &[(100., 100.), (300., 100.), (300., 300.), (100., 300.), (100., 100.)];
        assert_eq!(area(&[island]), (960_000.0, 0));
        let coast: &[_] = &[(600.0, 1050.0), (600.0, -50.0)];
        assert_eq!(area(&[island, coast]), (560_000.0, 0));
        let lagoon: Vec<_> = island.iter().rev().copied().collect();
        assert_eq!(area(&[&lagoon]), (40_000.0, 0));
    }

    #[test]
    fn a_ring_across_the_edge_is_cut_there() {
        // An island half outside, once beginning inside and once outside.
        let ring = [(500., 100.), (1500., 100.), (1500., 300.), (500., 300.), (500., 100.)];
        assert_eq!(area(&[&ring]), (900_000.0, 0));
        let turned: Vec<_> = [&ring[1..4], &ring[..2]].concat();
        assert_eq!(area(&[&turned]), (900_000.0, 0));
    }

    #[test]
    fn loose_ends_are_led_out_or_dropped() {
        assert_eq!(area(&[&[(600.0, 40.0), (600.0, 1050.0)]]), (400_000.0, 0));
        assert_eq!(area(&[&[(600.0, 500.0), (600.0, 1050.0)]]), (0.0, 1));
    }
}
