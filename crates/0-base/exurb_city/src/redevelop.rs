//! New streets in a part of a city: what stands elsewhere stays.

use std::collections::BTreeMap;

use exurb_geom::{GridPoint, Polygon, Vec2, overlay};

use crate::{Area, Block, Building, City, Edit, FeatureShape, StreetGraph, block, placing};

/// The edit that gives `city` these streets, which differ from its own inside `area` only. Blocks that
/// are the same afterwards keep what they are and their parcels; buildings and features outside `area`
/// stay; what lay inside goes, land use too, and what reaches inside from a block that changes.
pub fn redevelop(city: &City, streets: StreetGraph, area: &Polygon) -> Edit {
    let key =
        |block: &Block| (block.polygon.exterior().to_vec(), block.polygon.interiors().to_vec());
    let before: BTreeMap<_, &Block> = city.blocks.iter().map(|b| (key(b), b)).collect();
    let mut blocks = block::derive(&streets);
    let mut unchanged: BTreeMap<u32, u32> = BTreeMap::new();
    for block in &mut blocks {
        if let Some(old) = before.get(&key(block)) {
            unchanged.insert(old.id, block.id);
            block.land_use.clone_from(&old.land_use);
            block.pavement_m = old.pavement_m;
            block.provenance = old.provenance.clone();
        }
    }
    let is_outside = |p: Vec2| !area.contains(GridPoint::round(p));
    let mut parcels: Vec<_> =
        city.parcels.iter().filter(|p| unchanged.contains_key(&p.block)).cloned().collect();
    let stays = |b: &&Building| {
        let reaches_in = || b.polygon.exterior().iter().any(|p| area.contains(*p));
        is_outside(b.polygon.interior_point())
            && (unchanged.contains_key(&b.block) || !reaches_in())
    };
    let mut buildings: Vec<_> = city.buildings.iter().filter(stays).cloned().collect();
    let mut features: Vec<_> = city
        .features
        .iter()
        .filter(|feature| {
            is_outside(match &feature.shape {
                FeatureShape::Point(p) => p.to_m(),
                FeatureShape::Line(line) => line.first().map_or(Vec2::ZERO, |p| p.to_m()),
                FeatureShape::Polygon(polygon) => polygon.interior_point(),
            })
        })
        .cloned()
        .collect();
    placing::place(&blocks, &mut parcels, &mut buildings, &mut features);
    let outside = city.land_use.iter().flat_map(|land| {
        let pieces = overlay::difference(&land.polygon, [area]).into_iter();
        pieces.map(|polygon| Area { id: 0, polygon, class: land.class.clone() })
    });
    let mut land_use: Vec<Area> = outside.collect();
    land_use.iter_mut().zip(1..).for_each(|(land, id)| land.id = id);
    Edit {
        streets: Some(streets),
        blocks: Some(blocks),
        parcels: Some(parcels),
        buildings: Some(buildings),
        features: Some(features),
        land_use: Some(land_use),
        ..Edit::default()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use exurb_geom::Frame;

    use super::*;
    use crate::{Origin, Provenance, Street, street_graph};

    fn rectangle(x: f64, y: f64, to_x: f64, to_y: f64) -> Polygon {
        Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(to_x, to_y))
    }

    #[test]
    fn what_reaches_into_new_streets_goes_and_land_use_ends_at_them() {
        let line = |points: &[(f64, f64)]| {
            let points = points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect::<Vec<_>>();
            (points, Street::default())
        };
        // Two blocks beside each other; later a street parts the right one.
        let around = [
            line(&[(100.0, 0.0), (0.0, 0.0), (0.0, 100.0), (100.0, 100.0)]),
            line(&[(100.0, 0.0), (100.0, 100.0)]),
            line(&[(100.0, 0.0), (150.0, 0.0)]),
            line(&[(150.0, 0.0), (200.0, 0.0), (200.0, 100.0), (150.0, 100.0)]),
            line(&[(150.0, 100.0), (100.0, 100.0)]),
        ];
        let parting = line(&[(150.0, 0.0), (150.0, 100.0)]);
        let whole = rectangle(-10.0, -10.0, 210.0, 110.0);
        let mut city = City::empty(Frame::null_island(), whole.clone());
        city.streets = Arc::new(street_graph::from_lines(around.clone()));
        city.blocks = Arc::new(block::derive(&city.streets));
        city.land_use =
            Arc::new(vec![Area { id: 1, polygon: whole.clone(), class: "park".into() }]);
        let houses = [
            rectangle(85.0, 40.0, 95.0, 50.0),
            rectangle(110.0, 40.0, 118.0, 50.0),
            rectangle(112.0, 60.0, 135.0, 70.0),
            rectangle(145.0, 40.0, 155.0, 50.0),
        ];
        let mut buildings: Vec<Building> = (1..)
            .zip(houses.clone())
            .map(|(id, p)| Building::new(id, p, Provenance::of(Origin::Imported)))
            .collect();
        placing::place(&city.blocks, &mut [], &mut buildings, &mut []);
        city.buildings = Arc::new(buildings);

        // It reaches into the left block, whose streets stay, and up to the third house.
        let area = rectangle(92.0, 5.0, 190.0, 95.0);
        let far = rectangle(125.0, 5.0, 190.0, 95.0);
        for (area, left) in [(area, vec![0]), (far, vec![0, 1])] {
            let streets = street_graph::from_lines(around.iter().cloned().chain([parting.clone()]));
            let edit = redevelop(&city, streets, &area);
            let stand: Vec<Polygon> =
                edit.buildings.unwrap().into_iter().map(|b| b.polygon).collect();
            let wanted: Vec<Polygon> = left.iter().map(|i: &usize| houses[*i].clone()).collect();
            assert_eq!(stand, wanted);
            let park: f64 = edit.land_use.unwrap().iter().map(|a| a.polygon.area_m2()).sum();
            assert!((park - whole.area_m2() + area.area_m2()).abs() < 1e-6, "{park}");
        }
    }
}
