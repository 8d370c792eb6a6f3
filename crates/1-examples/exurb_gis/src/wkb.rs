//! Geometries as GeoPackage holds them: a header with the envelope, then well-known binary.

use exurb_city::FeatureShape;
use exurb_geom::{Bounds, GridPoint, Polygon};

use crate::geometry::{Geometry, Position};

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

/// The geometry of a blob in GeoPackage's form; `Ok(None)` for an empty one.
///
/// Z and M values are passed over. Counts are believed only as far as the blob has bytes for them.
pub fn decode(blob: &[u8]) -> Result<Option<Geometry>, &'static str> {
    let [b'G', b'P', _version, flags, ..] = blob else {
        return Err("is no GeoPackage geometry");
    };
    let envelope = match flags >> 1 & 7 {
        0 => 0,
        1 => 32,
        2 | 3 => 48,
        4 => 64,
        _ => return Err("has an unknown kind of envelope"),
    };
    let empty = flags & 0x10 != 0;
    let bytes = blob.get(8 + envelope..).ok_or(TRUNCATED)?;
    if empty { Ok(None) } else { Reader { bytes, little: true }.geometry(0) }
}

const TRUNCATED: &str = "ends in the middle of a geometry";
/// Collections are nested at most this deep.
const MAX_DEPTH: usize = 8;

struct Reader<'a> {
    bytes: &'a [u8],
    little: bool,
}

impl Reader<'_> {
    fn geometry(&mut self, depth: usize) -> Result<Option<Geometry>, &'static str> {
        if depth > MAX_DEPTH {
            return Err("nests collections too deeply");
        }
        self.little = self.take::<1>()?[0] == LITTLE_ENDIAN;
        let code = self.count()?;
        // Z and M by ISO (thousands) or by flags in the top bits.
        let (iso, flags) = ((code & 0xFFFF) / 1000, code >> 29);
        let more = match iso {
            0 => (flags >> 2 & 1) + (flags >> 1 & 1),
            1 | 2 => 1,
            _ => 2,
        };
        let numbers = 2 + more as usize;
        match (code & 0xFFFF) % 1000 {
            POINT => {
                let p = self.position(numbers)?;
                Ok((!p[0].is_nan() || !p[1].is_nan()).then_some(Geometry::Point(p)))
            }
            LINE_STRING => {
                let line = self.line(numbers)?;
                Ok((!line.is_empty()).then_some(Geometry::Line(line)))
            }
            POLYGON => {
                let rings = self.count()?;
                let rings: Vec<_> =
                    (0..rings).map(|_| self.line(numbers)).collect::<Result<_, _>>()?;
                Ok((!rings.is_empty()).then_some(Geometry::Polygon(rings)))
            }
            MULTI_POINT | MULTI_LINE_STRING | MULTI_POLYGON | COLLECTION => {
                let mut parts = Vec::new();
                for _ in 0..self.count()? {
                    parts.extend(self.geometry(depth + 1)?);
                }
                Ok((!parts.is_empty()).then_some(Geometry::Many(parts)))
            }
            _ => Err("is of a type that exurb does not know (a curve or a surface)"),
        }
    }

    fn line(&mut self, numbers: usize) -> Result<Vec<Position>, &'static str> {
        let count = self.count()? as usize;
        if count > self.bytes.len() / (8 * numbers) {
            return Err(TRUNCATED);
        }
        (0..count).map(|_| self.position(numbers)).collect()
    }

    fn position(&mut self, numbers: usize) -> Result<Position, &'static str> {
        let p = [self.number()?, self.number()?];
        for _ in 2..numbers {
            self.number()?;
        }
        Ok(p)
    }

    fn number(&mut self) -> Result<f64, &'static str> {
        let bytes = self.take()?;
        Ok(if self.little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    fn count(&mut self) -> Result<u32, &'static str> {
        let bytes = self.take()?;
        Ok(if self.little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], &'static str> {
        let (head, rest) = self.bytes.split_first_chunk().ok_or(TRUNCATED)?;
        self.bytes = rest;
        Ok(*head)
    }
}
