//! The last look at what was placed: whatever still breaks a law of buildings goes.
//!
//! Every block is settled by itself; where two blocks nearly touch, or a street ends in one, what stands
//! in them can still meet. It is rare, so one look in the end is cheaper than care in every block.

use std::collections::BTreeSet;
use std::sync::Arc;

use exurb_city::{City, Edit, Origin};
use exurb_operation::Run;

/// Laws that a building can break by where it stands.
const LAWS: [&str; 3] =
    ["buildings_overlapping", "buildings_crossed_by_street", "buildings_outside_block"];
/// Looks at most: two that overlap are both reported, and one may stay.
const ROUNDS: usize = 6;

/// The edit without placed buildings that break a law; of those that overlap the smaller ones go.
/// Imported buildings stay as they are. O(n log n).
pub fn lawful(city: &City, mut edit: Edit, run: &Run) -> Edit {
    let Some(mut buildings) = edit.buildings.take() else { return edit };
    let own: Vec<u32> = buildings.iter().map(|b| b.id).collect();
    buildings.iter_mut().zip(1..).for_each(|(building, id)| building.id = id);
    let mut checked = edit.clone().apply(city);
    let mut gone = BTreeSet::new();
    checked.buildings = Arc::new(buildings.clone());
    for _ in 0..ROUNDS {
        let report = exurb_city::laws::building_laws(&checked);
        let against = report.breaches.iter().filter(|breach| LAWS.contains(&breach.law));
        // Of two that overlap both are told, so that next time no others need be looked at.
        let involved: BTreeSet<u32> = against.map(|breach| breach.id).collect();
        let is_placed =
            |id: &u32| buildings[*id as usize - 1].provenance.origin != Origin::Imported;
        let broken: BTreeSet<u32> = involved.iter().copied().filter(is_placed).collect();
        if broken.is_empty() {
            break;
        }
        let area = |id: &u32| buildings[*id as usize - 1].polygon.area_m2();
        let mut by_size: Vec<u32> = broken.into_iter().collect();
        by_size.sort_by(|a, b| area(a).total_cmp(&area(b)).then(a.cmp(b)));
        // The smaller half: what these broke with may stand when they have gone.
        by_size.truncate(by_size.len().div_ceil(2));
        run.tally("footprints dropped: they broke a law", by_size.len() as u64);
        gone.extend(by_size);
        let left = involved.iter().filter(|id| !gone.contains(*id));
        checked.buildings = Arc::new(left.map(|id| buildings[*id as usize - 1].clone()).collect());
    }
    buildings.iter_mut().zip(own).for_each(|(building, id)| building.id = id);
    let mut number = 0;
    buildings.retain(|_| {
        number += 1;
        !gone.contains(&number)
    });
    edit.buildings = Some(buildings);
    edit
}
