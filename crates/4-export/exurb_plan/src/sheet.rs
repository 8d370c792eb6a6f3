//! What the styles are made of: the colours of every theme.

use exurb_city::{Class, Role, Street};

use crate::Style;
use crate::color::{Color, rgb};

/// Colours of everything but streets and land use.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    style: Style,
    /// Are local streets too narrow for a ribbon between two lines?
    as_lines: bool,
    pub paper: Color,
    pub block: Color,
    pub block_line: Color,
    pub parcel_line: Color,
    pub water: Color,
    pub water_line: Color,
    pub building: Color,
    pub public_building: Color,
    pub building_line: Color,
    pub building_shadow: Color,
    pub tree: Color,
    pub tree_line: Color,
    pub lamp: Color,
    pub bridge: Color,
    pub text: Color,
    pub plate: Color,
}

/// Colours and least width of a street.
#[derive(Clone, Copy, Debug)]
pub struct StreetPaint {
    pub fill: Color,
    pub casing: Color,
    /// Narrowest on paper, for maps where metres vanish.
    pub least_px: f32,
}

const LIGHT: Sheet = Sheet {
    style: Style::Default,
    as_lines: false,
    paper: rgb(0xece8de),
    block: rgb(0xf0ece3),
    block_line: rgb(0xdcd5c6),
    parcel_line: rgb(0xdfd7c8),
    water: rgb(0xa8cfe4),
    water_line: rgb(0x7cb0cd),
    building: rgb(0xd8ccbc),
    public_building: rgb(0xcdb9a4),
    building_line: rgb(0xab9a84),
    building_shadow: rgb(0x5c4a34).alpha(52),
    tree: rgb(0x86b56b).alpha(165),
    tree_line: rgb(0x5f9449).alpha(150),
    lamp: rgb(0xd9a437),
    bridge: rgb(0x6f675c),
    text: rgb(0x3c3730),
    plate: rgb(0xffffff).alpha(215),
};

const DARK: Sheet = Sheet {
    style: Style::Dark,
    as_lines: false,
    paper: rgb(0x14181d),
    block: rgb(0x1b2027),
    block_line: rgb(0x252c35),
    parcel_line: rgb(0x29313b),
    water: rgb(0x0d2b40),
    water_line: rgb(0x1c4a68),
    building: rgb(0x2f3742),
    public_building: rgb(0x434857),
    building_line: rgb(0x46515f),
    building_shadow: rgb(0x000000).alpha(90),
    tree: rgb(0x2c4a33).alpha(200),
    tree_line: rgb(0x3d6646).alpha(160),
    lamp: rgb(0xe8c05a),
    bridge: rgb(0x0a0c0f),
    text: rgb(0xd7dde4),
    plate: rgb(0x0d1014).alpha(215),
};

impl Sheet {
    /// The sheet of a style. Light streets on light ground are lost where they are but a few pixels
    /// wide: with `as_lines` the default style draws local streets as dark lines and main ones
    /// darker.
    pub fn of(style: Style, as_lines: bool) -> Self {
        match style {
            Style::Default => Self { as_lines, ..LIGHT },
            Style::Dark => DARK,
            Style::Figure => Self { style, paper: rgb(0xffffff), text: rgb(0x000000), ..LIGHT },
        }
    }

    /// Streets and nothing else?
    pub fn is_figure(&self) -> bool {
        self.style == Style::Figure
    }

    /// Width of a street's carriageway on the ground; the figure style knows roles only.
    pub fn width_m(&self, street: &Street) -> f64 {
        match street.role() {
            _ if !self.is_figure() => street.width_m(),
            Role::Main => 14.0,
            Role::Local => 7.0,
            Role::Other => 3.0,
        }
    }

    pub fn street(&self, class: Class) -> StreetPaint {
        let paint = |fill: u32, casing: u32, least_px| StreetPaint {
            fill: rgb(fill),
            casing: rgb(casing),
            least_px,
        };
        if self.as_lines {
            return match class {
                Class::Motorway => paint(0xe5823a, 0x8f4a14, 3.2),
                Class::Trunk => paint(0xec9a43, 0x94591a, 3.0),
                Class::MotorwayLink | Class::TrunkLink => paint(0xec9a43, 0x94591a, 1.6),
                Class::Primary => paint(0xf2b54a, 0x94681c, 2.8),
                Class::Secondary => paint(0xf7cf6d, 0x97772c, 2.4),
                Class::Tertiary => paint(0xfbe49c, 0x8f7d45, 2.0),
                Class::PrimaryLink | Class::SecondaryLink | Class::TertiaryLink => {
                    paint(0xf7cf6d, 0x97772c, 1.4)
                }
                Class::Pedestrian | Class::LivingStreet => paint(0x9b8a80, 0xf6f3ec, 1.1),
                Class::Service => paint(0xb3aa9c, 0xf6f3ec, 0.7),
                _ => paint(0x7d7468, 0xf6f3ec, 1.2),
            };
        }
        match (self.style, class) {
            (Style::Figure, c) => paint(0, 0, if c.role() == Role::Main { 2.4 } else { 1.0 }),
            (Style::Default, Class::Motorway) => paint(0xf0a35e, 0xb96a2c, 3.6),
            (Style::Default, Class::Trunk) => paint(0xf6bb70, 0xc48436, 3.4),
            (Style::Default, Class::MotorwayLink | Class::TrunkLink) => {
                paint(0xf6bb70, 0xc48436, 2.0)
            }
            (Style::Default, Class::Primary | Class::PrimaryLink) => paint(0xfbd684, 0xcaa045, 3.0),
            (Style::Default, Class::Secondary | Class::SecondaryLink) => {
                paint(0xfde8a9, 0xcbb169, 2.6)
            }
            (Style::Default, Class::Tertiary | Class::TertiaryLink) => {
                paint(0xfff3c4, 0xbfab74, 2.2)
            }
            (Style::Default, Class::Pedestrian) => paint(0xf0e7e3, 0xcdbdb4, 1.2),
            (Style::Default, Class::LivingStreet) => paint(0xfbf9f5, 0xcbc3b5, 1.2),
            (Style::Default, Class::Service) => paint(0xfdfcfa, 0xd0c8b9, 0.8),
            (Style::Default, _) => paint(0xffffff, 0xb5aa98, 1.6),
            (Style::Dark, Class::Motorway | Class::Trunk) => paint(0xd98b4a, 0x14181d, 3.4),
            (Style::Dark, Class::MotorwayLink | Class::TrunkLink) => paint(0xb87842, 0x14181d, 2.0),
            (Style::Dark, Class::Primary | Class::PrimaryLink) => paint(0xc9a35a, 0x14181d, 2.8),
            (Style::Dark, Class::Secondary | Class::SecondaryLink) => {
                paint(0xa39063, 0x14181d, 2.4)
            }
            (Style::Dark, Class::Tertiary | Class::TertiaryLink) => paint(0x8b8470, 0x14181d, 2.0),
            (Style::Dark, Class::Service) => paint(0x3a424d, 0x1b2027, 0.7),
            (Style::Dark, _) => paint(0x636d7a, 0x14181d, 1.3),
        }
    }

    /// Fill of a land use; `None` where it says no more than the block below.
    pub fn land_use(&self, class: &str) -> Option<Color> {
        let light = light_land_use(class)?;
        Some(match self.style {
            Style::Dark => {
                // The light colour's hue at the darkness of the ground.
                let grey = (u32::from(light.r) + u32::from(light.g) + u32::from(light.b)) / 3;
                let tint = |c: u8| (i32::from(c) - grey as i32) * 2 / 3;
                let add = |base: u8, c: u8| (i32::from(base) + tint(c) + 4).clamp(0, 255) as u8;
                let b = self.block;
                Color { r: add(b.r, light.r), g: add(b.g, light.g), b: add(b.b, light.b), a: 255 }
            }
            _ => light,
        })
    }
}

fn light_land_use(class: &str) -> Option<Color> {
    let hex = match class {
        "park" | "garden" | "recreation_ground" | "golf_course" | "dog_park" => 0xcfe4b6,
        "forest" | "wood" | "nature_reserve" => 0xb9d5a0,
        "grass" | "village_green" | "meadow" | "greenfield" | "flowerbed" => 0xdbeac3,
        "scrub" | "heath" | "plant_nursery" => 0xcfdcae,
        "cemetery" | "grave_yard" => 0xc6d9bd,
        "pitch" | "sports_centre" | "stadium" | "track" => 0xbadcb2,
        "playground" => 0xdceab8,
        "allotments" | "orchard" | "vineyard" => 0xd8e4b4,
        "farmland" | "farmyard" => 0xf0e9cb,
        "beach" | "sand" => 0xf6e8bd,
        "wetland" => 0xc3ddca,
        "water" | "basin" | "reservoir" => 0xa8cfe4,
        "commercial" | "retail" => 0xf3e3dc,
        "industrial" | "port" | "construction" | "brownfield" => 0xe6e0e6,
        "railway" => 0xe4e1df,
        "school" | "university" | "college" | "kindergarten" | "hospital" | "education"
        | "institutional" | "religious" => 0xf2ebcf,
        "military" => 0xecdcd4,
        "parking" => 0xebe8e1,
        "bare_rock" | "scree" | "quarry" => 0xdedad3,
        _ => return None,
    };
    Some(rgb(hex))
}
