//! Polygons with holes on the millimetre grid.

use crate::{Bounds, GridPoint, Vec2, grid, overlay, polyline};

/// A polygon: one outer ring, counter-clockwise, and holes, clockwise. Rings are open (the last
/// point differs from the first) and have at least three points.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Polygon {
    exterior: Vec<GridPoint>,
    interiors: Vec<Vec<GridPoint>>,
}

impl Polygon {
    /// A polygon of an outer ring and holes, in either direction, open or closed. Rings without
    /// area are dropped; `None` when the outer one has none. Crossings are left as they are: see
    /// [`Polygon::is_valid`] and [`overlay::repair`].
    pub fn new(exterior: Vec<GridPoint>, interiors: Vec<Vec<GridPoint>>) -> Option<Self> {
        let exterior = oriented(exterior, true)?;
        let interiors = interiors.into_iter().filter_map(|ring| oriented(ring, false)).collect();
        Some(Self { exterior, interiors })
    }

    /// The axis-parallel rectangle between two opposite corners, which differ in x and y.
    pub fn rectangle(a: GridPoint, b: GridPoint) -> Self {
        let (w, e, s, n) = (a.x.min(b.x), a.x.max(b.x), a.y.min(b.y), a.y.max(b.y));
        let exterior = [(w, s), (e, s), (e, n), (w, n)].map(|(x, y)| GridPoint { x, y }).to_vec();
        Self { exterior, interiors: Vec::new() }
    }

    /// The outer ring, counter-clockwise, open.
    pub fn exterior(&self) -> &[GridPoint] {
        &self.exterior
    }

    /// The holes, clockwise, open.
    pub fn interiors(&self) -> &[Vec<GridPoint>] {
        &self.interiors
    }

    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &[GridPoint]> {
        std::iter::once(&self.exterior[..]).chain(self.interiors.iter().map(|r| &r[..]))
    }

    /// All boundary segments.
    pub fn segments(&self) -> impl Iterator<Item = (GridPoint, GridPoint)> + '_ {
        self.rings().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
    }

    /// Area less the holes, in m².
    pub fn area_m2(&self) -> f64 {
        self.rings().map(signed_area_m2).sum()
    }

    /// Length of all rings in metres.
    pub fn perimeter_m(&self) -> f64 {
        self.segments().map(|(a, b)| a.distance_m(b)).sum()
    }

    /// Mean width `2·area / perimeter` in metres (fidelity of blocks: slivers are under 10 m).
    pub fn mean_width_m(&self) -> f64 {
        2.0 * self.area_m2() / self.perimeter_m()
    }

    /// The smallest axis-parallel box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.exterior.iter().copied())
            .unwrap_or(Bounds { min: Vec2::ZERO, max: Vec2::ZERO })
    }

    /// Is `p` inside or on the boundary?
    pub fn contains(&self, p: GridPoint) -> bool {
        let mut inside = false;
        for (a, b) in self.segments() {
            if grid::on_segment(a, b, p) {
                return true;
            }
            if (a.y > p.y) != (b.y > p.y) {
                let upward = b.y > a.y;
                inside ^= (grid::orient(a, b, p) > 0) == upward;
            }
        }
        inside
    }

    /// Distance from `p` to the boundary in metres.
    pub fn boundary_distance_m(&self, p: Vec2) -> f64 {
        self.segments()
            .map(|(a, b)| polyline::nearest_on_segment(a.to_m(), b.to_m(), p).0.distance(p))
            .fold(f64::INFINITY, f64::min)
    }

    /// Centre of gravity; may lie outside.
    pub fn centroid(&self) -> Vec2 {
        let origin = self.exterior[0].to_m();
        let (mut sum, mut area) = (Vec2::ZERO, 0.0);
        for (a, b) in self.segments() {
            let (a, b) = (a.to_m() - origin, b.to_m() - origin);
            let cross = a.perp_dot(b);
            area += cross;
            sum += (a + b) * cross;
        }
        if area == 0.0 { origin } else { origin + sum / (3.0 * area) }
    }

    /// A point well inside: the centroid where that lies inside, else the middle of the widest
    /// horizontal chord among seven.
    pub fn interior_point(&self) -> Vec2 {
        let centroid = self.centroid();
        if self.contains(GridPoint::round(centroid)) && self.boundary_distance_m(centroid) > 0.01 {
            return centroid;
        }
        let Bounds { min, max } = self.bounds();
        let mut best = (0.0, centroid);
        for k in 1..8 {
            // An odd fraction, so that the chord seldom meets a vertex.
            let y = min.y + (max.y - min.y) * (f64::from(k) / 8.0 + 0.001_37);
            let mut xs: Vec<f64> = self
                .segments()
                .map(|(a, b)| (a.to_m(), b.to_m()))
                .filter(|(a, b)| (a.y > y) != (b.y > y))
                .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
                .collect();
            xs.sort_by(f64::total_cmp);
            for chord in xs.chunks_exact(2) {
                if chord[1] - chord[0] > best.0 {
                    best = (chord[1] - chord[0], Vec2::new((chord[0] + chord[1]) / 2.0, y));
                }
            }
        }
        best.1
    }

    /// No ring crosses or touches itself or another, holes lie inside. O(n²) in vertices.
    pub fn is_valid(&self) -> bool {
        overlay::is_valid(self)
    }

    /// Every point moved by `f`; `None` when no area is left.
    pub fn map(&self, f: impl Fn(Vec2) -> Vec2) -> Option<Self> {
        let ring = |r: &[GridPoint]| r.iter().map(|p| GridPoint::round(f(p.to_m()))).collect();
        Self::new(ring(&self.exterior), self.interiors.iter().map(|r| ring(r)).collect())
    }
}

/// Signed area of a ring in m², positive when counter-clockwise.
pub fn signed_area_m2(ring: &[GridPoint]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    let twice: i128 = (1..ring.len().saturating_sub(1))
        .map(|i| i128::from(grid::orient(o, ring[i], ring[i + 1])))
        .sum();
    twice as f64 / 2e6
}

fn oriented(mut ring: Vec<GridPoint>, counter_clockwise: bool) -> Option<Vec<GridPoint>> {
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let area = signed_area_m2(&ring);
    if ring.len() < 3 || area == 0.0 {
        return None;
    }
    if (area > 0.0) != counter_clockwise {
        ring.reverse();
    }
    Some(ring)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn l_shape() -> Polygon {
        let ring = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (10.0, 10.0), (10.0, 40.0), (0.0, 40.0)];
        Polygon::new(ring.map(|(x, y)| GridPoint::m(x, y)).to_vec(), vec![]).expect("has area")
    }

    #[test]
    fn area_and_centroid_of_an_l() {
        let l = l_shape();
        assert_eq!(l.area_m2(), 700.0);
        assert!((l.centroid() - Vec2::splat((400.0 * 20.0 + 300.0 * 5.0) / 700.0)).length() < 1e-9);
    }

    #[test]
    fn the_interior_point_of_a_concave_polygon_is_inside() {
        let l = l_shape();
        assert!(!l.contains(GridPoint::round(l.centroid())));
        assert!(l.contains(GridPoint::round(l.interior_point())));
    }

    #[test]
    fn the_boundary_belongs_to_the_polygon_and_holes_do_not() {
        let outer = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(10.0, 10.0));
        let hole = Polygon::rectangle(GridPoint::m(4.0, 4.0), GridPoint::m(6.0, 6.0));
        let p = Polygon::new(outer.exterior.clone(), vec![hole.exterior]).expect("has area");
        assert_eq!(p.area_m2(), 96.0);
        assert!(p.contains(GridPoint::m(0.0, 5.0)) && p.contains(GridPoint::m(10.0, 10.0)));
        assert!(!p.contains(GridPoint::m(5.0, 5.0)) && p.contains(GridPoint::m(4.0, 5.0)));
    }
}
