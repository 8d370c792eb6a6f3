/// Why there is no model or picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Size out of range.
    #[error(
        "a picture of {width_px} x {height_px} pixels cannot be drawn; choose 16 to 8,192 each"
    )]
    Size {
        /// Width asked for.
        width_px: u32,
        /// Height asked for.
        height_px: u32,
    },
    /// A model beyond what one GLB file can hold.
    #[error("the model takes {0} bytes and a GLB file holds 4 GiB; cut the city into parts")]
    TooLarge(u64),
    /// The picture could not be packed.
    #[error("the picture could not be written as PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// The model's description could not be written.
    #[error("the model could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The file could not be written.
    #[error("cannot write {path}: {source}; check the folder and its free space")]
    Write {
        /// The file.
        path: String,
        /// What went wrong.
        source: std::io::Error,
    },
}
