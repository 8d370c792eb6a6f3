//! Where a border cut the streets of files that do not say where they are complete.
//!
//! Whoever clips a map to a rectangle leaves ends of streets in straight rows on the outside, turned
//! like the coordinate system of the clip. Such rows lie on the convex hull of the streets, along sides
//! that meet in corners. One row alone may be cul-de-sacs of equal length, or two that lie opposite each
//! other; other shapes than rectangles leave no rows that could be told from dead ends.

use exurb_geom::oriented_box::convex_hull;
use exurb_geom::{GridPoint, SegmentGrid, Vec2, polyline, trig};

/// Ends this near a side of the hull lie on it, in metres, and as much farther as a parallel bends.
const ON_SIDE_M: f64 = 1.0;
/// Mean radius of the earth, in metres.
const EARTH_M: f64 = 6_371_000.0;
/// A side turns by no more than this in all, in degrees.
const STRAIGHT_DEG: f64 = 1.5;
/// Sides meet in a corner of at least this, in degrees.
const CORNER_DEG: f64 = 30.0;
/// A row has at least so many ends.
const ROW: usize = 5;

/// The ends of lines that the border of a rectangle at this latitude cut, whichever way it is turned.
/// Lines that are given several times count once. O(n log n) for n points.
pub fn cut_ends(lines: &[&[GridPoint]], latitude_deg: f64) -> Vec<GridPoint> {
    let points: Vec<GridPoint> = lines.iter().copied().flatten().copied().collect();
    let sides = sides(&convex_hull(&points));
    // A side of longitude and latitude is no straight line in the plane: it lies as far off its chord.
    let latitude = trig::unit(latitude_deg.to_radians());
    let bend = (latitude.y / latitude.x).abs() / (8.0 * EARTH_M);
    let reach_m: Vec<f64> =
        sides.iter().map(|s| ON_SIDE_M + bend * direction(s).length_squared()).collect();
    let pieces: Vec<(usize, &[Vec2])> =
        sides.iter().enumerate().flat_map(|(i, s)| s.windows(2).map(move |w| (i, w))).collect();
    let on_grid = |w: &[Vec2]| (GridPoint::round(w[0]), GridPoint::round(w[1]));
    let grid = SegmentGrid::new(pieces.iter().map(|(_, w)| on_grid(w)).collect());
    let margin_mm = (1000.0 * reach_m.iter().copied().fold(0.0, f64::max)).ceil() as i32;

    let mut rows: Vec<Vec<GridPoint>> = vec![Vec::new(); sides.len()];
    let mut near = Vec::new();
    for p in loose_ends(lines) {
        grid.near(p, p, margin_mm, &mut near);
        for id in &near {
            let (side, w) = pieces[*id as usize];
            let apart_m = polyline::nearest_on_segment(w[0], w[1], p.to_m()).0.distance(p.to_m());
            // The pieces of a side follow each other.
            if apart_m < reach_m[side] && rows[side].last() != Some(&p) {
                rows[side].push(p);
            }
        }
    }
    let full: Vec<usize> = (0..sides.len()).filter(|i| rows[*i].len() >= ROW).collect();
    let is_corner = |i: &usize, j: &usize| {
        let turn = trig::angle_between(direction(&sides[*i]), direction(&sides[*j])).to_degrees();
        (CORNER_DEG..180.0 - CORNER_DEG).contains(&turn)
    };
    let has_corner = full.iter().any(|i| full.iter().any(|j| is_corner(i, j)));
    full.into_iter().filter(|_| has_corner).flat_map(|i| std::mem::take(&mut rows[i])).collect()
}

fn direction(side: &[Vec2]) -> Vec2 {
    side[side.len() - 1] - side[0]
}

/// The points where lines end from one direction only, in order.
fn loose_ends(lines: &[&[GridPoint]]) -> Vec<GridPoint> {
    let mut ends: Vec<(GridPoint, GridPoint)> = Vec::new();
    for line in lines.iter().filter(|l| l.len() > 1) {
        ends.extend([(line[0], line[1]), (line[line.len() - 1], line[line.len() - 2])]);
    }
    ends.sort_unstable();
    ends.dedup();
    ends.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0].0).collect()
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
    use exurb_geom::{Frame, LonLat};
    use proptest::prelude::*;

    use super::*;

    type Lines = Vec<Vec<GridPoint>>;

    fn found(lines: &Lines, latitude_deg: f64) -> Vec<GridPoint> {
        let lines: Vec<&[GridPoint]> = lines.iter().map(Vec::as_slice).collect();
        let mut found = cut_ends(&lines, latitude_deg);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Streets across a square with sides of 2, those of one direction bent in the middle, placed by
    /// `at`; and one that ends inside. With the ends that the sides of the square cut.
    fn clipped(streets: u32, at: impl Fn(f64, f64) -> GridPoint) -> (Lines, Vec<GridPoint>) {
        let mut lines = vec![vec![at(0.01, 0.02), at(0.04, 0.08)]];
        for i in 0..streets {
            let place = 1.94 * (f64::from(i) + 0.5) / f64::from(streets) - 0.97;
            lines.push(vec![at(place, -1.0), at(place + 0.02, 0.01), at(place, 1.0)]);
            lines.push(vec![at(-1.0, place), at(1.0, place)]);
        }
        let mut ends: Vec<GridPoint> =
            lines[1..].iter().flat_map(|l| [l[0], l[l.len() - 1]]).collect();
        ends.sort_unstable();
        (lines, ends)
    }

    proptest! {
        /// Whatever way the clip is turned, all its ends and no others are found, once or twice given.
        #[test]
        fn ends_in_rows_were_cut(
            turned_deg in -180.0..180.0_f64,
            streets in 7..30_u32,
            both_ways in any::<bool>(),
        ) {
            let east = trig::unit(turned_deg.to_radians()) * 500.0;
            let at = |x: f64, y: f64| GridPoint::round(east * x + east.perp() * y);
            let (mut lines, ends) = clipped(streets, at);
            if both_ways {
                let back = lines.iter().map(|l| l.iter().rev().copied().collect());
                let back: Lines = back.collect();
                lines.extend(back);
            }
            prop_assert_eq!(found(&lines, 0.0), ends);
        }

        /// Parallels bend in the plane: a clip by longitude and latitude of about 12 km is found, too.
        #[test]
        fn clips_by_longitude_and_latitude_are_found(lat in -65.0..65.0_f64, streets in 7..30_u32) {
            let frame = Frame::new(LonLat { lon: 11.0, lat }).unwrap();
            let wide = 0.054 / trig::unit(lat.to_radians()).x;
            let at = |x: f64, y: f64| {
                let p = LonLat { lon: 11.0 + wide * x, lat: lat + 0.054 * y };
                frame.project_to_grid(p).unwrap()
            };
            let (lines, ends) = clipped(streets, at);
            prop_assert_eq!(found(&lines, lat), ends);
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
            let lines = reach_m.iter().enumerate().map(ray).collect();
            prop_assert!(found(&lines, 50.0).is_empty());
        }
    }

    /// A street with cul-de-sacs of equal length on both sides has two rows, but no corner.
    #[test]
    fn culs_de_sac_of_equal_length_were_not_cut() {
        let mut lines = vec![vec![GridPoint::m(0.0, 0.0), GridPoint::m(1000.0, 0.0)]];
        for i in 1..20 {
            let x = 50.0 * f64::from(i);
            lines.push(vec![GridPoint::m(x, -80.0), GridPoint::m(x, 0.0), GridPoint::m(x, 80.0)]);
        }
        assert!(found(&lines, 50.0).is_empty());
    }

    #[test]
    fn what_has_no_sides_has_no_cut_ends() {
        let at = GridPoint::m;
        let row = |n: u32| (0..n).map(|i| vec![at(f64::from(i), 0.0), at(f64::from(i) + 0.5, 0.0)]);
        for lines in
            [vec![], vec![vec![]], vec![vec![at(1.0, 1.0)]], row(1).collect(), row(30).collect()]
        {
            assert!(found(&lines, 50.0).is_empty(), "{lines:?}");
        }
    }
}
