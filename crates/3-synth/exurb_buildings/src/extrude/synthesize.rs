//! The pure core: a building's likeness, its block's chance and its own → height, storeys, roof, use.

use std::sync::Arc;

use exurb_city::Roof;
use exurb_geom::trig;
use exurb_operation::Rng;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::Params;
use super::defaults;
use super::learn::{Learned, Sample};
use super::likeness::{Likeness, square_distance};

/// A building takes its use from one no more than so many times as large or small.
const MOST_AREA_RATIO: f64 = 2.0;
/// What has one storey by its use is no higher than this, in metres.
pub const LOW_M: f64 = 4.0;

/// Has a building of this use one storey?
pub fn is_low(usage: &str) -> bool {
    const LOW: [&str; 10] = [
        "carport",
        "garage",
        "garages",
        "greenhouse",
        "hut",
        "kiosk",
        "roof",
        "service",
        "shed",
        "toilets",
    ];
    LOW.contains(&usage)
}

/// What one building becomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Height of the top above ground in metres.
    pub height_m: f64,
    /// Storeys above ground.
    pub levels: f64,
    /// Roof shape.
    pub roof: Roof,
    /// Use, where the example tells.
    pub usage: Option<Arc<str>>,
}

/// What the buildings of one block share, as standard normal and uniform draws.
#[derive(Clone, Copy, Debug)]
pub struct BlockDraw {
    height: f64,
    roof: f64,
}

impl BlockDraw {
    /// Draws for one block.
    pub fn new(rng: &mut Rng) -> Self {
        Self { height: StandardNormal.sample(rng), roof: rng.random() }
    }
}

/// The shape of a building. Its height is the example's at a quantile that it shares with its block
/// to the learned degree (a Gaussian copula), among the buildings most like it. O(samples).
pub fn synthesize(
    likeness: &Likeness,
    learned: &Learned,
    block: &BlockDraw,
    params: &Params,
    rng: &mut Rng,
) -> Shape {
    let shared = if params.block_share < 0.0 { learned.block_share } else { params.block_share };
    let own: f64 = StandardNormal.sample(rng);
    let quantile = normal_cdf(shared.sqrt() * block.height + (1.0 - shared).sqrt() * own);
    let (roof_draw, use_draw): (f64, f64) = (rng.random(), rng.random());

    let uses = nearest(&learned.uses, likeness, params.neighbours);
    let usage = at_quantile(&uses, use_draw)
        .filter(|s| (s.likeness[0] - likeness[0]).abs() < trig::ln(MOST_AREA_RATIO))
        .and_then(|s| s.usage.clone());

    let mut like = nearest(&learned.heights, likeness, params.neighbours);
    like.sort_by(|a, b| a.height_m.unwrap_or(0.0).total_cmp(&b.height_m.unwrap_or(0.0)));
    let (height_m, levels) = match at_quantile(&like, quantile) {
        Some(sample) => {
            let height = sample.height_m.unwrap_or(params.storey_height) * params.height_factor;
            let storeys = (height / params.storey_height).round().max(1.0);
            let told = sample.levels.filter(|_| params.height_factor == 1.0);
            (height, told.unwrap_or(storeys))
        }
        None => {
            let levels = defaults::levels(likeness, quantile);
            let levels = (levels * params.height_factor).round().max(1.0);
            (levels * params.storey_height, levels)
        }
    };
    let (height_m, levels) = match &usage {
        Some(usage) if is_low(usage) => (height_m.min(LOW_M), 1.0),
        _ => (height_m, levels),
    };
    // Half of the blocks have one kind of roof, in the others each house has its own.
    let roof_draw = if block.roof < 0.5 { block.roof * 2.0 } else { roof_draw };
    let roofs = nearest(&learned.roofs, likeness, params.neighbours);
    let roof = at_quantile(&roofs, roof_draw)
        .and_then(|s| s.roof)
        .map_or_else(|| defaults::roof(likeness, levels), simplified);
    Shape { height_m, levels, roof, usage }
}

/// The `count` samples most like a building, most like first.
fn nearest<'a>(samples: &'a [Sample], likeness: &Likeness, count: usize) -> Vec<&'a Sample> {
    let mut ranked: Vec<(f64, usize)> = samples
        .iter()
        .enumerate()
        .map(|(i, s)| (square_distance(&s.likeness, likeness), i))
        .collect();
    let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if count < ranked.len() {
        ranked.select_nth_unstable_by(count, order);
        ranked.truncate(count);
    }
    ranked.sort_by(order);
    ranked.into_iter().map(|(_, i)| &samples[i]).collect()
}

fn at_quantile<'a>(samples: &[&'a Sample], quantile: f64) -> Option<&'a Sample> {
    let at = (quantile * samples.len() as f64) as usize;
    samples.get(at.min(samples.len().checked_sub(1)?)).copied()
}

/// Roofs that are made: flat, gabled, hipped; pyramids and the like are nearest to one of them.
fn simplified(roof: Roof) -> Roof {
    match roof {
        Roof::Flat | Roof::Dome | Roof::Round => Roof::Flat,
        Roof::Gabled | Roof::Skillion | Roof::Gambrel => Roof::Gabled,
        Roof::Hipped | Roof::Pyramidal | Roof::HalfHipped | Roof::Mansard => Roof::Hipped,
    }
}

/// Share of the standard normal distribution below `z`.
fn normal_cdf(z: f64) -> f64 {
    0.5 * trig::erfc(-z / std::f64::consts::SQRT_2)
}
