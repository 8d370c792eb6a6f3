//! Buildings: footprint, place beside the street, height. Parts of buildings are no buildings of
//! their own. Whatever has its centroid in the window counts, each building once. O(n log n), on
//! rayon's current pool.

use exurb_city::{Building, City};
use exurb_geom::{Bounds, GridPoint, OrientedBox, Vec2, polyline, trig};
use rayon::prelude::*;

use crate::Sample;
use crate::nearest::Segments;

/// Outlines are simplified by this before their corners are counted, in metres; at most so many.
const SIMPLIFY_M: f64 = 0.7;
const MOST_CORNERS: usize = 30;
/// Setbacks and gaps are at most this, in metres.
const MOST_SETBACK_M: f64 = 150.0;
const MOST_GAP_M: f64 = 60.0;

/// What is measured of one building.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Index in the city's list of buildings.
    pub index: usize,
    /// Centroid of the footprint in metres.
    pub at: Vec2,
    /// Area of the footprint in m².
    pub area_m2: f64,
    /// Shorter over longer side of the smallest enclosing rectangle.
    pub elongation: f64,
    /// Area over that of this rectangle.
    pub rectangularity: f64,
    /// Vertices of the outline simplified by 0.7 m, at most 30.
    pub corners: usize,
    /// Distance to the nearest street centreline in metres, at most 150.
    pub setback_m: f64,
    /// Angle between the longer axis and the nearest piece of street, folded to 0..45 degrees.
    /// `None` without a street within 150 m.
    pub street_alignment: Option<f64>,
    /// Gap to the nearest other building in metres, at most 60; 0 for a shared wall.
    pub gap_m: f64,
    /// Height in metres, where known by `height` or levels of 3 m.
    pub height_m: Option<f64>,
}

/// The buildings of a window.
pub fn shapes(city: &City, window: Bounds) -> Vec<Shape> {
    let whole: Vec<(usize, &Building)> =
        city.buildings.iter().enumerate().filter(|(_, b)| !b.is_part).collect();
    let streets = Segments::new(
        city.streets
            .edges()
            .flat_map(|(id, edge)| edge.line().windows(2).map(move |w| (id.0, (w[0], w[1])))),
    );
    let others = Segments::of_polygons(whole.iter().map(|(_, b)| &b.polygon));
    let shape = |(number, (index, building)): (usize, &(usize, &Building))| {
        let at = building.polygon.centroid();
        let own = number as u32;
        window.contains(at).then(|| shape(*index, building, own, &streets, &others))?
    };
    let found: Vec<Option<Shape>> = whole.par_iter().enumerate().map(shape).collect();
    found.into_iter().flatten().collect()
}

fn shape(
    index: usize,
    building: &Building,
    own: u32,
    streets: &Segments,
    others: &Segments,
) -> Option<Shape> {
    let polygon = &building.polygon;
    let rectangle = OrientedBox::of(polygon.exterior())?;
    let street = streets.nearest(polygon, MOST_SETBACK_M, |_| true);
    let gap = others.nearest(polygon, MOST_GAP_M, |other| other != own);
    let along = |(a, b): (GridPoint, GridPoint)| trig::angle(b.to_m() - a.to_m());
    let turned = |axis: f64, street: f64| {
        let quarter = (axis - street).to_degrees().rem_euclid(90.0);
        quarter.min(90.0 - quarter)
    };
    let axis = trig::angle(rectangle.axis);
    Some(Shape {
        index,
        at: polygon.centroid(),
        area_m2: polygon.area_m2(),
        elongation: rectangle.aspect(),
        rectangularity: polygon.area_m2() / rectangle.area_m2(),
        corners: corners(polygon.exterior()),
        setback_m: street.map_or(MOST_SETBACK_M, |s| s.distance_m),
        street_alignment: street.map(|s| turned(axis, along(s.segment))),
        gap_m: gap.map_or(MOST_GAP_M, |g| g.distance_m),
        height_m: building.known_height_m(),
    })
}

/// Vertices of a ring simplified from the one farthest from its middle, which is a corner for sure.
fn corners(ring: &[GridPoint]) -> usize {
    let points = polyline::to_m(ring);
    let middle = points.iter().sum::<Vec2>() / points.len() as f64;
    let far = |i: &usize| points[*i].distance_squared(middle);
    let first = (0..points.len()).max_by(|i, j| far(i).total_cmp(&far(j)).then(j.cmp(i)));
    let mut closed = points.clone();
    closed.rotate_left(first.unwrap_or(0));
    closed.push(closed[0]);
    (polyline::simplify(&closed, SIMPLIFY_M).len() - 1).min(MOST_CORNERS)
}

/// One measure of all buildings; what is not known is left out.
pub fn sample(shapes: &[Shape], value: impl Fn(&Shape) -> Option<f64>) -> Sample {
    Sample::plain(shapes.iter().filter_map(value))
}
