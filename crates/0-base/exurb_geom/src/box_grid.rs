//! Boxes that meet a box, for a set that does not change: outlines of buildings, blocks, parcels.
//!
//! As [`crate::segment_grid`]: a uniform grid, cells as wide as the mean box, hashed into one table.

use crate::{GridPoint, Polygon, cell_table::CellTable};

/// A fixed set of axis-parallel boxes, numbered in the order given.
#[derive(Clone, Debug)]
pub struct BoxGrid {
    boxes: Vec<(GridPoint, GridPoint)>,
    table: CellTable,
}

/// A box over more cells than this is looked at by every query instead of being listed.
const MOST_CELLS: i64 = 1024;
/// Cells are at least this wide.
const LEAST_CELL_MM: i64 = 5_000;

impl BoxGrid {
    /// The index of boxes given by their south-west and north-east corners.
    pub fn new(boxes: Vec<(GridPoint, GridPoint)>) -> Self {
        let total: i64 = boxes.iter().map(|(lo, hi)| width(*lo, *hi)).sum();
        let cell_mm = (total / boxes.len().max(1) as i64).max(LEAST_CELL_MM);
        let table = CellTable::new(cell_mm, boxes.len(), |table, put| {
            for (id, (lo, hi)) in boxes.iter().enumerate() {
                match slots(table, *lo, *hi) {
                    Some(found) => found.for_each(|slot| put(slot, id as u32)),
                    None => put(table.slot(-1, -1), id as u32),
                }
            }
        });
        Self { boxes, table }
    }

    /// The index of the boxes around `polygons`.
    pub fn of<'a>(polygons: impl IntoIterator<Item = &'a Polygon>) -> Self {
        Self::new(polygons.into_iter().map(corners).collect())
    }

    /// Fills `out` with the boxes that share a point with the box from `lo` to `hi`, ascending.
    pub fn meeting(&self, lo: GridPoint, hi: GridPoint, out: &mut Vec<u32>) {
        out.clear();
        let meets = |id: &u32| {
            let (a, b) = self.boxes[*id as usize];
            a.x <= hi.x && lo.x <= b.x && a.y <= hi.y && lo.y <= b.y
        };
        match slots(&self.table, lo, hi) {
            Some(found) => {
                for slot in found.chain([self.table.slot(-1, -1)]) {
                    out.extend(self.table.list(slot).iter().filter(|id| meets(id)));
                }
            }
            None => out.extend((0..self.boxes.len() as u32).filter(|id| meets(id))),
        }
        out.sort_unstable();
        out.dedup();
    }

    /// [`BoxGrid::meeting`] with the box around `polygon`.
    pub fn meeting_polygon(&self, polygon: &Polygon, out: &mut Vec<u32>) {
        let (lo, hi) = corners(polygon);
        self.meeting(lo, hi, out);
    }
}

/// South-west and north-east corner of the box around a polygon.
fn corners(polygon: &Polygon) -> (GridPoint, GridPoint) {
    let ring = polygon.exterior();
    ring.iter().fold((ring[0], ring[0]), |(lo, hi), p| {
        let lo = GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) };
        (lo, GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) })
    })
}

fn width(lo: GridPoint, hi: GridPoint) -> i64 {
    i64::from(hi.x - lo.x).max(i64::from(hi.y - lo.y))
}

/// The slots of the cells that a box covers; `None` when they are too many.
fn slots(
    table: &CellTable,
    lo: GridPoint,
    hi: GridPoint,
) -> Option<impl Iterator<Item = u32> + '_> {
    let (west, east) = (table.cell(i64::from(lo.x)), table.cell(i64::from(hi.x)));
    let (south, north) = (table.cell(i64::from(lo.y)), table.cell(i64::from(hi.y)));
    let count = (east - west + 1) * (north - south + 1);
    (count <= MOST_CELLS).then(|| {
        (south..=north)
            .flat_map(move |row| (west..=east).map(move |column| table.slot(column, row)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boxes_found_are_those_that_meet() {
        let boxes: Vec<_> = (0..500i32)
            .map(|i| {
                let (x, y) = ((i * 7919) % 400_009, (i * 104_729) % 390_001);
                let side = if i % 50 == 0 { 9_000_000 } else { 1_000 + (i * 631) % 30_000 };
                (GridPoint { x, y }, GridPoint { x: x + side, y: y + side / 2 })
            })
            .collect();
        let grid = BoxGrid::new(boxes.clone());
        let mut found = Vec::new();
        for (lo, hi) in &boxes {
            grid.meeting(*lo, *hi, &mut found);
            let expected: Vec<u32> = (0..boxes.len() as u32)
                .filter(|id| {
                    let (a, b) = boxes[*id as usize];
                    a.x <= hi.x && lo.x <= b.x && a.y <= hi.y && lo.y <= b.y
                })
                .collect();
            assert_eq!(found, expected);
        }
    }
}
