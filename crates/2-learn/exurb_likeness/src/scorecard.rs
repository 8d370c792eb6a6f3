//! Scores: distances read against the ceiling and the floor.
//!
//! score = (floor - distance) / (floor - ceiling): 1 = as near to the held-out part as the city's
//! own other part, 0 = no nearer than another city. Means take it clipped to -1..1.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::held_out::{HeldOut, Side};
use crate::measures::{Distance, Family, Measure};

/// A measure tells nothing where the ceiling reaches this share of the floor, for the classifier
/// where it comes this near.
const LEAST_GAP_SHARE: f64 = 0.8;
const LEAST_GAP: f64 = 0.05;

/// Ceiling and floor of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks {
    /// The measure.
    pub measure: Measure,
    /// Distance of every part of the example, in the order they were given.
    pub ceilings: Vec<Option<f64>>,
    /// Distance of every other city, in the order they were given.
    pub floors: Vec<Option<f64>>,
}

/// One of the real sets of a yardstick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Real {
    Part(usize),
    Other(usize),
}

impl Marks {
    /// Mean distance of the example's parts.
    pub fn ceiling(&self) -> Option<f64> {
        self.ceiling_without(None)
    }

    /// Mean distance of the other cities.
    pub fn floor(&self) -> Option<f64> {
        self.floor_without(None)
    }

    fn ceiling_without(&self, left_out: Option<Real>) -> Option<f64> {
        let kept = self.ceilings.iter().enumerate();
        mean(kept.filter(|(i, _)| Some(Real::Part(*i)) != left_out).filter_map(|(_, d)| *d))
    }

    fn floor_without(&self, left_out: Option<Real>) -> Option<f64> {
        let kept = self.floors.iter().enumerate();
        mean(kept.filter(|(i, _)| Some(Real::Other(*i)) != left_out).filter_map(|(_, d)| *d))
    }

    /// Do a ceiling and a floor of this measure separate?
    fn separate(&self, ceiling: Option<f64>, floor: Option<f64>) -> bool {
        let Some((ceiling, floor)) = ceiling.zip(floor) else { return false };
        match self.measure.distance {
            Distance::Classifier => floor - ceiling > LEAST_GAP,
            _ => ceiling < LEAST_GAP_SHARE * floor,
        }
    }
}

/// The scale of a comparison: a held-out part with ceilings and floors.
#[derive(Debug)]
pub struct Yardstick {
    held_out: HeldOut,
    marks: Vec<Marks>,
}

/// How a candidate does in one measure. What cannot be told is `None`, never NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// The measure.
    pub measure: Measure,
    /// Distance of the example's own other part.
    pub ceiling: Option<f64>,
    /// Mean distance of other cities.
    pub floor: Option<f64>,
    /// Distance of the candidate; `None` where it, or the held-out part, lacks what is measured.
    pub distance: Option<f64>,
    /// The score, unclipped; -1 where the candidate lacks what the held-out part has. `None` where the
    /// measure does not separate: between marks that hardly differ, a score would mean nothing.
    pub score: Option<f64>,
    /// Does the measure separate here? Others do not count.
    pub informative: bool,
}

/// How like its example a candidate is.
#[derive(Clone, Debug, PartialEq)]
pub struct Scorecard {
    /// TOTAL: mean of the families of streets and blocks.
    pub total: Option<f64>,
    /// Mean of the families over the core measures.
    pub core: Option<f64>,
    /// BUILT: mean of the families of buildings and parcels.
    pub built: Option<f64>,
    /// Mean score by family; families without an informative measure are left out.
    pub families: BTreeMap<Family, f64>,
    /// Every measure.
    pub measures: Vec<Score>,
}

impl Yardstick {
    /// Sets ceilings and floors.
    pub fn new(held_out: HeldOut, measures: &[Measure], parts: &[Side], others: &[Side]) -> Self {
        let marks = |measure: &Measure| {
            let distances = |sides: &[Side]| -> Vec<Option<f64>> {
                sides.par_iter().map(|side| held_out.distance(measure, *side)).collect()
            };
            Marks { measure: *measure, ceilings: distances(parts), floors: distances(others) }
        };
        let marks = measures.par_iter().map(marks).collect();
        Self { held_out, marks }
    }

    /// The held-out part.
    pub fn held_out(&self) -> &HeldOut {
        &self.held_out
    }

    /// Ceilings and floors.
    pub fn marks(&self) -> &[Marks] {
        &self.marks
    }

    /// Number of measures of streets and blocks that separate here.
    pub fn informative(&self) -> usize {
        let streets = self.marks.iter().filter(|m| Family::STREETS.contains(&m.measure.family));
        streets.filter(|m| m.separate(m.ceiling(), m.floor())).count()
    }

    /// Scores a candidate.
    pub fn score(&self, candidate: Side) -> Scorecard {
        let distance = |m: &Marks| self.held_out.distance(&m.measure, candidate);
        let distances: Vec<Option<f64>> = self.marks.par_iter().map(distance).collect();
        self.scorecard(&distances, None)
    }

    /// Scores one of the example's parts, which does not count for the ceiling then.
    pub fn score_part(&self, number: usize) -> Scorecard {
        let distances: Vec<Option<f64>> = self.marks.iter().map(|m| m.ceilings[number]).collect();
        self.scorecard(&distances, Some(Real::Part(number)))
    }

    /// Scores one of the other cities, which does not count for the floor then.
    pub fn score_other(&self, number: usize) -> Scorecard {
        let distances: Vec<Option<f64>> = self.marks.iter().map(|m| m.floors[number]).collect();
        self.scorecard(&distances, Some(Real::Other(number)))
    }

    fn scorecard(&self, distances: &[Option<f64>], left_out: Option<Real>) -> Scorecard {
        let score = |(marks, distance): (&Marks, &Option<f64>)| {
            let (ceiling, floor) = (marks.ceiling_without(left_out), marks.floor_without(left_out));
            let informative = marks.separate(ceiling, floor);
            let distance = *distance;
            let lacks = distance.is_none() && self.held_out.has(&marks.measure);
            let of = |d: f64| Some((floor? - d) / (floor? - ceiling?));
            let score = match distance {
                Some(d) => of(d),
                None => lacks.then_some(-1.0),
            };
            let score = score.filter(|_| informative);
            Score { measure: marks.measure, ceiling, floor, distance, score, informative }
        };
        Scorecard::of(self.marks.iter().zip(distances).map(score).collect())
    }
}

impl Scorecard {
    /// Averages scores.
    pub fn of(measures: Vec<Score>) -> Self {
        let families = families_where(&measures, |_| true);
        let core = mean_of(&families_where(&measures, |s| s.measure.core), &Family::STREETS);
        let (total, built) =
            (mean_of(&families, &Family::STREETS), mean_of(&families, &Family::BUILT));
        Self { total, core, built, families, measures }
    }

    /// The card without these families: their measures are not judged.
    pub fn without(self, families: &[Family]) -> Self {
        let judged = |score: Score| match families.contains(&score.measure.family) {
            true => Score { score: None, informative: false, ..score },
            false => score,
        };
        Self::of(self.measures.into_iter().map(judged).collect())
    }

    /// The score of a measure by name.
    pub fn get(&self, name: &str) -> Option<&Score> {
        self.measures.iter().find(|s| s.measure.name == name)
    }

    /// Number of measures of streets and blocks that count.
    pub fn informative(&self) -> usize {
        let counts = |s: &&Score| s.informative && Family::STREETS.contains(&s.measure.family);
        self.measures.iter().filter(counts).count()
    }
}

fn families_where(measures: &[Score], keep: impl Fn(&Score) -> bool) -> BTreeMap<Family, f64> {
    let of = |family: Family| {
        let own = measures.iter().filter(|s| keep(s));
        let own = own.filter(|s| s.measure.family == family);
        Some((family, mean(own.filter_map(|s| s.score).map(|s| s.clamp(-1.0, 1.0)))?))
    };
    Family::STREETS.into_iter().chain(Family::BUILT).filter_map(of).collect()
}

fn mean_of(families: &BTreeMap<Family, f64>, which: &[Family]) -> Option<f64> {
    mean(which.iter().filter_map(|f| families.get(f).copied()))
}

/// Mean; `None` of nothing.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
