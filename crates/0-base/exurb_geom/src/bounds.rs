use crate::{GridPoint, Vec2};

/// An axis-parallel box in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// South-west corner.
    pub min: Vec2,
    /// North-east corner.
    pub max: Vec2,
}

impl Bounds {
    /// The box of `points`; `None` when there are none.
    pub fn of(points: impl IntoIterator<Item = GridPoint>) -> Option<Self> {
        points.into_iter().map(GridPoint::to_m).fold(None, |bounds, p| match bounds {
            None => Some(Self { min: p, max: p }),
            Some(Self { min, max }) => Some(Self { min: min.min(p), max: max.max(p) }),
        })
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// This box with `margin_m` more on every side.
    pub fn grown(self, margin_m: f64) -> Self {
        Self { min: self.min - margin_m, max: self.max + margin_m }
    }

    /// Width and height in metres.
    pub fn size(self) -> Vec2 {
        self.max - self.min
    }

    /// The middle.
    pub fn center(self) -> Vec2 {
        (self.min + self.max) / 2.0
    }

    /// Does the closed box hold `p`?
    pub fn contains(self, p: Vec2) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// Do the closed boxes share a point?
    pub fn intersects(self, other: Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}
