//! SRTM tiles: big-endian 16-bit heights of one degree square, 1201 or 3601 a side, row by row from
//! the north. The name (`N43E007.hgt`) is the south-west corner; the outer heights stand on its
//! edges. -32768 is missing.

use std::path::Path;

use exurb_geom::Crs;

use crate::dem::Affine;
use crate::options::Said;
use crate::{Dem, Error, Options};

const MISSING: i16 = i16::MIN;
const SIDES: [usize; 3] = [1201, 3601, 601];

/// Reads a tile; its place is in its name.
pub fn read(bytes: &[u8], file: &str, options: &Options) -> Result<Dem, Error> {
    let Some(side) = SIDES.into_iter().find(|side| side * side * 2 == bytes.len()) else {
        let message = format!(
            "has {} bytes, which is no SRTM tile: those have 2 x 1201 x 1201 or 2 x 3601 x 3601",
            bytes.len()
        );
        return Err(Error::content(file, message));
    };
    let height = |pair: &[u8]| match i16::from_be_bytes([pair[0], pair[1]]) {
        MISSING => f32::NAN,
        height => f32::from(height),
    };
    let heights = bytes.chunks_exact(2).map(height).collect();
    let step = 1.0 / (side as f64 - 1.0);
    let affine = corner(file).map(|(lon, lat)| Affine::north_up(lon, lat + 1.0, step, step));
    let said = Said { affine, crs: Some(Ok(Crs::wgs84())) };
    let place = options.place(file, said, side, side)?;
    Ok(Dem { file: file.to_owned(), columns: side, heights, place, attribution: None })
}

/// Longitude and latitude in a name such as `S01W079`.
fn corner(file: &str) -> Option<(f64, f64)> {
    let name = Path::new(file).file_name()?.to_str()?.to_ascii_uppercase();
    let degrees = |letters: [char; 2], from: usize, digits: usize| {
        let sign = match name.chars().nth(from)? {
            c if c == letters[0] => 1.0,
            c if c == letters[1] => -1.0,
            _ => return None,
        };
        let number: u16 = name.get(from + 1..from + 1 + digits)?.parse().ok()?;
        Some(sign * f64::from(number))
    };
    Some((degrees(['E', 'W'], 3, 3)?, degrees(['N', 'S'], 0, 2)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_is_the_south_west_corner() {
        assert_eq!(corner("a/N43E007.hgt"), Some((7.0, 43.0)));
        assert_eq!(corner("s01w079.SRTMGL1.hgt"), Some((-79.0, -1.0)));
        for name in ["", "N4xE007.hgt", "heights.hgt", "Ä43E007.hgt", "N43"] {
            assert_eq!(corner(name), None, "{name}");
        }
    }
}
