//! The formats that are written, by the ending of the file or by name.

use std::path::Path;

use crate::problem::Problem;

/// A format to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Format {
    GeoPackage,
    GeoJson,
    OsmXml,
    OsmXmlGz,
    OsmPbf,
    Glb,
    Obj,
    Svg,
    Png,
    GeoTiff,
}

/// Every format: name for `--to`, endings, format. Longer endings first.
const FORMATS: [(&str, &[&str], Format); 10] = [
    ("gpkg", &[".gpkg"], Format::GeoPackage),
    ("geojson", &[".geojson", ".json"], Format::GeoJson),
    ("pbf", &[".osm.pbf", ".pbf"], Format::OsmPbf),
    ("osm.gz", &[".osm.gz"], Format::OsmXmlGz),
    ("osm", &[".osm", ".osm.xml"], Format::OsmXml),
    ("glb", &[".glb"], Format::Glb),
    ("obj", &[".obj"], Format::Obj),
    ("svg", &[".svg"], Format::Svg),
    ("png", &[".png"], Format::Png),
    ("tif", &[".tif", ".tiff"], Format::GeoTiff),
];

impl Format {
    /// The names for `--to`.
    pub fn names() -> impl Iterator<Item = &'static str> {
        FORMATS.into_iter().map(|(name, ..)| name)
    }

    /// The format of that name, else of the file's ending.
    pub fn of(path: &Path, to: Option<&str>) -> Result<Self, Problem> {
        let file = path.to_string_lossy().to_lowercase();
        let found = FORMATS.into_iter().find(|(name, endings, _)| match to {
            Some(to) => *name == to,
            None => endings.iter().any(|ending| file.ends_with(ending)),
        });
        found.map(|(.., format)| format).ok_or_else(|| {
            let endings: Vec<&str> =
                FORMATS.into_iter().map(|(_, endings, _)| endings[0]).collect();
            let message = match to {
                Some(to) => format!(
                    "there is no format `{to}`; there are {}",
                    Self::names().collect::<Vec<_>>().join(", ")
                ),
                None => format!(
                    "{}: no format has this ending; take one of {}, or name the format with --to",
                    path.display(),
                    endings.join(" ")
                ),
            };
            Problem::usage(message)
        })
    }

    /// Is it a model in space?
    pub fn is_model(self) -> bool {
        matches!(self, Self::Glb | Self::Obj)
    }

    /// Is it a picture?
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Svg | Self::Png)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_and_names_choose_the_format() {
        let of = |file: &str, to| Format::of(Path::new(file), to).map_err(|p| p.status);
        assert_eq!(of("a.b/City.OSM.PBF", None), Ok(Format::OsmPbf));
        assert_eq!(of("city.osm.gz", None), Ok(Format::OsmXmlGz));
        assert_eq!(of("city.osm", None), Ok(Format::OsmXml));
        assert_eq!(of("city.dat", Some("glb")), Ok(Format::Glb));
        assert_eq!(of("city.dat", None), Err(2));
        assert_eq!(of("city.gpkg", Some("dwg")), Err(2));
    }
}
