use std::collections::BTreeMap;

use exurb_city::{Block, BlockClass, City, block};
use exurb_match::{Attributes, Match, Query, align};
use exurb_operation::{Example, Failure, Run};

use super::candidate::Site;
use super::descriptor::{Descriptor, Spread};
use super::field::Sample;
use super::kinds::{Kind, Situation};
use crate::database::{BY_SHAPE, BlockDatabase, Layout};
use crate::kerb::Kerb;
use crate::neighbours::{MainStreets, neighbours};

/// What is learned of the examples' blocks.
#[derive(Debug)]
pub struct Learned {
    /// The layouts.
    pub database: BlockDatabase,
    /// How much they differ, and neighbours among them.
    pub spread: Spread,
    /// Share of all blocks together that is built on; those that the map keeps open do not count.
    pub coverage: f64,
    /// The same of the blocks of each kind.
    coverages: BTreeMap<Kind, f64>,
    /// How densely and how high ordinary blocks are built.
    pub samples: Vec<Sample>,
    /// Where which kind of block lies.
    pub situations: Vec<(Kind, Situation)>,
}

impl Learned {
    /// Learns from all examples.
    pub fn of(examples: &[Example], run: &Run) -> Result<Self, Failure> {
        let database = BlockDatabase::of(examples, run)?;
        let looks: Vec<Descriptor> = database
            .layouts
            .iter()
            .map(|l| {
                let footprints = l.footprints.iter().map(|f| &f.building.polygon);
                Descriptor::of(&l.kerb, &Kerb::of(&l.kerb), footprints)
            })
            .collect();
        let numbers: BTreeMap<(&str, u32), usize> =
            database.layouts.iter().enumerate().map(|(k, l)| ((&*l.source, l.id), k)).collect();
        let mut pairs = Vec::new();
        let mut situations = Vec::new();
        for example in examples {
            run.check()?;
            let city = &*example.city;
            let derived;
            let blocks: &[Block] = match city.blocks.is_empty() {
                true => {
                    derived = block::derive(&city.streets);
                    &derived
                }
                false => &city.blocks,
            };
            let at = |b: &Block| numbers.get(&(&*city.metadata.name, b.id)).copied();
            let index: Vec<Option<usize>> = blocks.iter().map(at).collect();
            for (i, list) in neighbours(blocks).into_iter().enumerate() {
                let ordinary = |k: &usize| database.layouts[*k].kind.is_none();
                let others = list.into_iter().filter(|j| *j > i);
                pairs.extend(others.filter_map(|j| {
                    Some((index[i].filter(ordinary)?, index[j].filter(ordinary)?))
                }));
            }
            let main = MainStreets::of(&city.streets);
            for k in index.into_iter().flatten() {
                let layout = &database.layouts[k];
                let at = layout.kerb.centroid();
                let (features, main_m) = (layout.features, main.distance_m(at));
                situations.push((layout.kind.clone(), Situation { features, main_m, at }));
            }
        }
        let samples = database.layouts.iter().filter(|l| l.kind.is_none()).map(|l| Sample {
            features: l.features,
            coverage: l.coverage,
            height_m: l.height_m,
            weight: l.weight,
        });
        let all = database.layouts.iter().filter(|l| !l.is_given_open);
        let mut by_kind: BTreeMap<Kind, Vec<&Layout>> = BTreeMap::new();
        for layout in &database.layouts {
            by_kind.entry(layout.kind.clone()).or_default().push(layout);
        }
        let coverages =
            by_kind.into_iter().map(|(kind, list)| (kind, coverage(list.into_iter()))).collect();
        Ok(Self {
            coverage: coverage(all),
            coverages,
            samples: samples.collect(),
            spread: Spread::of(&looks, &pairs),
            situations,
            database,
        })
    }

    /// The coverage of the example's blocks of a kind.
    pub fn coverage_of(&self, kind: &Kind) -> f64 {
        self.coverages.get(kind).copied().unwrap_or(0.0)
    }

    /// Names of the examples with layouts, in order.
    pub fn sources(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.database.layouts.iter().map(|l| &*l.source).collect();
        names.dedup();
        names
    }

    /// The layout of the very block, where it lies in an example.
    pub fn same(&self, site: &Site<'_>) -> Option<Match> {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-4 * b;
        let is_alike = |entry: u32| {
            let outline = self.database.outline(entry);
            near(outline.area_m2, site.outline.area_m2)
                && near(outline.length_m, site.outline.length_m)
        };
        // Most blocks need no time warp to be told apart.
        self.database.nearest(&site.outline).filter(|entry| is_alike(*entry))?;
        let attributes = Attributes::default();
        let query =
            Query { candidates: 1, weights: BY_SHAPE, ..Query::new(&site.outline, &attributes) };
        let found = self.database.query(&query, |_| true).into_iter().next()?;
        let outline = self.database.outline(found.entry);
        let motion = align::refine(found.motion, outline, &site.ring);
        (align::deviation_m(&motion, outline, &site.ring) < 0.002).then_some(found)
    }
}

/// Share of layouts' blocks together that is built on, examples by their weight.
fn coverage<'a>(layouts: impl Iterator<Item = &'a Layout>) -> f64 {
    let (built, area) = layouts.fold((0.0, 0.0), |(built, area), l| {
        (built + l.weight * l.built_m2(), area + l.weight * l.kerb.area_m2())
    });
    if area > 0.0 { built / area } else { 0.0 }
}

/// Coverage and mean height of each block that is built on, as the city has it.
pub fn built(city: &City, blocks: &[Block]) -> Vec<Option<(f64, Option<f64>)>> {
    let numbers: BTreeMap<u32, usize> = blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
    let mut sums = vec![(0.0, 0.0, 0.0); blocks.len()];
    for building in city.buildings.iter().filter(|b| !b.is_part) {
        if let Some(i) = numbers.get(&building.block) {
            let area = building.polygon.area_m2();
            sums[*i].0 += area;
            if let Some(height) = building.known_height_m() {
                sums[*i].1 += height * area;
                sums[*i].2 += area;
            }
        }
    }
    let value = |(block, (built, height, known)): (&Block, (f64, f64, f64))| {
        let mean = (known > 0.0).then(|| height / known);
        (built > 0.0 && block.class == BlockClass::Block)
            .then(|| (built / block.polygon.area_m2(), mean))
    };
    blocks.iter().zip(sums).map(value).collect()
}
