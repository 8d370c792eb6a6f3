//! The outline of a block without what is too small to lie along.

use exurb_geom::{GridPoint, Polygon, offset, overlay};

/// Notches and spikes narrower than twice this go, in metres: stubs of dead ends.
const RADIUS_M: f64 = 5.0;
/// What is larger stays: a dead end with houses along it. In m².
const MOST_M2: f64 = 220.0;

/// The outer ring of `block` without small notches and spikes, counter-clockwise. O(outline).
pub fn plain_outline(block: &Polygon) -> Vec<GridPoint> {
    let outer = Polygon::new(block.exterior().to_vec(), Vec::new());
    let Some(outer) = outer else { return block.exterior().to_vec() };
    let filled = closed(&outer, RADIUS_M).unwrap_or(outer);
    let plain = opened(&filled, RADIUS_M).unwrap_or(filled);
    plain.exterior().to_vec()
}

/// With small notches filled; `None` where there are none.
fn closed(block: &Polygon, radius_m: f64) -> Option<Polygon> {
    let grown = first(offset::inset(block, -radius_m))?;
    let whole = Polygon::new(grown.exterior().to_vec(), Vec::new())?;
    let closed = first(offset::inset(&whole, radius_m))?;
    let notches: Vec<Polygon> =
        overlay::difference(&closed, [block]).into_iter().filter(is_small).collect();
    if notches.is_empty() {
        return None;
    }
    first(overlay::union(notches.iter().chain([block])))
}

/// With small spikes cut off; `None` where there are none.
fn opened(block: &Polygon, radius_m: f64) -> Option<Polygon> {
    let opened: Vec<Polygon> = offset::inset(block, radius_m)
        .iter()
        .flat_map(|shrunk| offset::inset(shrunk, -radius_m))
        .collect();
    if opened.is_empty() {
        return None;
    }
    let spikes: Vec<Polygon> =
        overlay::difference(block, &opened).into_iter().filter(is_small).collect();
    if spikes.is_empty() {
        return None;
    }
    first(overlay::difference(block, &spikes))
}

/// Neither rounding nor too large.
fn is_small(piece: &Polygon) -> bool {
    (0.5..=MOST_M2).contains(&piece.area_m2())
}

fn first(polygons: Vec<Polygon>) -> Option<Polygon> {
    polygons.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[(f64, f64)]) -> Polygon {
        let ring = corners.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
        Polygon::new(ring, vec![]).expect("has area")
    }

    #[test]
    fn a_stub_goes_and_a_street_with_houses_stays() {
        let stub = [
            (0., 0.),
            (47., 0.),
            (47., 15.),
            (53., 15.),
            (53., 0.),
            (100., 0.),
            (100., 60.),
            (0., 60.),
        ];
        let plain = Polygon::new(plain_outline(&polygon(&stub)), vec![]).expect("has area");
        assert!((plain.area_m2() - 6000.0).abs() < 1.0, "{}", plain.area_m2());
        let street = stub.map(|(x, y)| (x, if y == 15. { 45. } else { y }));
        let plain = Polygon::new(plain_outline(&polygon(&street)), vec![]).expect("has area");
        assert!((plain.area_m2() - 5730.0).abs() < 3.0, "{}", plain.area_m2());
    }

    #[test]
    fn a_spike_goes_and_a_plain_block_is_itself() {
        let spike = [
            (0., 0.),
            (100., 0.),
            (100., 60.),
            (54., 60.),
            (54., 78.),
            (50., 78.),
            (50., 60.),
            (0., 60.),
        ];
        let plain = Polygon::new(plain_outline(&polygon(&spike)), vec![]).expect("has area");
        assert!((plain.area_m2() - 6000.0).abs() < 1.0, "{}", plain.area_m2());
        let block = polygon(&[(0., 0.), (100., 0.), (120., 60.), (0., 70.)]);
        assert_eq!(plain_outline(&block), block.exterior());
    }
}
