//! Buildings for cities whose example shows none.

use exurb_city::Block;
use exurb_geom::Vec2;

use crate::library::BuildingSample;

/// Blocks under this area stand in dense quarters, where houses share walls, in m².
const DENSE_BLOCK_M2: f64 = 12_000.0;

/// Rows of houses in small blocks (3 m from the kerb, 12 m deep), detached houses with 4 m to each
/// side in large ones (6 m from the kerb).
pub fn samples(block: &Block) -> Vec<BuildingSample> {
    if block.polygon.area_m2() < DENSE_BLOCK_M2 {
        return [12.0, 16.0, 20.0].map(|w| sample(Vec2::new(w, 12.0), 3.0, 0.0)).to_vec();
    }
    let sizes = [(11.0, 9.0), (13.0, 10.0), (10.0, 12.0)];
    sizes.map(|(w, d)| sample(Vec2::new(w, d), 6.0, 8.0)).to_vec()
}

fn sample(size_m: Vec2, setback_m: f64, gap_m: f64) -> BuildingSample {
    let corners = [(0.0, 0.0), (size_m.x, 0.0), (size_m.x, size_m.y), (0.0, size_m.y)];
    BuildingSample {
        frontage_m: size_m.x + gap_m,
        size_m,
        band_m: size_m.y,
        setback_m,
        gap_before_m: gap_m,
        gap_after_m: gap_m,
        turn_rad: 0.0,
        at_corner: false,
        area_m2: size_m.x * size_m.y,
        outline: vec![corners.map(|(x, y)| Vec2::new(x, y)).to_vec()],
    }
}
