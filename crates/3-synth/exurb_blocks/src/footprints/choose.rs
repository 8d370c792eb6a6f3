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

/// The sample for `lot`: alike in frontage, at a corner or not, sharing a wall with the building
/// before when that one reaches the common border, and no deeper than the lot.
pub fn choose<'a>(
    samples: &[&'a BuildingSample],
    lot: &Lot,
    depth_m: f64,
    before_touches: Option<bool>,
    rng: &mut Rng,
) -> Option<&'a BuildingSample> {
    let frontage = if lot.is_corner() { lot.width_m } else { lot.frontage_m() };
    let cost = |s: &BuildingSample| {
        let width = (trig::ln(frontage.max(1.0)) - trig::ln(s.frontage_m.max(1.0))).abs();
        let corner = if s.at_corner == lot.is_corner() { 0.0 } else { 0.3 };
        let touching = s.gap_before_m == 0.0;
        let wall = if before_touches.is_some_and(|t| t != touching) { 0.8 } else { 0.0 };
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
