//! A quick look at validity that settles nearly all polygons.

use crate::{GridPoint, Polygon, SegmentGrid, grid};

/// Up to this many segments all pairs are looked at; above, those that a grid finds near.
const FEW: usize = 40;

/// Do no two segments share a point but the vertex between neighbours, and do the holes lie inside,
/// apart from each other? Exact. Polygons that fail may still be valid (a hole may touch the outer
/// ring in a point). O(n²) for few segments, else O(n).
pub fn is_plainly_valid(polygon: &Polygon) -> bool {
    let segments: Vec<(GridPoint, GridPoint)> = polygon.segments().collect();
    // Of every segment the next one in its ring.
    let mut next = Vec::with_capacity(segments.len());
    for ring in polygon.rings() {
        let start = next.len();
        next.extend((1..ring.len()).map(|i| start + i));
        next.push(start);
    }
    let apart = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (segments[i], segments[j]);
        if next[i] == j {
            next[j] != i && !grid::on_segment(a, b, d) && !grid::on_segment(c, d, a)
        } else if next[j] == i {
            !grid::on_segment(a, b, c) && !grid::on_segment(c, d, b)
        } else {
            !boxes_meet(a, b, c, d) || !grid::intersects(a, b, c, d)
        }
    };
    let free = if segments.len() <= FEW {
        (1..segments.len()).all(|j| (0..j).all(|i| apart(i, j)))
    } else {
        let index = SegmentGrid::new(segments.clone());
        let mut near = Vec::new();
        (0..segments.len()).all(|j| {
            index.near(segments[j].0, segments[j].1, 0, &mut near);
            near.iter().all(|i| *i as usize >= j || apart(*i as usize, j))
        })
    };
    free && holes_nest(polygon)
}

/// With no boundary meeting another, one point of each hole tells where it lies.
fn holes_nest(polygon: &Polygon) -> bool {
    let holes = polygon.interiors();
    let inside = |ring: &[GridPoint], p: GridPoint| {
        (0..ring.len()).fold(false, |inside, i| {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let crossed = (a.y > p.y) != (b.y > p.y) && (grid::orient(a, b, p) > 0) == (b.y > a.y);
            inside ^ crossed
        })
    };
    holes.iter().enumerate().all(|(i, hole)| {
        inside(polygon.exterior(), hole[0])
            && holes.iter().enumerate().all(|(j, other)| i == j || !inside(other, hole[0]))
    })
}

fn boxes_meet(a: GridPoint, b: GridPoint, c: GridPoint, d: GridPoint) -> bool {
    a.x.min(b.x) <= c.x.max(d.x)
        && c.x.min(d.x) <= a.x.max(b.x)
        && a.y.min(b.y) <= c.y.max(d.y)
        && c.y.min(d.y) <= a.y.max(b.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert;
    use geo::Validation;
    use proptest::prelude::*;

    /// In whole metres, which the library's floating point holds exactly: in millimetres it can take
    /// three points on a line for a corner.
    fn ring(points: &[(i32, i32)]) -> Vec<GridPoint> {
        points.iter().map(|(x, y)| GridPoint { x: *x * 1000, y: *y * 1000 }).collect()
    }

    #[test]
    fn a_spike_is_no_corner_in_millimetres_either() {
        let spike = [(21, 14), (23, 10), (22, 12), (0, 0)].map(|(x, y)| GridPoint { x, y });
        let polygon = Polygon::new(spike.to_vec(), vec![]).expect("has area");
        assert!(!is_plainly_valid(&polygon));
    }

    proptest! {
        #[test]
        fn what_passes_is_valid_for_the_library_too(
            outer in prop::collection::vec((0i32..30, 0i32..30), 3..9),
            hole in prop::collection::vec((5i32..25, 5i32..25), 3..5),
        ) {
            let polygon = Polygon::new(ring(&outer), vec![ring(&hole)]);
            if let Some(polygon) = polygon && is_plainly_valid(&polygon) {
                prop_assert!(convert::to_geo(&polygon).is_valid());
            }
            // Without holes the answers agree both ways.
            if let Some(polygon) = Polygon::new(ring(&outer), vec![]) {
                let library = convert::to_geo(&polygon).is_valid();
                prop_assert_eq!(is_plainly_valid(&polygon), library);
            }
        }
    }

    #[test]
    fn long_rings_are_looked_at_through_the_grid() {
        let star: Vec<GridPoint> = (0..200)
            .map(|i| {
                let radius = if i % 2 == 0 { 90.0 } else { 60.0 };
                GridPoint::round(crate::trig::unit(f64::from(i) * 0.031_4) * radius)
            })
            .collect();
        let plain = Polygon::new(star.clone(), vec![]).expect("has area");
        assert!(is_plainly_valid(&plain));
        let mut crossed = star;
        crossed.swap(50, 53);
        let crossed = Polygon::new(crossed, vec![]).expect("has area");
        assert!(!is_plainly_valid(&crossed));
    }
}
