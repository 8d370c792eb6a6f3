use exurb_geom::Crs;

use crate::Error;
use crate::dem::{Affine, Place};

/// What a file may not say about itself. What is given here goes before what the file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Where its outer edges lie.
    pub edges: Option<Edges>,
    /// Heights in metres of black and white of a picture.
    pub range_m: Option<[f64; 2]>,
    /// The coordinate system: `EPSG:code` or a `+proj=` text.
    pub crs: Option<String>,
}

/// Where the outer edges of a raster lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edges {
    /// West, south, east and north in degrees.
    Degrees([f64; 4]),
    /// Over whatever box it is laid on: a height map painted for the target.
    Target,
}

/// What a file says of its place.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// From columns and rows (middles of pixels) to coordinates.
    pub affine: Option<Affine>,
    /// What these are; a name where exurb does not know them.
    pub crs: Option<Result<Crs, String>>,
}

impl Options {
    /// The place of a raster of that many pixels, by these options and what its file says.
    pub(crate) fn place(
        &self,
        file: &str,
        said: Said,
        columns: usize,
        rows: usize,
    ) -> Result<Place, Error> {
        match self.edges {
            Some(Edges::Target) => return Ok(Place::Stretched),
            Some(Edges::Degrees(edges)) => {
                let affine = Affine::between(edges, columns, rows);
                return Ok(Place::Georeferenced { affine, crs: Crs::wgs84().into() });
            }
            None => {}
        }
        let unknown = |crs: &str| {
            let (file, crs) = (file.to_owned(), format!("the coordinate system `{crs}`"));
            Error::CoordinateSystem { file, crs }
        };
        let affine = said.affine.ok_or_else(|| Error::Placeless { file: file.to_owned() })?;
        let crs = match (&self.crs, said.crs) {
            (Some(name), _) => Crs::from_name(name).ok_or_else(|| unknown(name))?,
            (None, Some(Ok(crs))) => crs,
            (None, Some(Err(name))) => return Err(unknown(&name)),
            (None, None) if is_in_degrees(&affine, columns, rows) => Crs::wgs84(),
            (None, None) => {
                let crs = "no coordinate system that it names, and not in degrees".to_owned();
                return Err(Error::CoordinateSystem { file: file.to_owned(), crs });
            }
        };
        Ok(Place::Georeferenced { affine, crs: crs.into() })
    }
}

/// Could the coordinates be longitudes and latitudes? Pixels of a degree or more are none of a map.
fn is_in_degrees(affine: &Affine, columns: usize, rows: usize) -> bool {
    let inside = |(x, y): (f64, f64)| x.abs() <= 180.0 && y.abs() <= 90.0;
    let small = |v: f64| v.abs() < 0.5;
    inside(affine.at(0.0, 0.0))
        && inside(affine.at(columns as f64, rows as f64))
        && [affine.xc, affine.xr, affine.yc, affine.yr].into_iter().all(small)
}
