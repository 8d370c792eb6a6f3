//! The block database: the layouts of the blocks of one or more example cities, and an index over their
//! shapes.
//!
//! Source: Hartmann 2018, section 5.1.3. Blocks are compared by their kerb lines: where the streets
//! around differ in width, the paper's centrelines would set the buildings off by half the difference.

mod kind;
mod layout;
mod tidy;

use exurb_city::{Block, City, FeatureShape, Terrain, block};
use exurb_geom::Vec2;
use exurb_match::{Attributes, Database, Entry, Match, Outline, Query, Weights};
use exurb_operation::{Example, Failure, Run};

pub use kind::is_civic;
pub use layout::{Footprint, Layout};

use crate::library::Surroundings;

/// Layouts of example blocks.
#[derive(Debug, Default)]
pub struct BlockDatabase {
    /// The layouts, in order of examples and blocks.
    pub layouts: Vec<Layout>,
    shapes: Database,
}

impl BlockDatabase {
    /// The database of all examples.
    pub fn of(examples: &[Example], run: &Run) -> Result<Self, Failure> {
        let mut layouts = Vec::new();
        for example in examples {
            run.check()?;
            layouts.extend(layouts_of(&example.city, example.weight));
        }
        let entry = |layout: &Layout| Entry {
            outline: Outline::of(&layout.outline),
            attributes: attributes(layout),
        };
        let shapes = Database::new(layouts.iter().map(entry).collect());
        Ok(Self { layouts, shapes })
    }

    /// The layout of one block of a city, empty ones included; `None` for islands and slivers.
    pub fn layout_of(city: &City, blocks: &[Block], at: usize) -> Option<Layout> {
        let features = Surroundings::of(blocks).features(&blocks[at], &city.streets);
        layout::layout_of(city, &blocks[at], features)
    }

    /// The layouts most like a query; see [`Database::query`].
    pub fn query(&self, query: &Query<'_>, serves: impl Fn(&Layout) -> bool) -> Vec<Match> {
        self.shapes.query(query, |id| serves(&self.layouts[id as usize]))
    }

    /// The layout whose block is nearest by size and aspect.
    pub fn nearest(&self, outline: &Outline) -> Option<u32> {
        self.shapes.nearest(outline)
    }

    /// The outline of a layout's block.
    pub fn outline(&self, entry: u32) -> &Outline {
        &self.shapes.entries()[entry as usize].outline
    }
}

fn layouts_of(city: &City, weight: f64) -> Vec<Layout> {
    let derived;
    let blocks = if city.blocks.is_empty() {
        derived = block::derive(&city.streets);
        &derived
    } else {
        &*city.blocks
    };
    let surroundings = Surroundings::of(blocks);
    let features: Vec<_> = blocks.iter().map(|b| surroundings.features(b, &city.streets)).collect();
    layout::layouts_of(city, blocks, &features, weight)
}

fn attributes(layout: &Layout) -> Attributes {
    Attributes {
        relief_m: layout.relief_m.clone(),
        land_use: layout.land_use.clone(),
        density: Some(layout.coverage),
        height_m: layout.height_m,
    }
}

/// Heights of the ground at points; `None` where one is not known.
pub fn relief_m(terrain: &Terrain, points: &[Vec2]) -> Option<Vec<f64>> {
    points.iter().map(|p| terrain.height_m(*p)).collect()
}

/// The weights of a query by shape alone.
pub const BY_SHAPE: Weights =
    Weights { shape: 1.0, relief: 0.0, land_use: 0.0, density: 0.0, height: 0.0 };

/// A point of a feature that tells its block.
pub fn middle(shape: &FeatureShape) -> Vec2 {
    match shape {
        FeatureShape::Point(p) => p.to_m(),
        FeatureShape::Line(line) => line.get(line.len() / 2).map_or(Vec2::ZERO, |p| p.to_m()),
        FeatureShape::Polygon(polygon) => polygon.interior_point(),
    }
}
