//! Which format a file has, by what it holds and, where that does not tell, by its ending.

use std::path::Path;

/// A readable format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenStreetMap XML, PBF or Overpass JSON, packed or not.
    Osm,
    /// GeoJSON.
    GeoJson,
    /// GeoPackage.
    GeoPackage,
}

/// The readable formats, for messages.
pub const READABLE: &str = ".osm, .osm.gz, .osm.bz2, .osm.pbf, Overpass .json, .geojson and .gpkg";

/// The format of a file by its first bytes (a few kilobytes are enough), else by its ending.
pub fn detect(path: &Path, head: &[u8]) -> Option<Format> {
    by_content(head).or_else(|| by_ending(path))
}

fn by_content(head: &[u8]) -> Option<Format> {
    const GZIP: &[u8] = &[0x1f, 0x8b];
    if head.starts_with(b"SQLite format 3\0") {
        return Some(Format::GeoPackage);
    }
    let packed = head.starts_with(GZIP) || head.starts_with(b"BZh");
    let pbf = head.get(..32.min(head.len())).is_some_and(|h| contains(h, b"OSMHeader"));
    if packed || pbf {
        return Some(Format::Osm);
    }
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    match text.first()? {
        b'<' => Some(Format::Osm),
        b'{' => json(text),
        _ => None,
    }
}

/// Overpass answers begin with `version`, `generator`, `osm3s` and hold `elements`; GeoJSON has a
/// `type` that names one of its objects.
fn json(text: &[u8]) -> Option<Format> {
    let first = |words: &[&[u8]]| {
        words.iter().filter_map(|word| text.windows(word.len()).position(|w| w == *word)).min()
    };
    let overpass = first(&[b"\"osm3s\"", b"\"elements\""]);
    let geojson =
        first(&[b"\"FeatureCollection\"", b"\"Feature\"", b"\"features\"", b"\"coordinates\""]);
    match (overpass, geojson) {
        (Some(o), Some(g)) if o < g => Some(Format::Osm),
        (Some(_), None) => Some(Format::Osm),
        (_, Some(_)) => Some(Format::GeoJson),
        (None, None) => None,
    }
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|w| w == word)
}

fn by_ending(path: &Path) -> Option<Format> {
    let name = path.file_name()?.to_string_lossy().to_lowercase();
    let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    if ends(&[".osm", ".osm.gz", ".osm.bz2", ".pbf", ".osm.xml"]) {
        Some(Format::Osm)
    } else if ends(&[".geojson"]) {
        Some(Format::GeoJson)
    } else if ends(&[".gpkg"]) {
        Some(Format::GeoPackage)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_goes_before_the_ending() {
        let of = |name: &str, head: &[u8]| detect(Path::new(name), head);
        assert_eq!(of("a.json", b" {\"version\": 0.6, \"elements\": ["), Some(Format::Osm));
        assert_eq!(
            of("a.json", b"\xef\xbb\xbf{\"type\":\"FeatureCollection\""),
            Some(Format::GeoJson)
        );
        assert_eq!(of("a.osm", b"SQLite format 3\0"), Some(Format::GeoPackage));
        assert_eq!(of("map", b"\0\0\0\x0d\x0a\x09OSMHeader"), Some(Format::Osm));
        assert_eq!(of("map", b"<?xml version='1.0'?><osm"), Some(Format::Osm));
        assert_eq!(of("map.gpkg", b"PK\x03\x04"), Some(Format::GeoPackage));
        assert_eq!(of("readme.txt", b"hello"), None);
        assert_eq!(of("empty", b""), None);
    }
}
