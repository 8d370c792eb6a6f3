use exurb_operation::Failure;

/// Why a recipe gives no city.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The recipe itself is wrong.
    #[error("{0}")]
    Recipe(String),
    /// A file cannot be read.
    #[error("{0}")]
    Input(String),
    /// The target cannot be built on.
    #[error("{0}")]
    Target(String),
    /// An operation did not do its work.
    #[error("{0}")]
    Operation(#[from] Failure),
}

impl Error {
    /// Was the program used wrongly, or is an input unreadable? Otherwise the work itself failed.
    pub fn is_usage(&self) -> bool {
        match self {
            Self::Recipe(_) | Self::Input(_) | Self::Target(_) => true,
            Self::Operation(failure) => matches!(failure, Failure::Params { .. }),
        }
    }

    /// Did the user stop the work?
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Operation(Failure::Cancelled))
    }
}
