//! What a user may turn.

use exurb_operation::{DomainsFile, LinesFile, Params as _};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the next piece begins, of all places where one may.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// Where a place has waited longest: breadth first, as in the paper.
    #[default]
    First,
    /// Nearest to a start, of those that have waited longest.
    Nearest,
    /// Where most streets wait for an answer, of those that have waited longest.
    Fit,
}

/// Growth of streets by patches of an example.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// How often growth follows the example's own next patch instead of drawing one that fits: 1
    /// largely copies the example, 0 always draws.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub continuation: f64,
    /// How often a place grows from statistics although a patch would fit: 0 never, 1 always.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub procedural: f64,
    /// Where the next piece begins, of all places where one may.
    pub order: Order,
    /// Number of places where growth begins, spread over the target; the first is its middle.
    #[schemars(range(min = 1, max = 1000))]
    pub starts: u32,
    /// A place where growth begins, as `LON,LAT` in the target or `LON,LAT=LON,LAT` with the place
    /// in the example that it begins with. Replaces `starts`.
    pub start: Vec<String>,
    /// A map of some drawn streets: growth learns from the surroundings of the place of the examples
    /// that is most like them, and begins with it, turned as they are, where they lie if that is in
    /// the target. Replaces `start`.
    #[schemars(extend("x-value-name" = "SKETCH.geojson"))]
    pub like: LinesFile,
    /// A GeoJSON file of areas: `use` and `example`, or `examples` with weights, say what each grows
    /// like; without examples, the one whose own ground, and streets where `density` says how many
    /// km/km², are most like the area's. `starts` are places as in `start`.
    #[schemars(extend("x-value-name" = "AREAS.geojson"))]
    pub areas: DomainsFile,
    /// Splits the target by height and slope into parts that each grow like the example whose own
    /// ground is most like theirs.
    pub split: bool,
    /// Heights that belong together where the target is split.
    #[schemars(range(min = 1.0, max = 10000.0), extend("x-unit" = "m"))]
    pub height_bin: f64,
    /// Slopes that belong together where the target is split, rise over run.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub slope_bin: f64,
    /// No part is smaller where the target is split.
    #[schemars(range(min = 0.0, max = 1000.0), extend("x-unit" = "km²"))]
    pub least_domain: f64,
    /// Width of the transition between several examples, as a share of the target's longer side: 0
    /// changes the style at once where the next start is nearer.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub blend: f64,
    /// Mixes two examples everywhere instead: the share of the first. Streets get the mean length and
    /// curvature of both; with `procedural` 1 they grow from these alone.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub interpolation: Option<f64>,
    /// A point of a guideline, as `LON,LAT=LON,LAT` with its place in the example, in order along the
    /// line: the example is bent so that its line follows this one. Replaces `start`.
    pub guide: Vec<String>,
    /// Turns the example against the target, counter-clockwise.
    #[schemars(range(min = -360.0, max = 360.0), extend("x-unit" = "°"))]
    pub rotate: f64,
    /// Pieces of the example may be turned by up to this to fit.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "°"))]
    pub turn_pieces: f64,
    /// Pieces of the example may be mirrored to fit.
    pub mirror_pieces: bool,
    /// Main junctions nearer than this along a street belong to one patch.
    #[schemars(range(min = 0.0, max = 500.0), extend("x-unit" = "m"))]
    pub main_reach: f64,
    /// Local junctions nearer than this along a street belong to one patch.
    #[schemars(range(min = 0.0, max = 500.0), extend("x-unit" = "m"))]
    pub local_reach: f64,
    /// A polygon on the example, as `LON,LAT LON,LAT LON,LAT ...`, whose streets stay together as
    /// one patch.
    pub keep: Vec<String>,
    /// Largest radius of a circle of main streets that stays together as one patch.
    #[schemars(range(min = 0.0, max = 1000.0), extend("x-unit" = "m"))]
    pub main_circle: f64,
    /// Largest radius of a circle of local streets that stays together as one patch.
    #[schemars(range(min = 0.0, max = 1000.0), extend("x-unit" = "m"))]
    pub local_circle: f64,
    /// Streets are no steeper than this: their rise over run.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub grade: f64,
    /// No street lies on ground steeper than this: its rise over run.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub slope: f64,
    /// In the end local edits bring the network nearer to the example: kinks, pairs of junctions and
    /// joints go where the example has fewer.
    pub polish: bool,
    /// How much lengths of streets count in that.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub lengths_weight: f64,
    /// How much bends of streets count in that.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub bends_weight: f64,
    /// How much junctions count in that: their degrees and the angles of those of three streets.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub junctions_weight: f64,
    /// How much the number of junctions for each kilometre of street counts in that.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub density_weight: f64,
    /// Dead ends that the example does not have there are removed.
    pub remove_dangling: bool,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            continuation: 0.55,
            procedural: 0.0,
            order: Order::First, // scores best within the examples, see docs/growth.md
            starts: 1,
            start: Vec::new(),
            like: LinesFile::default(),
            areas: DomainsFile::default(),
            split: false,
            height_bin: 80.0,
            slope_bin: 0.1,
            least_domain: 0.1, // the authors' program
            blend: 0.1,        // half the authors' program's, as eq. (4) has it
            interpolation: None,
            guide: Vec::new(),
            rotate: 0.0,
            turn_pieces: 0.0,
            mirror_pieces: false,
            main_reach: 80.0,  // the authors' program
            local_reach: 20.0, // the authors' program
            keep: Vec::new(),
            main_circle: 500.0,  // the authors' program
            local_circle: 100.0, // the authors' program
            grade: 0.2,
            slope: 0.6, // the authors' program: 36°, 0.73
            polish: true,
            lengths_weight: 1.0,
            bends_weight: 1.0,
            junctions_weight: 1.0,
            density_weight: 1.0,
            remove_dangling: true,
        }
    }
}

impl exurb_operation::Params for Params {
    fn check(&self) -> Result<(), String> {
        for start in &self.start {
            parse_start(start)?;
        }
        if self.guide.len() == 1 {
            return Err(format!("`guide` is the one point {}, a line needs two", self.guide[0]));
        }
        for point in &self.guide {
            parse_start(point)?;
        }
        for keep in &self.keep {
            parse_ring(keep)?;
        }
        Ok(())
    }
}

/// A place in degrees: longitude, latitude.
pub type Place = (f64, f64);

/// Reads `LON,LAT` or `LON,LAT=LON,LAT`.
pub fn parse_start(text: &str) -> Result<(Place, Option<Place>), String> {
    let (target, source) = match text.split_once('=') {
        Some((target, source)) => (target, Some(parse_place(source)?)),
        None => (text, None),
    };
    Ok((parse_place(target)?, source))
}

/// Reads at least three places separated by blanks.
pub fn parse_ring(text: &str) -> Result<Vec<Place>, String> {
    let ring = text.split_whitespace().map(parse_place).collect::<Result<Vec<_>, _>>()?;
    if ring.len() < 3 {
        return Err(format!("`keep` is `{text}`, expected at least three LON,LAT"));
    }
    Ok(ring)
}

fn parse_place(text: &str) -> Result<Place, String> {
    let error = || format!("`{text}` is no place, expected LON,LAT in degrees");
    let (lon, lat) = text.split_once(',').ok_or_else(error)?;
    let number = |v: &str| v.trim().parse::<f64>().map_err(|_| error());
    let (lon, lat) = (number(lon)?, number(lat)?);
    if lon.abs() <= 180.0 && lat.abs() <= 90.0 { Ok((lon, lat)) } else { Err(error()) }
}

impl Params {
    /// The same, checked.
    pub fn validate(&self) -> Result<&Self, String> {
        self.check().map(|()| self)
    }
}
