//! Carriageways that leave room for the buildings beside them.
//!
//! Maps draw streets as lines and seldom tell how wide they are; the width by class then runs under
//! the facades of narrow lanes. Hartmann 2018, section 5.1, needs the kerb between the two.

use exurb_geom::{GridPoint, SegmentGrid, polyline};
use exurb_graph::EdgeId;
use rayon::prelude::*;

use crate::{Building, StreetGraph};

/// Kept free between kerb and facade, in metres.
const CLEAR_M: f64 = 0.1;
/// A building nearer to the centreline stands across the street and narrows nothing, in metres.
const ACROSS_M: f64 = 0.15;

/// Narrows every street on the ground so that half its width is no more than the distance from its
/// centreline to the nearest facade less 0.1 m. Buildings that a street runs through are passed over.
/// Widths come in whole centimetres, rounded down, so that doing it again changes nothing.
/// O(outlines + streets near them).
pub fn narrow_streets(streets: &mut StreetGraph, buildings: &[Building]) {
    let (mut owners, mut segments): (Vec<EdgeId>, Vec<_>) = (Vec::new(), Vec::new());
    let mut widest_m: f64 = 0.0;
    for (id, edge) in streets.edges().filter(|(_, e)| e.data.crossing_level() >= 0) {
        widest_m = widest_m.max(edge.data.width_m());
        segments.extend(edge.line().windows(2).map(|w| (w[0], w[1])));
        owners.resize(segments.len(), id);
    }
    let grid = SegmentGrid::new(segments);
    let reach_mm = ((widest_m / 2.0 + CLEAR_M) * 1000.0) as i32;
    let free = |building: &Building| nearest_streets(building, &grid, &owners, reach_mm);
    let found: Vec<Vec<(EdgeId, f64)>> =
        buildings.par_iter().filter(|b| !b.is_part).map(free).collect();
    for (id, distance_m) in found.into_iter().flatten() {
        let width_m = ((distance_m - CLEAR_M) * 200.0).floor() / 100.0;
        let street = &mut streets.edge_mut(id).data;
        if distance_m > ACROSS_M && width_m < street.width_m() {
            street.width_m = width_m.max(0.01);
        }
    }
}

/// The streets within reach of a building with their distances, by number.
fn nearest_streets(
    building: &Building,
    grid: &SegmentGrid,
    owners: &[EdgeId],
    reach_mm: i32,
) -> Vec<(EdgeId, f64)> {
    let mut out: Vec<(EdgeId, f64)> = Vec::new();
    let mut near = Vec::new();
    let m = GridPoint::to_m;
    for (a, b) in building.polygon.segments() {
        grid.near(a, b, reach_mm, &mut near);
        for i in &near {
            let (c, d) = grid.segment(*i);
            let distance_m = polyline::segment_distance(m(a), m(b), m(c), m(d));
            out.push((owners[*i as usize], distance_m));
        }
    }
    out.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    out.dedup_by_key(|found| found.0);
    out
}

#[cfg(test)]
mod tests {
    use exurb_geom::Polygon;

    use super::*;
    use crate::{Class, Provenance, Street, street_graph};

    fn width_beside(houses: &[(f64, f64)]) -> f64 {
        let line = vec![GridPoint::m(0.0, 0.0), GridPoint::m(100.0, 0.0)];
        let street = Street { class: Class::Residential, ..Street::default() };
        let mut streets = street_graph::from_lines([(line, street)]);
        let house = |&(low, high): &(f64, f64)| {
            let outline = Polygon::rectangle(GridPoint::m(40.0, low), GridPoint::m(50.0, high));
            Building::new(1, outline, Provenance::default())
        };
        let houses: Vec<Building> = houses.iter().map(house).collect();
        narrow_streets(&mut streets, &houses);
        let once = streets.edges().map(|(_, e)| e.data.width_m()).collect::<Vec<_>>();
        narrow_streets(&mut streets, &houses);
        assert_eq!(once, streets.edges().map(|(_, e)| e.data.width_m()).collect::<Vec<_>>());
        once[0]
    }

    #[test]
    fn the_nearest_facade_narrows_the_street() {
        assert_eq!(width_beside(&[]), 6.0);
        assert_eq!(width_beside(&[(4.0, 12.0)]), 6.0);
        assert_eq!(width_beside(&[(4.0, 12.0), (-9.0, -2.0)]), 3.8);
        assert_eq!(width_beside(&[(0.2, 12.0)]), 0.2);
    }

    #[test]
    fn a_building_across_the_street_narrows_nothing() {
        assert_eq!(width_beside(&[(-3.0, 3.0)]), 6.0);
        assert_eq!(width_beside(&[(0.12, 3.0)]), 6.0);
    }
}
