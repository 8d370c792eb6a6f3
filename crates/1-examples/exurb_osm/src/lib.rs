//! OpenStreetMap files both ways.
//!
//! [`mod@read`] makes a city of OSM XML, PBF or Overpass JSON; [`write_xml()`] and [`write_pbf()`] write one.
//! All formats go through one list of elements; what follows is the same for all.
//!
//! | part | what it does |
//! |---|---|
//! | `read` | formats, unpacking, archive bombs |
//! | `read_pbf`, `read_xml`, `read_overpass` | the formats |
//! | `import` | the passes in order: what matters, where it lies, what it is |
//! | `streets`, `buildings`, `areas`, `features` | the meaning of tags |
//! | `surfaces`, `coast` | everything that is no street; the sea |
//! | `outline` | rings and polygons of ways and relations |
//! | `document`, `shared_walls` | a city as nodes, ways and relations, for `write_xml` and `write_pbf` |
//! | [`fuzz`] | bodies of the fuzz targets |

mod areas;
mod buildings;
mod coast;
mod document;
mod elements;
mod error;
mod features;
pub mod fuzz;
mod import;
mod narrow;
mod outline;
mod pbf_format;
mod places;
mod read;
mod read_overpass;
mod read_pbf;
mod read_xml;
mod shared_walls;
mod streets;
mod surfaces;
mod tags;
mod write_pbf;
mod write_xml;

/// How files written here begin to say who wrote them.
const GENERATOR: &str = "exurb";

pub use error::Error;
pub use import::ATTRIBUTION;
pub use read::{Format, read, read_bytes, read_draft};
pub use write_pbf::write_pbf;
pub use write_xml::write_xml;
