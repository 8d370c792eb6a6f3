use exurb_geom::Vec2;

/// A building of an example as one sees it from its street: x along the street with the block to the
/// left, y into the block.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildingSample {
    /// Frontage it takes, half the gaps to its neighbours included, in metres.
    pub frontage_m: f64,
    /// Extent along the street and into the block, in metres.
    pub size_m: Vec2,
    /// Distance from the kerb in metres.
    pub setback_m: f64,
    /// Gap to the building before it along the street in metres; 0 = shared wall.
    pub gap_before_m: f64,
    /// Gap to the building after it.
    pub gap_after_m: f64,
    /// Angle from the street to the building's own direction in radians.
    pub turn_rad: f64,
    /// Does it stand at a corner of its block?
    pub at_corner: bool,
    /// Footprint area in m².
    pub area_m2: f64,
    /// Its rings, simplified, from (0, 0) to `size_m`; the outer one first, counter-clockwise.
    pub outline: Vec<Vec<Vec2>>,
}

impl BuildingSample {
    /// Does it share both side walls?
    pub fn is_in_row(&self) -> bool {
        self.gap_before_m == 0.0 && self.gap_after_m == 0.0
    }

    /// Share of its box that it covers.
    pub fn fill(&self) -> f64 {
        self.area_m2 / (self.size_m.x * self.size_m.y).max(1e-6)
    }
}
