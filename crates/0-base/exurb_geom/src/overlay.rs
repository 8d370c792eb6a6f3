//! Intersection, difference and union of polygons.
//!
//! Results are rounded to the grid and sorted, largest first. Rounding can leave two results up to
//! 1 mm over a shared edge; where shared edges must be exact, keep them in a graph instead.

use geo::{BooleanOps, Validation};

use crate::plain::is_plainly_valid;
use crate::{GridPoint, Polygon, convert};

/// What lies in `a` and in `b`.
pub fn intersection(a: &Polygon, b: &Polygon) -> Vec<Polygon> {
    if !a.bounds().intersects(b.bounds()) {
        return Vec::new();
    }
    convert::from_geo(convert::to_geo(a).intersection(&convert::to_geo(b)))
}

/// What lies in one of `a` and in one of `b`.
pub fn intersection_of_many(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    convert::from_geo(convert::many_to_geo(a).intersection(&convert::many_to_geo(b)))
}

/// What lies in `a` and in none of `b`.
pub fn difference<'a>(a: &Polygon, b: impl IntoIterator<Item = &'a Polygon>) -> Vec<Polygon> {
    let bounds = a.bounds();
    let near = b.into_iter().filter(|p| p.bounds().intersects(bounds));
    let clip = convert::many_to_geo(near);
    if clip.0.is_empty() {
        return vec![a.clone()];
    }
    // Overlapping clip polygons are joined first: the library reads a multi-polygon by even-odd.
    convert::from_geo(convert::to_geo(a).difference(&geo::unary_union(&clip)))
}

/// The union of all.
pub fn union<'a>(polygons: impl IntoIterator<Item = &'a Polygon>) -> Vec<Polygon> {
    convert::from_geo(geo::unary_union(&convert::many_to_geo(polygons)))
}

/// The part of `line` (metres) inside `area`, as lines; in no promised order.
pub fn clip_line(area: &Polygon, line: &[crate::Vec2]) -> Vec<Vec<crate::Vec2>> {
    let lines = geo::MultiLineString(vec![convert::line_to_geo(line)]);
    let inside = convert::to_geo(area).clip(&lines, false);
    inside.0.iter().map(|l| l.0.iter().map(|c| crate::Vec2::new(c.x, c.y)).collect()).collect()
}

/// The valid polygons that `polygon` covers by the even-odd rule: crossings become vertices and
/// pieces fall apart where the ring crosses itself.
pub fn repair(polygon: &Polygon) -> Vec<Polygon> {
    if is_valid(polygon) {
        return vec![polygon.clone()];
    }
    let rings: Vec<Vec<GridPoint>> = polygon.rings().map(<[GridPoint]>::to_vec).collect();
    covered(&rings)
}

/// The valid polygons that closed rings cover together by the even-odd rule, whatever they cross
/// and whichever way they turn.
pub fn covered(rings: &[Vec<GridPoint>]) -> Vec<Polygon> {
    let line = |ring: &Vec<GridPoint>| convert::ring_to_geo(ring);
    let Some((outer, holes)) = rings.split_first() else { return Vec::new() };
    let all = geo::Polygon::new(line(outer), holes.iter().map(line).collect());
    let empty = geo::MultiPolygon::<f64>(Vec::new());
    let covered = geo::MultiPolygon(vec![all]).union(&empty);
    convert::from_geo(covered).into_iter().filter(is_valid).collect()
}

/// Does no ring cross or touch itself or another, and do holes lie inside?
pub fn is_valid(polygon: &Polygon) -> bool {
    is_plainly_valid(polygon) || convert::to_geo(polygon).is_valid()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        Polygon::rectangle(GridPoint::m(x, y), GridPoint::m(x + side, y + side))
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn inclusion_and_exclusion() {
        let (a, b) = (square(0.0, 0.0, 10.0), square(5.0, 5.0, 10.0));
        assert_eq!(area(&intersection(&a, &b)), 25.0);
        assert_eq!(area(&difference(&a, [&b])), 75.0);
        assert_eq!(area(&union([&a, &b])), 175.0);
    }

    #[test]
    fn overlapping_clips_are_removed_once() {
        let (b, c) = (square(5.0, 0.0, 10.0), square(4.0, 0.0, 10.0));
        assert_eq!(area(&difference(&square(0.0, 0.0, 10.0), [&b, &c])), 40.0);
    }

    #[test]
    fn a_bow_tie_becomes_two_triangles() {
        let ring = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 9.0)];
        let bow =
            Polygon::new(ring.map(|(x, y)| GridPoint::m(x, y)).to_vec(), vec![]).expect("area");
        assert!(!bow.is_valid());
        assert_eq!(repair(&bow).len(), 2);
        // With wings of one size its signed area is none, and still it covers something.
        let even = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)];
        let even = even.map(|(x, y)| GridPoint::m(x, y)).to_vec();
        assert!(Polygon::new(even.clone(), vec![]).is_none());
        assert_eq!(area(&covered(&[even])), 50.0);
    }
}
