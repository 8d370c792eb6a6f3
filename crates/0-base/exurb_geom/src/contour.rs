//! Areas of a grid of values below a threshold, by marching squares (`contour`).

use contour::ContourBuilder;

use crate::{Polygon, Vec2, convert, overlay};

/// Missing values, and those beyond the grid's edge, count as this far above the threshold: areas
/// close beside them.
const BARRIER: f64 = 1e9;

/// A grid of values: rows from the south, columns from the west.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// Row by row; NaN is no value.
    pub values: &'a [f32],
    /// Values in a row; `values` holds whole rows.
    pub columns: usize,
    /// Place of the first value, in metres.
    pub first: Vec2,
    /// Distance of neighbours in metres.
    pub step_m: f64,
}

/// The areas where the values, linear between neighbours, are at most `threshold`. They end at
/// values that are missing and where the grid ends. Sorted, largest first. O(values).
pub fn below(grid: Values<'_>, threshold: f32) -> Vec<Polygon> {
    let rows = grid.values.len().checked_div(grid.columns).unwrap_or(0);
    let (wide, high) = (grid.columns + 2, rows + 2);
    let mut depth = vec![-BARRIER; wide * high];
    for (row, values) in grid.values.chunks_exact(grid.columns.max(1)).enumerate() {
        for (column, value) in values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
            // The library finds what lies above; half an ulp's worth keeps equal values inside.
            depth[(row + 1) * wide + column + 1] = f64::from(threshold) - f64::from(*value) + 1e-9;
        }
    }
    // The library counts from the corners of cells whose middles bear the values.
    let corner = grid.first - Vec2::splat(1.5 * grid.step_m);
    let found = ContourBuilder::new(wide, high, true)
        .x_origin(corner.x)
        .y_origin(corner.y)
        .x_step(grid.step_m)
        .y_step(grid.step_m)
        .contours(&depth, &[0.0]);
    let areas = found.into_iter().flatten().map(|area| area.into_inner().0);
    areas.flat_map(convert::from_geo).flat_map(|area| overlay::repair(&area)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GridPoint;

    /// A cone with its foot in the middle: heights are distances.
    fn cone(n: usize, step_m: f64, middle: Vec2) -> Vec<f32> {
        let place = |i: usize| Vec2::new((i % n) as f64, (i / n) as f64) * step_m;
        (0..n * n).map(|i| place(i).distance(middle) as f32).collect()
    }

    #[test]
    fn the_area_below_a_cone_s_contour_is_a_disc() {
        let middle = Vec2::new(203.0, 197.0);
        let values = cone(41, 10.0, middle);
        let grid = Values { values: &values, columns: 41, first: Vec2::ZERO, step_m: 10.0 };
        let disc = below(grid, 100.0);
        assert_eq!(disc.len(), 1);
        assert!((disc[0].area_m2() / (100.0 * 100.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
        for p in disc[0].exterior() {
            assert!((p.to_m().distance(middle) - 100.0).abs() < 0.3, "{p:?}");
        }
        assert!(disc[0].is_valid() && below(grid, -1.0).is_empty());
    }

    #[test]
    fn areas_end_where_values_are_missing_and_at_the_edge() {
        let mut values = vec![0.0; 100];
        values[55] = f32::NAN;
        let grid = Values { values: &values, columns: 10, first: Vec2::ZERO, step_m: 10.0 };
        let found = below(grid, 1.0);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].interiors().len(), 1, "around the missing value");
        let bounds = found[0].bounds();
        assert!(bounds.min.abs_diff_eq(Vec2::ZERO, 0.01), "{bounds:?}");
        assert!(bounds.max.abs_diff_eq(Vec2::splat(90.0), 0.01), "{bounds:?}");
        assert!(!found[0].contains(GridPoint::m(50.0, 50.0)));
        assert!(found[0].contains(GridPoint::m(20.0, 50.0)));
    }
}
