//! Whose ground a point is: that of the nearest site.

use exurb_geom::{PointIndex, Vec2, voronoi::Site};

/// Sites that can be asked for the nearest one.
pub struct Owners<'a> {
    sites: &'a [Site],
    index: PointIndex,
}

/// First search radius in metres; it grows threefold.
const FIRST_RADIUS_M: f64 = 12.0;
/// Sites farther than this are searched for one by one, in metres.
const LAST_RADIUS_M: f64 = 400.0;

impl<'a> Owners<'a> {
    /// The owners of the cells of `sites`.
    pub fn of(sites: &'a [Site]) -> Self {
        let mut index = PointIndex::new(FIRST_RADIUS_M);
        for (i, site) in sites.iter().enumerate() {
            index.insert(i as u32, site.at);
        }
        Self { sites, index }
    }

    /// The label of the site nearest to `p`; 0 where there is none.
    pub fn at(&self, p: Vec2) -> u32 {
        let mut radius_m = FIRST_RADIUS_M;
        while radius_m < LAST_RADIUS_M {
            if let Some((nearest, _)) = self.index.nearest(p, radius_m) {
                return self.sites[nearest as usize].label;
            }
            radius_m *= 3.0;
        }
        let square = |s: &&Site| s.at.distance_squared(p);
        let nearest = self.sites.iter().min_by(|a, b| square(a).total_cmp(&square(b)));
        nearest.map_or(0, |s| s.label)
    }
}
