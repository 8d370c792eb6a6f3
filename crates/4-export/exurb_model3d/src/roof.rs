//! Roofs over footprints of any shape.
//!
//! Hipped roofs rise over the straight skeleton. Gabled ones begin as hipped: a hip, the triangle
//! over a short side, is pulled upright until the ridge ends over that side; both slopes stay in
//! their planes. Gambrel, mansard, round and dome bend the slopes of these two by a profile. Where
//! a footprint is too rich or its skeleton fails, the roof is flat.

use exurb_city::Roof;
use exurb_geom::straight_skeleton::Skeleton;
use exurb_geom::{OrientedBox, Polygon, Vec2, trig};

/// Footprints with more corners get a flat roof: the skeleton takes the cube of them.
pub const MOST_CORNERS: usize = 60;
/// No roof takes more than this share of a building's height.
const MOST_SHARE: f64 = 0.5;
const MOST_HEIGHT_M: f64 = 9.0;
/// Roofs lower than this are flat.
const LEAST_HEIGHT_M: f64 = 0.3;

/// The upper end of a building.
#[derive(Clone, Debug, PartialEq)]
pub struct Top {
    eaves: Eaves,
    /// Slopes and gables; none when the roof is one plane over the whole footprint.
    pub faces: Vec<Face>,
}

/// Height of the walls.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Eaves {
    Level(f64),
    /// Height at the origin, and rise for each metre east and north.
    Tilted(f64, Vec2),
}

/// A flat face of a roof.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Places and heights, counter-clockwise from outside.
    pub corners: Vec<(Vec2, f64)>,
    /// Triangles between the corners; every corner is used, so that shells close.
    pub triangles: Vec<[u32; 3]>,
    /// Upright, part of the wall?
    pub is_gable: bool,
}

impl Top {
    /// A flat roof.
    pub fn flat(height_m: f64) -> Self {
        Self { eaves: Eaves::Level(height_m), faces: Vec::new() }
    }

    /// A roof of `shape` over `polygon`, whose highest point lies `top_m` over the ground, on walls
    /// that begin at `base_m`.
    pub fn of(polygon: &Polygon, shape: Roof, base_m: f64, top_m: f64, slope: f64) -> Self {
        let most_m = ((top_m - base_m) * MOST_SHARE).min(MOST_HEIGHT_M);
        let made = match shape {
            Roof::Flat => None,
            Roof::Skillion => Self::skillion(polygon, top_m, most_m, slope),
            Roof::Pyramidal => Self::pyramid(polygon, top_m, most_m, slope),
            Roof::Hipped | Roof::HalfHipped => {
                Self::sloped(polygon, top_m, most_m, slope, false, &STRAIGHT)
            }
            Roof::Gabled => Self::sloped(polygon, top_m, most_m, slope, true, &STRAIGHT),
            Roof::Gambrel => Self::sloped(polygon, top_m, most_m, 0.9, true, &BROKEN),
            Roof::Mansard => Self::sloped(polygon, top_m, most_m, 0.9, false, &BROKEN),
            Roof::Round => Self::sloped(polygon, top_m, most_m, 1.0, true, &ARC),
            Roof::Dome => Self::sloped(polygon, top_m, most_m.max(3.0), 1.0, false, &ARC),
        };
        made.unwrap_or(Self::flat(top_m))
    }

    /// Height of the wall's top at a corner.
    pub fn eaves_m(&self, p: Vec2) -> f64 {
        match self.eaves {
            Eaves::Level(height_m) => height_m,
            Eaves::Tilted(at_zero, rise) => at_zero + rise.dot(p),
        }
    }

    /// One plane that falls across the footprint's shorter side.
    fn skillion(polygon: &Polygon, top_m: f64, most_m: f64, slope: f64) -> Option<Self> {
        let across = OrientedBox::of(polygon.exterior())?.axis.perp();
        let reach = polygon.exterior().iter().map(|p| p.to_m().dot(across));
        let (low, high) = reach.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        let rise_m = ((high - low) * slope.min(0.3)).min(most_m);
        let rise = across * (rise_m / (high - low));
        let at_zero = top_m - rise_m / (high - low) * high;
        (rise_m >= LEAST_HEIGHT_M)
            .then(|| Self { eaves: Eaves::Tilted(at_zero, rise), faces: Vec::new() })
    }

    /// Triangles up to one point; only where that point sees every side.
    fn pyramid(polygon: &Polygon, top_m: f64, most_m: f64, slope: f64) -> Option<Self> {
        let apex = polygon.centroid();
        let sees = |a: Vec2, b: Vec2| (b - a).perp_dot(apex - a) > 0.01;
        if !polygon.interiors().is_empty()
            || !polygon.segments().all(|(a, b)| sees(a.to_m(), b.to_m()))
        {
            return Self::sloped(polygon, top_m, most_m, slope, false, &STRAIGHT);
        }
        let reach_m = polygon.boundary_distance_m(apex);
        let rise_m = (reach_m * slope.max(0.7)).min(most_m.max(2.0 * MOST_HEIGHT_M * MOST_SHARE));
        let eaves_m = top_m - rise_m;
        let face = |(a, b): (exurb_geom::GridPoint, exurb_geom::GridPoint)| Face {
            corners: vec![(a.to_m(), eaves_m), (b.to_m(), eaves_m), (apex, top_m)],
            triangles: vec![[0, 1, 2]],
            is_gable: false,
        };
        let faces = polygon.segments().map(face).collect();
        (rise_m >= LEAST_HEIGHT_M).then_some(Self { eaves: Eaves::Level(eaves_m), faces })
    }

    fn sloped(
        polygon: &Polygon,
        top_m: f64,
        most_m: f64,
        slope: f64,
        gabled: bool,
        profile: &[(f64, f64)],
    ) -> Option<Self> {
        if polygon.rings().map(<[_]>::len).sum::<usize>() > MOST_CORNERS {
            return None;
        }
        let mut frame = Frame::of(polygon)?;
        if gabled {
            frame.raise_gables();
        }
        let last_m = frame.nodes.iter().map(|n| n.1).fold(0.0, f64::max);
        let rise_m = (last_m * slope).min(most_m);
        if rise_m < LEAST_HEIGHT_M {
            return None;
        }
        let bent = profile.len() > 2 && frame.faces.iter().all(|f| frame.rises_once(f));
        let profile = if bent { profile } else { &STRAIGHT };
        let eaves_m = top_m - rise_m;
        let mut faces = Vec::new();
        for (side, face) in frame.faces.iter().enumerate() {
            for band in profile.windows(2) {
                faces.extend(frame.band(
                    side,
                    face,
                    last_m,
                    [band[0], band[1]],
                    eaves_m,
                    rise_m,
                )?);
            }
        }
        Some(Self { eaves: Eaves::Level(eaves_m), faces })
    }
}

/// Share of the way from the eaves to the ridge, and share of the rise reached there.
const STRAIGHT: [(f64, f64); 2] = [(0.0, 0.0), (1.0, 1.0)];
const BROKEN: [(f64, f64); 3] = [(0.0, 0.0), (0.3, 0.7), (1.0, 1.0)];
/// A quarter of a circle.
const ARC: [(f64, f64); 6] =
    [(0.0, 0.0), (0.05, 0.312), (0.2, 0.6), (0.4, 0.8), (0.7, 0.954), (1.0, 1.0)];

/// A skeleton whose hips may become gables.
struct Frame {
    /// Places and distances from the eaves.
    nodes: Vec<(Vec2, f64)>,
    faces: Vec<Vec<usize>>,
    is_gable: Vec<bool>,
}

impl Frame {
    fn of(polygon: &Polygon) -> Option<Self> {
        let skeleton = Skeleton::of(polygon)?;
        let nodes = skeleton.nodes.iter().map(|n| (n.at, n.time_m)).collect();
        let is_gable = vec![false; skeleton.faces.len()];
        Some(Self { nodes, faces: skeleton.faces, is_gable })
    }

    /// Moves the tip of every hip along the ridge to over its side. Tips are moved once; a tip that
    /// two hips share (a pyramid) stays, and so do hips whose ridge would leave the side.
    fn raise_gables(&mut self) {
        let mut owners = vec![0; self.nodes.len()];
        for face in self.faces.iter().filter(|f| f.len() == 3) {
            owners[face[2]] += 1;
        }
        for side in 0..self.faces.len() {
            let [a, b, tip] = self.faces[side][..] else { continue };
            if owners[tip] == 1
                && let Some(moved) = self.over_side(a, b, tip)
            {
                self.nodes[tip] = moved;
                self.is_gable[side] = true;
            }
        }
    }

    /// Where the ridge that ends at `tip` meets the side from `a` to `b`.
    fn over_side(&self, a: usize, b: usize, tip: usize) -> Option<(Vec2, f64)> {
        let neighbors: Vec<usize> =
            self.beside(tip).into_iter().filter(|n| *n != a && *n != b).collect();
        let [ridge] = neighbors[..] else { return None };
        let ((p, time), (q, ridge_time)) = (self.nodes[tip], self.nodes[ridge]);
        let (a, b) = (self.nodes[a].0, self.nodes[b].0);
        let along = p - q;
        let cross = along.perp_dot(b - a);
        // Only ridges that run at the side, and hardly fall, look like gables.
        if cross.abs() < 0.7 * along.length() * (b - a).length() || along.length() < 0.05 {
            return None;
        }
        let reach = (a - q).perp_dot(b - a) / cross;
        let at = q + along * reach;
        let share = (at - a).dot(b - a) / (b - a).length_squared();
        let moved_time = ridge_time + (time - ridge_time) * reach;
        let sound =
            (0.2..=0.8).contains(&share) && reach >= 1.0 && (moved_time - time).abs() < 0.25 * time;
        sound.then_some((at, moved_time))
    }

    /// Nodes next to `node` in any face.
    fn beside(&self, node: usize) -> Vec<usize> {
        let mut out = Vec::new();
        for face in &self.faces {
            for (i, n) in face.iter().enumerate() {
                let next = face[(i + 1) % face.len()];
                if *n == node {
                    out.push(next);
                } else if next == node {
                    out.push(*n);
                }
            }
        }
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Does the outline go up and down once only, so that bands of it hang together?
    fn rises_once(&self, face: &[usize]) -> bool {
        let times: Vec<f64> =
            face[1..].iter().chain(&face[..1]).map(|n| self.nodes[*n].1).collect();
        let peak = times.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(i, _)| i);
        times[..=peak].windows(2).all(|w| w[0] <= w[1] + 1e-9)
            && times[peak..].windows(2).all(|w| w[0] >= w[1] - 1e-9)
    }

    /// The part of a face between two distances from the eaves; nothing when the face ends below.
    /// `None` when it cannot be split into triangles.
    fn band(
        &self,
        side: usize,
        face: &[usize],
        last_m: f64,
        [low, high]: [(f64, f64); 2],
        eaves_m: f64,
        rise_m: f64,
    ) -> Option<Option<Face>> {
        let (from, to) = (low.0 * last_m, high.0 * last_m);
        let slope = (high.1 - low.1) / (high.0 - low.0).max(1e-9);
        // Exactly the same on both sides of a bend.
        let height = |time: f64| match time {
            t if t == from => eaves_m + rise_m * low.1,
            t if t == to => eaves_m + rise_m * high.1,
            t => eaves_m + rise_m * (low.1 + (t / last_m - low.0) * slope),
        };
        let inside = |time: f64| time >= from - 1e-9 && time <= to + 1e-9;
        let mut ring: Vec<(Vec2, f64)> = Vec::new();
        for (i, n) in face.iter().enumerate() {
            let m = face[(i + 1) % face.len()];
            let (p, q) = (self.nodes[*n], self.nodes[m]);
            if inside(p.1) {
                ring.push(p);
            }
            // Cut always from the node of the lower number, so that both faces along an arc get
            // the same point.
            let (lo, hi) = if *n < m { (p, q) } else { (q, p) };
            let mut cuts: Vec<f64> =
                [from, to].into_iter().filter(|c| (p.1 - c) * (q.1 - c) < -1e-12).collect();
            if p.1 > q.1 {
                cuts.reverse();
            }
            ring.extend(cuts.into_iter().map(|c| (lo.0.lerp(hi.0, (c - lo.1) / (hi.1 - lo.1)), c)));
        }
        ring.dedup_by(|a, b| a.0 == b.0 && a.1 == b.1);
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() < 3 {
            return Some(None);
        }
        let is_gable = self.is_gable[side];
        let (a, b) = (self.nodes[face[0]].0, self.nodes[face[1]].0);
        let along = (b - a).normalize_or_zero();
        let flat = |(p, time): &(Vec2, f64)| {
            let up = if is_gable { *time } else { (*p - a).dot(along.perp()) };
            Vec2::new((*p - a).dot(along), up)
        };
        let plan: Vec<Vec2> = ring.iter().map(flat).collect();
        let triangles = ears(&plan)?;
        let corners = ring.iter().map(|(p, time)| (*p, height(*time))).collect();
        Some(Some(Face { corners, triangles, is_gable }))
    }
}

/// Triangles of a small ring, counter-clockwise, that use every corner, also those on a straight
/// line: the best ear first. `None` when the ring crosses itself.
fn ears(ring: &[Vec2]) -> Option<Vec<[u32; 3]>> {
    let mut left: Vec<usize> = (0..ring.len()).collect();
    let mut out = Vec::with_capacity(ring.len() - 2);
    while left.len() > 3 {
        let n = left.len();
        let corner = |i: usize| {
            let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            (a, b, c)
        };
        let quality = |i: usize| {
            let (a, b, c) = corner(i);
            let (p, q, r) = (ring[a], ring[b], ring[c]);
            let area = (q - p).perp_dot(r - q);
            let longest = (q - p)
                .length_squared()
                .max((r - q).length_squared())
                .max((p - r).length_squared());
            let free = left.iter().all(|k| [a, b, c].contains(k) || !within(ring[*k], p, q, r));
            if free && area > -1e-9 { area / longest.max(1e-12) } else { f64::MIN }
        };
        let best = (0..n).map(|i| (i, quality(i))).max_by(|x, y| x.1.total_cmp(&y.1))?;
        if best.1 == f64::MIN {
            return None;
        }
        let (a, b, c) = corner(best.0);
        out.push([a as u32, b as u32, c as u32]);
        left.remove(best.0);
    }
    out.push([left[0] as u32, left[1] as u32, left[2] as u32]);
    Some(out)
}

/// Is `k` strictly inside the triangle, or on its open sides?
fn within(k: Vec2, p: Vec2, q: Vec2, r: Vec2) -> bool {
    let side = |a: Vec2, b: Vec2| (b - a).perp_dot(k - a);
    let (s, t, u) = (side(p, q), side(q, r), side(r, p));
    s > -1e-9 && t > -1e-9 && u > -1e-9 && (s.max(t).max(u) > 1e-9) && k != p && k != q && k != r
}

/// Slope of a pitched roof by shape: rise for each metre.
pub fn slope(shape: Roof, dice: f64) -> f64 {
    let degrees = match shape {
        Roof::Gabled => 34.0 + 12.0 * dice,
        Roof::Skillion => 8.0 + 6.0 * dice,
        _ => 27.0 + 10.0 * dice,
    };
    trig::tan(f64::to_radians(degrees))
}
