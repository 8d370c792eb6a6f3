//! Any readable file to a city.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use exurb_city::{ImportOptions, Imported};

use crate::format::{self, Format, READABLE};
use crate::{Error, builtin};

/// Opens a map or a city of any readable format, told by content and ending; `builtin:NAME` opens
/// an example that comes with the program.
pub fn open_city(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    if let Some(name) = builtin::name_of(path) {
        return builtin::open(name, options);
    }
    let format = format_of(path)?;
    let wrong = |message: String| Error::Input(named(path, &message));
    match format {
        Format::Osm => exurb_osm::read(path, options).map_err(|e| wrong(e.to_string())),
        Format::GeoJson => exurb_gis::read_geojson(path, options).map_err(|e| wrong(e.to_string())),
        Format::GeoPackage => {
            exurb_gis::read_geopackage(path, options).map_err(|e| wrong(e.to_string()))
        }
    }
}

/// Opens a map, or the several GeoJSON files of one place: streets, parcels, buildings.
pub fn open_all(paths: &[PathBuf], options: &ImportOptions) -> Result<Imported, Error> {
    if let [path] = paths {
        return open_city(path, options);
    }
    for path in paths {
        if format_of(path)? != Format::GeoJson {
            let message = "only GeoJSON files are read together; import the others one by one";
            return Err(Error::Input(named(path, message)));
        }
    }
    exurb_gis::read_geojson_many(paths, options).map_err(|e| Error::Input(e.to_string()))
}

/// The format of a file that is there.
pub fn format_of(path: &Path) -> Result<Format, Error> {
    format::detect(path, &head(path)?).ok_or_else(|| {
        let path = path.display();
        Error::Input(format!("{path}: no format that can be read; there are {READABLE}"))
    })
}

/// Is it a GeoPackage?
pub fn is_geopackage(path: &Path) -> Result<bool, Error> {
    Ok(format::detect(path, &head(path)?) == Some(Format::GeoPackage))
}

/// Where a file is: beside the recipe, else in the current folder.
pub fn locate(file: &Path, folder: &Path) -> Result<PathBuf, Error> {
    if builtin::name_of(file).is_some() {
        return Ok(file.to_owned());
    }
    [folder.join(file), file.to_owned()]
        .into_iter()
        .find(|path| path.exists())
        .ok_or_else(|| Error::Input(format!("{}: there is no such file", file.display())))
}

/// The beginning of a file.
fn head(path: &Path) -> Result<Vec<u8>, Error> {
    let wrong = |message: &str| Error::Input(format!("{}: {message}", path.display()));
    if path.is_dir() {
        return Err(wrong("this is a folder, not a map"));
    }
    let file = File::open(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => wrong("there is no such file"),
        _ => wrong(&format!("cannot be read: {e}")),
    })?;
    let mut head = Vec::new();
    file.take(16_384).read_to_end(&mut head).map_err(|e| wrong(&format!("cannot be read: {e}")))?;
    if head.is_empty() {
        return Err(wrong("the file is empty"));
    }
    Ok(head)
}

/// The message with the file's name in front, unless it is there already.
pub fn named(path: &Path, message: &str) -> String {
    let path = path.display().to_string();
    if message.contains(&path) { message.to_owned() } else { format!("{path}: {message}") }
}
