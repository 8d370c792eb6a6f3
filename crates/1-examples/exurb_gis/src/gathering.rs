//! A city out of the rows of other people's files.

use std::sync::Arc;

use exurb_city::{
    Area, Building, Draft, Feature, FeatureShape, ImportOptions, Imported, Origin, Parcel,
    Provenance, Way,
};
use exurb_geom::{Bounds, Crs, Frame, GridPoint, LonLat, Polygon, Vec2, overlay};

use crate::geometry::{Geometry, Position};
use crate::recognise::{Attributes, Kind, recognise};
use crate::{Error, border};

/// Rows on their way to a city. Their positions are what their file says until
/// [`Gathering::place`] or [`Gathering::leave_placeless`] is called.
pub struct Gathering {
    /// Names the file or files in messages.
    pub file: String,
    name: String,
    attribution: Vec<String>,
    rows: Vec<(Kind, Geometry)>,
    placed: usize,
    placeless: Option<bool>,
    unknown: usize,
    misplaced: usize,
    repaired: usize,
    warnings: Vec<String>,
}

/// How OpenStreetMap's data are credited.
const OSM_ATTRIBUTION: &str = "© OpenStreetMap contributors, ODbL 1.0";
/// Data farther than this from their middle are strays, in degrees.
const FARTHEST_DEG: f64 = 2.0;

impl Gathering {
    /// No rows yet.
    pub fn new(file: String, name: String) -> Self {
        Self {
            file,
            name,
            attribution: Vec::new(),
            rows: Vec::new(),
            placed: 0,
            placeless: None,
            unknown: 0,
            misplaced: 0,
            repaired: 0,
            warnings: Vec::new(),
        }
    }

    /// Takes a row of the layer or file `hint`.
    pub fn add(&mut self, geometry: Geometry, attributes: &Attributes<'_>, hint: &str) {
        match recognise(&geometry, attributes, hint) {
            Some(kind) => {
                self.rows
                    .extend(geometry.into_parts().into_iter().map(|part| (kind.clone(), part)));
            }
            None => self.unknown += 1,
        }
    }

    /// Adds attributions, one a line; what names OpenStreetMap gets its usual attribution.
    pub fn credit(&mut self, text: &str) {
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let is_osm = line.to_lowercase().contains("openstreetmap");
            let line = if is_osm { OSM_ATTRIBUTION } else { line }.to_owned();
            if !self.attribution.contains(&line) {
                self.attribution.push(line);
            }
        }
    }

    /// Adds a sentence for the user.
    pub fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Counts a row whose geometry could not be read.
    pub fn skip(&mut self) {
        self.misplaced += 1;
    }

    /// Brings what was added since the last call from `crs` to longitude and latitude; rows with
    /// impossible positions go.
    pub fn place(&mut self, crs: &Crs) -> Result<(), Error> {
        self.agree(false)?;
        let mut fresh = self.rows.split_off(self.placed);
        let before = fresh.len();
        fresh.retain_mut(|(_, geometry)| {
            geometry.all(|p| match crs.to_lonlat(p[0], p[1]) {
                Some(place) => {
                    *p = [place.lon, place.lat];
                    true
                }
                None => false,
            })
        });
        self.misplaced += before - fresh.len();
        self.rows.append(&mut fresh);
        self.placed = self.rows.len();
        Ok(())
    }

    /// Takes what was added since the last call as metres of an unknown place.
    pub fn leave_placeless(&mut self) -> Result<(), Error> {
        self.agree(true)?;
        let mut fresh = self.rows.split_off(self.placed);
        let before = fresh.len();
        fresh.retain_mut(|(_, geometry)| geometry.all(|p| p[0].is_finite() && p[1].is_finite()));
        self.misplaced += before - fresh.len();
        self.rows.append(&mut fresh);
        self.placed = self.rows.len();
        Ok(())
    }

    /// Do the positions since the last placing look like metres rather than degrees?
    pub fn looks_like_metres(&mut self) -> bool {
        let degrees = |p: &mut Position| !(p[0].abs() > 180.0 || p[1].abs() > 90.0);
        let fresh = &mut self.rows[self.placed..];
        let metres = fresh.iter_mut().filter_map(|(_, g)| (!g.all(degrees)).then_some(())).count();
        metres * 2 > fresh.len()
    }

    fn agree(&mut self, placeless: bool) -> Result<(), Error> {
        if self.rows.len() > self.placed && *self.placeless.get_or_insert(placeless) != placeless {
            return Err(Error::Content {
                file: self.file.clone(),
                place: "coordinates".to_owned(),
                what: "some have a coordinate system and some have none; give all of them the same"
                    .to_owned(),
            });
        }
        Ok(())
    }

    /// The city of all rows.
    pub fn finish(mut self, options: &ImportOptions) -> Result<Imported, Error> {
        let center = self.center().ok_or_else(|| Error::Empty { file: self.file.clone() })?;
        let placeless = self.placeless == Some(true);
        let frame = if placeless {
            Frame::null_island()
        } else {
            let [lon, lat] = center;
            Frame::new(LonLat { lon, lat }).map_err(|e| Error::Content {
                file: self.file.clone(),
                place: "coordinates".to_owned(),
                what: e.to_string(),
            })?
        };
        let place = |p: Position| {
            if placeless {
                return GridPoint::checked(Vec2::from_array(p) - Vec2::from_array(center));
            }
            let near =
                (p[0] - center[0]).abs() < FARTHEST_DEG && (p[1] - center[1]).abs() < FARTHEST_DEG;
            near.then(|| frame.project_to_grid(LonLat { lon: p[0], lat: p[1] }))?
        };
        let mut draft = Draft::new(frame.clone());
        for (kind, geometry) in std::mem::take(&mut self.rows) {
            match geometry.to_grid(place) {
                Some(shape) => self.put(&mut draft, kind, shape),
                None => self.misplaced += 1,
            }
        }
        draft.extent = extent(&draft);
        let lines: Vec<&[GridPoint]> = draft.streets.ways.iter().map(|w| &w.line[..]).collect();
        draft.broken_ends = border::cut_ends(&lines, if placeless { 0.0 } else { center[1] });
        if !draft.broken_ends.is_empty() {
            self.warnings.push(format!(
                "`{}`: {} ends of streets that stand in straight rows on the outside were taken as cut \
                 off there, not as dead ends",
                self.file,
                draft.broken_ends.len()
            ));
        }
        draft.metadata.name = self.name.as_str().into();
        draft.metadata.attribution = std::mem::take(&mut self.attribution);
        let source = |source| Error::Draft { file: self.file.clone(), source };
        let mut imported = draft.assemble(options).map_err(source)?;
        self.report(&mut imported.warnings);
        Ok(imported)
    }

    /// The middle of the positions, in whole metres where they are metres. A few strays do not
    /// move it far: the middle of the box when that is small, else the median.
    fn center(&mut self) -> Option<Position> {
        let whole = self.placeless == Some(true);
        let reach = if whole { 1e5 } else { 2.0 * FARTHEST_DEG };
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for (_, geometry) in &mut self.rows {
            geometry.all(|p| {
                xs.push(p[0]);
                ys.push(p[1]);
                true
            });
        }
        let middle = |values: &mut Vec<f64>| {
            values.sort_unstable_by(f64::total_cmp);
            let (first, last) = (*values.first()?, *values.last()?);
            let middle =
                if last - first < reach { (first + last) / 2.0 } else { values[values.len() / 2] };
            Some(if whole { middle.round() } else { middle })
        };
        Some([middle(&mut xs)?, middle(&mut ys)?])
    }

    fn put(&mut self, draft: &mut Draft, kind: Kind, shape: FeatureShape) {
        let provenance = Provenance::of(Origin::Imported);
        match (kind, shape) {
            (Kind::Street { street, backward }, FeatureShape::Line(mut line)) => {
                if backward {
                    line.reverse();
                }
                let ways = &mut draft.streets.ways;
                let id = ways.len() as i64 + 1;
                ways.push(Way { id, line, nodes: Vec::new(), street });
            }
            (Kind::Building(walls), FeatureShape::Polygon(polygon)) => {
                for polygon in self.sound(polygon) {
                    let id = draft.buildings.len() as u32 + 1;
                    draft.buildings.push(Building {
                        height_m: walls.height_m,
                        min_height_m: walls.min_height_m,
                        levels: walls.levels,
                        roof: walls.roof,
                        usage: walls.usage.clone(),
                        is_part: walls.is_part,
                        ..Building::new(id, polygon, provenance.clone())
                    });
                }
            }
            (Kind::Parcel(land_use), FeatureShape::Polygon(polygon)) => {
                for polygon in self.sound(polygon) {
                    let id = draft.parcels.len() as u32 + 1;
                    draft.parcels.push(Parcel {
                        id,
                        block: 0,
                        polygon,
                        street_access: false,
                        land_use: land_use.clone(),
                        provenance: provenance.clone(),
                    });
                }
            }
            (Kind::Water(class), FeatureShape::Polygon(polygon)) => {
                self.put_area(&mut draft.water, polygon, &class);
            }
            (Kind::LandUse(class), FeatureShape::Polygon(polygon)) => {
                self.put_area(&mut draft.land_use, polygon, &class);
            }
            (Kind::Feature(kind), shape) => {
                let id = draft.features.len() as u32 + 1;
                draft.features.push(Feature { id, kind, shape, block: 0, provenance });
            }
            _ => self.unknown += 1,
        }
    }

    fn put_area(&mut self, areas: &mut Vec<Area>, polygon: Polygon, class: &Arc<str>) {
        for polygon in self.sound(polygon) {
            let id = areas.len() as u32 + 1;
            areas.push(Area { id, polygon, class: class.clone() });
        }
    }

    /// The polygon, or the sound pieces of one that crosses itself.
    fn sound(&mut self, polygon: Polygon) -> Vec<Polygon> {
        let pieces = overlay::repair(&polygon);
        self.repaired += usize::from(pieces.len() != 1 || pieces[0] != polygon);
        pieces
    }

    fn report(self, warnings: &mut Vec<String>) {
        warnings.extend(self.warnings);
        let mut count = |n: usize, what: &str| {
            if n > 0 {
                warnings.push(format!("`{}`: {n} {what}", self.file));
            }
        };
        count(self.unknown, "features are neither streets, buildings, parcels nor areas: left out");
        count(self.misplaced, "features have no usable geometry: left out");
        count(self.repaired, "polygons crossed themselves: repaired");
        if self.placeless == Some(true) {
            warnings.push(format!(
                "`{}` has no coordinate system that exurb can convert: its coordinates are taken \
                 as metres and the city lies at the null island",
                self.file
            ));
        }
    }
}

/// The rectangle around everything; the files do not say where they are complete.
fn extent(draft: &Draft) -> Option<Polygon> {
    let lines = draft.streets.ways.iter().filter_map(|w| Bounds::of(w.line.iter().copied()));
    let polygons = draft
        .buildings
        .iter()
        .map(|b| &b.polygon)
        .chain(draft.parcels.iter().map(|p| &p.polygon))
        .chain(draft.water.iter().chain(&draft.land_use).map(|a| &a.polygon));
    let bounds = lines.chain(polygons.map(Polygon::bounds)).reduce(Bounds::union)?;
    let (a, b) = (GridPoint::round(bounds.min), GridPoint::round(bounds.max));
    // One straight street alone has a box without area.
    let wide = GridPoint { x: b.x.max(a.x + 1000), y: b.y.max(a.y + 1000) };
    Some(Polygon::rectangle(a, wide))
}
