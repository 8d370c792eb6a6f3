//! What a comparison found, as `exurb compare --json` prints it and as a table for people.
//!
//! Keys never vanish; what cannot be told is `None`. Figures have six digits.

use std::fmt::Write;

use indexmap::IndexMap;
use serde::Serialize;

use crate::comparison::{Likeness, Reference};
use crate::explain::{figure, sentence, typical, worst};
use crate::measures::{Distance, Family, STREETS};
use crate::scorecard::Score;
use crate::words::words;
use crate::{Measured, distance};

/// Sentences on the worst measures.
const WORST: usize = 3;

/// A candidate against one example.
#[derive(Clone, Debug, Serialize)]
pub struct Document {
    /// Name of the example.
    pub example: String,
    /// Name of its held-out part, which stands for it in every measure; `None` where that is a half of
    /// the example itself.
    pub held_out: Option<String>,
    /// Mean of the families; `None` where no measure is informative.
    pub total: Option<f64>,
    /// The same over the core measures.
    pub core: Option<f64>,
    /// The mean of the families of buildings and parcels; `None` where the example has none.
    pub built: Option<f64>,
    /// Mean score by family; `None` where no measure of it is informative.
    pub families: IndexMap<&'static str, Option<f64>>,
    /// Every measure, in the order of the scorecard.
    pub measures: IndexMap<&'static str, MeasureDocument>,
    /// Number of informative measures.
    pub informative: usize,
    /// Share of junctions that stand in the example with what lies within 150 m.
    pub copy_rate_150m: Option<f64>,
    /// The same within 300 m.
    pub copy_rate_300m: Option<f64>,
    /// Share of the candidate's street length that was copied from this example.
    pub example_share: Option<f64>,
    /// Width and height of the windows compared, in metres.
    pub window_m: [f64; 2],
    /// The cities of the floor.
    pub floor: Vec<String>,
    /// The worst measures, a sentence each.
    pub worst: Vec<String>,
    /// What a reader should know, a sentence each.
    pub notes: Vec<String>,
}

/// A candidate in one measure.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureDocument {
    /// Its family.
    pub family: &'static str,
    /// Is it one of the core measures?
    pub core: bool,
    /// Typical value in the held-out part.
    pub example: Option<f64>,
    /// Typical value of the candidate.
    pub candidate: Option<f64>,
    /// Distance of the example's own other part.
    pub ceiling: Option<f64>,
    /// Mean distance of other cities.
    pub floor: Option<f64>,
    /// Distance of the candidate.
    pub distance: Option<f64>,
    /// Kolmogorov-Smirnov distance of the candidate, of measures that are distributions.
    pub ks: Option<f64>,
    /// The score, unclipped; `None` where the measure does not separate.
    pub score: Option<f64>,
    /// Does the measure separate here?
    pub informative: bool,
}

impl Document {
    /// Of a comparison.
    pub fn of(reference: &Reference, likeness: &Likeness) -> Self {
        let card = &likeness.scorecard;
        let (candidate, held_out) =
            (&likeness.candidate.measured, reference.yardstick.held_out().measured());
        let measure =
            |score: &Score| (score.measure.name, MeasureDocument::of(score, candidate, held_out));
        let family = |f: Family| (f.name(), card.families.get(&f).copied().map(round));
        let worst = worst(card, WORST).into_iter().map(|s| sentence(s, candidate, held_out));
        Self {
            example: reference.name.clone(),
            held_out: reference.held_out_name.clone(),
            total: card.total.map(round),
            core: card.core.map(round),
            built: card.built.map(round),
            families: Family::STREETS.into_iter().chain(Family::BUILT).map(family).collect(),
            measures: card.measures.iter().map(measure).collect(),
            informative: card.informative(),
            copy_rate_150m: likeness.copy_rates[0].map(round),
            copy_rate_300m: likeness.copy_rates[1].map(round),
            example_share: likeness.example_share.map(round),
            window_m: [reference.size.x, reference.size.y].map(round),
            floor: reference.floor.clone(),
            worst: worst.collect(),
            notes: reference.notes.iter().chain(&likeness.notes).cloned().collect(),
        }
    }

    /// As a table for the terminal.
    pub fn to_text(&self) -> String {
        let mut out = format!(
            "{:<24} {:>10} {:>10} {:>9} {:>8} {:>7} {:>7}\n",
            "", "example", "candidate", "distance", "ceiling", "floor", "score"
        );
        let is_street = |m: &MeasureDocument| Family::STREETS.iter().any(|f| f.name() == m.family);
        let here = |m: &MeasureDocument| is_street(m) || m.ceiling.or(m.distance).is_some();
        for (name, m) in self.measures.iter().filter(|(_, m)| here(m)) {
            let cell = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
            let value = |value: Option<f64>| value.map_or("-".to_owned(), |v| figure(v, ""));
            let core = if m.core { "*" } else { " " };
            let _ = writeln!(
                out,
                "{:<24} {:>10} {:>10} {:>9} {:>8} {:>7} {:>7}",
                format!("{core} {name}"),
                value(m.example),
                value(m.candidate),
                cell(m.distance),
                cell(m.ceiling),
                cell(m.floor),
                cell(m.score)
            );
        }
        out.push_str(&self.summary());
        out
    }

    /// What stands for the example in the comparison, in words.
    pub fn held_out_words(&self) -> String {
        match &self.held_out {
            Some(name) => format!("its held-out part, {name}"),
            None => "one half of it, held out".to_owned(),
        }
    }

    fn summary(&self) -> String {
        let cell = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
        let known = self.families.iter().filter(|(_, score)| score.is_some());
        let families: Vec<String> =
            known.map(|(name, score)| format!("{name} {}", cell(*score))).collect();
        let mut out = format!(
            "* core measure; without a score: tells nothing here; {} of {} of streets and blocks count\n\
             example: {}; typical figures are medians, of node_degree the mean\n\n\
             TOTAL {}   CORE {}   BUILT {}   {}\n\
             copied          {} of junctions with what lies within 150 m, {} within 300 m; \
             {} of the street length was laid from this example\n\
             windows         {:.0} x {:.0} m; floor: {}\n",
            self.informative,
            STREETS.len(),
            self.held_out_words(),
            cell(self.total),
            cell(self.core),
            cell(self.built),
            families.join("  "),
            cell(self.copy_rate_150m),
            cell(self.copy_rate_300m),
            cell(self.example_share),
            self.window_m[0],
            self.window_m[1],
            self.floor.join(", "),
        );
        for sentence in &self.worst {
            let _ = writeln!(out, "worst           {sentence}");
        }
        for note in &self.notes {
            let _ = writeln!(out, "note            {note}");
        }
        out
    }
}

impl MeasureDocument {
    fn of(score: &Score, candidate: &Measured, held_out: &Measured) -> Self {
        let measure = &score.measure;
        let samples =
            || Some((candidate.samples.get(measure.name)?, held_out.samples.get(measure.name)?));
        let ks = samples().and_then(|(a, b)| distance::kolmogorov_smirnov(a, b));
        let is_distribution = matches!(measure.distance, Distance::Wasserstein(_));
        Self {
            family: measure.family.name(),
            core: measure.core,
            example: typical(held_out, measure).map(round),
            candidate: typical(candidate, measure).map(round),
            ceiling: score.ceiling.map(round),
            floor: score.floor.map(round),
            distance: score.distance.map(round),
            ks: ks.filter(|_| is_distribution).map(round),
            score: score.score.map(round),
            informative: score.informative,
        }
    }

    /// A value of this measure with its unit.
    pub fn with_unit(name: &str, value: Option<f64>) -> String {
        let unit = crate::measures::find(name).map_or("", |m| words(m).unit);
        value.map_or("-".to_owned(), |v| figure(v, unit))
    }
}

/// Six digits, so that reports are the same wherever sums differ in the last place.
fn round(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
