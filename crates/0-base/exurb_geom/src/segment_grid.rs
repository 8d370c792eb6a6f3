//! Segments near a segment, for linework that does not change.
//!
//! A uniform grid whose cells are hashed into one flat table, built once: no allocation per cell,
//! and neither far outliers nor empty land cost memory. Cells that share a slot only bring
//! candidates that the box test drops. For linework that comes and goes see
//! [`crate::segment_index`]. Building is O(cells passed), a query O(cells passed + found).

use crate::{GridPoint, grid::LIMIT_MM};

/// A fixed set of segments, numbered in the order given.
#[derive(Clone, Debug)]
pub struct SegmentGrid {
    segments: Vec<(GridPoint, GridPoint)>,
    cell_mm: i64,
    mask: u64,
    /// Slot → range of `items`.
    starts: Vec<u32>,
    items: Vec<u32>,
}

/// Cells are at least this wide, so that heaps of tiny segments do not make a fine grid.
const LEAST_CELL_MM: f64 = 5_000.0;

impl SegmentGrid {
    /// The index of `segments`. Cells are as wide as the mean segment is long.
    pub fn new(segments: Vec<(GridPoint, GridPoint)>) -> Self {
        let total: f64 = segments.iter().map(|(a, b)| a.distance_m(*b) * 1000.0).sum();
        let mean_mm = total / segments.len().max(1) as f64;
        let cell_mm = mean_mm.max(LEAST_CELL_MM) as i64;
        let slots = (segments.len() * 2).next_power_of_two().max(16);
        let mut grid = Self {
            cell_mm,
            mask: slots as u64 - 1,
            starts: vec![0; slots + 1],
            items: Vec::new(),
            segments,
        };
        // Count, sum up, fill: the table by slots in one array.
        let mut entries: Vec<(u32, u32)> = Vec::with_capacity(grid.segments.len() * 2);
        for (id, (a, b)) in grid.segments.iter().enumerate() {
            grid.for_cells(*a, *b, 0, |slot| entries.push((slot, id as u32)));
        }
        for (slot, _) in &entries {
            grid.starts[*slot as usize + 1] += 1;
        }
        for slot in 0..slots {
            grid.starts[slot + 1] += grid.starts[slot];
        }
        grid.items = vec![0; entries.len()];
        let mut next = grid.starts.clone();
        for (slot, id) in entries {
            grid.items[next[slot as usize] as usize] = id;
            next[slot as usize] += 1;
        }
        grid
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// The ends of segment `id`.
    pub fn segment(&self, id: u32) -> (GridPoint, GridPoint) {
        self.segments[id as usize]
    }

    /// Fills `out` with the segments that may come within `margin_mm` of segment `a b` (which may be
    /// a point): every one that does, and of the others only such whose boxes do. Ascending, each once.
    pub fn near(&self, a: GridPoint, b: GridPoint, margin_mm: i32, out: &mut Vec<u32>) {
        out.clear();
        let (lo_x, hi_x) = (a.x.min(b.x) - margin_mm, a.x.max(b.x) + margin_mm);
        let (lo_y, hi_y) = (a.y.min(b.y) - margin_mm, a.y.max(b.y) + margin_mm);
        self.for_cells(a, b, margin_mm, |slot| {
            let range =
                self.starts[slot as usize] as usize..self.starts[slot as usize + 1] as usize;
            for id in &self.items[range] {
                let (c, d) = self.segments[*id as usize];
                let apart = c.x.max(d.x) < lo_x
                    || hi_x < c.x.min(d.x)
                    || c.y.max(d.y) < lo_y
                    || hi_y < c.y.min(d.y);
                if !apart {
                    out.push(*id);
                }
            }
        });
        out.sort_unstable();
        out.dedup();
    }

    /// The slots of the cells within `margin_mm` of the segment, row by row.
    fn for_cells(&self, a: GridPoint, b: GridPoint, margin_mm: i32, mut f: impl FnMut(u32)) {
        // A millimetre more covers the rounding of the row cuts below.
        let margin = i64::from(margin_mm) + 1;
        let cell = |v: i64| (v + 2 * i64::from(LIMIT_MM)) / self.cell_mm;
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (ax, ay) = (i64::from(a.x), i64::from(a.y));
        let (bx, by) = (i64::from(b.x), i64::from(b.y));
        let (lo_x, hi_x) = (ax.min(bx) - margin, ax.max(bx) + margin);
        let (west, east) = (cell(lo_x), cell(hi_x));
        let (south, north) = (cell(ay - margin), cell(by + margin));
        for row in south..=north {
            let (mut first, mut last) = (west, east);
            if south != north && west != east {
                // The part of the segment within this row, grown by the margin.
                let floor = row * self.cell_mm - 2 * i64::from(LIMIT_MM);
                let x_at = |y: i64| {
                    let t = (y - ay) as f64 / (by - ay).max(1) as f64;
                    ax + ((bx - ax) as f64 * t.clamp(0.0, 1.0)) as i64
                };
                let (p, q) = (x_at(floor - margin), x_at(floor + self.cell_mm + margin));
                first = first.max(cell(p.min(q) - margin));
                last = last.min(cell(p.max(q) + margin));
            }
            for column in first..=last {
                f(self.slot(column, row));
            }
        }
    }

    fn slot(&self, column: i64, row: i64) -> u32 {
        let mixed = (column as u64)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .wrapping_add((row as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
        ((mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 32 & self.mask) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyline::segment_distance;

    #[test]
    fn every_segment_within_the_margin_is_found() {
        // Odd lengths and slopes from a few kilometres to a few metres.
        let segments: Vec<_> = (0..400)
            .map(|i: i32| {
                let (x, y) = ((i * 7919) % 200_003 - 100_000, (i * 104_729) % 180_001 - 90_000);
                let (u, v) = ((i * 31_337) % 60_013 - 30_000, (i * 27_644) % 50_021 - 25_000);
                let scale = if i % 10 == 0 { 40 } else { 1 };
                (GridPoint { x, y }, GridPoint { x: x + u * scale, y: y + v * scale })
            })
            .collect();
        let grid = SegmentGrid::new(segments.clone());
        let mut found = Vec::new();
        for (a, b) in &segments {
            grid.near(*a, *b, 700, &mut found);
            for (id, (c, d)) in segments.iter().enumerate() {
                if segment_distance(a.to_m(), b.to_m(), c.to_m(), d.to_m()) <= 0.7 {
                    assert!(found.binary_search(&(id as u32)).is_ok(), "{a:?} {b:?} {id}");
                }
            }
        }
    }
}
