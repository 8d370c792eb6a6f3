//! Where a border cut the streets of files that do not say where they are complete.
//!
//! Whoever clips a map leaves ends of streets in straight rows, turned as the coordinates of the one who
//! clipped. Such a row lies on the convex hull of the streets; dead ends of a town do not stand in rows.

use exurb_geom::oriented_box::convex_hull;
use exurb_geom::{GridPoint, Vec2, polyline, trig};

/// Ends this near a side of the hull lie on it, in metres: a border that is straight in another
/// projection bends by less over 10 km.
const ON_SIDE_M: f64 = 1.0;
/// A side turns by no more than this in all, in degrees.
const STRAIGHT_DEG: f64 = 1.5;
/// So many ends stand in a row only where they were cut.
const ROW: usize = 5;

/// The ends of lines that a straight border cut. O(n log n) for n points and few sides.
pub fn cut_ends(lines: &[&[GridPoint]]) -> Vec<GridPoint> {
    let points: Vec<GridPoint> = lines.iter().copied().flatten().copied().collect();
    let hull = convex_hull(&points);
    let ends = lines.iter().filter_map(|line| Some([*line.first()?, *line.last()?]));
    let mut ends: Vec<GridPoint> = ends.flatten().collect();
    ends.sort_unstable();
    let loose = ends.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]);
    let loose: Vec<GridPoint> = loose.collect();
    let mut out = Vec::new();
    for side in sides(&hull) {
        let on_side = |p: &&GridPoint| {
            let from = |w: &[Vec2]| polyline::nearest_on_segment(w[0], w[1], p.to_m()).0;
            side.windows(2).any(|w| from(w).distance(p.to_m()) < ON_SIDE_M)
        };
        let row: Vec<GridPoint> = loose.iter().filter(on_side).copied().collect();
        if row.len() >= ROW {
            out.extend(row);
        }
    }
    out
}

/// The runs of a hull's corners that lie on about one line, from its sharpest corner on.
fn sides(hull: &[Vec2]) -> Vec<Vec<Vec2>> {
    let n = hull.len();
    if n < 3 {
        return Vec::new();
    }
    let edge = |i: usize| hull[(i + 1) % n] - hull[i % n];
    let turn = |i: usize| trig::angle_between(edge(i + n - 1), edge(i)).to_degrees();
    let start = (0..n).max_by(|i, j| turn(*i).total_cmp(&turn(*j))).unwrap_or_default();
    let mut out: Vec<Vec<Vec2>> = Vec::new();
    let mut turned = f64::INFINITY;
    for i in start..start + n {
        turned += turn(i);
        let (from, to) = (hull[i % n], hull[(i + 1) % n]);
        match out.last_mut() {
            Some(side) if turned <= STRAIGHT_DEG => side.push(to),
            _ => {
                out.push(vec![from, to]);
                turned = 0.0;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Streets across a square of 1 km that is turned by so many degrees, those of one direction bent
    /// in the middle, as whoever clips them there leaves them; and a street that ends inside.
    fn clipped(turned_deg: f64, spacing_m: f64) -> (Vec<Vec<GridPoint>>, Vec<GridPoint>) {
        let east = trig::unit(turned_deg.to_radians());
        let at = |x: f64, y: f64| GridPoint::round(east * x + east.perp() * y);
        let mut lines = vec![vec![at(3.0, 5.0), at(20.0, 40.0)]];
        let mut place = -480.0;
        while place < 490.0 {
            lines.push(vec![at(place, -500.0), at(place + 9.0, 2.0), at(place, 500.0)]);
            lines.push(vec![at(-500.0, place), at(500.0, place)]);
            place += spacing_m;
        }
        let ends = lines[1..].iter().flat_map(|l| [l[0], l[l.len() - 1]]).collect();
        (lines, ends)
    }

    proptest! {
        /// Whatever way the clip is turned, all its ends and no others are found.
        #[test]
        fn ends_in_a_row_were_cut(turned_deg in -180.0..180.0_f64, spacing_m in 40.0..150.0_f64) {
            let (lines, mut ends) = clipped(turned_deg, spacing_m);
            let lines: Vec<&[GridPoint]> = lines.iter().map(Vec::as_slice).collect();
            let mut found = cut_ends(&lines);
            found.sort_unstable();
            ends.sort_unstable();
            prop_assert_eq!(found, ends);
        }

        /// Dead ends around a town are none that were cut.
        #[test]
        fn ends_around_a_town_were_not_cut(
            reach_m in prop::collection::vec(300.0..600.0_f64, 8..40),
        ) {
            let ray = |(i, m): (usize, &f64)| {
                let angle = i as f64 / reach_m.len() as f64 * std::f64::consts::TAU;
                vec![GridPoint { x: 0, y: 0 }, GridPoint::round(trig::unit(angle) * *m)]
            };
            let lines: Vec<Vec<GridPoint>> = reach_m.iter().enumerate().map(ray).collect();
            let lines: Vec<&[GridPoint]> = lines.iter().map(Vec::as_slice).collect();
            prop_assert!(cut_ends(&lines).is_empty());
        }
    }
}
