//! Insets of polygons and carriageways of lines.

use geo::Buffer;
use geo::algorithm::buffer::{BufferStyle, LineCap, LineJoin};

use crate::{Polygon, Vec2, convert};

/// Mitres sharper than this angle are bevelled.
const MITRE_MIN_ANGLE_RAD: f64 = 0.35;

/// How the ends of a line are covered by [`carriageway`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    /// The area stops at the end point.
    Butt,
    /// The area runs half a width past the end point.
    Square,
    /// A half circle around the end point.
    Round,
}

/// `polygon` shrunk by `distance_m` on every side (grown when negative), with mitred corners.
pub fn inset(polygon: &Polygon, distance_m: f64) -> Vec<Polygon> {
    if distance_m == 0.0 {
        return vec![polygon.clone()];
    }
    let style = BufferStyle::new(-distance_m).line_join(LineJoin::Miter(MITRE_MIN_ANGLE_RAD));
    convert::from_geo(convert::to_geo(polygon).buffer_with_style(style))
}

/// The area within `half_width_m` of a line in metres, with round joins.
pub fn carriageway(line: &[Vec2], half_width_m: f64, cap: Cap) -> Vec<Polygon> {
    // An eighth of a turn per step: kerbs are drawn in metres, not in millimetres.
    const STEP_RAD: f64 = std::f64::consts::FRAC_PI_8;
    let cap = match cap {
        Cap::Butt => LineCap::Butt,
        Cap::Square => LineCap::Square,
        Cap::Round => LineCap::Round(STEP_RAD),
    };
    let style = BufferStyle::new(half_width_m).line_cap(cap).line_join(LineJoin::Round(STEP_RAD));
    convert::from_geo(convert::line_to_geo(line).buffer_with_style(style))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GridPoint;

    #[test]
    fn an_inset_rectangle_loses_the_distance_on_every_side() {
        let block = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(100.0, 50.0));
        let inner = inset(&block, 5.0);
        assert_eq!(inner.len(), 1);
        assert!((inner[0].area_m2() - 90.0 * 40.0).abs() < 0.1);
        assert!(inset(&block, 30.0).is_empty());
    }

    #[test]
    fn a_straight_carriageway_is_length_times_width() {
        let road = carriageway(&[Vec2::ZERO, Vec2::new(100.0, 0.0)], 3.5, Cap::Butt);
        assert!((road.iter().map(Polygon::area_m2).sum::<f64>() - 700.0).abs() < 0.1);
    }
}
