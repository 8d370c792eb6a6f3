//! Laws of blocks, parcels and buildings.

use exurb_geom::{BoxGrid, GridPoint, Polygon, grid, overlap};
use rayon::prelude::*;

use super::{Breach, LawReport, pieces::Pieces};
use crate::{Block, City};

/// Areas up to this are rounding, in m².
const SLACK_M2: f64 = 0.1;
/// Parcels cover their block's ground but for this share.
const TILING_SLACK: f64 = 0.001;

pub fn add_laws(report: &mut LawReport, city: &City, pieces: &Pieces) {
    let blocks = || city.blocks.iter().map(|b| (b.id, &b.polygon));
    report.none_of("invalid_blocks", invalid("invalid_blocks", "blocks", blocks()));
    add_parcel_laws(report, city);
    add_building_laws(report, city, pieces);
}

fn add_parcel_laws(report: &mut LawReport, city: &City) {
    let parcels: Vec<(u32, &Polygon)> = city.parcels.iter().map(|p| (p.id, &p.polygon)).collect();
    let found = invalid("invalid_parcels", "parcels", parcels.iter().copied());
    report.none_of("invalid_parcels", found);
    let (worst, gaps) = tiling(city);
    report.at_most("parcels_tile_block", worst, TILING_SLACK, gaps);
    let found = overlapping("parcels_overlapping", "parcels", &parcels);
    report.none_of("parcels_overlapping", found);

    let lots: Vec<_> = city.parcels.iter().filter(|p| p.block != 0).collect();
    let locked: Vec<Breach> = lots
        .iter()
        .filter(|p| !p.street_access)
        .map(|p| {
            let message = "has no access to a street".to_owned();
            breach("street_access_share", "parcels", p.id, &p.polygon, message)
        })
        .collect();
    let share = (!lots.is_empty()).then(|| 1.0 - locked.len() as f64 / lots.len() as f64);
    report.at_least("street_access_share", share, 0.99, locked);
}

pub fn add_building_laws(report: &mut LawReport, city: &City, pieces: &Pieces) {
    let buildings: Vec<_> = city.buildings.iter().filter(|b| !b.is_part).collect();
    let outlines: Vec<(u32, &Polygon)> = buildings.iter().map(|b| (b.id, &b.polygon)).collect();
    let found = invalid("invalid_buildings", "buildings", outlines.iter().copied());
    report.none_of("invalid_buildings", found);
    let found = overlapping("buildings_overlapping", "buildings", &outlines);
    report.none_of("buildings_overlapping", found);

    let homes = Homes::of(&city.blocks);
    let outside = buildings
        .par_iter()
        .with_min_len(64)
        .filter_map(|b| {
            let (block, area_m2) = homes.outside_m2(b.block, &b.polygon)?;
            let message = format!("{area_m2:.1} m² lie outside block {block}");
            (area_m2 > SLACK_M2)
                .then(|| breach("buildings_outside_block", "buildings", b.id, &b.polygon, message))
        })
        .collect();
    report.none_of("buildings_outside_block", outside);

    let crossed = outlines
        .par_iter()
        .with_min_len(64)
        .filter_map(|(id, polygon)| {
            let street = street_through(pieces, polygon)?;
            let message = format!("street {} runs through it", street + 1);
            Some(breach("buildings_crossed_by_street", "buildings", *id, polygon, message))
        })
        .collect();
    report.none_of("buildings_crossed_by_street", crossed);
}

fn breach(
    law: &'static str,
    layer: &'static str,
    id: u32,
    polygon: &Polygon,
    message: String,
) -> Breach {
    Breach { law, layer, id, at: polygon.exterior()[0], message }
}

fn invalid<'a>(
    law: &'static str,
    layer: &'static str,
    polygons: impl Iterator<Item = (u32, &'a Polygon)>,
) -> Vec<Breach> {
    let polygons: Vec<(u32, &Polygon)> = polygons.collect();
    polygons
        .par_iter()
        .with_min_len(64)
        .filter(|(_, polygon)| !polygon.is_valid())
        .map(|(id, polygon)| {
            breach(law, layer, *id, polygon, "its outline crosses or touches itself".to_owned())
        })
        .collect()
}

/// The polygons that share over 0.1 m² with another.
fn overlapping(
    law: &'static str,
    layer: &'static str,
    polygons: &[(u32, &Polygon)],
) -> Vec<Breach> {
    let boxes = BoxGrid::of(polygons.iter().map(|(_, p)| *p));
    let pairs: Vec<Vec<(usize, usize, f64)>> = (0..polygons.len())
        .into_par_iter()
        .with_min_len(64)
        .map_init(Vec::new, |near, i| {
            boxes.meeting_polygon(polygons[i].1, near);
            near.iter()
                .map(|j| *j as usize)
                .filter(|j| *j > i)
                .map(|j| (i, j, overlap::shared_m2(polygons[i].1, polygons[j].1, SLACK_M2)))
                .filter(|(.., area_m2)| *area_m2 > SLACK_M2)
                .collect()
        })
        .collect();
    let mut partner: Vec<Option<(usize, f64)>> = vec![None; polygons.len()];
    for (i, j, area_m2) in pairs.into_iter().flatten() {
        partner[i].get_or_insert((j, area_m2));
        partner[j].get_or_insert((i, area_m2));
    }
    partner
        .into_iter()
        .enumerate()
        .filter_map(|(i, other)| {
            let (other, area_m2) = other?;
            let (id, polygon) = polygons[i];
            let message = format!("shares {area_m2:.1} m² with {}", polygons[other].0);
            Some(breach(law, layer, id, polygon, message))
        })
        .collect()
}

/// Does a street on the ground run through the polygon? Its index.
fn street_through(pieces: &Pieces, polygon: &Polygon) -> Option<u32> {
    let mut near = Vec::new();
    let inside = |p: GridPoint| {
        polygon.contains(p) && !polygon.segments().any(|(r, s)| grid::on_segment(r, s, p))
    };
    polygon.segments().find_map(|(p, q)| {
        pieces.grid.near(p, q, 0, &mut near);
        near.iter().find_map(|i| {
            let edge = pieces.owners[*i as usize].0;
            let (a, b) = pieces.grid.segment(*i);
            let through = || {
                grid::cross_properly(a, b, p, q)
                    || (grid::intersects(a, b, p, q)
                        && [a, b, GridPoint::round((a.to_m() + b.to_m()) / 2.0)]
                            .into_iter()
                            .any(inside))
            };
            (pieces.level(edge) == 0 && through()).then_some(edge.0)
        })
    })
}

/// The blocks, to look up whose ground a building stands on.
struct Homes<'a> {
    blocks: &'a [Block],
    /// (number, index), ascending.
    by_id: Vec<(u32, usize)>,
    boxes: BoxGrid,
}

impl<'a> Homes<'a> {
    fn of(blocks: &'a [Block]) -> Self {
        let mut by_id: Vec<(u32, usize)> =
            blocks.iter().enumerate().map(|(i, b)| (b.id, i)).collect();
        by_id.sort_unstable();
        Self { blocks, by_id, boxes: BoxGrid::of(blocks.iter().map(|b| &b.polygon)) }
    }

    fn named(&self, id: u32) -> Option<&Block> {
        let at = self.by_id.binary_search_by_key(&id, |(id, _)| *id).ok()?;
        Some(&self.blocks[self.by_id[at].1])
    }

    /// Number of its block and area in m² outside that: the block it names, else the one it mostly
    /// stands on. `None` for a building in no block, as at the edge of a map.
    fn outside_m2(&self, block: u32, polygon: &Polygon) -> Option<(u32, f64)> {
        if let Some(block) = self.named(block) {
            return Some((block.id, overlap::outside_m2(polygon, &block.polygon)));
        }
        let mut near = Vec::new();
        self.boxes.meeting_polygon(polygon, &mut near);
        let area_m2 = polygon.area_m2();
        near.iter()
            .map(|i| &self.blocks[*i as usize])
            .map(|block| (block.id, overlap::outside_m2(polygon, &block.polygon)))
            .filter(|(_, outside)| *outside < area_m2 - SLACK_M2)
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Worst deviation of a block's coverage by its parcels from 1, over blocks that have parcels, and
/// the blocks beyond the slack.
fn tiling(city: &City) -> (Option<f64>, Vec<Breach>) {
    let mut by_block: Vec<(u32, &Polygon)> =
        city.parcels.iter().filter(|p| p.block != 0).map(|p| (p.block, &p.polygon)).collect();
    by_block.sort_by_key(|(block, _)| *block);
    let groups: Vec<&[(u32, &Polygon)]> = by_block.chunk_by(|a, b| a.0 == b.0).collect();
    let homes = Homes::of(&city.blocks);
    let deviations: Vec<(f64, Breach)> = groups
        .par_iter()
        .filter_map(|group| {
            let block = homes.named(group[0].0)?;
            let ground = block.buildable();
            let ground_m2: f64 = ground.iter().map(Polygon::area_m2).sum();
            // Parcels lie apart by the next law, so that their areas add up.
            let covered_m2: f64 = group.iter().map(|(_, p)| p.area_m2()).sum();
            let stray_m2: f64 = group
                .iter()
                .map(|(_, p)| {
                    ground.iter().map(|g| overlap::outside_m2(p, g)).fold(p.area_m2(), f64::min)
                })
                .sum();
            let gap_m2 = (ground_m2 - (covered_m2 - stray_m2)).abs().max(stray_m2);
            let deviation = if ground_m2 > 0.0 { gap_m2 / ground_m2 } else { 1.0 };
            let message = format!("its parcels miss its ground by {:.2} %", deviation * 100.0);
            let against = breach("parcels_tile_block", "blocks", block.id, &block.polygon, message);
            Some((deviation, against))
        })
        .collect();
    let worst = deviations.iter().map(|(d, _)| *d).reduce(f64::max);
    let against = deviations.into_iter().filter(|(d, _)| *d > TILING_SLACK).map(|(_, b)| b);
    (worst, against.collect())
}
