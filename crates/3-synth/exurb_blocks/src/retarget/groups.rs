//! Arrangement groups: which elements stand along which side of the outline, and which in rows inside.

use exurb_geom::{BoxGrid, GridPoint, Polygon, Rigid, Vec2, polyline};

use super::Settings;
use super::path::{Path, inverse};
use crate::library::are_near;
use crate::ring::{Ring, Side};
use crate::slices::Slices;

/// How an element behaves when its group is laid out anew (Hartmann et al. 2015, section 3.2; the third
/// type, empty, is no element of the input).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// At a corner: stands at most once.
    Fixed,
    /// Along one side: may be repeated.
    Repeatable,
}

/// One or several polygons that stay together: a house and what stands behind it.
#[derive(Clone, Debug)]
pub struct Element {
    /// Indices of the polygons.
    pub members: Vec<usize>,
    /// How it behaves.
    pub kind: Kind,
    /// Where it stands along its path: from, to, in metres.
    pub span_m: (f64, f64),
    /// From the plane to its frame on the path.
    pub to_frame: Rigid,
    /// Its rings in that frame.
    pub rings: Vec<Vec<Vec2>>,
    /// The same in slices.
    pub slices: Slices,
    /// From where to where it reaches along the path from its middle, what stands behind it counted.
    pub reach_m: (f64, f64),
    /// Its area in m².
    pub area_m2: f64,
    /// How deep it reaches from the path, in metres.
    pub depth_m: f64,
    /// Does it share a wall with something before it along the path, and after it?
    pub walls: (bool, bool),
}

/// Elements along one path, in order along it.
#[derive(Clone, Debug)]
pub struct Group {
    /// The line they stand along.
    pub path: Path,
    /// Position of the path along the outline; `None` for a row inside.
    pub side: Option<Side>,
    /// The elements. Fixed ones are listed at both their sides.
    pub elements: Vec<Element>,
}

/// A layout analysed.
#[derive(Clone, Debug)]
pub struct Groups {
    /// Sides of the outline, then rows inside.
    pub groups: Vec<Group>,
    /// Polygons that belong to no group.
    pub singles: Vec<usize>,
}

/// An element at a corner is as near to its second side as to its first, give or take, in metres.
const CORNER_M: f64 = 5.0;
/// Elements that share more of their side than this, of the shorter, stay together.
const BEHIND_SHARE: f64 = 0.35;
/// What lies behind others and is this much longer than the longest of them belongs to none.
const BEHIND_RATIO: f64 = 1.5;

/// Walls nearer than this are one, in metres.
const WALL_M: f64 = 0.3;

/// How one polygon lies to one side.
#[derive(Clone, Copy)]
struct Lie {
    /// Directed Hausdorff distance, polygon to side (section 3.2; method: the symmetric one is at least
    /// half the side's length).
    farthest_m: f64,
    nearest_m: f64,
    span_m: (f64, f64),
}

impl Groups {
    /// Analyses the layout of `polygons` in the outline `ring`.
    pub fn of(ring: &Ring, polygons: &[Polygon], settings: &Settings) -> Self {
        let sides = ring.sides();
        let paths: Vec<(Side, Path)> = sides
            .iter()
            .filter_map(|s| Some((*s, Path::new(ring.part(s.start_m, s.end_m))?)))
            .collect();
        let corners: Vec<Vec<Vec2>> =
            polygons.iter().map(|p| polyline::to_m(p.exterior())).collect();
        let mut members: Vec<Vec<(usize, Kind, Lie)>> = vec![Vec::new(); paths.len()];
        let mut inner = Vec::new();
        for (i, corners) in corners.iter().enumerate() {
            let lies: Vec<Lie> = paths.iter().map(|(_, path)| lie(path, corners)).collect();
            let homes = homes(&lies, settings.reach);
            let kind = if homes.len() > 1 { Kind::Fixed } else { Kind::Repeatable };
            for home in &homes {
                members[*home].push((i, kind, lies[*home]));
            }
            if homes.is_empty() {
                inner.push(i);
            }
        }
        let mut groups: Vec<Group> = Vec::new();
        let mut behind = Vec::new();
        let mut by_side = Vec::new();
        for members in members {
            let (together, alone) = compounds(members);
            behind.extend(alone);
            by_side.push(together);
        }
        each_behind_one(&mut by_side);
        for ((side, path), together) in paths.into_iter().zip(by_side) {
            let elements = together
                .into_iter()
                .map(|(members, kind, span)| element(&path, members, kind, span, polygons))
                .collect();
            groups.push(Group { path, side: Some(side), elements });
        }
        let held =
            |i: &usize| groups.iter().flat_map(|g| &g.elements).any(|e| e.members.contains(i));
        behind.retain(|i| !held(i));
        inner.extend(behind);
        inner.sort_unstable();
        inner.dedup();
        let (rows, singles) = super::rows::rows(&inner, polygons);
        groups.extend(rows);
        let touching = touching(polygons);
        for element in groups.iter_mut().flat_map(|g| &mut g.elements) {
            element.walls = walls(element, &touching, polygons);
        }
        Self { groups, singles }
    }
}

/// An element in its frame.
pub fn element(
    path: &Path,
    members: Vec<usize>,
    kind: Kind,
    span_m: (f64, f64),
    polygons: &[Polygon],
) -> Element {
    let to_frame = inverse(&path.frame(span_m.0, span_m.1));
    let rings: Vec<Vec<Vec2>> = members
        .iter()
        .flat_map(|i| polygons[*i].rings())
        .map(|ring| ring.iter().map(|p| to_frame.apply(p.to_m())).collect())
        .collect();
    let slices = Slices::of(rings.iter().map(|r| &r[..]));
    let depth_m = rings.iter().flatten().map(|p| p.y).fold(0.0, f64::max);
    let area_m2 = slices.area_m2().max(1.0);
    Element {
        members,
        kind,
        span_m,
        to_frame,
        rings,
        reach_m: slices.span_m(f64::INFINITY).unwrap_or((0.0, 0.0)),
        slices,
        area_m2,
        depth_m,
        walls: (false, false),
    }
}

/// Pairs of polygons that share a wall.
fn touching(polygons: &[Polygon]) -> Vec<(usize, usize)> {
    let boxes = BoxGrid::of(polygons);
    let mut near = Vec::new();
    let mut out = Vec::new();
    for (i, polygon) in polygons.iter().enumerate() {
        let (lo, hi) = (polygon.bounds().grown(WALL_M).min, polygon.bounds().grown(WALL_M).max);
        boxes.meeting(GridPoint::round(lo), GridPoint::round(hi), &mut near);
        let others = near.iter().map(|j| *j as usize).filter(|j| *j > i);
        out.extend(others.filter(|j| are_near(polygon, &polygons[*j], WALL_M)).map(|j| (i, j)));
    }
    out
}

/// Does something that is not part of the element share a wall with it, before and after its middle?
fn walls(element: &Element, touching: &[(usize, usize)], polygons: &[Polygon]) -> (bool, bool) {
    let holds = |i: usize| element.members.contains(&i);
    let mut walls = (false, false);
    for &(i, j) in touching.iter().filter(|(i, j)| holds(*i) != holds(*j)) {
        let other = if holds(i) { j } else { i };
        let at = element.to_frame.apply(polygons[other].interior_point()).x;
        if at < 0.0 {
            walls.0 = true;
        } else {
            walls.1 = true;
        }
    }
    walls
}

fn lie(path: &Path, corners: &[Vec2]) -> Lie {
    let mut out = Lie {
        farthest_m: 0.0,
        nearest_m: f64::INFINITY,
        span_m: (f64::INFINITY, f64::NEG_INFINITY),
    };
    for p in corners {
        let (at_m, distance_m) = (path.project(*p), path.nearest(*p).1);
        out.farthest_m = out.farthest_m.max(distance_m);
        out.nearest_m = out.nearest_m.min(distance_m);
        out.span_m = (out.span_m.0.min(at_m), out.span_m.1.max(at_m));
    }
    out
}

/// The side an element stands along, and the next one around the corner where it stands there, too.
///
/// The paper counts every side that the whole element lies within reach of. In shallow blocks that makes
/// all elements fixed ones of both their streets, and deep buildings and those behind front gardens
/// belong to none. Here the edge that faces the street decides: the nearest side counts, and a neighbour
/// of it that is as near.
fn homes(lies: &[Lie], reach_m: f64) -> Vec<usize> {
    let near = |i: usize| (lies[i].nearest_m, lies[i].farthest_m);
    let order = |i: &usize, j: &usize| {
        let ((a, b), (c, d)) = (near(*i), near(*j));
        a.total_cmp(&c).then(b.total_cmp(&d)).then(i.cmp(j))
    };
    let stands = |i: &usize| lies[*i].nearest_m <= reach_m;
    let Some(first) = (0..lies.len()).filter(stands).min_by(order) else { return Vec::new() };
    let n = lies.len();
    let beside = [(first + 1) % n, (first + n - 1) % n];
    let second = beside
        .into_iter()
        .filter(|i| *i != first && lies[*i].nearest_m <= lies[first].nearest_m + CORNER_M)
        .min_by(order);
    [Some(first), second].into_iter().flatten().collect()
}

/// What stands at a side, the foremost first; how it behaves; where it stands along the side.
type Compound = (Vec<usize>, Kind, (f64, f64));

/// At a corner, what stands behind a house of one side and behind one of the next goes with the first of
/// them alone, and with none where it is itself the foremost at a side: else neither house could be laid
/// out without the other. What then stands at one side only may be repeated.
fn each_behind_one(sides: &mut [Vec<Compound>]) {
    let in_front: Vec<usize> = sides.iter().flatten().map(|c| c.0[0]).collect();
    let mut behind = Vec::new();
    for (members, ..) in sides.iter_mut().flatten() {
        let front = members[0];
        members.retain(|i| *i == front || !(in_front.contains(i) || behind.contains(i)));
        behind.extend_from_slice(&members[1..]);
    }
    for (members, kind, _) in sides.iter_mut().flatten() {
        let sides_of_front = in_front.iter().filter(|i| **i == members[0]).count();
        *kind = if sides_of_front > 1 { Kind::Fixed } else { Kind::Repeatable };
    }
}

/// Elements in order along a side, each with what stands behind it; and what stands behind several.
fn compounds(mut members: Vec<(usize, Kind, Lie)>) -> (Vec<Compound>, Vec<usize>) {
    let width = |lie: &Lie| lie.span_m.1 - lie.span_m.0;
    // Those nearer to the side come first, so that what is behind finds them there.
    members.sort_by(|a, b| a.2.nearest_m.total_cmp(&b.2.nearest_m).then(a.0.cmp(&b.0)));
    let mut out: Vec<(Compound, Lie)> = Vec::new();
    let mut alone = Vec::new();
    for (i, kind, lie) in members {
        let shared = |other: &Lie| {
            let common = lie.span_m.1.min(other.span_m.1) - lie.span_m.0.max(other.span_m.0);
            common / width(&lie).min(width(other)).max(0.5)
        };
        let before: Vec<usize> =
            (0..out.len()).filter(|k| shared(&out[*k].1) > BEHIND_SHARE).collect();
        let longest = before.iter().map(|k| width(&out[*k].1)).fold(0.0, f64::max);
        let most =
            before.iter().copied().max_by(|a, b| shared(&out[*a].1).total_cmp(&shared(&out[*b].1)));
        match most {
            None => out.push(((vec![i], kind, lie.span_m), lie)),
            Some(_) if width(&lie) > BEHIND_RATIO * longest => alone.push(i),
            Some(k) => {
                // What sticks out a little behind does not widen the front.
                let (members, its_kind, _) = &mut out[k].0;
                members.push(i);
                if kind == Kind::Fixed {
                    *its_kind = Kind::Fixed;
                }
            }
        }
    }
    out.sort_by(|a, b| a.1.span_m.0.total_cmp(&b.1.span_m.0).then(a.0.0.cmp(&b.0.0)));
    (out.into_iter().map(|(compound, _)| compound).collect(), alone)
}
