//! `likeness`: the protocol over every shared map, and its table in docs/likeness.md; `yardstick`: the
//! table there that shows whether the scale behaves; `blocks`: the protocol of buildings, in
//! docs/blocks.md; `panel`: the built-in panel of `exurb compare`, measured anew.

use std::path::PathBuf;

use crate::shell::{self, Outcome, cargo, output_of, root, target};

/// The pages with the tables.
const LIKENESS: &str = "docs/likeness.md";
const BLOCKS: &str = "docs/blocks.md";

/// The shared maps that hold a square of 5 km, for a second yardstick.
const WIDE: [&str; 27] = [
    "aleppo",
    "auckland",
    "baltimore_county_suburb_east",
    "baltimore_harbor",
    "barcelona_eixample_santmarti",
    "bucaramanga",
    "cairo",
    "campo_grande",
    "canberra",
    "columbus",
    "davis_california",
    "douala",
    "heidelberg_roads",
    "liege",
    "los_angeles_paramount",
    "madrid_center",
    "malta_valletta",
    "maribor",
    "monaco_menton_east",
    "paris_center",
    "portland_central",
    "porto_alegre",
    "quito",
    "salt_lake_city",
    "san_francisco",
    "tel_aviv",
    "wuhan",
];

/// Runs the protocol with these options over the shared maps, or over those whose names follow
/// `--maps`. Without options the table goes into docs/likeness.md.
pub fn run(options: &[&str]) -> Outcome {
    let (options, chosen) = match options.iter().position(|o| *o == "--maps") {
        Some(at) => (&options[..at], &options[at + 1..]),
        None => (options, &[][..]),
    };
    let maps: Vec<PathBuf> = maps()?.into_iter().filter(|map| is_chosen(map, chosen)).collect();
    if maps.is_empty() {
        println!("skipped: no shared data");
        return Ok(());
    }
    let build = "build --release --locked --package exurb_benches --bin exurb_protocol";
    shell::run(&mut cargo(build))?;
    let mut protocol = std::process::Command::new(target().join("release/exurb_protocol"));
    let table = output_of(protocol.args(options).args(maps))?;
    println!("{table}");
    if options.is_empty() && chosen.is_empty() {
        write(LIKENESS, "protocol", table.trim_end())
    } else {
        Ok(())
    }
}

/// Runs the protocol of buildings over the shared maps whose buildings are complete; without options the
/// table goes into docs/blocks.md.
pub fn blocks(options: &[&str]) -> Outcome {
    let maps =
        listed("crates/3-synth/exurb_blocks/tests/shared/mod.rs", "COMPLETE: [&str; 17] = [")?;
    if maps.iter().any(|map| !map.exists()) {
        println!("skipped: no shared data");
        return Ok(());
    }
    let build = "build --release --locked --package exurb_benches --bin exurb_blocks_protocol";
    shell::run(&mut cargo(build))?;
    let mut protocol = std::process::Command::new(target().join("release/exurb_blocks_protocol"));
    let table = output_of(protocol.args(options).args(maps))?;
    println!("{table}");
    if options.is_empty() { write(BLOCKS, "protocol", table.trim_end()) } else { Ok(()) }
}

/// Scores spoilt copies, other cities and streets by rule against the cities of the panel, and once more
/// against all maps that are wide enough, of which the page shows the rows alone.
pub fn yardstick() -> Outcome {
    let panel = panel_maps("CITIES: [&str; 9] = [")?;
    let wide: Vec<PathBuf> = WIDE.iter().map(|name| shared_map(name)).collect();
    if panel.iter().chain(&wide).any(|map| !map.exists()) {
        println!("skipped: no shared data");
        return Ok(());
    }
    shell::run(&mut cargo("build --release --locked --bin exurb"))?;
    let table = |maps: Vec<PathBuf>| {
        let mut exurb = std::process::Command::new(target().join("release/exurb"));
        output_of(exurb.args(["compare", "--quiet", "--yardstick"]).args(maps))
    };
    let fenced = |table: &str| format!("```text\n{}\n```", table.trim_end());
    let of_panel = table(panel)?;
    println!("{of_panel}");
    write(LIKENESS, "yardstick", &fenced(&of_panel))?;
    let of_wide = table(wide)?;
    println!("{of_wide}");
    let rows = of_wide.split("\n\n").nth(1).ok_or("the yardstick has no table of rows")?;
    write(LIKENESS, "wide yardstick", &fenced(rows))
}

/// Measures the cities and towns of the panel and writes what `exurb compare` has built in.
pub fn panel() -> Outcome {
    let cities = panel_maps("CITIES: [&str; 9] = [")?;
    let towns = panel_maps("TOWNS: [&str; 9] = [")?;
    if let Some(missing) = cities.iter().chain(&towns).find(|map| !map.exists()) {
        return Err(format!("the panel needs {}", missing.display()));
    }
    let file = root().join("crates/2-learn/exurb_likeness/data/panel.json.gz");
    let mut example = cargo("run --release --locked --package exurb_likeness --example panel --");
    shell::run(example.arg(&file).args(cities).arg("--").args(towns))
}

/// The maps that a list in the source of the panel names.
fn panel_maps(list: &str) -> Outcome<Vec<PathBuf>> {
    listed("crates/2-learn/exurb_likeness/src/panel.rs", list)
}

/// The maps that a list in a source file names, so that each list stands in one place.
fn listed(source: &str, list: &str) -> Outcome<Vec<PathBuf>> {
    let source = std::fs::read_to_string(root().join(source)).map_err(|e| e.to_string())?;
    let names = source.split_once(list).and_then(|(_, rest)| rest.split_once(']'));
    let names = names.map_or("", |(names, _)| names).split('"').skip(1).step_by(2);
    Ok(names.map(shared_map).collect())
}

fn shared_map(name: &str) -> PathBuf {
    root().join("../shared/data/osm").join(format!("{name}.osm.pbf"))
}

fn maps() -> Outcome<Vec<PathBuf>> {
    let Ok(folder) = std::fs::read_dir(root().join("../shared/data/osm")) else {
        return Ok(Vec::new());
    };
    let mut maps: Vec<PathBuf> = folder.flatten().map(|entry| entry.path()).collect();
    maps.sort();
    Ok(maps)
}

fn is_chosen(map: &std::path::Path, names: &[&str]) -> bool {
    let file = map.file_name().unwrap_or_default().to_string_lossy();
    names.is_empty() || names.iter().any(|name| file.split('.').next() == Some(*name))
}

/// Puts a table between its marks in the page.
fn write(page_name: &str, name: &str, table: &str) -> Outcome {
    let (begin, end) = (format!("<!-- {name}: begin -->\n"), format!("<!-- {name}: end -->\n"));
    let path = root().join(page_name);
    let page = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let parts =
        page.split_once(&begin).and_then(|(head, rest)| Some((head, rest.split_once(&end)?.1)));
    let (head, tail) =
        parts.ok_or_else(|| format!("{page_name} lacks the marks of the {name} table"))?;
    std::fs::write(&path, format!("{head}{begin}{table}\n{end}{tail}")).map_err(|e| e.to_string())
}
