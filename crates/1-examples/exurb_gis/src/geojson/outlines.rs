//! The polygons of a GeoJSON file, as outlines of a target.

use std::io::Read;
use std::path::Path;

use super::read::{open, system};
use super::stream::{self, Json, Properties, Sink, Stop};
use crate::Error;
use crate::geometry::Geometry;
use crate::target::{Outlines, System};

/// The polygons of a file; only those of features that say they are the target, where there are
/// some.
pub fn outlines_of(path: &Path) -> Result<Outlines, Error> {
    let (file, input) = open(path)?;
    outlines(input, &file)
}

/// [`outlines_of`] from anywhere.
pub fn outlines(input: impl Read, file: &str) -> Result<Outlines, Error> {
    let mut found = Found::default();
    stream::read(input, &mut found)
        .map_err(|source| Error::Json { file: file.to_owned(), source })?;
    let crs = system(found.crs.as_ref())
        .map_err(|crs| Error::CoordinateSystem { file: file.to_owned(), crs })?;
    let polygons = if found.declared.is_empty() { found.polygons } else { found.declared };
    Ok(Outlines { polygons, system: crs.map_or(System::Unsaid, System::Known) })
}

#[derive(Default)]
struct Found {
    crs: Option<Json>,
    /// Of features that say they are the target.
    declared: Vec<Geometry>,
    polygons: Vec<Geometry>,
}

impl Sink for Found {
    fn member(&mut self, key: &str, value: Json) {
        if key == "crs" {
            self.crs = Some(value);
        }
    }

    fn feature(&mut self, geometry: Option<Geometry>, properties: &Properties) -> Result<(), Stop> {
        let is_target = properties.get("element").and_then(Json::as_str) == Some("target");
        let list = if is_target { &mut self.declared } else { &mut self.polygons };
        list.extend(geometry.into_iter().flat_map(Geometry::into_polygons));
        Ok(())
    }
}
