//! Buildings: a shadow as long as they are high, then the houses.

use exurb_city::Building;
use exurb_geom::Vec2;

use crate::display::{Mark, Paint, Pen, Px, Shape};
use crate::map::Map;

/// Shadow per metre of height: the sun stands high in the north-west, as on engraved maps.
const SHADOW_PER_M: Vec2 = Vec2::new(0.22, -0.26);
/// Heights over this throw no longer shadow.
const SHADOW_MAX_M: f64 = 60.0;
/// Height of a building of which none is known.
const USUAL_HEIGHT_M: f64 = 8.0;
/// Shadows shorter than this are not seen.
const LEAST_SHADOW_PX: f32 = 0.5;

pub fn draw(map: &Map) -> Vec<Mark> {
    let buildings = || map.city.buildings.iter().filter(|b| !b.is_part);
    let mut marks: Vec<Mark> = buildings().filter_map(|b| shadow(map, b)).collect();
    marks.extend(buildings().filter_map(|b| house(map, b)));
    marks
}

fn house(map: &Map, building: &Building) -> Option<Mark> {
    let shape = map.view.area(&building.polygon)?;
    let sheet = &map.sheet;
    let public = building.usage.as_deref().is_some_and(is_public);
    let own = if public { sheet.public_building } else { sheet.building };
    let fill = map.key.building(building).unwrap_or(map.base(own));
    // Outlines of small houses on a small map would hide the houses.
    let line_px = (map.view.px(0.8)).min(map.hair_px());
    let line = if fill == map.base(own) { map.base(sheet.building_line) } else { fill.shade() };
    let pen = (line_px > 0.2).then(|| Pen::solid(line, line_px));
    Some(Mark::new(shape, Paint { fill: Some(fill), pen }))
}

/// What the footprint sweeps on its way along the shadow, as rings that all turn the same way.
fn shadow(map: &Map, building: &Building) -> Option<Mark> {
    let height_m = building.known_height_m().unwrap_or(USUAL_HEIGHT_M).clamp(0.0, SHADOW_MAX_M);
    let by_m = SHADOW_PER_M * height_m;
    if map.view.px(by_m.length()) < LEAST_SHADOW_PX {
        return None;
    }
    let from = map.view.rings(&building.polygon, Vec2::ZERO)?;
    let mut rings = map.view.rings(&building.polygon, by_m)?;
    let by = [map.view.px(by_m.x), -map.view.px(by_m.y)];
    let moved = |p: Px| [p[0] + by[0], p[1] + by[1]];
    for ring in &from {
        for (i, a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let forward = (b[0] - a[0]) * by[1] - (b[1] - a[1]) * by[0] > 0.0;
            // Rings of the footprint run clockwise in the eyes of a y axis that points down.
            rings.push(if forward {
                vec![*a, moved(*a), moved(b), b]
            } else {
                vec![*a, b, moved(b), moved(*a)]
            });
        }
    }
    rings.extend(from);
    Some(Mark::new(Shape::Area(rings), Paint::fill(map.sheet.building_shadow)))
}

/// Uses that a city map brings out.
fn is_public(usage: &str) -> bool {
    matches!(
        usage,
        "church"
            | "cathedral"
            | "chapel"
            | "mosque"
            | "synagogue"
            | "temple"
            | "place_of_worship"
            | "school"
            | "university"
            | "college"
            | "hospital"
            | "public"
            | "civic"
            | "government"
            | "townhall"
            | "library"
            | "museum"
            | "theatre"
            | "train_station"
            | "stadium"
    )
}
