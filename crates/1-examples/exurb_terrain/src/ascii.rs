//! ESRI ASCII grid: a head of names and numbers, then heights row by row from the north.
//!
//! `ncols`, `nrows`; `xllcorner` and `yllcorner`, or `xllcenter` and `yllcenter`; `cellsize`, or
//! `dx` and `dy`; `nodata_value` (-9999 when absent). Names in any case and order.

use crate::dem::Affine;
use crate::options::Said;
use crate::{Dem, Error, Options, read::MOST_PIXELS};

/// Is this the beginning of one?
pub fn is_ascii_grid(head: &[u8]) -> bool {
    let text = head.trim_ascii_start();
    NAMES.iter().any(|name| {
        text.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name.as_bytes()))
    })
}

const NAMES: [&str; 11] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "xllcentre",
    "yllcentre",
    "cellsize",
    "nodata_value",
    "dx",
];

/// Numbers of the head.
#[derive(Default)]
struct Head {
    columns: usize,
    rows: usize,
    /// Of the south-west pixel, and whether it is its middle.
    x: Option<(f64, bool)>,
    y: Option<(f64, bool)>,
    width: f64,
    height: f64,
    missing: f64,
}

/// Reads an ASCII grid; `said` is what files beside it say.
pub fn read(bytes: &[u8], file: &str, said: Said, options: &Options) -> Result<Dem, Error> {
    let text = std::str::from_utf8(bytes)
        .map_err(|_| Error::content(file, "is no ASCII grid: it holds bytes that are no text"))?;
    let mut words = text.split_ascii_whitespace().peekable();
    let head = read_head(&mut words, file)?;
    let wanted = head.columns * head.rows;
    let mut heights: Vec<f32> = Vec::with_capacity(wanted.min(text.len() / 2));
    for word in words {
        let height: f64 = word.parse().map_err(|_| {
            let at = heights.len();
            let (row, column) = (at / head.columns + 1, at % head.columns + 1);
            let message = format!("has `{word}` for a height in row {row}, column {column}");
            Error::content(file, message)
        })?;
        heights.push(if height == head.missing { f32::NAN } else { height as f32 });
    }
    if heights.len() != wanted {
        let message = format!(
            "holds {} heights, but its head says {} x {}; it may be cut short",
            heights.len(),
            head.columns,
            head.rows
        );
        return Err(Error::content(file, message));
    }
    let said = Said { affine: head.affine(), ..said };
    let place = options.place(file, said, head.columns, head.rows)?;
    Ok(Dem { file: file.to_owned(), columns: head.columns, heights, place, attribution: None })
}

fn read_head<'t>(
    words: &mut std::iter::Peekable<impl Iterator<Item = &'t str>>,
    file: &str,
) -> Result<Head, Error> {
    let mut head = Head { missing: -9999.0, ..Head::default() };
    while let Some(name) = words.next_if(|w| w.starts_with(|c: char| c.is_ascii_alphabetic())) {
        let name = name.to_ascii_lowercase();
        if name == "nan" {
            return Err(Error::content(file, "has no complete head before its heights"));
        }
        let value: f64 = words.next().and_then(|word| word.parse().ok()).ok_or_else(|| {
            Error::content(file, format!("has no number after `{name}` in its head"))
        })?;
        match name.as_str() {
            "ncols" => head.columns = value as usize,
            "nrows" => head.rows = value as usize,
            "xllcorner" => head.x = Some((value, false)),
            "yllcorner" => head.y = Some((value, false)),
            "xllcenter" | "xllcentre" => head.x = Some((value, true)),
            "yllcenter" | "yllcentre" => head.y = Some((value, true)),
            "cellsize" => (head.width, head.height) = (value, value),
            "dx" => head.width = value,
            "dy" => head.height = value,
            "nodata_value" => head.missing = value,
            _ => {
                return Err(Error::content(
                    file,
                    format!("has `{name}` in its head, which no ASCII grid has"),
                ));
            }
        }
    }
    let count = head.columns.saturating_mul(head.rows);
    if !(1..=MOST_PIXELS).contains(&count) {
        let message = format!("is {} x {} by its head", head.columns, head.rows);
        return Err(Error::content(file, message));
    }
    Ok(head)
}

impl Head {
    fn affine(&self) -> Option<Affine> {
        let ((x, x_is_middle), (y, y_is_middle)) = (self.x?, self.y?);
        let middle = |edge: f64, is_middle: bool, size: f64| {
            if is_middle { edge } else { edge + size / 2.0 }
        };
        let west = middle(x, x_is_middle, self.width);
        let south = middle(y, y_is_middle, self.height);
        let north = south + self.height * (self.rows as f64 - 1.0);
        (self.width > 0.0 && self.height > 0.0)
            .then(|| Affine::north_up(west, north, self.width, self.height))
    }
}
