use std::sync::Arc;

use exurb_city::{Block, BlockClass, Building, City, Feature};
use exurb_geom::{BoxGrid, GridPoint, Polygon, Rigid};
use exurb_match::Outline;

use super::relief_m;
use super::tidy::tidied;
use crate::kerb::Kerb;
use crate::library::{Features, OPEN_COVERAGE, OPEN_SHARE, OpenLand};
use crate::outline::plain_outline;
use crate::refine::Why;

/// What stands in a block of an example.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Name of its example.
    pub source: Arc<str>,
    /// Number of its block in the example.
    pub id: u32,
    /// Weight of its example.
    pub weight: f64,
    /// The block.
    pub kerb: Polygon,
    /// Its outer ring without small notches and spikes.
    pub outline: Vec<GridPoint>,
    /// What blocks are compared by before anything stands on them.
    pub features: Features,
    /// Class of open land, where that takes most of the block and next to nothing is built on it.
    pub open: Option<Arc<str>>,
    /// Does the map say that at least half of its ground is open land or water, built on or not?
    pub is_given_open: bool,
    /// Prevailing land use.
    pub land_use: Option<Arc<str>>,
    /// What the block is for; `None` is an ordinary one.
    pub kind: Option<Arc<str>>,
    /// Its buildings, in order of their numbers.
    pub footprints: Vec<Footprint>,
    /// Why buildings of the map are not among them, one each.
    pub flaws: Vec<Why>,
    /// Trees, lamps, playgrounds and the like.
    pub things: Vec<Feature>,
    /// Footprints by area of the block.
    pub coverage: f64,
    /// Mean height of the buildings by footprint, in metres, where known.
    pub height_m: Option<f64>,
    /// Heights of the ground at the samples of the outline, in metres, where known.
    pub relief_m: Option<Vec<f64>>,
}

/// A building of a layout.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// The building as it stands in the example.
    pub building: Building,
    /// The parts that lie in it.
    pub parts: Vec<Building>,
    /// Distance to the kerb in metres; negative where it reaches over it.
    pub clearance_m: f64,
    /// Does it stand on water or open land in the example already?
    pub on_open_land: bool,
}

/// Blocks under this area teach nothing, in m².
const LEAST_BLOCK_M2: f64 = 100.0;
/// A footprint that flaws of the map take more of than this share is left out.
const FLAW_TOLERANCE: f64 = 0.3;

/// The layouts of a city's blocks; islands and slivers are left out, and so are empty blocks, parks too,
/// where the map's buildings are not complete: how many blocks are open it does not tell. Linear in
/// elements.
pub fn layouts_of(
    city: &City,
    blocks: &[Block],
    features: &[Features],
    weight: f64,
) -> Vec<Layout> {
    let open = OpenLand::of(city);
    let homes = homes_of(city, blocks);
    let mut out = Vec::new();
    for ((block, home), features) in blocks.iter().zip(homes).zip(features) {
        let Some(layout) = layout(city, block, home, *features, weight, &open) else { continue };
        if city.metadata.buildings_complete || !layout.footprints.is_empty() {
            out.push(layout);
        }
    }
    out
}

/// The layout of one block; `None` for islands and slivers.
pub fn layout_of(city: &City, block: &Block, features: Features) -> Option<Layout> {
    let home = homes_of(city, std::slice::from_ref(block)).pop()?;
    layout(city, block, home, features, 1.0, &OpenLand::of(city))
}

fn layout(
    city: &City,
    block: &Block,
    home: Home,
    features: Features,
    weight: f64,
    open: &OpenLand,
) -> Option<Layout> {
    if block.class == BlockClass::Island || block.polygon.area_m2() < LEAST_BLOCK_M2 {
        return None;
    }
    let (footprints, flaws) = footprints(city, block, &home.buildings, open);
    let outline = plain_outline(&block.polygon);
    let mut layout = Layout {
        source: city.metadata.name.clone(),
        id: block.id,
        weight,
        kerb: block.polygon.clone(),
        relief_m: city.terrain.as_deref().and_then(|t| relief_m(t, Outline::of(&outline).points())),
        outline,
        features,
        open: None,
        is_given_open: false,
        land_use: block.land_use.clone(),
        kind: None,
        coverage: 0.0,
        height_m: mean_height_m(&footprints),
        footprints,
        flaws,
        things: home.things,
    };
    layout.coverage = layout.built_m2() / block.polygon.area_m2();
    let given = open.share(&block.polygon).filter(|(_, share)| *share >= OPEN_SHARE);
    layout.is_given_open = given.is_some();
    layout.open = given.map(|(class, _)| class).filter(|_| layout.coverage <= OPEN_COVERAGE);
    layout.kind = super::kind::kind_of(&layout);
    Some(layout)
}

impl Layout {
    /// Area of all footprints in m².
    pub fn built_m2(&self) -> f64 {
        self.footprints.iter().map(|f| f.building.polygon.area_m2()).sum()
    }
}

impl Layout {
    /// The layout with everything in it moved. Features keep their place.
    pub fn moved(&self, motion: &Rigid) -> Self {
        let polygon = |p: &Polygon| motion.apply_polygon(p).unwrap_or_else(|| p.clone());
        let building = |b: &Building| Building { polygon: polygon(&b.polygon), ..b.clone() };
        let moved = |p: &GridPoint| GridPoint::round(motion.apply(p.to_m()));
        let mut outline: Vec<GridPoint> = self.outline.iter().map(moved).collect();
        if motion.mirrored {
            // Counter-clockwise again, from the same first point.
            outline[1..].reverse();
        }
        let footprint = |f: &Footprint| Footprint {
            building: building(&f.building),
            parts: f.parts.iter().map(building).collect(),
            ..f.clone()
        };
        Self {
            kerb: polygon(&self.kerb),
            outline,
            footprints: self.footprints.iter().map(footprint).collect(),
            ..self.clone()
        }
    }
}

fn mean_height_m(footprints: &[Footprint]) -> Option<f64> {
    let known = footprints
        .iter()
        .filter_map(|f| Some((f.building.known_height_m()?, f.building.polygon.area_m2())));
    let (sum, area) = known.fold((0.0, 0.0), |(s, a), (h, m2)| (s + h * m2, a + m2));
    (area > 0.0).then(|| sum / area)
}

/// Indices of the buildings, and the features, of a block.
#[derive(Clone, Default)]
struct Home {
    buildings: Vec<u32>,
    things: Vec<Feature>,
}

/// By the numbers of blocks that elements carry, else by a point inside.
fn homes_of(city: &City, blocks: &[Block]) -> Vec<Home> {
    let numbers: std::collections::BTreeMap<u32, usize> =
        blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
    let told = !city.blocks.is_empty();
    let boxes = BoxGrid::of(blocks.iter().map(|b| &b.polygon));
    let mut near = Vec::new();
    let mut home = |number: u32, at: &dyn Fn() -> GridPoint| {
        if told {
            return numbers.get(&number).copied();
        }
        let p = at();
        boxes.meeting(p, p, &mut near);
        near.iter().map(|n| *n as usize).find(|n| blocks[*n].polygon.contains(p))
    };
    let mut out = vec![Home::default(); blocks.len()];
    for (i, b) in city.buildings.iter().enumerate() {
        if let Some(k) = home(b.block, &|| GridPoint::round(b.polygon.interior_point())) {
            out[k].buildings.push(i as u32);
        }
    }
    for thing in city.features.iter() {
        if let Some(k) = home(thing.block, &|| GridPoint::round(super::middle(&thing.shape))) {
            out[k].things.push(thing.clone());
        }
    }
    out
}

fn footprints(
    city: &City,
    block: &Block,
    list: &[u32],
    open: &OpenLand,
) -> (Vec<Footprint>, Vec<Why>) {
    let (parts, whole): (Vec<&Building>, Vec<&Building>) =
        list.iter().map(|i| &city.buildings[*i as usize]).partition(|b| b.is_part);
    let open = open.near(&block.polygon);
    let footprints = whole.into_iter().map(|building| Footprint {
        clearance_m: 0.0,
        on_open_land: open.forbids(&building.polygon),
        building: building.clone(),
        parts: Vec::new(),
    });
    let (mut out, flaws) = tidied(&block.polygon, footprints.collect(), FLAW_TOLERANCE);
    let kerb = Kerb::of(&block.polygon);
    for footprint in &mut out {
        footprint.clearance_m = kerb.clearance_m(&footprint.building.polygon);
    }
    for part in parts {
        let p = GridPoint::round(part.polygon.interior_point());
        // A part without its building stays at home.
        if let Some(whole) = out.iter_mut().find(|f| f.building.polygon.contains(p)) {
            whole.parts.push(part.clone());
        }
    }
    (out, flaws)
}
