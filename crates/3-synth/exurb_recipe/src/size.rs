use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Width and height of a target in metres, written `WxH` or, for a square, `W`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Size {
    width_m: f64,
    height_m: f64,
}

/// Targets are at least this wide and high, in metres.
pub const LEAST_SIDE_M: f64 = 10.0;
/// Targets are at most this large, in km².
pub const MOST_AREA_KM2: f64 = 10_000.0;

impl Size {
    /// A rectangle of at least 10 m a side and at most 10,000 km².
    pub fn new(width_m: f64, height_m: f64) -> Result<Self, String> {
        if !(width_m >= LEAST_SIDE_M && height_m >= LEAST_SIDE_M) {
            return Err(format!(
                "a target of {width_m} m x {height_m} m is too small: at least 10 m a side"
            ));
        }
        let area_km2 = width_m * height_m / 1e6;
        if area_km2 > MOST_AREA_KM2 {
            return Err(format!(
                "a target of {area_km2:.0} km² is too large: at most 10,000 km²; make several"
            ));
        }
        Ok(Self { width_m, height_m })
    }

    /// Width in metres.
    pub fn width_m(self) -> f64 {
        self.width_m
    }

    /// Height in metres.
    pub fn height_m(self) -> f64 {
        self.height_m
    }
}

impl Default for Size {
    fn default() -> Self {
        Self { width_m: 2000.0, height_m: 2000.0 }
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("`{text}` is no size; write width and height in metres, as in 2000x2000");
        let metres = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        let mut sides = text.split(['x', 'X', '×']).map(metres);
        let width = sides.next().flatten().ok_or_else(wrong)?;
        let height = sides.next().unwrap_or(Some(width)).ok_or_else(wrong)?;
        if sides.next().is_some() {
            return Err(wrong());
        }
        Self::new(width, height)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width_m, self.height_m)
    }
}

impl TryFrom<String> for Size {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Size> for String {
    fn from(size: Size) -> Self {
        size.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_as_people_write_them() {
        let size = |text: &str| text.parse::<Size>().map(|s| (s.width_m, s.height_m));
        assert_eq!(size("2000x1500"), Ok((2000.0, 1500.0)));
        assert_eq!(size("2000 X 1500.5"), Ok((2000.0, 1500.5)));
        assert_eq!(size("800"), Ok((800.0, 800.0)));
    }

    #[test]
    fn what_is_no_size_too_small_or_too_large_is_refused() {
        for text in ["", "x", "10x", "axb", "1x2x3", "NaNx10", "-5x100", "0x0", "infx10"] {
            assert!(text.parse::<Size>().is_err(), "{text}");
        }
        assert!("100000x100000".parse::<Size>().is_ok());
        assert!("100001x100000".parse::<Size>().is_err_and(|e| e.contains("10,000 km²")));
    }
}
