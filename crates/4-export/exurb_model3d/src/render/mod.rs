//! A perspective picture without a graphics card.
//!
//! 1. All triangles are drawn from the sun and from straight above (`light`): shadows, and how much
//!    sky each place sees.
//! 2. They are drawn from the camera into bands of rows, nearest first (`raster`), several samples
//!    to a pixel.
//! 3. Each pixel is shaded once for every surface among its samples (`shade`): sun, sky, haze.
//!
//! Bands are worked on in parallel and joined in order: the picture does not depend on the number
//! of threads.

mod camera;
mod caption;
mod light;
mod meadow;
mod raster;
mod shade;
mod surface;
mod texture;

use exurb_city::City;
use rayon::prelude::*;

use crate::scene::Scene;
use crate::{Error, Options};
use camera::Camera;
use light::Light;
use raster::{Bands, NOTHING};
use shade::{Screen, Shader};
use surface::Surfaces;

/// Where a picture is taken from.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Width in pixels, 16 to 8,192; default 1,600.
    pub width_px: u32,
    /// Height in pixels, 16 to 8,192; default 1,000.
    pub height_px: u32,
    /// Where the camera stands as seen from the middle: degrees clockwise from north; default 225,
    /// the south-west.
    pub azimuth_deg: f64,
    /// How high the camera stands over the horizon, in degrees, 2 to 89; default 19, so low that
    /// the horizon is seen.
    pub elevation_deg: f64,
    /// Vertical angle of view in degrees, 5 to 100; default 44.
    pub field_of_view_deg: f64,
    /// 1 fills the frame with the city, 2 with half of it.
    pub zoom: f64,
    /// Where the sun stands, degrees clockwise from north; default 165.
    pub sun_azimuth_deg: f64,
    /// Height of the sun in degrees, 5 to 90; default 38.
    pub sun_elevation_deg: f64,
    /// Samples along each side of a pixel, 1 to 4; default 2.
    pub samples: u32,
    /// Write the attribution into the picture's corner; default true. (It stands in the file's
    /// metadata either way.)
    pub caption: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            width_px: 1600,
            height_px: 1000,
            azimuth_deg: 225.0,
            elevation_deg: 19.0,
            field_of_view_deg: 44.0,
            zoom: 1.0,
            sun_azimuth_deg: 165.0,
            sun_elevation_deg: 40.0,
            samples: 2,
            caption: true,
        }
    }
}

/// The city in perspective as PNG, 8 bits RGB. Values of `view` out of range are brought into it,
/// but for the size.
pub fn render_png(city: &City, options: &Options, view: &View) -> Result<Vec<u8>, Error> {
    let (width_px, height_px) = (view.width_px, view.height_px);
    if [width_px, height_px].iter().any(|v| !(16..=8192).contains(v)) {
        return Err(Error::Size { width_px, height_px });
    }
    let scene = Scene::of(city, options);
    let mut pixels = picture(city, &scene, view);
    let attribution = city.metadata.attribution.join("; ");
    if view.caption {
        caption::write(&mut pixels, width_px as usize, &attribution);
    }
    Ok(encode(&pixels, width_px, height_px, &city.metadata.name, &attribution)?)
}

/// RGB rows from the top.
fn picture(city: &City, scene: &Scene, view: &View) -> Vec<u8> {
    let samples = view.samples.clamp(1, 4);
    let surfaces = Surfaces::of(scene);
    let camera = Camera::over_city(city, scene, view, samples);
    let light = Light::of(&surfaces, view);
    let bands = Bands::of(&surfaces, &camera, samples as usize * ROWS_PER_BAND);
    let shader = Shader::new(scene, &surfaces, &camera, &light);
    let screen = Screen::new();
    let rows: Vec<Vec<u8>> = (0..bands.count())
        .into_par_iter()
        .map(|band| {
            let drawn = bands.draw(band);
            resolve(&drawn, &shader, &screen, &camera, samples as usize)
        })
        .collect();
    rows.concat()
}

/// Rows of pixels in a band.
const ROWS_PER_BAND: usize = 16;

/// Pixels of a band: every surface among a pixel's samples is shaded once and weighs by its
/// samples.
fn resolve(
    drawn: &raster::Drawn,
    shader: &Shader,
    screen: &Screen,
    camera: &Camera,
    samples: usize,
) -> Vec<u8> {
    let (width, rows) = (camera.width / samples, drawn.rows.len() / samples);
    let mut out = Vec::with_capacity(width * rows * 3);
    let per_pixel = (samples * samples) as f32;
    for y in 0..rows {
        for x in 0..width {
            let mut sum = glam::Vec3::ZERO;
            let mut seen: [(u32, usize, f32); 16] = [(NOTHING, 0, 0.0); 16];
            let mut kinds = 0;
            for dy in 0..samples {
                for dx in 0..samples {
                    let at = (y * samples + dy) * camera.width + x * samples + dx;
                    let triangle = drawn.triangles[at];
                    match seen[..kinds].iter_mut().find(|s| s.0 == triangle) {
                        Some(known) => known.2 += 1.0,
                        None => {
                            seen[kinds] = (triangle, at, 1.0);
                            kinds += 1;
                        }
                    }
                }
            }
            for (triangle, at, weight) in &seen[..kinds] {
                let row = drawn.rows.start + at / camera.width;
                let place = [at % camera.width, row];
                sum += shader.color(*triangle, place, drawn.nearness[*at]) * (weight / per_pixel);
            }
            out.extend(screen.of(sum));
        }
    }
    out
}

fn encode(
    pixels: &[u8],
    width_px: u32,
    height_px: u32,
    title: &str,
    attribution: &str,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width_px, height_px);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    for (keyword, text) in [("Title", title), ("Copyright", attribution)] {
        if !text.is_empty() {
            encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(out)
}
