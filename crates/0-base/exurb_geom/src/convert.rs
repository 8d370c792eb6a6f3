//! To and from the geometry library.

use geo::{Coord, LineString};

use crate::{GridPoint, Polygon, Vec2};

pub fn to_geo(polygon: &Polygon) -> geo::Polygon<f64> {
    geo::Polygon::new(
        ring_to_geo(polygon.exterior()),
        polygon.interiors().iter().map(|r| ring_to_geo(r)).collect(),
    )
}

pub fn ring_to_geo(ring: &[GridPoint]) -> LineString<f64> {
    LineString(ring.iter().map(|p| coord(p.to_m())).collect())
}

pub fn line_to_geo(line: &[Vec2]) -> LineString<f64> {
    LineString(line.iter().map(|p| coord(*p)).collect())
}

pub fn many_to_geo<'a>(polygons: impl IntoIterator<Item = &'a Polygon>) -> geo::MultiPolygon<f64> {
    geo::MultiPolygon(polygons.into_iter().map(to_geo).collect())
}

/// Largest first, ties by coordinates, so that results do not depend on the library's order.
pub fn from_geo(polygons: geo::MultiPolygon<f64>) -> Vec<Polygon> {
    let ring = |r: &LineString<f64>| r.0.iter().map(|c| GridPoint::m(c.x, c.y)).collect::<Vec<_>>();
    let mut out: Vec<Polygon> = polygons
        .iter()
        .filter_map(|p| Polygon::new(ring(p.exterior()), p.interiors().iter().map(ring).collect()))
        .collect();
    out.sort_by(|a, b| b.area_m2().total_cmp(&a.area_m2()).then_with(|| a.cmp(b)));
    out
}

fn coord(p: Vec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}
