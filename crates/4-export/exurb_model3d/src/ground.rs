//! Ground, water, land use and blocks: surfaces that share no place, so that no viewer has to
//! decide which of two lies on top.

use exurb_city::{Area, Block, BlockClass};
use exurb_geom::{GridPoint, Polygon, SegmentIndex, overlay};
use rayon::prelude::*;

use crate::mesh::Facing;
use crate::palette::{self, BANK, GROUND, KERB, PAVEMENT, WATER, linear, scaled, share};
use crate::scene::{Layer, Material, Part, Site};

/// Heights in metres. Carriageways lie at 0, kerbs are 12 cm high; open ground lies a little lower
/// than streets, so that these may overlap it.
pub const BLOCK_M: f64 = 0.12;
pub const GROUND_M: f64 = -0.25;
const LAND_USE_M: f64 = -0.12;
const WATER_M: f64 = -0.8;

pub fn layers(site: &Site) -> Vec<Layer> {
    let city = site.city;
    let page = rectangle(site);
    let water: Vec<Area> = clipped(&city.water, &page);
    let land_use = clipped(&city.land_use, &page);
    let wet = Wet::of(&water);
    let blocks: Vec<Part> =
        city.blocks.par_iter().map(|block| block_part(site, block, &land_use, &wet)).collect();
    let mut all_blocks = Part::new(Material::Plain);
    blocks.iter().for_each(|part| all_blocks.append(part));
    vec![
        ground(site, &page, &wet),
        water_layer(site, &water),
        land_use_layer(site, &land_use, &wet),
        Layer { name: "blocks", parts: vec![all_blocks] },
    ]
}

/// Water, and a way to tell what it does not touch.
struct Wet<'a> {
    areas: &'a [Area],
    shores: SegmentIndex,
}

impl<'a> Wet<'a> {
    fn of(areas: &'a [Area]) -> Self {
        let mut shores = SegmentIndex::new(100.0);
        for (area, i) in areas.iter().zip(0..) {
            area.polygon.segments().for_each(|(a, b)| shores.insert(i, a.to_m(), b.to_m()));
        }
        Self { areas, shores }
    }

    fn polygons(&self) -> impl Iterator<Item = &'a Polygon> + Clone {
        self.areas.iter().map(|a| &a.polygon)
    }

    /// What of a polygon lies on land. Most polygons are far from any shore: they need no overlay.
    fn dry(&self, polygon: &Polygon) -> Vec<Polygon> {
        let near = self.shores.ids(polygon.bounds());
        let corner = polygon.exterior()[0];
        // Areas whose shore is not near hold all of the polygon or none of it.
        let is_sunk = |(area, i): (&Area, u32)| {
            near.binary_search(&i).is_err()
                && area.polygon.bounds().contains(corner.to_m())
                && area.polygon.contains(corner)
        };
        if self.areas.iter().zip(0..).any(is_sunk) {
            return Vec::new();
        }
        overlay::difference(polygon, near.iter().map(|i| &self.areas[*i as usize].polygon))
    }
}

fn rectangle(site: &Site) -> Polygon {
    Polygon::rectangle(GridPoint::round(site.bounds.min), GridPoint::round(site.bounds.max))
}

/// Areas cut at the edge of the page and mended where their rings cross, largest first.
fn clipped(areas: &[Area], page: &Polygon) -> Vec<Area> {
    let bounds = page.bounds();
    let near: Vec<&Area> = areas.iter().filter(|a| a.polygon.bounds().intersects(bounds)).collect();
    let mut out: Vec<Area> = near
        .par_iter()
        .flat_map_iter(|area| {
            let pieces = overlay::intersection(page, &area.polygon);
            pieces.into_iter().map(|polygon| Area { polygon, ..(*area).clone() })
        })
        .collect();
    out.sort_by(|a, b| b.polygon.area_m2().total_cmp(&a.polygon.area_m2()).then(a.id.cmp(&b.id)));
    out
}

fn ground(site: &Site, page: &Polygon, wet: &Wet) -> Layer {
    let mut part = Part::new(Material::Plain);
    part.begin(0);
    for piece in overlay::difference(page, wet.polygons()) {
        part.mesh.horizontal(site.axes, &piece, GROUND_M, linear(GROUND), Facing::Up);
    }
    Layer { name: "ground", parts: vec![part] }
}

fn water_layer(site: &Site, water: &[Area]) -> Layer {
    let mut surface = Part::new(Material::Water);
    let mut banks = Part::new(Material::Plain);
    // Rings of one class that overlap would shimmer: their union is what is seen. The first area
    // of the union lends its number.
    for polygon in overlay::union(water.iter().map(|a| &a.polygon)) {
        let inside = |a: &&Area| a.polygon.bounds().intersects(polygon.bounds());
        let id = water.iter().find(inside).map_or(0, |a| a.id);
        surface.begin(id);
        surface.mesh.horizontal(site.axes, &polygon, WATER_M, linear(WATER), Facing::Up);
        banks.begin(id);
        for (a, b) in polygon.segments() {
            // Seen from the water: the bank faces inwards.
            banks.mesh.wall(site.axes, b.to_m(), a.to_m(), WATER_M, GROUND_M, linear(BANK));
        }
    }
    Layer { name: "water", parts: vec![surface, banks] }
}

/// Open ground between the blocks, or where there are none. Where areas overlap, the smaller one,
/// later in the list, is seen.
fn land_use_layer(site: &Site, land_use: &[Area], wet: &Wet) -> Layer {
    let seen: Vec<Vec<Polygon>> = (0..land_use.len())
        .into_par_iter()
        .map(|i| {
            let above = land_use[i + 1..].iter().map(|a| &a.polygon);
            let seen = overlay::difference(&land_use[i].polygon, above);
            seen.iter().flat_map(|piece| wet.dry(piece)).collect()
        })
        .collect();
    let mut part = Part::new(Material::Plain);
    for (area, pieces) in land_use.iter().zip(&seen) {
        part.begin(area.id);
        let color = linear(palette::ground_of(Some(&area.class)));
        for piece in pieces {
            part.mesh.horizontal(site.axes, piece, LAND_USE_M, color, Facing::Up);
        }
    }
    Layer { name: "land_use", parts: vec![part] }
}

/// Kerb, pavement, and behind it the ground by land use.
fn block_part(site: &Site, block: &Block, land_use: &[Area], wet: &Wet) -> Part {
    let mut part = Part::new(Material::Plain);
    part.begin(block.id);
    for piece in wet.dry(&block.polygon) {
        for (a, b) in piece.segments() {
            part.mesh.wall(site.axes, a.to_m(), b.to_m(), GROUND_M, BLOCK_M, linear(KERB));
        }
    }
    let mut top = |polygon: &Polygon, color| {
        for piece in wet.dry(polygon) {
            part.mesh.horizontal(site.axes, &piece, BLOCK_M, color, Facing::Up);
        }
    };
    if block.class == BlockClass::Island {
        top(&block.polygon, linear(PAVEMENT));
        return part;
    }
    let mut rest = block.buildable();
    for ring in overlay::difference(&block.polygon, &rest) {
        top(&ring, linear(PAVEMENT));
    }
    // The smallest area that covers a place decides: later in the list.
    for area in land_use.iter().rev() {
        if rest.is_empty() || !area.polygon.bounds().intersects(block.polygon.bounds()) {
            continue;
        }
        let color = linear(palette::ground_of(Some(&area.class)));
        let mut left = Vec::new();
        for piece in rest {
            for covered in overlay::intersection(&piece, &area.polygon) {
                top(&covered, color);
            }
            left.extend(overlay::difference(&piece, [&area.polygon]));
        }
        rest = left;
    }
    let tone = 0.92 + 0.12 * share(block.id, 7);
    let color = scaled(linear(palette::ground_of(block.land_use.as_deref())), tone);
    rest.iter().for_each(|piece| top(piece, color));
    part
}
