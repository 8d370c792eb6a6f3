//! Layouts of few large buildings, fitted as a whole.
//!
//! Hartmann 2018, section 5.2.5: a school, a hospital, a stadium is not to be replicated; its layout goes
//! with the block by a geometric adaption. Here: turned and shifted as the outlines say, and lengthened
//! or shortened along the axes of its block by at most a third.

use exurb_geom::{GridPoint, OrientedBox, Polygon, Rigid, Vec2};

use super::Correspondence;
use super::path::inverse;
use crate::motion::Motion;
use crate::ring::Ring;

/// Buildings over this area are large, in m².
const LARGE_M2: f64 = 600.0;
/// Large ones take this share of what is built.
const LARGE_SHARE: f64 = 0.7;
/// At most so many of them.
const FEW: usize = 3;
/// Places along the outlines that are compared.
const PLACES: usize = 48;
/// Least and most stretch.
const STRETCH: (f64, f64) = (0.75, 1.33);

/// Does a layout consist of few large buildings, large beside the block, too?
pub fn is_whole(block_m2: f64, polygons: &[&Polygon]) -> bool {
    let areas = || polygons.iter().map(|p| p.area_m2());
    let large: Vec<f64> = areas().filter(|a| *a >= LARGE_M2.max(0.04 * block_m2)).collect();
    let built: f64 = areas().sum();
    (1..=FEW).contains(&large.len()) && large.iter().sum::<f64>() >= LARGE_SHARE * built
}

/// The motion of everything in one outline to another.
pub fn fitted(outline: &[GridPoint], from: &Ring, to: &Ring, link: &Correspondence) -> Motion {
    let pairs: Vec<(Vec2, Vec2)> = (0..PLACES)
        .map(|k| from.length_m() * k as f64 / PLACES as f64)
        .map(|at| (from.point_at(at), to.point_at(link.to_target(at))))
        .collect();
    let rigid = Rigid::fit(pairs.iter().map(|(p, q)| (*p, *q, 1.0)));
    let Some(frame) = OrientedBox::of(outline) else { return rigid.into() };
    let out = Rigid { turn: frame.axis, shift: frame.center, mirrored: false };
    let into = inverse(&out);
    let back = inverse(&rigid);
    let stretch = |axis: fn(Vec2) -> f64| {
        let local = |p: Vec2| axis(into.apply(p));
        let (sum, square) = pairs.iter().fold((0.0, 0.0), |(sum, square), (p, q)| {
            let (x, y) = (local(*p), local(back.apply(*q)));
            (sum + x * y, square + x * x)
        });
        (sum / square.max(1e-9)).clamp(STRETCH.0, STRETCH.1)
    };
    let stretch = Vec2::new(stretch(|p| p.x), stretch(|p| p.y));
    Motion { into, stretch, out: out.then(&rigid) }
}
