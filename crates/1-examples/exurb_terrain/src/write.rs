//! Terrain → height maps for GIS programs and game engines.

use std::io::Cursor;

use exurb_city::{City, Terrain};
use exurb_geom::Frame;
use tiff::TiffError;
use tiff::encoder::{Compression, TiffEncoder, colortype::Gray32Float, compression::DeflateLevel};
use tiff::tags::Tag;

use crate::png16::{Description, KEYWORD};
use crate::{Error, geokeys};

const COPYRIGHT: Tag = Tag::Unknown(33_432);
const GDAL_METADATA: Tag = Tag::Unknown(42_112);

/// The terrain of a city as GeoTIFF: 32-bit floats, metres, deflated, north up, in the city's own
/// transverse Mercator; missing heights are NaN. Lowest and highest height stand in GDAL's
/// statistics, attributions in the copyright tag. Equal cities give equal bytes. An error when
/// there is no terrain.
pub fn to_geotiff(city: &City) -> Result<Vec<u8>, Error> {
    let terrain = terrain_of(city)?;
    let pack = |e: TiffError| Error::Pack(e.to_string());
    let mut out = Cursor::new(Vec::new());
    let mut file = TiffEncoder::new(&mut out)
        .map_err(pack)?
        .with_compression(Compression::Deflate(DeflateLevel::Balanced));
    let (columns, rows) = (terrain.columns() as u32, terrain.rows() as u32);
    let mut image = file.new_image::<Gray32Float>(columns, rows).map_err(pack)?;
    tags(&mut image, terrain, city).map_err(pack)?;
    image.write_data(&from_north(terrain)).map_err(pack)?;
    Ok(out.into_inner())
}

type Image<'a, 'b> = tiff::encoder::ImageEncoder<
    'a,
    &'b mut Cursor<Vec<u8>>,
    Gray32Float,
    tiff::encoder::TiffKindStandard,
>;

fn tags(image: &mut Image<'_, '_>, terrain: &Terrain, city: &City) -> Result<(), TiffError> {
    let cell = terrain.cell_m();
    let north_west = terrain.post(0, terrain.rows() - 1);
    let (directory, doubles, text) = geokeys::of_frame(&city.frame);
    let (low, high) = terrain.range_m();
    let metadata = format!(
        "<GDALMetadata><Item name=\"STATISTICS_MINIMUM\" sample=\"0\">{low}</Item>\
         <Item name=\"STATISTICS_MAXIMUM\" sample=\"0\">{high}</Item></GDALMetadata>"
    );
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[cell, cell, 0.0][..])?;
    let corner = [0.0, 0.0, 0.0, north_west.x - cell / 2.0, north_west.y + cell / 2.0, 0.0];
    tags.write_tag(Tag::ModelTiepointTag, &corner[..])?;
    tags.write_tag(Tag::GeoKeyDirectoryTag, &directory[..])?;
    tags.write_tag(Tag::GeoDoubleParamsTag, &doubles[..])?;
    tags.write_tag(Tag::GeoAsciiParamsTag, &text[..])?;
    tags.write_tag(GDAL_METADATA, &metadata[..])?;
    tags.write_tag(Tag::GdalNodata, "nan")?;
    let attribution = plain(&city.metadata.attribution.join("; "));
    if !attribution.is_empty() {
        tags.write_tag(COPYRIGHT, &attribution[..])?;
    }
    Ok(())
}

/// TIFF's texts are ASCII.
fn plain(text: &str) -> String {
    let letter = |c: char| if c == '©' { "(c)".to_owned() } else { c.to_string() };
    text.chars().map(letter).collect::<String>().replace(|c: char| !c.is_ascii(), "?")
}

/// A height map as a picture, with the files that go with it.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// PNG, 16 bits grey.
    pub png: Vec<u8>,
    /// What its values mean, as JSON, for `NAME.json`; the same stands in the PNG.
    pub json: String,
    /// World file, for `NAME.pgw`: coordinates of the city's own plane.
    pub world: String,
    /// That plane as well-known text, for `NAME.prj`.
    pub projection: String,
}

/// The terrain of a city as a 16-bit grey PNG, north up: black is the lowest height, white the
/// highest; where heights are missing, 0 stands for that and 1 for the lowest. [`Description`] says
/// the rest. Equal cities give equal bytes. An error when there is no terrain.
pub fn to_png(city: &City) -> Result<HeightMap, Error> {
    let terrain = terrain_of(city)?;
    let description = describe(terrain, &city.frame);
    let value = |height: f32| match height.is_nan() {
        true => 0,
        false => {
            let steps = (f64::from(height) - description.offset_m) / description.metres_per_step;
            steps.round().clamp(f64::from(description.lowest_value), 65_535.0) as u16
        }
    };
    let pixels: Vec<u8> =
        from_north(terrain).iter().flat_map(|height| value(*height).to_be_bytes()).collect();
    let json =
        serde_json::to_string_pretty(&description).map_err(|e| Error::Pack(e.to_string()))?;
    let png = pack_png(&pixels, &description, &json, city);
    let png = png.map_err(|e| Error::Pack(e.to_string()))?;
    let (cell, [x, y]) = (description.cell_m, description.first_m);
    let world = format!("{cell}\n0\n0\n-{cell}\n{x}\n{y}\n");
    Ok(HeightMap { png, json: json + "\n", world, projection: city.frame.to_wkt() + "\n" })
}

fn pack_png(
    pixels: &[u8],
    description: &Description,
    json: &str,
    city: &City,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let (width, height) = (description.width as u32, description.height as u32);
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    if description.lowest_value > 0 {
        encoder.set_trns(vec![0, 0]);
    }
    encoder.add_itxt_chunk(KEYWORD.to_owned(), json.to_owned())?;
    let attribution = city.metadata.attribution.join("; ");
    for (keyword, text) in [("Title", &*city.metadata.name), ("Copyright", &attribution)] {
        if !text.is_empty() {
            encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(out)
}

fn describe(terrain: &Terrain, frame: &Frame) -> Description {
    let (low, high) = terrain.range_m();
    let (low, high) = (f64::from(low), f64::from(high));
    let lowest_value = u16::from(terrain.missing() > 0);
    let steps = f64::from(65_535 - lowest_value);
    // Flat ground has steps, too, so that its height can be told.
    let metres_per_step = (high - low).max(0.001) / steps;
    let offset_m = low - metres_per_step * f64::from(lowest_value);
    let (columns, rows, cell_m) = (terrain.columns(), terrain.rows(), terrain.cell_m());
    let first = terrain.post(0, rows - 1);
    let size_m = [(columns - 1) as f64 * cell_m, (rows - 1) as f64 * cell_m];
    let bounds = terrain.bounds();
    let (sw, ne) = (frame.unproject(bounds.min), frame.unproject(bounds.max));
    let degrees = |v: f64| (v * 1e7).round() / 1e7;
    let full_m = metres_per_step * 65_535.0;
    Description {
        width: columns,
        height: rows,
        cell_m,
        size_m,
        lowest_m: low,
        highest_m: low + metres_per_step * steps,
        lowest_value,
        metres_per_step,
        offset_m,
        water_level_m: terrain.water_level_m(),
        first_m: first.to_array(),
        crs: frame.to_proj(),
        lonlat_bounds: [sw.lon, sw.lat, ne.lon, ne.lat].map(degrees),
        // Unreal reads 16 bits as -256 m to 256 m at scale 100.
        unreal_scale: [cell_m * 100.0, cell_m * 100.0, full_m / 512.0 * 100.0],
        unity_size: [size_m[0], full_m, size_m[1]],
    }
}

fn terrain_of(city: &City) -> Result<&Terrain, Error> {
    city.terrain.as_deref().ok_or_else(|| {
        Error::Pack("the city has no terrain; give it one with --terrain DEM".to_owned())
    })
}

/// Heights row by row from the north.
fn from_north(terrain: &Terrain) -> Vec<f32> {
    terrain.heights().chunks_exact(terrain.columns()).rev().flatten().copied().collect()
}
