use std::path::PathBuf;

use exurb_city::{ImportOptions, Part};
use exurb_geom::LonLat;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::{Library, Size, TerrainSource};

/// The version of the recipe format that this program reads and writes.
pub const VERSION: u32 = 1;

/// Operations in order, with what they work on: everything that makes a city, as a document.
///
/// The same recipe on the same inputs gives the same city, byte for byte.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Version of the format; [`VERSION`].
    pub exurb: u32,
    /// Random seed of every step that has none of its own; 0 to 2⁶³ − 1.
    #[serde(default = "default_seed")]
    pub seed: u64,
    /// Threads to work on; every processor when absent. Changes nothing in the city.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// The city that the steps begin with. Without one, the first step makes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub city: Option<Source>,
    /// Where and how large a new city is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Target>,
    /// The ground under the city; that of a given city stays without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<TerrainSource>,
    /// What the steps learn from. Without any, a step learns from the given city as it is before
    /// the step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub examples: Vec<Source>,
    /// A folder of further examples, from which the first step chooses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub library: Option<Library>,
    /// The operations, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<Step>,
    /// Files to write.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exports: Vec<Export>,
}

/// A file to read a city from, and what of it to take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Any readable map or city, beside the recipe or in the current folder; or
    /// `builtin:NAME`, an example that comes with the program.
    pub file: PathBuf,
    /// The word by which steps choose it; its name when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Its name in the provenance of what is copied; the stem of the file when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its share where a method mixes examples; positive, 1 when absent.
    #[serde(default = "default_weight", skip_serializing_if = "is_default_weight")]
    pub weight: f64,
    /// West, south, east and north of the part to take, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bbox: Option<[f64; 4]>,
    /// Half of the densest 5 km square: `west`, `east`, `north` or `south`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<Half>,
    /// Let service roads and the like count as streets.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub with_service: bool,
    /// Join dual carriageways into one street and shrink small roundabouts to junctions.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub simplify: bool,
    /// The ground under it, from a height map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<TerrainSource>,
}

/// A half of an example; see [`Part`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "the names say it")]
pub enum Half {
    West,
    East,
    North,
    South,
}

/// Where and how large a new city is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Target {
    /// An axis-parallel rectangle around the first example's centre.
    Size(Size),
    /// The polygon of a GeoJSON or GeoPackage file.
    File(PathBuf),
}

/// One operation with its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Command words, as in `streets grow`.
    pub op: String,
    /// A random seed of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The examples it learns from, by id or name; all of them when absent, the city as it is before
    /// the step when the list is empty.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub examples: Option<Vec<String>>,
    /// Where it may change the city.
    #[serde(default, skip_serializing_if = "Within::is_all")]
    pub scope: Within,
    /// A map whose streets lie there before the step and stay as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed: Option<PathBuf>,
    /// Its parameters; what is absent takes its default.
    #[serde(flatten)]
    pub params: Map<String, Value>,
}

/// Where a step may change the city.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Within {
    /// Everywhere.
    #[default]
    All,
    /// Inside the polygon of a GeoJSON or GeoPackage file.
    File(PathBuf),
    /// Where the recipe's terrain differs from the ground of its city.
    Changed,
    /// In the blocks of these numbers.
    Blocks(Vec<u32>),
}

/// A file to write; relative names lie in the output folder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Export {
    /// Its name; the ending chooses the format.
    pub file: PathBuf,
    /// The format where the ending is not enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// The one layer to write.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
    /// `map` from above, or `3d`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// Style of a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub style: Option<String>,
    /// What the colours of a picture tell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color_by: Option<String>,
    /// Width of a picture in pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// Perspective: where the camera stands, in degrees clockwise from north.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// Perspective: how high the camera stands over the horizon, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation: Option<f64>,
    /// Perspective: 1 fills the picture with the city, 2 with half of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            exurb: VERSION,
            seed: default_seed(),
            threads: None,
            city: None,
            target: None,
            terrain: None,
            examples: Vec::new(),
            library: None,
            steps: Vec::new(),
            exports: Vec::new(),
        }
    }
}

impl Source {
    /// The whole of a file, with weight 1.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        let file = file.into();
        let (id, name, bbox, part) = (None, None, None, None);
        let (with_service, simplify) = (false, false);
        Self { file, id, name, weight: 1.0, bbox, part, with_service, simplify, terrain: None }
    }

    /// The word by which steps choose it: its id, else its name.
    pub fn key(&self) -> String {
        self.id.clone().unwrap_or_else(|| self.name())
    }

    /// Its name: the given one, else the stem of the file up to its first dot.
    pub fn name(&self) -> String {
        if let Some(name) = &self.name {
            return name.clone();
        }
        let file = self.file.file_name().unwrap_or(self.file.as_os_str()).to_string_lossy();
        let file = file.strip_prefix("builtin:").unwrap_or(&file);
        file.split('.').find(|part| !part.is_empty()).unwrap_or("city").to_owned()
    }

    /// The same, each under a name of its own.
    pub fn distinct(sources: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut distinct: Vec<Self> = Vec::new();
        for mut source in sources {
            let plain = source.name();
            let mut number = 2;
            while distinct.iter().any(|s| s.name() == source.name()) {
                source.name = Some(format!("{plain}-{number}"));
                number += 1;
            }
            distinct.push(source);
        }
        distinct
    }

    /// What of the file to take, for the readers.
    pub fn import_options(&self) -> ImportOptions {
        let corners = |[west, south, east, north]: [f64; 4]| {
            [LonLat { lon: west, lat: south }, LonLat { lon: east, lat: north }]
        };
        ImportOptions {
            bbox: self.bbox.map(corners),
            part: self.part.map(Half::part),
            with_other: self.with_service,
            simplify: self.simplify,
        }
    }
}

impl Half {
    /// All four, with their names.
    pub const ALL: [(&'static str, Self); 4] = [
        ("west", Self::West),
        ("east", Self::East),
        ("north", Self::North),
        ("south", Self::South),
    ];

    /// The half as readers know it.
    pub fn part(self) -> Part {
        match self {
            Self::West => Part::West,
            Self::East => Part::East,
            Self::North => Part::North,
            Self::South => Part::South,
        }
    }
}

impl Step {
    /// An operation with every parameter at its default.
    pub fn new(op: impl Into<String>) -> Self {
        let (seed, examples, scope, fixed) = (None, None, Within::All, None);
        Self { op: op.into(), seed, examples, scope, fixed, params: Map::new() }
    }
}

impl Within {
    fn is_all(&self) -> bool {
        *self == Self::All
    }
}

fn default_seed() -> u64 {
    1
}

fn default_weight() -> f64 {
    1.0
}

fn is_default_weight(weight: &f64) -> bool {
    *weight == 1.0
}
