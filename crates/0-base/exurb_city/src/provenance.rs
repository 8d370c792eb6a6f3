//! Where an element came from.

use std::sync::Arc;

/// How an element came to be. The names are the values of the `origin` column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Origin {
    /// Read from a file.
    #[default]
    Imported,
    /// Copied from an example.
    Example,
    /// Made from statistics.
    Procedural,
    /// Made to join what stood apart.
    Joined,
    /// A bridge over water.
    Bridge,
    /// Given by the user.
    Sketch,
    /// Changed after it was made.
    Edited,
}

impl Origin {
    /// All, in the order of the contract.
    pub const ALL: [Self; 7] = [
        Self::Imported,
        Self::Example,
        Self::Procedural,
        Self::Joined,
        Self::Bridge,
        Self::Sketch,
        Self::Edited,
    ];

    /// The name in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Imported => "imported",
            Self::Example => "example",
            Self::Procedural => "procedural",
            Self::Joined => "joined",
            Self::Bridge => "bridge",
            Self::Sketch => "sketch",
            Self::Edited => "edited",
        }
    }

    /// The origin of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|o| o.as_str() == name)
    }
}

/// Origin of an element, and the example and part it was copied from.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Provenance {
    /// How it came to be.
    pub origin: Origin,
    /// Name of the example.
    pub source: Option<Arc<str>>,
    /// Patch, fragment or block of the example.
    pub part: Option<Arc<str>>,
}

impl Provenance {
    /// Of the given origin, from nowhere in particular.
    pub fn of(origin: Origin) -> Self {
        Self { origin, ..Self::default() }
    }
}
