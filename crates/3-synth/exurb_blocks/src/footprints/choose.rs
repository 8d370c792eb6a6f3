//! Which building of the example stands on which lot.

use exurb_geom::trig;
use exurb_operation::Rng;
use rand::RngExt;

use super::lot::Lot;
use crate::library::{BuildingSample, ExampleBlock};

/// A lot draws one of this many samples that suit it best.
const BEST: usize = 4;
/// A donor with fewer buildings is helped out by like blocks.
const ENOUGH: usize = 4;

/// The buildings of the first donor, and of like blocks where it has few.
pub fn samples<'a>(donors: &[&'a ExampleBlock]) -> Vec<&'a BuildingSample> {
    let mut out = Vec::new();
    for donor in donors.iter().filter(|d| d.open.is_none()) {
        if out.len() >= ENOUGH {
            break;
        }
        out.extend(&donor.buildings);
    }
    out
}

/// Which borders between lots along the kerb are shared walls: the first donor's, in order from a
/// place drawn at random, so that rows are as long as in the example.
pub fn walls<'a>(
    samples: &[&'a BuildingSample],
    rng: &mut Rng,
) -> impl Iterator<Item = bool> + use<'a> {
    let start = rng.random::<u32>() as usize % samples.len().max(1);
    let walls: Vec<bool> = samples.iter().map(|s| s.gap_after_m == 0.0).collect();
    (start..).map(move |k| walls.get(k % walls.len().max(1)).copied().unwrap_or(false))
}

/// The sample for `lot`: alike in frontage, at a corner or not, in sharing walls, and no deeper than
/// the lot.
pub fn choose<'a>(
    samples: &[&'a BuildingSample],
    lot: &Lot,
    depth_m: f64,
    walls: (bool, bool),
    rng: &mut Rng,
) -> Option<&'a BuildingSample> {
    let frontage = if lot.is_corner() { lot.width_m } else { lot.frontage_m() };
    let cost = |s: &BuildingSample| {
        let width = (trig::ln(frontage.max(1.0)) - trig::ln(s.frontage_m.max(1.0))).abs();
        let corner = if s.at_corner == lot.is_corner() { 0.0 } else { 0.3 };
        let differs = |wall: bool, gap_m: f64| if wall == (gap_m == 0.0) { 0.0 } else { 0.5 };
        let wall = differs(walls.0, s.gap_before_m) + differs(walls.1, s.gap_after_m);
        let deep = ((s.setback_m + s.size_m.y - depth_m) / depth_m.max(1.0)).max(0.0);
        width + corner + wall + deep
    };
    let mut ranked: Vec<(f64, usize)> =
        samples.iter().enumerate().map(|(i, s)| (cost(s), i)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.truncate(BEST);
    let weight = |c: f64| trig::exp(-4.0 * (c - ranked[0].0));
    let total: f64 = ranked.iter().map(|r| weight(r.0)).sum();
    let mut left = rng.random::<f64>() * total;
    let drawn = ranked.iter().find(|r| {
        left -= weight(r.0);
        left < 0.0
    });
    drawn.or(ranked.first()).map(|r| samples[r.1])
}
