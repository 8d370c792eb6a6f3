use exurb_city::DraftError;

/// Why a file could not be read or written. `file` is its path, or what a caller called it.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum Error {
    #[error("cannot read `{file}`: {source}")]
    Read { file: String, source: std::io::Error },
    #[error("cannot write `{file}`: {source}; choose another folder or free some space")]
    Write { file: String, source: std::io::Error },
    #[error("`{file}` is no readable GeoPackage: {source}; export it anew")]
    Database { file: String, source: rusqlite::Error },
    #[error("cannot write the GeoPackage `{file}`: {source}")]
    WriteDatabase { file: String, source: rusqlite::Error },
    #[error("`{file}` is no readable GeoJSON: {source}")]
    Json { file: String, source: serde_json::Error },
    #[error("`{file}`, {place}: {what}")]
    Content { file: String, place: String, what: String },
    #[error(
        "`{file}` is in the coordinate system `{crs}`, which exurb cannot convert; reproject it to \
         EPSG:4326 first (in QGIS: Export, Save Features As)"
    )]
    CoordinateSystem { file: String, crs: String },
    #[error("`{file}` holds no streets, buildings, parcels or other areas that exurb knows")]
    Empty { file: String },
    #[error("`{file}`: {source}")]
    Draft { file: String, source: DraftError },
    #[error("the target `{file}` {what}")]
    Target { file: String, what: String },
}
