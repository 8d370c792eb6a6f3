//! Buildings: how high, how roofed, how coloured, where the map does not tell.

use exurb_city::{Building, Roof};
use exurb_geom::{GridPoint, Polygon, SegmentIndex, polyline};
use rayon::prelude::*;

use crate::ground::GROUND_M;
use crate::palette::{Linear, pick, scaled, share};
use crate::roof::{self, Top};
use crate::scene::{Layer, Material, Part, Site};
use crate::shell::Body;

/// Corners nearer than this to the line between their neighbours are left out.
const STRAIGHT_M: f64 = 0.04;
const CHUNK: usize = 256;

/// What a building is for, as far as it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    House,
    Apartments,
    Office,
    Hall,
    Shed,
    Church,
    Unknown,
}

pub fn layer(site: &Site) -> Layer {
    let buildings = shown(site);
    let chunks: Vec<[Part; 3]> = buildings
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut parts = empty();
            chunk.iter().for_each(|b| add(site, b, &mut parts));
            parts
        })
        .collect();
    let mut all = empty();
    // Each chunk is let go as soon as it is joined.
    for chunk in chunks {
        all.iter_mut().zip(&chunk).for_each(|(to, from)| to.append(from));
    }
    Layer { name: "buildings", parts: all.into() }
}

fn empty() -> [Part; 3] {
    [Material::Plain, Material::Windows, Material::Glass].map(Part::new)
}

/// A building to show, what it is used for, and the ground it stands on.
struct Shown<'a> {
    building: &'a Building,
    usage: &'a str,
    /// Its own footprint, or that of the building it is a part of.
    footing: &'a Polygon,
}

/// Parts stand for the building around them where they cover most of it (as OSM's simple 3D
/// buildings are read); else both are shown. Parts are used as that building is.
fn shown<'a>(site: &Site<'a>) -> Vec<Shown<'a>> {
    let all = &site.city.buildings;
    let mut index = SegmentIndex::new(50.0);
    for (part, i) in all.iter().zip(0u32..).filter(|(b, _)| b.is_part) {
        let at = part.polygon.interior_point();
        index.insert(i, at, at);
    }
    let mut usage: Vec<&str> = all.iter().map(|b| b.usage.as_deref().unwrap_or("yes")).collect();
    let mut footings: Vec<&Polygon> = all.iter().map(|b| &b.polygon).collect();
    let mut is_hidden = vec![false; all.len()];
    for (k, building) in all.iter().enumerate().filter(|(_, b)| !b.is_part && !index.is_empty()) {
        let mut covered_m2 = 0.0;
        for i in index.ids(building.polygon.bounds()) {
            let part = &all[i as usize].polygon;
            if building.polygon.contains(GridPoint::round(part.interior_point())) {
                covered_m2 += part.area_m2();
                footings[i as usize] = &building.polygon;
                if usage[i as usize] == "yes" {
                    usage[i as usize] = usage[k];
                }
            }
        }
        is_hidden[k] = covered_m2 > 0.6 * building.polygon.area_m2();
    }
    let near = |b: &Building| b.polygon.bounds().intersects(site.bounds);
    let all = all.iter().zip(usage).zip(footings).zip(is_hidden);
    let listed = all.filter(|(((b, _), _), hidden)| !hidden && near(b));
    listed.map(|(((building, usage), footing), _)| Shown { building, usage, footing }).collect()
}

fn add(site: &Site, shown: &Shown, parts: &mut [Part; 3]) {
    let building = shown.building;
    let Some(polygon) = straightened(&building.polygon) else { return };
    let id = building.id;
    let kind = kind(shown.usage, building);
    let height_m = height_m(building, kind);
    let base_m = building.min_height_m.clamp(0.0, height_m - 0.3);
    let shape = if site.options.roofs { shape(building, kind, height_m) } else { Roof::Flat };
    let foot_m = if base_m > 0.0 { base_m } else { GROUND_M };
    let slope = if kind == Kind::Church { 1.1 } else { roof::slope(shape, share(id, 11)) };
    let top = Top::of(&polygon, shape, base_m, height_m, slope);
    let storeys_m = height_m - base_m;
    let material = match kind {
        _ if !site.options.facades || storeys_m < 2.6 => Material::Plain,
        Kind::Hall | Kind::Shed | Kind::Church => Material::Plain,
        Kind::Office => Material::Glass,
        Kind::Unknown if height_m > 28.0 && !building.is_part && share(id, 12) < 0.5 => {
            Material::Glass
        }
        _ => Material::Windows,
    };
    let (wall, roof) = colors(id, kind, material, !top.faces.is_empty() || shape == Roof::Skillion);
    let body = Body {
        // On the lowest ground, so that no wall hangs in the air.
        axes: site.axes.lifted(site.drape.lowest_m(shown.footing)),
        polygon: &polygon,
        base_m: foot_m,
        top: &top,
        wall,
        roof,
        dice: crate::palette::dice(id, 13),
    };
    let [plain, ..] = parts;
    plain.begin(id);
    body.caps(&mut plain.mesh);
    for part in parts.iter_mut().filter(|part| part.material == material) {
        part.begin(id);
        body.walls(&mut part.mesh, material.is_textured());
    }
}

/// The polygon without corners that nobody sees.
fn straightened(polygon: &Polygon) -> Option<Polygon> {
    let ring = |ring: &[GridPoint]| -> Vec<GridPoint> {
        let mut out = ring.to_vec();
        let mut i = 0;
        while i < out.len() && out.len() > 3 {
            let n = out.len();
            let (a, p, b) = (out[(i + n - 1) % n].to_m(), out[i].to_m(), out[(i + 1) % n].to_m());
            if polyline::nearest_on_segment(a, b, p).0.distance(p) < STRAIGHT_M {
                out.remove(i);
            } else {
                i += 1;
            }
        }
        out
    };
    let holes = polygon.interiors().iter().map(|r| ring(r)).collect();
    Polygon::new(ring(polygon.exterior()), holes).filter(|p| p.area_m2() > 0.5)
}

fn kind(usage: &str, building: &Building) -> Kind {
    match usage {
        "house" | "detached" | "semidetached_house" | "semi" | "terrace" | "bungalow" | "cabin"
        | "farm" | "villa" => Kind::House,
        "apartments" | "residential" | "dormitory" | "hotel" => Kind::Apartments,
        "office" | "commercial" | "bank" | "company" => Kind::Office,
        "industrial" | "warehouse" | "retail" | "supermarket" | "hangar" | "sports_hall"
        | "stadium" | "train_station" | "barn" | "farm_auxiliary" | "parking" => Kind::Hall,
        "garage" | "garages" | "shed" | "hut" | "carport" | "roof" | "kiosk" | "greenhouse"
        | "service" | "toilets" | "transformer_tower" => Kind::Shed,
        "church" | "cathedral" | "chapel" | "place_of_worship" | "temple" | "tower" => Kind::Church,
        _ if building.polygon.area_m2() < 32.0 => Kind::Shed,
        _ => Kind::Unknown,
    }
}

/// Height by tag or storeys, else what is usual for the kind, by a tenth up or down.
fn height_m(building: &Building, kind: Kind) -> f64 {
    let area_m2 = building.polygon.area_m2();
    let usual_m = match kind {
        Kind::House => 7.5,
        Kind::Apartments => 13.0,
        Kind::Office => 18.0,
        Kind::Hall => 8.0,
        Kind::Shed => 3.0,
        Kind::Church => 18.0,
        Kind::Unknown if area_m2 < 220.0 => 8.0,
        Kind::Unknown => 11.0,
    };
    let known_m = building.known_height_m().filter(|h| h.is_finite() && *h > 0.0);
    known_m.unwrap_or(usual_m * (0.9 + 0.2 * share(building.id, 14))).clamp(1.0, 1000.0)
}

/// Roof by tag, else: houses have gables and hips, the large and the high are flat.
fn shape(building: &Building, kind: Kind, height_m: f64) -> Roof {
    let area_m2 = building.polygon.area_m2();
    let pitched = match kind {
        Kind::House => area_m2 < 900.0,
        Kind::Church => true,
        Kind::Apartments | Kind::Unknown => {
            height_m < 21.0 && area_m2 < 700.0 && building.polygon.mean_width_m() < 13.0
        }
        Kind::Hall | Kind::Office | Kind::Shed => false,
    };
    let guess = || match share(building.id, 15) {
        _ if !pitched || building.is_part => Roof::Flat,
        d if kind == Kind::Church || d < 0.72 => Roof::Gabled,
        _ => Roof::Hipped,
    };
    building.roof.unwrap_or_else(guess)
}

/// Colours of wall and roof.
fn colors(id: u32, kind: Kind, material: Material, pitched: bool) -> (Linear, Linear) {
    const HOUSES: [u32; 10] = [
        0xf2ede2, 0xeadfca, 0xe6d3b3, 0xdcc3a0, 0xf0e6d6, 0xd9cfc2, 0xcf9f82, 0xe8c9a8, 0xb9806a,
        0xd3d6d2,
    ];
    const OFFICES: [u32; 6] = [0xd5d9dc, 0xc3c9ce, 0xe3e1dc, 0xb9bdb9, 0xcdc4b6, 0xdfe4e6];
    const HALLS: [u32; 5] = [0xc9c7c1, 0xb7b5ae, 0xd6cfc2, 0xa9adb0, 0xc0a996];
    const CHURCHES: [u32; 3] = [0xd8cdb8, 0xc9b698, 0xb98f74];
    const TILES: [u32; 8] =
        [0x95574a, 0x8a5044, 0xa0624d, 0x7d4a40, 0x6a514b, 0x585554, 0x8f5f50, 0x9a5a44];
    const FLATS: [u32; 6] = [0x9b9892, 0xaaa69e, 0x8c8a86, 0xb7b2a8, 0x7f8182, 0xa39b8c];
    let walls: &[u32] = match kind {
        Kind::Office => &OFFICES,
        Kind::Hall | Kind::Shed => &HALLS,
        Kind::Church => &CHURCHES,
        _ if material == Material::Glass => &OFFICES,
        _ => &HOUSES,
    };
    let roofs: &[u32] = if pitched { &TILES } else { &FLATS };
    let tone = |purpose| 0.9 + 0.14 * share(id, purpose);
    (scaled(pick(walls, id, 21), tone(22)), scaled(pick(roofs, id, 23), tone(24)))
}
