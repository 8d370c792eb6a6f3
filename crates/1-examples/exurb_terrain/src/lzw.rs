//! Tiles and strips packed with LZW, which most height maps of surveys are.
//!
//! The TIFF library (0.11) gives such files up at the end of a tile's row, so they are unpacked here:
//! LZW by `weezl`, then the predictor, then the first band's values.

use tiff::decoder::ChunkType;
use tiff::tags::{ByteOrder, Tag};
use weezl::BitOrder;
use weezl::decode::Configuration;

use crate::geotiff::File;

const LZW: u16 = 5;

/// Is it packed with LZW?
pub fn is_packed(tiff: &mut File) -> bool {
    short(tiff, Tag::Compression) == Some(LZW)
}

/// How samples are stored.
struct Layout {
    columns: usize,
    rows: usize,
    /// Columns and rows of a tile or strip.
    chunk: (usize, usize),
    /// Bytes of a sample.
    bytes: usize,
    /// 1 without sign, 2 with, 3 floating.
    format: u16,
    /// Samples of a pixel that stand together.
    samples: usize,
    predictor: u16,
    big_endian: bool,
}

/// The values of the first band through `height`, which is also told whether they are singles.
pub fn read(
    tiff: &mut File,
    file: &[u8],
    samples: usize,
    height: impl Fn(f64, bool) -> f32,
) -> Result<Vec<f32>, String> {
    let layout = Layout::of(tiff, samples)?;
    let tiled = tiff.get_chunk_type() == ChunkType::Tile;
    let (offsets, counts) = if tiled {
        (Tag::TileOffsets, Tag::TileByteCounts)
    } else {
        (Tag::StripOffsets, Tag::StripByteCounts)
    };
    let list = |tiff: &mut File, tag| tiff.get_tag_u64_vec(tag).map_err(|e| e.to_string());
    let (offsets, counts) = (list(tiff, offsets)?, list(tiff, counts)?);
    let across = layout.columns.div_ceil(layout.chunk.0);
    let down = layout.rows.div_ceil(layout.chunk.1);
    let mut heights = vec![f32::NAN; layout.columns * layout.rows];
    for number in 0..across * down {
        let (Some(at), Some(count)) = (offsets.get(number), counts.get(number)) else {
            return Err(format!("{} of its {} tiles are there", offsets.len(), across * down));
        };
        // GDAL leaves out what holds nothing but missing values.
        if *count == 0 {
            continue;
        }
        let end = at.saturating_add(*count).min(file.len() as u64) as usize;
        let packed = file.get(*at as usize..end).ok_or("it is cut short")?;
        let place = (number % across * layout.chunk.0, number / across * layout.chunk.1);
        layout.unpack(packed, place, &mut heights, &height)?;
    }
    Ok(heights)
}

impl Layout {
    fn of(tiff: &mut File, samples: usize) -> Result<Self, String> {
        let (columns, rows) = tiff.dimensions().map_err(|e| e.to_string())?;
        let (width, height) = tiff.chunk_dimensions();
        let bits = short(tiff, Tag::BitsPerSample).unwrap_or(1);
        if ![8, 16, 32, 64].contains(&bits) {
            return Err(format!("{bits} bits a sample are none of 8, 16, 32, 64"));
        }
        Ok(Self {
            columns: columns as usize,
            rows: rows as usize,
            chunk: ((width as usize).max(1), (height as usize).max(1)),
            bytes: usize::from(bits / 8),
            format: short(tiff, Tag::SampleFormat).unwrap_or(1),
            samples,
            predictor: short(tiff, Tag::Predictor).unwrap_or(1),
            big_endian: tiff.byte_order() == ByteOrder::BigEndian,
        })
    }

    /// Unpacks a tile or strip and puts its values at `place` (column, row) of the heights.
    fn unpack(
        &self,
        packed: &[u8],
        (left, top): (usize, usize),
        heights: &mut [f32],
        height: &impl Fn(f64, bool) -> f32,
    ) -> Result<(), String> {
        let row_bytes = self.chunk.0 * self.samples * self.bytes;
        // The last strip may be shorter; tiles are always whole.
        let rows = self.chunk.1.min(self.rows - top);
        let mut unpacked = Vec::new();
        let mut decoder = Configuration::with_tiff_size_switch(BitOrder::Msb, 8).build();
        // An end code that is missing harms nothing when all bytes are there.
        let outcome = decoder.into_vec(&mut unpacked).decode_all(packed);
        if unpacked.len() < rows * row_bytes {
            return Err(match outcome.status {
                Err(error) => error.to_string(),
                Ok(_) => "a tile is cut short".to_owned(),
            });
        }
        for (y, row) in unpacked.chunks_exact_mut(row_bytes).take(rows).enumerate() {
            let big_endian = self.undo_predictor(row);
            let width = self.chunk.0.min(self.columns - left);
            let start = (top + y) * self.columns + left;
            let values = row.chunks_exact(self.bytes).step_by(self.samples);
            for (to, value) in heights[start..start + width].iter_mut().zip(values) {
                *to = height(self.value(value, big_endian), self.format == 3 && self.bytes == 4);
            }
        }
        Ok(())
    }

    /// Makes values of differences; tells whether they are big-endian now.
    fn undo_predictor(&self, row: &mut [u8]) -> bool {
        let pixel = self.samples * self.bytes;
        match self.predictor {
            2 => {
                for at in (pixel..row.len()).step_by(self.bytes) {
                    let (before, here) = row.split_at_mut(at);
                    let before = &before[at - pixel..at - pixel + self.bytes];
                    add(&mut here[..self.bytes], before, self.big_endian);
                }
                self.big_endian
            }
            3 => {
                for at in self.samples..row.len() {
                    row[at] = row[at].wrapping_add(row[at - self.samples]);
                }
                // First the highest bytes of all values, then the next.
                let count = row.len() / self.bytes;
                let planes = row.to_vec();
                for (i, byte) in row.iter_mut().enumerate() {
                    *byte = planes[i % self.bytes * count + i / self.bytes];
                }
                true
            }
            _ => self.big_endian,
        }
    }

    fn value(&self, bytes: &[u8], big_endian: bool) -> f64 {
        let bits = number(bytes, big_endian);
        let unused = 64 - 8 * self.bytes as u32;
        match (self.format, self.bytes) {
            (3, 2) => half::f16::from_bits(bits as u16).to_f64(),
            (3, 4) => f64::from(f32::from_bits(bits as u32)),
            (3, 8) => f64::from_bits(bits),
            (2, _) => ((bits << unused) as i64 >> unused) as f64,
            _ => bits as f64,
        }
    }
}

fn number(bytes: &[u8], big_endian: bool) -> u64 {
    let join = |n: u64, byte: &u8| n << 8 | u64::from(*byte);
    if big_endian { bytes.iter().fold(0, join) } else { bytes.iter().rev().fold(0, join) }
}

/// Adds one number of bytes to another of as many.
fn add(to: &mut [u8], other: &[u8], big_endian: bool) {
    let sum = number(to, big_endian).wrapping_add(number(other, big_endian));
    let n = to.len();
    for (i, byte) in to.iter_mut().enumerate() {
        let place = if big_endian { n - 1 - i } else { i };
        *byte = (sum >> (8 * place)) as u8;
    }
}

/// The first value of a tag of small numbers.
pub fn short(tiff: &mut File, tag: Tag) -> Option<u16> {
    let values: Vec<u16> = tiff.find_tag_unsigned_vec(tag).ok().flatten()?;
    values.first().copied()
}
