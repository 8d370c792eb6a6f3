//! The ground of a city, from a height map.

use std::path::{Path, PathBuf};

use exurb_city::{City, ImportOptions, Terrain};
use exurb_operation::Run;
use exurb_terrain::{Dem, Edges, Options};
use serde::{Deserialize, Serialize};

use crate::{Error, open, sketch};

/// Heights are kept this far around the target, where streets run on.
const AROUND_M: f64 = 200.0;

/// A height map and how to read it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TerrainSource {
    /// GeoTIFF, SRTM tile, ASCII grid or 16-bit PNG; or a city file, whose terrain is taken; or a
    /// sketch of land uses, drawn (GeoJSON) or painted (PNG in colours).
    pub file: PathBuf,
    /// Everything up to this height is under water, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub water_level: Option<f64>,
    /// What to do where it knows no height of the target.
    #[serde(skip_serializing_if = "is_default")]
    pub gaps: Gaps,
    /// Distance of neighbouring heights in the city, in metres; the file's own when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cell: Option<f64>,
    /// Where its outer edges lie, for files that do not say it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<TerrainBounds>,
    /// Heights of black and white of a picture, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Its coordinate system, as in `EPSG:32633`, for files that do not say it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
}

/// What to do where a height map knows no height of the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Gaps {
    /// The known heights around go on smoothly; a warning says how much was missing.
    #[default]
    Extend,
    /// That is an error.
    Refuse,
}

/// Where the outer edges of a height map lie.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum TerrainBounds {
    /// West, south, east and north in degrees.
    Degrees([f64; 4]),
    /// On those of the target.
    Word(TargetWord),
}

/// The word `target`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "the name says it")]
pub enum TargetWord {
    Target,
}

fn is_default(gaps: &Gaps) -> bool {
    *gaps == Gaps::default()
}

/// Lays the terrain of `source` under the city, and water up to its level.
pub fn lay(city: &mut City, source: &TerrainSource, folder: &Path, run: &Run) -> Result<(), Error> {
    let path = open::locate(&source.file, folder)?;
    run.phase(&format!("reading {}", file_name(&source.file)));
    if sketch::is_sketch(&path) {
        return sketch::lay(city, &path, AROUND_M, run.seed());
    }
    let (dem, own_level) = read(&path, source)?;
    let wrong = |message: String| Error::Input(open::named(&path, &message));
    let bounds = city.target.bounds().grown(AROUND_M);
    let terrain = dem.onto(&city.frame, bounds, source.cell).map_err(|e| wrong(e.to_string()))?;
    let terrain = close_gaps(terrain, city, source, run)?;
    city.lay(terrain.with_water_level(source.water_level.or(own_level)));
    city.flood();
    city.metadata.credit(dem.attribution.as_ref());
    run.check()?;
    Ok(())
}

/// The height map, and the water level of a city file.
fn read(path: &Path, source: &TerrainSource) -> Result<(Dem, Option<f64>), Error> {
    if open::is_geopackage(path)? {
        let city = open::open_city(path, &ImportOptions::default())?.city;
        let Some(terrain) = &city.terrain else {
            let message = "the city has no terrain; import it with --terrain DEM first";
            return Err(Error::Input(open::named(path, message)));
        };
        let dem = Dem::of(terrain, &city.frame, &path.display().to_string());
        return Ok((dem, terrain.water_level_m()));
    }
    let edges = source.bounds.map(|bounds| match bounds {
        TerrainBounds::Degrees(edges) => Edges::Degrees(edges),
        TerrainBounds::Word(TargetWord::Target) => Edges::Target,
    });
    let options = Options { edges, range_m: source.range, crs: source.crs.clone() };
    let dem = exurb_terrain::read(path, &options)
        .map_err(|e| Error::Input(open::named(path, &e.to_string())))?;
    Ok((dem, None))
}

/// What is missing of the target is told, and filled or refused.
fn close_gaps(
    terrain: Terrain,
    city: &City,
    source: &TerrainSource,
    run: &Run,
) -> Result<Terrain, Error> {
    if terrain.missing() == 0 && terrain.bounds().contains(city.target.bounds().min) {
        return Ok(terrain);
    }
    let share = terrain.missing_share(&city.target);
    let file = file_name(&source.file);
    let missing = format!(
        "{file} knows no height for {:.1} % of the target ({:.2} km²)",
        share * 100.0,
        share * city.area_km2()
    );
    match source.gaps {
        Gaps::Refuse if share > 0.0 => Err(Error::Input(format!(
            "{missing}; take a larger height map or a smaller target, or let the heights around go \
             on with --terrain-gaps extend"
        ))),
        _ => {
            if share > 0.0 {
                run.warn(format!("{missing}: the heights around go on there"));
            }
            Ok(terrain.filled())
        }
    }
}

fn file_name(file: &Path) -> String {
    file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}
