//! `exurb compare CITY --with EXAMPLE`

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use exurb_city::{City, FeatureShape};
use exurb_geom::GridPoint;
use exurb_gis::theme::{GeometryType, Theme, ThemeRow};
use exurb_likeness::comparison::{common_size, split};
use exurb_likeness::{
    Document, Floor, Panel, Place, Reference, columns, unlikely, windows, yardstick_table,
};
use exurb_measure::{Info, Network};
use exurb_operation::Run;
use exurb_recipe::Source;
use exurb_report::{Column, Report};
use serde_json::{Value, json};

use crate::options::RunOptions;
use crate::pending::{Pending, is_one_of};
use crate::problem::Problem;
use crate::{job, report};

/// Random draws are the same in every run.
const SEED: u64 = 1;

#[derive(Args)]
struct Options {
    /// City to judge, any readable format
    #[arg(required_unless_present = "yardstick", value_name = "CITY")]
    city: Option<PathBuf>,
    /// Example it was made from; repeatable, each is compared on its own
    #[arg(long, required_unless_present = "yardstick", value_name = "EXAMPLE")]
    with: Vec<PathBuf>,
    /// Part of the example that the city was not made from, one for each example [default: the east
    /// half of the example's densest square, its west half standing for the example; of a strip from
    /// north to south the south half]
    #[arg(long, value_name = "CITY")]
    held_out: Vec<PathBuf>,
    /// Other cities, whose mean distance scores 0 [default: a built-in panel of nine cities]
    #[arg(long, value_name = "CITY", num_args = 1..)]
    floor: Vec<PathBuf>,
    /// Check the scale itself instead: score other parts, other cities, spoilt copies and streets by
    /// rule against each of these cities
    #[arg(long, value_name = "CITY", num_args = 1.., conflicts_with_all = ["city", "with", "held_out", "floor"])]
    yardstick: Vec<PathBuf>,
    /// Write the comparison as one page of HTML, with maps and distributions
    #[arg(long, value_name = "FILE.html", conflicts_with = "yardstick")]
    report: Option<PathBuf>,
    /// Write where the city differs: how unlikely each of its blocks and junctions is under the
    /// first example
    #[arg(long, value_name = "FILE.gpkg", conflicts_with = "yardstick")]
    map: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
}

/// The command.
pub fn command() -> Command {
    let about = "How like its example a city is: scores between another city (0) and the example's \
                 own other part (1)";
    Options::augment_args(Command::new("compare")).about(about)
}

/// Runs it.
pub fn run(matches: &ArgMatches) -> Result<(), Problem> {
    let options = Options::from_arg_matches(matches).map_err(|e| Problem::usage(e.to_string()))?;
    let text = job::work(&options.run, SEED, |run| {
        let panel = Panel::builtin().map_err(|e| Problem::failed(e.to_string()))?;
        match &options.city {
            Some(city) => compare(city, &options, &panel, run),
            None => yardstick(&options, &panel, run),
        }
    })?;
    report::result(&text)
}

fn compare(city: &Path, options: &Options, panel: &Panel, run: &Run) -> Result<String, Problem> {
    let inputs = [&options.with, &options.held_out, &options.floor].into_iter().flatten();
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).chain([city]).collect();
    writable(options.report.as_deref(), "--report", &["html", "htm"], &inputs)?;
    writable(options.map.as_deref(), "--map", &["gpkg"], &inputs)?;
    let candidate = read(city, run)?;
    let examples = read_all(&options.with, run)?;
    let held_out = read_all(&options.held_out, run)?;
    let floor = read_all(&options.floor, run)?;
    if !held_out.is_empty() && held_out.len() != examples.len() {
        return Err(Problem::usage(format!(
            "there are {} examples and {} held-out parts; give one --held-out for each --with, or none",
            examples.len(),
            held_out.len()
        )));
    }
    // Before the long work: can the files be written?
    let page = options.report.as_deref().map(Pending::new).transpose()?;
    let map = options.map.as_deref().map(Pending::new).transpose()?;
    run.phase("comparing");
    let mut found = Vec::new();
    for (number, example) in examples.iter().enumerate() {
        let reference = reference(&candidate, example, held_out.get(number), &floor, panel);
        run.check()?;
        let likeness = reference.compare(&candidate, panel);
        let document = Document::of(&reference, &likeness);
        found.push((reference, likeness, document));
        run.check()?;
    }
    let info = Info::of(&candidate, examples.first());
    if let Some(page) = page {
        let columns: Vec<Column> = found
            .iter()
            .zip(&examples)
            .enumerate()
            .map(|(number, ((reference, likeness, document), example))| Column {
                example,
                held_out: held_out.get(number).unwrap_or(example),
                reference,
                likeness,
                document,
            })
            .collect();
        let report = Report { candidate: &candidate, info: &info, columns: &columns };
        let html = exurb_report::to_html(&report).map_err(|e| page.problem(&e.to_string()))?;
        page.write(html.as_bytes())?;
        page.commit()?;
    }
    if let (Some(map), Some((reference, likeness, _))) = (map, found.first()) {
        let themes = themes(&likeness.candidate.network, reference);
        exurb_gis::write_themes(&candidate, &themes, map.beside())
            .map_err(|e| map.problem(&e.to_string()))?;
        map.commit()?;
    }
    let documents: Vec<Document> = found.into_iter().map(|(.., document)| document).collect();
    if options.run.json {
        return Ok(format!("{:#}", to_json(&candidate, &documents, &info)));
    }
    Ok(to_text(&candidate, &documents, &info))
}

/// Refuses a file to write that has another ending, or is one of those to read: a page or a map of
/// differences is no city, so that what it replaces would be lost.
fn writable(
    file: Option<&Path>,
    option: &str,
    endings: &[&str],
    inputs: &[&Path],
) -> Result<(), Problem> {
    let Some(file) = file else { return Ok(()) };
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_file = |f: &Path| f.metadata().map_or(true, |there| there.is_file());
    if is_file(file) && !endings.contains(&&*ending) {
        let wanted = endings[0];
        return Err(Problem::usage(format!("{option} {}: name a .{wanted} file", file.display())));
    }
    if is_one_of(file, inputs.iter().copied()) {
        let message = "it is one of the cities compared and would be lost; name another file";
        return Err(Problem::usage(format!("{option} {}: {message}", file.display())));
    }
    Ok(())
}

/// The layers of the map of differences.
fn themes(candidate: &Network, reference: &Reference) -> [Theme; 2] {
    let example = [&reference.part.network, &reference.held_out];
    let block = |b: unlikely::Block| ThemeRow {
        values: [
            b.unlikely,
            Some(b.shape.area_m2),
            Some(b.shape.phi),
            Some(b.shape.aspect),
            Some(b.shape.rectangularity),
        ]
        .to_vec(),
        shape: FeatureShape::Polygon(b.polygon),
    };
    let junction = |j: unlikely::Junction| ThemeRow {
        shape: FeatureShape::Point(GridPoint::round(j.at)),
        values: [
            j.unlikely,
            Some(j.degree as f64),
            Some(j.angles[0]),
            Some(j.angles[1]),
            Some(j.leg_m),
        ]
        .to_vec(),
    };
    [
        Theme {
            name: "blocks",
            geometry: GeometryType::Polygon,
            columns: vec!["unlikely", "area", "phi", "aspect", "rectangularity"],
            rows: unlikely::blocks(candidate, &example).into_iter().map(block).collect(),
        },
        Theme {
            name: "junctions",
            geometry: GeometryType::Point,
            columns: vec!["unlikely", "degree", "widest_angle", "narrowest_angle", "mean_leg"],
            rows: unlikely::junctions(candidate, &example).into_iter().map(junction).collect(),
        },
    ]
}

/// The example, its parts and the floor, all windows of one size.
fn reference(
    candidate: &City,
    example: &City,
    held_out: Option<&City>,
    floor: &[City],
    panel: &Panel,
) -> Reference {
    let (part, other) = match held_out {
        None => {
            let [a, b] = split(example);
            (a, b)
        }
        Some(city) => {
            let size = city.target.bounds().size();
            let window = windows::of_size(example, size);
            let held_out = Place { city, window: city.target.bounds() };
            (Place { city: example, window }, held_out)
        }
    };
    let (size, note) = common_size(part, other, floor.iter().chain([candidate]));
    let floor = if floor.is_empty() { Floor::Panel } else { Floor::Cities(floor) };
    let mut reference = Reference::new(example, &[part], other, floor, panel, size, SEED);
    reference.notes.extend(note);
    reference
}

fn read(file: &Path, run: &Run) -> Result<City, Problem> {
    let source = Source::new(file);
    let mut city = exurb_recipe::read_source(&source, Path::new(""), run)?;
    if city.metadata.name.is_empty() {
        city.metadata.name = source.name().into();
    }
    if city.streets.edges().next().is_none() {
        let message = "it has no streets, so there is nothing to compare";
        return Err(Problem::usage(format!("{}: {message}", file.display())));
    }
    Ok(city)
}

fn read_all(files: &[PathBuf], run: &Run) -> Result<Vec<City>, Problem> {
    files.iter().map(|file| read(file, run)).collect()
}

/// The contract's keys are those of the first example; `examples` holds them all.
fn to_json(candidate: &City, documents: &[Document], info: &Info) -> Value {
    let mut value = json!(documents.first());
    if let Some(object) = value.as_object_mut() {
        object.insert("candidate".into(), json!(&*candidate.metadata.name));
        object.insert("laws".into(), json!(info.laws));
        object.insert("likeness_gates".into(), json!(info.likeness_gates));
        object.insert("valid".into(), json!(info.valid));
        object.insert("examples".into(), json!(documents));
    }
    value
}

fn to_text(candidate: &City, documents: &[Document], info: &Info) -> String {
    let mut out = String::new();
    if documents.len() > 1 {
        out = format!("{} beside its examples\n", candidate.metadata.name);
        out += &columns::side_by_side(documents);
        out.push('\n');
    }
    for document in documents {
        out += &format!("{} compared with {}\n", candidate.metadata.name, document.example);
        out += &document.to_text();
        out.push('\n');
    }
    let broken = info.laws.iter().filter(|(_, law)| !law.pass).map(|(name, _)| name.as_str());
    let broken: Vec<&str> = broken.collect();
    let gates = info.likeness_gates.iter().filter(|(_, gate)| gate.pass == Some(false));
    let missed: Vec<&str> = gates.map(|(name, _)| name.as_str()).collect();
    let list = |names: Vec<&str>| if names.is_empty() { "none".into() } else { names.join(", ") };
    out + &format!("laws broken     {}\ngates missed    {}\n", list(broken), list(missed))
}

fn yardstick(options: &Options, panel: &Panel, run: &Run) -> Result<String, Problem> {
    let cities = read_all(&options.yardstick, run)?;
    if cities.len() < 2 {
        let message = "a yardstick needs at least two cities: each is the floor of the others";
        return Err(Problem::usage(message));
    }
    run.phase("measuring");
    let cities: Vec<&City> = cities.iter().collect();
    let table = yardstick_table::table(&cities, &panel.dictionary, SEED);
    run.check()?;
    Ok(if options.run.json { format!("{:#}", json!(table)) } else { table.to_text() })
}
