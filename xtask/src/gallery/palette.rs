//! Pictures of few colours: a palette makes them several times smaller.

use std::error::Error;
use std::path::Path;

use color_quant::NeuQuant;

/// Colours kept.
const COLORS: usize = 64;
/// One pixel in so many teaches the palette.
const SAMPLING: i32 = 10;

/// Writes the RGB or RGBA picture again with a palette; its bytes then. Text chunks are kept: they name
/// the attribution.
pub fn pack(file: &Path) -> Result<usize, Box<dyn Error>> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(std::fs::read(file)?));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("is too large")?];
    let frame = reader.next_frame(&mut pixels)?;
    pixels.truncate(frame.buffer_size());
    let opaque: Vec<u8> = match frame.color_type.samples() {
        3 => pixels.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect(),
        4 => pixels,
        _ => return Err("is neither RGB nor RGBA".into()),
    };
    let palette = NeuQuant::new(SAMPLING, COLORS, &opaque);
    let indices: Vec<u8> = opaque.chunks_exact(4).map(|p| palette.index_of(p) as u8).collect();
    let info = reader.info();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width, frame.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    for text in &info.uncompressed_latin1_text {
        encoder.add_text_chunk(text.keyword.clone(), text.text.clone())?;
    }
    for text in &info.utf8_text {
        encoder.add_itxt_chunk(text.keyword.clone(), text.get_text()?)?;
    }
    encoder.write_header()?.write_image_data(&indices)?;
    std::fs::write(file, &bytes)?;
    Ok(bytes.len())
}
