//! All blocks choose together.

use exurb_city::Block;
use exurb_geom::{GridPoint, trig};
use exurb_operation::{Rng, Run, rng};
use rand::RngExt;
use rayon::prelude::*;

use super::candidate::{ANY, Candidate, SMALL, Site, USUAL, filled_up};
use super::field::Place;
use super::level::{self, Expected};
use super::{Choosing, Learned, joint};
use crate::fill::Limits;
use crate::library::OpenLand;

/// What a factor of e between wanted and reached coverage costs.
const COVERAGE_COST: f64 = 0.15;
/// What a layout that is lost altogether costs.
const LOSS_COST: f64 = 0.3;
/// What a layout costs that does not suit the block.
const UNSUITED_COST: f64 = 1.0;
/// What neighbours cost that look as different as any two blocks, at a coherence of 1.
const PAIR_COST: f64 = 0.12;
/// What two neighbours of one layout cost.
const SAME_LAYOUT_COST: f64 = 0.06;
/// Spread of the draw among the best.
const PICK_SPREAD: f64 = 0.04;
/// Rounds in which the coverage of all is brought to what it should be.
const LEVEL_ROUNDS: usize = 8;
/// Wishes are raised or lowered by this factor at most.
const MOST_LEVEL: f64 = 3.0;
/// A factor of e by which wishes are raised is worth so many by which the coverage of all comes nearer.
const LEVEL_PRICE: f64 = 0.03;
/// The coverage of all is right within this share.
const NEAR: f64 = 0.03;
/// Rounds in which blocks are filled up: with buildings of which sizes, and how near to the coverage of all.
const FILL_ROUNDS: [(f64, f64); 5] =
    [(USUAL, NEAR), (USUAL, NEAR), (SMALL, NEAR), (SMALL, NEAR), (ANY, 2.0 * NEAR)];
/// A block that reaches less than this share of what it should has no room left.
const FULL: f64 = 0.97;

/// What the choice of all blocks hangs on.
pub struct Together<'a> {
    /// The blocks.
    pub blocks: &'a [Block],
    /// What is expected of those to be filled with another block's layout.
    pub expected: &'a [Option<Expected>],
    /// Share of each block to be built on.
    pub wishes: &'a [f64],
    /// What all of them should build on together, in m².
    pub total_m2: f64,
    /// The examples.
    pub learned: &'a Learned,
    /// What a user turned.
    pub choosing: &'a Choosing,
    /// When a layout does not suit a block.
    pub limits: Limits,
}

impl Together<'_> {
    /// The candidates of each block, the chosen one first.
    pub fn chosen(&self, tried: &[Vec<Candidate>], places: &[Place], run: &Run) -> Vec<Vec<usize>> {
        let count = self.blocks.len();
        let noise: Vec<Vec<f64>> = self
            .blocks
            .iter()
            .zip(tried)
            .map(|(block, tried)| {
                let key = rng::place_key(GridPoint::round(block.polygon.centroid()));
                noise(tried.len(), self.choosing, &mut run.stream(key))
            })
            .collect();
        let neighbours: Vec<Vec<usize>> = places.iter().map(|p| p.neighbours.clone()).collect();
        let spread = &self.learned.spread;
        let strength = PAIR_COST * self.choosing.coherence * spread.coherence;
        let pair = |(i, a): (usize, usize), (j, b): (usize, usize)| {
            let (a, b) = (&tried[i][a], &tried[j][b]);
            let one = if a.entry == b.entry && !a.is_same { SAME_LAYOUT_COST } else { 0.0 };
            strength * spread.distance(&a.looks, &b.looks).min(2.0) + one
        };
        let (mut level, mut low, mut high): (f64, f64, f64) = (1.0, 1.0 / MOST_LEVEL, MOST_LEVEL);
        let mut best: Option<(f64, Vec<usize>, joint::Problem)> = None;
        for _ in 0..LEVEL_ROUNDS {
            let costs = (0..count).map(|i| {
                let own = |(c, noise): (&Candidate, &f64)| self.own_cost(i, c, level) + noise;
                tried[i].iter().zip(&noise[i]).map(own).collect()
            });
            let problem = joint::Problem { costs: costs.collect(), neighbours: neighbours.clone() };
            let chosen = joint::choose(&problem, pair);
            let built_m2: f64 = (0..count).map(|i| self.built_m2(i, tried[i].get(chosen[i]))).sum();
            let off = trig::ln(self.total_m2.max(1.0) / built_m2.max(1.0));
            let price = off.abs() + LEVEL_PRICE * trig::ln(level).abs();
            if best.as_ref().is_none_or(|b| price < b.0) {
                best = Some((price, chosen, problem));
            }
            if off.abs() < NEAR {
                break;
            }
            (low, high) = if off > 0.0 { (level, high) } else { (low, level) };
            level = (low * high).sqrt();
        }
        let Some((_, chosen, problem)) = best else { return Vec::new() };
        (0..count).map(|i| self.ranked(&problem.costs[i], chosen[i])).collect()
    }

    /// Candidates by cost, the chosen one first, or the alternative that was asked for.
    fn ranked(&self, costs: &[f64], chosen: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|a, b| {
            (*b == chosen).cmp(&(*a == chosen)).then(costs[*a].total_cmp(&costs[*b])).then(a.cmp(b))
        });
        let skip = (self.choosing.alternative as usize - 1).min(order.len().saturating_sub(1));
        if !order.is_empty() {
            order[..=skip].rotate_right(1);
        }
        order
    }

    /// What a candidate costs by itself, where wishes are raised by a factor.
    fn own_cost(&self, i: usize, candidate: &Candidate, level: f64) -> f64 {
        let slack = 0.02;
        let off = match &self.expected[i] {
            Some(e) if e.is_ordinary => {
                let wish = self.wishes[i] * level;
                trig::ln((candidate.looks.coverage() + slack) / (wish + slack)).abs()
            }
            _ => 0.0,
        };
        let unsuited = if self.limits.admit(candidate) { 0.0 } else { UNSUITED_COST };
        candidate.cost + COVERAGE_COST * off + LOSS_COST * (1.0 - candidate.kept) + unsuited
    }

    /// What a block adds to the total, in m²: what the candidate builds, or, where that does not suit and
    /// parcels will take its place, what is expected of the block by itself.
    fn built_m2(&self, i: usize, candidate: Option<&Candidate>) -> f64 {
        match (&self.expected[i], candidate) {
            (Some(_), Some(c)) if self.limits.admit(c) => c.laid.built_m2(),
            (Some(e), Some(_)) => e.area_m2 * e.coverage,
            _ => 0.0,
        }
    }

    /// Where all together are built on less than they should be, adds buildings of the chosen layouts to
    /// ordinary blocks, as their wishes say and as far as there is room.
    pub fn fill_up(
        &self,
        tried: &mut [Vec<Candidate>],
        ranked: &[Vec<usize>],
        sites: &[Option<Site<'_>>],
        open: &OpenLand,
    ) {
        let count = self.blocks.len();
        let fillable: Vec<bool> = (0..count)
            .map(|i| {
                let first = ranked[i].first().map(|k| &tried[i][*k]);
                self.expected[i].is_some_and(|e| e.is_ordinary)
                    && first.is_some_and(|c| self.limits.admit(c))
            })
            .collect();
        let mut has_room = fillable.clone();
        let mut smallest = USUAL;
        for (least, near) in FILL_ROUNDS {
            if least < smallest {
                // There may be room for smaller ones.
                has_room.clone_from(&fillable);
                smallest = least;
            }
            let enough_m2 = self.total_m2 * (1.0 - near);
            let now: Vec<f64> = (0..count)
                .map(|i| self.built_m2(i, ranked[i].first().map(|k| &tried[i][*k])))
                .collect();
            if now.iter().sum::<f64>() > enough_m2 {
                return;
            }
            let goal_m2 = |i: usize, factor: f64| match &self.expected[i] {
                Some(e) if has_room[i] => {
                    let wished = Expected { coverage: self.wishes[i], ..*e };
                    now[i].max(e.area_m2 * level::raised(&wished, factor))
                }
                _ => now[i],
            };
            let sum = |factor: f64| (0..count).map(|i| goal_m2(i, factor)).sum();
            let factor = level::solved(sum, (enough_m2 + self.total_m2) / 2.0);
            let goals_m2: Vec<f64> = (0..count).map(|i| goal_m2(i, factor)).collect();
            tried.par_iter_mut().enumerate().for_each(|(i, tried)| {
                if let (Some(site), true) = (&sites[i], goals_m2[i] > now[i]) {
                    let near = open.near(&site.block.polygon);
                    let (first, goal) = (ranked[i][0], (goals_m2[i], least));
                    filled_up(site, tried, first, self.learned, self.choosing, &near, goal);
                }
            });
            for i in (0..count).filter(|i| goals_m2[*i] > now[*i]) {
                has_room[i] &= tried[i][ranked[i][0]].laid.built_m2() > FULL * goals_m2[i];
            }
        }
    }
}

/// What draws among the best: nothing for one, else costs whose cheapest is drawn (Gumbel).
fn noise(count: usize, choosing: &Choosing, rng: &mut Rng) -> Vec<f64> {
    let pick = choosing.pick as usize;
    (0..count)
        .map(|k| {
            let uniform: f64 = rng.random::<f64>().clamp(1e-12, 1.0 - 1e-12);
            match pick {
                1 => 0.0,
                _ if k >= pick => 1.0,
                _ => PICK_SPREAD * trig::ln(-trig::ln(uniform)),
            }
        })
        .collect()
}
