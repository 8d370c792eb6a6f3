//! The table that shows whether the scale behaves: what unseen parts of a city, other cities, spoilt
//! copies and streets by rule score against each other.
//!
//! Every city's densest 5 km square is cut in two; the west part is the example, the east part is
//! held out, the other cities' west parts are the floor. Cities differ in how much they mind a change,
//! so each row says by how much it lies below the row before it in the same city, and how sure that is.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use exurb_city::{City, Part, StreetGraph};
use exurb_geom::{Bounds, Vec2};
use exurb_measure::Network;
use exurb_operation::{Rng, rng};
use rayon::prelude::*;
use serde::Serialize;

use crate::measures::{Family, STREETS};
use crate::patches::{CANDIDATE, Dictionary, HELD_OUT, Patches};
use crate::scorecard::{Marks, mean};
use crate::{HeldOut, Measured, Scorecard, Side, Yardstick, nets, windows};

impl Table {
    /// Both tables as text.
    pub fn to_text(&self) -> String {
        let figure = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.2}"));
        let mut out =
            format!("{:<24} {:>8} {:>8} {:>8} {:>8}\n", "measure", "ceiling", "floor", "grid", "P");
        for d in &self.distances {
            let [ceiling, floor, grid, p] = [d.ceiling, d.floor, d.grid, d.farther].map(figure);
            out += &format!("{:<24} {ceiling:>8} {floor:>8} {grid:>8} {p:>8}\n", d.measure);
        }
        let families: Vec<&str> = Family::STREETS.iter().map(|f| f.name()).collect();
        out += &format!(
            "\n{:<32} {:>13} {:>15} {:>6}  {}\n",
            "candidate",
            "TOTAL (sd)",
            "lower by (se)",
            "CORE",
            families.join(" ")
        );
        for row in &self.rows {
            let family = |f: &Family| {
                let score = figure(row.families.get(f.name()).copied());
                format!("{score:>width$}", width = f.name().len())
            };
            let families: Vec<String> = Family::STREETS.iter().map(family).collect();
            let total = row.total.map_or("-".to_owned(), |[t, sd]| format!("{t:.2} ({sd:.2})"));
            let lower =
                row.lower.map_or(String::new(), |l| format!("{:.2} ({:.2})", l.by, l.error));
            let core = figure(row.core);
            out += &format!(
                "{:<32} {total:>13} {lower:>15} {core:>6}  {}\n",
                row.candidate,
                families.join(" ")
            );
        }
        let higher = |pair: &&[Row]| pair[1].lower.is_some_and(|l| l.by < 0.0);
        for pair in self.rows.windows(2).filter(higher) {
            let (row, before) = (pair[1].candidate, pair[0].candidate);
            let apart = pair[1].lower.is_some_and(|l| l.by < -CHANCE_ERRORS * l.error);
            let surely = if apart { "" } else { ", within chance" };
            out += &format!("out of order: {row} above {before}{surely}\n");
        }
        out += "\ninformative measures:";
        for (name, count) in &self.informative {
            out += &format!(" {name} {count}");
        }
        out + "\n"
    }
}

/// One row: what a kind of candidate scores, over all cities.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What the candidates are.
    pub candidate: &'static str,
    /// Mean and standard deviation of TOTAL; `None` where no city has one.
    pub total: Option<[f64; 2]>,
    /// How far the row lies below the one before it; `None` for the first, and where fewer than two
    /// cities have both.
    pub lower: Option<Lower>,
    /// Mean of CORE.
    pub core: Option<f64>,
    /// Mean by family.
    pub families: BTreeMap<&'static str, f64>,
}

/// A difference of TOTAL between two rows, city by city.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Lower {
    /// Mean over cities; below 0 when the rows stand the other way round.
    pub by: f64,
    /// Standard error of that mean.
    pub error: f64,
}

impl Lower {
    /// Of a row below the one before it, TOTAL of both in the same cities in the same order.
    fn of(before: &[Option<f64>], row: &[Option<f64>]) -> Option<Self> {
        let both = before.iter().zip(row).filter_map(|(b, r)| Some((*b)? - (*r)?));
        let steps: Vec<f64> = both.collect();
        let by = mean(steps.iter().copied())?;
        let spread = steps.iter().map(|s| (s - by) * (s - by)).sum::<f64>();
        let n = steps.len() as f64;
        (n > 1.0).then(|| Self { by, error: (spread / (n - 1.0) / n).sqrt() })
    }
}

/// Within so many standard errors chance can account for an order.
const CHANCE_ERRORS: f64 = 2.0;

/// Mean distances of one measure over all cities.
#[derive(Clone, Debug, Serialize)]
pub struct Distances {
    /// The measure.
    pub measure: &'static str,
    /// Of the city's own other part.
    pub ceiling: Option<f64>,
    /// Of other cities.
    pub floor: Option<f64>,
    /// Of a square grid of equal street density.
    pub grid: Option<f64>,
    /// P: the chance that another city lies farther off than the city's own other part, 0.5 =
    /// useless, 1 = perfect.
    pub farther: Option<f64>,
}

/// The table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Kinds of candidates, in the order they should come out.
    pub rows: Vec<Row>,
    /// Distances by measure.
    pub distances: Vec<Distances>,
    /// Number of informative measures by city.
    pub informative: Vec<(String, usize)>,
}

/// A part of a city, measured, and its picture looked at.
struct Set {
    measured: Measured,
    patches: Option<Patches>,
}

impl Set {
    fn side(&self) -> Side<'_> {
        Side { measured: &self.measured, patches: self.patches.as_ref() }
    }
}

/// Candidates of one kind that are made and scored for each city: chance moves a single one by 0.05.
const REPETITIONS: usize = 3;

type Maker = fn(&Network, &mut Rng) -> StreetGraph;

/// Kinds of candidates made from the example part.
const MADE: [(&str, Maker); 7] = [
    ("A with 10 m node noise", |n, rng| nets::with_noise(n, 10.0, rng)),
    ("A with 10 % of segments removed", |n, rng| nets::with_gaps(n, 0.1, rng)),
    ("A with 25 m node noise", |n, rng| nets::with_noise(n, 25.0, rng)),
    ("A with 30 % of segments removed", |n, rng| nets::with_gaps(n, 0.3, rng)),
    ("Poisson-Voronoi streets", |n, rng| nets::voronoi(n.window, density(n), rng)),
    ("jittered grid", |n, rng| nets::jittered_grid(n.window, density(n), rng)),
    ("regular grid", |n, rng| nets::grid(n.window, density(n), 0.0, rng)),
];

fn density(network: &Network) -> f64 {
    let size = network.window.size();
    network.length_m() / (size.x * size.y)
}

/// Makes the table for cities, at least two; the discriminator looks through the filters of
/// `dictionary`. On rayon's current pool; the same on any number of threads.
pub fn table(cities: &[&City], dictionary: &Dictionary, seed: u64) -> Table {
    let windows = equal_halves(cities);
    let looked_at = |measured: Measured, key: u64| {
        let patches = measured.image.as_ref().map(|i| Patches::of(i, dictionary, seed, key));
        Set { measured, patches }
    };
    let set = |i: usize, half: usize, key: u64| {
        looked_at(Measured::of(&cities[i].streets, windows[i][half]), key)
    };
    let sets: Vec<[Set; 2]> = (0..cities.len())
        .into_par_iter()
        .map(|i| [set(i, 0, CANDIDATE), set(i, 1, HELD_OUT)])
        .collect();
    let columns: Vec<Column> = (0..cities.len())
        .into_par_iter()
        .map(|i| {
            let part = Network::unmerged(&cities[i].streets, windows[i][0]);
            column(&sets, &part, i, seed, &looked_at)
        })
        .collect();
    let names = cities.iter().map(|c| c.metadata.name.to_string());
    summary(&columns, names.collect())
}

/// West and east half of every city's densest square, all cut to one size.
fn equal_halves(cities: &[&City]) -> Vec<[Bounds; 2]> {
    let halves: Vec<[Bounds; 2]> =
        cities.iter().map(|city| windows::halves(city, [Part::West, Part::East])).collect();
    let size = halves.iter().flatten().map(|h| h.size()).fold(Vec2::INFINITY, Vec2::min);
    halves.into_iter().map(|pair| pair.map(|half| windows::centred(half, size))).collect()
}

/// What one held-out part gives.
struct Column {
    marks: Vec<Marks>,
    itself: Scorecard,
    /// By kind, then by repetition.
    made: Vec<Vec<Scorecard>>,
    others: Vec<Scorecard>,
    informative: usize,
}

fn column(
    sets: &[[Set; 2]],
    part: &Network,
    own: usize,
    seed: u64,
    looked_at: &(impl Fn(Measured, u64) -> Set + Sync),
) -> Column {
    let [a, b] = &sets[own];
    let others: Vec<Side> =
        (0..sets.len()).filter(|i| *i != own).map(|i| sets[i][0].side()).collect();
    let real = others.iter().map(|s| s.measured).chain([&a.measured]);
    let held_out = HeldOut::new(b.measured.clone(), b.patches.clone(), real, seed);
    let yardstick = Yardstick::new(held_out, &STREETS, &[a.side()], &others);
    let made = |(name, make): &(&str, Maker), repetition: usize| {
        let key = (own * REPETITIONS + repetition) as u64;
        let streets = make(part, &mut rng::stream(seed, name, key));
        yardstick.score(looked_at(Measured::of(&streets, part.window), CANDIDATE).side())
    };
    let of_kind = |kind| (0..REPETITIONS).into_par_iter().map(|r| made(kind, r)).collect();
    Column {
        itself: yardstick.score(a.side()),
        made: MADE.par_iter().map(of_kind).collect(),
        others: (0..others.len()).map(|i| yardstick.score_other(i)).collect(),
        informative: yardstick.informative(),
        marks: yardstick.marks().to_vec(),
    }
}

fn summary(columns: &[Column], names: Vec<String>) -> Table {
    let mut kinds = vec![("A itself", of_each(columns, |c| std::slice::from_ref(&c.itself)))];
    for (i, (name, _)) in MADE.iter().enumerate() {
        if i == 4 {
            kinds.push(("another real city", of_each(columns, |c| &c.others)));
        }
        kinds.push((name, of_each(columns, |c| &c.made[i])));
    }
    let mut rows: Vec<Row> = kinds.iter().map(|(name, cards)| row(name, cards)).collect();
    for (row, pair) in rows[1..].iter_mut().zip(kinds.windows(2)) {
        row.lower = Lower::of(&totals(&pair[0].1), &totals(&pair[1].1));
    }
    let grids = || columns.iter().flat_map(|c| &c.made[MADE.len() - 1]);
    let distances = STREETS.iter().enumerate().map(|(m, measure)| Distances {
        measure: measure.name,
        ceiling: mean(columns.iter().filter_map(|c| c.marks[m].ceiling())),
        floor: mean(columns.iter().filter_map(|c| c.marks[m].floor())),
        grid: mean(grids().filter_map(|card| card.measures[m].distance)),
        farther: mean(columns.iter().flat_map(|c| farther(&c.marks[m]))),
    });
    Table {
        rows,
        distances: distances.collect(),
        informative: names.into_iter().zip(columns.iter().map(|c| c.informative)).collect(),
    }
}

/// For every other city: does it lie farther off than the city's own part? 1, 0, or 0.5 for a tie.
fn farther(marks: &Marks) -> Vec<f64> {
    let Some(own) = marks.ceiling() else { return Vec::new() };
    let share = |other: &f64| match other.total_cmp(&own) {
        Ordering::Greater => 1.0,
        Ordering::Equal => 0.5,
        Ordering::Less => 0.0,
    };
    marks.floors.iter().flatten().map(share).collect()
}

/// The scorecards of one kind of candidate, by city.
type ByCity<'a> = Vec<&'a [Scorecard]>;

fn of_each<'a>(columns: &'a [Column], cards: impl Fn(&'a Column) -> &'a [Scorecard]) -> ByCity<'a> {
    columns.iter().map(cards).collect()
}

/// Mean TOTAL by city.
fn totals(cards: &ByCity) -> Vec<Option<f64>> {
    cards.iter().map(|own| mean(own.iter().filter_map(|c| c.total))).collect()
}

fn row(candidate: &'static str, cards: &ByCity) -> Row {
    let cards: Vec<&Scorecard> = cards.iter().copied().flatten().collect();
    let totals: Vec<f64> = cards.iter().filter_map(|c| c.total).collect();
    let total = mean(totals.iter().copied()).and_then(|total| {
        let variance = mean(totals.iter().map(|t| (t - total) * (t - total)))?;
        Some([total, variance.sqrt()])
    });
    let family = |f: Family| {
        Some((f.name(), mean(cards.iter().filter_map(|c| c.families.get(&f).copied()))?))
    };
    Row {
        candidate,
        total,
        lower: None,
        core: mean(cards.iter().filter_map(|c| c.core)),
        families: Family::STREETS.into_iter().filter_map(family).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with these TOTALs in three cities.
    fn table_of(totals: &[(&'static str, [f64; 3])]) -> Table {
        let of_city = |t: [f64; 3]| t.map(Some);
        let lower =
            |i: usize| Lower::of(&of_city(totals[i.checked_sub(1)?].1), &of_city(totals[i].1));
        let row = |(i, (candidate, own)): (usize, &(&'static str, [f64; 3]))| Row {
            candidate,
            total: mean(own.iter().copied()).map(|total| [total, 0.0]),
            lower: lower(i),
            core: None,
            families: BTreeMap::new(),
        };
        let rows = totals.iter().enumerate().map(row).collect();
        Table { rows, distances: Vec::new(), informative: Vec::new() }
    }

    #[test]
    fn rows_out_of_order_are_named_and_whether_chance_can_be_why() {
        let text = table_of(&[
            ("first", [0.5, 0.6, 0.7]),
            ("perhaps above", [0.8, 0.5, 0.7]),
            ("surely above", [1.0, 0.7, 0.9]),
            ("below", [0.1, 0.2, 0.3]),
        ])
        .to_text();
        let said: Vec<&str> = text.lines().filter(|l| l.starts_with("out of order")).collect();
        let wanted = [
            "out of order: perhaps above above first, within chance",
            "out of order: surely above above perhaps above",
        ];
        assert_eq!(said, wanted);
    }

    /// Steps 0.1, 0.2, 0.6: mean 0.3, deviations -0.2, -0.1, 0.3, so variance 0.07, error √(0.07 / 3).
    #[test]
    fn a_difference_is_taken_city_by_city() {
        let lower = Lower::of(
            &[Some(0.5), Some(0.9), None, Some(0.7)],
            &[Some(0.4), Some(0.7), Some(0.1), Some(0.1)],
        )
        .unwrap();
        assert!(
            (lower.by - 0.3).abs() < 1e-12 && (lower.error - (0.07_f64 / 3.0).sqrt()).abs() < 1e-12
        );
        assert!(Lower::of(&[Some(0.5)], &[Some(0.4)]).is_none(), "one city has no spread");
    }
}
