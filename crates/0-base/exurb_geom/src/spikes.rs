//! Walls that turn right back on themselves: spikes and cracks of no width.
//!
//! What is cut along a slanting border keeps hairs of a hand's breadth; they have length and no area, and
//! close up when a file rounds its places.

use crate::{GridPoint, Polygon, trig};

/// The polygon without corners sharper than `sharp_rad`. Spikes go, and cracks where filling one adds no
/// more than `most_m2`, so that what lies in a wider one is left alone. `None` where nothing with an area is
/// left. O(n) for n corners, and again for every sharp one.
pub fn without_spikes(polygon: &Polygon, sharp_rad: f64, most_m2: f64) -> Option<Polygon> {
    let trim = |ring: &[GridPoint]| {
        let mut ring = ring.to_vec();
        let goes = |ring: &[GridPoint], i: usize| {
            let n = ring.len();
            let [a, b, c] =
                [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]].map(GridPoint::to_m);
            let (u, v) = (a - b, c - b);
            // The ground lies to the left, so that a crack turns right.
            let is_spike = v.perp_dot(u) >= 0.0;
            trig::angle_between(u, v) < sharp_rad
                && (is_spike || v.perp_dot(u).abs() / 2.0 <= most_m2)
        };
        while ring.len() > 3
            && let Some(i) = (0..ring.len()).find(|i| goes(&ring, *i))
        {
            ring.remove(i);
        }
        ring
    };
    let interiors = polygon.interiors().iter().map(|ring| trim(ring)).collect();
    Polygon::new(trim(polygon.exterior()), interiors)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        let ring = points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        Polygon::new(ring, Vec::new()).unwrap()
    }

    #[test]
    fn spikes_go_and_cracks_that_are_hairs() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let plain = polygon(&square);
        assert_eq!(without_spikes(&plain, 0.1, 0.1), Some(plain.clone()));
        // Out along the upper wall, 14 m beyond the house.
        let spiky = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 9.99), (24.0, 10.0), (0.0, 10.0)]);
        let mended = without_spikes(&spiky, 0.1, 0.1).unwrap();
        assert!((mended.area_m2() - 100.0).abs() < 0.1 && mended.bounds().max.x < 10.01);
        // Into the house, 1 cm and 50 cm wide: 0.04 and 2 m².
        let crack = |width: f64| {
            let (a, b) = (5.0 - width / 2.0, 5.0 + width / 2.0);
            polygon(&[square[0], (a, 0.0), (5.0, 8.0), (b, 0.0), square[1], square[2], square[3]])
        };
        assert_eq!(without_spikes(&crack(0.01), 0.1, 0.1).unwrap().area_m2(), 100.0);
        assert_eq!(without_spikes(&crack(0.5), 0.1, 0.1), Some(crack(0.5)));
        assert_eq!(without_spikes(&crack(0.5), 0.1, 9.0).unwrap().area_m2(), 100.0);
    }

    #[test]
    fn a_sliver_is_a_triangle_at_least() {
        let sliver = polygon(&[(0.0, 0.0), (10.0, 0.01), (20.0, 0.0), (10.0, 0.02)]);
        let left = without_spikes(&sliver, 0.1, 0.1);
        assert!(left.is_none_or(|p| p.exterior().len() == 3));
    }
}
