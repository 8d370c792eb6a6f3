//! Geometries as GeoPackage holds them: a header with the envelope, then well-known binary.

use exurb_city::FeatureShape;
use exurb_geom::{Bounds, GridPoint, Polygon};

/// A geometry of a city, to be written.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'a> {
    /// A point.
    Point(GridPoint),
    /// A line.
    Line(&'a [GridPoint]),
    /// A polygon.
    Polygon(&'a Polygon),
}

impl<'a> Shape<'a> {
    /// The shape of a feature.
    pub fn of(feature: &'a FeatureShape) -> Self {
        match feature {
            FeatureShape::Point(p) => Self::Point(*p),
            FeatureShape::Line(line) => Self::Line(line),
            FeatureShape::Polygon(polygon) => Self::Polygon(polygon),
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        let bounds = match self {
            Self::Point(p) => Bounds::of([*p]),
            Self::Line(line) => Bounds::of(line.iter().copied()),
            Self::Polygon(polygon) => Some(polygon.bounds()),
        };
        bounds.unwrap_or(Bounds { min: exurb_geom::Vec2::ZERO, max: exurb_geom::Vec2::ZERO })
    }
}

const LITTLE_ENDIAN: u8 = 1;
const POINT: u32 = 1;
const LINE_STRING: u32 = 2;
const POLYGON: u32 = 3;
const MULTI_POINT: u32 = 4;
const MULTI_LINE_STRING: u32 = 5;
const MULTI_POLYGON: u32 = 6;
const COLLECTION: u32 = 7;

/// Writes `shape` with its header into `out`, in metres.
pub fn encode(shape: Shape<'_>, srs_id: i32, out: &mut Vec<u8>) {
    out.clear();
    let with_envelope = !matches!(shape, Shape::Point(_));
    out.extend([b'G', b'P', 0, LITTLE_ENDIAN | u8::from(with_envelope) << 1]);
    out.extend(srs_id.to_le_bytes());
    if with_envelope {
        let Bounds { min, max } = shape.bounds();
        for v in [min.x, max.x, min.y, max.y] {
            out.extend(v.to_le_bytes());
        }
    }
    out.push(LITTLE_ENDIAN);
    match shape {
        Shape::Point(p) => {
            out.extend(POINT.to_le_bytes());
            put(p, out);
        }
        Shape::Line(line) => {
            out.extend(LINE_STRING.to_le_bytes());
            out.extend((line.len() as u32).to_le_bytes());
            line.iter().for_each(|p| put(*p, out));
        }
        Shape::Polygon(polygon) => {
            out.extend(POLYGON.to_le_bytes());
            out.extend((polygon.rings().count() as u32).to_le_bytes());
            for ring in polygon.rings() {
                out.extend((ring.len() as u32 + 1).to_le_bytes());
                ring.iter().chain(&ring[..1]).for_each(|p| put(*p, out));
            }
        }
    }
}

fn put(p: GridPoint, out: &mut Vec<u8>) {
    let p = p.to_m();
    out.extend(p.x.to_le_bytes());
    out.extend(p.y.to_le_bytes());
}
