//! The protocol of likeness: what a method makes of one half of a city, compared with the other half.
//!
//! `exurb_protocol [--inside] [--method "streets grow"] [--set KEY=VALUE]... [--seeds N] [--least N]
//! [--no-unseen] [--json] MAP...`; `cargo xtask likeness` runs it over every shared map.
//!
//! Of every map: 1 the densest square is cut into a west part A and an east part B (north and south
//! where fewer than `--least` measures are informative); 2 a city of B's size is made from A, for
//! seeds 1 to N; 3 it is scored against B, with A as the ceiling and the built-in panel as the floor.
//! `--inside` cuts A once more and compares its halves, so that parameters can be tuned without
//! seeing B. Beside it stands what unseen fabric of the city itself scores: a quadrant against
//! another one, with the remaining two as the ceiling, mean over all twelve choices; `--no-unseen`
//! saves that half of the time.
//!
//! Maps are worked on side by side in one process; every real part is measured once.

#![allow(clippy::print_stdout, reason = "its output is the result")]

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use exurb_benches::set;
use exurb_city::{City, ImportOptions, Part};
use exurb_geom::{Bounds, GridPoint, Polygon, Vec2};
use exurb_likeness::measures::Family;
use exurb_likeness::{Floor, Panel, Place, Reference, STREETS, Scorecard, windows};
use exurb_operation::{AnyOperation, Example, Run, Scope};
use exurb_recipe::Registry;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

fn main() -> Outcome<()> {
    let options = Options::parse()?;
    let registry = Registry::all();
    let operation = registry.find(&options.method)?;
    let panel = Panel::builtin()?;
    let runs: Vec<MapRun> = options
        .maps
        .par_iter()
        .map(|map| run_map(map, operation, &panel, &options))
        .collect::<Outcome<_>>()?;
    let qualifying: Vec<&MapRun> = runs.iter().filter(|r| !r.cards.is_empty()).collect();
    if options.json {
        let maps: Map<String, Value> = runs.iter().map(|r| (r.name.clone(), r.json())).collect();
        println!("{:#}", json!({ "maps": maps, "mean": Mean::of(&qualifying).json() }));
    } else {
        print_table(&runs, &qualifying);
    }
    Ok(())
}

struct Options {
    maps: Vec<PathBuf>,
    method: String,
    params: Map<String, Value>,
    seeds: u64,
    least: usize,
    inside: bool,
    unseen: bool,
    json: bool,
}

impl Options {
    fn parse() -> Outcome<Self> {
        let mut options = Self {
            maps: Vec::new(),
            method: "streets grow".to_owned(),
            params: Map::new(),
            seeds: 3,
            least: 20,
            inside: false,
            unseen: true,
            json: false,
        };
        let mut args = std::env::args().skip(1);
        while let Some(arg) = args.next() {
            let mut value = || args.next().ok_or(format!("{arg} needs a value"));
            match arg.as_str() {
                "--inside" => options.inside = true,
                "--no-unseen" => options.unseen = false,
                "--json" => options.json = true,
                "--method" => options.method = value()?,
                "--seeds" => options.seeds = value()?.parse()?,
                "--least" => options.least = value()?.parse()?,
                "--set" => set(&mut options.params, &value()?)?,
                flag if flag.starts_with('-') => return Err(format!("no option {flag}").into()),
                map => options.maps.push(map.into()),
            }
        }
        Ok(options)
    }
}

/// What one map gave; no cards where it does not qualify.
struct MapRun {
    name: String,
    split: &'static str,
    informative: usize,
    cards: Vec<Card>,
    unseen: Option<Unseen>,
    seconds: f64,
}

/// One city made and scored.
struct Card {
    scorecard: Scorecard,
    copy_rates: [Option<f64>; 2],
    example_share: Option<f64>,
}

/// What unseen fabric of the city itself scores.
struct Unseen {
    total: f64,
    core: f64,
    families: BTreeMap<Family, f64>,
}

fn run_map(
    map: &Path,
    operation: &dyn AnyOperation,
    panel: &Panel,
    options: &Options,
) -> Outcome<MapRun> {
    let started = Instant::now();
    let file = map.file_name().unwrap_or_default().to_string_lossy();
    let name = file.split('.').next().unwrap_or_default().to_owned();
    let city = read(map, &name, None)?;
    let mut run =
        MapRun { name, split: "", informative: 0, cards: Vec::new(), unseen: None, seconds: 0.0 };
    let splits = [("W|E", [Part::West, Part::East]), ("N|S", [Part::North, Part::South])];
    for (split, parts) in splits {
        let [a, b] = halves(map, &run.name, parts, options.inside)?;
        let whole = |city| Place { city, window: bounds(city) };
        let size = bounds(&a).size().min(bounds(&b).size());
        let reference = Reference::new(&a, &[whole(&a)], whole(&b), Floor::Panel, panel, size, 1);
        let informative = reference.yardstick.informative();
        if informative > run.informative {
            (run.split, run.informative) = (split, informative);
        }
        if informative >= options.least {
            let a = Example::new(a);
            for seed in 1..=options.seeds {
                run.cards.push(made(&a, &b, seed, operation, panel, &reference, options)?);
            }
            break;
        }
    }
    if options.unseen && !run.cards.is_empty() {
        run.unseen = unseen(&city, panel, options.inside);
    }
    run.seconds = started.elapsed().as_secs_f64();
    Ok(run)
}

fn read(map: &Path, name: &str, part: Option<Part>) -> Outcome<City> {
    let taken = ImportOptions { part, ..ImportOptions::default() };
    let mut city = exurb_recipe::open_city(map, &taken).map_err(|e| e.to_string())?.city;
    city.metadata.name = name.into();
    Ok(city)
}

/// The example and the held-out part: two halves of the map's densest square, or of its first half.
fn halves(map: &Path, name: &str, [a, b]: [Part; 2], inside: bool) -> Outcome<[City; 2]> {
    if !inside {
        return Ok([read(map, name, Some(a))?, read(map, name, Some(b))?]);
    }
    // The other axis, so that the quarters are as square as can be.
    let across = match a {
        Part::West | Part::East => [Part::South, Part::North],
        _ => [Part::West, Part::East],
    };
    let whole = read(map, name, Some(a))?;
    let box_of = |part| {
        let half = exurb_city::densest_square::half(bounds(&whole), part);
        [half.min, half.max].map(|p| whole.frame.unproject(p))
    };
    let quarter = |part| -> Outcome<City> {
        let taken = ImportOptions { bbox: Some(box_of(part)), ..ImportOptions::default() };
        let mut city = exurb_recipe::open_city(map, &taken).map_err(|e| e.to_string())?.city;
        city.metadata.name = name.into();
        Ok(city)
    };
    Ok([quarter(across[0])?, quarter(across[1])?])
}

fn bounds(city: &City) -> Bounds {
    city.target.bounds()
}

/// A city of the held-out part's size around the example's middle, scored.
fn made(
    example: &Example,
    held_out: &City,
    seed: u64,
    operation: &dyn AnyOperation,
    panel: &Panel,
    reference: &Reference,
    options: &Options,
) -> Outcome<Card> {
    let a = &example.city;
    let (middle, half) = (bounds(a).center(), bounds(held_out).size() / 2.0);
    let corner = |p: Vec2| GridPoint::round(p);
    let target = Polygon::rectangle(corner(middle - half), corner(middle + half));
    let empty = City::empty(a.frame.clone(), target);
    let params = Value::Object(options.params.clone());
    let examples = std::slice::from_ref(example);
    let outcome = operation.run(&empty, &Scope::All, examples, params, &Run::new(seed));
    let city = outcome.map_err(|e| e.to_string())?.city;
    let likeness = reference.compare(&city, panel);
    Ok(Card {
        scorecard: likeness.scorecard,
        copy_rates: likeness.copy_rates,
        example_share: likeness.example_share,
    })
}

/// A quadrant of the densest square (of its west half) against another one, the remaining two as the
/// ceiling: mean over all choices.
fn unseen(city: &City, panel: &Panel, inside: bool) -> Option<Unseen> {
    let square = exurb_city::densest_square::of_city(city);
    let square = if inside { windows::halves(city, [Part::West; 2])[0] } else { square };
    let size = square.size() / 2.0;
    let places: Vec<Place> = (0..4)
        .map(|i| square.min + size * Vec2::new(f64::from(i % 2), f64::from(i / 2)))
        .map(|min| Place { city, window: Bounds { min, max: min + size } })
        .collect();
    let cards = |held_out: usize| {
        let rest = (0..4).filter(|i| *i != held_out).map(|i| places[i]);
        let (parts, held_out) = (rest.collect::<Vec<Place>>(), places[held_out]);
        let reference = Reference::new(city, &parts, held_out, Floor::Panel, panel, size, 1);
        (0..3).map(|part| reference.yardstick.score_part(part)).collect::<Vec<Scorecard>>()
    };
    let cards: Vec<Scorecard> = (0..4).flat_map(cards).collect();
    let mean = |value: &dyn Fn(&Scorecard) -> Option<f64>| mean(cards.iter().filter_map(value));
    let family = |f: Family| Some((f, mean(&|c| c.families.get(&f).copied())?));
    Some(Unseen {
        total: mean(&|c| c.total)?,
        core: mean(&|c| c.core)?,
        families: Family::STREETS.into_iter().filter_map(family).collect(),
    })
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// Means over the seeds of maps, maps counting alike.
struct Mean {
    total: Option<f64>,
    core: Option<f64>,
    families: Vec<Option<f64>>,
    copies: [Option<f64>; 2],
    example_share: Option<f64>,
    unseen: [Option<f64>; 2],
    unseen_families: Vec<Option<f64>>,
    /// Mean clipped score of every measure where it is informative, and the number of such maps.
    measures: Vec<(&'static str, Option<f64>, usize)>,
}

impl Mean {
    fn of(runs: &[&MapRun]) -> Self {
        let over = |value: &dyn Fn(&Card) -> Option<f64>| {
            mean(runs.iter().filter_map(|r| mean(r.cards.iter().filter_map(value))))
        };
        let unseen = |value: &dyn Fn(&Unseen) -> Option<f64>| {
            mean(runs.iter().filter_map(|r| value(r.unseen.as_ref()?)))
        };
        let measure = |name: &'static str| {
            let own = |c: &Card| {
                let score = c.scorecard.get(name).filter(|s| s.informative)?;
                Some(score.score?.clamp(-1.0, 1.0))
            };
            let count = runs.iter().filter(|r| r.cards.iter().any(|c| own(c).is_some())).count();
            (name, over(&own), count)
        };
        Self {
            total: over(&|c| c.scorecard.total),
            core: over(&|c| c.scorecard.core),
            families: Family::STREETS
                .iter()
                .map(|f| over(&|c| c.scorecard.families.get(f).copied()))
                .collect(),
            copies: [over(&|c| c.copy_rates[0]), over(&|c| c.copy_rates[1])],
            example_share: over(&|c| c.example_share),
            unseen: [unseen(&|u| Some(u.total)), unseen(&|u| Some(u.core))],
            unseen_families: Family::STREETS
                .iter()
                .map(|f| unseen(&|u| u.families.get(f).copied()))
                .collect(),
            measures: STREETS.iter().map(|m| measure(m.name)).collect(),
        }
    }

    fn json(&self) -> Value {
        let families = |values: &[Option<f64>]| -> Map<String, Value> {
            let named = Family::STREETS.iter().zip(values);
            named.map(|(f, v)| (f.name().to_owned(), json!(v.map(round)))).collect()
        };
        let measures: Map<String, Value> = self
            .measures
            .iter()
            .map(|(name, score, maps)| {
                ((*name).to_owned(), json!({ "score": score.map(round), "maps": maps }))
            })
            .collect();
        json!({
            "total": self.total.map(round),
            "core": self.core.map(round),
            "families": families(&self.families),
            "measures": measures,
            "copy_rate_150m": self.copies[0].map(round),
            "copy_rate_300m": self.copies[1].map(round),
            "example_share": self.example_share.map(round),
            "unseen_total": self.unseen[0].map(round),
            "unseen_core": self.unseen[1].map(round),
            "unseen_families": families(&self.unseen_families),
        })
    }
}

fn round(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

impl MapRun {
    fn json(&self) -> Value {
        let mut value = Mean::of(&[self]).json();
        if let Some(object) = value.as_object_mut() {
            object.insert("split".into(), json!(self.split));
            object.insert("informative".into(), json!(self.informative));
            object.insert("seconds".into(), json!(round(self.seconds)));
        }
        value
    }
}

fn print_table(runs: &[MapRun], qualifying: &[&MapRun]) {
    let families: Vec<&str> = Family::STREETS.iter().map(|f| f.name()).collect();
    println!(
        "| map | split | TOTAL | CORE | {} | copied 150 m | copied 300 m | laid by patches | unseen TOTAL | unseen CORE |",
        families.join(" | ")
    );
    println!("|---|---|---|---|{}---|---|---|---|---|", "---|".repeat(families.len()));
    for run in qualifying {
        println!("| {} | {} | {} |", run.name, run.split, cells(&Mean::of(&[run])));
    }
    println!("| **mean of {}** | | {} |", qualifying.len(), cells(&Mean::of(qualifying)));
    let left_out: Vec<String> = runs
        .iter()
        .filter(|r| r.cards.is_empty())
        .map(|r| format!("{} ({})", r.name, r.informative))
        .collect();
    println!("\nToo few informative measures: {}.", left_out.join(", "));
}

fn cells(mean: &Mean) -> String {
    let figure = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.2}"));
    let all = [mean.total, mean.core].into_iter().chain(mean.families.iter().copied());
    let all = all.chain(mean.copies).chain([mean.example_share]).chain(mean.unseen);
    all.map(figure).collect::<Vec<_>>().join(" | ")
}
