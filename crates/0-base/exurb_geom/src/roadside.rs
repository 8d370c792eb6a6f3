//! What streets take of the ground beside them.
//!
//! [`crate::offset::carriageway`] gives one street as a clean polygon, which costs an overlay. Here
//! the ground along many streets is collected in plain pieces, left of each line only, and taken off
//! an area in a single overlay: the pieces may overlap as they like.

use geo::{BooleanOps, Coord, LineString, bool_ops::FillRule};

use crate::{Polygon, Vec2, convert, trig};

/// Arcs are drawn in steps of an eighth of half a turn, as in [`crate::offset::carriageway`].
const STEP_RAD: f64 = std::f64::consts::FRAC_PI_8;

/// Cosine of [`STEP_RAD`].
const COS_STEP: f64 = 0.923_879_532_511_286_7;

/// Ground taken by streets.
#[derive(Clone, Debug, Default)]
pub struct Roadside {
    pieces: Vec<geo::Polygon<f64>>,
}

impl Roadside {
    /// Takes what lies left of the line within `width_m`, its outer bends rounded.
    ///
    /// As few strips as can be: two segments share a mitre where the line turns left and both are
    /// long enough, or turns right by no more than a step of an arc. Else a strip ends there, and
    /// the next one overlaps it or leaves room for an arc.
    pub fn left_of(&mut self, line: &[Vec2], width_m: f64) {
        let normals: Vec<Vec2> =
            line.windows(2).map(|w| (w[1] - w[0]).normalize_or_zero().perp()).collect();
        let mut strip = Strip::default();
        // What the mitre at its start takes off the outer side of the current segment.
        let mut taken_m = 0.0;
        for (i, w) in line.windows(2).enumerate() {
            let (at, before) = (w[0], i.checked_sub(1).map(|j| normals[j]));
            let mitre = before.and_then(|n| mitre(n, normals[i]));
            let length_m = |j: usize| line[j].distance(line[j + 1]);
            match (before, mitre) {
                (Some(_), Some((offset, setback)))
                    if setback * width_m + taken_m <= length_m(i - 1)
                        && setback * width_m <= length_m(i) =>
                {
                    strip.push(at, at + offset * width_m);
                    taken_m = setback * width_m;
                }
                _ => {
                    if let Some(before) = before {
                        strip.push(at, at + before * width_m);
                        self.push(&std::mem::take(&mut strip).outline());
                        self.bend(at, -before.perp(), w[1] - at, width_m);
                    }
                    strip.push(at, at + normals[i] * width_m);
                    taken_m = 0.0;
                }
            }
        }
        if let (Some(at), Some(normal)) = (line.last(), normals.last()) {
            strip.push(*at, *at + *normal * width_m);
            self.push(&strip.outline());
        }
    }

    /// Takes the rounded ground left of a right turn at `at` from direction `u` to `v`; nothing
    /// where the line turns left or goes straight on.
    pub fn bend(&mut self, at: Vec2, u: Vec2, v: Vec2, width_m: f64) {
        let turn = trig::atan2(u.perp_dot(v), u.dot(v));
        if turn >= 0.0 {
            return;
        }
        let steps = (-turn / STEP_RAD).ceil().max(1.0) as u32;
        let first = u.normalize_or_zero().perp() * width_m;
        let mut wedge = vec![at];
        // Counter-clockwise: from the later direction back to the earlier one.
        for i in (0..=steps).rev() {
            wedge.push(at + trig::rotate(first, turn * f64::from(i) / f64::from(steps)));
        }
        self.push(&wedge);
    }

    /// Takes the disc around `at`.
    pub fn disc(&mut self, at: Vec2, radius_m: f64) {
        const CORNERS: u32 = 16;
        let corner = |i| at + trig::unit(f64::from(i) * STEP_RAD) * radius_m;
        self.push(&(0..CORNERS).map(corner).collect::<Vec<_>>());
    }

    /// What is left of `area`, largest first.
    pub fn taken_off(self, area: &Polygon) -> Vec<Polygon> {
        if self.pieces.is_empty() {
            return vec![area.clone()];
        }
        // All pieces turn counter-clockwise, so that the non-zero rule reads them as their union.
        let taken = geo::MultiPolygon(self.pieces);
        let left = convert::to_geo(area).difference_with_fill_rule(&taken, FillRule::NonZero);
        convert::from_geo(left)
    }

    /// Adds a piece that turns counter-clockwise around each of its points.
    fn push(&mut self, corners: &[Vec2]) {
        let mut ring: Vec<Coord<f64>> = corners.iter().map(|p| Coord { x: p.x, y: p.y }).collect();
        ring.extend(ring.first().copied());
        self.pieces.push(geo::Polygon::new(LineString(ring), Vec::new()));
    }
}

/// A strip along a line: the line itself and its outer side.
#[derive(Default)]
struct Strip {
    line: Vec<Vec2>,
    side: Vec<Vec2>,
}

impl Strip {
    fn push(&mut self, on_line: Vec2, beside: Vec2) {
        self.line.push(on_line);
        self.side.push(beside);
    }

    fn outline(self) -> Vec<Vec2> {
        let mut out = self.line;
        out.extend(self.side.into_iter().rev());
        out
    }
}

/// Where the sides of two segments of unit normals `m` and `n` meet, for a width of 1: from the
/// vertex, and what is taken off each side (negative where it grows longer). `None` for sharp turns.
fn mitre(m: Vec2, n: Vec2) -> Option<(Vec2, f64)> {
    const SHARPEST_COS: f64 = -0.7;
    let (sin, cos) = (m.perp_dot(n), m.dot(n));
    let gentle = if sin >= 0.0 { cos > SHARPEST_COS } else { cos >= COS_STEP };
    gentle.then(|| ((m + n) / (1.0 + cos), sin / (1.0 + cos)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::offset::{Cap, carriageway};
    use crate::{GridPoint, overlay};

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn what_is_left_is_the_difference_with_whole_carriageways() {
        // A face with a bend, a reflex corner and sides of two widths.
        let corners =
            [(0., 0.), (90., 10.), (140., -20.), (200., 80.), (110., 60.), (100., 140.), (5., 90.)];
        let ring: Vec<Vec2> = corners.iter().map(|(x, y)| Vec2::new(*x, *y)).collect();
        let face = Polygon::new(ring.iter().map(|p| GridPoint::round(*p)).collect(), vec![]);
        let face = face.expect("has area");
        let widths = [6.0, 6.0, 3.0];
        let sides: Vec<Vec<Vec2>> =
            vec![ring[..4].to_vec(), ring[3..6].to_vec(), vec![ring[5], ring[6], ring[0]]];
        let mut roads = Roadside::default();
        for (side, width) in sides.iter().zip(widths) {
            roads.left_of(side, width);
            roads.disc(side[0], width);
            roads.disc(side[side.len() - 1], width);
        }
        let spur = [Vec2::new(5., 90.), Vec2::new(50., 70.)];
        roads.left_of(&spur, 2.0);
        roads.left_of(&[spur[1], spur[0]], 2.0);
        roads.disc(spur[1], 2.0);
        let fast = roads.taken_off(&face);

        let mut whole: Vec<Polygon> = Vec::new();
        for (side, width) in sides.iter().zip(widths) {
            whole.extend(carriageway(side, width, Cap::Round));
        }
        whole.extend(carriageway(&spur, 2.0, Cap::Round));
        let slow = overlay::difference(&face, &whole);
        assert_eq!((fast.len(), slow.len()), (1, 1));
        let apart = area(&overlay::difference(&fast[0], &slow))
            + area(&overlay::difference(&slow[0], &fast));
        assert!(apart < 2.0, "{apart} m² of {}", area(&slow));
    }

    #[test]
    fn nothing_taken_leaves_the_area() {
        let square = Polygon::rectangle(GridPoint::m(0.0, 0.0), GridPoint::m(9.0, 9.0));
        assert_eq!(Roadside::default().taken_off(&square), std::slice::from_ref(&square));
        let mut all = Roadside::default();
        all.disc(Vec2::splat(4.5), 20.0);
        assert!(all.taken_off(&square).is_empty());
    }
}
