//! What fuzzing calls: readers of any bytes, which may fail but never panic or run away. The tests
//! run them over mutated files.

use exurb_city::ImportOptions;
use rusqlite::{Connection, MAIN_DB};

use crate::{geojson, geopackage, target};

/// Reads bytes as a GeoPackage.
pub fn geopackage(bytes: &[u8]) {
    let Ok(mut db) = Connection::open_in_memory() else { return };
    if db.deserialize_read_exact(MAIN_DB, bytes, bytes.len(), true).is_ok() {
        // Errors are an answer, too.
        let _ = geopackage::read_database(&db, "bytes", "bytes", &ImportOptions::default());
    }
}

/// Reads bytes as GeoJSON.
pub fn geojson(bytes: &[u8]) {
    let _ = geojson::read_stream(bytes, "bytes", "bytes", &ImportOptions::default());
}

/// Reads bytes as a target.
pub fn target(bytes: &[u8]) {
    let _ = geojson::outlines(bytes, "bytes").and_then(|o| target::settle(o, "bytes", None));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use proptest::prelude::*;

    /// Bytes with some of them changed, then cut off.
    fn mutated(whole: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
        let n = whole.len();
        let flips = prop::collection::vec((0..n, any::<u8>()), 0..12);
        // One half is cut, the other only changed.
        (flips, prop_oneof![Just(n), 0..n]).prop_map(move |(flips, end)| {
            let mut bytes = whole.clone();
            flips.into_iter().for_each(|(at, byte)| bytes[at] = byte);
            bytes.truncate(end);
            bytes
        })
    }

    fn small_geopackage() -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gpkg");
        crate::write_geopackage(&sample::grid_city(1), &path).unwrap();
        std::fs::read(path).unwrap()
    }

    fn small_geojson() -> Vec<u8> {
        let mut out = Vec::new();
        crate::write_geojson(&sample::grid_city(1), &mut out).unwrap();
        out
    }

    /// A row's geometry replaced by nonsense of the same length.
    fn with_bad_blobs(whole: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
        let starts: Vec<usize> = whole
            .windows(4)
            .enumerate()
            .filter(|(_, w)| w[..3] == *b"GP\0")
            .map(|(i, _)| i)
            .collect();
        let changes =
            prop::collection::vec((prop::sample::select(starts), 3..60_usize, any::<u8>()), 1..6);
        changes.prop_map(move |changes| {
            let mut bytes = whole.clone();
            for (start, offset, byte) in changes {
                if let Some(slot) = bytes.get_mut(start + offset) {
                    *slot = byte;
                }
            }
            bytes
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn broken_geopackages_do_not_panic(bytes in mutated(small_geopackage())) {
            geopackage(&bytes);
        }

        #[test]
        fn broken_geometries_do_not_panic(bytes in with_bad_blobs(small_geopackage())) {
            geopackage(&bytes);
        }

        #[test]
        fn broken_geojson_does_not_panic(bytes in mutated(small_geojson())) {
            geojson(&bytes);
            target(&bytes);
        }

        #[test]
        fn any_numbers_are_coordinates_or_errors(numbers in prop::collection::vec(any::<f64>(), 2..16)) {
            let positions: Vec<String> = numbers.chunks(2).map(|c| format!("[{:e},{:e}]", c[0], c[c.len() - 1])).collect();
            for (kind, depth) in [("Polygon", 1), ("LineString", 0), ("MultiPolygon", 2)] {
                let (open, close) = ("[".repeat(depth), "]".repeat(depth));
                let text = format!("{{\"type\":\"{kind}\",\"coordinates\":{open}[{}]{close}}}", positions.join(","));
                geojson(text.as_bytes());
                target(text.as_bytes());
            }
        }
    }

    #[test]
    fn absurd_counts_and_depths_are_errors() {
        let huge_line =
            [b"GP\0\x01\0\0\0\0\x01\x02\0\0\0".as_slice(), &u32::MAX.to_le_bytes()].concat();
        assert!(crate::wkb::decode(&huge_line).is_err());
        let huge_polygon =
            [b"GP\0\x01\0\0\0\0\x01\x03\0\0\0".as_slice(), &u32::MAX.to_le_bytes()].concat();
        assert!(crate::wkb::decode(&huge_polygon).is_err());
        let nested =
            [b"GP\0\x01\0\0\0\0".as_slice(), &b"\x01\x07\0\0\0\x01\0\0\0".repeat(100_000)].concat();
        assert!(crate::wkb::decode(&nested).is_err());
        geojson(
            format!("{{\"type\":\"Polygon\",\"coordinates\":{}", "[".repeat(100_000)).as_bytes(),
        );
        geojson("{\"geometry\":".repeat(100_000).as_bytes());
    }
}
