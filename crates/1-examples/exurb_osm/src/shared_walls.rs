//! Walls that houses share, with the same corners on both sides.
//!
//! Where a corner of one house stands in the middle of another's wall, OSM's centimetre would move
//! the two apart or into each other. Mappers put the corner into both outlines; so does this.

use std::collections::BTreeSet;

use exurb_geom::{GridPoint, Polygon, SegmentGrid, polyline};

/// A corner no farther from a wall stands in it, in millimetres: OSM's centimetre could move it across.
const TOLERANCE_MM: i32 = 10;

/// The rings of all polygons, outer ones first, each with the corners of the others that stand in
/// its walls. O(n log n).
pub fn rings(polygons: &[&Polygon]) -> Vec<Vec<Vec<GridPoint>>> {
    let segments: Vec<_> = polygons.iter().flat_map(|polygon| polygon.segments()).collect();
    let guests = guests(&segments);
    let mut walls = segments.iter().zip(guests);
    polygons
        .iter()
        .map(|polygon| {
            polygon
                .rings()
                .map(|ring| {
                    let walls = walls.by_ref().take(ring.len());
                    walls.flat_map(|((a, _), guests)| with_guests(*a, guests, ring)).collect()
                })
                .collect()
        })
        .collect()
}

/// For each wall the corners of others that stand in it.
fn guests(walls: &[(GridPoint, GridPoint)]) -> Vec<Vec<GridPoint>> {
    let corners: BTreeSet<GridPoint> = walls.iter().map(|(a, _)| *a).collect();
    let grid = SegmentGrid::new(walls.to_vec());
    let mut guests = vec![Vec::new(); walls.len()];
    let mut near = Vec::new();
    for p in corners {
        near.clear();
        grid.near(p, p, TOLERANCE_MM, &mut near);
        for wall in &near {
            let (a, b) = grid.segment(*wall);
            let (at, _) = polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m());
            let stands_in = at.distance(p.to_m()) * 1000.0 <= f64::from(TOLERANCE_MM);
            if stands_in && p != a && p != b {
                guests[*wall as usize].push(p);
            }
        }
    }
    guests
}

/// A wall's first corner, then its guests in order, but for corners of the ring itself.
fn with_guests(a: GridPoint, mut guests: Vec<GridPoint>, ring: &[GridPoint]) -> Vec<GridPoint> {
    guests.retain(|guest| !ring.contains(guest));
    guests.sort_by(|p, q| a.distance_m(*p).total_cmp(&a.distance_m(*q)));
    guests.insert(0, a);
    guests
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_in_a_wall_is_a_corner_of_both() {
        let square = |x: f64, y: f64, side: f64| {
            Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + side, y + side))
        };
        // Two small houses against the wall of a large one, and one that stands apart.
        let large = square(0.0, 0.0, 20.0);
        let houses =
            [large, square(20.0, 3.0, 5.0), square(20.0, 8.0, 5.0), square(20.1, 14.0, 3.0)];
        let rings = rings(&houses.each_ref());
        let expected: Vec<GridPoint> = [
            (0.0, 0.0),
            (20.0, 0.0),
            (20.0, 3.0),
            (20.0, 8.0),
            (20.0, 13.0),
            (20.0, 20.0),
            (0.0, 20.0),
        ]
        .map(|(x, y)| GridPoint::m(x, y))
        .to_vec();
        assert_eq!(rings[0], [expected]);
        for (ring, house) in rings.iter().zip(&houses).skip(1) {
            assert_eq!(ring[0], house.exterior());
        }
    }
}
