use exurb_geom::Vec2;

/// A building of an example as one sees it from its street: x along the street with the block to the
/// left, y into the block.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildingSample {
    /// Frontage it takes, half the gaps to its neighbours included, in metres.
    pub frontage_m: f64,
    /// Extent along the street and into the block, in metres.
    pub size_m: Vec2,
    /// Depth of the part along the street, wings behind it left out, in metres.
    pub band_m: f64,
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

/// How deep an outline covers most of its width, in metres.
pub fn band_m(outline: &[Vec2], size_m: Vec2) -> f64 {
    const STEPS: u32 = 24;
    const MOST: f64 = 0.75;
    let covered = |y: f64| {
        let mut crossings: Vec<f64> = (0..outline.len())
            .map(|i| (outline[i], outline[(i + 1) % outline.len()]))
            .filter(|(a, b)| (a.y > y) != (b.y > y))
            .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
            .collect();
        crossings.sort_by(f64::total_cmp);
        crossings.chunks_exact(2).map(|c| c[1] - c[0]).sum::<f64>()
    };
    // The first steps may cut through bays and steps of the front.
    let first = STEPS / 6;
    let at = |k: u32| size_m.y * (f64::from(k) + 0.5) / f64::from(STEPS);
    let last = (first..STEPS).take_while(|k| covered(at(*k)) >= MOST * size_m.x).last();
    size_m.y * f64::from(last.map_or(STEPS / 2, |k| k + 1)) / f64::from(STEPS)
}
