use exurb_geom::{GridPoint, Polygon};

/// A parameter that names a file: none by default, and in the schema a string with the kind of file.
macro_rules! names_a_file {
    ($($file:ident is $kind:literal;)*) => {$(
        impl Default for $file {
            fn default() -> Self {
                Self::File(String::new())
            }
        }

        impl schemars::JsonSchema for $file {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($file).into()
            }

            fn inline_schema() -> bool {
                true
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({ "type": "string", "x-file": $kind })
            }
        }
    )*};
}

names_a_file! {
    PolygonFile is "polygon";
    StyleMap is "style-map";
    DomainsFile is "domains";
    LinesFile is "lines";
}

/// A polygon that a parameter takes from a file. Recipes and commands name the file; whoever runs the
/// operation reads it first, since operations open no files.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum PolygonFile {
    /// The file's name.
    File(String),
    /// What was read: rings in metres in the city's frame, the outer one first.
    Read {
        /// The rings, open or closed.
        polygon: Vec<Vec<[f64; 2]>>,
    },
}

impl PolygonFile {
    /// Was none given?
    pub fn is_none(&self) -> bool {
        matches!(self, Self::File(name) if name.is_empty())
    }

    /// The polygon; `None` where none was read or it has no area.
    pub fn polygon(&self) -> Option<Polygon> {
        let Self::Read { polygon } = self else { return None };
        of_rings(polygon)
    }
}

/// Which example serves where: areas with the names of examples, or an image over the target whose
/// colours a legend explains. A parameter that takes it from a file, as [`PolygonFile`] does.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum StyleMap {
    /// The file's name.
    File(String),
    /// What was read of polygons.
    Areas {
        /// The areas; of several that hold a place the first counts.
        areas: Vec<StyleArea>,
    },
    /// What was read of an image, which covers the target's box.
    Image {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Colours 0xrrggbb, row by row from the north-west.
        pixels: Vec<u32>,
    },
}

/// Where an example serves.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StyleArea {
    /// Name of the example.
    pub example: String,
    /// The area: rings in metres in the city's frame, the outer one first.
    pub polygon: Vec<Vec<[f64; 2]>>,
}

impl StyleMap {
    /// Was none given?
    pub fn is_none(&self) -> bool {
        matches!(self, Self::File(name) if name.is_empty())
    }
}

impl StyleArea {
    /// The area as a polygon; `None` where it has no area.
    pub fn outline(&self) -> Option<Polygon> {
        of_rings(&self.polygon)
    }
}

fn of_rings(rings: &[Vec<[f64; 2]>]) -> Option<Polygon> {
    let ring = |r: &Vec<[f64; 2]>| r.iter().map(|p| GridPoint::m(p[0], p[1])).collect();
    Polygon::new(ring(rings.first()?), rings[1..].iter().map(ring).collect())
}

/// Areas that a parameter takes from a file: what they are for, and which examples serve there.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum DomainsFile {
    /// The file's name.
    File(String),
    /// What was read.
    Read {
        /// The areas, in the file's order.
        areas: Vec<Domain>,
    },
}

/// An area of a [`DomainsFile`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Domain {
    /// `flat`, `coast`, `mountain`, `park`, `water` or anything else.
    #[serde(rename = "use")]
    pub usage: String,
    /// Names of examples with their weights; none leaves the choice open.
    pub examples: std::collections::BTreeMap<String, f64>,
    /// Kilometres of streets for each square kilometre that an example should have to serve here.
    #[serde(default)]
    pub density: Option<f64>,
    /// Places where growth begins, as `LON,LAT` or `LON,LAT=LON,LAT` with the place in the example.
    #[serde(default)]
    pub starts: Vec<String>,
    /// Rings in metres in the city's frame, the outer one first.
    polygon: Vec<Vec<[f64; 2]>>,
}

/// Lines that a parameter takes from a file, noded where they cross.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum LinesFile {
    /// The file's name.
    File(String),
    /// What was read.
    Read(Lines),
}

/// Lines of a [`LinesFile`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lines {
    /// Longitude and latitude of the place that coordinates count from.
    pub origin: [f64; 2],
    /// Points of each line in metres east and north of the origin.
    pub lines: Vec<Vec<[f64; 2]>>,
}

impl LinesFile {
    /// The lines; `None` where none were read.
    pub fn lines(&self) -> Option<&Lines> {
        match self {
            Self::Read(lines) => Some(lines),
            Self::File(_) => None,
        }
    }
}

impl Domain {
    /// Its outline; `None` where it has no area.
    pub fn polygon(&self) -> Option<Polygon> {
        of_rings(&self.polygon)
    }
}

impl DomainsFile {
    /// The areas; none where none were read.
    pub fn areas(&self) -> &[Domain] {
        match self {
            Self::Read { areas } => areas,
            Self::File(_) => &[],
        }
    }
}
