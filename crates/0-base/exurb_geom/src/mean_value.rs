//! Mean value coordinates: a map of a polygon's inside that follows its outline.
//!
//! Source: Hormann, Floater 2006, *Mean Value Coordinates for Arbitrary Planar Polygons*. The half
//! tangents come from areas and products, which is well conditioned near the outline. Coordinates
//! reproduce linear functions everywhere; inside concave outlines some are negative, and a map between
//! two outlines may then fold or leave its target: [`MeanValueMap::ring`] gives nothing where a ring
//! folds. O(outline) a point.

use crate::Vec2;

/// Points nearer to a corner or a side than this share of the outline's length lie on it.
const ON_OUTLINE: f64 = 1e-9;
/// A ring whose area changes by more than this factor counts as folded.
const MOST_STRETCH: f64 = 16.0;

/// The coordinates of `p` with regard to the closed line `ring` of at least three corners: one weight
/// a corner, 1 in all.
pub fn coordinates(ring: &[Vec2], p: Vec2) -> Vec<f64> {
    let mut out = vec![0.0; ring.len()];
    write_coordinates(ring, ON_OUTLINE * closed_length(ring), p, &mut out);
    out
}

fn closed_length(ring: &[Vec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])).sum()
}

fn write_coordinates(ring: &[Vec2], epsilon: f64, p: Vec2, out: &mut [f64]) {
    out.fill(0.0);
    let mut last = ring.len() - 1;
    let mut before = ring[last] - p;
    let mut before_m = before.length();
    for i in 0..ring.len() {
        let here = ring[i] - p;
        let here_m = here.length();
        if here_m <= epsilon {
            out.fill(0.0);
            out[i] = 1.0;
            return;
        }
        let (area, product) = (before.perp_dot(here), before.dot(here));
        if area.abs() > epsilon * before.distance(here) {
            // The tangent of half the angle under which the side is seen.
            let half_tangent = (before_m * here_m - product) / area;
            out[last] += half_tangent / before_m;
            out[i] += half_tangent / here_m;
        } else if product < 0.0 {
            out.fill(0.0);
            (out[last], out[i]) = (here_m, before_m);
            break;
        }
        (last, before, before_m) = (i, here, here_m);
    }
    let sum: f64 = out.iter().sum();
    out.iter_mut().for_each(|w| *w /= sum);
}

/// The map that takes one closed line, corner by corner, to another.
#[derive(Clone, Debug)]
pub struct MeanValueMap {
    from: Vec<Vec2>,
    to: Vec<Vec2>,
    epsilon: f64,
}

impl MeanValueMap {
    /// The map from `from` to `to`, which have equally many corners, at least three.
    pub fn new(from: Vec<Vec2>, to: Vec<Vec2>) -> Option<Self> {
        let epsilon = ON_OUTLINE * closed_length(&from);
        (from.len() == to.len() && from.len() >= 3 && epsilon > 0.0).then_some(Self {
            from,
            to,
            epsilon,
        })
    }

    /// Where `p` goes.
    pub fn apply(&self, p: Vec2) -> Vec2 {
        self.image(p, &mut vec![0.0; self.from.len()])
    }

    /// Where a ring's corners go; `None` where the ring folds: its area changes sign or by more than a
    /// factor of 16, or a corner has no finite image.
    pub fn ring(&self, ring: &[Vec2]) -> Option<Vec<Vec2>> {
        let mut weights = vec![0.0; self.from.len()];
        let out: Vec<Vec2> = ring.iter().map(|p| self.image(*p, &mut weights)).collect();
        let stretch = signed_area(&out) / signed_area(ring);
        let holds = stretch.is_finite() && (1.0 / MOST_STRETCH..=MOST_STRETCH).contains(&stretch);
        (holds && out.iter().all(|p| p.is_finite())).then_some(out)
    }

    fn image(&self, p: Vec2, weights: &mut [f64]) -> Vec2 {
        write_coordinates(&self.from, self.epsilon, p, weights);
        weights.iter().zip(&self.to).map(|(w, q)| *q * *w).sum()
    }
}

fn signed_area(ring: &[Vec2]) -> f64 {
    let origin = ring.first().copied().unwrap_or_default();
    ring.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::trig;

    fn l_shape() -> Vec<Vec2> {
        let corners = [(0., 0.), (60., 0.), (60., 20.), (20., 20.), (20., 60.), (0., 60.)];
        corners.map(|(x, y)| Vec2::new(x, y)).to_vec()
    }

    /// A star around the origin of as many corners as radii.
    fn star(radii: &[f64]) -> Vec<Vec2> {
        let step = std::f64::consts::TAU / radii.len() as f64;
        (0..radii.len()).map(|i| trig::unit(step * i as f64) * radii[i]).collect()
    }

    /// The formula of the paper's section 2, with angles.
    fn by_angles(ring: &[Vec2], p: Vec2) -> Vec<f64> {
        let n = ring.len();
        let half_tangent = |i: usize| {
            let (u, v) = (ring[i] - p, ring[(i + 1) % n] - p);
            trig::tan(trig::atan2(u.perp_dot(v), u.dot(v)) / 2.0)
        };
        let weight =
            |i: usize| (half_tangent((i + n - 1) % n) + half_tangent(i)) / ring[i].distance(p);
        let weights: Vec<f64> = (0..n).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|w| w / sum).collect()
    }

    proptest! {
        #[test]
        fn linear_functions_are_reproduced_and_angles_give_the_same(
            radii in prop::collection::vec(20.0..90.0, 3..14),
            x in -70.0..70.0, y in -70.0..70.0,
        ) {
            let (ring, p) = (star(&radii), Vec2::new(x, y));
            let weights = coordinates(&ring, p);
            prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            let image: Vec2 = weights.iter().zip(&ring).map(|(w, q)| *q * *w).sum();
            let size: f64 = weights.iter().map(|w| w.abs()).sum();
            prop_assert!(image.distance(p) < 1e-8 * size * 90.0, "{image} {p}");
            let inside = size < 3.0;
            let same = weights.iter().zip(by_angles(&ring, p)).all(|(a, b)| (a - b).abs() < 1e-6);
            prop_assert!(same || !inside);
        }
    }

    #[test]
    fn corners_and_sides_are_kept() {
        let l = l_shape();
        assert_eq!(coordinates(&l, l[2]), [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(coordinates(&l, Vec2::new(15.0, 0.0)), [0.75, 0.25, 0.0, 0.0, 0.0, 0.0]);
        let map = MeanValueMap::new(l.clone(), l.iter().map(|p| *p * 2.0).collect());
        let map = map.expect("equal corners");
        assert!(map.apply(Vec2::new(20.0, 40.0)).distance(Vec2::new(40.0, 80.0)) < 1e-9);
        assert!(map.apply(Vec2::new(9.0, 1e-7)).distance(Vec2::new(18.0, 2e-7)) < 1e-6);
    }

    #[test]
    fn a_ring_that_folds_is_told() {
        let square = [(0., 0.), (40., 0.), (40., 40.), (0., 40.)].map(|(x, y)| Vec2::new(x, y));
        let house = [(4., 4.), (12., 4.), (12., 12.), (4., 12.)].map(|(x, y)| Vec2::new(x, y));
        let wide = square.map(|p| Vec2::new(p.x * 1.5, p.y));
        let map = MeanValueMap::new(square.to_vec(), wide.to_vec()).expect("equal corners");
        let image = map.ring(&house).expect("no fold");
        assert!(image[2].distance(Vec2::new(18.0, 12.0)) < 1e-9);
        let turned_over = square.map(|p| Vec2::new(-p.x, p.y));
        let map = MeanValueMap::new(square.to_vec(), turned_over.to_vec()).expect("equal corners");
        assert_eq!(map.ring(&house), None);
    }

    #[test]
    fn outlines_that_do_not_go_together_have_no_map() {
        assert!(MeanValueMap::new(l_shape(), l_shape()[1..].to_vec()).is_none());
        assert!(MeanValueMap::new(vec![Vec2::ZERO; 3], vec![Vec2::ZERO; 3]).is_none());
    }
}
