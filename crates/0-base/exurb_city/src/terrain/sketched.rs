//! Plausible ground for a sketch of land uses (Nishida et al. 2015, section 3 and fig. 13).
//!
//! The paper paints heights together with uses. Here uses alone are enough: shores fall gently to the
//! water, mountains rise from their edge with seeded relief, everything else is nearly flat.

use exurb_geom::{Bounds, Vec2, contour};

use super::{Terrain, TerrainError};

/// What somebody drew.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SketchedUse {
    /// Sea, lake or river.
    Water,
    /// Low land by the sea.
    Coast,
    /// Nearly flat land; where nothing is drawn.
    Flat,
    /// Land kept free of buildings.
    Park,
    /// Hills and mountains.
    Mountain,
}

impl SketchedUse {
    /// All, by the word that a file uses.
    pub const ALL: [(&'static str, Self); 5] = [
        ("water", Self::Water),
        ("coast", Self::Coast),
        ("flat", Self::Flat),
        ("park", Self::Park),
        ("mountain", Self::Mountain),
    ];

    /// The use of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(word, _)| *word == name).map(|(_, kind)| *kind)
    }
}

/// Distance of neighbouring heights of sketched ground, in metres.
pub const SKETCH_CELL_M: f64 = 20.0;
/// Height of flat land over the water, in metres, and how far from the shore it is reached.
const FLAT_M: f64 = 8.0;
const SHORE_M: f64 = 130.0;
/// The deepest water, and how steeply the ground falls to it.
const DEEPEST_M: f64 = 12.0;
const BED_SLOPE: f64 = 0.08;
/// Mountains rise by this over the distance from their edge, and by no more and no less.
const RISE: f64 = 0.2;
const HEIGHT_M: std::ops::RangeInclusive<f64> = 35.0..=260.0;
/// Size of hills in mountains, and of the unevenness of flat land, in metres.
const HILL_M: f64 = 420.0;
const UNEVEN_M: f64 = 350.0;

/// Ground for the uses that `use_at` tells, over `bounds`, the water's level at 0. The same seed
/// gives the same hills. O(heights).
pub fn sketched(
    bounds: Bounds,
    use_at: impl Fn(Vec2) -> SketchedUse,
    seed: u64,
) -> Result<Terrain, TerrainError> {
    let flat = Terrain::over(bounds, SKETCH_CELL_M, |_| 0.0)?;
    let (columns, rows) = (flat.columns(), flat.rows());
    let uses: Vec<SketchedUse> =
        (0..columns * rows).map(|i| use_at(flat.post(i % columns, i / columns))).collect();
    let to = |wanted: &dyn Fn(SketchedUse) -> bool| {
        distances_m(&uses.iter().map(|u| wanted(*u)).collect::<Vec<_>>(), columns)
    };
    let to_water = to(&|u| u == SketchedUse::Water);
    let to_land = to(&|u| u != SketchedUse::Water);
    let into_mountain = to(&|u| u != SketchedUse::Mountain);
    let mut heights: Vec<f32> = (0..uses.len())
        .map(|i| {
            let p = flat.post(i % columns, i / columns);
            let height = if uses[i] == SketchedUse::Water {
                -(0.8 + (to_land[i] * BED_SLOPE).min(DEEPEST_M))
            } else {
                land_m(p, to_water[i], seed) + mountain_m(p, into_mountain[i], seed)
            };
            height as f32
        })
        .collect();
    smooth(&mut heights, columns);
    let terrain = Terrain::new(flat.first(), flat.cell_mm(), columns, heights)?;
    Ok(terrain.with_water_level(Some(0.0)))
}

/// Areas of one use as the sketch shows them on its grid.
pub fn sketched_areas(
    bounds: Bounds,
    use_at: impl Fn(Vec2) -> SketchedUse,
    wanted: SketchedUse,
) -> Result<Vec<exurb_geom::Polygon>, TerrainError> {
    let side = |p: Vec2| if use_at(p) == wanted { -1.0 } else { 1.0 };
    let mask = Terrain::over(bounds, SKETCH_CELL_M, side)?;
    Ok(contour::below(
        contour::Values {
            values: mask.heights(),
            columns: mask.columns(),
            first: mask.first().to_m(),
            step_m: mask.cell_m(),
        },
        0.0,
    ))
}

fn land_m(p: Vec2, to_water_m: f64, seed: u64) -> f64 {
    let rise = (to_water_m / SHORE_M).min(1.0);
    let rise = rise * (2.0 - rise);
    0.8 + (FLAT_M + 3.0 * (relief(p / UNEVEN_M, seed) - 0.5)) * rise
}

fn mountain_m(p: Vec2, inside_m: f64, seed: u64) -> f64 {
    if inside_m <= 0.0 {
        return 0.0;
    }
    let hills = relief(p / HILL_M, seed ^ 0x5EED);
    let height = (RISE * inside_m.min(1500.0)).min(*HEIGHT_M.end());
    // Near its edge a mountain is as high as the edge lets it be; hills stand on it.
    let floor = *HEIGHT_M.start() * smoothstep((inside_m / 400.0).min(1.0));
    height * (0.45 + 0.75 * hills) + floor * hills
}

/// Distance in metres from every post to the nearest that `is` marks, along rows, columns and
/// diagonals: at most 4 % too large.
fn distances_m(is: &[bool], columns: usize) -> Vec<f64> {
    const FAR: f64 = 1e9;
    let rows = is.len() / columns.max(1);
    let mut out: Vec<f64> = is.iter().map(|m| if *m { 0.0 } else { FAR }).collect();
    // The forward pass looks west and south, the backward pass east and north.
    let steps = [(-1_i64, 0_i64, 1.0), (0, -1, 1.0), (-1, -1, 1.414), (1, -1, 1.414)];
    let steps: Vec<_> = steps
        .into_iter()
        .chain([(-2, -1, 2.236), (2, -1, 2.236), (-1, -2, 2.236), (1, -2, 2.236)])
        .collect();
    let at = |column: i64, row: i64| {
        let inside = (0..columns as i64).contains(&column) && (0..rows as i64).contains(&row);
        inside.then(|| row as usize * columns + column as usize)
    };
    for sign in [1, -1] {
        for k in 0..out.len() {
            let i = if sign > 0 { k } else { out.len() - 1 - k };
            let (column, row) = ((i % columns) as i64, (i / columns) as i64);
            for (dx, dy, length) in &steps {
                if let Some(j) = at(column + sign * dx, row + sign * dy) {
                    out[i] = out[i].min(out[j] + length);
                }
            }
        }
    }
    out.iter().map(|d| if *d >= FAR { f64::INFINITY } else { d * SKETCH_CELL_M }).collect()
}

/// Every height becomes the mean of those around; dry land stays dry and water wet.
fn smooth(heights: &mut [f32], columns: usize) {
    let rows = heights.len() / columns.max(1);
    let before = heights.to_vec();
    for (i, height) in heights.iter_mut().enumerate() {
        let (column, row) = (i % columns, i / columns);
        let (mut sum, mut count) = (0.0, 0.0);
        for y in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
            for x in column.saturating_sub(1)..=(column + 1).min(columns - 1) {
                sum += before[y * columns + x];
                count += 1.0;
            }
        }
        let mean: f32 = sum / count;
        *height = if *height < 0.0 { mean.min(-0.3) } else { mean.max(0.3) };
    }
}

/// Value noise of four octaves, 0 to 1.
fn relief(p: Vec2, seed: u64) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for octave in 0..4_u32 {
        let scale = f64::from(1 << octave);
        sum += noise(p * scale, seed.wrapping_add(u64::from(octave))) / scale;
        total += 1.0 / scale;
    }
    sum / total
}

fn noise(p: Vec2, seed: u64) -> f64 {
    let (cell, part) = (p.floor(), p - p.floor());
    let (u, v) = (smoothstep(part.x), smoothstep(part.y));
    let corner = |dx: f64, dy: f64| random((cell.x + dx) as i64, (cell.y + dy) as i64, seed);
    let low = corner(0.0, 0.0) * (1.0 - u) + corner(1.0, 0.0) * u;
    let high = corner(0.0, 1.0) * (1.0 - u) + corner(1.0, 1.0) * u;
    low * (1.0 - v) + high * v
}

fn smoothstep(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// A number in 0..1 for a corner of the lattice (the finaliser of SplitMix64).
fn random(x: i64, y: i64, seed: u64) -> f64 {
    let mut z = seed
        .wrapping_add((x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15))
        .wrapping_add((y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn use_at(p: Vec2) -> SketchedUse {
        match () {
            () if p.x < 600.0 => SketchedUse::Water,
            () if p.x > 1500.0 => SketchedUse::Mountain,
            () => SketchedUse::Flat,
        }
    }

    #[test]
    fn ground_is_dry_where_land_is_drawn_and_rises_into_mountains() {
        let bounds = Bounds { min: Vec2::ZERO, max: Vec2::splat(2600.0) };
        let terrain = sketched(bounds, use_at, 7).expect("small");
        assert_eq!(terrain, sketched(bounds, use_at, 7).expect("small"));
        assert_ne!(terrain, sketched(bounds, use_at, 8).expect("small"));
        for row in 0..terrain.rows() {
            for column in 0..terrain.columns() {
                let p = terrain.post(column, row);
                let height = terrain.heights()[row * terrain.columns() + column];
                assert_eq!(height < 0.0, use_at(p) == SketchedUse::Water, "{p}: {height}");
            }
        }
        let mean = |x: f64| {
            let heights =
                (10..250).filter_map(|i| terrain.height_m(Vec2::new(x, f64::from(i) * 10.0)));
            let (sum, count) = heights.fold((0.0, 0.0), |(s, n), h| (s + h, n + 1.0));
            sum / count
        };
        assert!(mean(620.0) < mean(1000.0) && mean(1000.0) < 14.0, "{}", mean(1000.0));
        assert!(mean(2500.0) > mean(1600.0) + 60.0, "{} {}", mean(1600.0), mean(2500.0));
    }

    #[test]
    fn distances_are_near_the_straight_ones() {
        let columns = 60;
        let is: Vec<bool> = (0..columns * columns).map(|i| i == 30 * columns + 30).collect();
        for (i, d) in distances_m(&is, columns).iter().enumerate() {
            let apart = Vec2::new((i % columns) as f64 - 30.0, (i / columns) as f64 - 30.0);
            let straight = apart.length() * SKETCH_CELL_M;
            assert!((0.999 * straight..=1.05 * straight).contains(d), "{d} {straight}");
        }
    }
}
