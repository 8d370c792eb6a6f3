use std::path::Path;

use crate::options::Said;
use crate::{Dem, Error, Options, ascii, beside, geotiff, hgt, png16};

/// Larger rasters are to be cut first.
pub const MOST_PIXELS: usize = 1 << 27;

/// A format, told by its first bytes and its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Tiff,
    Png,
    Ascii,
    Hgt,
}

/// Reads a height map: GeoTIFF, SRTM tile, ESRI ASCII grid or grey PNG, told by content. A world
/// file or `.prj` beside it counts where it says nothing itself.
pub fn read(path: &Path, options: &Options) -> Result<Dem, Error> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| Error::Read { file: file.clone(), source })?;
    read_bytes(&bytes, &file, beside::said(path), options)
}

/// Reads the bytes of a height map; `file` is its name, whose ending and tile count.
pub(crate) fn read_bytes(
    bytes: &[u8],
    file: &str,
    said: Said,
    options: &Options,
) -> Result<Dem, Error> {
    let dem = match format(bytes, file) {
        Some(Format::Tiff) => geotiff::read(bytes, file, said, options),
        Some(Format::Png) => png16::read(bytes, file, said, options),
        Some(Format::Ascii) => ascii::read(bytes, file, said, options),
        Some(Format::Hgt) => hgt::read(bytes, file, options),
        None => Err(Error::Format { file: file.to_owned() }),
    }?;
    match dem.heights.iter().any(|h| h.is_finite()) {
        true => Ok(dem),
        false => Err(Error::content(file, "knows no height at all")),
    }
}

fn format(bytes: &[u8], file: &str) -> Option<Format> {
    let tiff: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    if tiff.iter().any(|magic| bytes.starts_with(magic)) {
        return Some(Format::Tiff);
    }
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Some(Format::Png);
    }
    if file.to_ascii_lowercase().ends_with(".hgt") {
        return Some(Format::Hgt);
    }
    ascii::is_ascii_grid(bytes).then_some(Format::Ascii)
}
