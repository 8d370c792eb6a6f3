use exurb_city::TerrainError;

/// Why a height map could not be read, placed or written. `file` is its path, or what a caller
/// called it.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum Error {
    #[error("cannot read `{file}`: {source}")]
    Read { file: String, source: std::io::Error },
    #[error(
        "`{file}` is no height map that exurb knows; there are GeoTIFF, SRTM .hgt, ESRI ASCII grid \
         and 16-bit PNG"
    )]
    Format { file: String },
    #[error("`{file}` {what}")]
    Content { file: String, what: String },
    #[error(
        "`{file}` does not say where it lies: give its edges in degrees with --terrain-bounds \
         W,S,E,N, or `target` to lay it over the target, or put a world file beside it"
    )]
    Placeless { file: String },
    #[error(
        "`{file}` does not say how high black and white are: give both in metres with \
         --terrain-range LOW,HIGH"
    )]
    Rangeless { file: String },
    #[error(
        "`{file}` is in {crs}, which exurb cannot convert; name its system with --terrain-crs, or \
         reproject it to EPSG:4326 (gdalwarp -t_srs EPSG:4326)"
    )]
    CoordinateSystem { file: String, crs: String },
    #[error("`{file}` knows no height where the city lies: {what}")]
    Elsewhere { file: String, what: String },
    #[error("`{file}`: {source}")]
    Terrain { file: String, source: TerrainError },
    #[error("the height map cannot be packed: {0}")]
    Pack(String),
}

impl Error {
    /// A file whose contents are wrong.
    pub(crate) fn content(file: &str, what: impl Into<String>) -> Self {
        Self::Content { file: file.to_owned(), what: what.into() }
    }
}
