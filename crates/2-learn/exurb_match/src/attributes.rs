use std::sync::Arc;

use exurb_geom::Vec2;

use crate::{
    Outline,
    shape_context::{ANGLES, BINS, Costs, RADII},
};

/// What is known of a block beside its shape. Terms of the cost for what either side lacks are
/// dropped, and the weights of the others count for more.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// Height of the ground at each sample of the outline, in metres.
    pub relief_m: Option<Vec<f64>>,
    /// Prevailing land use.
    pub land_use: Option<Arc<str>>,
    /// Share of the ground that is built on, in `0..=1`.
    pub density: Option<f64>,
    /// Mean height of the buildings in metres, by footprint.
    pub height_m: Option<f64>,
}

/// What each term of the cost weighs; they are brought to a sum of 1 (Hartmann 2018, eq. 4.1, whose
/// two terms these extend).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Shape of the outline.
    pub shape: f64,
    /// Slopes along the outline.
    pub relief: f64,
    /// Land use: 0 where equal, else 1.
    pub land_use: f64,
    /// Density: difference by sum.
    pub density: f64,
    /// Height: difference by sum.
    pub height: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { shape: 1.0, relief: 0.0, land_use: 0.0, density: 0.0, height: 0.0 }
    }
}

impl Weights {
    /// Cost of all terms but shape and relief, and their weight together.
    pub(crate) fn plain_terms(&self, a: &Attributes, b: &Attributes) -> (f64, f64) {
        let ratio = |x: f64, y: f64| if x + y > 0.0 { (x - y).abs() / (x + y) } else { 0.0 };
        let same = |x: &Arc<str>, y: &Arc<str>| if x == y { 0.0 } else { 1.0 };
        let terms = [
            (self.land_use, a.land_use.as_ref().zip(b.land_use.as_ref()).map(|(x, y)| same(x, y))),
            (self.density, a.density.zip(b.density).map(|(x, y)| ratio(x, y))),
            (self.height, a.height_m.zip(b.height_m).map(|(x, y)| ratio(x, y))),
        ];
        let known = terms.iter().filter_map(|(weight, cost)| cost.map(|c| (*weight, c)));
        known.fold((0.0, 0.0), |(sum, total), (weight, cost)| (sum + weight * cost, total + weight))
    }
}

/// Slopes from each sample to the others, by bins as those of shape contexts (Hartmann 2018, section
/// 4.1.3): the mean slope to the samples in each bin, clamped to ±1. The paper samples the relief at
/// the bins' middles; a block knows its heights along its streets only.
pub(crate) struct Slopes {
    values: Vec<[f32; BINS]>,
}

impl Slopes {
    pub(crate) fn of(outline: &Outline, heights_m: &[f64], outer_radius_m: f64) -> Self {
        let points = outline.points();
        let slopes = |(i, tangent): (usize, Vec2)| {
            let (mut sums, mut counts) = ([0.0; BINS], [0.0f64; BINS]);
            for (j, p) in points.iter().enumerate().filter(|(j, _)| *j != i) {
                let offset = *p - points[i];
                let Some(bin) = bin(offset, tangent, outer_radius_m) else { continue };
                let rise_m = heights_m.get(j).unwrap_or(&0.0) - heights_m.get(i).unwrap_or(&0.0);
                sums[bin] += (rise_m / offset.length().max(0.1)).clamp(-1.0, 1.0);
                counts[bin] += 1.0;
            }
            std::array::from_fn(|k| (sums[k] / counts[k].max(1.0)) as f32)
        };
        Self { values: outline.tangents().into_iter().enumerate().map(slopes).collect() }
    }

    /// Distance of the slopes of each pair of samples, in `0..=1`.
    pub(crate) fn costs(&self, other: &Self) -> Costs {
        let most = 2.0 * (BINS as f32).sqrt();
        let cost = |a: &[f32; BINS], b: &[f32; BINS]| {
            a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f32>().sqrt() / most
        };
        let values = self.values.iter().flat_map(|a| other.values.iter().map(move |b| cost(a, b)));
        Costs::new(other.values.len(), values.collect())
    }
}

fn bin(offset: Vec2, tangent: Vec2, outer_radius_m: f64) -> Option<usize> {
    let radius = (0..RADII)
        .find(|k| offset.length() <= outer_radius_m / f64::from(1u32 << (RADII - 1 - k)))?;
    let local = Vec2::new(tangent.x, -tangent.y).rotate(offset);
    let turn = exurb_geom::trig::angle(local) / std::f64::consts::TAU * ANGLES as f64;
    Some((turn.round() as i64).rem_euclid(ANGLES as i64) as usize * RADII + radius)
}
