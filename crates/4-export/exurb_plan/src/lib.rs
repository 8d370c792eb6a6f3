//! The map from above, as SVG and PNG.
//!
//! A city becomes one display list: groups of marks in pixels, in the order in which they are laid
//! on the paper. Both writers consume that list, so what is drawn is said once. Nothing depends on
//! system fonts: the few words on a map are drawn with strokes.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Options`], [`Layer`] | what is shown, how large |
//! | [`Style`] | colours and widths |
//! | [`ColorBy`] | what colours tell instead |
//! | `ground`, `relief`, `buildings`, `streets`, `features`, `caption` | city → marks, a file per theme |
//! | `svg`, `raster` | marks → file |
//!
//! ```
//! use exurb_city::City;
//! use exurb_geom::{Frame, GridPoint, Polygon};
//! let target = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(300.0, 200.0));
//! let city = City::empty(Frame::null_island(), target);
//! let svg = exurb_plan::to_svg(&city, &exurb_plan::Options::default());
//! assert!(svg.starts_with("<?xml"));
//! ```

mod buildings;
mod caption;
mod color;
mod color_by;
mod display;
mod features;
pub mod font;
mod ground;
mod map;
mod options;
mod raster;
mod relief;
mod sheet;
mod streets;
mod style;
mod svg;
mod view;

pub use color_by::ColorBy;
pub use options::{Error, Layer, Options};
pub use raster::to_png;
pub use style::Style;
pub use svg::to_svg;

#[cfg(test)]
mod tests;
