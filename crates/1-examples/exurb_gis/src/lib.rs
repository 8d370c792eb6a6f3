//! GeoPackage and GeoJSON both ways.
//!
//! A city is written as one file of either format and read back as the very same city. Any other
//! file is read by what its rows are; the streets of several layers or files become one graph, noded
//! where they cross.
//!
//! | geometry | becomes | when |
//! |---|---|---|
//! | line | street | `highway`, `class`, `fclass`, `type` or BD TOPO's `NATURE` name a street, or nothing is named: then a residential one. No waterways, railways, paths |
//! | polygon | building | `building` or `building:part`; a layer or file of buildings; a height or levels |
//! | | parcel | a layer or file of parcels, plots or lots; elsewhere a zoning column |
//! | | water | `natural=water`, `water`, `waterway`; a layer or file of water |
//! | | land use | `landuse`, `leisure`, `natural`; a layer or file of land use or zones |
//! | point | feature | `natural=tree`, `highway=street_lamp`, `leisure`, `amenity`, `kind`; a layer or file of trees or lamps |
//!
//! Read where present: lanes (`lanes`, `NB_VOIES`), width (`width`, `LARGEUR`), `oneway`, `SENS`,
//! `bridge`, `tunnel`, `layer`, `junction`, name; height (`height`, `HAUTEUR`, ...), levels
//! (`building:levels`, `levels`, `NB_ETAGES`, ...), `min_height`, `roof:shape`, use; zoning. Of lists,
//! as OSMnx writes them, the first item counts; GDAL's `other_tags` is read as its columns. Where a
//! file has a column `highway`, a line that leaves it empty is no street. Such files do not say where they
//! are complete: that is taken to be the rectangle around everything, and ends of streets that stand in
//! straight rows along a rectangle, whichever way it is turned, were cut there and are no dead ends.
//!
//! A file's coordinate system may be any with an EPSG code or a common projection. A plane system
//! in metres beyond that keeps shape and scale and loses its place, with a warning; others are
//! errors that say how to reproject.
//!
//! | part | what it holds |
//! |---|---|
//! | [`geopackage`] | [`write_geopackage`], [`read_geopackage`] |
//! | [`geojson`] | [`write_geojson`], [`read_geojson`], [`read_geojson_many`] |
//! | [`target`] | [`read_target`] |
//! | [`theme`] | layers of figures on a city: [`write_themes`] |
//! | [`fuzz`] | what fuzzing calls |
//!
//! ```
//! use exurb_city::City;
//! use exurb_geom::{Frame, GridPoint, Polygon};
//!
//! let target = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(500.0, 500.0));
//! let city = City::empty(Frame::null_island(), target);
//! let mut text = Vec::new();
//! exurb_gis::write_geojson(&city, &mut text)?;
//! assert!(text.starts_with(b"{\"type\":\"FeatureCollection\""));
//! # Ok::<(), std::io::Error>(())
//! ```

mod assembly;
mod beside;
mod border;
mod error;
pub mod fuzz;
mod gathering;
pub mod geojson;
mod geometry;
pub mod geopackage;
mod layers;
mod metadata;
mod numbered;
mod recognise;
#[cfg(test)]
mod sample;
pub mod target;
pub mod theme;
mod value;
mod wkb;

pub use error::Error;
pub use geojson::{
    read_geojson, read_geojson_many, write_geojson, write_geojson_file, write_geojson_streets,
};
pub use geopackage::{
    forget_journals, read_geopackage, write_geopackage, write_geopackage_streets, write_themes,
};
pub use layers::Streets;
pub use target::{TargetArea, read_target};
pub use theme::{Theme, ThemeRow};
