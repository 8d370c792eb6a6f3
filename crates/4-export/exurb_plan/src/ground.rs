//! Blocks, land use, water and parcels: what everything stands on.

use exurb_city::{Area, BlockClass};

use crate::display::{Mark, Paint, Pen};
use crate::map::Map;

pub fn blocks(map: &Map) -> Vec<Mark> {
    let line = Pen::solid(map.sheet.block_line, map.hair_px());
    let blocks = map.city.blocks.iter();
    let mark = |block: &exurb_city::Block| {
        let shape = map.view.area(&block.polygon)?;
        let by_key = map
            .key
            .land_use(block.land_use.as_deref())
            .or_else(|| map.key.provenance(&block.provenance))
            .map(|c| c.mix(map.sheet.paper, 0.6));
        let by_use = || block.land_use.as_deref().and_then(|name| map.sheet.land_use(name));
        let fill = match block.class {
            BlockClass::Island => map.sheet.block.mix(map.sheet.block_line, 0.5),
            BlockClass::Block => map.sheet.block,
        };
        Some(Mark::new(shape, Paint::both(by_key.or_else(by_use).unwrap_or(fill), line)))
    };
    blocks.filter_map(mark).collect()
}

pub fn land_use(map: &Map) -> Vec<Mark> {
    let mut areas: Vec<&Area> = map.city.land_use.iter().collect();
    // A playground inside a park lies on it.
    areas.sort_by(|a, b| b.polygon.area_m2().total_cmp(&a.polygon.area_m2()).then(a.id.cmp(&b.id)));
    let mark = |area: &Area| {
        let fill = map.base(map.sheet.land_use(&area.class)?);
        Some(Mark::new(map.view.area(&area.polygon)?, Paint::fill(fill)))
    };
    areas.into_iter().filter_map(mark).collect()
}

pub fn water(map: &Map) -> Vec<Mark> {
    let line = Pen::solid(map.base(map.sheet.water_line), map.hair_px());
    let paint = Paint::both(map.base(map.sheet.water), line);
    let shapes = map.city.water.iter().filter_map(|area| map.view.area(&area.polygon));
    shapes.map(|shape| Mark::new(shape, paint)).collect()
}

pub fn parcels(map: &Map) -> Vec<Mark> {
    // Lines closer than a few pixels would only grey the ground.
    if map.view.px(15.0) < 4.0 {
        return Vec::new();
    }
    let line = Pen::solid(map.sheet.parcel_line, map.hair_px());
    let mark = |parcel: &exurb_city::Parcel| {
        let shape = map.view.area(&parcel.polygon)?;
        let by_key = map.key.land_use(parcel.land_use.as_deref());
        let fill = by_key.map(|c| c.mix(map.sheet.paper, 0.5));
        Some(Mark::new(shape, Paint { fill, pen: Some(line) }))
    };
    map.city.parcels.iter().filter_map(mark).collect()
}
