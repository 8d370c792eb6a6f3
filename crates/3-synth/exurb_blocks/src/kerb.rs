//! The outline of a block as a list of rings, and the place on it nearest to a point.

use exurb_geom::{GridPoint, Polygon, RowSides, SegmentGrid, Vec2, grid, polyline};

use crate::ring::Ring;

/// The place on a ring nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Position along the ring in metres.
    pub at_m: f64,
    /// Distance to it in metres.
    pub distance_m: f64,
    /// Unit direction of the ring there.
    pub direction: Vec2,
}

/// The rings of a block's outline, the outer one first.
#[derive(Clone, Debug)]
pub struct Kerb {
    /// Its rings.
    pub rings: Vec<Ring>,
    grid: SegmentGrid,
    sides: RowSides,
    /// Ring and start along it of every segment of the grid.
    starts: Vec<(usize, f64)>,
}

/// Places are first searched for within this distance, in metres.
const FIRST_M: f64 = 8.0;
/// Places farther than this are searched for one by one, in metres.
const FARTHEST_M: f64 = 500.0;

impl Kerb {
    /// The outline of `block`.
    pub fn of(block: &Polygon) -> Self {
        let rings: Vec<Ring> = block.rings().map(Ring::of).collect();
        let mut starts = Vec::new();
        for (r, ring) in block.rings().enumerate() {
            let mut at = 0.0;
            for i in 0..ring.len() {
                starts.push((r, at));
                at += ring[i].distance_m(ring[(i + 1) % ring.len()]);
            }
        }
        let grid = SegmentGrid::new(block.segments().collect());
        Self { rings, grid, sides: RowSides::new(block), starts }
    }

    /// Length of all rings in metres.
    pub fn length_m(&self) -> f64 {
        self.rings.iter().map(Ring::length_m).sum()
    }

    /// The segments near a point, for tests that need no place.
    pub fn grid(&self) -> &SegmentGrid {
        &self.grid
    }

    /// The ring and place on it nearest to `p`. About O(1) near the kerb.
    pub fn nearest(&self, p: Vec2) -> (usize, Place) {
        let mut within_m = FIRST_M;
        while within_m <= FARTHEST_M {
            if let Some(found) = self.within(p, within_m) {
                return found;
            }
            within_m *= 3.0;
        }
        let all = 0..self.starts.len() as u32;
        self.best(p, all).unwrap_or((0, Place { at_m: 0.0, distance_m: 0.0, direction: Vec2::X }))
    }

    /// The same where it is no farther than that.
    fn within(&self, p: Vec2, within_m: f64) -> Option<(usize, Place)> {
        let at = GridPoint::round(p);
        let mut near = Vec::new();
        self.grid.near(at, at, (within_m * 1000.0).ceil() as i32, &mut near);
        let best = self.best(p, near.into_iter());
        best.filter(|(_, place)| place.distance_m <= within_m)
    }

    /// Is `p` in the block whose kerb this is? Even-odd, over the rings.
    pub fn contains(&self, p: Vec2) -> bool {
        self.rings.iter().fold(false, |inside, ring| inside ^ ring.winds_around(p))
    }

    /// Distance of an outline to the kerb in metres, negative where it reaches over it.
    pub fn clearance_m(&self, outline: &Polygon) -> f64 {
        self.clearance_up_to_m(f64::INFINITY, outline)
    }

    /// The same where it is less than `most_m`, else that.
    pub fn clearance_up_to_m(&self, most_m: f64, outline: &Polygon) -> f64 {
        if self.crosses(outline) {
            return -1.0;
        }
        let mut least = most_m;
        for p in outline.exterior() {
            let inside = self.sides.contains(*p);
            let distance_m = match inside && most_m <= FIRST_M {
                true => self.within(p.to_m(), most_m).map_or(most_m, |found| found.1.distance_m),
                false => self.nearest(p.to_m()).1.distance_m,
            };
            least = least.min(if inside { distance_m } else { -distance_m });
        }
        // Corners of the kerb that come near a long wall, or stand in the building.
        let bounds = outline.bounds().grown(least.max(0.0));
        let corners = (0..self.starts.len() as u32).map(|id| self.grid.segment(id).0);
        for corner in corners.filter(|p| bounds.contains(p.to_m())) {
            let distance_m = outline.boundary_distance_m(corner.to_m());
            least = least.min(if outline.contains(corner) { -distance_m } else { distance_m });
        }
        least
    }

    /// Does the kerb cross the outline?
    fn crosses(&self, outline: &Polygon) -> bool {
        let mut near = Vec::new();
        outline.segments().any(|(a, b)| {
            self.grid.near(a, b, 0, &mut near);
            near.iter().any(|id| {
                let (c, d) = self.grid.segment(*id);
                grid::cross_properly(a, b, c, d)
            })
        })
    }

    fn best(&self, p: Vec2, segments: impl Iterator<Item = u32>) -> Option<(usize, Place)> {
        let place = |id: u32| {
            let (a, b) = self.grid.segment(id);
            let (a, b) = (a.to_m(), b.to_m());
            let (q, t) = polyline::nearest_on_segment(a, b, p);
            let (ring, start) = self.starts[id as usize];
            let at_m = start + t * a.distance(b);
            let direction = (b - a).normalize_or_zero();
            (ring, Place { at_m, distance_m: q.distance(p), direction })
        };
        segments.map(place).min_by(|a, b| a.1.distance_m.total_cmp(&b.1.distance_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_place_is_that_of_a_walk_over_all_rings() {
        let ring = |r: f64, c: (f64, f64), turn: f64| -> Vec<GridPoint> {
            (0..40)
                .map(|i| exurb_geom::trig::unit(turn * f64::from(i) * std::f64::consts::TAU / 40.0))
                .map(|u| GridPoint::m(c.0 + u.x * r, c.1 + u.y * r * 0.4))
                .collect()
        };
        let block = Polygon::new(ring(300.0, (0., 0.), 1.0), vec![ring(40.0, (90., 9.), -1.0)])
            .expect("has area");
        let kerb = Kerb::of(&block);
        for i in 0..200 {
            let k = f64::from(i);
            let p = Vec2::new((k * 37.7) % 900.0 - 450.0, (k * 61.3) % 900.0 - 450.0);
            let walked = block.boundary_distance_m(p);
            let (r, place) = kerb.nearest(p);
            assert!((place.distance_m - walked).abs() < 1e-9, "{p}");
            assert!(kerb.rings[r].point_at(place.at_m).distance(p) - walked < 1e-6, "{p}");
        }
    }
}
