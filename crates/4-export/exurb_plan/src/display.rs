//! The display list: what lies on the paper, in pixels, in order.

use std::sync::Arc;

use crate::color::Color;

/// A point on the paper in pixels, x right, y down.
pub type Px = [f32; 2];

/// Line ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cap {
    Butt,
    Round,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    pub color: Color,
    pub width_px: f32,
    pub cap: Cap,
    /// Lengths of dash and gap.
    pub dash_px: Option<[f32; 2]>,
}

impl Pen {
    /// A solid line with round ends.
    pub fn solid(color: Color, width_px: f32) -> Self {
        Self { color, width_px, cap: Cap::Round, dash_px: None }
    }
}

/// Fill and outline of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    pub fill: Option<Color>,
    pub pen: Option<Pen>,
}

impl Paint {
    pub fn fill(color: Color) -> Self {
        Self { fill: Some(color), pen: None }
    }

    pub fn pen(pen: Pen) -> Self {
        Self { fill: None, pen: Some(pen) }
    }

    pub fn both(color: Color, pen: Pen) -> Self {
        Self { fill: Some(color), pen: Some(pen) }
    }
}

/// The form of a mark.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Closed rings, filled by winding: outer rings one way, holes the other.
    Area(Vec<Vec<Px>>),
    /// An open line.
    Line(Vec<Px>),
    /// A circle.
    Disc { center: Px, radius_px: f32 },
    /// Pixels from the page's upper left corner on.
    Picture(Picture),
    /// Words that begin at `at` on the base line; `height_px` is that of a capital.
    Text { at: Px, height_px: f32, text: String },
}

/// Pixels, row by row from the top: red, green, blue, opacity.
#[derive(Clone, Debug)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub rgba: Arc<Vec<u8>>,
    /// Its size on the paper.
    pub size: [f32; 2],
}

/// One thing on the paper.
#[derive(Clone, Debug)]
pub struct Mark {
    pub shape: Shape,
    pub paint: Paint,
    /// A name to show on request, such as that of a street.
    pub title: Option<Arc<str>>,
}

impl Mark {
    pub fn new(shape: Shape, paint: Paint) -> Self {
        Self { shape, paint, title: None }
    }
}

/// Marks of one theme.
#[derive(Clone, Debug)]
pub struct Group {
    pub id: &'static str,
    pub marks: Vec<Mark>,
}

/// A whole map.
#[derive(Clone, Debug)]
pub struct Display {
    pub width_px: u32,
    pub height_px: u32,
    pub paper: Color,
    pub groups: Vec<Group>,
    /// Name of the city, may be empty.
    pub title: String,
    /// Attributions in one line, may be empty.
    pub attribution: String,
}
