//! The examples that come with the program, from the repository's folder `data`.

use std::path::Path;

use exurb_city::{ImportOptions, Imported};

use crate::Error;

/// What stands before the name of a built-in example where a file is expected.
pub const PREFIX: &str = "builtin:";
/// The names of the built-in examples, the demo's own first.
pub const NAMES: [&str; 5] = ["helsinki", "karhula", "prague", "grid", "suburb"];

/// File name and bytes of each, in the order of [`NAMES`].
const FILES: [(&str, &[u8]); 5] = [
    ("helsinki.osm.pbf", include_bytes!("../../../../data/helsinki.osm.pbf")),
    ("karhula.osm.pbf", include_bytes!("../../../../data/karhula.osm.pbf")),
    ("prague.geojson", include_bytes!("../../../../data/prague.geojson")),
    ("grid.osm.pbf", include_bytes!("../../../../data/grid.osm.pbf")),
    ("suburb.osm.pbf", include_bytes!("../../../../data/suburb.osm.pbf")),
];

/// The name in `builtin:NAME`; `None` for ordinary files.
pub fn name_of(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix(PREFIX)
}

/// Opens the example of that name.
pub fn open(name: &str, options: &ImportOptions) -> Result<Imported, Error> {
    let known = NAMES.iter().zip(FILES).find(|(known, _)| **known == name);
    let (_, (file, bytes)) = known.ok_or_else(|| {
        Error::Input(format!(
            "there is no built-in example `{name}`; there are {}",
            NAMES.join(", ")
        ))
    })?;
    let wrong = |message: String| Error::Input(format!("built-in example {name}: {message}"));
    if file.ends_with(".geojson") {
        Err(wrong("LATER".to_owned()))
    } else {
        exurb_osm::read_bytes(bytes, file, None, options).map_err(|e| wrong(e.to_string()))
    }
}
