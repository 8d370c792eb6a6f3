//! Layers of figures on a city, for looking at in a geographic information system.

use exurb_city::FeatureShape;

pub use crate::layers::GeometryType;

/// A layer of shapes with figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// Its name: letters and underscores.
    pub name: &'static str,
    /// Type of its shapes.
    pub geometry: GeometryType,
    /// Names of its figures: letters and underscores.
    pub columns: Vec<&'static str>,
    /// Its shapes.
    pub rows: Vec<ThemeRow>,
}

/// One shape and its figures, in the order of the columns; `None` where there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct ThemeRow {
    /// The shape.
    pub shape: FeatureShape,
    /// Its figures.
    pub values: Vec<Option<f64>>,
}
