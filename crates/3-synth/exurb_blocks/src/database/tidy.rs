//! What maps get wrong inside a block: footprints that overlap, cross themselves or reach over the
//! kerb.

use exurb_geom::{BoxGrid, Polygon, overlap, overlay};

use super::Footprint;
use crate::refine::{SLACK_M2, Why};

/// Footprints without flaws, and why each of the others is left out. The larger of two that overlap
/// stays as it is, the smaller loses what they share, as does what reaches over the kerb; one that
/// would lose more than `tolerance` of its area is left out.
pub fn tidied(
    block: &Polygon,
    mut footprints: Vec<Footprint>,
    tolerance: f64,
) -> (Vec<Footprint>, Vec<Why>) {
    let mut flaws = Vec::new();
    let boxes = BoxGrid::of(footprints.iter().map(|f| &f.building.polygon));
    let mut order: Vec<usize> = (0..footprints.len()).collect();
    let area_m2 = |f: &Footprint| f.building.polygon.area_m2();
    order.sort_by(|i, j| {
        area_m2(&footprints[*j]).total_cmp(&area_m2(&footprints[*i])).then(i.cmp(j))
    });
    let mut stands = vec![false; footprints.len()];
    let mut near = Vec::new();
    for i in order {
        boxes.meeting_polygon(&footprints[i].building.polygon, &mut near);
        let larger = near.iter().map(|j| *j as usize).filter(|j| stands[*j]);
        let larger: Vec<&Polygon> = larger.map(|j| &footprints[j].building.polygon).collect();
        match tidy(block, &footprints[i].building.polygon, &larger, tolerance) {
            Ok(None) => stands[i] = true,
            Ok(Some(polygon)) => {
                footprints[i].building.polygon = polygon;
                stands[i] = true;
            }
            Err(why) => flaws.push(why),
        }
    }
    let mut stands = stands.into_iter();
    footprints.retain(|_| stands.next().unwrap_or(false));
    (footprints, flaws)
}

/// The footprint less its flaws; `None` where it has none.
fn tidy(
    block: &Polygon,
    polygon: &Polygon,
    larger: &[&Polygon],
    tolerance: f64,
) -> Result<Option<Polygon>, Why> {
    let mut out = polygon.clone();
    let first = |polygons: Vec<Polygon>| polygons.into_iter().next();
    if !polygon.is_valid() {
        out = first(overlay::repair(polygon)).ok_or(Why::Shape)?;
    }
    if overlap::outside_m2(&out, block) > SLACK_M2 {
        out = first(overlay::intersection(&out, block)).ok_or(Why::Street)?;
    }
    let in_the_way: Vec<&Polygon> = larger
        .iter()
        .copied()
        .filter(|l| overlap::shared_m2(&out, l, SLACK_M2) > SLACK_M2)
        .collect();
    let why = if in_the_way.is_empty() { Why::Street } else { Why::Neighbour };
    if !in_the_way.is_empty() {
        out = first(overlay::difference(&out, in_the_way)).ok_or(why)?;
    }
    if out == *polygon {
        return Ok(None);
    }
    let enough = out.area_m2() >= polygon.area_m2() * (1.0 - tolerance) && out.is_valid();
    if enough { Ok(Some(out)) } else { Err(why) }
}
