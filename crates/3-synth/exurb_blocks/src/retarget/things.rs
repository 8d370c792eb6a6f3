//! Trees and other features of a layout that is laid out anew: repeated and dropped with the element
//! they stand by, the others carried by the guidance map.

use exurb_city::Feature;
use exurb_geom::{GridPoint, Polygon, Rigid};

use super::{Correspondence, Placement, Source};
use crate::database::{Layout, middle};
use crate::lay::Wish;

/// A feature within this distance of a building stands by it, in metres.
const BESIDE_M: f64 = 12.0;

/// Where the features of `layout` go when its elements are placed as `placed`.
pub fn things<'a>(
    layout: &'a Layout,
    source: &Source,
    placed: &[Placement],
    domain: &Polygon,
    outline: &[GridPoint],
    link: &Correspondence,
) -> Vec<Wish<'a, Feature>> {
    let mut out = Vec::new();
    let mut loose = Vec::new();
    for what in &layout.things {
        let at = middle(&what.shape);
        let near = (0..layout.footprints.len())
            .map(|i| (distance_m(&layout.footprints[i].building.polygon, at), i))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match near.filter(|(distance_m, _)| *distance_m <= BESIDE_M) {
            Some((_, i)) => {
                let of_building = placed.iter().filter(|p| p.members.contains(&i));
                out.extend(of_building.map(|p| Wish { what, motion: p.motion }));
            }
            None => loose.push((what, at)),
        }
    }
    let points: Vec<_> = loose.iter().map(|(_, at)| *at).collect();
    let carried = source.carried(domain, outline, link, &points);
    out.extend(loose.into_iter().zip(carried).map(|((what, at), to)| {
        let shift = Rigid { shift: to - at, ..Rigid::IDENTITY };
        Wish { what, motion: shift.into() }
    }));
    out
}

fn distance_m(polygon: &Polygon, p: exurb_geom::Vec2) -> f64 {
    if polygon.contains(GridPoint::round(p)) { 0.0 } else { polygon.boundary_distance_m(p) }
}
