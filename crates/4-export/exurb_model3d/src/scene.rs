//! The city as layers of meshes.

use exurb_city::City;
use exurb_geom::{Bounds, Vec2};

use crate::drape::Drape;
use crate::mesh::{Axes, Mesh};
use crate::{Options, buildings, ground, plants, streets};

/// How a surface looks; one draw call for each in a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Material {
    /// Coloured and matt.
    Plain,
    /// Smooth.
    Water,
    /// Walls with single windows.
    Windows,
    /// Walls with bands of glass.
    Glass,
}

impl Material {
    /// All.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Water, Self::Windows, Self::Glass];

    /// The name in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Water => "water",
            Self::Windows => "windows",
            Self::Glass => "glass",
        }
    }

    /// Has it a texture?
    pub fn is_textured(self) -> bool {
        matches!(self, Self::Windows | Self::Glass)
    }
}

/// Meshes of one material, with the element that each stretch of triangles belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// How it looks.
    pub material: Material,
    /// Its triangles, in order of elements.
    pub mesh: Mesh,
    /// Element number and index of its first triangle corner in `mesh.indices`, ascending.
    pub elements: Vec<(u32, u32)>,
}

impl Part {
    /// An empty part.
    pub fn new(material: Material) -> Self {
        Self { material, mesh: Mesh::default(), elements: Vec::new() }
    }

    /// What is added from here on belongs to element `id`.
    pub fn begin(&mut self, id: u32) {
        let at = self.mesh.indices.len() as u32;
        match self.elements.last_mut() {
            Some(last) if last.0 == id => {}
            Some(last) if last.1 == at => last.0 = id,
            _ => self.elements.push((id, at)),
        }
    }

    /// Appends a part of the same material.
    pub fn append(&mut self, other: &Self) {
        let first = self.mesh.indices.len() as u32;
        self.elements.extend(other.elements.iter().map(|(id, at)| (*id, at + first)));
        self.mesh.append(&other.mesh);
    }

    /// Drops a last element that has no triangle.
    fn finish(&mut self) {
        let end = self.mesh.indices.len() as u32;
        self.elements.retain(|(_, at)| *at < end);
    }
}

/// A layer of the city.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its name, that of the city's layer.
    pub name: &'static str,
    /// One part for each material.
    pub parts: Vec<Part>,
}

/// The whole city as meshes.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Layers that hold something, from the ground up.
    pub layers: Vec<Layer>,
    /// The place of the meshes' origin in the city's frame, in metres.
    pub center: Vec2,
    /// The ground that is shown, in the city's frame.
    pub bounds: Bounds,
    /// Height of the origin over the zero of the city's terrain, in metres.
    pub datum_m: f64,
    /// Height of the lowest ground or water, over the origin.
    pub lowest_m: f64,
    /// Goes the country around on as water?
    pub by_the_sea: bool,
}

/// Ground around all that stands in the city, in metres.
const MARGIN_M: f64 = 30.0;

/// The target and what runs past it: streets, the blocks between them, their buildings.
fn extent(city: &City) -> Bounds {
    let corners = city.streets.edges().flat_map(|(_, edge)| edge.line().iter().copied());
    let blocks = city.blocks.iter().map(|block| block.polygon.bounds());
    let buildings = city.buildings.iter().map(|building| building.polygon.bounds());
    let all = Bounds::of(corners).into_iter().chain(blocks).chain(buildings);
    all.fold(city.target.bounds(), Bounds::union)
}

impl Scene {
    /// The meshes of `city`. Works on rayon's current pool; the result does not depend on it.
    pub fn of(city: &City, options: &Options) -> Self {
        let bounds = extent(city).grown(MARGIN_M);
        let center = city.target.bounds().center();
        let center = Vec2::new(center.x.round(), center.y.round());
        let drape = Drape::of(city, bounds, center);
        let axes = Axes { center, lift_m: 0.0 };
        let mut site = Site { city, axes, bounds, options, drape };
        let water = ground::Waters::of(&mut site);
        let (ground, (streets, (buildings, features))) = rayon::join(
            || ground::layers(&site, &water),
            || {
                rayon::join(
                    || streets::layer(&site),
                    || rayon::join(|| buildings::layer(&site), || plants::layers(&site)),
                )
            },
        );
        let mut layers = ground;
        layers.extend([streets, buildings]);
        layers.extend(features);
        for layer in &mut layers {
            layer.parts.iter_mut().for_each(Part::finish);
            layer.parts.retain(|part| !part.mesh.indices.is_empty());
        }
        layers.retain(|layer| !layer.parts.is_empty());
        let lowest_m = ground::lowest_m(&site, &water);
        let by_the_sea = ground::is_by_the_sea(&site, &water);
        Self { layers, center, bounds, datum_m: site.drape.datum_m, lowest_m, by_the_sea }
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.layers.iter().flat_map(|l| &l.parts).map(|p| p.mesh.triangle_count()).sum()
    }
}

/// What every layer needs to build itself.
pub struct Site<'a> {
    pub city: &'a City,
    pub axes: Axes,
    pub bounds: Bounds,
    pub options: &'a Options,
    pub drape: Drape,
}
