//! Options that several commands share.

use std::path::PathBuf;

use clap::Args;
use exurb_recipe::{
    Gaps, Half, Library, Size, Source, Target, TargetWord, TerrainBounds, TerrainSource,
};

use crate::format::Format;

/// How a command works and reports.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub struct RunOptions {
    /// Threads to work on [default: every processor]; changes nothing in the result
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Stop when the program uses more memory than this, as in 500M or 4G (Linux only)
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    pub max_memory: Option<u64>,
    /// Print the result as JSON on standard output
    #[arg(long)]
    pub json: bool,
    /// Print no progress and no summary, only errors and what was asked for
    #[arg(long, short)]
    pub quiet: bool,
}

/// The random seed.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub struct SeedOptions {
    /// Random seed: same inputs, parameters and seed, same city
    #[arg(long, value_name = "N", default_value_t = 1,
          allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    pub seed: u64,
    /// Read and check everything, print the recipe, write nothing
    #[arg(long)]
    pub dry_run: bool,
}

/// The file to write.
#[derive(Args, Clone, Debug)]
pub struct OutputOptions {
    /// File to write, replaced when it is there; its ending chooses the format
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Format, where the ending is not enough
    #[arg(long, value_name = "FORMAT", value_parser = Format::names().collect::<Vec<_>>())]
    pub to: Option<String>,
}

/// Whether to write at all.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub struct DryOptions {
    /// Read and check everything, write nothing
    #[arg(long)]
    pub dry_run: bool,
}

/// What of a map to take.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading")]
pub struct PartOptions {
    /// Half of the densest 5 km square: west, east, north or south
    #[arg(long, value_name = "SIDE", value_parser = half)]
    pub part: Option<Half>,
    /// West, south, east and north of the part to take, in degrees
    #[arg(long, value_name = "W,S,E,N", value_parser = bbox, allow_hyphen_values = true)]
    pub bbox: Option<[f64; 4]>,
    /// Let service roads and the like count as streets
    #[arg(long)]
    pub with_service: bool,
    /// Join dual carriageways into one street and shrink small roundabouts to junctions
    #[arg(long)]
    pub simplify: bool,
}

/// What to learn from.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading")]
pub struct ExampleOptions {
    /// City to learn from, any readable format or builtin:NAME; repeatable, with its share where a
    /// method mixes
    #[arg(long = "example", short, value_name = "FILE[=WEIGHT]", value_parser = example)]
    pub examples: Vec<Source>,
    /// What of the examples to take.
    #[command(flatten)]
    pub part: PartOptions,
}

/// What to choose examples from.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading")]
pub struct LibraryOptions {
    /// Folder of maps and cities, height maps of the same names beside them, of which those serve that
    /// fit: by ground, by the density of areas, or by a drawn fragment
    #[arg(long, value_name = "DIR")]
    pub example_library: Option<PathBuf>,
}

impl LibraryOptions {
    /// The folder as a recipe has it.
    pub fn library(self) -> Option<Library> {
        self.example_library.map(|folder| Library { folder })
    }
}

/// Where and how large a new city is.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Target")]
pub struct TargetOptions {
    /// GeoJSON or GeoPackage file with the polygon to fill
    #[arg(long, value_name = "AREA.geojson", conflicts_with = "size")]
    pub target: Option<PathBuf>,
    /// Width and height in metres, around the first example's centre [default: 2000x2000]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub size: Option<Size>,
}

/// The ground of a city.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Terrain")]
pub struct TerrainOptions {
    /// Height map under the city: GeoTIFF, SRTM .hgt, ESRI ASCII grid, 16-bit PNG, or a city file
    #[arg(long, value_name = "DEM")]
    pub terrain: Option<PathBuf>,
    /// Everything up to this height is under water, in metres
    #[arg(long, value_name = "M", requires = "terrain", allow_negative_numbers = true)]
    pub water_level: Option<f64>,
    /// Where the height map knows no height of the target: extend the heights around, or refuse
    /// [default: extend]
    #[arg(long, value_name = "WHAT", requires = "terrain", value_parser = gaps)]
    pub terrain_gaps: Option<Gaps>,
    /// Outer edges of a height map that does not say where it lies: degrees, or `target`
    #[arg(long, value_name = "W,S,E,N|target", requires = "terrain", allow_hyphen_values = true,
          value_parser = terrain_bounds)]
    pub terrain_bounds: Option<TerrainBounds>,
    /// Heights of black and white of a PNG, in metres
    #[arg(long, value_name = "LOW,HIGH", requires = "terrain", allow_hyphen_values = true,
          value_parser = range)]
    pub terrain_range: Option<[f64; 2]>,
    /// Coordinate system of a height map that does not name it, as in EPSG:32633
    #[arg(long, value_name = "CRS", requires = "terrain")]
    pub terrain_crs: Option<String>,
    /// Distance of neighbouring heights in the city, in metres [default: that of the height map]
    #[arg(long, value_name = "M", requires = "terrain", value_parser = cell)]
    pub terrain_cell: Option<f64>,
}

impl TerrainOptions {
    /// The height map as a recipe has it.
    pub fn source(&self) -> Option<TerrainSource> {
        self.terrain.clone().map(|file| TerrainSource {
            file,
            water_level: self.water_level,
            gaps: self.terrain_gaps.unwrap_or_default(),
            cell: self.terrain_cell,
            bounds: self.terrain_bounds,
            range: self.terrain_range,
            crs: self.terrain_crs.clone(),
        })
    }
}

impl PartOptions {
    /// The source with these options.
    pub fn apply(&self, source: Source) -> Source {
        let Self { part, bbox, with_service, simplify } = *self;
        Source { part, bbox, with_service, simplify, ..source }
    }
}

impl ExampleOptions {
    /// The examples as a recipe has them, each under a name of its own.
    pub fn sources(&self) -> Vec<Source> {
        Source::distinct(self.examples.iter().map(|example| self.part.apply(example.clone())))
    }
}

impl TargetOptions {
    /// The target as a recipe has it.
    pub fn target(&self) -> Target {
        match &self.target {
            Some(file) => Target::File(file.clone()),
            None => Target::Size(self.size.unwrap_or_default()),
        }
    }
}

fn half(text: &str) -> Result<Half, String> {
    let wrong = || "expected west, east, north or south".to_owned();
    Half::ALL.into_iter().find(|(name, _)| *name == text).map(|(_, half)| half).ok_or_else(wrong)
}

fn bbox(text: &str) -> Result<[f64; 4], String> {
    let wrong = "expected west,south,east,north in degrees, as in 24.93,60.16,24.96,60.18";
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.ok().and_then(|n| <[f64; 4]>::try_from(n).ok()) {
        Some([w, s, e, n])
            if w < e && s < n && w.abs().max(e.abs()) <= 180.0 && s.abs().max(n.abs()) <= 90.0 =>
        {
            Ok([w, s, e, n])
        }
        _ => Err(wrong.to_owned()),
    }
}

fn gaps(text: &str) -> Result<Gaps, String> {
    match text {
        "extend" => Ok(Gaps::Extend),
        "refuse" => Ok(Gaps::Refuse),
        _ => Err("expected extend or refuse".to_owned()),
    }
}

fn terrain_bounds(text: &str) -> Result<TerrainBounds, String> {
    match text.trim() {
        "target" => Ok(TerrainBounds::Word(TargetWord::Target)),
        text => bbox(text).map(TerrainBounds::Degrees),
    }
}

fn range(text: &str) -> Result<[f64; 2], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.ok().and_then(|n| <[f64; 2]>::try_from(n).ok()) {
        Some([low, high]) if low < high && low.abs().max(high.abs()) <= 20_000.0 => Ok([low, high]),
        _ => Err("expected the heights of black and white in metres, as in 0,350".to_owned()),
    }
}

fn cell(text: &str) -> Result<f64, String> {
    let wrong = || "expected metres, 0.1 to 1000".to_owned();
    text.parse().ok().filter(|m| (0.1..=1000.0).contains(m)).ok_or_else(wrong)
}

/// `FILE` or `FILE=WEIGHT`; a file whose name holds `=` needs its weight said.
fn example(text: &str) -> Result<Source, String> {
    let Some((file, weight)) = text.rsplit_once('=') else { return Ok(Source::new(text)) };
    match weight.parse::<f64>() {
        Ok(weight) if weight > 0.0 && weight.is_finite() => {
            Ok(Source { weight, ..Source::new(file) })
        }
        Ok(weight) => Err(format!("weight {weight} is not positive")),
        Err(_) => Ok(Source::new(text)),
    }
}

fn memory(text: &str) -> Result<u64, String> {
    let wrong = || "expected a number of bytes with K, M or G, as in 500M or 4G".to_owned();
    let upper = text.trim().to_uppercase();
    let upper = upper.trim_end_matches('B').trim_end_matches('I');
    let (number, factor) = match upper.char_indices().last() {
        Some((at, 'K')) => (&upper[..at], 1 << 10),
        Some((at, 'M')) => (&upper[..at], 1 << 20),
        Some((at, 'G')) => (&upper[..at], 1 << 30),
        _ => (upper, 1_u64),
    };
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    if !(number > 0.0 && number.is_finite()) {
        return Err(wrong());
    }
    if !cfg!(target_os = "linux") {
        return Err("the limit can be kept on Linux only".to_owned());
    }
    Ok((number * factor as f64) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_as_people_write_it() {
        assert_eq!(memory("1024"), Ok(1024));
        assert_eq!(memory("1.5K"), Ok(1536));
        assert_eq!(memory("500MB"), Ok(500 << 20));
        assert_eq!(memory("4GiB"), Ok(4 << 30));
        assert!(memory("much").is_err() && memory("-1M").is_err() && memory("").is_err());
    }

    #[test]
    fn examples_carry_weights_and_names_of_their_own() {
        let weighted = example("a/map.osm.pbf=2.5").unwrap();
        assert_eq!((weighted.file.to_str(), weighted.weight), (Some("a/map.osm.pbf"), 2.5));
        assert_eq!(example("a=b.osm").unwrap().file.to_str(), Some("a=b.osm"));
        assert!(example("a.osm=-1").is_err() && example("a.osm=0").is_err());
        let examples = vec![Source::new("a/map.osm"), Source::new("b/map.osm")];
        let options = ExampleOptions { examples, ..ExampleOptions::default() };
        let names: Vec<String> = options.sources().iter().map(Source::name).collect();
        assert_eq!(names, ["map", "map-2"]);
    }

    #[test]
    fn heights_and_edges_are_read_as_people_write_them() {
        assert_eq!(range("-3, 350.5"), Ok([-3.0, 350.5]));
        for wrong in ["", "5", "5,5", "9,2", "NaN,1", "0,1e9"] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
        assert_eq!(terrain_bounds("target"), Ok(TerrainBounds::Word(TargetWord::Target)));
        assert_eq!(terrain_bounds("1,2,3,4"), Ok(TerrainBounds::Degrees([1.0, 2.0, 3.0, 4.0])));
        assert!(terrain_bounds("there").is_err() && cell("0").is_err() && cell("NaN").is_err());
    }

    #[test]
    fn boxes_are_four_numbers_in_order() {
        assert_eq!(bbox("-1,2, 3,4"), Ok([-1.0, 2.0, 3.0, 4.0]));
        for wrong in ["", "1,2,3", "3,2,1,4", "1,4,3,2", "NaN,0,1,1", "-190,0,0,1"] {
            assert!(bbox(wrong).is_err(), "{wrong}");
        }
    }
}
