//! What a model shows.

/// What goes into a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Roofs by shape; else all are flat. Default true.
    pub roofs: bool,
    /// Walls with windows; else plain. Default true.
    pub facades: bool,
    /// Trees. Default true.
    pub trees: bool,
    /// Lamps and other small things. Default true.
    pub furniture: bool,
    /// Centre lines on main streets. Default true.
    pub markings: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { roofs: true, facades: true, trees: true, furniture: true, markings: true }
    }
}
