//! Position-based dynamics on near-rigid bodies.

use exurb_geom::{Bounds, Polygon, Rigid, Vec2, polyline};

use super::{Body, Ground};
use crate::ring::Ring;

/// Steps before bodies that were pushed against give way, too.
const STEPS: usize = 40;
/// How often others give way.
const ROUNDS: usize = 3;
/// A round ends when the deepest push has not shrunk by a twentieth in so many steps.
const STALL_STEPS: usize = 8;
/// Steps at the end of a round in which shapes may give.
const SOFT_STEPS: usize = 12;
/// How firmly shapes are held then.
const SOFT: f64 = 0.8;
/// Pushes below this are none, in metres.
const STILL_M: f64 = 0.002;
/// Bodies are pushed this much farther than they must, in metres, so that rounding does not bring
/// them together again.
const BEYOND_M: f64 = 0.002;

/// Where bodies come to rest; `None` for those that did not move. Those after the first `count` never
/// do.
pub fn solve(
    ground: &Ground<'_>,
    bodies: &[Body],
    count: usize,
    present: &[bool],
    conflicted: &[bool],
    tolerance: f64,
) -> Vec<Option<Polygon>> {
    let solids = bodies.iter().zip(present).zip(conflicted);
    let mut world = World {
        ground,
        corners: ground.block.rings().flatten().map(|p| p.to_m()).collect(),
        solids: solids.map(|((body, present), free)| Solid::of(body, *present, *free)).collect(),
    };
    world.solids[count..].iter_mut().for_each(|s| s.stands_fast = true);
    world.run();
    let back = |(solid, body): (&Solid, &Body)| solid.polygon(body, tolerance);
    world.solids.iter().zip(bodies).map(back).collect()
}

/// A body as rings of particles.
struct Solid {
    rest: Vec<Vec<Vec2>>,
    now: Vec<Vec<Vec2>>,
    clearance_m: f64,
    present: bool,
    free: bool,
    /// Was it pushed against before it was free?
    touched: bool,
    /// Is it never to move?
    stands_fast: bool,
    bounds: Bounds,
    /// Of each outer corner where it was when the kerb was last asked, how far that is, and on which
    /// side: as long as it has not gone as far, it need not be asked again.
    asked: Vec<(Vec2, f64, bool)>,
}

impl Solid {
    fn of(body: &Body, present: bool, free: bool) -> Self {
        let rest: Vec<Vec<Vec2>> = body.polygon.rings().map(polyline::to_m).collect();
        let bounds = body.polygon.bounds();
        let clearance_m = body.clearance_m;
        let asked = vec![(Vec2::INFINITY, 0.0, true); rest[0].len()];
        Self {
            now: rest.clone(),
            rest,
            clearance_m,
            present,
            free,
            touched: false,
            stands_fast: false,
            bounds,
            asked,
        }
    }

    /// Even-odd, over the rings.
    fn contains(&self, p: Vec2) -> bool {
        self.bounds.contains(p)
            && self.sides().fold(false, |inside, (a, b)| {
                let crossed =
                    (a.y > p.y) != (b.y > p.y) && ((b - a).perp_dot(p - a) > 0.0) == (b.y > a.y);
                inside ^ crossed
            })
    }

    fn sides(&self) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
        self.now.iter().flat_map(|r| (0..r.len()).map(|i| (r[i], r[(i + 1) % r.len()])))
    }

    /// The point of the outline nearest to `p`.
    fn nearest(&self, p: Vec2) -> Vec2 {
        let mut best = (f64::INFINITY, p);
        for (a, b) in self.sides() {
            let q = polyline::nearest_on_segment(a, b, p).0;
            let square = q.distance_squared(p);
            if square < best.0 {
                best = (square, q);
            }
        }
        best.1
    }

    /// Moves the whole by what the pushes have in common, and each pushed corner by the rest.
    fn push(&mut self, pushes: &[(usize, Vec2)]) {
        let common = pushes.iter().map(|(_, d)| *d).sum::<Vec2>() / pushes.len().max(1) as f64;
        self.shift(common);
        for (corner, push) in pushes {
            self.now[0][*corner] += *push - common;
        }
    }

    fn shift(&mut self, by: Vec2) {
        self.now.iter_mut().flatten().for_each(|p| *p += by);
        self.bounds = Bounds { min: self.bounds.min + by, max: self.bounds.max + by };
    }

    /// Brings the particles back towards the shape at rest, which is laid on them as well as can be.
    fn hold(&mut self, firmness: f64) {
        let fit = self.fit();
        for (ring, rest) in self.now.iter_mut().zip(&self.rest) {
            for (p, r) in ring.iter_mut().zip(rest) {
                *p = p.lerp(fit.apply(*r), firmness);
            }
        }
        let (mut min, mut max) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for p in &self.now[0] {
            (min, max) = (min.min(*p), max.max(*p));
        }
        self.bounds = Bounds { min, max };
    }

    fn fit(&self) -> Rigid {
        let rest = self.rest.iter().flatten();
        Rigid::fit(rest.zip(self.now.iter().flatten()).map(|(p, q)| (*p, *q, 1.0)))
    }

    /// Where it came to rest: as it lies where area and sides kept within the tolerance, else rigid.
    fn polygon(&self, body: &Body, tolerance: f64) -> Option<Polygon> {
        if !self.free {
            return None;
        }
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance * b + 0.05;
        let length = |(ring, i): (&Vec<Vec2>, usize)| ring[i].distance(ring[(i + 1) % ring.len()]);
        let keeps =
            self.now.iter().zip(&self.rest).all(|(now, rest)| {
                (0..rest.len()).all(|i| near(length((now, i)), length((rest, i))))
            });
        let round = |ring: &Vec<Vec2>| polyline::round(ring);
        let bent = Polygon::new(round(&self.now[0]), self.now[1..].iter().map(round).collect());
        let area_m2 = body.polygon.area_m2();
        bent.filter(|p| keeps && near(p.area_m2(), area_m2) && p.is_valid())
            .or_else(|| self.fit().apply_polygon(&body.polygon))
    }
}

struct World<'a> {
    ground: &'a Ground<'a>,
    corners: Vec<Vec2>,
    solids: Vec<Solid>,
}

impl World<'_> {
    fn run(&mut self) {
        for _ in 0..ROUNDS {
            let (mut least_m, mut since) = (f64::INFINITY, 0);
            let mut step = 0;
            while step < STEPS {
                let mut worst_m: f64 = 0.0;
                for i in 0..self.solids.len() {
                    if self.solids[i].free {
                        worst_m = worst_m.max(self.off_kerb(i));
                    }
                }
                worst_m = worst_m.max(self.apart());
                let firmness = if step + SOFT_STEPS >= STEPS { SOFT } else { 1.0 };
                self.solids.iter_mut().filter(|s| s.free).for_each(|s| s.hold(firmness));
                if worst_m < STILL_M {
                    return;
                }
                since = if worst_m < least_m * 0.95 { 0 } else { since + 1 };
                least_m = least_m.min(worst_m);
                // Where it comes no nearer, shapes may give at once.
                step =
                    if since > STALL_STEPS { (step + 1).max(STEPS - SOFT_STEPS) } else { step + 1 };
            }
            for solid in self.solids.iter_mut().filter(|s| s.touched && !s.stands_fast) {
                solid.free = true;
            }
        }
    }

    /// Pushes body `i` off the kerb; the deepest push in metres.
    fn off_kerb(&mut self, i: usize) -> f64 {
        let solid = &mut self.solids[i];
        let need_m = solid.clearance_m.max(0.0);
        let mut pushes = Vec::new();
        let mut worst_m: f64 = 0.0;
        for (corner, p) in solid.now[0].iter().enumerate() {
            let (before, distance_m, was_inside) = solid.asked[corner];
            let gone_m = before.distance(*p);
            if was_inside && distance_m - gone_m > need_m {
                continue;
            }
            let (ring, place) = self.ground.kerb.nearest(*p);
            let inside =
                if gone_m < distance_m { was_inside } else { self.ground.kerb.contains(*p) };
            solid.asked[corner] = (*p, place.distance_m, inside);
            let missing_m =
                if inside { need_m - place.distance_m } else { need_m + place.distance_m };
            if missing_m <= STILL_M {
                continue;
            }
            let inward =
                inward(&self.ground.kerb.rings[ring], place.at_m, *p, inside, place.direction);
            pushes.push((corner, inward * (missing_m + BEYOND_M)));
            worst_m = worst_m.max(missing_m);
        }
        solid.push(&pushes);
        // A corner of the kerb that stands in the body.
        for corner in &self.corners {
            if solid.contains(*corner) {
                let way = *corner - solid.nearest(*corner);
                solid.shift(way + way.normalize_or_zero() * (need_m + BEYOND_M));
                worst_m = worst_m.max(way.length());
            }
        }
        worst_m
    }

    /// Pushes bodies apart, pair by pair; the deepest push in metres.
    fn apart(&mut self) -> f64 {
        let mut worst_m: f64 = 0.0;
        let present = |i: &usize| self.solids[*i].present;
        let all: Vec<usize> = (0..self.solids.len()).filter(present).collect();
        let free: Vec<usize> = all.iter().copied().filter(|i| self.solids[*i].free).collect();
        // Side by side in memory: most pairs are told apart by their boxes.
        let mut boxes: Vec<Bounds> = self.solids.iter().map(|s| s.bounds).collect();
        for &i in &all {
            // Of two that stand fast none is pushed.
            for &j in if self.solids[i].free { &all } else { &free } {
                if i != j && boxes[i].intersects(boxes[j]) {
                    worst_m = worst_m.max(self.out_of(i, j));
                    (boxes[i], boxes[j]) = (self.solids[i].bounds, self.solids[j].bounds);
                }
            }
        }
        worst_m
    }

    /// Pushes the corners of body `i` out of body `j`.
    fn out_of(&mut self, i: usize, j: usize) -> f64 {
        let (a, b) = (&self.solids[i], &self.solids[j]);
        let mut pushes = Vec::new();
        let mut worst_m: f64 = 0.0;
        for (corner, p) in a.now[0].iter().enumerate().filter(|(_, p)| b.contains(**p)) {
            let way = b.nearest(*p) - *p;
            let depth_m = way.length();
            if depth_m > STILL_M {
                pushes.push((corner, way * ((depth_m + BEYOND_M) / depth_m)));
                worst_m = worst_m.max(depth_m);
            }
        }
        if pushes.is_empty() {
            return 0.0;
        }
        let (a_free, b_free) = (a.free, b.free);
        let share = if a_free && b_free { 0.5 } else { 1.0 };
        pushes.iter_mut().for_each(|(_, push)| *push *= share);
        if b_free {
            let common = pushes.iter().map(|(_, d)| *d).sum::<Vec2>() / pushes.len() as f64;
            self.solids[j].shift(-common);
        } else {
            self.solids[j].touched = true;
        }
        if a_free {
            self.solids[i].push(&pushes);
        } else {
            self.solids[i].touched = true;
        }
        worst_m
    }
}

/// Unit direction from the kerb into the block near `p`.
fn inward(ring: &Ring, at_m: f64, p: Vec2, inside: bool, direction: Vec2) -> Vec2 {
    let way = p - ring.point_at(at_m);
    let way = if inside { way } else { -way };
    if way.length() > 1e-6 { way.normalize() } else { direction.perp() }
}
