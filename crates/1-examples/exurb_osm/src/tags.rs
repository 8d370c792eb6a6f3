//! Tags: the keys that matter and how their values are read.

use std::sync::Arc;

/// The keys that matter; all others are dropped while reading. Sorted.
const KEYS: [&str; 39] = [
    "amenity",
    "area",
    "barrier",
    "boundary",
    "bridge",
    "building",
    "building:levels",
    "building:min_level",
    "building:part",
    "emergency",
    "exurb:target",
    "fixme",
    "height",
    "highway",
    "historic",
    "junction",
    "landuse",
    "lanes",
    "layer",
    "leisure",
    "man_made",
    "min_height",
    "name",
    "natural",
    "office",
    "oneway",
    "place",
    "power",
    "roof:shape",
    "shop",
    "tourism",
    "tunnel",
    "type",
    "water",
    "waterway",
    "waterway:width",
    "width",
    "width:carriageway",
    "zoning",
];

/// A key that matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(u8);

/// The key of that name, if it matters.
pub fn key(name: &str) -> Option<Key> {
    KEYS.binary_search(&name).ok().map(|i| Key(i as u8))
}

/// Tags of an element, as far as they matter. Values are shared where a reader shares them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tags(Vec<(Key, Arc<str>)>);

impl Tags {
    /// Adds a tag.
    pub fn push(&mut self, key: Key, value: impl Into<Arc<str>>) {
        self.0.push((key, value.into()));
    }

    /// The value of `key`.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.iter().find(|(k, _)| *k == key).map(|(_, v)| v)
    }

    /// The value of `key`, to keep.
    pub fn get_shared(&self, key: &str) -> Option<Arc<str>> {
        self.0.iter().find(|(k, _)| KEYS[usize::from(k.0)] == key).map(|(_, v)| v.clone())
    }

    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Is `key` there with a value other than `no`?
    pub fn says(&self, key: &str) -> bool {
        self.get(key).is_some_and(|v| v != "no")
    }

    /// All tags.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.0.iter().map(|(k, v)| (KEYS[usize::from(k.0)], &**v))
    }

    /// Gives back memory that no further tag will need.
    pub fn shrunk(mut self) -> Self {
        self.0.shrink_to_fit();
        self
    }
}

impl<'a> FromIterator<(&'a str, &'a str)> for Tags {
    fn from_iter<I: IntoIterator<Item = (&'a str, &'a str)>>(tags: I) -> Self {
        let mut out = Self::default();
        for (name, value) in tags {
            if let Some(key) = key(name) {
                out.push(key, value);
            }
        }
        out
    }
}

/// A length in metres: `7`, `7.5`, `7,5`, `7 m`, `0.8 km`, `23'`, `23 ft`, `5'11"`. `None` for what
/// is no finite length of at least 0.
pub fn length_m(value: &str) -> Option<f64> {
    const FOOT_M: f64 = 0.3048;
    let value = value.trim();
    if let Some((feet, inches)) = value.split_once('\'') {
        let inches = inches.trim().trim_end_matches('"').trim();
        let inches = if inches.is_empty() { 0.0 } else { number(inches)? };
        return Some((number(feet)? + inches / 12.0) * FOOT_M);
    }
    let at = value.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+')));
    let (digits, unit) = value.split_at(at.unwrap_or(value.len()));
    let factor = match unit.trim() {
        "" | "m" | "metre" | "metres" | "meter" | "meters" => 1.0,
        "km" => 1000.0,
        "cm" => 0.01,
        "ft" | "feet" | "foot" => FOOT_M,
        _ => return None,
    };
    Some(number(digits)? * factor)
}

/// A finite number of at least 0, with a point or one comma.
pub fn number(value: &str) -> Option<f64> {
    let value = value.trim();
    let plain = value.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b',' | b'-' | b'+'));
    let parsed: f64 = if plain { value.replace(',', ".").parse().ok()? } else { return None };
    (parsed.is_finite() && parsed >= 0.0).then_some(parsed)
}

/// A whole number from `lo` to `hi`; numbers beyond are clamped, words and lists are `None`.
pub fn whole(value: &str, lo: i32, hi: i32) -> Option<i32> {
    let parsed: f64 = value.trim().parse().ok()?;
    (parsed.is_finite() && parsed.fract() == 0.0)
        .then(|| parsed.clamp(f64::from(lo), f64::from(hi)) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_are_sorted_and_found() {
        assert!(KEYS.is_sorted());
        for name in KEYS {
            assert_eq!(Tags::from_iter([(name, "x")]).iter().next(), Some((name, "x")));
        }
        assert_eq!(key("addr:street"), None);
    }

    #[test]
    fn lengths_come_in_many_dresses() {
        let near = |value: &str, m: f64| {
            let got = length_m(value).unwrap_or(f64::NAN);
            assert!((got - m).abs() < 1e-9, "{value}: {got}");
        };
        near("7", 7.0);
        near(" 7.5 ", 7.5);
        near("7,5", 7.5);
        near("7 m", 7.0);
        near("12m", 12.0);
        near("0.8 km", 800.0);
        near("40'", 40.0 * 0.3048);
        near("5'11\"", 71.0 / 12.0 * 0.3048);
        near("23 ft", 23.0 * 0.3048);
        for nonsense in ["", "wide", "-3", "3;4", "1e400", "NaN", "inf", "2-3", "'", "4 lanes"] {
            assert_eq!(length_m(nonsense), None, "{nonsense}");
        }
    }

    #[test]
    fn whole_numbers_are_clamped_and_words_ignored() {
        assert_eq!(whole("3", 0, 9), Some(3));
        assert_eq!(whole("-77", -10, 10), Some(-10));
        assert_eq!(whole("2.0", 0, 9), Some(2));
        assert_eq!(whole("1;2", 0, 9), None);
        assert_eq!(whole("nan", 0, 9), None);
    }
}
