//! Ground, water, land use and blocks: surfaces that share no place, so that no viewer has to
//! decide which of two lies on top.

use std::collections::BTreeMap;

use exurb_city::{Area, Block, BlockClass, Parcel, area};
use exurb_geom::{GridPoint, Polygon, SegmentIndex, Vec2, overlay, polyline};
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
/// A cut through the ground reaches this far under its lowest place.
const SOLID_M: f64 = 5.0;

/// Larger lots are not paved, in m².
const LARGEST_YARD_M2: f64 = 4000.0;

/// Water that is shown, joined.
pub struct Waters {
    areas: Vec<Area>,
    bodies: Vec<Body>,
}

/// Areas of water that touch, and how high they stand.
struct Body {
    id: u32,
    polygon: Polygon,
    /// Height of its surface less [`WATER_M`]; `None` where it runs down the ground.
    level_m: Option<f64>,
}

impl Waters {
    /// The water of a site. Ground around standing water is raised to its level.
    pub fn of(site: &mut Site) -> Self {
        let mut areas = clipped(&site.city.water, &rectangle(site));
        if !site.drape.is_flat() {
            areas.iter_mut().for_each(|area| run_on(site, &mut area.polygon));
        }
        // Rings of one class that overlap would shimmer: their union is what is seen. The first
        // area of the union lends its number.
        let mut bodies = Vec::new();
        for polygon in overlay::union(areas.iter().map(|a| &a.polygon)) {
            let inside = |a: &&Area| a.polygon.bounds().intersects(polygon.bounds());
            let area = areas.iter().find(inside);
            let (id, class) = area.map_or((0, ""), |a| (a.id, &*a.class));
            let level_m = level_m(site, &polygon, class);
            if let Some(level_m) = level_m {
                site.drape.raise(&polygon, level_m);
            }
            bodies.push(Body { id, polygon, level_m });
        }
        Self { areas, bodies }
    }
}

/// Water that is cut off at the target's box goes on to the page's edge.
fn run_on(site: &Site, polygon: &mut Polygon) {
    let (inner, outer) = (site.city.target.bounds(), site.bounds);
    let mut pieces = vec![polygon.clone()];
    for (a, b) in polygon.segments() {
        let (a, b) = (a.to_m(), b.to_m());
        let on = |v: f64, w: f64, edge: f64| (v - edge).abs().max((w - edge).abs()) < 0.05;
        let out = match () {
            () if on(a.x, b.x, inner.min.x) => Vec2::new(outer.min.x - inner.min.x, 0.0),
            () if on(a.x, b.x, inner.max.x) => Vec2::new(outer.max.x - inner.max.x, 0.0),
            () if on(a.y, b.y, inner.min.y) => Vec2::new(0.0, outer.min.y - inner.min.y),
            () if on(a.y, b.y, inner.max.y) => Vec2::new(0.0, outer.max.y - inner.max.y),
            () => continue,
        };
        let ring = [a, b, b + out, a + out].map(GridPoint::round).to_vec();
        pieces.extend(Polygon::new(ring, Vec::new()));
    }
    if pieces.len() > 1
        && let Some(joined) = overlay::union(&pieces).into_iter().next()
    {
        *polygon = joined;
    }
}

/// The level of standing water: the middle height of the ground it covers, or of its shore. Rivers
/// stand only where they hardly fall; the sea always does.
fn level_m(site: &Site, polygon: &Polygon, class: &str) -> Option<f64> {
    const STANDS_M: f64 = 4.0;
    if site.drape.is_flat() {
        return Some(0.0);
    }
    let mut heights = site.drape.heights_in(polygon);
    if heights.len() < 4 {
        let shore = polygon.exterior().iter().map(|p| site.drape.height_m(p.to_m()));
        heights = shore.collect();
    }
    heights.sort_by(f64::total_cmp);
    let at = |share: usize| heights[(heights.len() - 1) * share / 10];
    (class == "sea" || at(9) - at(1) <= STANDS_M).then(|| at(4))
}

/// Does the country around go on as water: is a good part of the page's edge standing water?
pub fn is_by_the_sea(site: &Site, waters: &Waters) -> bool {
    const SHARE: usize = 4;
    const PLACES: usize = 200;
    if site.drape.is_flat() {
        return false;
    }
    let edge = polyline::to_m(rectangle(site).exterior());
    let around = [&edge[..], &edge[..1]].concat();
    let step_m = polyline::length(&around) / PLACES as f64;
    let wet = |p: &Vec2| {
        // A little inside, where water is cut off.
        let p = GridPoint::round(p.lerp(site.bounds.center(), 0.001));
        waters.bodies.iter().any(|b| b.level_m.is_some() && b.polygon.contains(p))
    };
    polyline::resample(&around, step_m).iter().filter(|p| wet(p)).count() * SHARE > PLACES
}

/// Height of the lowest ground or water, over the model's origin.
pub fn lowest_m(site: &Site, waters: &Waters) -> f64 {
    if site.drape.is_flat() {
        return GROUND_M;
    }
    let levels = waters.bodies.iter().filter_map(|body| body.level_m).map(|m| m + WATER_M);
    levels.fold(site.drape.lowest_m(&rectangle(site)) + GROUND_M, f64::min)
}

pub fn layers(site: &Site, waters: &Waters) -> Vec<Layer> {
    let city = site.city;
    let page = rectangle(site);
    let land_use = clipped(&city.land_use, &page);
    let wet = Wet::of(&waters.areas);
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
        water_layer(site, waters),
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
        site.drape.lay(&mut part.mesh, site.axes, &piece, GROUND_M, linear(GROUND));
    }
    if !site.drape.is_flat() {
        // The cut through the ground along the page's edge.
        let foot_m = site.drape.lowest_m(page) + GROUND_M - SOLID_M;
        for (a, b) in page.segments() {
            let ends = [a.to_m(), b.to_m()];
            let color = linear(BANK);
            site.drape.wall(&mut part.mesh, site.axes, ends, |_| foot_m, |h| h + GROUND_M, color);
        }
    }
    Layer { name: "ground", parts: vec![part] }
}

fn water_layer(site: &Site, waters: &Waters) -> Layer {
    let mut surface = Part::new(Material::Water);
    let mut banks = Part::new(Material::Plain);
    for Body { id, polygon, level_m } in &waters.bodies {
        surface.begin(*id);
        match level_m {
            Some(level_m) => {
                let (height_m, color) = (level_m + WATER_M, linear(WATER));
                surface.mesh.horizontal(site.axes, polygon, height_m, color, Facing::Up);
            }
            None => site.drape.lay(&mut surface.mesh, site.axes, polygon, WATER_M, linear(WATER)),
        }
        banks.begin(*id);
        for (a, b) in polygon.segments() {
            // Seen from the water: the bank faces inwards.
            let ends = [b.to_m(), a.to_m()];
            let from = |h: f64| level_m.unwrap_or(h) + WATER_M;
            let to = |h: f64| h + GROUND_M;
            site.drape.wall(&mut banks.mesh, site.axes, ends, from, to, linear(BANK));
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
            site.drape.lay(&mut part.mesh, site.axes, piece, LAND_USE_M, color);
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
            let ends = [a.to_m(), b.to_m()];
            let (from, to) = (|h: f64| h + GROUND_M, |h: f64| h + BLOCK_M);
            site.drape.wall(&mut part.mesh, site.axes, ends, from, to, linear(KERB));
        }
    }
    let mut top = |polygon: &Polygon, color| {
        for piece in wet.dry(polygon) {
            site.drape.lay(&mut part.mesh, site.axes, &piece, BLOCK_M, color);
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
