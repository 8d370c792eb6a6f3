//! Blocks split along their oriented boxes, again and again.
//!
//! Source: Vanegas, Kelly, Weber, Halatsch, Aliaga, Müller 2012, *Procedural Generation of Parcels in
//! Urban Modeling*, the box method: a piece is cut across its smallest enclosing rectangle, through the
//! middle, a little to one side; where that leaves a piece without street access, the cut is turned by
//! 90 degrees as often as asked for. Departures: a piece that is small enough by area or by width is left
//! alone, and a cut that would make one too small is refused (public transcriptions of the rule
//! contradict each other, and the only reading that ends is this one); what has no access in the end is
//! joined to a neighbour. O(parcels · vertices).

use exurb_geom::{GridPoint, OrientedBox, Polygon, SegmentGrid, Vec2, overlay, polyline, split};
use exurb_operation::Rng;
use rand::RngExt;

/// What parcels should be like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Least and most area in m².
    pub area_m2: (f64, f64),
    /// Least and most width in metres.
    pub width_m: (f64, f64),
    /// How far cuts lie beside the middle at most, as a share of the side cut.
    pub irregularity: f64,
    /// How often a cut that takes a piece's street access away is turned.
    pub access: f64,
}

/// A piece with less of the block's boundary has no street access, in metres.
const ACCESS_M: f64 = 3.0;
/// Cuts run over their ends by this much, in metres.
const OVER_M: f64 = 0.03;

/// Lines that cut `ground` into parcels.
pub fn cuts(ground: &Polygon, wanted: &Wanted, rng: &mut Rng) -> Vec<Vec<Vec2>> {
    let kerb = SegmentGrid::new(ground.segments().collect());
    let mut out = Vec::new();
    let mut open = vec![ground.clone()];
    while let Some(piece) = open.pop() {
        let Some(cut) = cut(&piece, &kerb, wanted, rng) else { continue };
        out.extend(overlay::clip_line(&piece, &cut.line).iter().map(|line| lengthened(line)));
        open.extend(cut.parts);
    }
    out
}

/// A line and the parts it leaves.
struct Cut {
    line: [Vec2; 2],
    parts: Vec<Polygon>,
}

/// The cut of a piece; `None` where it is to stay whole.
fn cut(piece: &Polygon, kerb: &SegmentGrid, wanted: &Wanted, rng: &mut Rng) -> Option<Cut> {
    let frame = OrientedBox::of(piece.exterior())?;
    // Drawn in any case, so that one piece's draw does not hang on another's shape.
    let (beside, turns) = (rng.random_range(-0.5..=0.5), rng.random::<f64>() < wanted.access);
    if piece.area_m2() <= wanted.area_m2.1 {
        return None;
    }
    let shift = beside * wanted.irregularity;
    let plain = halves(piece, &frame, false, shift);
    let has_access = |cut: &Cut| cut.parts.iter().all(|p| frontage_m(p, kerb) >= ACCESS_M);
    let fits = |cut: &Cut| {
        let parts = &cut.parts;
        let narrow = |p: &Polygon| {
            OrientedBox::of(p.exterior()).is_none_or(|b| b.short_m() < wanted.width_m.0)
        };
        parts.len() > 1 && parts.iter().all(|p| p.area_m2() >= wanted.area_m2.0 && !narrow(p))
    };
    if fits(&plain) && (!turns || has_access(&plain)) {
        return Some(plain);
    }
    let turned = halves(piece, &frame, true, shift);
    if fits(&turned) && (has_access(&turned) || !fits(&plain)) {
        return Some(turned);
    }
    fits(&plain).then_some(plain)
}

/// A cut across the longer side of the box (or along it), `shift` of that side beside the middle.
fn halves(piece: &Polygon, frame: &OrientedBox, turned: bool, shift: f64) -> Cut {
    let (axis, half, reach) = if turned {
        (frame.axis.perp(), frame.half.y, frame.half.x)
    } else {
        (frame.axis, frame.half.x, frame.half.y)
    };
    let at = frame.center + axis * (2.0 * half * shift);
    let across = axis.perp() * (reach + 1.0);
    let (a, b) = (at - across, at + across);
    let mut parts = split::left_of(piece, a, b);
    parts.extend(split::left_of(piece, b, a));
    Cut { line: [a, b], parts }
}

/// A line carried on a little at both ends, so that rounding leaves no gap there.
fn lengthened(line: &[Vec2]) -> Vec<Vec2> {
    let mut out = line.to_vec();
    if let [first, .., last] = &mut out[..] {
        let along = (*last - *first).normalize_or_zero() * OVER_M;
        (*first, *last) = (*first - along, *last + along);
    }
    out
}

/// Length of a piece's boundary that lies on the block's.
fn frontage_m(piece: &Polygon, kerb: &SegmentGrid) -> f64 {
    const ON_M: f64 = 0.02;
    let mut near = Vec::new();
    let on_kerb = |a: GridPoint, b: GridPoint, near: &mut Vec<u32>| {
        let middle = (a.to_m() + b.to_m()) / 2.0;
        let at = GridPoint::round(middle);
        kerb.near(at, at, 50, near);
        near.iter().any(|id| {
            let (c, d) = kerb.segment(*id);
            polyline::nearest_on_segment(c.to_m(), d.to_m(), middle).0.distance(middle) < ON_M
        })
    };
    piece.segments().filter(|(a, b)| on_kerb(*a, *b, &mut near)).map(|(a, b)| a.distance_m(b)).sum()
}
