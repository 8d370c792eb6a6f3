//! Sketches: drawn or painted land uses that become ground.
//!
//! A GeoJSON file holds polygons whose property `use` is `water`, `coast`, `flat`, `park` or
//! `mountain`; later ones lie over earlier ones. A painted PNG lies on the target's bounds; the nearest
//! of five colours tells the use.

use std::path::Path;

use exurb_city::terrain::{SketchedUse, sketched, sketched_areas};
use exurb_city::{Area, City};
use exurb_geom::{Bounds, GridPoint, Polygon, Vec2};
use serde_json::Value;

use crate::attached::{self, Image};
use crate::{Error, open};

/// Class of the parks of a sketch.
const PARK: &str = "park";
/// Colours of a painted sketch.
const COLORS: [(u32, SketchedUse); 5] = [
    (0x3070C0, SketchedUse::Water),
    (0xE8D8A0, SketchedUse::Coast),
    (0xD0D0D0, SketchedUse::Flat),
    (0x60B060, SketchedUse::Park),
    (0x806040, SketchedUse::Mountain),
];

/// Is that a sketch and no height map: GeoJSON, or an image of colours?
pub fn is_sketch(path: &Path) -> bool {
    let ends = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    ends("geojson") || ends("json") || ends("png") && attached::has_colors(path)
}

/// Puts the ground of a sketch under the city: heights, water, parks.
pub fn lay(city: &mut City, path: &Path, around_m: f64, seed: u64) -> Result<(), Error> {
    let wrong = |message: &str| Error::Input(open::named(path, message));
    let drawn = Drawn::read(path, city)?;
    let bounds = city.target.bounds().grown(around_m);
    let use_at = |p: Vec2| drawn.use_at(p);
    let terrain = sketched(bounds, use_at, seed).map_err(|e| wrong(&e.to_string()))?;
    let parks = sketched_areas(bounds, use_at, SketchedUse::Park);
    let parks = parks.map_err(|e| wrong(&e.to_string()))?;
    let mut land_use = (*city.land_use).clone();
    // The sketch says where parks are.
    land_use.retain(|area| *area.class != *PARK);
    for polygon in parks {
        land_use.push(Area { id: 0, polygon, class: PARK.into() });
    }
    land_use.iter_mut().zip(1..).for_each(|(area, id)| area.id = id);
    city.land_use = land_use.into();
    city.lay(terrain);
    city.flood();
    Ok(())
}

enum Drawn {
    Polygons { list: Vec<(SketchedUse, Polygon)>, bounds: Bounds },
    Painted { image: Image, bounds: Bounds },
}

impl Drawn {
    fn read(path: &Path, city: &City) -> Result<Self, Error> {
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
            let image = attached::read_image(path)?;
            return Ok(Self::Painted { image, bounds: city.target.bounds() });
        }
        let wrong = |message: String| Error::Input(open::named(path, &message));
        let mut out = Vec::new();
        for (properties, polygon) in attached::polygons(path, &city.frame)? {
            let word = properties.get("use").and_then(Value::as_str).unwrap_or("flat");
            let kind = SketchedUse::named(word).ok_or_else(|| {
                wrong(format!("`use` is `{word}`, expected water, coast, flat, park or mountain"))
            })?;
            out.push((kind, polygon));
        }
        // What touches the edge goes on beyond it.
        let bounds = city.target.bounds().grown(-0.5);
        Ok(Self::Polygons { list: out, bounds })
    }

    fn use_at(&self, p: Vec2) -> SketchedUse {
        match self {
            Self::Polygons { list, bounds } => {
                let at = GridPoint::round(p.clamp(bounds.min, bounds.max));
                let over = list.iter().rev().find(|(_, polygon)| polygon.contains(at));
                over.map_or(SketchedUse::Flat, |(kind, _)| *kind)
            }
            Self::Painted { image, bounds } => {
                let share = (p - bounds.min) / bounds.size();
                let color = image.color(share.x, 1.0 - share.y);
                let near = COLORS.iter().min_by_key(|(c, _)| distance(*c, color));
                near.map_or(SketchedUse::Flat, |(_, kind)| *kind)
            }
        }
    }
}

/// Squared distance of two colours `0xrrggbb`.
fn distance(a: u32, b: u32) -> u32 {
    [16, 8, 0].map(|s| (a >> s & 0xFF).abs_diff(b >> s & 0xFF).pow(2)).iter().sum()
}
