//! Polygons cut into thin slices, to tell quickly how much they share, also while one slides along a
//! line.

use exurb_geom::Vec2;

/// Height of a slice in metres.
const STEP_M: f64 = 0.5;
/// What has more slices is not cut: no building is as deep.
const MOST_ROWS: f64 = 4000.0;

/// For each slice the stretches that lie inside.
#[derive(Clone, Debug, Default)]
pub struct Slices {
    first_row: i64,
    /// End of each row's stretches in the list.
    ends: Vec<u32>,
    stretches: Vec<(f64, f64)>,
}

impl Slices {
    /// The slices of closed lines, by the even-odd rule.
    pub fn of<'a>(rings: impl IntoIterator<Item = &'a [Vec2]> + Clone) -> Self {
        let points = rings.clone().into_iter().flatten();
        let (low, high) =
            points.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)));
        let rows = (high - low) / STEP_M;
        if !(0.0..=MOST_ROWS).contains(&rows) {
            return Self::default();
        }
        let first_row = (low / STEP_M - 0.5).ceil() as i64;
        let last_row = (high / STEP_M - 0.5).floor() as i64;
        let count = (last_row - first_row + 1).max(0) as usize;
        let mut crossings: Vec<(u32, f64)> = Vec::with_capacity(4 * count);
        // Where each row's crossings begin, at first their number.
        let mut starts = vec![0u32; count + 1];
        for ring in rings {
            for (i, b) in ring.iter().enumerate() {
                let a = ring[(i + ring.len() - 1) % ring.len()];
                let (a, b) = if a.y <= b.y { (a, *b) } else { (*b, a) };
                let from = ((a.y / STEP_M - 0.5).ceil() as i64).max(first_row);
                let slope = (b.x - a.x) / (b.y - a.y);
                for row in from..=last_row {
                    let y = (row as f64 + 0.5) * STEP_M;
                    if y >= b.y {
                        break;
                    }
                    let k = (row - first_row) as u32;
                    crossings.push((k, a.x + slope * (y - a.y)));
                    starts[k as usize + 1] += 1;
                }
            }
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut sorted = vec![0.0; crossings.len()];
        let mut next = starts.clone();
        for (row, x) in crossings {
            let slot = &mut next[row as usize];
            // Rows hold a handful: each crossing is moved down to its place.
            let mut at = *slot as usize;
            while at > starts[row as usize] as usize && sorted[at - 1] > x {
                sorted[at] = sorted[at - 1];
                at -= 1;
            }
            sorted[at] = x;
            *slot += 1;
        }
        let mut out = Self { first_row, ..Self::default() };
        for k in 0..count {
            let row = &sorted[starts[k] as usize..starts[k + 1] as usize];
            out.stretches.extend(row.chunks_exact(2).map(|c| (c[0], c[1])));
            out.ends.push(out.stretches.len() as u32);
        }
        out
    }

    /// The area inside, in m².
    pub fn area_m2(&self) -> f64 {
        self.stretches.iter().map(|(a, b)| b - a).sum::<f64>() * STEP_M
    }

    /// The area that these, moved by `shift_m` along the slices, share with others, in m².
    pub fn shared_m2(&self, shift_m: f64, other: &Self) -> f64 {
        let first = self.first_row.max(other.first_row);
        let last = (self.first_row + self.ends.len() as i64)
            .min(other.first_row + other.ends.len() as i64);
        let mut sum = 0.0;
        for row in first..last {
            for (a, b) in self.row(row) {
                for (c, d) in other.row(row) {
                    sum += ((b + shift_m).min(*d) - (a + shift_m).max(*c)).max(0.0);
                }
            }
        }
        sum * STEP_M
    }

    /// Depth of what lies between two places along the slices, on average, in metres.
    pub fn depth_m(&self, from_m: f64, to_m: f64) -> f64 {
        let shared = |(a, b): &(f64, f64)| (b.min(to_m) - a.max(from_m)).max(0.0);
        self.stretches.iter().map(shared).sum::<f64>() * STEP_M / (to_m - from_m)
    }

    /// From where to where along the slices they reach in those up to `depth_m`.
    pub fn span_m(&self, depth_m: f64) -> Option<(f64, f64)> {
        let last = (depth_m / STEP_M).min(i64::MAX as f64) as i64;
        let rows = self.first_row..(self.first_row + self.ends.len() as i64).min(last);
        let stretches = rows.flat_map(|row| self.row(row));
        stretches.fold(None, |found: Option<(f64, f64)>, (a, b)| {
            Some(found.map_or((*a, *b), |(l, h)| (l.min(*a), h.max(*b))))
        })
    }

    fn row(&self, row: i64) -> &[(f64, f64)] {
        let k = (row - self.first_row) as usize;
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.stretches[start as usize..self.ends[k] as usize]
    }
}

#[cfg(test)]
mod tests {
    use exurb_geom::{Polygon, overlay, polyline, trig};
    use proptest::prelude::*;

    use super::*;

    fn star(radii: &[f64], at: Vec2) -> Vec<Vec2> {
        let step = std::f64::consts::TAU / radii.len() as f64;
        (0..radii.len()).map(|i| at + trig::unit(step * i as f64) * radii[i]).collect()
    }

    proptest! {
        #[test]
        fn slices_share_what_the_overlay_says(
            a in prop::collection::vec(5.0..15.0, 4..9),
            b in prop::collection::vec(5.0..15.0, 4..9),
            x in -20.0..20.0, y in -9.0..9.0, shift in -12.0..12.0,
        ) {
            let (a, b) = (star(&a, Vec2::ZERO), star(&b, Vec2::new(x, y)));
            let shared = Slices::of([&a[..]]).shared_m2(shift, &Slices::of([&b[..]]));
            let grid = |ring: &[Vec2], by: f64| {
                let moved: Vec<Vec2> = ring.iter().map(|p| *p + Vec2::new(by, 0.0)).collect();
                Polygon::new(polyline::round(&moved), vec![]).expect("has area")
            };
            let exact: f64 =
                overlay::intersection(&grid(&a, shift), &grid(&b, 0.0)).iter().map(Polygon::area_m2).sum();
            prop_assert!((shared - exact).abs() < 4.0, "{shared} {exact}");
        }
    }

    #[test]
    fn a_courtyard_is_no_inside() {
        let square = |low: f64, high: f64| {
            [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| Vec2::new(x, y))
        };
        let (outer, court) = (square(0.0, 20.0), square(5.0, 15.0));
        let ring = Slices::of([&outer[..], &court[..]]);
        assert_eq!(ring.area_m2(), 300.0);
        assert_eq!(ring.depth_m(8.0, 9.0), 10.0);
    }
}
