//! Outlines so narrow somewhere that OSM's centimetre would make them cross themselves.

use exurb_geom::{Frame, GridPoint, LonLat, Polygon, offset};

use crate::document::{fixed, spaced};

/// Necks and cracks narrower than twice this close, in metres.
const HALF_M: f64 = 0.03;

/// The outline without its necks and cracks, where it would cross itself as OSM writes it; `None` where it
/// would not, or where that does not help.
pub fn mended(polygon: &Polygon, frame: &Frame) -> Option<Polygon> {
    if survives(polygon, frame) {
        return None;
    }
    let closed = moved_and_back(polygon, -HALF_M);
    let opened = moved_and_back(polygon, HALF_M);
    let both = closed.as_ref().and_then(|closed| moved_and_back(closed, HALF_M));
    [opened, closed, both].into_iter().flatten().find(|p| survives(p, frame))
}

/// Shrunk and grown again, or the other way round; of several pieces the largest.
fn moved_and_back(polygon: &Polygon, by_m: f64) -> Option<Polygon> {
    let largest = |pieces: Vec<Polygon>| {
        pieces.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()))
    };
    largest(offset::inset(&largest(offset::inset(polygon, by_m))?, -by_m))
}

fn survives(polygon: &Polygon, frame: &Frame) -> bool {
    let rings: Vec<&[GridPoint]> = polygon.rings().collect();
    are_valid(&rings, frame)
}

/// Are rings, the outer one first, valid with their corners where OSM writes them?
pub fn are_valid(rings: &[impl AsRef<[GridPoint]>], frame: &Frame) -> bool {
    let degrees = |v: f64| f64::from(fixed(v)) / 1e7;
    let place = |p: &GridPoint| {
        let LonLat { lon, lat } = frame.unproject(p.to_m());
        frame.project_to_grid(LonLat { lon: degrees(lon), lat: degrees(lat) })
    };
    let written = |ring: &[GridPoint]| spaced(ring).iter().map(place).collect::<Option<Vec<_>>>();
    let mut rings = rings.iter().map(|ring| written(ring.as_ref()));
    let Some(Some(exterior)) = rings.next() else { return true };
    let Some(interiors) = rings.collect::<Option<Vec<_>>>() else { return true };
    Polygon::new(exterior, interiors).is_some_and(|p| p.is_valid())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn necks_and_cracks_of_a_centimetre_close() {
        let frame = Frame::new(LonLat { lon: 11.5, lat: 48.1 }).unwrap();
        let polygon = |points: &[(f64, f64)]| {
            let ring = points.iter().map(|(x, y)| GridPoint::m(*x, *y)).collect();
            Polygon::new(ring, Vec::new()).unwrap()
        };
        let house = [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)];
        assert_eq!(mended(&polygon(&house), &frame), None);
        // Two houses joined by a strip of 1 mm along 9 m, and a house with a crack as narrow.
        let neck = polygon(&[
            (0.0, 0.0),
            (10.0, 0.0),
            (10.0, 3.0),
            (19.0, 4.001),
            (19.0, 0.0),
            (22.0, 0.0),
            (22.0, 8.0),
            (19.0, 8.0),
            (19.0, 4.002),
            (10.0, 3.001),
            (10.0, 8.0),
            (0.0, 8.0),
        ]);
        let crack = polygon(&[
            (0.0, 0.0),
            (4.999, 0.0),
            (5.3, 6.0),
            (5.301, 6.0),
            (5.0, 0.0),
            (10.0, 0.0),
            (10.0, 8.0),
            (0.0, 8.0),
        ]);
        for narrow in [neck, crack] {
            assert!(!survives(&narrow, &frame), "OSM's centimetre would close it");
            let found = mended(&narrow, &frame).expect("a wider one");
            assert!(found.is_valid() && found.area_m2() > 79.0, "{}", found.area_m2());
        }
    }
}
