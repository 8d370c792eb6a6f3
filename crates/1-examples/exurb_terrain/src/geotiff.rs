//! GeoTIFF → heights: tiled or in strips, with predictors, deflated, LZW or plain; integers and
//! floats of 8 to 64 bits; the first band counts.
//!
//! The missing value is GDAL's (`GDAL_NODATA`); so are scale and offset of heights. Heights in feet
//! become metres where the file says so.

use std::io::Cursor;

use quick_xml::events::Event;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use crate::dem::Affine;
use crate::geokeys::{GeoKeys, RASTER_TYPE};
use crate::options::Said;
use crate::{Dem, Error, Options, lzw, read::MOST_PIXELS};

const COPYRIGHT: Tag = Tag::Unknown(33_432);
const GDAL_METADATA: Tag = Tag::Unknown(42_112);
/// `GTRasterTypeGeoKey`: coordinates are those of points, the middles of pixels.
const PIXEL_IS_POINT: u16 = 2;

const IN_PLANES: u16 = 2;

pub type File<'a> = Decoder<Cursor<&'a [u8]>>;

/// Reads a GeoTIFF; `said` is what files beside it say, where it says nothing itself.
pub fn read(bytes: &[u8], file: &str, said: Said, options: &Options) -> Result<Dem, Error> {
    let broken = |error: TiffError| Error::content(file, format!("is no readable TIFF: {error}"));
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_PIXELS * 8;
    let mut tiff = Decoder::new(Cursor::new(bytes)).map_err(broken)?.with_limits(limits);
    let (columns, rows) = tiff.dimensions().map_err(broken)?;
    let (columns, rows) = (columns as usize, rows as usize);
    if columns.saturating_mul(rows) > MOST_PIXELS {
        let message = format!(
            "has {columns} x {rows} pixels, more than fit; cut the city's part out first (gdalwarp \
             -te)"
        );
        return Err(Error::content(file, message));
    }
    let samples = match tiff.colortype().map_err(broken)? {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::Multiband { num_samples, .. } => usize::from(num_samples),
        other => {
            let message = format!("is a picture ({other:?}), no height map: it has no heights");
            return Err(Error::content(file, message));
        }
    };
    // Where bands lie one after the other, the first alone is read.
    let in_planes = lzw::short(&mut tiff, Tag::PlanarConfiguration) == Some(IN_PLANES);
    let samples = if in_planes { 1 } else { samples };
    let keys = geo_keys(&mut tiff);
    let (scale, offset) = scale(&mut tiff);
    let missing = ascii(&mut tiff, Tag::GdalNodata).and_then(|text| text.trim().parse().ok());
    let said =
        Said { affine: affine(&mut tiff, &keys).or(said.affine), crs: keys.crs().or(said.crs) };
    let unit_m = keys.height_unit_m();
    let height = |value: f64, missing: Option<f64>| match missing == Some(value) {
        true => f32::NAN,
        false => ((value * scale + offset) * unit_m) as f32,
    };
    let heights = if lzw::is_packed(&mut tiff) {
        lzw::read(&mut tiff, bytes, samples, |value, is_single| {
            height(value, as_kept(missing, is_single))
        })
        .map_err(|what| Error::content(file, format!("is no readable TIFF: {what}")))?
    } else {
        let values = tiff.read_image().map_err(broken)?;
        let missing = as_kept(missing, matches!(values, DecodingResult::F32(_)));
        heights(&values, samples, |value| height(value, missing))
    };
    if heights.len() != columns * rows {
        let message = format!("holds {} of {columns} x {rows} heights", heights.len());
        return Err(Error::content(file, message));
    }
    let place = options.place(file, said, columns, rows)?;
    let attribution = ascii(&mut tiff, COPYRIGHT).filter(|text| !text.trim().is_empty());
    Ok(Dem { file: file.to_owned(), columns, heights, place, attribution })
}

/// The missing value is written as a double; among singles it is one.
fn as_kept(missing: Option<f64>, is_single: bool) -> Option<f64> {
    missing.map(|m| if is_single { f64::from(m as f32) } else { m })
}

/// The first of every `samples` values.
fn heights(values: &DecodingResult, samples: usize, height: impl Fn(f64) -> f32) -> Vec<f32> {
    macro_rules! first_band {
        ($values:expr, $to_f64:expr) => {
            $values.iter().step_by(samples).map(|v| height($to_f64(*v))).collect()
        };
    }
    match values {
        DecodingResult::U8(v) => first_band!(v, f64::from),
        DecodingResult::I8(v) => first_band!(v, f64::from),
        DecodingResult::U16(v) => first_band!(v, f64::from),
        DecodingResult::I16(v) => first_band!(v, f64::from),
        DecodingResult::U32(v) => first_band!(v, f64::from),
        DecodingResult::I32(v) => first_band!(v, f64::from),
        DecodingResult::U64(v) => first_band!(v, |v| v as f64),
        DecodingResult::I64(v) => first_band!(v, |v| v as f64),
        DecodingResult::F16(v) => first_band!(v, |v: half::f16| v.to_f64()),
        DecodingResult::F32(v) => first_band!(v, f64::from),
        DecodingResult::F64(v) => first_band!(v, |v| v),
    }
}

fn geo_keys(tiff: &mut File) -> GeoKeys {
    let directory = tiff.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    let doubles = tiff.get_tag_f64_vec(Tag::GeoDoubleParamsTag).unwrap_or_default();
    let text = ascii(tiff, Tag::GeoAsciiParamsTag).unwrap_or_default();
    GeoKeys::parse(&directory, &doubles, &text)
}

fn ascii(tiff: &mut File, tag: Tag) -> Option<String> {
    tiff.get_tag_ascii_string(tag).ok()
}

/// Scale and tie point, or the whole matrix.
fn affine(tiff: &mut File, keys: &GeoKeys) -> Option<Affine> {
    let doubles = |tiff: &mut File, tag| tiff.get_tag_f64_vec(tag).unwrap_or_default();
    let scale = doubles(tiff, Tag::ModelPixelScaleTag);
    let tie = doubles(tiff, Tag::ModelTiepointTag);
    let matrix = doubles(tiff, Tag::ModelTransformationTag);
    let affine = match (&scale[..], &tie[..], &matrix[..]) {
        (_, _, [xc, xr, _, x0, yc, yr, _, y0, ..]) => {
            Affine { x0: *x0, xc: *xc, xr: *xr, y0: *y0, yc: *yc, yr: *yr }
        }
        ([width, height, ..], [column, row, _, x, y, ..], _) => {
            let (x, y) = (x - column * width, y + row * height);
            Affine::north_up(x, y, *width, *height)
        }
        _ => return None,
    };
    affine.inverse(0.0, 0.0)?;
    let is_point = keys.short(RASTER_TYPE) == Some(PIXEL_IS_POINT);
    Some(if is_point { affine } else { affine.from_corner() })
}

/// Scale and offset of the first band by GDAL's metadata; 1 and 0 where there are none.
fn scale(tiff: &mut File) -> (f64, f64) {
    let (mut scale, mut offset) = (1.0, 0.0);
    let Some(text) = ascii(tiff, GDAL_METADATA) else { return (scale, offset) };
    let mut reader = quick_xml::Reader::from_str(&text);
    let mut role = None;
    loop {
        match reader.read_event() {
            Ok(Event::Start(item)) => {
                let attribute = |name: &str| {
                    let found = item.try_get_attribute(name).ok().flatten()?;
                    Some(found.value.into_owned())
                };
                let first = attribute("sample").is_none_or(|sample| sample == "0");
                role = attribute("role").filter(|_| first);
            }
            Ok(Event::Text(text)) => {
                let number = text.trim().parse().ok();
                match (role.as_deref(), number) {
                    (Some("scale"), Some(number)) => scale = number,
                    (Some("offset"), Some(number)) => offset = number,
                    _ => {}
                }
            }
            Ok(Event::End(_)) => role = None,
            Ok(Event::Eof) | Err(_) => return (scale, offset),
            Ok(_) => {}
        }
    }
}
