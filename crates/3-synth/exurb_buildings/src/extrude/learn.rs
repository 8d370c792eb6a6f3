use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{Block, Building, City, Roof, block};
use exurb_geom::{BoxGrid, GridPoint, trig};
use exurb_operation::{Example, Failure, Run};
use serde_json::{Value, json};

use super::Params;
use super::likeness::{self, Likeness};

/// What is known of one building of an example.
#[derive(Clone, Debug)]
pub struct Sample {
    /// What it looks like from above.
    pub likeness: Likeness,
    /// Height in metres.
    pub height_m: Option<f64>,
    /// Storeys.
    pub levels: Option<f64>,
    /// Roof shape.
    pub roof: Option<Roof>,
    /// Use.
    pub usage: Option<Arc<str>>,
}

/// The buildings of all examples of which something is known.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    /// Those with height or storeys.
    pub heights: Vec<Sample>,
    /// Those with a roof shape.
    pub roofs: Vec<Sample>,
    /// All, with and without a use, so that uses are as frequent as in the example; none where it tells
    /// no uses.
    pub uses: Vec<Sample>,
    /// Correlation of ln height between neighbours in one block, in `0..=1`.
    pub block_share: f64,
}

/// Fewer known heights than this, or than this share of the buildings, are exceptions that mappers noted,
/// not a city's heights.
const ENOUGH: usize = 5;
const ENOUGH_SHARE: f64 = 0.01;
/// What OpenStreetMap's `building` says of a building's state, or nothing at all.
const NO_USE: [&str; 7] =
    ["yes", "collapsed", "construction", "damaged", "demolished", "destroyed", "ruins"];
/// No more samples are kept of each kind.
const MOST_SAMPLES: usize = 3000;
/// Correlation within a block where the example cannot tell.
const BLOCK_SHARE: f64 = 0.6;

/// What is known, in figures: heights by quartile in metres, shares of roof shapes and uses.
pub fn describe(learned: &Learned) -> Value {
    let mut heights: Vec<f64> = learned.heights.iter().filter_map(|s| s.height_m).collect();
    heights.sort_by(f64::total_cmp);
    let quartiles = [1, 2, 3].map(|k| heights.get(heights.len().saturating_sub(1) * k / 4));
    let roofs = learned.roofs.iter().filter_map(|s| s.roof).map(|roof| roof.as_str());
    let uses = learned.uses.iter().filter_map(|s| s.usage.as_deref());
    json!({
        "known_heights": learned.heights.len(),
        "height_quartiles_m": quartiles,
        "height_correlation_in_block": learned.block_share,
        "roofs": shares(roofs),
        "uses": shares(uses),
    })
}

/// The share of each word.
fn shares<'a>(words: impl Iterator<Item = &'a str>) -> BTreeMap<&'a str, f64> {
    let mut shares: BTreeMap<&str, f64> = BTreeMap::new();
    words.for_each(|word| *shares.entry(word).or_default() += 1.0);
    let total: f64 = shares.values().sum();
    shares.values_mut().for_each(|share| *share /= total);
    shares
}

/// Learns heights, roofs and uses. O(buildings · buildings nearby).
pub fn learn(examples: &[Example], params: &Params, run: &Run) -> Result<Learned, Failure> {
    let mut learned = Learned::default();
    let (mut pairs, mut count) = (Pairs::default(), 0);
    for example in examples {
        run.check()?;
        let city = &*example.city;
        let derived;
        let blocks: &[Block] = if city.blocks.is_empty() {
            derived = block::derive(&city.streets);
            &derived
        } else {
            &city.blocks
        };
        let chosen: Vec<usize> = (0..city.buildings.len())
            .filter(|i| !city.buildings[*i].is_part && city.buildings[*i].polygon.area_m2() > 5.0)
            .collect();
        let block_of = blocks_of(city, blocks, &chosen);
        let likeness = likeness::of_city(city, blocks, &chosen, &block_of);
        for ((i, likeness), block) in chosen.iter().zip(likeness).zip(block_of) {
            let sample = sample(&city.buildings[*i], likeness, params);
            if let (Some(height), Some(block)) = (sample.height_m, block) {
                pairs.add((count, block), trig::ln(height.max(1.0)));
            }
            learned.heights.extend(sample.height_m.is_some().then(|| sample.clone()));
            learned.roofs.extend(sample.roof.is_some().then(|| sample.clone()));
            learned.uses.push(sample);
        }
        count += 1;
    }
    learned.block_share = pairs.correlation().unwrap_or(BLOCK_SHARE);
    let enough = ENOUGH.max((learned.uses.len() as f64 * ENOUGH_SHARE).ceil() as usize);
    if learned.heights.len() < enough {
        learned.heights.clear();
        run.warn(
            "the example tells hardly any heights; storeys follow from footprints and their density",
        );
    }
    if learned.roofs.len() < enough {
        learned.roofs.clear();
        run.warn(
            "the example tells hardly any roof shapes; small and narrow houses get pitched roofs",
        );
    }
    if learned.uses.iter().all(|sample| sample.usage.is_none()) {
        learned.uses.clear();
    }
    for list in [&mut learned.heights, &mut learned.roofs, &mut learned.uses] {
        *list = thinned(std::mem::take(list));
    }
    Ok(learned)
}

/// Every so many-th sample of a list that is too long to be searched for every building.
fn thinned(samples: Vec<Sample>) -> Vec<Sample> {
    let step = samples.len().div_ceil(MOST_SAMPLES).max(1);
    samples.into_iter().step_by(step).collect()
}

/// Index of the block that holds each of the chosen buildings.
pub fn blocks_of(city: &City, blocks: &[Block], chosen: &[usize]) -> Vec<Option<usize>> {
    let boxes = BoxGrid::of(blocks.iter().map(|b| &b.polygon));
    let mut near = Vec::new();
    chosen
        .iter()
        .map(|i| {
            let p = GridPoint::round(city.buildings[*i].polygon.interior_point());
            boxes.meeting(p, p, &mut near);
            near.iter().map(|n| *n as usize).find(|n| blocks[*n].polygon.contains(p))
        })
        .collect()
}

fn sample(building: &Building, likeness: Likeness, params: &Params) -> Sample {
    let sane = |v: &f64| v.is_finite() && *v > 0.5 && *v < 1000.0;
    let levels = building.levels.filter(sane);
    let height_m =
        building.height_m.filter(sane).or_else(|| levels.map(|l| l * params.storey_height));
    let usage = building.usage.clone().filter(|u| !NO_USE.contains(&&**u));
    Sample { likeness, height_m, levels, roof: building.roof, usage }
}

/// Sums for the correlation of values within groups (one-way analysis of variance).
#[derive(Default)]
struct Pairs {
    groups: std::collections::BTreeMap<(usize, usize), (f64, f64, f64)>,
}

impl Pairs {
    fn add(&mut self, group: (usize, usize), value: f64) {
        let entry = self.groups.entry(group).or_insert((0.0, 0.0, 0.0));
        *entry = (entry.0 + 1.0, entry.1 + value, entry.2 + value * value);
    }

    /// Share of the variance that lies between groups; `None` with fewer than 5 groups of two.
    fn correlation(&self) -> Option<f64> {
        let groups: Vec<_> = self.groups.values().filter(|g| g.0 >= 2.0).collect();
        if groups.len() < 5 {
            return None;
        }
        let n: f64 = groups.iter().map(|g| g.0).sum();
        let mean = groups.iter().map(|g| g.1).sum::<f64>() / n;
        let within: f64 = groups.iter().map(|g| g.2 - g.1 * g.1 / g.0).sum();
        let total: f64 = groups.iter().map(|g| g.2).sum::<f64>() - n * mean * mean;
        (total > 1e-9).then(|| (1.0 - within / total).clamp(0.0, 1.0))
    }
}
