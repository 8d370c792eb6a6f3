//! What becomes of blocks, and the edit that writes it.

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_city::{Area, Block, Building, City, Edit, Feature, Parcel, Provenance, area};
use exurb_geom::{GridPoint, Polygon, RowSides, offset, spikes};

use crate::kerb::Kerb;
use crate::parcels::{ACCESS_M, Holding, cadastre};

/// What becomes of one block.
#[derive(Clone, Debug, Default)]
pub struct Filling {
    /// New buildings and parts; block and number are written later.
    pub buildings: Vec<Building>,
    /// New parcels, numbered from 1 for the buildings to name.
    pub parcels: Vec<Parcel>,
    /// New features; likewise.
    pub things: Vec<Feature>,
    /// New open land.
    pub open: Vec<(Polygon, Arc<str>)>,
    /// Prevailing land use.
    pub land_use: Option<Arc<str>>,
    /// Pavement, in metres.
    pub pavement_m: f64,
    /// Where the filling came from.
    pub provenance: Provenance,
}

/// The edit that fills blocks: elements of filled blocks are replaced, all others stay; buildings and
/// parcels are numbered block by block.
pub fn written(city: &City, mut blocks: Vec<Block>, fillings: Vec<Option<Filling>>) -> Edit {
    let mut filled: Vec<u32> =
        blocks.iter().zip(&fillings).filter(|(_, f)| f.is_some()).map(|(b, _)| b.id).collect();
    filled.sort_unstable();
    let stays = |block: u32| filled.binary_search(&block).is_err();
    let mut buildings: Vec<Building> =
        city.buildings.iter().filter(|b| stays(b.block)).cloned().collect();
    let mut parcels: Vec<Parcel> =
        city.parcels.iter().filter(|p| stays(p.block)).cloned().collect();
    let mut things: Vec<Feature> =
        city.features.iter().filter(|f| stays(f.block)).cloned().collect();
    let mut land_use: Vec<Area> = city.land_use.to_vec();
    let mut next_area = land_use.iter().map(|a| a.id).max().unwrap_or(0) + 1;
    let mut first_parcel = parcels.iter().map(|p| p.id).max().unwrap_or(0);
    for (block, filling) in blocks.iter_mut().zip(fillings) {
        let Some(filling) = filling else { continue };
        block.pavement_m = filling.pavement_m;
        block.land_use = filling.land_use;
        block.provenance = filling.provenance;
        let home = block.id;
        let parcel = |id: u32| if id == 0 { 0 } else { id + first_parcel };
        let building = |b: Building| Building { block: home, parcel: parcel(b.parcel), ..b };
        buildings.extend(filling.buildings.into_iter().map(building));
        let lot = |p: Parcel| Parcel { block: home, id: parcel(p.id), ..p };
        parcels.extend(filling.parcels.into_iter().map(lot));
        first_parcel = parcels.iter().map(|p| p.id).max().unwrap_or(0);
        things.extend(filling.things.into_iter().map(|f| Feature { block: home, ..f }));
        for (polygon, class) in filling.open {
            land_use.push(Area { id: next_area, polygon, class });
            next_area += 1;
        }
    }
    number(&mut parcels, &mut buildings);
    things.sort_by_key(|f| f.block);
    things.iter_mut().zip(1..).for_each(|(thing, id)| thing.id = id);
    Edit {
        blocks: Some(blocks),
        parcels: Some(parcels),
        buildings: Some(buildings),
        features: Some(things),
        land_use: Some(land_use),
        ..Edit::default()
    }
}

/// Corners of footprints sharper than this are what fitting, cutting and moving walls left over, 6°.
pub const SHARP_RAD: f64 = 0.1;
/// Cracks in them are filled where that adds no more, in m².
const CRACK_M2: f64 = 0.05;

/// Takes spikes and cracks without width off footprints.
pub fn trim(buildings: &mut [Building]) {
    for building in buildings {
        let trimmed = spikes::without_spikes(&building.polygon, SHARP_RAD, CRACK_M2);
        if let Some(trimmed) = trimmed.filter(Polygon::is_valid) {
            building.polygon = trimmed;
        }
    }
}

impl Filling {
    /// Cuts the block's ground into parcels around the buildings; the pavement is as narrow as the
    /// building nearest to the kerb needs. Ground without buildings is one parcel.
    pub fn with_cadastre(mut self, block: &Block, most_pavement_m: f64) -> Self {
        let kerb = Kerb::of(&block.polygon);
        let whole: Vec<usize> =
            (0..self.buildings.len()).filter(|i| !self.buildings[*i].is_part).collect();
        let clearance =
            |i: &usize| kerb.clearance_up_to_m(most_pavement_m, &self.buildings[*i].polygon);
        let least_m = whole.iter().map(clearance).fold(most_pavement_m, f64::min);
        // In whole centimetres, rounded down.
        self.pavement_m = (least_m.max(0.0) * 100.0).floor() / 100.0;
        let mut parcel = vec![0; self.buildings.len()];
        for ground in offset::inset(&block.polygon, self.pavement_m) {
            let sides = RowSides::new(&ground);
            let on = |i: &&usize| {
                sides.contains(GridPoint::round(self.buildings[**i].polygon.interior_point()))
            };
            let here: Vec<usize> = whole.iter().filter(on).copied().collect();
            let footprints: Vec<&Polygon> =
                here.iter().map(|i| &self.buildings[*i].polygon).collect();
            for Holding { lot, footprints } in cadastre(&ground, &footprints) {
                let id = self.parcels.len() as u32 + 1;
                footprints.iter().for_each(|k| parcel[here[*k]] = id);
                self.parcels.push(Parcel {
                    id,
                    block: block.id,
                    street_access: lot.frontage_m >= ACCESS_M,
                    land_use: self.land_use.clone().filter(|class| area::is_open(class)),
                    polygon: lot.polygon,
                    provenance: self.provenance.clone(),
                });
            }
        }
        // Parts follow the building before them.
        let mut last = 0;
        for (building, parcel) in self.buildings.iter_mut().zip(parcel) {
            last = if building.is_part { last } else { parcel };
            building.parcel = last;
        }
        self
    }
}

/// Numbers parcels and buildings block by block; buildings follow their parcels.
fn number(parcels: &mut [Parcel], buildings: &mut [Building]) {
    number_parcels(parcels, buildings);
    buildings.sort_by_key(|b| b.block);
    buildings.iter_mut().zip(1..).for_each(|(building, id)| building.id = id);
}

/// Numbers parcels block by block; buildings follow theirs. New parcels that no building names yet have
/// the number 0.
pub fn number_parcels(parcels: &mut [Parcel], buildings: &mut [Building]) {
    parcels.sort_by_key(|p| p.block);
    let known = parcels.iter().zip(1..).filter(|(p, _)| p.id != 0);
    let renumbered: BTreeMap<u32, u32> = known.map(|(p, id)| (p.id, id)).collect();
    parcels.iter_mut().zip(1..).for_each(|(parcel, id)| parcel.id = id);
    for building in buildings {
        building.parcel = renumbered.get(&building.parcel).copied().unwrap_or(0);
    }
}
