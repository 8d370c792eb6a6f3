//! Segments near a segment, for linework that does not change.
//!
//! A uniform grid, built once and hashed into one flat table, so that neither far outliers nor empty
//! land cost memory. For linework that comes and goes see [`crate::segment_index`]. Building is
//! O(cells passed), a query O(cells passed + found).

use crate::{GridPoint, cell_table::CellTable};

/// A fixed set of segments, numbered in the order given.
#[derive(Clone, Debug)]
pub struct SegmentGrid {
    segments: Vec<(GridPoint, GridPoint)>,
    table: CellTable,
}

/// Cells are at least this wide, so that heaps of tiny segments do not make a fine grid.
const LEAST_CELL_MM: f64 = 2_000.0;

impl SegmentGrid {
    /// The index of `segments`. Cells are as wide as the mean segment is long.
    pub fn new(segments: Vec<(GridPoint, GridPoint)>) -> Self {
        let total: f64 = segments.iter().map(|(a, b)| a.distance_m(*b) * 1000.0).sum();
        let mean_mm = total / segments.len().max(1) as f64;
        let cell_mm = mean_mm.max(LEAST_CELL_MM) as i64;
        let table = CellTable::new(cell_mm, segments.len(), |table, put| {
            for (id, (a, b)) in segments.iter().enumerate() {
                for_cells(table, *a, *b, 0, |slot| put(slot, id as u32));
            }
        });
        Self { segments, table }
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
        self.near_of(a, b, margin_mm, |_| true, out);
    }

    /// As [`SegmentGrid::near`], of the segments that are `wanted` alone.
    pub fn near_of(
        &self,
        a: GridPoint,
        b: GridPoint,
        margin_mm: i32,
        wanted: impl Fn(u32) -> bool,
        out: &mut Vec<u32>,
    ) {
        out.clear();
        let (lo_x, hi_x) = (a.x.min(b.x) - margin_mm, a.x.max(b.x) + margin_mm);
        let (lo_y, hi_y) = (a.y.min(b.y) - margin_mm, a.y.max(b.y) + margin_mm);
        for_cells(&self.table, a, b, margin_mm, |slot| {
            for id in self.table.list(slot) {
                let (c, d) = self.segments[*id as usize];
                let apart = c.x.max(d.x) < lo_x
                    || hi_x < c.x.min(d.x)
                    || c.y.max(d.y) < lo_y
                    || hi_y < c.y.min(d.y);
                if !apart && wanted(*id) {
                    out.push(*id);
                }
            }
        });
        out.sort_unstable();
        out.dedup();
    }
}

/// The slots of the cells within `margin_mm` of the segment, row by row.
fn for_cells(
    table: &CellTable,
    a: GridPoint,
    b: GridPoint,
    margin_mm: i32,
    mut f: impl FnMut(u32),
) {
    // A millimetre more covers the rounding of the row cuts below.
    let margin = i64::from(margin_mm) + 1;
    let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
    let (ax, ay) = (i64::from(a.x), i64::from(a.y));
    let (bx, by) = (i64::from(b.x), i64::from(b.y));
    let (west, east) = (table.cell(ax.min(bx) - margin), table.cell(ax.max(bx) + margin));
    let (south, north) = (table.cell(ay - margin), table.cell(by + margin));
    for row in south..=north {
        let (mut first, mut last) = (west, east);
        if south != north && west != east {
            // The part of the segment within this row, grown by the margin.
            let floor = table.border_mm(row);
            let x_at = |y: i64| {
                let t = (y - ay) as f64 / (by - ay).max(1) as f64;
                ax + ((bx - ax) as f64 * t.clamp(0.0, 1.0)) as i64
            };
            let (p, q) = (x_at(floor - margin), x_at(floor + table.cell_mm() + margin));
            first = first.max(table.cell(p.min(q) - margin));
            last = last.min(table.cell(p.max(q) + margin));
        }
        for column in first..=last {
            f(table.slot(column, row));
        }
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
