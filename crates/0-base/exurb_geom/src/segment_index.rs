//! Segments near a box, while segments come and go.
//!
//! A uniform grid of cells that list the segments passing through their box. Growth asks for the
//! segments near a candidate street millions of times and inserts in between; a grid answers in a
//! few list look-ups where a dynamic R-tree walks and rebalances (measured in `docs/performance.md`).

use rustc_hash::FxHashMap;

use crate::{Bounds, Vec2, polyline};

/// An index of line segments, each with a number of the caller's.
#[derive(Clone, Debug)]
pub struct SegmentIndex {
    cell_m: f64,
    cells: FxHashMap<(i32, i32), Vec<Entry>>,
    len: usize,
}

/// A stored segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The caller's number.
    pub id: u32,
    /// One end, metres.
    pub a: Vec2,
    /// The other end, metres.
    pub b: Vec2,
}

impl SegmentIndex {
    /// An empty index with square cells of `cell_m`, best near the usual length of a segment.
    pub fn new(cell_m: f64) -> Self {
        Self { cell_m, cells: FxHashMap::default(), len: 0 }
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Is it empty?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Adds the segment `a b` as `id`.
    pub fn insert(&mut self, id: u32, a: Vec2, b: Vec2) {
        self.len += 1;
        for cell in self.cells_of_segment(a, b) {
            self.cells.entry(cell).or_default().push(Entry { id, a, b });
        }
    }

    /// Adds every segment of `line` as `id`.
    pub fn insert_line(&mut self, id: u32, line: &[Vec2]) {
        for w in line.windows(2) {
            self.insert(id, w[0], w[1]);
        }
    }

    /// Removes all segments of `line` that were added as `id`.
    pub fn remove_line(&mut self, id: u32, line: &[Vec2]) {
        for w in line.windows(2) {
            let mut found = false;
            for cell in self.cells_of_segment(w[0], w[1]) {
                if let Some(list) = self.cells.get_mut(&cell)
                    && let Some(at) =
                        list.iter().position(|e| e.id == id && e.a == w[0] && e.b == w[1])
                {
                    list.remove(at);
                    found = true;
                }
            }
            self.len -= usize::from(found);
        }
    }

    /// Calls `visit` for the segments whose boxes meet `bounds`, in order of cells and insertion,
    /// until it returns `false`. A segment over several cells may come more than once.
    pub fn visit(&self, bounds: Bounds, mut visit: impl FnMut(&Entry) -> bool) {
        let (lo, hi) = (self.cell(bounds.min), self.cell(bounds.max));
        for y in lo.1..=hi.1 {
            for x in lo.0..=hi.0 {
                for e in self.cells.get(&(x, y)).into_iter().flatten() {
                    let segment = Bounds { min: e.a.min(e.b), max: e.a.max(e.b) };
                    if segment.intersects(bounds) && !visit(e) {
                        return;
                    }
                }
            }
        }
    }

    /// The distance from `p` to the nearest segment; `None` where that is more than `within_m`. Rings of
    /// cells around `p` until none can hold a nearer one. O(cells within the distance + segments there).
    pub fn nearest_m(&self, p: Vec2, within_m: f64) -> Option<f64> {
        let (x, y) = self.cell(p);
        let mut best = within_m;
        let mut found = false;
        for ring in 0_i32.. {
            // Whatever lies in this ring and beyond is at least this far.
            if f64::from(ring - 1) * self.cell_m > best {
                break;
            }
            for dy in -ring..=ring {
                let step = if dy.abs() == ring { 1 } else { (2 * ring).max(1) };
                for dx in (-ring..=ring).step_by(step as usize) {
                    for e in self.cells.get(&(x + dx, y + dy)).into_iter().flatten() {
                        let distance = polyline::nearest_on_segment(e.a, e.b, p).0.distance(p);
                        if distance <= best {
                            (best, found) = (distance, true);
                        }
                    }
                }
            }
        }
        found.then_some(best)
    }

    /// The numbers of the segments whose boxes meet `bounds`, ascending, each once.
    pub fn ids(&self, bounds: Bounds) -> Vec<u32> {
        let mut out = Vec::new();
        self.visit(bounds, |e| {
            out.push(e.id);
            true
        });
        out.sort_unstable();
        out.dedup();
        out
    }

    fn cell(&self, p: Vec2) -> (i32, i32) {
        ((p.x / self.cell_m).floor() as i32, (p.y / self.cell_m).floor() as i32)
    }

    /// The cells that the segment's line passes, row by row.
    fn cells_of_segment(&self, a: Vec2, b: Vec2) -> Vec<(i32, i32)> {
        let (lo, hi) = (self.cell(a.min(b)), self.cell(a.max(b)));
        let mut out = Vec::new();
        for y in lo.1..=hi.1 {
            if lo.0 == hi.0 || lo.1 == hi.1 {
                out.extend((lo.0..=hi.0).map(|x| (x, y)));
                continue;
            }
            // The x-range of the segment within this row, a hair wider than exact.
            let (south, north) = (f64::from(y) * self.cell_m, f64::from(y + 1) * self.cell_m);
            let at = |row: f64| {
                let t = ((row - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
                a.x + (b.x - a.x) * t
            };
            let (p, q) = (at(south), at(north));
            let first = self.cell(Vec2::new(p.min(q) - 1e-6, 0.0)).0.max(lo.0);
            let last = self.cell(Vec2::new(p.max(q) + 1e-6, 0.0)).0.min(hi.0);
            out.extend((first..=last).map(|x| (x, y)));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_segment_is_that_of_all() {
        let at = |i: i32| Vec2::new(f64::from(i * 7919 % 1999), f64::from(i * 6047 % 1801));
        let lines: Vec<[Vec2; 2]> =
            (0..60).map(|i| [at(i), at(i) + Vec2::new(f64::from(i % 9) * 12.0, 31.0)]).collect();
        let mut index = SegmentIndex::new(40.0);
        lines.iter().zip(0..).for_each(|(line, id)| index.insert_line(id, line));
        let mut far = 0;
        for p in (0..500).map(|i| at(i * 31 + 5) - 100.0) {
            let distance = |line: &[Vec2; 2]| polyline::distance(line, p);
            let least = lines.iter().map(distance).fold(f64::INFINITY, f64::min);
            let expected = (least <= 150.0).then_some(least);
            assert_eq!(index.nearest_m(p, 150.0), expected, "{p}");
            far += usize::from(expected.is_none());
        }
        assert!((50..450).contains(&far), "{far} of 500 are far from all");
    }

    #[test]
    fn a_long_diagonal_is_found_along_its_line_and_forgotten() {
        let mut index = SegmentIndex::new(10.0);
        let line = [Vec2::new(-55.0, -31.0), Vec2::new(120.0, 77.0), Vec2::new(120.0, 300.0)];
        index.insert_line(7, &line);
        for p in crate::polyline::resample(&line, 1.0) {
            assert_eq!(index.ids(Bounds { min: p - 0.5, max: p + 0.5 }), [7], "{p}");
        }
        index.remove_line(7, &line);
        assert!(index.is_empty());
        assert!(index.ids(Bounds { min: Vec2::splat(-1e3), max: Vec2::splat(1e3) }).is_empty());
    }
}
