//! Why streets could not be grown.

/// Errors of growth; folded into [`exurb_operation::Failure`] at the room's border.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The example has no streets to learn from.
    #[error(
        "`{0}` has no streets to learn from (classes motorway and trunk are never grown); \
         choose a map with streets, or a larger part of it"
    )]
    NoStreets(String),
    /// No junction, so no patch.
    #[error("`{0}` has no junction of three streets, so no patch; choose a larger part of the map")]
    NoPatch(String),
    /// A parameter cannot be used with this example or target.
    #[error("{0}")]
    Params(String),
    /// A start lies outside the target.
    #[error("the start {0} lies outside the target; choose a place inside it")]
    StartOutside(String),
    /// A start lies where no street can.
    #[error("the start {0} lies in water or on ground too steep (see `slope`); move it to land")]
    StartInWater(String),
    /// The target has no ground for streets.
    #[error(
        "the whole target lies in water or on ground too steep (see `slope`); choose another target"
    )]
    NoLand,
    /// Nothing tells which example of a library fits.
    #[error(
        "nothing tells which example of the library fits: choose by ground (--terrain, and examples \
         with terrain), by the `density` of areas (--areas), or by a drawn fragment (--like)"
    )]
    Library,
    /// The drawn fragment cannot be looked for.
    #[error("`like` {0}")]
    Like(String),
    /// No example has a junction.
    #[error("`like` finds no junction in any example; choose other examples")]
    NotLike,
    /// Nothing grew.
    #[error(
        "no street grew from {starts} start(s) in a target of {area_km2:.3} km²; enlarge the target or move the start"
    )]
    Nothing {
        /// Starts tried.
        starts: usize,
        /// Size of the target.
        area_km2: f64,
    },
    /// The user asked to stop.
    #[error("cancelled")]
    Cancelled,
}
