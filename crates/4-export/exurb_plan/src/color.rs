//! Colours.

/// A colour with opacity, not premultiplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color {
    pub r: u8,
    pub g: u8,
    pub b: u8,
    pub a: u8,
}

/// The opaque colour `0xRRGGBB`.
pub const fn rgb(hex: u32) -> Color {
    Color { r: (hex >> 16) as u8, g: (hex >> 8) as u8, b: hex as u8, a: 255 }
}

impl Color {
    /// The same colour at another opacity.
    pub const fn alpha(self, a: u8) -> Self {
        Self { a, ..self }
    }

    /// This colour with `share` (0 to 1) of `other` mixed in; the opacity stays.
    pub fn mix(self, other: Self, share: f32) -> Self {
        let blend = |p: u8, q: u8| (f32::from(p) + (f32::from(q) - f32::from(p)) * share) as u8;
        Self {
            r: blend(self.r, other.r),
            g: blend(self.g, other.g),
            b: blend(self.b, other.b),
            ..self
        }
    }

    /// A darker shade, for the outline of a fill.
    pub fn shade(self) -> Self {
        self.mix(rgb(0x000000), 0.35)
    }

    /// `#rrggbb`.
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.r, self.g, self.b)
    }

    /// Opacity from 0 to 1.
    pub fn opacity(self) -> f32 {
        f32::from(self.a) / 255.0
    }
}
