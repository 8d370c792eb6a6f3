//! Geometries as files hold them, in whatever coordinates, and their way onto the grid.

use exurb_city::FeatureShape;
use exurb_geom::{GridPoint, Polygon};

/// A point of a file.
pub type Position = [f64; 2];

/// A geometry of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// A point.
    Point(Position),
    /// A line.
    Line(Vec<Position>),
    /// A polygon: outer ring, then holes.
    Polygon(Vec<Vec<Position>>),
    /// Several geometries.
    Many(Vec<Geometry>),
}

impl Geometry {
    /// The simple geometries it consists of, in order.
    pub fn into_parts(self) -> Vec<Self> {
        match self {
            Self::Many(parts) => parts.into_iter().flat_map(Self::into_parts).collect(),
            simple => vec![simple],
        }
    }

    /// The polygons among [`Geometry::into_parts`].
    pub fn into_polygons(self) -> Vec<Self> {
        let mut parts = self.into_parts();
        parts.retain(|part| matches!(part, Self::Polygon(_)));
        parts
    }

    /// All positions, to change or look at; stops at the first `false`, which it returns.
    pub fn all(&mut self, mut visit: impl FnMut(&mut Position) -> bool) -> bool {
        self.visit(&mut visit)
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut Position) -> bool) -> bool {
        match self {
            Self::Point(p) => visit(p),
            Self::Line(line) => line.iter_mut().all(visit),
            Self::Polygon(rings) => rings.iter_mut().flatten().all(visit),
            Self::Many(parts) => parts.iter_mut().all(|part| part.visit(visit)),
        }
    }

    /// A simple geometry (or the only part of one) on the grid, by `place`; `None` when a position
    /// has no place, or when nothing with length or area is left.
    pub fn to_grid(&self, place: impl Fn(Position) -> Option<GridPoint>) -> Option<FeatureShape> {
        let line = |line: &[Position]| -> Option<Vec<GridPoint>> {
            line.iter().map(|p| place(*p)).collect()
        };
        match self {
            Self::Point(p) => place(*p).map(FeatureShape::Point),
            Self::Line(points) => {
                let mut points = line(points)?;
                points.dedup();
                (points.len() > 1).then_some(FeatureShape::Line(points))
            }
            Self::Polygon(rings) => {
                let mut rings = rings.iter().map(|ring| line(ring));
                let exterior = rings.next()??;
                let interiors = rings.collect::<Option<_>>()?;
                Polygon::new(exterior, interiors).map(FeatureShape::Polygon)
            }
            Self::Many(parts) => match &parts[..] {
                [only] => only.to_grid(place),
                _ => None,
            },
        }
    }
}
