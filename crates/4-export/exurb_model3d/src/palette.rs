//! Colours, and the dice that spread them: a number decides, so that models repeat.

/// A linear colour with opacity, 255 = 1, as glTF's vertex colours are.
pub type Linear = [u8; 4];

/// The linear colour of `0xRRGGBB` as screens show it.
pub fn linear(hex: u32) -> Linear {
    let channel = |shift: u32| {
        let v = f64::from((hex >> shift) & 255) / 255.0;
        (from_srgb(v) * 255.0).round() as u8
    };
    [channel(16), channel(8), channel(0), 255]
}

/// Linear light of a screen value, both 0 to 1.
pub fn from_srgb(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { exurb_geom::trig::pow((v + 0.055) / 1.055, 2.4) }
}

/// Screen value of linear light, both 0 to 1.
pub fn to_srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * exurb_geom::trig::pow(v, 1.0 / 2.4) - 0.055 }
}

/// A colour times `factor`.
pub fn scaled(color: Linear, factor: f64) -> Linear {
    let scale = |v: u8| (f64::from(v) * factor).round().clamp(0.0, 255.0) as u8;
    [scale(color[0]), scale(color[1]), scale(color[2]), color[3]]
}

/// A well-mixed number from an element's number and a purpose (splitmix64).
pub fn dice(id: u32, purpose: u32) -> u32 {
    let mut z = (u64::from(purpose) << 32 | u64::from(id)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as u32
}

/// [`dice`] from 0 to 1.
pub fn share(id: u32, purpose: u32) -> f64 {
    f64::from(dice(id, purpose)) / f64::from(u32::MAX)
}

/// One of `hexes`.
pub fn pick(hexes: &[u32], id: u32, purpose: u32) -> Linear {
    linear(hexes[dice(id, purpose) as usize % hexes.len()])
}

pub const ASPHALT: u32 = 0x5d5f63;
pub const PAVED: u32 = 0xaaa397;
pub const PAVEMENT: u32 = 0xb3afa6;
pub const KERB: u32 = 0x9c9890;
pub const MARKING: u32 = 0xe9e7df;
pub const CONCRETE: u32 = 0xa9a59c;
pub const WATER: u32 = 0x4f86a6;
pub const BANK: u32 = 0x8c8371;
pub const GROUND: u32 = 0x98a07a;
pub const LAMP: u32 = 0x4a4d50;
pub const LAMP_HEAD: u32 = 0xf7e9b8;
pub const TRUNK: u32 = 0x6b5340;

/// Ground of a block by its land use.
pub fn ground_of(land_use: Option<&str>) -> u32 {
    match land_use {
        Some(
            "park" | "garden" | "grass" | "meadow" | "village_green" | "recreation_ground"
            | "golf_course",
        ) => 0x86a35e,
        Some("forest" | "wood" | "nature_reserve" | "scrub" | "heath") => 0x6c8a50,
        Some("cemetery" | "allotments" | "orchard" | "vineyard") => 0x98ab74,
        Some("pitch" | "playground" | "sports_centre" | "stadium") => 0x86b06c,
        Some("farmland") => 0xb9ae76,
        Some("beach" | "sand") => 0xdccfa0,
        Some("wetland") => 0x8aa384,
        Some("commercial" | "retail" | "industrial" | "railway" | "port" | "parking") => 0xa59f93,
        Some("construction" | "brownfield" | "quarry") => 0xb3a48c,
        _ => 0x9fa682,
    }
}

/// Gardens, then yards.
pub const LOTS: [u32; 6] = [0x8fa36a, 0x99a878, 0x86995f, 0x95a06f, 0xa3a489, 0xa9a392];
/// How many of [`LOTS`] are gardens.
pub const GREEN_LOTS: usize = 4;

/// Crowns.
pub const LEAVES: [u32; 6] = [0x5f8a45, 0x6b9650, 0x567f42, 0x7a9c55, 0x4e7a48, 0x86a05a];
