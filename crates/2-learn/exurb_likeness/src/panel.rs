//! The built-in panel: what was measured of nine cities, for floors and for the filters of the
//! discriminator.
//!
//! It holds distributions, no geometry: quantiles, shares, features of patches. `cargo xtask panel`
//! makes it from maps. The floor of a comparison decides what a score of 0 means, so scores made
//! with different panels must not be compared.

use std::collections::BTreeMap;
use std::io::Read;

use exurb_city::{City, Part};
use exurb_measure::Sample;
use ndarray::Array2;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::draws::ByWeight;
use crate::measures::STREETS;
use crate::patches::{CANDIDATE, Dictionary, Filters, Image, LearnError, Patches};
use crate::{Measured, Side, windows};

/// The fixed panel, by file name of its maps.
pub const CITIES: [&str; 9] = [
    "liege",
    "salt_lake_city",
    "aleppo",
    "auckland",
    "bucaramanga",
    "douala",
    "wuhan",
    "campo_grande",
    "porto_alegre",
];

const BUILTIN: &[u8] = include_bytes!("../data/panel.json.gz");
/// Quantiles kept of a distribution, and blocks of a fingerprint.
const QUANTILES: usize = 200;
const BLOCKS: usize = 500;
/// Levels of a feature, from 0.
const MOST_LEVEL: f32 = 63.0;

/// Cities to measure others by.
#[derive(Debug)]
pub struct Panel {
    /// Filters of the discriminator, learned from these cities.
    pub dictionary: Dictionary,
    /// The cities.
    pub cities: Vec<PanelCity>,
}

/// What was measured of one city.
#[derive(Debug)]
pub struct PanelCity {
    /// Its name.
    pub name: String,
    /// West, south, east and north border of the part measured, in degrees.
    pub bbox: [f64; 4],
    /// Streets and blocks.
    pub measured: Measured,
    /// Patches of its streets.
    pub patches: Option<Patches>,
}

/// Why a panel cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("the panel cannot be read: {0}")]
pub struct PanelError(String);

impl Panel {
    /// The panel that comes with the program.
    pub fn builtin() -> Result<Self, PanelError> {
        Self::read(BUILTIN)
    }

    /// Reads what [`Panel::write`] gave.
    pub fn read(packed: &[u8]) -> Result<Self, PanelError> {
        let mut text = String::new();
        let mut unpacked = flate2::read::GzDecoder::new(packed);
        unpacked.read_to_string(&mut text).map_err(|e| PanelError(e.to_string()))?;
        let document: Document =
            serde_json::from_str(&text).map_err(|e| PanelError(e.to_string()))?;
        document.panel()
    }

    /// The panel as gzipped JSON.
    pub fn write(&self) -> Result<Vec<u8>, PanelError> {
        let wrong = |e: String| PanelError(e);
        let text = serde_json::to_vec(&Document::of(self)).map_err(|e| wrong(e.to_string()))?;
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        std::io::Write::write_all(&mut packed, &text).map_err(|e| wrong(e.to_string()))?;
        packed.finish().map_err(|e| wrong(e.to_string()))
    }

    /// The cities that lie apart from all of these: their own place is no other city.
    pub fn others<'a>(&'a self, cities: &[&City]) -> Vec<&'a PanelCity> {
        let places: Vec<[f64; 4]> = cities.iter().map(|city| place_of(city)).collect();
        let apart =
            |a: &[f64; 4], b: &[f64; 4]| a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1];
        self.cities.iter().filter(|c| places.iter().all(|p| apart(&c.bbox, p))).collect()
    }
}

impl Panel {
    /// Measures a panel: the west half of each city's densest square. The filters are learned from
    /// both halves of all of them.
    pub fn measure(cities: &[City], seed: u64) -> Result<Self, LearnError> {
        let parts = [Part::West, Part::East];
        let halves: Vec<[Measured; 2]> = cities
            .par_iter()
            .map(|city| windows::halves(city, parts).map(|w| Measured::of(&city.streets, w)))
            .collect();
        let images: Vec<&Image> =
            halves.iter().flatten().filter_map(|half| half.image.as_ref()).collect();
        let dictionary = Dictionary::learn(&images, seed)?;
        let city = |(city, [west, _]): (&City, [Measured; 2])| PanelCity {
            name: city.metadata.name.to_string(),
            bbox: place_of(city),
            patches: west.image.as_ref().map(|i| Patches::of(i, &dictionary, seed, CANDIDATE)),
            measured: west,
        };
        let cities = cities.iter().zip(halves).map(city).collect();
        Ok(Self { dictionary, cities })
    }
}

impl PanelCity {
    /// As one side of a comparison.
    pub fn side(&self) -> Side<'_> {
        Side { measured: &self.measured, patches: self.patches.as_ref() }
    }
}

/// West, south, east and north border of a city in degrees.
pub fn place_of(city: &City) -> [f64; 4] {
    let bounds = city.target.bounds();
    let (sw, ne) = (city.frame.unproject(bounds.min), city.frame.unproject(bounds.max));
    [sw.lon, sw.lat, ne.lon, ne.lat]
}

/// Share of the smaller of two places that lies in the other.
pub(crate) fn shared_area(a: [f64; 4], b: [f64; 4]) -> f64 {
    let side = |i: usize| (a[i + 2].min(b[i + 2]) - a[i].max(b[i])).max(0.0);
    let area = |p: [f64; 4]| (p[2] - p[0]) * (p[3] - p[1]);
    side(0) * side(1) / area(a).min(area(b))
}

#[derive(Serialize, Deserialize)]
struct Document {
    about: String,
    filters: Vec<FiltersDocument>,
    cities: Vec<CityDocument>,
}

#[derive(Serialize, Deserialize)]
struct FiltersDocument {
    mean: Vec<f32>,
    whitening: Vec<f32>,
    centres: Vec<f32>,
}

#[derive(Serialize, Deserialize)]
struct CityDocument {
    name: String,
    bbox: [f64; 4],
    distributions: BTreeMap<String, Distribution>,
    degrees: Option<[f64; 5]>,
    bearings: Option<Vec<f64>>,
    blocks: Vec<[f32; 2]>,
    patches: Option<PatchesDocument>,
}

/// A distribution: the number of values, and quantiles in even steps.
#[derive(Serialize, Deserialize)]
struct Distribution {
    count: usize,
    quantiles: Vec<f32>,
}

/// Features in 64 levels, each feature between its least and its greatest value.
#[derive(Serialize, Deserialize)]
struct PatchesDocument {
    least: Vec<f32>,
    step: Vec<f32>,
    levels: Vec<u8>,
    halves: Vec<[bool; 2]>,
}

impl Document {
    fn of(panel: &Panel) -> Self {
        let about = "Measured from OpenStreetMap data, (c) OpenStreetMap contributors, ODbL 1.0: \
                     distributions of streets and blocks in the west half of each city's densest \
                     5 km square, without geometry.";
        let filters = panel.dictionary.scales.iter().map(|f| FiltersDocument {
            mean: f.mean.to_vec(),
            whitening: f.whitening.iter().copied().collect(),
            centres: f.centres.iter().copied().collect(),
        });
        Self {
            about: about.to_owned(),
            filters: filters.collect(),
            cities: panel.cities.iter().map(CityDocument::of).collect(),
        }
    }

    fn panel(self) -> Result<Panel, PanelError> {
        let wrong = || PanelError("its filters are incomplete".to_owned());
        let filters: Vec<Filters> = self
            .filters
            .into_iter()
            .map(|f| Filters::from_rows(f.mean, f.whitening, f.centres))
            .collect::<Option<_>>()
            .ok_or_else(wrong)?;
        let scales = filters.try_into().map_err(|_| wrong())?;
        let cities = self.cities.into_iter().map(CityDocument::city).collect();
        Ok(Panel { dictionary: Dictionary { scales }, cities })
    }
}

impl CityDocument {
    fn of(city: &PanelCity) -> Self {
        let measured = &city.measured;
        let shares: Vec<f64> =
            (0..QUANTILES).map(|i| (i as f64 + 0.5) / QUANTILES as f64).collect();
        let distribution = |sample: &Sample| Distribution {
            count: sample.len(),
            quantiles: sample.quantiles(&shares).iter().map(|v| round(*v)).collect(),
        };
        let distributions = measured.samples.iter();
        Self {
            name: city.name.clone(),
            bbox: city.bbox.map(|v| (v * 1e4).round() / 1e4),
            distributions: distributions.map(|(n, s)| ((*n).to_owned(), distribution(s))).collect(),
            degrees: measured.degrees,
            bearings: measured.bearings.map(|b| b.to_vec()),
            blocks: drawn_blocks(&measured.fingerprint),
            patches: city.patches.as_ref().map(PatchesDocument::of),
        }
    }

    fn city(self) -> PanelCity {
        let mut measured = Measured {
            degrees: self.degrees,
            bearings: self.bearings.and_then(|b| b.try_into().ok()),
            fingerprint: self.blocks.iter().map(|b| (b.map(f64::from), 1.0)).collect(),
            ..Measured::default()
        };
        for measure in STREETS {
            if let Some(found) = self.distributions.get(measure.name) {
                let values = found.quantiles.iter().map(|v| f64::from(*v));
                measured.samples.insert(measure.name, Sample::plain(values));
                measured.sizes.insert(measure.name, found.count);
            }
        }
        let patches = self.patches.and_then(PatchesDocument::patches);
        PanelCity { name: self.name, bbox: self.bbox, measured, patches }
    }
}

/// Five digits.
fn round(value: f64) -> f32 {
    format!("{value:.4e}").parse().unwrap_or(value as f32)
}

/// At most 500 blocks, drawn by weight, so that they count alike.
fn drawn_blocks(blocks: &[([f64; 2], f64)]) -> Vec<[f32; 2]> {
    if blocks.is_empty() {
        return Vec::new();
    }
    let weights: Vec<f64> = blocks.iter().map(|(_, weight)| *weight).collect();
    let by_weight = ByWeight::new(&weights);
    let mut rng = exurb_operation::rng::stream(1, "panel blocks", 0);
    (0..BLOCKS).map(|_| blocks[by_weight.draw(&mut rng)].0.map(round)).collect()
}

impl PatchesDocument {
    fn of(patches: &Patches) -> Self {
        let columns = patches.features.columns();
        let ranges: Vec<(f32, f32)> = columns
            .into_iter()
            .map(|c| {
                let least = c.fold(f32::INFINITY, |a, b| a.min(*b));
                let step = (c.fold(f32::NEG_INFINITY, |a, b| a.max(*b)) - least) / MOST_LEVEL;
                (round(f64::from(least)), round(f64::from(step)))
            })
            .collect();
        let level = |(i, v): (usize, &f32)| {
            let (least, step) = ranges[i % ranges.len()];
            if step > 0.0 { ((v - least) / step).round().clamp(0.0, MOST_LEVEL) as u8 } else { 0 }
        };
        Self {
            levels: patches.features.iter().enumerate().map(level).collect(),
            least: ranges.iter().map(|r| r.0).collect(),
            step: ranges.iter().map(|r| r.1).collect(),
            halves: patches.halves.clone(),
        }
    }

    fn patches(self) -> Option<Patches> {
        let (rows, columns) = (self.halves.len(), self.least.len());
        let value = |(i, level): (usize, &u8)| {
            self.least[i % columns] + f32::from(*level) * self.step[i % columns]
        };
        let values = self.levels.iter().enumerate().map(value).collect();
        let features = Array2::from_shape_vec((rows, columns), values).ok()?;
        Some(Patches { features, halves: self.halves, places: Vec::new() })
    }
}
