//! What a map shows.

use crate::{ColorBy, Style};

/// Largest width and height of a picture in pixels.
pub const MAX_PX: u32 = 20_000;

/// What a map shows and how large.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Width in pixels, 16 to 20,000; default 2,000. The height follows from the target.
    pub width_px: u32,
    /// Colours and widths.
    pub style: Style,
    /// What colours tell, instead of the style's own.
    pub color_by: Option<ColorBy>,
    /// The themes that are drawn; default all.
    pub layers: Vec<Layer>,
    /// How much is shown around the target's box, in metres; default 0.
    pub margin_m: f64,
    /// Draw scale bar and attribution; default true. (The style `figure` never does. Files name the
    /// attribution in their metadata either way.)
    pub caption: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            width_px: 2000,
            style: Style::default(),
            color_by: None,
            layers: Layer::ALL.to_vec(),
            margin_m: 0.0,
            caption: true,
        }
    }
}

impl Options {
    pub(crate) fn shows(&self, layer: Layer) -> bool {
        self.layers.contains(&layer)
    }
}

/// A theme of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of the city's layers")]
pub enum Layer {
    Blocks,
    LandUse,
    /// Shading of the ground.
    Terrain,
    Water,
    Parcels,
    Buildings,
    Streets,
    /// Service roads and other ways that are no streets for the methods.
    OtherWays,
    Features,
}

impl Layer {
    /// All, from the ground up.
    pub const ALL: [Self; 9] = [
        Self::Blocks,
        Self::LandUse,
        Self::Terrain,
        Self::Water,
        Self::Parcels,
        Self::Buildings,
        Self::Streets,
        Self::OtherWays,
        Self::Features,
    ];

    /// The name in files and options.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Blocks => "blocks",
            Self::LandUse => "land_use",
            Self::Terrain => "terrain",
            Self::Water => "water",
            Self::Parcels => "parcels",
            Self::Buildings => "buildings",
            Self::Streets => "streets",
            Self::OtherWays => "other_ways",
            Self::Features => "features",
        }
    }

    /// The layer of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|l| l.as_str() == name)
    }
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Width out of range.
    #[error("a picture {0} pixels wide cannot be drawn; choose 16 to 20,000")]
    Width(u32),
    /// The picture was drawn and could not be packed.
    #[error("the picture could not be written as PNG: {0}")]
    Png(#[from] png::EncodingError),
}
