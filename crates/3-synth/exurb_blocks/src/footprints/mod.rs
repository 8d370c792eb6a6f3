//! `blocks footprints`: stands one building on each parcel, as the example's stand by their streets.
//!
//! No paper. Steps: 1 each block takes after the same example block as its parcels did (crate
//! `library`); 2 lots are walked in order along the kerb, each draws one of the example's buildings of
//! like frontage that goes with the building before: shared walls go on, gaps go on ([`choose`]);
//! 3 the building is put behind the example's setback: in rows it is stretched from border to border,
//! around corners it follows both fronts, elsewhere it keeps its outline and its turn and is scaled a
//! little ([`mod@place`]); 4 what does not fit, lies in water or under a bridge, or would be too small,
//! leaves its lot empty, as do as many lots as in the example where that has all its buildings.
//! Units: metres. Complexity: linear in lots. Each block has its own random stream by place.

mod choose;
mod defaults;
mod error;
mod lot;
mod params;
mod place;
mod row;
#[cfg(test)]
mod tests;

use exurb_city::{Block, Building, City, Edit, Parcel, area, block};
use exurb_geom::{GridPoint, Polygon, SegmentIndex, grid};
use exurb_operation::{Card, Example, Failure, Operation, Rng, Run, Scope, rng};
use rand::RngExt;
use rayon::prelude::*;

pub use error::Error;
pub use params::Params;

use crate::kerb::Kerb;
use crate::lawful::lawful;
use crate::library::{BuildingSample, Donors, ExampleBlock, Library, OpenLand};
use crate::scoped::Scoped;
use lot::Lot;
use place::{Wish, place};

/// The operation.
pub struct Footprints;

impl Operation for Footprints {
    const CARD: Card = Card {
        stage: "blocks",
        method: "footprints",
        summary: "stands one building on each parcel, as the example's stand by their streets",
        source: "own method",
        needs_example: false,
    };
    type Params = Params;
    type Learned = Library;

    fn learn(examples: &[Example], _: &Params, run: &Run) -> Result<Library, Failure> {
        let library = Library::of(examples, run)?;
        if !library.has_buildings {
            run.warn(
                "the example has no buildings; rows of houses stand in small blocks and detached \
                 houses in large ones",
            );
        }
        Ok(library)
    }

    fn describe(learned: &Library) -> serde_json::Value {
        learned.describe_buildings()
    }

    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Library,
        params: &Params,
        run: &Run,
    ) -> Result<Edit, Failure> {
        if city.parcels.is_empty() {
            let (operation, message) = (Self::CARD.name(), Error::NoParcels.to_string());
            return Err(Failure::City { operation, message });
        }
        let scoped = Scoped::of(city, &city.blocks, scope);
        let site = Site::of(city, learned, run);
        let mut lots: Vec<Vec<&Parcel>> = vec![Vec::new(); city.blocks.len()];
        let number: std::collections::BTreeMap<u32, usize> =
            city.blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
        for parcel in city.parcels.iter() {
            if let Some(i) = number.get(&parcel.block) {
                lots[*i].push(parcel);
            }
        }
        let built: Vec<Result<Vec<Building>, Failure>> = city
            .blocks
            .par_iter()
            .zip(lots)
            .map(|(block, lots)| {
                run.check()?;
                let inside = scoped.holds(block.id) && !lots.is_empty();
                Ok(if inside { site.build(block, &lots, params, run) } else { Vec::new() })
            })
            .collect();
        let mut buildings: Vec<Building> =
            city.buildings.iter().filter(|b| !scoped.holds(b.block)).cloned().collect();
        for list in built {
            buildings.extend(list?);
        }
        buildings.sort_by_key(|b| (b.block, b.parcel));
        for (building, id) in buildings.iter_mut().zip(1..) {
            building.id = id;
        }
        let edit = Edit { buildings: Some(buildings), ..Edit::default() };
        Ok(lawful(city, edit, run))
    }
}

/// A block's coverage is aimed at this many times.
const TRIES: usize = 4;
/// Near enough to the example's coverage, as a share of it.
const CLOSE: f64 = 0.08;

/// What all blocks share.
struct Site<'a> {
    city: &'a City,
    donors: Donors<'a>,
    open: OpenLand,
    /// Bridges and the like that pass over blocks.
    over: SegmentIndex,
}

impl<'a> Site<'a> {
    fn of(city: &'a City, learned: &'a Library, run: &Run) -> Self {
        let bounding = block::bounding_edges(&city.streets);
        let mut over = SegmentIndex::new(50.0);
        for (id, edge) in city.streets.edges() {
            if !bounding[id.index()] && !edge.data.tunnel {
                over.insert_line(id.0, &edge.line_m());
            }
        }
        let donors = learned.donors(&city.blocks, run.seed());
        Self { city, donors, open: OpenLand::of(city), over }
    }

    fn build(
        &self,
        block: &Block,
        parcels: &[&Parcel],
        params: &Params,
        run: &Run,
    ) -> Vec<Building> {
        let donors = self.donors.of(block, &self.city.streets);
        let key = rng::place_key(GridPoint::round(block.polygon.centroid()));
        let rng = run.stream(key);
        let fallback = defaults::samples(block);
        let mut samples = choose::samples(&donors);
        if samples.is_empty() {
            samples = fallback.iter().collect();
        }
        let style = Style::of(&donors, &samples, params);
        let lots = in_order(block, parcels);
        let area = block.polygon.area_m2();
        let mut best: Option<(f64, Vec<Building>)> = None;
        let mut growth = 1.0;
        for _ in 0..TRIES {
            let built = self.build_lots(block, &lots, &samples, &style, growth, &mut rng.clone());
            let covered = built.iter().map(|b| b.polygon.area_m2()).sum::<f64>() / area;
            let Some(wanted) = style.coverage else { return built };
            let off = (covered - wanted).abs() / wanted;
            if best.as_ref().is_none_or(|(least, _)| off < *least) {
                best = Some((off, built));
            }
            let next = (growth * (wanted / covered.max(1e-3)).clamp(0.6, 1.6)).clamp(0.5, 3.0);
            if off < CLOSE || (next - growth).abs() < 0.05 {
                break;
            }
            growth = next;
        }
        let mut out = best.map(|(_, built)| built).unwrap_or_default();
        if parcels.iter().any(|p| p.provenance.origin == exurb_city::Origin::Imported) {
            drop_overlaps(&mut out);
        }
        out
    }

    /// Every lot's building when all are `growth` times as large as in the example.
    fn build_lots(
        &self,
        block: &Block,
        lots: &[(&Parcel, Lot)],
        samples: &[&BuildingSample],
        style: &Style,
        growth: f64,
        rng: &mut Rng,
    ) -> Vec<Building> {
        let n = lots.len();
        let joined =
            |k: usize| n > 1 && lots[k].1.ends.1.distance(lots[(k + 1) % n].1.ends.0) < 0.5;
        let walls: Vec<bool> =
            choose::walls(samples, rng).take(n).enumerate().map(|(k, w)| w && joined(k)).collect();
        let open = self.open.near(&block.polygon);
        let is_free = |p: &Polygon| !open.forbids(p) && !self.is_crossed(p);
        let mut out = Vec::new();
        for (k, (parcel, lot)) in lots.iter().enumerate() {
            let empty = rng.random::<f64>() < style.empty_share;
            let depth = lot.depth_at(0.0) + block.pavement_m;
            let walls = (walls[(k + n - 1) % n], walls[k]);
            let chosen = choose::choose(samples, lot, depth, walls, rng);
            let Some(sample) = chosen.filter(|_| !empty) else { continue };
            let wish = style.wish(sample, walls, block.pavement_m, growth);
            let Some(polygon) = place(lot, &wish).filter(is_free) else { continue };
            let mut building = Building::new(0, polygon, parcel.provenance.clone());
            (building.block, building.parcel) = (block.id, parcel.id);
            out.push(building);
        }
        out
    }

    /// Does a bridge or the like pass over the footprint?
    fn is_crossed(&self, polygon: &Polygon) -> bool {
        let mut hit = false;
        self.over.visit(polygon.bounds(), |e| {
            let (c, d) = (GridPoint::round(e.a), GridPoint::round(e.b));
            hit |= polygon.contains(c)
                || polygon.segments().any(|(a, b)| grid::intersects(a, b, c, d));
            !hit
        });
        hit
    }
}

/// What the buildings of one block have in common.
struct Style<'p> {
    params: &'p Params,
    empty_share: f64,
    setback_m: f64,
    /// Share of the block to be covered, where the example tells.
    coverage: Option<f64>,
}

impl<'p> Style<'p> {
    fn of(donors: &[&ExampleBlock], samples: &[&BuildingSample], params: &'p Params) -> Self {
        let learned = donors.first().and_then(|d| d.empty_share).unwrap_or(0.0);
        let empty_share = if params.empty_share < 0.0 { learned } else { params.empty_share };
        let setback_m = crate::library::median(samples.iter().map(|s| s.setback_m));
        let first = donors.first().filter(|d| d.open.is_none() && d.coverage > 0.0);
        let coverage = first.filter(|d| d.empty_share.is_some()).map(|d| d.coverage);
        let coverage = coverage.filter(|_| params.empty_share < 0.0);
        Self { params, empty_share, setback_m, coverage }
    }

    fn wish<'s>(
        &self,
        sample: &'s BuildingSample,
        walls: (bool, bool),
        pavement_m: f64,
        growth: f64,
    ) -> Wish<'s> {
        // Houses in a row keep the building line of their block, give or take a bay window.
        let in_row = walls.0 || walls.1;
        let off_line = (sample.setback_m - self.setback_m).abs();
        let setback = if in_row && off_line < 2.5 { self.setback_m } else { sample.setback_m };
        Wish {
            sample,
            setback_m: (setback * self.params.setback_factor - pavement_m).max(0.0),
            depth_factor: self.params.depth_factor,
            growth,
            wall_before: walls.0,
            wall_after: walls.1,
            min_gap_m: self.params.min_gap,
            min_area_m2: self.params.min_area,
        }
    }
}

/// Lots with a front, in order along the kerb; those of open land are left out.
fn in_order<'p>(block: &Block, parcels: &[&'p Parcel]) -> Vec<(&'p Parcel, Lot)> {
    let kerb = Kerb::of(&block.polygon);
    let mut lots: Vec<(usize, f64, &Parcel, Lot)> = parcels
        .iter()
        .filter(|p| p.land_use.as_deref().is_none_or(|class| !area::is_open(class)))
        .filter_map(|parcel| {
            let lot = Lot::of(&parcel.polygon, kerb.grid(), block.pavement_m)?;
            let (ring, place) = kerb.nearest(lot.ends.0);
            Some((ring, place.at_m, *parcel, lot))
        })
        .collect();
    lots.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.id.cmp(&b.2.id)));
    lots.into_iter().map(|(.., parcel, lot)| (parcel, lot)).collect()
}

/// Imported parcels may overlap; what they carry may not.
fn drop_overlaps(buildings: &mut Vec<Building>) {
    let mut kept: Vec<Building> = Vec::new();
    for building in std::mem::take(buildings) {
        let overlaps = kept.iter().any(|other| {
            let shared = exurb_geom::overlay::intersection(&other.polygon, &building.polygon);
            shared.iter().map(Polygon::area_m2).sum::<f64>() > 0.05
        });
        if !overlaps {
            kept.push(building);
        }
    }
    *buildings = kept;
}
