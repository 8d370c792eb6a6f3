//! Which blocks lie across a street from each other, and how far main streets are.

use std::collections::BTreeMap;

use exurb_city::{Block, Role, StreetGraph};
use exurb_geom::{GridPoint, SegmentGrid, Vec2, polyline};

/// For each block the indices of those that share a street with it, ascending.
/// Aliaga 2008, section 3.1.2: the block graph is dual to the street graph.
pub fn neighbours(blocks: &[Block]) -> Vec<Vec<usize>> {
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, block) in blocks.iter().enumerate() {
        for side in &block.sides {
            at.entry(side.0).or_default().push(i);
        }
    }
    let mut out: Vec<Vec<usize>> = vec![Vec::new(); blocks.len()];
    for sharing in at.values() {
        for i in sharing {
            out[*i].extend(sharing.iter().filter(|j| *j != i));
        }
    }
    for list in &mut out {
        list.sort_unstable();
        list.dedup();
    }
    out
}

/// Main streets that can be asked for the nearest one.
pub struct MainStreets {
    grid: SegmentGrid,
}

/// Main streets farther than this are far, in metres.
const FAR_M: f64 = 3000.0;

impl MainStreets {
    /// Those of a network.
    pub fn of(streets: &StreetGraph) -> Self {
        let main = streets.edges().filter(|(_, e)| e.data.role() == Role::Main);
        let segments = main.flat_map(|(_, e)| e.line().windows(2).map(|w| (w[0], w[1])));
        Self { grid: SegmentGrid::new(segments.collect()) }
    }

    /// Distance from `p` to the nearest one in metres, at most 3 km; `None` where there is none at all.
    pub fn distance_m(&self, p: Vec2) -> Option<f64> {
        if self.grid.is_empty() {
            return None;
        }
        let at = GridPoint::round(p);
        let mut near = Vec::new();
        let mut within_m = 100.0;
        while within_m <= FAR_M {
            self.grid.near(at, at, (within_m * 1000.0) as i32, &mut near);
            let distance = |id: &u32| {
                let (a, b) = self.grid.segment(*id);
                polyline::nearest_on_segment(a.to_m(), b.to_m(), p).0.distance(p)
            };
            let nearest = near.iter().map(distance).fold(f64::INFINITY, f64::min);
            if nearest <= within_m {
                return Some(nearest);
            }
            within_m *= 3.0;
        }
        Some(FAR_M)
    }
}
