//! The pure core: a layout, a new outline → where the elements go.

use exurb_geom::{Bounds, GridPoint, Polygon, Rigid, Vec2, trig};

use super::Settings;
use super::correspondence::Correspondence;
use super::groups::{Element, Group, Groups, Kind};
use super::guidance::{Guidance, middle};
use super::label::{self, Problem};
use super::path::Path;
use super::slices::Slices;
use super::spacing::{Wish, spaced};
use super::whole;
use crate::motion::Motion;
use crate::ring::{Ring, Side};

/// An element in the new outline: its polygons and the motion that takes them there.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Indices of the polygons, as they were given.
    pub members: Vec<usize>,
    /// From where they were to where they go.
    pub motion: Motion,
}

/// A layout that can be laid out anew in other outlines, over and over.
#[derive(Clone, Debug)]
pub struct Source {
    outline: Vec<GridPoint>,
    ring: Ring,
    groups: Groups,
    polygons: Vec<Polygon>,
    /// Is it to be fitted as a whole?
    is_whole: bool,
}

/// Elements whose group is not theirs reach this far over its ends, in metres.
const OVER_ENDS_M: f64 = 3.0;
/// A fixed element stands where it covers at least this share of its image.
const FIXED_SHARE: f64 = 0.3;
/// How often sequences are solved again with dearer repetitions.
const ROUNDS: usize = 3;
/// What being off the image costs, as a share of the distance: breaks ties.
const OFF_COST: f64 = 0.02;
/// A gap is filled where at least this share of an element is missing.
const FILL_SHARE: f64 = 0.6;
/// What an element costs that stands where nothing guides it, as a share of its length.
const UNGUIDED_COST: f64 = 0.3;
/// Elements may overlap earlier ones by this much, in metres: refinement parts them.
const TOUCH_M: f64 = 0.3;
/// Elements may reach over the outline by this much, in metres.
const OVER_M: f64 = 1.0;
/// Gaps up to this share of an element between two that share walls are closed.
const CLOSE_SHARE: f64 = 0.6;
/// Elements reach past the ends of their path by at most this, in metres.
const MOST_PAD_M: f64 = 15.0;
/// Ground counts as taken where the map covers this share of the usual depth.
const TAKEN_DEPTH: f64 = 0.5;

impl Source {
    /// Analyses a layout once; polygons that `once` names are never repeated. O(polygons · outline).
    pub fn of(
        outline: &[GridPoint],
        polygons: Vec<Polygon>,
        once: &[bool],
        settings: &Settings,
    ) -> Self {
        let ring = Ring::of(outline);
        let mut groups = Groups::of(&ring, &polygons, settings);
        for element in groups.groups.iter_mut().flat_map(|g| &mut g.elements) {
            if element.members.iter().any(|m| once.get(*m) == Some(&true)) {
                element.kind = Kind::Fixed;
            }
        }
        let block_m2 = exurb_geom::polygon::signed_area_m2(outline).abs();
        let is_whole = whole::is_whole(block_m2, &polygons);
        Self { outline: outline.to_vec(), ring, groups, polygons, is_whole }
    }

    /// The outline as positions.
    pub fn ring(&self) -> &Ring {
        &self.ring
    }

    /// The groups and what belongs to none.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Lays the elements out in `domain`, along `outline`, its outer ring or a plainer one, which belongs
    /// to the layout's outline by `link`.
    pub fn retarget(
        &self,
        domain: &Polygon,
        outline: &[GridPoint],
        link: &Correspondence,
        settings: &Settings,
    ) -> Vec<Placement> {
        let target = Ring::of(outline);
        if self.is_whole && settings.fit_whole {
            let motion = whole::fitted(&self.outline, &self.ring, &target, link);
            let place = |i| Placement { members: vec![i], motion };
            return (0..self.polygons.len()).map(place).collect();
        }
        let guidance = Guidance::new(&self.ring, &target, domain, link);
        let mut work =
            Work { source: self, guidance, settings, placed: Vec::new(), bodies: Vec::new() };
        work.keep();
        let mut tracks = work.tracks(&target);
        tracks.sort_by_key(|track| std::cmp::Reverse(track.pool.len()));
        for track in &tracks {
            work.fill(track);
        }
        for track in tracks.iter().filter(|t| !t.is_row && t.weight > 0.0) {
            work.fill_up(track);
        }
        work.place_singles();
        work.placed
    }

    /// Where the guidance map carries points of the layout.
    pub fn carried(
        &self,
        domain: &Polygon,
        outline: &[GridPoint],
        link: &Correspondence,
        points: &[Vec2],
    ) -> Vec<Vec2> {
        if points.is_empty() {
            return Vec::new();
        }
        let target = Ring::of(outline);
        let guidance = Guidance::new(&self.ring, &target, domain, link);
        points.iter().map(|p| guidance.point(*p)).collect()
    }

    /// The deformed layout that guides the elements, ring by ring; for pictures.
    pub fn guidance_map(
        &self,
        domain: &Polygon,
        outline: &[GridPoint],
        link: &Correspondence,
        scale: f64,
    ) -> Vec<Vec<Vec2>> {
        let target = Ring::of(outline);
        let guidance = Guidance::new(&self.ring, &target, domain, link);
        let images = self.groups.groups.iter().flat_map(|g| {
            g.elements.iter().filter_map(|e| guidance.image(g, e, scale)).collect::<Vec<_>>()
        });
        images.flatten().collect()
    }
}

/// A line of the new layout and the elements that may stand along it.
struct Track<'a> {
    path: Path,
    /// Elements with their groups.
    pool: Vec<(&'a Group, &'a Element)>,
    /// How far it follows the guidance map.
    weight: f64,
    /// How much longer the line is than what it was.
    stretch: f64,
    /// Share of its length that elements took.
    built_share: f64,
    is_row: bool,
}

struct Work<'a> {
    source: &'a Source,
    guidance: Guidance<'a>,
    settings: &'a Settings,
    placed: Vec<Placement>,
    /// Rings of what stands already.
    bodies: Vec<(Bounds, Vec<Vec<Vec2>>)>,
}

impl<'a> Work<'a> {
    fn tracks(&self, target: &Ring) -> Vec<Track<'a>> {
        let sides = target.sides();
        let by_side =
            sides.iter().enumerate().filter_map(|(k, side)| self.side_track(target, k, side));
        let rows = self.source.groups.groups.iter().filter(|g| g.side.is_none());
        by_side.chain(rows.filter_map(|g| self.row_track(g))).collect()
    }

    /// A side of the new outline and the elements of the sides it belongs to.
    fn side_track(&self, target: &Ring, k: usize, side: &Side) -> Option<Track<'a>> {
        let path = Path::new(target.part(side.start_m, side.end_m))?;
        let (from, to) =
            (self.guidance.link.to_source(side.start_m), self.guidance.link.to_source(side.end_m));
        let around = self.source.ring.length_m();
        let mut pool = Vec::new();
        for group in &self.source.groups.groups {
            let Some(own) = &group.side else { continue };
            for element in &group.elements {
                let at = own.start_m + (element.span_m.0 + element.span_m.1) / 2.0;
                let ahead = (at - from + OVER_ENDS_M).rem_euclid(around);
                if ahead < to - from + 2.0 * OVER_ENDS_M {
                    pool.push((group, element));
                }
            }
        }
        let mut weight = self.settings.side_weights.get(k).copied().unwrap_or(1.0).clamp(0.0, 1.0);
        if self.settings.local && self.stayed(target, side) {
            weight = 0.0;
        }
        let stretch = path.length_m() / (to - from).max(1.0);
        let built_m: f64 = pool.iter().map(|(_, e)| e.span_m.1 - e.span_m.0).sum();
        let built_share = (built_m / (to - from).max(1.0)).min(1.0);
        Some(Track { path, pool, weight, stretch, built_share, is_row: false })
    }

    /// Did the side stay where it was?
    fn stayed(&self, target: &Ring, side: &Side) -> bool {
        let same = |at: f64| {
            let there = self.source.ring.point_at(self.guidance.link.to_source(at));
            there.distance(target.point_at(at)) < 0.01
        };
        same(side.start_m) && same(side.end_m) && same((side.start_m + side.end_m) / 2.0)
    }

    /// A row inside, along its deformed curve.
    fn row_track(&self, group: &'a Group) -> Option<Track<'a>> {
        let line = exurb_geom::polyline::resample(group.path.line(), 5.0);
        let path = Path::new(line.into_iter().map(|p| self.guidance.point(p)).collect())?;
        let inside = |p: &Vec2| self.guidance.domain.contains(GridPoint::round(*p));
        if !path.line().iter().all(inside) {
            return None;
        }
        let stretch = path.length_m() / group.path.length_m();
        let pool = group.elements.iter().map(|e| (group, e)).collect();
        Some(Track { path, pool, weight: 1.0, stretch, built_share: 0.0, is_row: true })
    }

    /// Lays the elements of a track out along it.
    fn fill(&mut self, track: &Track<'a>) {
        let free = |e: &Element| {
            let holds = |p: &Placement| e.members.iter().any(|m| p.members.contains(m));
            e.kind == Kind::Repeatable || !self.placed.iter().any(holds)
        };
        let pool: Vec<(&Group, &Element)> =
            track.pool.iter().filter(|(_, e)| free(e)).copied().collect();
        let line = Line::of(track, &pool, self);
        let labels = line.solve(self.settings, track.stretch);
        for (element, motion) in line.placed(&labels, self.settings.stretch) {
            self.put(element.members.clone(), motion);
        }
    }

    /// Repeats elements where a side is built on less than it was: no longer guided, the longest that
    /// find room first.
    fn fill_up(&mut self, track: &Track<'a>) {
        let pool: Vec<(&Group, &Element)> =
            track.pool.iter().filter(|(_, e)| e.kind == Kind::Repeatable).copied().collect();
        let line = Line::unguided(track, &pool, self);
        let mut missing_m = track.built_share * track.path.length_m() - line.built_m();
        let shortest = (0..line.pool.len()).map(|e| line.length(e)).fold(f64::INFINITY, f64::min);
        if missing_m < shortest.min(track.path.length_m()) * FILL_SHARE {
            return;
        }
        let labels = line.solve(self.settings, f64::INFINITY);
        let mut found = line.placed(&labels, 0.0);
        let length = |e: &Element| e.span_m.1 - e.span_m.0;
        found.sort_by(|a, b| length(b.0).total_cmp(&length(a.0)));
        for (element, motion) in found {
            if missing_m >= length(element) * FILL_SHARE {
                missing_m -= length(element);
                self.put(element.members.clone(), motion);
            }
        }
    }

    fn put(&mut self, members: Vec<usize>, motion: Motion) {
        for member in &members {
            let rings: Vec<Vec<Vec2>> = self.source.polygons[*member]
                .rings()
                .map(|ring| ring.iter().map(|p| motion.apply(p.to_m())).collect())
                .collect();
            self.bodies.push((bounds(&rings[0]), rings));
        }
        self.placed.push(Placement { members, motion });
    }

    /// What the map leaves where it is, to the rounding of a step, stays there: what is laid out beside it
    /// finds it standing.
    fn keep(&mut self) {
        let near_m = self.settings.step / 2.0;
        let stays = |i: &usize| {
            let mut corners = self.source.polygons[*i].exterior().iter().map(|p| p.to_m());
            corners.all(|p| self.guidance.point(p).distance(p) <= near_m)
        };
        let stay: Vec<bool> = (0..self.source.polygons.len()).map(|i| stays(&i)).collect();
        let mut kept = vec![false; stay.len()];
        let groups = self.source.groups.groups.iter().flat_map(|g| &g.elements);
        let elements = groups.map(|e| e.members.clone());
        for members in elements.chain(self.source.groups.singles.iter().map(|i| vec![*i])) {
            if members.iter().all(|i| stay[*i] && !kept[*i]) {
                members.iter().for_each(|i| kept[*i] = true);
                self.put(members, Rigid::IDENTITY.into());
            }
        }
    }

    /// What belongs to no group goes where the map takes it, turned as the map turns it; refinement parts
    /// it from what stands there.
    fn place_singles(&mut self) {
        for &i in &self.source.groups.singles {
            if self.placed.iter().any(|p| p.members.contains(&i)) {
                continue;
            }
            let ring = exurb_geom::polyline::to_m(self.source.polygons[i].exterior());
            let Some(image) = self.guidance.ring(&ring) else { continue };
            let motion = Rigid::fit(ring.iter().zip(&image).map(|(p, q)| (*p, *q, 1.0)));
            self.put(vec![i], motion.into());
        }
    }

    /// Does it stand clear of what stands already, and inside, give or take?
    fn is_free(&self, rings: &[Vec<Vec2>]) -> bool {
        let own = bounds(&rings[0]);
        let domain = self.guidance.domain;
        let inside = |p: &Vec2| {
            domain.contains(GridPoint::round(*p)) || domain.boundary_distance_m(*p) < OVER_M
        };
        rings[0].iter().all(inside) && {
            let shrunk = shrunk(&rings[0], TOUCH_M);
            self.bodies
                .iter()
                .all(|(bounds, body)| !own.intersects(*bounds) || apart(&shrunk, &body[0]))
        }
    }
}

/// A track as a problem of labelling.
struct Line<'t, 'a> {
    track: &'t Track<'a>,
    pool: Vec<(&'a Group, &'a Element)>,
    /// Metres a step, so that whole steps fill the path, and as asked for.
    step_m: f64,
    nominal_m: f64,
    /// Steps before and behind the path: elements at corners reach past its ends.
    pad: usize,
    problem: Problem,
    /// Where each element's image lies along the path, if it has one.
    image_m: Vec<Option<f64>>,
    /// What stands along the path already, from and to.
    blocked: Vec<(f64, f64)>,
}

impl<'t, 'a> Line<'t, 'a> {
    /// With no elements yet; room for those of `pool` that reach past the ends.
    fn empty(track: &'t Track<'a>, pool: &[(&'a Group, &'a Element)], work: &Work<'_>) -> Self {
        let settings = work.settings;
        let length_m = track.path.length_m();
        let inner = (length_m / settings.step).round() as usize;
        let step_m = length_m / inner.max(1) as f64;
        let over =
            |(group, e): &(&Group, &Element)| (-e.span_m.0).max(e.span_m.1 - group.path.length_m());
        let over_m = pool.iter().map(over).fold(0.0, f64::max).min(MOST_PAD_M);
        let pad = (over_m / step_m).ceil() as usize;
        let steps = inner + 2 * pad;
        Self {
            track,
            pool: Vec::new(),
            step_m,
            nominal_m: settings.step,
            pad,
            problem: Problem {
                steps,
                lengths: Vec::new(),
                costs: Vec::new(),
                empty: vec![0.0; steps],
                empty_pair: settings.alpha,
                same_pair: Vec::new(),
            },
            image_m: Vec::new(),
            blocked: Vec::new(),
        }
    }

    fn of(track: &'t Track<'a>, pool: &[(&'a Group, &'a Element)], work: &Work<'_>) -> Self {
        let settings = work.settings;
        let mut line = Self::empty(track, pool, work);
        let (steps, step_m) = (line.problem.steps, line.step_m);
        let usual_depth =
            pool.iter().map(|(_, e)| e.depth_m).sum::<f64>() / pool.len().max(1) as f64;
        let depth = usual_depth.min(settings.empty_depth).max(1.0);
        line.blocked = line.standing(work, usual_depth.max(1.0));
        let mut taken = vec![0.0; steps];
        let mut images = Vec::new();
        for (group, element) in pool {
            let Some(image) = line.image(group, element, work, 1.0) else { continue };
            line.cover(&image, depth, &mut taken);
            let Some(wide) = line.image(group, element, work, settings.map_scale) else { continue };
            images.push((*group, *element, wide));
        }
        for t in &mut taken {
            *t = f64::min(*t, 1.0);
        }
        for (group, element, image) in images {
            line.add(group, element, &image, &taken, work);
        }
        let per_step = if settings.printed_cost { settings.empty_depth } else { 1.0 };
        line.problem.empty = taken.iter().map(|t| t * step_m * per_step).collect();
        line
    }

    /// The same with no guidance: elements may stand wherever there is room, and leaving room costs.
    fn unguided(track: &'t Track<'a>, pool: &[(&'a Group, &'a Element)], work: &Work<'_>) -> Self {
        let mut line = Self::empty(track, &[], work);
        let usual_depth =
            pool.iter().map(|(_, e)| e.depth_m).sum::<f64>() / pool.len().max(1) as f64;
        line.blocked = line.standing(work, usual_depth.max(1.0));
        let taken = |from: f64, to: f64, by: f64| {
            line.blocked.iter().any(|(low, high)| low + by < to && from < high - by)
        };
        let empty: Vec<f64> = (0..line.problem.steps)
            .map(|k| if taken(line.at_m(k), line.at_m(k + 1), 0.0) { 0.0 } else { line.step_m })
            .collect();
        for (group, element) in pool {
            let length = line.steps_of_length(element);
            let mut costs = vec![f64::INFINITY; line.problem.steps];
            let starts = (line.problem.steps + 1).saturating_sub(length);
            for (start, cost) in costs.iter_mut().enumerate().take(starts) {
                let (from, to) = (line.at_m(start), line.at_m(start + length));
                if !taken(from, to, TOUCH_M) && work.is_free(&line.rings(element, from, to)) {
                    *cost = UNGUIDED_COST * (to - from);
                }
            }
            line.problem.same_pair.push(1.0 - work.settings.alpha);
            line.problem.lengths.push(length);
            line.problem.costs.push(costs);
            line.pool.push((group, element));
            line.image_m.push(None);
        }
        line.problem.empty = empty;
        line
    }

    /// How much of the path has something beside it, in metres.
    fn built_m(&self) -> f64 {
        let steps = (0..self.problem.steps).filter(|k| {
            let at = (self.at_m(*k) + self.at_m(k + 1)) / 2.0;
            (0.0..=self.track.path.length_m()).contains(&at)
                && self.blocked.iter().any(|(low, high)| *low <= at && at <= *high)
        });
        steps.count() as f64 * self.step_m
    }

    /// Steps an element takes: its ends rounded in the old line, so that the lengths of a row sum up to
    /// what they did.
    fn steps_of_length(&self, element: &Element) -> usize {
        let steps = |at: f64| (at / self.nominal_m).round();
        (steps(element.span_m.1) - steps(element.span_m.0)).max(1.0) as usize
    }

    /// The image of an element, drawn towards its place along the side as the track's weight says.
    fn image(
        &self,
        group: &Group,
        element: &Element,
        work: &Work<'_>,
        scale: f64,
    ) -> Option<Vec<Vec<Vec2>>> {
        let weight = self.track.weight;
        let mapped = || work.guidance.image(group, element, scale);
        if weight >= 1.0 {
            return mapped();
        }
        // As far from the start of the new side as it was from the start of the old one.
        let frame = self.track.path.frame(element.span_m.0, element.span_m.1);
        let kept =
            element.rings.iter().map(|r| r.iter().map(|p| frame.apply(*p)).collect::<Vec<_>>());
        let kept: Vec<Vec<Vec2>> = kept.collect();
        if weight <= 0.0 {
            return Some(kept);
        }
        let mixed = |(a, b): (Vec<Vec2>, &Vec<Vec2>)| -> Vec<Vec2> {
            a.iter().zip(b).map(|(p, q)| q.lerp(*p, weight)).collect()
        };
        Some(mapped()?.into_iter().zip(&kept).map(mixed).collect())
    }

    /// Stretches of the path with something beside them, as deep as elements stand there.
    fn standing(&self, work: &Work<'_>, depth_m: f64) -> Vec<(f64, f64)> {
        let path = &self.track.path;
        let stretch = |(_, rings): &(Bounds, Vec<Vec<Vec2>>)| {
            let near = rings[0].iter().filter(|p| path.nearest(**p).1 <= depth_m);
            near.map(|p| path.project(*p)).fold(None, |found: Option<(f64, f64)>, at| {
                Some(found.map_or((at, at), |(l, h)| (l.min(at), h.max(at))))
            })
        };
        work.bodies.iter().filter_map(stretch).collect()
    }

    /// Adds to `taken` how much of the usual depth an image covers at each step.
    fn cover(&self, image: &[Vec<Vec2>], depth_m: f64, taken: &mut [f64]) {
        let Some((first, last)) = self.steps_of(image, 0) else { return };
        let slices = self.unrolled(image);
        for (step, taken) in taken.iter_mut().enumerate().take(last + 1).skip(first) {
            let covered = slices.depth_m(self.at_m(step), self.at_m(step + 1));
            *taken += covered / (depth_m * TAKEN_DEPTH);
        }
    }

    /// Adds an element with its costs.
    fn add(
        &mut self,
        group: &'a Group,
        element: &'a Element,
        image: &[Vec<Vec2>],
        taken: &[f64],
        work: &Work<'_>,
    ) {
        let settings = work.settings;
        let length = self.steps_of_length(element);
        let steps = self.problem.steps;
        let mut costs = vec![f64::INFINITY; steps];
        let at_m = self.track.path.project(middle(&image[0]));
        let turn = if self.track.is_row { Some(turn_of(element, image)) } else { None };
        let slices = self.unrolled(image);
        if let Some((first, last)) = self.steps_of(image, length) {
            for (start, cost) in costs.iter_mut().enumerate().take(last + 1).skip(first) {
                if start + length > steps {
                    break;
                }
                let (from, to) = (self.at_m(start), self.at_m(start + length));
                let shared = element.slices.shared_m2((from + to) / 2.0, &slices);
                let share = (shared / element.area_m2).min(1.0);
                let least = if element.kind == Kind::Fixed { FIXED_SHARE } else { 0.0 };
                if share <= least || !work.is_free(&self.rings(element, from, to)) {
                    continue;
                }
                let gaps: f64 = taken[start..start + length].iter().map(|t| 1.0 - t).sum();
                *cost = if settings.printed_cost {
                    element.area_m2 * (1.0 - share)
                } else {
                    (to - from) * (1.0 - share)
                        + settings.gap_cost * gaps * self.step_m
                        + OFF_COST * ((from + to) / 2.0 - at_m).abs()
                };
                if let Some(turn) = turn {
                    let off = trig::angle_between(self.track.path.frame(from, to).turn, turn);
                    *cost += settings.turn_cost * (to - from) * trig::sin(off).powi(2);
                }
            }
        }
        let same = 1.0 - settings.alpha;
        self.problem.same_pair.push(if element.kind == Kind::Fixed { f64::INFINITY } else { same });
        self.problem.lengths.push(length);
        self.problem.costs.push(costs);
        self.pool.push((group, element));
        self.image_m.push(Some(at_m));
    }

    /// Where a step begins along the path.
    fn at_m(&self, step: usize) -> f64 {
        (step as f64 - self.pad as f64) * self.step_m
    }

    /// First and last step at which something `length` steps long may touch an image.
    fn steps_of(&self, image: &[Vec<Vec2>], length: usize) -> Option<(usize, usize)> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in image.iter().flatten() {
            let at = self.track.path.project(*p);
            (low, high) = (low.min(at), high.max(at));
        }
        let steps = self.problem.steps;
        let step = |at: f64| (at / self.step_m).floor() + self.pad as f64;
        let first = (step(low) - length as f64 - 1.0).max(0.0) as usize;
        let last = ((step(high) + 2.0).max(0.0) as usize).min(steps.checked_sub(1)?);
        (first <= last).then_some((first, last))
    }

    /// Rings in slices, seen from the path.
    fn unrolled(&self, rings: &[Vec<Vec2>]) -> Slices {
        let path = &self.track.path;
        let moved: Vec<Vec<Vec2>> =
            rings.iter().map(|r| r.iter().map(|p| path.unrolled(*p)).collect()).collect();
        Slices::of(moved.iter().map(|r| &r[..]))
    }

    fn rings(&self, element: &Element, from_m: f64, to_m: f64) -> Vec<Vec<Vec2>> {
        let frame = self.track.path.frame(from_m, to_m);
        element.rings.iter().map(|r| r.iter().map(|p| frame.apply(*p)).collect()).collect()
    }

    /// Solves, and solves again with dearer repetitions: fixed elements stand once, others are repeated
    /// no more often than the line grew without paying for it.
    fn solve(&self, settings: &Settings, stretch: f64) -> Vec<(usize, f64)> {
        let mut problem = self.problem.clone();
        let usual = stretch.ceil().max(1.0);
        let mut labels = label::solve(&problem).1;
        for _ in 0..ROUNDS {
            if !self.make_dearer(&mut problem, &labels, usual, settings) {
                break;
            }
            labels = label::solve(&problem).1;
        }
        labels.dedup_by(|b, a| {
            let fixed =
                |l: &label::Label| l.element.filter(|e| self.pool[*e].1.kind == Kind::Fixed);
            fixed(a).is_some() && fixed(a) == fixed(b)
        });
        let start = |l: label::Label| Some((l.element?, self.at_m(l.start)));
        labels.into_iter().filter_map(start).collect()
    }

    /// Raises the costs of elements used too often; false where there are none.
    fn make_dearer(
        &self,
        problem: &mut Problem,
        labels: &[label::Label],
        usual: f64,
        settings: &Settings,
    ) -> bool {
        let mut again = false;
        for e in 0..self.pool.len() {
            let starts = labels.iter().filter(|l| l.element == Some(e)).map(|l| l.start);
            let starts: Vec<usize> = starts.collect();
            let uses = starts.len() as f64;
            let costs = &mut problem.costs[e];
            if self.pool[e].1.kind == Kind::Fixed && starts.len() > 1 {
                let best = starts.iter().copied().min_by(|a, b| costs[*a].total_cmp(&costs[*b]));
                for (start, cost) in costs.iter_mut().enumerate() {
                    *cost = if Some(start) == best { *cost } else { f64::INFINITY };
                }
                again = true;
            } else if uses > usual {
                let length_m = problem.lengths[e] as f64 * self.step_m;
                let dearer = settings.repetition * length_m * (uses - usual) / uses;
                costs.iter_mut().for_each(|cost| *cost += dearer);
                again |= dearer > 0.0;
            }
        }
        again
    }

    /// The elements of a sequence with their motions, brought to where their images lie. Neighbours
    /// that share walls stay together, and fill what is left beside them by stretching a little.
    fn placed(&self, sequence: &[(usize, f64)], stretch: f64) -> Vec<(&'a Element, Motion)> {
        let chains = self.chains(sequence);
        let pad_m = self.pad as f64 * self.step_m;
        let mut wishes = Vec::with_capacity(chains.len());
        for (k, chain) in chains.iter().enumerate() {
            let before_m = match k.checked_sub(1).map(|before| &chains[before]) {
                None => 0.0,
                Some(before) => {
                    let (a, b) = (before.last, sequence[chain.first].0);
                    self.distance(a, b) - self.length(a) / 2.0 - self.length(b) / 2.0
                        + before.length_m
                }
            };
            // Positions are those of the chains' starts.
            let weight = chain.offsets.len() as f64;
            wishes.push(Wish { at_m: chain.wish_m + pad_m, weight, after_m: before_m });
        }
        let last_m = chains.last().map_or(0.0, |c| c.length_m);
        let mut starts = spaced(&wishes, self.track.path.length_m() + 2.0 * pad_m, last_m);
        starts.iter_mut().for_each(|start| *start -= pad_m);
        let mut out = Vec::with_capacity(sequence.len());
        for (k, (chain, start)) in chains.iter().zip(&starts).enumerate() {
            let before =
                k.checked_sub(1).map_or(f64::NEG_INFINITY, |b| starts[b] + chains[b].length_m);
            let after = starts.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let (from, to) = self.filled(chain, sequence, *start, (before, after), stretch);
            let factor = (to - from) / chain.length_m;
            for (&(e, _), offset) in sequence[chain.first..].iter().zip(&chain.offsets) {
                let element = self.pool[e].1;
                let half = self.length(e) * factor / 2.0;
                let at = from + offset * factor;
                let frame = self.track.path.frame(at - half, at + half);
                let stretch = Vec2::new(factor, 1.0);
                out.push((element, Motion { into: element.to_frame, stretch, out: frame }));
            }
        }
        out
    }

    /// Neighbours in a sequence that share walls and nearly meet.
    fn chains(&self, sequence: &[(usize, f64)]) -> Vec<Chain> {
        let uses = |e: usize| sequence.iter().filter(|(other, _)| *other == e).count();
        let slot = |(e, start): (usize, f64)| {
            let length = self.problem.lengths[e] as f64 * self.step_m;
            (start, start + length)
        };
        let mut out: Vec<Chain> = Vec::new();
        for (k, &(e, start)) in sequence.iter().enumerate() {
            let (from, to) = slot((e, start));
            let image_m = self.image_m[e].filter(|_| uses(e) == 1);
            let wish = image_m.unwrap_or((from + to) / 2.0);
            let linked = k.checked_sub(1).map(|b| sequence[b]).filter(|before| {
                let gap = from - slot(*before).1;
                let shares = self.pool[before.0].1.walls.1 && self.pool[e].1.walls.0;
                shares && gap <= CLOSE_SHARE * (to - from) + self.step_m
            });
            match (linked, out.last_mut()) {
                (Some((before, _)), Some(chain)) => {
                    let offset = chain.offsets[chain.offsets.len() - 1] + self.distance(before, e);
                    let n = chain.offsets.len() as f64;
                    chain.wish_m = (chain.wish_m * n + wish - offset) / (n + 1.0);
                    chain.offsets.push(offset);
                    chain.length_m = offset + self.length(e) / 2.0;
                    chain.last = e;
                }
                _ => {
                    let half = self.length(e) / 2.0;
                    out.push(Chain {
                        first: k,
                        last: e,
                        offsets: vec![half],
                        length_m: 2.0 * half,
                        wish_m: wish - half,
                    });
                }
            }
        }
        out
    }

    /// Where a chain begins and ends when it fills what is left to what it shares walls with.
    fn filled(
        &self,
        chain: &Chain,
        sequence: &[(usize, f64)],
        start: f64,
        (before, after): (f64, f64),
        stretch: f64,
    ) -> (f64, f64) {
        let end = start + chain.length_m;
        let wall_before = self.pool[sequence[chain.first].0].1.walls.0;
        let wall_after = self.pool[chain.last].1.walls.1;
        let blocked = |limit: f64, up: bool| {
            let ends = self.blocked.iter().map(|(from, to)| if up { *from } else { *to });
            let middle = (start + end) / 2.0;
            let beyond = ends.filter(|at| if up { *at > middle } else { *at < middle });
            if up { beyond.fold(limit, f64::min) } else { beyond.fold(limit, f64::max) }
        };
        let (low, high) = (blocked(before, false), blocked(after, true));
        // What is left on both sides, as far as the stretch goes.
        let gap = |wall: bool, gap: f64| {
            if wall && gap <= CLOSE_SHARE * chain.length_m { gap } else { 0.0 }
        };
        let (before, after) = (gap(wall_before, start - low), gap(wall_after, high - end));
        let share = (stretch * chain.length_m / (before + after).max(1e-9)).min(1.0);
        let (from, to) = (start - before * share, end + after * share);
        if to - from > 0.5 * chain.length_m { (from, to) } else { (start, end) }
    }

    fn length(&self, e: usize) -> f64 {
        (self.pool[e].1.span_m.1 - self.pool[e].1.span_m.0).max(0.1)
    }

    /// How far apart the middles of two neighbours stay: as they were if they were neighbours and
    /// reached past each other, else by their lengths.
    fn distance(&self, before: usize, after: usize) -> f64 {
        let ((g, a), (h, b)) = (self.pool[before], self.pool[after]);
        let lengths_m = (self.length(before) + self.length(after)) / 2.0;
        let middle = |e: &Element| (e.span_m.0 + e.span_m.1) / 2.0;
        let apart = middle(b) - middle(a);
        if std::ptr::eq(g, h) && apart > 0.0 { apart.min(lengths_m) } else { lengths_m }
    }
}

/// Elements that share walls from first to last.
struct Chain {
    /// Index of the first one in the sequence.
    first: usize,
    /// Index of the last one in the pool.
    last: usize,
    /// Middles of the elements from the chain's start.
    offsets: Vec<f64>,
    length_m: f64,
    /// Where its start should lie.
    wish_m: f64,
}

/// The direction that an element's path has in its image.
fn turn_of(element: &Element, image: &[Vec<Vec2>]) -> Vec2 {
    let pairs = element.rings.iter().flatten().zip(image.iter().flatten());
    Rigid::fit(pairs.map(|(p, q)| (*p, *q, 1.0))).turn
}

fn bounds(ring: &[Vec2]) -> Bounds {
    let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let (min, max) = ring.iter().fold(start, |(l, h), p| (l.min(*p), h.max(*p)));
    Bounds { min, max }
}

/// A ring drawn towards its middle by about `by_m`.
fn shrunk(ring: &[Vec2], by_m: f64) -> Vec<Vec2> {
    let middle = middle(ring);
    let draw = |p: &Vec2| {
        let way = *p - middle;
        let length = way.length();
        middle + way * ((length - by_m).max(length * 0.2) / length.max(1e-9))
    };
    ring.iter().map(draw).collect()
}

/// Do two rings share no inside? By sides that cross and corners that lie inside.
fn apart(a: &[Vec2], b: &[Vec2]) -> bool {
    let sides = |r: &'_ [Vec2], i: usize| (r[i], r[(i + 1) % r.len()]);
    let crosses = (0..a.len()).any(|i| {
        let (p, q) = sides(a, i);
        (0..b.len()).any(|j| {
            let (r, s) = sides(b, j);
            let side = |u: Vec2, v: Vec2, w: Vec2| (v - u).perp_dot(w - u);
            side(p, q, r) * side(p, q, s) < 0.0 && side(r, s, p) * side(r, s, q) < 0.0
        })
    });
    !crosses && !winds_around(b, a[0]) && !winds_around(a, b[0])
}

fn winds_around(ring: &[Vec2], p: Vec2) -> bool {
    (0..ring.len()).fold(false, |inside, i| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let crossed = (a.y > p.y) != (b.y > p.y) && ((b - a).perp_dot(p - a) > 0.0) == (b.y > a.y);
        inside ^ crossed
    })
}
