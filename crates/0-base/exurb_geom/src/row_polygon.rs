//! A polygon that answers quickly whether it holds a place, however many corners it has.

use crate::{GridPoint, Polygon, grid};

/// A polygon with its sides by rows.
#[derive(Clone, Debug)]
pub struct RowPolygon<'a> {
    polygon: &'a Polygon,
    sides: RowSides,
}

impl<'a> RowPolygon<'a> {
    /// Sorts the sides: see [`RowSides::new`].
    pub fn new(polygon: &'a Polygon) -> Self {
        Self { polygon, sides: RowSides::new(polygon) }
    }

    /// The polygon.
    pub fn polygon(&self) -> &'a Polygon {
        self.polygon
    }

    /// Does `p` lie inside or on the boundary? The same as [`Polygon::contains`]; O(sides in its row).
    pub fn contains(&self, p: GridPoint) -> bool {
        self.sides.contains(p)
    }
}

/// The sides of a polygon by rows, for what does not keep the polygon.
#[derive(Clone, Debug)]
pub struct RowSides {
    low_mm: i64,
    row_mm: i64,
    /// Per row where its sides end in the list.
    ends: Vec<u32>,
    /// Sides of one row after those of the other.
    sides: Vec<(GridPoint, GridPoint)>,
}

impl RowSides {
    /// Sorts the sides into about half as many rows as there are sides. O(sides · rows each crosses).
    pub fn new(polygon: &Polygon) -> Self {
        let count = (polygon.segments().count() / 2).clamp(1, 4096) as i64;
        let ys = || polygon.segments().map(|(a, _)| i64::from(a.y));
        let (low_mm, high_mm) = (ys().min().unwrap_or(0), ys().max().unwrap_or(0));
        let row_mm = ((high_mm - low_mm) / count + 1).max(1);
        let rows = |(a, b): (GridPoint, GridPoint)| {
            let row = |y: i32| ((i64::from(y) - low_mm) / row_mm) as usize;
            row(a.y.min(b.y))..=row(a.y.max(b.y))
        };
        let mut ends = vec![0u32; ((high_mm - low_mm) / row_mm + 1) as usize];
        for row in polygon.segments().flat_map(rows) {
            ends[row] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            // At first where the row begins: filling it moves that to its end.
            (sum, *end) = (sum + *end, sum);
        }
        let none = GridPoint { x: 0, y: 0 };
        let mut sides = vec![(none, none); sum as usize];
        for side in polygon.segments() {
            for row in rows(side) {
                sides[ends[row] as usize] = side;
                ends[row] += 1;
            }
        }
        Self { low_mm, row_mm, ends, sides }
    }

    /// Does `p` lie inside or on the boundary? The same as [`Polygon::contains`]; O(sides in its row).
    pub fn contains(&self, p: GridPoint) -> bool {
        let row = (i64::from(p.y) - self.low_mm).div_euclid(self.row_mm);
        let Ok(row) = usize::try_from(row) else { return false };
        let Some(&end) = self.ends.get(row) else { return false };
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        let mut inside = false;
        for &(a, b) in &self.sides[start as usize..end as usize] {
            if grid::on_segment(a, b, p) {
                return true;
            }
            if (a.y > p.y) != (b.y > p.y) {
                inside ^= (grid::orient(a, b, p) > 0) == (b.y > a.y);
            }
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_holds_what_the_polygon_holds(
            radii in prop::collection::vec(10..1000_i32, 3..60),
            places in prop::collection::vec((-1100..1100_i32, -1100..1100_i32), 40),
        ) {
            let turn = std::f64::consts::TAU / radii.len() as f64;
            let ring: Vec<GridPoint> = radii
                .iter()
                .enumerate()
                .map(|(i, r)| {
                    let p = crate::trig::unit(i as f64 * turn) * f64::from(*r);
                    GridPoint { x: p.x as i32, y: p.y as i32 }
                })
                .collect();
            let corners = ring.clone();
            if let Some(polygon) = Polygon::new(ring, vec![]) {
                let rows = RowPolygon::new(&polygon);
                let places = places.into_iter().map(|(x, y)| GridPoint { x, y });
                for p in places.chain(corners) {
                    prop_assert_eq!(rows.contains(p), polygon.contains(p), "{:?}", p);
                }
            }
        }
    }
}
