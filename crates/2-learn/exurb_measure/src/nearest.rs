//! The nearest of many segments to an outline, within a reach.

use exurb_geom::{GridPoint, Polygon, SegmentGrid, polyline};

/// Reaches tried one after the other: most things are near.
const REACHES_M: [f64; 4] = [5.0, 20.0, 60.0, 150.0];

/// Segments with owners, to be asked for the nearest one.
#[derive(Debug)]
pub struct Segments {
    grid: SegmentGrid,
    owners: Vec<u32>,
}

/// The nearest segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its distance in metres.
    pub distance_m: f64,
    /// Its owner.
    pub owner: u32,
    /// Its ends.
    pub segment: (GridPoint, GridPoint),
}

impl Segments {
    /// Of pairs of owner and segment.
    pub fn new(segments: impl IntoIterator<Item = (u32, (GridPoint, GridPoint))>) -> Self {
        let (owners, segments) = segments.into_iter().unzip();
        Self { grid: SegmentGrid::new(segments), owners }
    }

    /// The boundary segments of polygons, numbered in their order.
    pub fn of_polygons<'a>(polygons: impl IntoIterator<Item = &'a Polygon>) -> Self {
        let numbered = polygons.into_iter().zip(0..);
        Self::new(numbered.flat_map(|(p, owner)| p.segments().map(move |s| (owner, s))))
    }

    /// Does a segment come within `reach_m` of `p`?
    pub fn is_within(&self, p: GridPoint, reach_m: f64) -> bool {
        let mut near = Vec::new();
        self.grid.near(p, p, (reach_m * 1000.0) as i32, &mut near);
        near.iter().any(|i| {
            let (a, b) = self.grid.segment(*i);
            polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m()).0.distance(p.to_m())
                <= reach_m
        })
    }

    /// The segment nearest to the boundary of `polygon` within `most_m`, of owners that `is_other`
    /// accepts; ties go to the first. O(segments near).
    pub fn nearest(
        &self,
        polygon: &Polygon,
        most_m: f64,
        is_other: impl Fn(u32) -> bool,
    ) -> Option<Nearest> {
        let mut near = Vec::new();
        let reaches = REACHES_M.into_iter().filter(|r| *r < most_m).chain([most_m]);
        for reach_m in reaches {
            let mut best: Option<Nearest> = None;
            for (a, b) in polygon.segments() {
                self.grid.near(a, b, (reach_m * 1000.0) as i32, &mut near);
                for i in near.iter().filter(|i| is_other(self.owners[**i as usize])) {
                    let (c, d) = self.grid.segment(*i);
                    let distance_m =
                        polyline::segment_distance(a.to_m(), b.to_m(), c.to_m(), d.to_m());
                    if best.is_none_or(|b| distance_m < b.distance_m) {
                        let owner = self.owners[*i as usize];
                        best = Some(Nearest { distance_m, owner, segment: (c, d) });
                    }
                }
            }
            // What lies farther than the reach may have been overlooked.
            if let Some(best) = best.filter(|best| best.distance_m <= reach_m) {
                return Some(best);
            }
        }
        None
    }
}
