//! A parcel seen from its street: x along the front, y into the block, in metres.

use exurb_geom::{GridPoint, Polygon, SegmentGrid, Vec2, trig};

/// Edges of a parcel this near to where its block's pavement ends front on the street, in metres.
const FRONT_SLACK_M: f64 = 0.3;
/// Fronts turning more than this are two, in radians (35°).
const CORNER_RAD: f64 = 0.6;

/// A front around the corner is at least this long, in metres.
const LEAST_RUN_M: f64 = 6.0;

/// A parcel and its fronts.
#[derive(Clone, Debug)]
pub struct Lot {
    /// Its outline.
    pub polygon: Polygon,
    /// Middle of the main front.
    origin: Vec2,
    /// Direction of the main front, the parcel to its left.
    along: Vec2,
    /// Its rings in x and y.
    rings: Vec<Vec<Vec2>>,
    /// Main front from `-width/2` to `width/2`.
    pub width_m: f64,
    /// Farthest reach of the main front into the parcel: 0 when it is straight.
    pub bulge_m: f64,
    /// All straight fronts in order around the corner, each with the parcel to its left.
    pub runs: Vec<Run>,
    /// Which of them is the main one.
    pub main: usize,
    /// Where the front begins and ends, all of it together.
    pub ends: (Vec2, Vec2),
}

/// A nearly straight front.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Where it begins and ends.
    pub from: Vec2,
    /// Its end.
    pub to: Vec2,
    /// Farthest reach of the front to the left of the straight line.
    pub bulge_m: f64,
}

impl Run {
    fn length_m(&self) -> f64 {
        self.from.distance(self.to)
    }

    fn direction(&self) -> Vec2 {
        (self.to - self.from).normalize_or_zero()
    }

    /// Two points of the line `distance_m` into the parcel.
    pub fn line_at(&self, distance_m: f64) -> (Vec2, Vec2) {
        let inward = (self.to - self.from).normalize_or_zero().perp();
        let shift = inward * (self.bulge_m + distance_m);
        (self.from + shift, self.to + shift)
    }
}

impl Lot {
    /// The lot of a parcel whose block has the kerb `kerb`; `None` when it has no front.
    pub fn of(polygon: &Polygon, kerb: &SegmentGrid, pavement_m: f64) -> Option<Self> {
        let chain = longest_front(polygon, kerb, pavement_m + FRONT_SLACK_M)?;
        let ends = (chain[0], chain[chain.len() - 1]);
        let all = runs(&chain);
        let longer =
            |i: &usize, j: &usize| all[*i].length_m().total_cmp(&all[*j].length_m()).then(j.cmp(i));
        let main = (0..all.len()).max_by(longer)?;
        let run = all[main];
        // Only streets that meet the main one at an outer corner are fronts, too: around the tip of
        // a dead end the others lead away from the lot.
        let meets = |a: &Run, b: &Run| {
            let turn = a.direction().perp_dot(b.direction());
            turn > trig::sin(CORNER_RAD) && a.length_m().min(b.length_m()) > LEAST_RUN_M
        };
        let before = main.checked_sub(1).filter(|i| meets(&all[*i], &run)).map(|i| all[i]);
        let after = all.get(main + 1).filter(|r| meets(&run, r)).copied();
        let runs: Vec<Run> = before.into_iter().chain([run]).chain(after).collect();
        let main = usize::from(before.is_some());
        let along = (run.to - run.from).normalize_or_zero();
        if along == Vec2::ZERO {
            return None;
        }
        let origin = (run.from + run.to) / 2.0;
        let local = |p: &GridPoint| {
            let d = p.to_m() - origin;
            Vec2::new(d.dot(along), along.perp_dot(d))
        };
        let rings = polygon.rings().map(|ring| ring.iter().map(local).collect()).collect();
        Some(Self {
            polygon: polygon.clone(),
            origin,
            along,
            rings,
            width_m: run.length_m(),
            bulge_m: run.bulge_m,
            runs,
            main,
            ends,
        })
    }

    /// A point given in x and y.
    pub fn world(&self, p: Vec2) -> Vec2 {
        self.origin + self.along * p.x + self.along.perp() * p.y
    }

    /// Does it lie at a corner of its block?
    pub fn is_corner(&self) -> bool {
        self.runs.len() > 1
    }

    /// Frontage of all runs in metres.
    pub fn frontage_m(&self) -> f64 {
        self.runs.iter().map(Run::length_m).sum()
    }

    /// The parcel's extent in x at `y`, around the middle of the front or as near to it as there is
    /// ground; `None` where there is none.
    pub fn chord(&self, y: f64) -> Option<(f64, f64)> {
        self.chords(y, |p| (p.y, p.x)).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }

    /// The parcel's extent in y at `x` from the front on.
    pub fn depth_at(&self, x: f64) -> f64 {
        let y = self.bulge_m + 0.1;
        let inside = self.chords(x, |p| (p.x, p.y)).find(|c| c.0 <= y && y <= c.1);
        inside.map_or(0.0, |c| c.1)
    }

    fn chords(
        &self,
        at: f64,
        axes: impl Fn(Vec2) -> (f64, f64),
    ) -> impl Iterator<Item = (f64, f64)> {
        let mut crossings = Vec::new();
        for ring in &self.rings {
            for i in 0..ring.len() {
                let ((u, v), (s, t)) = (axes(ring[i]), axes(ring[(i + 1) % ring.len()]));
                if (u > at) != (s > at) {
                    crossings.push(v + (t - v) * (at - u) / (s - u));
                }
            }
        }
        crossings.sort_by(f64::total_cmp);
        (0..crossings.len() / 2).map(move |i| (crossings[2 * i], crossings[2 * i + 1]))
    }
}

/// Distance of an interval from 0.
fn off(chord: (f64, f64)) -> f64 {
    chord.0.max(-chord.1).max(0.0)
}

/// The longest run of edges along the street, as points with the parcel to their left.
fn longest_front(polygon: &Polygon, kerb: &SegmentGrid, within_m: f64) -> Option<Vec<Vec2>> {
    let mut near = Vec::new();
    let margin_mm = (within_m * 1000.0) as i32 + 1;
    let mut fronts = |p: GridPoint| {
        kerb.near(p, p, margin_mm, &mut near);
        near.iter().any(|id| {
            let (a, b) = kerb.segment(*id);
            let nearest = exurb_geom::polyline::nearest_on_segment(a.to_m(), b.to_m(), p.to_m()).0;
            nearest.distance(p.to_m()) <= within_m
        })
    };
    let mut best: Option<(f64, Vec<Vec2>)> = None;
    for ring in polygon.rings() {
        let n = ring.len();
        let street: Vec<bool> = (0..n)
            .map(|i| {
                let (a, b) = (ring[i].to_m(), ring[(i + 1) % n].to_m());
                // Both quarters: the middle alone may touch a kerb that turns away.
                [0.25, 0.75].iter().all(|t| fronts(GridPoint::round(a.lerp(b, *t))))
            })
            .collect();
        let starts = (0..n).filter(|i| street[*i] && !street[(i + n - 1) % n]);
        let starts: Vec<usize> = if street.iter().all(|s| *s) { vec![0] } else { starts.collect() };
        for start in starts {
            let mut chain = vec![ring[start].to_m()];
            let edges = (0..n).map(|k| (start + k) % n).take_while(|i| street[*i]);
            chain.extend(edges.map(|i| ring[(i + 1) % n].to_m()));
            let length = exurb_geom::polyline::length(&chain);
            if best.as_ref().is_none_or(|(most, _)| length > *most) {
                best = Some((length, chain));
            }
        }
    }
    best.map(|(_, chain)| chain)
}

/// Cuts a front where it turns a corner; what is shorter than 2 m goes to the longer neighbour.
fn runs(chain: &[Vec2]) -> Vec<Run> {
    let mut cuts = vec![0];
    let mut from = 0;
    for i in 1..chain.len() - 1 {
        let before = chain[i] - chain[from.max(i.saturating_sub(3))];
        let after = chain[(i + 2).min(chain.len() - 1)] - chain[i];
        if trig::angle_between(before, after) > CORNER_RAD
            && chain[from].distance(chain[i]) > 2.0
            && chain[i].distance(chain[chain.len() - 1]) > 2.0
        {
            cuts.push(i);
            from = i;
        }
    }
    cuts.push(chain.len() - 1);
    cuts.windows(2)
        .map(|w| {
            let points = &chain[w[0]..=w[1]];
            let (from, to) = (points[0], points[points.len() - 1]);
            let unit = (to - from).normalize_or_zero();
            let reach = |p: &Vec2| unit.perp_dot(*p - from);
            let bulge_m = points.iter().map(reach).fold(0.0, f64::max);
            Run { from, to, bulge_m }
        })
        .collect()
}
