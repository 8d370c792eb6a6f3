//! Ground, water, land use and blocks: surfaces that share no place, so that no viewer has to
//! decide which of two lies on top.

use std::collections::BTreeMap;

use exurb_city::{Area, Block, BlockClass, Parcel, area};
use exurb_geom::{GridPoint, Polygon, SegmentIndex, overlay};
use rayon::prelude::*;

use crate::mesh::Facing;
use crate::palette::{
    self, BANK, GREEN_LOTS, GROUND, KERB, Linear, PAVEMENT, WATER, linear, scaled, share,
};
use crate::scene::{Layer, Material, Part, Site};

/// Heights in metres. Carriageways lie at 0, kerbs are 12 cm high; open ground lies a little lower
/// than streets, so that these may overlap it.
pub const BLOCK_M: f64 = 0.12;
pub const GROUND_M: f64 = -0.25;
const LAND_USE_M: f64 = -0.12;
const WATER_M: f64 = -0.8;

/// Larger lots are not paved, in m².
const LARGEST_YARD_M2: f64 = 4000.0;

pub fn layers(site: &Site) -> Vec<Layer> {
    let city = site.city;
    let page = rectangle(site);
    let water: Vec<Area> = clipped(&city.water, &page);
    let land_use = clipped(&city.land_use, &page);
    let wet = Wet::of(&water);
    let mut lots: BTreeMap<u32, Vec<&Parcel>> = BTreeMap::new();
    city.parcels.iter().for_each(|lot| lots.entry(lot.block).or_default().push(lot));
    let of_block = |block: &Block| lots.get(&block.id).map_or(&[][..], |lots| lots);
    let blocks: Vec<Part> = city
        .blocks
        .par_iter()
        .map(|block| block_part(site, block, of_block(block), &land_use, &wet))
        .collect();
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

/// Kerb, pavement, and behind it the ground by land use and lot.
fn block_part(site: &Site, block: &Block, lots: &[&Parcel], land_use: &[Area], wet: &Wet) -> Part {
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
    let inner = block.buildable();
    for ring in overlay::difference(&block.polygon, &inner) {
        top(&ring, linear(PAVEMENT));
    }
    let mut rest = grounds(block, lots, inner);
    // The smallest area that covers a place decides: later in the list.
    for area in land_use.iter().rev() {
        if rest.is_empty() || !area.polygon.bounds().intersects(block.polygon.bounds()) {
            continue;
        }
        let color = linear(palette::ground_of(Some(&area.class)));
        let mut left = Vec::new();
        for (piece, own) in rest {
            for covered in overlay::intersection(&piece, &area.polygon) {
                top(&covered, color);
            }
            let uncovered = overlay::difference(&piece, [&area.polygon]);
            left.extend(uncovered.into_iter().map(|piece| (piece, own)));
        }
        rest = left;
    }
    rest.iter().for_each(|(piece, color)| top(piece, *color));
    part
}

/// The ground behind the pavement: lots in tones of their own where they fill it, else one tone.
fn grounds(block: &Block, lots: &[&Parcel], inner: Vec<Polygon>) -> Vec<(Polygon, Linear)> {
    let tone = |id: u32, spread: f64| 1.0 - spread / 2.0 + spread * share(id, 7);
    let known = block.land_use.as_deref().filter(|class| area::is_open(class));
    let area_m2 = |polygons: &mut dyn Iterator<Item = &Polygon>| -> f64 {
        polygons.map(Polygon::area_m2).sum()
    };
    let inner_m2 = area_m2(&mut inner.iter());
    let lots_m2 = area_m2(&mut lots.iter().map(|lot| &lot.polygon));
    if known.is_none() && (lots_m2 - inner_m2).abs() < 0.02 * inner_m2 {
        let color = |lot: &Parcel| {
            let of_use = lot.land_use.as_deref().filter(|class| area::is_open(class));
            let base = match of_use {
                Some(class) => linear(palette::ground_of(Some(class))),
                // Nobody paves a field.
                None if lot.polygon.area_m2() > LARGEST_YARD_M2 => {
                    palette::pick(&palette::LOTS[..GREEN_LOTS], lot.id, 8)
                }
                None => palette::pick(&palette::LOTS, lot.id, 8),
            };
            scaled(base, tone(lot.id, 0.16))
        };
        return lots.iter().map(|lot| (lot.polygon.clone(), color(lot))).collect();
    }
    let color = linear(palette::ground_of(block.land_use.as_deref()));
    inner.into_iter().map(|piece| (piece, scaled(color, tone(block.id, 0.12)))).collect()
}
