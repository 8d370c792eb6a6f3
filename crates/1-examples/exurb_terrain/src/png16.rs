//! Height maps as PNG: grey, 16 bits (8 are read, too), black low and white high.
//!
//! A plain PNG says neither where it lies nor how high black and white are: options and a world file
//! say it. Those that exurb writes carry both as JSON in a text chunk named `exurb:terrain`, and are
//! read without. The missing value is that of the `tRNS` chunk, or alpha 0.

use std::io::Cursor;

use exurb_geom::Crs;
use serde::{Deserialize, Serialize};

use crate::dem::Affine;
use crate::options::Said;
use crate::{Dem, Error, Options, read::MOST_PIXELS};

/// Keyword of the text chunk.
pub const KEYWORD: &str = "exurb:terrain";

/// What a height map says of itself: the content of the text chunk and of the `.json` beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// Pixels across and down.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Distance of the middles of neighbouring pixels in metres.
    pub cell_m: f64,
    /// Metres from the middle of the first pixel to that of the last, across and down.
    pub size_m: [f64; 2],
    /// Height of the lowest value that is a height, in metres.
    pub lowest_m: f64,
    /// Height of white (65535) in metres.
    pub highest_m: f64,
    /// The lowest value that is a height: 0, or 1 where 0 is missing.
    pub lowest_value: u16,
    /// `height_m = offset_m + metres_per_step * value`.
    pub metres_per_step: f64,
    /// See there.
    pub offset_m: f64,
    /// Everything up to here is under water.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub water_level_m: Option<f64>,
    /// Middle of the first, north-west pixel in the coordinate system, east and north in metres.
    pub first_m: [f64; 2],
    /// The coordinate system as a `proj` text.
    pub crs: String,
    /// Corners in degrees: west, south, east, north of the outer middles.
    pub lonlat_bounds: [f64; 4],
    /// Unreal Engine's landscape scale, in its centimetres: X and Y, and Z for 16-bit heights.
    pub unreal_scale: [f64; 3],
    /// Unity's terrain size: width, height, length in metres.
    pub unity_size: [f64; 3],
}

/// Reads a PNG; `said` is what files beside it say.
pub fn read(bytes: &[u8], file: &str, said: Said, options: &Options) -> Result<Dem, Error> {
    let broken = |error: png::DecodingError| {
        Error::content(file, format!("is no readable PNG: {error}; export it anew"))
    };
    let mut decoder =
        png::Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: MOST_PIXELS * 2 });
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(broken)?;
    let info = reader.info();
    let (columns, rows) = (info.width as usize, info.height as usize);
    if columns.saturating_mul(rows) > MOST_PIXELS {
        return Err(Error::content(file, format!("has {columns} x {rows} pixels: too many")));
    }
    let samples = match info.color_type {
        png::ColorType::Grayscale => 1,
        png::ColorType::GrayscaleAlpha => 2,
        _ => {
            let message = "is a coloured picture, no height map: heights are grey, best 16 bits";
            return Err(Error::content(file, message));
        }
    };
    let wide = match info.bit_depth {
        png::BitDepth::Eight => false,
        png::BitDepth::Sixteen => true,
        depth => {
            return Err(Error::content(file, format!("has {depth:?} bits a pixel; 16 are needed")));
        }
    };
    let missing = info.trns.as_deref().and_then(|t| t.try_into().ok()).map(u16::from_be_bytes);
    let size = reader.output_buffer_size().ok_or_else(|| Error::content(file, "is too large"))?;
    let mut pixels = vec![0; size];
    reader.next_frame(&mut pixels).map_err(broken)?;
    let _ = reader.finish();
    let text = |keyword: &str| {
        let chunk = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == keyword)?;
        chunk.get_text().ok()
    };
    let attribution = text("Copyright");
    let own: Option<Description> = text(KEYWORD).and_then(|text| serde_json::from_str(&text).ok());

    let range = options.range_m.or(own.as_ref().map(range_of_zero));
    let [low, high] = range.ok_or_else(|| Error::Rangeless { file: file.to_owned() })?;
    let values = if wide { values::<2>(&pixels) } else { values::<1>(&pixels) };
    let white = if wide { 65_535.0 } else { 255.0 };
    let height = |pixel: &[u16]| match pixel {
        [value, ..] if Some(*value) == missing => f32::NAN,
        [_, 0] => f32::NAN,
        [value, ..] => (low + (high - low) * f64::from(*value) / white) as f32,
        [] => f32::NAN,
    };
    let heights: Vec<f32> = values.chunks_exact(samples).map(height).collect();
    let said = own.map_or(said, |own| Said {
        affine: Some(Affine::north_up(own.first_m[0], own.first_m[1], own.cell_m, own.cell_m)),
        crs: Some(Crs::from_name(&own.crs).ok_or(own.crs)),
    });
    let place = options.place(file, said, columns, rows)?;
    Ok(Dem { file: file.to_owned(), columns, heights, place, attribution })
}

/// Numbers of one or two bytes.
fn values<const N: usize>(bytes: &[u8]) -> Vec<u16> {
    let number = |b: &[u8]| b.iter().fold(0, |n, byte| n << 8 | u16::from(*byte));
    bytes.chunks_exact(N).map(number).collect()
}

/// Heights of the values 0 and 65535.
fn range_of_zero(own: &Description) -> [f64; 2] {
    [own.offset_m, own.offset_m + own.metres_per_step * 65_535.0]
}
