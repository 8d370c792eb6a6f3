//! Where two grounds of one city differ.

use exurb_geom::{Bounds, GridPoint, Polygon, contour, overlay};

use super::{Terrain, TerrainError};
use crate::area::WITHOUT_STREETS;
use crate::{City, Land};

/// Places are compared this far apart, in metres.
const STEP_M: f64 = 25.0;
/// Heights and slopes that differ by less are the same.
const SAME_HEIGHT_M: f64 = 3.0;
const SAME_SLOPE: f64 = 0.05;
/// Changed ground smaller than this is left alone, and so is unchanged ground inside changed, m².
const LEAST_M2: f64 = 10_000.0;

/// The parts of the target where `new` has other ground than `old`: water, parks, heights or slopes.
/// A step of [`STEP_M`] around belongs to them, too. Errors when the target is too large for a grid.
/// O(area).
pub fn changed(old: &City, new: &City) -> Result<Vec<Polygon>, TerrainError> {
    let (before, after) = (Land::of(old), Land::of(new));
    let (parks_before, parks_after) = (parks(old), parks(new));
    let is_park = |parks: &[(Bounds, &Polygon)], p| {
        let at = GridPoint::round(p);
        parks.iter().any(|(bounds, park)| bounds.contains(p) && park.contains(at))
    };
    let differs = |p| {
        before.is_wet(p) != after.is_wet(p)
            || (before.height_m(p) - after.height_m(p)).abs() > SAME_HEIGHT_M
            || (before.slope(p) - after.slope(p)).abs() > SAME_SLOPE
            || is_park(&parks_before, p) != is_park(&parks_after, p)
    };
    let side = |p| if differs(p) { -1.0 } else { 1.0 };
    let mask = Terrain::over(new.target.bounds().grown(STEP_M), STEP_M, side)?;
    let (columns, rows) = (mask.columns(), mask.rows());
    let values = mask.heights();
    let grown: Vec<f32> = (0..values.len())
        .map(|i| {
            let (column, row) = (i % columns, i / columns);
            let around = (row.saturating_sub(1)..(row + 2).min(rows)).flat_map(|r| {
                (column.saturating_sub(1)..(column + 2).min(columns)).map(move |c| r * columns + c)
            });
            around.map(|k| values[k]).fold(1.0, f32::min)
        })
        .collect();
    let first = mask.first().to_m();
    let grid = contour::Values { values: &grown, columns, first, step_m: mask.cell_m() };
    let parts = contour::below(grid, 0.0);
    let inside = parts.iter().flat_map(|part| overlay::intersection(part, &new.target));
    let large = inside.filter(|part| part.area_m2() >= LEAST_M2);
    Ok(large.filter_map(|part| without_small_holes(&part)).collect())
}

/// Ground that streets leave alone.
fn parks(city: &City) -> Vec<(Bounds, &Polygon)> {
    let parks = city.land_use.iter().filter(|area| WITHOUT_STREETS.contains(&&*area.class));
    parks.map(|area| (area.polygon.bounds(), &area.polygon)).collect()
}

fn without_small_holes(part: &Polygon) -> Option<Polygon> {
    let is_large = |hole: &&Vec<GridPoint>| {
        let hole = Polygon::new((*hole).clone(), Vec::new());
        hole.is_some_and(|hole| hole.area_m2() >= LEAST_M2)
    };
    let holes = part.interiors().iter().filter(is_large).cloned().collect();
    Polygon::new(part.exterior().to_vec(), holes)
}

#[cfg(test)]
mod tests {
    use exurb_geom::{Frame, Vec2};

    use super::*;
    use crate::Area;

    fn city(height_m: impl Fn(Vec2) -> f64) -> City {
        let corner = GridPoint::m(1000.0, 1000.0);
        let target = Polygon::rectangle(GridPoint::m(0.0, 0.0), corner);
        let mut city = City::empty(Frame::null_island(), target);
        let bounds = city.target.bounds().grown(100.0);
        city.lay(Terrain::over(bounds, 20.0, |p| height_m(p) as f32).unwrap());
        city
    }

    #[test]
    fn changed_ground_is_where_a_hill_was_raised_and_nowhere_else() {
        let hill = |p: Vec2| (60.0 - p.distance(Vec2::new(300.0, 300.0)) * 0.4).max(0.0);
        let (flat, hilly) = (city(|_| 5.0), city(|p| 5.0 + hill(p)));
        assert_eq!(changed(&flat, &flat).unwrap(), []);
        let parts = changed(&flat, &hilly).unwrap();
        assert_eq!(parts.len(), 1);
        assert!(parts[0].contains(GridPoint::m(300.0, 300.0)));
        assert!(!parts[0].contains(GridPoint::m(550.0, 300.0)));
        let area = std::f64::consts::PI * 150.0 * 150.0;
        // A step around it belongs to it, too.
        assert!((0.8..2.0).contains(&(parts[0].area_m2() / area)), "{}", parts[0].area_m2());
    }

    #[test]
    fn a_park_is_changed_ground() {
        let plain = city(|_| 5.0);
        let mut green = plain.clone();
        let polygon = Polygon::rectangle(GridPoint::m(600.0, 600.0), GridPoint::m(800.0, 800.0));
        green.land_use = vec![Area { id: 1, polygon, class: "park".into() }].into();
        let parts = changed(&plain, &green).unwrap();
        assert_eq!(parts.len(), 1);
        assert!((200.0..280.0).contains(&parts[0].area_m2().sqrt()));
    }
}
