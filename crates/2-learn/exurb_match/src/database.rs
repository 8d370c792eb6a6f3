use exurb_geom::{Rigid, trig};
use rstar::{RTree, primitives::GeomWithData};

use crate::attributes::Slopes;
use crate::shape_context::{Contexts, Costs, outer_radius_m};
use crate::time_warp::{self, Warp};
use crate::{Attributes, Outline, Weights, align::align};

/// One outline of a database.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its outline.
    pub outline: Outline,
    /// What else is known of it.
    pub attributes: Attributes,
}

/// Outlines with an index over area, length and aspect.
#[derive(Debug, Default)]
pub struct Database {
    entries: Vec<Entry>,
    index: RTree<GeomWithData<[f64; 3], u32>>,
}

/// What is asked of a database.
#[derive(Clone, Copy, Debug)]
pub struct Query<'a> {
    /// The outline to find the like of.
    pub outline: &'a Outline,
    /// What else is known of it.
    pub attributes: &'a Attributes,
    /// What the terms of the cost weigh.
    pub weights: Weights,
    /// Candidates that go to the time warp (Hartmann 2018, section 5.1.3: 10).
    pub candidates: usize,
    /// May an entry be mirrored?
    pub mirrored: bool,
}

impl<'a> Query<'a> {
    /// A query by shape alone, with 10 candidates.
    pub fn new(outline: &'a Outline, attributes: &'a Attributes) -> Self {
        Self { outline, attributes, weights: Weights::default(), candidates: 10, mirrored: false }
    }
}

/// An entry that is like the query.
#[derive(Clone, Debug)]
pub struct Match {
    /// Index of the entry.
    pub entry: u32,
    /// How unlike it is, all terms together, in `0..=1`.
    pub cost: f64,
    /// How unlike its shape alone is.
    pub shape_cost: f64,
    /// Which samples belong together: the query's, then the (mirrored) entry's.
    pub warp: Warp,
    /// From the entry onto the query.
    pub motion: Rigid,
}

/// What a difference in ln area, ln length and aspect weighs in the index: the first two measure the
/// same for blocks of one shape, and aspect runs from 0 to 1 only.
const AXES: [f64; 3] = [1.0, 1.0, 1.5];
/// So many times the candidates are taken from the index before the plain terms choose among them.
const WIDER: usize = 4;

impl Database {
    /// A database of `entries`. O(n log n).
    pub fn new(entries: Vec<Entry>) -> Self {
        let at = |(entry, id): (&Entry, u32)| GeomWithData::new(place(&entry.outline), id);
        let index = RTree::bulk_load(entries.iter().zip(0..).map(at).collect());
        Self { entries, index }
    }

    /// The entries.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The entry that is nearest by size and aspect. O(log n).
    pub fn nearest(&self, outline: &Outline) -> Option<u32> {
        self.index.nearest_neighbor(&place(outline)).map(|found| found.data)
    }

    /// The entries most like the query, best first; only those that `serves` accepts. Ties go to the
    /// lower index. O(log n) for the index, then one time warp a candidate.
    pub fn query(&self, query: &Query<'_>, serves: impl Fn(u32) -> bool) -> Vec<Match> {
        let candidates = self.candidates(query, serves);
        let radius_m = outer_radius_m(query.outline);
        let asked = Described::of(query.outline, query.attributes, radius_m);
        let mut found: Vec<Match> =
            candidates.into_iter().map(|id| self.compared(id, query, &asked, radius_m)).collect();
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(a.entry.cmp(&b.entry)));
        found
    }

    /// The entries that are nearest in the index and by the plain terms.
    fn candidates(&self, query: &Query<'_>, serves: impl Fn(u32) -> bool) -> Vec<u32> {
        let nearest = self
            .index
            .nearest_neighbor_iter_with_distance_2(&place(query.outline))
            .filter(|(found, _)| serves(found.data))
            .take(query.candidates * WIDER);
        let mut ranked: Vec<(f64, u32)> = nearest
            .map(|(found, square)| {
                let attributes = &self.entries[found.data as usize].attributes;
                let (plain, _) = query.weights.plain_terms(query.attributes, attributes);
                (square.sqrt() * query.weights.shape + plain, found.data)
            })
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        ranked.truncate(query.candidates);
        ranked.into_iter().map(|(_, id)| id).collect()
    }

    fn compared(&self, id: u32, query: &Query<'_>, asked: &Described, radius_m: f64) -> Match {
        let entry = &self.entries[id as usize];
        let plain = Described::of(&entry.outline, &entry.attributes, radius_m);
        let plain_slopes = plain.slopes.is_some();
        let (mut warp, mut shape_cost) = asked.warp(&plain, &query.weights);
        let mut motion = align(&entry.outline, query.outline, &warp);
        if query.mirrored {
            let outline = entry.outline.mirrored();
            let mut attributes = entry.attributes.clone();
            if let Some(relief) = &mut attributes.relief_m {
                relief[1..].reverse();
            }
            let other = Described::of(&outline, &attributes, radius_m);
            let (other_warp, other_shape) = asked.warp(&other, &query.weights);
            if other_warp.cost < warp.cost {
                motion = Rigid { mirrored: true, ..align(&outline, query.outline, &other_warp) };
                (warp, shape_cost) = (other_warp, other_shape);
            }
        }
        let (plain, plain_weight) = query.weights.plain_terms(query.attributes, &entry.attributes);
        let has_relief = asked.slopes.is_some() && plain_slopes;
        let path_weight = query.weights.shape + if has_relief { query.weights.relief } else { 0.0 };
        let total = (path_weight + plain_weight).max(f64::MIN_POSITIVE);
        let cost = (warp.cost * path_weight + plain) / total;
        Match { entry: id, cost, shape_cost, warp, motion }
    }
}

fn place(outline: &Outline) -> [f64; 3] {
    let ln = |v: f64| trig::ln(v.max(1e-3));
    [ln(outline.area_m2) * AXES[0], ln(outline.length_m) * AXES[1], outline.aspect * AXES[2]]
}

/// An outline as the time warp compares it.
struct Described {
    contexts: Contexts,
    slopes: Option<Slopes>,
}

impl Described {
    fn of(outline: &Outline, attributes: &Attributes, radius_m: f64) -> Self {
        let slopes = attributes.relief_m.as_ref().map(|h| Slopes::of(outline, h, radius_m));
        Self { contexts: Contexts::of(outline, radius_m), slopes }
    }

    /// The path, and the mean cost of the shape along it.
    fn warp(&self, other: &Self, weights: &Weights) -> (Warp, f64) {
        let shape = self.contexts.costs(&other.contexts);
        let share = weights.shape / (weights.shape + weights.relief).max(f64::MIN_POSITIVE);
        match (&self.slopes, &other.slopes) {
            (Some(a), Some(b)) if weights.relief > 0.0 => {
                let warp = time_warp::cyclic(&shape.clone().mixed(share as f32, &a.costs(b)));
                let shape_cost = mean_along(&shape, &warp);
                (warp, shape_cost)
            }
            _ => {
                let warp = time_warp::cyclic(&shape);
                let cost = warp.cost;
                (warp, cost)
            }
        }
    }
}

fn mean_along(costs: &Costs, warp: &Warp) -> f64 {
    let at = |(i, j): &(u32, u32)| f64::from(costs.row(*i as usize)[*j as usize % costs.columns()]);
    warp.path.iter().map(at).sum::<f64>() / warp.path.len().max(1) as f64
}

#[cfg(test)]
mod tests;
