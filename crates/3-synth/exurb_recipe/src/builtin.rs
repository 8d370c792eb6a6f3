//! The examples that come with the program, from the repository's folder `data`.

use std::io::Write;
use std::path::Path;

use exurb_city::{ImportOptions, Imported};
use tempfile::NamedTempFile;

use crate::Error;

/// What stands before the name of a built-in example where a file is expected.
pub const PREFIX: &str = "builtin:";
/// The names of the built-in examples, the demo's own first.
pub const NAMES: [&str; 6] = ["helsinki", "karhula", "prague", "suburb", "saltlake", "grid"];

const OSM: &str = "© OpenStreetMap contributors, ODbL 1.0";
const FICTIONAL: &str = "Fictional map of the exurb project, CC0 1.0";
const PRAGUE_PARCELS: &str = "Parcels of Prague: © Český úřad zeměměřický a katastrální, CC BY 4.0";

/// A file of the folder `data`, with the credits of its index.
struct Builtin {
    file: &'static str,
    bytes: &'static [u8],
    credits: &'static [&'static str],
}

macro_rules! builtin {
    ($file:literal, $credits:expr) => {
        Builtin {
            file: $file,
            bytes: include_bytes!(concat!("../../../../data/", $file)),
            credits: $credits,
        }
    };
}

/// In the order of [`NAMES`].
const EXAMPLES: [Builtin; 6] = [
    builtin!("helsinki.osm.pbf", &[OSM]),
    builtin!("karhula.osm.pbf", &[OSM]),
    builtin!("prague.geojson", &[OSM, PRAGUE_PARCELS]),
    builtin!("suburb.osm.pbf", &[OSM]),
    builtin!("saltlake.osm.pbf", &[OSM]),
    builtin!("grid.osm.pbf", &[FICTIONAL]),
];

/// The name in `builtin:NAME`; `None` for ordinary files.
pub fn name_of(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix(PREFIX)
}

/// Opens the example of that name.
pub fn open(name: &str, options: &ImportOptions) -> Result<Imported, Error> {
    let known = NAMES.iter().zip(EXAMPLES).find(|(known, _)| **known == name);
    let (_, Builtin { file, bytes, credits }) = known.ok_or_else(|| {
        let names = NAMES.join(", ");
        Error::Input(format!("there is no built-in example `{name}`; there are {names}"))
    })?;
    let wrong = |message: String| Error::Input(format!("built-in example {name}: {message}"));
    let imported = if file.ends_with(".osm.pbf") {
        exurb_osm::read_bytes(bytes, file, None, options).map_err(|e| wrong(e.to_string()))
    } else {
        let copy = copy(file, bytes).map_err(|e| wrong(format!("no temporary file: {e}")))?;
        exurb_gis::read_geojson(copy.path(), options).map_err(|e| wrong(e.to_string()))
    };
    let mut imported = imported?;
    // What is wrong with our own examples is no news for a user.
    imported.warnings.clear();
    imported.city.metadata.attribution = credits.iter().map(ToString::to_string).collect();
    Ok(imported)
}

/// The GeoJSON reader opens files only.
fn copy(name: &str, bytes: &[u8]) -> std::io::Result<NamedTempFile> {
    let mut file = tempfile::Builder::new().suffix(name).tempfile()?;
    file.write_all(bytes)?;
    file.flush()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_example_opens() {
        for name in NAMES {
            let city = open(name, &ImportOptions::default()).unwrap().city;
            assert!(city.streets.edge_count() > 20, "{name}");
            assert!(!city.metadata.attribution.is_empty(), "{name}");
        }
        let message = open("atlantis", &ImportOptions::default()).unwrap_err().to_string();
        assert!(message.contains("`atlantis`; there are helsinki"), "{message}");
    }
}
