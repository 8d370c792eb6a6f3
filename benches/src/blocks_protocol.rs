//! The protocol of likeness for buildings: the blocks of one half of a city, filled from the other half.
//!
//! `exurb_blocks_protocol [--method "blocks auto"] [--set KEY=VALUE]... [--seeds N] [--halves W|N] MAP...`;
//! `cargo xtask blocks` runs it over the shared maps whose buildings are complete.
//!
//! Of every map of 2 km² and more: 1 the densest square is cut into two halves, A and B; 2 the blocks of B
//! are emptied and filled from A, for seeds 1 to N; 3 what stands in them is scored against what stood there,
//! with A as the ceiling and all other maps as the floor. Only buildings in closed blocks count, on all
//! sides: the others stay as they are and would be compared with themselves.

#![allow(clippy::print_stdout, reason = "its output is the result")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use exurb_benches::set;
use exurb_blocks::library::{OPEN_SHARE, OpenLand};
use exurb_city::{Block, BlockClass, Building, City, ImportOptions, Part};
use exurb_likeness::measures::Family;
use exurb_likeness::{BUILT, Floor, Panel, Place, Reference, Scorecard};
use exurb_operation::{AnyOperation, Example, Run, Scope};
use exurb_recipe::Registry;
use rayon::prelude::*;
use serde_json::{Map, Value};

type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// Smaller maps serve as floor only, in km².
const LEAST_KM2: f64 = 2.0;
const FAMILIES: [Family; 2] = [Family::Buildings, Family::BuiltBlocks];

fn main() -> Outcome<()> {
    let options = Options::parse()?;
    let registry = Registry::all();
    let operation = registry.find(&options.method)?;
    let panel = Panel::builtin()?;
    let whole: Vec<City> =
        options.maps.par_iter().map(|map| read(map, None)).collect::<Outcome<_>>()?;
    let large = |i: &usize| whole[*i].target.area_m2() >= LEAST_KM2 * 1e6;
    let chosen: Vec<usize> = (0..whole.len()).filter(large).collect();
    let runs: Vec<MapRun> = chosen
        .into_par_iter()
        .map(|i| run_map(i, &whole, operation, &panel, &options))
        .collect::<Outcome<_>>()?;
    print_table(&runs);
    Ok(())
}

struct Options {
    maps: Vec<PathBuf>,
    method: String,
    params: Map<String, Value>,
    seeds: u64,
    halves: [Part; 2],
}

impl Options {
    fn parse() -> Outcome<Self> {
        let mut options = Self {
            maps: Vec::new(),
            method: "blocks auto".to_owned(),
            params: Map::new(),
            seeds: 5,
            halves: [Part::West, Part::East],
        };
        let mut args = std::env::args().skip(1);
        while let Some(arg) = args.next() {
            let mut value = || args.next().ok_or(format!("{arg} needs a value"));
            match arg.as_str() {
                "--method" => options.method = value()?,
                "--seeds" => options.seeds = value()?.parse()?,
                "--halves" if value()? == "N" => options.halves = [Part::North, Part::South],
                "--halves" => {}
                "--set" => set(&mut options.params, &value()?)?,
                flag if flag.starts_with('-') => return Err(format!("no option {flag}").into()),
                map => options.maps.push(map.into()),
            }
        }
        Ok(options)
    }
}

/// What one map gave.
struct MapRun {
    name: String,
    cards: Vec<Card>,
    /// Share of their blocks that buildings cover: of the example, and of the part that was emptied.
    example: f64,
    held_out: f64,
}

/// One filling.
struct Card {
    scorecard: Scorecard,
    coverage: f64,
    /// Share of the footprints of the chosen layouts that found room.
    kept: f64,
}

/// The map or a half of it, with the buildings of its closed blocks alone.
fn read(map: &Path, part: Option<Part>) -> Outcome<City> {
    let taken = ImportOptions { part, ..ImportOptions::default() };
    let mut city = exurb_recipe::open_city(map, &taken).map_err(|e| e.to_string())?.city;
    let file = map.file_name().unwrap_or_default().to_string_lossy();
    city.metadata.name = file.split('.').next().unwrap_or_default().into();
    let blocks: Vec<u32> = filled_blocks(&city).map(|b| b.id).collect();
    let stands = |b: &&Building| blocks.contains(&b.block);
    city.buildings = Arc::new(city.buildings.iter().filter(stands).cloned().collect());
    Ok(city)
}

/// The blocks that are filled: no islands.
fn filled_blocks(city: &City) -> impl Iterator<Item = &Block> {
    city.blocks.iter().filter(|b| b.class == BlockClass::Block)
}

/// Share of all blocks of a map together that buildings of `city`, which has the same blocks, cover; those
/// that are kept open, since at least half of them is open land or water on the map, do not count.
fn coverage(map: &City, city: &City) -> f64 {
    let open = OpenLand::of(map);
    let counts = |b: &&Block| open.share(&b.polygon).is_none_or(|(_, share)| share < OPEN_SHARE);
    let blocks: Vec<&Block> = filled_blocks(map).filter(counts).collect();
    let own = |b: &&Building| !b.is_part && blocks.iter().any(|block| block.id == b.block);
    let built = city.buildings.iter().filter(own).map(|b| b.polygon.area_m2());
    built.sum::<f64>() / blocks.iter().map(|b| b.polygon.area_m2()).sum::<f64>()
}

fn whole_of(city: &City) -> Place<'_> {
    Place { city, window: city.target.bounds() }
}

fn run_map(
    at: usize,
    whole: &[City],
    operation: &dyn AnyOperation,
    panel: &Panel,
    options: &Options,
) -> Outcome<MapRun> {
    let [a, b] = options.halves.map(|part| read(&options.maps[at], Some(part)));
    let (a, b) = (a?, b?);
    let others: Vec<City> =
        (0..whole.len()).filter(|i| *i != at).map(|i| whole[i].clone()).collect();
    let size = b.target.bounds().size().min(a.target.bounds().size());
    let reference =
        Reference::new(&a, &[whole_of(&a)], whole_of(&b), Floor::Cities(&others), panel, size, 1);
    let mut run = MapRun {
        name: a.metadata.name.to_string(),
        cards: Vec::new(),
        example: coverage(&a, &a),
        held_out: coverage(&b, &b),
    };
    let emptied = City { buildings: Arc::default(), parcels: Arc::default(), ..b };
    let examples = [Example::new(a)];
    for seed in 1..=options.seeds {
        let params = Value::Object(options.params.clone());
        let job = Run::new(seed);
        let made = operation.run(&emptied, &Scope::All, &examples, params, &job);
        let made = made.map_err(|e| e.to_string())?;
        let tallies = job.tallies();
        let count = |what: &str| -> f64 {
            let counted = tallies.iter().filter(|(name, _)| name.starts_with(what));
            counted.map(|(_, count)| *count as f64).sum()
        };
        let placed = count("footprints placed");
        run.cards.push(Card {
            scorecard: reference.compare(&made.city, panel).scorecard,
            coverage: coverage(&emptied, &made.city),
            kept: placed / (placed + count("footprints dropped")),
        });
    }
    Ok(run)
}

impl MapRun {
    /// Mean score of a measure over the seeds; `None` where it does not separate.
    fn score(&self, measure: &str) -> Option<f64> {
        let of = |card: &Card| {
            let score = card.scorecard.get(measure).filter(|s| s.informative)?;
            Some(score.score?.clamp(-1.0, 1.0))
        };
        mean(self.cards.iter().filter_map(of))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

fn print_table(runs: &[MapRun]) {
    let measures: Vec<&str> =
        BUILT.iter().filter(|m| FAMILIES.contains(&m.family)).map(|m| m.name).collect();
    let figure = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.2}"));
    let names: Vec<String> = runs.iter().map(|r| r.name.replace('_', " ")).collect();
    println!("| measure | {} | **mean** |", names.join(" | "));
    println!("|---|{}---|", "---|".repeat(runs.len()));
    let row = |what: &str, cells: Vec<String>| println!("| {what} | {} |", cells.join(" | "));
    let line = |what: &str, value: &dyn Fn(&MapRun) -> Option<f64>| {
        let values: Vec<Option<f64>> = runs.iter().map(value).collect();
        let mean = mean(values.iter().flatten().copied());
        row(what, values.into_iter().chain([mean]).map(figure).collect());
    };
    for measure in &measures {
        line(measure, &|r| r.score(measure));
    }
    let of_map = |r: &MapRun| mean(measures.iter().filter_map(|m| r.score(m)));
    let all = runs.iter().flat_map(|r| measures.iter().filter_map(|m| r.score(m)));
    let cells = runs.iter().map(of_map).chain([mean(all)]).map(figure).collect();
    row("**mean of measures**", cells);
    line("coverage of the example", &|r| Some(r.example));
    line("coverage of the emptied half", &|r| Some(r.held_out));
    let covered = |r: &MapRun| mean(r.cards.iter().map(|c| c.coverage));
    line("coverage of the filled half", &covered);
    line("filled by example", &|r| Some(covered(r)? / r.example));
    line("footprints kept", &|r| mean(r.cards.iter().map(|c| c.kept)));
}
