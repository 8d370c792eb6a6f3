//! What files beside a raster say of its place: world files and `.prj`.

use std::path::Path;

use exurb_geom::Crs;

use crate::dem::Affine;
use crate::options::Said;

/// Reads `NAME.pgw`, `NAME.pngw` or `NAME.wld` (and so for other endings), and `NAME.prj`. What is
/// not there or not readable says nothing.
pub fn said(path: &Path) -> Said {
    let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
    let letters: Vec<char> = ending.chars().collect();
    let short = match letters[..] {
        [first, .., last] => format!("{first}{last}w"),
        _ => "wld".to_owned(),
    };
    let text = |ending: &str| std::fs::read_to_string(path.with_extension(ending)).ok();
    let world = [short, format!("{ending}w"), "wld".to_owned()];
    let affine = world.iter().filter_map(|ending| text(ending)).find_map(|text| world_file(&text));
    let crs = text("prj").map(|text| {
        Crs::from_wkt(text.trim()).or_else(|| Crs::from_name(&text)).ok_or_else(|| name(&text))
    });
    Said { affine, crs }
}

/// Six numbers: x by column, y by column, x by row, y by row, and the middle of the first pixel.
fn world_file(text: &str) -> Option<Affine> {
    let numbers: Result<Vec<f64>, _> =
        text.split_whitespace().map(|word| word.replace(',', ".").parse()).collect();
    match numbers.ok()?[..] {
        [xc, yc, xr, yr, x0, y0] => {
            let affine = Affine { x0, xc, xr, y0, yc, yr };
            affine.inverse(0.0, 0.0).map(|_| affine)
        }
        _ => None,
    }
}

/// The first quoted word of a well-known text.
fn name(text: &str) -> String {
    text.split('"').nth(1).unwrap_or(text).chars().take(60).collect()
}
