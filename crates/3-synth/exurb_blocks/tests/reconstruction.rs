//! Hartmann 2018, figure 5.7: blocks emptied and filled again from their own city get their buildings
//! back.

#![allow(clippy::print_stdout, reason = "the figures of docs/blocks.md")]

mod shared;

use std::collections::BTreeMap;
use std::sync::Arc;

use exurb_blocks::auto::Auto;
use exurb_blocks::transfer::Transfer;
use exurb_city::{BlockClass, Building, City};
use exurb_geom::{BoxGrid, overlap};
use exurb_operation::{Example, Operation, Run, Scope, erase};

/// Corners that come back this near are back, in millimetres.
const NEAR_MM: i32 = 10;

/// Does some building of the other city stand where `building` does?
fn is_back(building: &Building, others: &[Building], boxes: &BoxGrid) -> bool {
    let mut near = Vec::new();
    boxes.meeting_polygon(&building.polygon, &mut near);
    near.iter().map(|i| &others[*i as usize]).any(|other| {
        let (a, b) = (building.polygon.exterior(), other.polygon.exterior());
        let at = |k: usize| {
            (0..a.len()).all(|i| {
                let (p, q) = (a[i], b[(i + k) % b.len()]);
                (p.x - q.x).abs() <= NEAR_MM && (p.y - q.y).abs() <= NEAR_MM
            })
        };
        a.len() == b.len() && (0..b.len()).any(at)
    })
}

/// Which buildings share over 0.1 m² with another?
fn overlapping(buildings: &[&Building]) -> Vec<bool> {
    let boxes = BoxGrid::of(buildings.iter().map(|b| &b.polygon));
    let mut near = Vec::new();
    (0..buildings.len())
        .map(|i| {
            boxes.meeting_polygon(&buildings[i].polygon, &mut near);
            near.iter().map(|j| *j as usize).filter(|j| *j != i).any(|j| {
                overlap::shared_m2(&buildings[i].polygon, &buildings[j].polygon, 0.1) > 0.1
            })
        })
        .collect()
}

/// The city, its blocks emptied and filled from itself.
fn refilled<O: Operation + 'static>(city: &City) -> City {
    let examples = [Example::new(city.clone())];
    let is_filled =
        |b: &Building| b.block != 0 && city.blocks[b.block as usize - 1].class == BlockClass::Block;
    let rest = city.buildings.iter().filter(|b| !is_filled(b)).cloned().collect();
    let emptied = City { buildings: Arc::new(rest), ..city.clone() };
    let params = serde_json::Value::Null;
    let made = erase::<O>().run(&emptied, &Scope::All, &examples, params, &Run::new(1));
    made.expect("the map has blocks").city
}

/// Share of all footprints that stand where they stood.
fn kept(city: &City, made: &City) -> f64 {
    let boxes = BoxGrid::of(made.buildings.iter().map(|b| &b.polygon));
    let whole: Vec<&Building> = city.buildings.iter().filter(|b| !b.is_part).collect();
    let back = whole.iter().filter(|b| is_back(b, &made.buildings, &boxes)).count();
    back as f64 / whole.len() as f64
}

#[test]
fn blocks_filled_from_their_own_city_get_their_buildings_back() {
    let Some(folder) = shared::folder() else { return };
    for name in shared::COMPLETE {
        let city = shared::city(&folder, name);
        let made = refilled::<Transfer>(&city);
        let whole: Vec<&Building> = city.buildings.iter().filter(|b| !b.is_part).collect();
        let boxes = BoxGrid::of(made.buildings.iter().map(|b| &b.polygon));
        let overlapping = overlapping(&whole);
        let (mut counted, mut back, mut all_back) = (0u32, 0u32, 0u32);
        let mut missing: BTreeMap<&str, usize> = BTreeMap::new();
        for (building, overlaps) in whole.iter().zip(overlapping) {
            let is_back = is_back(building, &made.buildings, &boxes);
            all_back += u32::from(is_back);
            let over_kerb = building.block != 0
                && overlap::outside_m2(
                    &building.polygon,
                    &city.blocks[building.block as usize - 1].polygon,
                ) > 0.1;
            let reason = match (building.block, overlaps) {
                (0, _) => "in no block",
                (_, true) => "overlaps another",
                _ if over_kerb => "reaches over a kerb",
                _ => "beside one that does",
            };
            if building.block != 0 && !overlaps {
                counted += 1;
                back += u32::from(is_back);
            }
            if !is_back {
                *missing.entry(reason).or_default() += 1;
            }
        }
        let share = f64::from(back) / f64::from(counted);
        let all = f64::from(all_back) / whole.len() as f64;
        let by_auto = kept(&city, &refilled::<Auto>(&city));
        println!(
            "| {name} | {counted} | {:.2} | {} | {:.2} | {:.2} | {} |",
            100.0 * share,
            whole.len(),
            100.0 * all,
            100.0 * by_auto,
            missing.iter().map(|(why, n)| format!("{n} {why}")).collect::<Vec<_>>().join(", "),
        );
        assert!(share >= 0.98, "{name}: {share} of {counted}");
        assert!(all >= 0.95, "{name}: {all} of all");
        assert!(by_auto >= 0.95, "{name}: {by_auto} of all by auto");
    }
}
