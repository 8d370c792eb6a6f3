use exurb_city::DraftError;

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file system says no.
    #[error("cannot read {file}: {source}")]
    Io {
        /// The file.
        file: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Neither ending nor content is one of ours.
    #[error(
        "{file} is no OpenStreetMap file: expected XML, PBF or Overpass JSON, plain or packed by gzip or bzip2"
    )]
    Format {
        /// The file.
        file: String,
    },
    /// There is nothing in it.
    #[error("{file} is empty")]
    Empty {
        /// The file.
        file: String,
    },
    /// It breaks its format.
    #[error("{file} is truncated or corrupt: {what}")]
    Corrupt {
        /// The file.
        file: String,
        /// What is wrong, and where.
        what: String,
    },
    /// It asks for what this reader does not do.
    #[error("{file} {what}")]
    Unsupported {
        /// The file.
        file: String,
        /// What it needs, and what to do.
        what: String,
    },
    /// The server that should have made it did not.
    #[error("{file} is empty; {what}")]
    Unmade {
        /// The file.
        file: String,
        /// What the server says.
        what: String,
    },
    /// It unpacks to far more than a map would.
    #[error(
        "{file} unpacks to over 64 MB at more than 200 to 1, as an archive bomb does; unpack it first if it is a map"
    )]
    Bomb {
        /// The file.
        file: String,
    },
    /// The place cannot be mapped.
    #[error("{file}: {source}")]
    Frame {
        /// The file.
        file: String,
        /// Why.
        source: exurb_geom::projection::FrameError,
    },
    /// Nothing is left to be a city.
    #[error("{file}: {source}")]
    Draft {
        /// The file.
        file: String,
        /// Why.
        source: DraftError,
    },
}

impl Error {
    pub(crate) fn corrupt(file: &str, what: impl ToString) -> Self {
        Self::Corrupt { file: file.to_owned(), what: what.to_string() }
    }

    /// What a decoder or the file system reports while reading.
    pub(crate) fn reading(file: &str, source: std::io::Error) -> Self {
        match source.kind() {
            std::io::ErrorKind::InvalidData
            | std::io::ErrorKind::InvalidInput
            | std::io::ErrorKind::UnexpectedEof => Self::corrupt(file, source),
            std::io::ErrorKind::FileTooLarge => Self::Bomb { file: file.to_owned() },
            _ => Self::Io { file: file.to_owned(), source },
        }
    }
}
