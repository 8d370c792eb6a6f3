//! What a user may turn.

use exurb_operation::Params as _;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Number of places where growth begins, spread over the target; the first is its middle.
    #[schemars(range(min = 1, max = 1000))]
    pub starts: u32,
    /// A place where growth begins, as `LON,LAT` in the target or `LON,LAT=LON,LAT` with the place
    /// in the example that it begins with. Replaces `starts`.
    pub start: Vec<String>,
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
    /// Dead ends that the example does not have there are removed.
    pub remove_dangling: bool,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            continuation: 0.3,
            procedural: 0.0,
            starts: 1,
            start: Vec::new(),
            main_reach: 80.0,  // the authors' program
            local_reach: 20.0, // the authors' program
            keep: Vec::new(),
            main_circle: 500.0,  // the authors' program
            local_circle: 100.0, // the authors' program
            remove_dangling: true,
        }
    }
}

impl exurb_operation::Params for Params {
    fn check(&self) -> Result<(), String> {
        for start in &self.start {
            parse_start(start)?;
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
