//! How alike two outlines are, and which of many is most like a given one.
//!
//! Outlines of blocks, later of street fragments and footprints, are compared by shape context and
//! cyclic dynamic time warping (Belongie, Malik and Puzicha 2000; Sakoe and Chiba 1978; Hartmann 2018,
//! sections 4.1.3 and 5.1.3): the cost tells how alike they are, the warping path which point of one
//! belongs to which of the other, and a rigid motion fitted to the path lays one on the other.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Outline`] | evenly spaced samples of a closed line |
//! | [`shape_context`] | histograms of where the other samples lie, and their chi-square cost |
//! | [`time_warp`] | the cheapest monotone path around both outlines |
//! | [`mod@align`] | the rigid motion of one outline onto another |
//! | [`Attributes`], [`Weights`] | further terms of the cost: relief, land use, density, height |
//! | [`Database`] | many outlines, an index over them, and queries |
//!
//! ```
//! use exurb_geom::GridPoint;
//! use exurb_match::{Attributes, Database, Entry, Outline, Query};
//!
//! let square = |side: f64| {
//!     let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
//!     Outline::of(&corners.map(|(x, y)| GridPoint::m(x, y)))
//! };
//! let entry = |side| Entry { outline: square(side), attributes: Attributes::default() };
//! let database = Database::new(vec![entry(60.0), entry(100.0), entry(150.0)]);
//! let (asked, attributes) = (square(98.0), Attributes::default());
//! let found = database.query(&Query::new(&asked, &attributes), |_| true);
//! assert_eq!(found[0].entry, 1);
//! ```

pub mod align;
mod attributes;
mod database;
mod outline;
pub mod shape_context;
pub mod time_warp;

pub use attributes::{Attributes, Weights};
pub use database::{Database, Entry, Match, Query};
pub use outline::{Outline, SAMPLES};
pub use shape_context::{Contexts, outer_radius_m};
pub use time_warp::Warp;
