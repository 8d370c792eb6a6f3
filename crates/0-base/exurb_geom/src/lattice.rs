//! Points of a square grid inside a polygon: for shares and means over its area.

use crate::{Bounds, GridPoint, Polygon};

impl Polygon {
    /// The middles of those cells of a grid of `step_m` metres, laid from its south-west corner, that
    /// lie inside; its interior point where the grid misses it. Row by row from the south, between
    /// the crossings of the boundary: O(rows · vertices + points).
    pub fn lattice(&self, step_m: f64) -> Vec<GridPoint> {
        let Bounds { min, max } = self.bounds();
        let mut out = Vec::new();
        let mut crossings: Vec<f64> = Vec::new();
        for row in 0..=((max.y - min.y) / step_m) as u32 {
            let y = min.y + (f64::from(row) + 0.5) * step_m;
            let cut = self.segments().map(|(a, b)| (a.to_m(), b.to_m()));
            crossings.clear();
            crossings.extend(
                cut.filter(|(a, b)| (a.y > y) != (b.y > y))
                    .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)),
            );
            crossings.sort_by(f64::total_cmp);
            for inside in crossings.chunks_exact(2) {
                let column = |x: f64| (x - min.x) / step_m - 0.5;
                let (first, last) =
                    (column(inside[0]).ceil() as i64, column(inside[1]).floor() as i64);
                let x = |i: i64| min.x + (i as f64 + 0.5) * step_m;
                out.extend((first..=last).map(|i| GridPoint::m(x(i), y)));
            }
        }
        if out.is_empty() {
            out.push(GridPoint::round(self.interior_point()));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_inside_and_their_number_gives_the_area() {
        let ring = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (10.0, 10.0), (10.0, 40.0), (0.0, 40.0)];
        let ring = ring.map(|(x, y)| GridPoint::m(x, y)).to_vec();
        let l = Polygon::new(ring, vec![]).expect("has area");
        let points = l.lattice(0.5);
        assert_eq!(points.len() as f64 * 0.25, l.area_m2());
        assert!(points.iter().all(|p| l.contains(*p)));
        assert_eq!(l.lattice(1000.0), [GridPoint::round(l.interior_point())]);
    }
}
