//! How an element goes from where it stood to where it stands: turned, shifted, perhaps stretched a
//! little along an axis of its own.

use exurb_geom::{Polygon, Rigid, Vec2};

/// A rigid motion into a frame, a stretch there, and a rigid motion out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Into the frame.
    pub into: Rigid,
    /// The stretch along the frame's axes; positive.
    pub stretch: Vec2,
    /// Out of the frame.
    pub out: Rigid,
}

impl From<Rigid> for Motion {
    fn from(rigid: Rigid) -> Self {
        Self { into: Rigid::IDENTITY, stretch: Vec2::ONE, out: rigid }
    }
}

impl Motion {
    /// Where `p` goes.
    pub fn apply(&self, p: Vec2) -> Vec2 {
        self.out.apply(self.into.apply(p) * self.stretch)
    }

    /// Where a polygon goes; `None` where rounding leaves no area.
    pub fn apply_polygon(&self, polygon: &Polygon) -> Option<Polygon> {
        polygon.map(|p| self.apply(p))
    }

    /// This motion, then a rigid one.
    pub fn then(&self, next: &Rigid) -> Self {
        Self { out: self.out.then(next), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use exurb_geom::trig;

    use super::*;

    #[test]
    fn a_stretch_lengthens_along_its_axis_only() {
        let into = Rigid::about(Vec2::new(3.0, 4.0), trig::unit(-0.5), Vec2::ZERO);
        let out = Rigid::about(Vec2::new(3.0, 4.0), trig::unit(0.5), Vec2::ZERO);
        let motion = Motion { into, stretch: Vec2::new(2.0, 1.0), out };
        let along = trig::unit(0.5);
        let way = motion.apply(along) - motion.apply(Vec2::ZERO);
        assert!((way - along * 2.0).length() < 1e-9);
        let way = motion.apply(along.perp()) - motion.apply(Vec2::ZERO);
        assert!((way - along.perp()).length() < 1e-9);
    }
}
