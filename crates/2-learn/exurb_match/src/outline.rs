use exurb_geom::{GridPoint, OrientedBox, Vec2, polygon::signed_area_m2};

/// Samples of an outline (Hartmann 2018, section 5.1.6).
pub const SAMPLES: usize = 100;

/// A closed line as evenly spaced samples, counter-clockwise, with what tells outlines apart quickly.
/// Lengths in metres; nothing is scaled, since the size of a block counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    points: Vec<Vec2>,
    /// Area inside, in m².
    pub area_m2: f64,
    /// Length in metres.
    pub length_m: f64,
    /// Shorter over longer side of the smallest enclosing rectangle, in `0..=1`.
    pub aspect: f64,
}

impl Outline {
    /// The outline through `ring`, which is open and counter-clockwise and has an area, as the outer
    /// ring of a polygon. The first sample is its first point.
    pub fn of(ring: &[GridPoint]) -> Self {
        let n = ring.len();
        let ends = |i: usize| (ring[i % n].to_m(), ring[(i + 1) % n].to_m());
        let length_m: f64 = (0..n).map(ends).map(|(a, b)| a.distance(b)).sum();
        let mut points = Vec::with_capacity(SAMPLES);
        let (mut segment, mut start) = (0, 0.0);
        for k in 0..SAMPLES {
            let at = length_m * k as f64 / SAMPLES as f64;
            let step = |segment| {
                let (a, b) = ends(segment);
                a.distance(b)
            };
            while segment + 1 < n && at > start + step(segment) {
                start += step(segment);
                segment += 1;
            }
            let (a, b) = ends(segment);
            let length = a.distance(b).max(f64::MIN_POSITIVE);
            points.push(a.lerp(b, ((at - start) / length).clamp(0.0, 1.0)));
        }
        let aspect = OrientedBox::of(ring).map_or(0.0, |b| b.aspect());
        Self { points, area_m2: signed_area_m2(ring).abs(), length_m, aspect }
    }

    /// The samples, [`SAMPLES`] of them.
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }

    /// The outline seen in a mirror at the y axis; its samples run backwards, from the same first one.
    pub fn mirrored(&self) -> Self {
        let mut points: Vec<Vec2> = self.points.iter().map(|p| Vec2::new(-p.x, p.y)).collect();
        points[1..].reverse();
        Self { points, ..self.clone() }
    }

    /// Unit direction along the outline at each sample, between its neighbours.
    pub fn tangents(&self) -> Vec<Vec2> {
        let n = self.points.len();
        let tangent = |i: usize| {
            (self.points[(i + 1) % n] - self.points[(i + n - 1) % n]).normalize_or(Vec2::X)
        };
        (0..n).map(tangent).collect()
    }

    /// Mean distance between two samples in metres.
    pub fn mean_distance_m(&self) -> f64 {
        let n = self.points.len();
        let sum: f64 = (0..n)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| self.points[i].distance(self.points[j]))
            .sum();
        sum * 2.0 / (n * (n - 1)) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(width: f64, depth: f64) -> Outline {
        let corners = [(0.0, 0.0), (width, 0.0), (width, depth), (0.0, depth)];
        Outline::of(&corners.map(|(x, y)| GridPoint::m(x, y)))
    }

    #[test]
    fn samples_are_evenly_spaced() {
        let outline = rectangle(40.0, 10.0);
        assert_eq!(outline.points().len(), SAMPLES);
        assert!(outline.points().windows(2).all(|w| (w[0].distance(w[1]) - 1.0).abs() < 1e-9));
        assert_eq!((outline.area_m2, outline.length_m, outline.aspect), (400.0, 100.0, 0.25));
    }

    #[test]
    fn twice_mirrored_is_itself() {
        let outline = rectangle(40.0, 10.0);
        assert_ne!(outline.mirrored(), outline);
        assert_eq!(outline.mirrored().mirrored(), outline);
    }
}
