//! Tiles of heights as bare TIFF: what GeoPackage keeps its rasters in.

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult};
use tiff::encoder::{TiffEncoder, colortype::Gray32Float};

use crate::Error;

/// `side` times `side` heights, row by row from the north, as a TIFF of 32-bit floats.
pub fn encode(heights: &[f32], side: u32) -> Result<Vec<u8>, Error> {
    let mut out = Cursor::new(Vec::new());
    TiffEncoder::new(&mut out)
        .and_then(|mut file| file.write_image::<Gray32Float>(side, side, heights))
        .map_err(|e| Error::Pack(e.to_string()))?;
    Ok(out.into_inner())
}

/// The heights of a tile that [`encode`] wrote; the words for what is wrong with it.
pub fn decode(bytes: &[u8], side: u32) -> Result<Vec<f32>, String> {
    let mut file = Decoder::new(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    if file.dimensions().map_err(|e| e.to_string())? != (side, side) {
        return Err(format!("it is not {side} x {side} heights"));
    }
    match file.read_image().map_err(|e| e.to_string())? {
        DecodingResult::F32(heights) if heights.len() == (side * side) as usize => Ok(heights),
        _ => Err("its heights are no 32-bit floats".to_owned()),
    }
}
