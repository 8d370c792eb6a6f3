//! Plane geometry in metres on a millimetre grid.
//!
//! Stored coordinates are integers: [`GridPoint`] counts millimetres in a city's local frame, so that
//! touching, equality, noding and export are exact. Algorithms compute with [`Vec2`] in metres and
//! round once. Libraries for polygons (`geo`), triangulations (`spade`) and projections (`proj4rs`)
//! are wrapped here; no other crate names them.
//!
//! | part | what it holds |
//! |---|---|
//! | [`grid`] | the 1 mm grid and its exact predicates |
//! | [`polyline`] | lengths, positions, curvature and distances of lines |
//! | [`polygon`] | polygons with holes |
//! | [`cells`] | a square grid, and which cells a polygon covers |
//! | [`contour`] | areas of a grid of values below a threshold |
//! | [`oriented_box`] | smallest enclosing rectangle |
//! | [`rigid`] | motions that keep lengths |
//! | [`split`] | cutting a polygon along a line |
//! | [`voronoi`] | borders between groups of points |
//! | [`overlay`] | intersection, difference, union |
//! | [`overlap`] | areas that polygons share |
//! | [`offset`] | insets of polygons and carriageways of lines |
//! | [`box_grid`] | boxes that meet a box, for a set that does not change |
//! | [`segment_grid`] | segments near a segment, for linework that does not change |
//! | [`straight_skeleton`] | what sides sweep while they move inwards: hipped roofs |
//! | [`mean_value`] | a map of a polygon's inside that follows its outline |
//! | [`roadside`] | what streets take of the ground beside them |
//! | [`segment_index`] | segments near a box, while they come and go |
//! | [`spikes`] | polygons without spikes and cracks of no width |
//! | [`point_index`] | points near a point, while they come and go |
//! | [`crs`] | coordinate systems of other files to longitude and latitude |
//! | [`projection`] | longitude and latitude to local metres and back |
//! | [`trig`] | trigonometry that is the same on every machine |
//!
//! ```
//! use exurb_geom::{GridPoint, Polygon};
//! let square = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(10.0, 20.0));
//! assert_eq!(square.area_m2(), 200.0);
//! ```

mod bounds;
pub mod box_grid;
mod cell_table;
pub mod cells;
pub mod contour;
mod convert;
pub mod crs;
pub mod enclosing_circle;
pub mod grid;
mod lattice;
pub mod mean_value;
pub mod offset;
pub mod oriented_box;
pub mod overlap;
pub mod overlay;
mod plain;
pub mod point_grid;
mod point_index;
pub mod polygon;
pub mod polyline;
pub mod projection;
pub mod rigid;
pub mod roadside;
pub mod row_polygon;
pub mod segment_grid;
pub mod segment_index;
pub mod spikes;
pub mod split;
pub mod straight_skeleton;
pub mod trig;
pub mod voronoi;

pub use bounds::Bounds;
pub use box_grid::BoxGrid;
pub use cells::{Cell, Cells};
pub use crs::Crs;
pub use enclosing_circle::Circle;
pub use glam::DVec2 as Vec2;
pub use grid::GridPoint;
pub use mean_value::MeanValueMap;
pub use oriented_box::OrientedBox;
pub use point_grid::PointGrid;
pub use point_index::PointIndex;
pub use polygon::Polygon;
pub use projection::{Frame, LonLat};
pub use rigid::Rigid;
pub use roadside::Roadside;
pub use row_polygon::{RowPolygon, RowSides};
pub use segment_grid::SegmentGrid;
pub use segment_index::SegmentIndex;
