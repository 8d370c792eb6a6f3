//! Maps side by side: windows of one size at one scale, as pictures of a fixed number of pixels.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use exurb_city::City;
use exurb_geom::Bounds;
use exurb_measure::network::rectangle;
use exurb_plan::Options;

use crate::html::text;
use crate::{Column, Error, Report};

/// Pixels of all maps of a page together; a quarter less is tried until they are no more than so many
/// bytes.
const ALL_PIXELS: f64 = 1.5e6;
const MOST_BYTES: usize = 1_900_000;
const LESS: f64 = 0.75;
/// Pixels of a map are not made fewer than this.
const LEAST_PIXELS: f64 = 1e4;
/// A map is at most this wide.
const MOST_WIDTH_PX: f64 = 900.0;

/// A row for every example: the candidate, the example's part, its held-out part, at one scale.
pub fn maps(report: &Report) -> Result<String, Error> {
    let mut each = ALL_PIXELS / (3 * report.columns.len().max(1)) as f64;
    loop {
        let rows = report.columns.iter().map(|column| row(report.candidate, column, each));
        let maps: String = rows.collect::<Result<_, _>>()?;
        if maps.len() <= MOST_BYTES || each < LEAST_PIXELS {
            return Ok(maps);
        }
        each *= LESS;
    }
}

fn row(candidate: &City, column: &Column, pixels: f64) -> Result<String, Error> {
    let reference = column.reference;
    let name = text(&column.document.example);
    let held_out = text(&column.document.held_out_words());
    let shown = [
        ("the new city".to_owned(), candidate, column.likeness.candidate.network.window),
        (format!("{name}: the example"), column.example, reference.part.network.window),
        (format!("{name}: {held_out}"), column.held_out, reference.held_out.window),
    ];
    let size = reference.size;
    let width_px = (pixels * size.x / size.y).sqrt().clamp(16.0, MOST_WIDTH_PX) as u32;
    let mut out = "<div class=\"maps\">\n".to_owned();
    for (title, city, window) in shown {
        let data = picture(city, window, width_px)?;
        out += &format!(
            "<figure><img alt=\"{title}\" src=\"data:image/png;base64,{data}\">\
             <figcaption>{title}; {:.0} m × {:.0} m</figcaption></figure>\n",
            window.size().x,
            window.size().y
        );
    }
    Ok(out + "</div>\n")
}

fn picture(city: &City, window: Bounds, width_px: u32) -> Result<String, Error> {
    let cropped = City { target: rectangle(window), ..city.clone() };
    let options = Options { width_px, caption: false, ..Options::default() };
    Ok(STANDARD.encode(exurb_plan::to_png(&cropped, &options)?))
}
