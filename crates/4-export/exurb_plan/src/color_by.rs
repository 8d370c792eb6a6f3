//! Colours that tell something: class, origin, source, level, role, land use, height.

use std::collections::BTreeSet;

use exurb_city::{Building, City, Class, Origin, Provenance, Role, Street};

use crate::color::{Color, rgb};

/// What colours tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorBy {
    /// Streets by OSM class.
    Class,
    /// Streets, buildings and blocks by how they came to be.
    Origin,
    /// Streets, buildings and blocks by the example they were copied from.
    Source,
    /// Streets by hierarchy level.
    Level,
    /// Streets by role.
    Role,
    /// Blocks, parcels and buildings by land use.
    LandUse,
    /// Buildings by height.
    Height,
}

impl ColorBy {
    /// All.
    pub const ALL: [Self; 7] = [
        Self::Class,
        Self::Origin,
        Self::Source,
        Self::Level,
        Self::Role,
        Self::LandUse,
        Self::Height,
    ];

    /// The name in options.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Class => "class",
            Self::Origin => "origin",
            Self::Source => "source",
            Self::Level => "level",
            Self::Role => "role",
            Self::LandUse => "land_use",
            Self::Height => "height",
        }
    }

    /// The way of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.as_str() == name)
    }
}

/// Twelve hues that stay apart, also next to each other.
const HUES: [u32; 12] = [
    0x3b6fb6, 0xe08a2c, 0x3f9a57, 0xc8453f, 0x8460ad, 0x8c6248, 0xd77fb4, 0x6f7a80, 0xb1aa3a,
    0x35a8b5, 0x274a6d, 0x9c2f5e,
];
const UNKNOWN: Color = rgb(0xa9a39a);
/// From low to high, light to dark.
const HEIGHTS: [(f64, &str, u32); 7] = [
    (6.0, "under 6 m", 0xf3e3a3),
    (10.0, "6 to 10 m", 0xf2c46d),
    (15.0, "10 to 15 m", 0xe89a51),
    (20.0, "15 to 20 m", 0xd46a4d),
    (30.0, "20 to 30 m", 0xb0425a),
    (50.0, "30 to 50 m", 0x7b2d68),
    (f64::INFINITY, "over 50 m", 0x3f1d5c),
];

/// One line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub label: String,
    pub color: Color,
}

/// Colours for the values that a city has.
#[derive(Clone, Debug)]
pub struct Key {
    by: Option<ColorBy>,
    names: Vec<String>,
}

impl Key {
    pub fn of(city: &City, by: Option<ColorBy>) -> Self {
        let names = match by {
            Some(ColorBy::Source) => {
                provenances(city).filter_map(|p| p.source.as_deref()).collect::<BTreeSet<_>>()
            }
            Some(ColorBy::LandUse) => land_uses(city).collect(),
            _ => BTreeSet::new(),
        };
        Self { by, names: names.into_iter().map(str::to_owned).collect() }
    }

    pub fn street(&self, street: &Street) -> Option<Color> {
        Some(match self.by? {
            ColorBy::Class => class_color(street.class),
            ColorBy::Level => level_color(street.level),
            ColorBy::Role => role_color(street.role()),
            ColorBy::Origin | ColorBy::Source => self.provenance(&street.provenance)?,
            ColorBy::LandUse | ColorBy::Height => return None,
        })
    }

    pub fn building(&self, building: &Building) -> Option<Color> {
        match self.by? {
            ColorBy::Height => Some(height_color(building.known_height_m())),
            ColorBy::LandUse => building.usage.as_deref().map(|name| self.named(name)),
            _ => self.provenance(&building.provenance),
        }
    }

    pub fn land_use(&self, name: Option<&str>) -> Option<Color> {
        (self.by? == ColorBy::LandUse).then(|| name.map(|n| self.named(n)))?
    }

    pub fn provenance(&self, provenance: &Provenance) -> Option<Color> {
        match self.by? {
            ColorBy::Origin => Some(origin_color(provenance.origin)),
            ColorBy::Source => {
                Some(provenance.source.as_deref().map_or(UNKNOWN, |name| self.named(name)))
            }
            _ => None,
        }
    }

    /// What the colours mean, for the values that `city` has.
    pub fn legend(&self, city: &City) -> Vec<Entry> {
        let entry = |label: &str, color| Entry { label: label.replace('_', " "), color };
        let others = || city.other_ways.iter().map(|w| &w.street);
        let streets = || city.streets.edges().map(|(_, e)| &e.data).chain(others());
        match self.by {
            None => Vec::new(),
            Some(ColorBy::Class) => {
                let present: BTreeSet<Class> = streets().map(|s| s.class).collect();
                present.into_iter().map(|c| entry(c.as_str(), class_color(c))).collect()
            }
            Some(ColorBy::Role) => {
                let present: BTreeSet<Role> = streets().map(Street::role).collect();
                present.into_iter().map(|r| entry(r.as_str(), role_color(r))).collect()
            }
            Some(ColorBy::Level) => {
                let present: BTreeSet<u8> = streets().map(|s| s.level).collect();
                present.into_iter().map(|l| entry(&format!("level {l}"), level_color(l))).collect()
            }
            Some(ColorBy::Origin) => {
                let present: BTreeSet<Origin> = provenances(city).map(|p| p.origin).collect();
                present.into_iter().map(|o| entry(o.as_str(), origin_color(o))).collect()
            }
            Some(ColorBy::Source | ColorBy::LandUse) => {
                let mut out: Vec<Entry> =
                    self.names.iter().map(|n| entry(n, self.named(n))).collect();
                if out.len() > 24 {
                    out.truncate(24);
                    out.push(entry("...", UNKNOWN));
                }
                out
            }
            Some(ColorBy::Height) => {
                let known = HEIGHTS.iter().map(|(_, label, hex)| entry(label, rgb(*hex)));
                known.chain([entry("unknown", UNKNOWN)]).collect()
            }
        }
    }

    fn named(&self, name: &str) -> Color {
        if self.by == Some(ColorBy::LandUse)
            && let Some(color) = land_use_color(name)
        {
            return color;
        }
        let at = self.names.iter().position(|n| n == name);
        at.map_or(UNKNOWN, |i| rgb(HUES[i % HUES.len()]))
    }
}

fn provenances(city: &City) -> impl Iterator<Item = &Provenance> {
    let streets = city.streets.edges().map(|(_, e)| &e.data.provenance);
    streets.chain(city.buildings.iter().map(|b| &b.provenance))
}

fn land_uses(city: &City) -> impl Iterator<Item = &str> {
    let blocks = city.blocks.iter().filter_map(|b| b.land_use.as_deref());
    let parcels = city.parcels.iter().filter_map(|p| p.land_use.as_deref());
    let buildings = city.buildings.iter().filter_map(|b| b.usage.as_deref());
    blocks.chain(parcels).chain(buildings)
}

fn class_color(class: Class) -> Color {
    rgb(match class {
        Class::Motorway => 0xd9534f,
        Class::MotorwayLink => 0xe58a87,
        Class::Trunk => 0xe0762f,
        Class::TrunkLink => 0xeba679,
        Class::Primary => 0xf0a500,
        Class::PrimaryLink => 0xf4c258,
        Class::Secondary => 0xc9bf2a,
        Class::SecondaryLink => 0xdcd575,
        Class::Tertiary => 0x5fae4f,
        Class::TertiaryLink => 0x98cc8d,
        Class::Unclassified => 0x4f8fc4,
        Class::Residential => 0x7d95ab,
        Class::LivingStreet => 0x4fb3ab,
        Class::Road => 0x9a8f86,
        Class::Pedestrian => 0xb07fc0,
        Class::Service => 0xbdb7ae,
    })
}

fn role_color(role: Role) -> Color {
    rgb(match role {
        Role::Main => 0xd1493f,
        Role::Local => 0x4477aa,
        Role::Other => 0xb5afa6,
    })
}

fn level_color(level: u8) -> Color {
    const LEVELS: [u32; 6] = [0xb3261e, 0xe0762f, 0xe3b23c, 0x6fae5c, 0x4f8fc4, 0x8a7fb8];
    rgb(LEVELS[usize::from(level).min(LEVELS.len() - 1)])
}

fn origin_color(origin: Origin) -> Color {
    rgb(match origin {
        Origin::Imported => 0x6f7a80,
        Origin::Example => 0x3b6fb6,
        Origin::Procedural => 0xe08a2c,
        Origin::Joined => 0x3f9a57,
        Origin::Bridge => 0x8460ad,
        Origin::Sketch => 0xc8453f,
        Origin::Edited => 0xd77fb4,
    })
}

fn height_color(height_m: Option<f64>) -> Color {
    let bin = |h: f64| HEIGHTS.iter().find(|(below, ..)| h < *below).map(|(.., hex)| rgb(*hex));
    height_m.and_then(bin).unwrap_or(UNKNOWN)
}

/// Well-known uses keep the colours that planners give them.
fn land_use_color(name: &str) -> Option<Color> {
    Some(rgb(match name {
        "residential" | "apartments" | "house" | "detached" | "terrace" => 0xf2d16b,
        "commercial" | "retail" | "office" | "shop" => 0xd95f4c,
        "industrial" | "warehouse" => 0x9b7fb5,
        "park" | "garden" | "grass" | "recreation_ground" => 0x8cc474,
        "forest" | "wood" => 0x5b9a57,
        "cemetery" => 0x9dbd94,
        "school" | "university" | "hospital" | "public" | "civic" => 0x5b8cc4,
        "mixed" | "mixed_use" => 0xe59a5a,
        _ => return None,
    }))
}
