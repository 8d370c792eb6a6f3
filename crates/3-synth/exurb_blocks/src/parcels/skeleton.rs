//! Blocks in strips along their streets, cut across into parcels.
//!
//! Source: Vanegas, Kelly, Weber, Halatsch, Aliaga, Müller 2012, *Procedural Generation of Parcels in
//! Urban Modeling*, the skeleton method: the straight skeleton parts the block into one strip a street
//! (the faces of the sides between two corners together); the diagonal ends of strips at corners go to
//! the longer street, down to a border square to the shorter one; strips are cut square to their street,
//! and deeper land stays one court where asked for. Departures: strips follow the sides between corners,
//! not street names; frontages come in the order of the example's kerb. `None` where the skeleton
//! degenerates. O(vertices²), as the skeleton.

use std::collections::BTreeMap;

use exurb_geom::{Polygon, Vec2, straight_skeleton::Skeleton};

use crate::retarget::Path;
use crate::ring::{Ring, Side};

/// Strips of a block.
pub struct Strips {
    /// Borders between strips and across them.
    pub lines: Vec<Vec<Vec2>>,
    strips: Vec<Strip>,
    faces: Vec<(Vec<Vec2>, usize)>,
    depth_m: f64,
}

struct Strip {
    path: Path,
    /// Where parcels part, ascending.
    cuts_m: Vec<f64>,
    /// Label of its first parcel.
    first: u32,
    /// Corner pieces given to it: ground in the face of another strip.
    corners: Vec<Vec<Vec2>>,
}

/// Owner of the land behind the strips.
pub const COURT: u32 = u32::MAX - 1;

/// Strips of `ground` that are `depth_m` deep at most; `next_m` gives wanted frontages.
pub fn strips(ground: &Polygon, depth_m: f64, mut next_m: impl FnMut() -> f64) -> Option<Strips> {
    let skeleton = Skeleton::of(ground)?;
    let mut sides: Vec<(Ring, Side)> = Vec::new();
    // Side of every segment, ring by ring.
    let mut of_segment = Vec::new();
    for points in ground.rings() {
        let ring = Ring::of(points);
        let own = ring.sides();
        for i in 0..points.len() {
            let middle = (ring.vertex_m(i) + ring.vertex_m(i + 1)) / 2.0;
            let within = |s: &Side| (middle - s.start_m).rem_euclid(ring.length_m()) < s.length_m();
            of_segment.push(sides.len() + own.iter().position(within).unwrap_or(0));
        }
        sides.extend(own.into_iter().map(|side| (ring.clone(), side)));
    }
    let at = |node: &usize| skeleton.nodes[*node].at;
    let faces: Vec<(Vec<Vec2>, usize)> = skeleton
        .faces
        .iter()
        .zip(&of_segment)
        .map(|(face, side)| (face.iter().map(at).collect(), *side))
        .collect();
    let mut strips = Vec::new();
    let mut first = 0;
    for (ring, side) in &sides {
        let path = Path::new(ring.part(side.start_m, side.end_m))?;
        let cuts_m = cuts(path.length_m(), &mut next_m);
        let count = cuts_m.len() as u32 + 1;
        strips.push(Strip { path, cuts_m, first, corners: Vec::new() });
        first += count;
    }
    let mut lines: Vec<Vec<Vec2>> = faces
        .iter()
        .map(|(face, _)| {
            let mut line = face.clone();
            line.extend(face.first().copied());
            line
        })
        .collect();
    corners(&skeleton, &of_segment, &mut strips, &mut lines);
    for strip in &strips {
        for cut in &strip.cuts_m {
            let frame = strip.path.frame(cut - 0.5, cut + 0.5);
            lines.push(vec![
                frame.apply(Vec2::new(0.0, -1.0)),
                frame.apply(Vec2::new(0.0, depth_m)),
            ]);
        }
    }
    Some(Strips { lines, strips, faces, depth_m })
}

impl Strips {
    /// The parcel that a point belongs to.
    pub fn owner(&self, p: Vec2) -> u32 {
        let in_corner = |s: &Strip| s.corners.iter().any(|c| holds(c, p));
        let by_corner = self.strips.iter().position(in_corner);
        let by_face = || self.faces.iter().find(|(face, _)| holds(face, p)).map(|(_, side)| *side);
        let Some(strip) = by_corner.or_else(by_face).map(|k| &self.strips[k]) else { return COURT };
        let (at_m, distance_m) = strip.path.nearest(p);
        if distance_m > self.depth_m {
            return COURT;
        }
        strip.first + strip.cuts_m.partition_point(|cut| *cut < at_m) as u32
    }
}

/// Gives the diagonal piece at each corner to the longer street: what lies between the border that the
/// skeleton draws from the corner and the square from its end to the shorter street.
fn corners(
    skeleton: &Skeleton,
    of_segment: &[usize],
    strips: &mut [Strip],
    lines: &mut Vec<Vec<Vec2>>,
) {
    let mut arcs: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (face, strip) in skeleton.faces.iter().zip(of_segment) {
        for (i, node) in face.iter().enumerate().skip(1) {
            let next = face[(i + 1) % face.len()];
            arcs.entry((*node.min(&next), *node.max(&next))).or_default().push(*strip);
        }
    }
    let parts = |strips: &[usize], a: usize, b: usize| matches!(strips, [x, y] if (*x, *y) == (a, b) || (*x, *y) == (b, a));
    for (face, strip) in skeleton.faces.iter().zip(of_segment) {
        let corner = face[0];
        let before = skeleton.faces.iter().zip(of_segment).find(|(f, _)| f[1] == corner);
        let Some((_, other)) = before.filter(|(_, other)| *other != strip) else { continue };
        let mut border = vec![corner];
        loop {
            let here = border[border.len() - 1];
            let next = arcs.iter().find_map(|((u, v), sides)| {
                let there = if *u == here { *v } else { *u };
                let goes = (*u == here || *v == here) && !border.contains(&there);
                (goes && parts(sides, *strip, *other)).then_some(there)
            });
            match next {
                Some(next) => border.push(next),
                None => break,
            }
        }
        let (a, b) = (*strip, *other);
        let longer = strips[a].path.length_m() >= strips[b].path.length_m();
        let (winner, loser) = if longer { (a, b) } else { (b, a) };
        let mut piece: Vec<Vec2> = border.iter().map(|n| skeleton.nodes[*n].at).collect();
        let end = piece[piece.len() - 1];
        let foot = strips[loser].path.point_at(strips[loser].path.nearest(end).0);
        lines.push(vec![end, foot]);
        piece.push(foot);
        strips[winner].corners.push(piece);
    }
}

/// Is `p` inside a closed line?
fn holds(ring: &[Vec2], p: Vec2) -> bool {
    (0..ring.len()).fold(false, |inside, i| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let crossed = (a.y > p.y) != (b.y > p.y) && ((b - a).perp_dot(p - a) > 0.0) == (b.y > a.y);
        inside ^ crossed
    })
}

/// Where a strip is cut: wanted frontages, stretched to its length.
fn cuts(length_m: f64, next_m: &mut impl FnMut() -> f64) -> Vec<f64> {
    let mut widths: Vec<f64> = vec![next_m().max(1.0)];
    let mut sum = widths[0];
    loop {
        let width = next_m().max(1.0);
        // One more only if that comes nearer to the length.
        if sum + width / 2.0 > length_m {
            break;
        }
        sum += width;
        widths.push(width);
    }
    let mut at = 0.0;
    widths.pop();
    widths
        .into_iter()
        .map(|width| {
            at += width * length_m / sum;
            at
        })
        .collect()
}
