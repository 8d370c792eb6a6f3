use exurb_city::Terrain;
use exurb_geom::{Crs, Frame, LonLat};

/// A raster of heights as its file has it.
#[derive(Clone, Debug)]
pub struct Dem {
    /// What it is called in messages.
    pub file: String,
    /// Pixels in a row.
    pub columns: usize,
    /// Heights in metres, row by row from the north; NaN where not known.
    pub heights: Vec<f32>,
    /// Where its pixels lie.
    pub place: Place,
    /// Who is to be credited, where the file says so.
    pub attribution: Option<String>,
}

/// Where the pixels of a raster lie.
#[derive(Clone, Debug)]
pub enum Place {
    /// By the middles of its pixels in a coordinate system.
    Georeferenced {
        /// From columns and rows to coordinates.
        affine: Affine,
        /// What the coordinates are.
        crs: Box<Crs>,
    },
    /// Its edges are those of whatever box it is laid over.
    Stretched,
}

/// `x = x0 + xc · column + xr · row`, and so for y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the formula says it")]
pub struct Affine {
    pub x0: f64,
    pub xc: f64,
    pub xr: f64,
    pub y0: f64,
    pub yc: f64,
    pub yr: f64,
}

impl Affine {
    /// North up: the middle of the north-west pixel and the size of pixels.
    pub fn north_up(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x0: x, xc: width, xr: 0.0, y0: y, yc: 0.0, yr: -height }
    }

    /// A raster of that many pixels whose outer edges lie at west, south, east and north.
    pub fn between([west, south, east, north]: [f64; 4], columns: usize, rows: usize) -> Self {
        let (width, height) = ((east - west) / columns as f64, (north - south) / rows as f64);
        Self::north_up(west + width / 2.0, north - height / 2.0, width, height)
    }

    /// The coordinates of a column and row.
    pub fn at(&self, column: f64, row: f64) -> (f64, f64) {
        (self.x0 + self.xc * column + self.xr * row, self.y0 + self.yc * column + self.yr * row)
    }

    /// The column and row of coordinates; `None` when pixels have no area.
    pub fn inverse(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let area = self.xc * self.yr - self.xr * self.yc;
        let (dx, dy) = (x - self.x0, y - self.y0);
        let back = ((dx * self.yr - dy * self.xr) / area, (dy * self.xc - dx * self.yc) / area);
        (back.0.is_finite() && back.1.is_finite()).then_some(back)
    }

    /// The same pixels counted from the corner of the first instead of its middle.
    pub fn from_corner(self) -> Self {
        let (x0, y0) = self.at(0.5, 0.5);
        Self { x0, y0, ..self }
    }
}

impl Dem {
    /// The heights of a city file's terrain, to be laid under another city.
    pub fn of(terrain: &Terrain, frame: &Frame, file: &str) -> Self {
        let rows = terrain.heights().chunks_exact(terrain.columns());
        let first = terrain.post(0, terrain.rows() - 1);
        let affine = Affine::north_up(first.x, first.y, terrain.cell_m(), terrain.cell_m());
        let crs = Crs::from_name(&frame.to_proj()).unwrap_or_else(Crs::wgs84);
        Self {
            file: file.to_owned(),
            columns: terrain.columns(),
            heights: rows.rev().flatten().copied().collect(),
            place: Place::Georeferenced { affine, crs: crs.into() },
            attribution: None,
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.heights.len().checked_div(self.columns).unwrap_or(0)
    }

    /// South-west and north-east corner of the middles of its outer pixels, as far as they have a
    /// place.
    pub fn extent(&self) -> Option<[LonLat; 2]> {
        let Place::Georeferenced { affine, crs } = &self.place else { return None };
        let (last_column, last_row) = (self.columns as f64 - 1.0, self.rows() as f64 - 1.0);
        let corners = [(0.0, 0.0), (last_column, 0.0), (0.0, last_row), (last_column, last_row)];
        let mut box_of: Option<[LonLat; 2]> = None;
        for (column, row) in corners {
            let (x, y) = affine.at(column, row);
            let p = crs.to_lonlat(x, y)?;
            let [a, b] = box_of.unwrap_or([p, p]);
            box_of = Some([
                LonLat { lon: a.lon.min(p.lon), lat: a.lat.min(p.lat) },
                LonLat { lon: b.lon.max(p.lon), lat: b.lat.max(p.lat) },
            ]);
        }
        box_of
    }
}
