//! One line of the new layout as a problem of labelling: what each element costs at each step along it,
//! and where the elements of the cheapest sequence come to stand.

use exurb_geom::{Rigid, Vec2, trig};

use super::Settings;
use super::groups::{Element, Group, Kind};
use super::guidance::middle;
use super::label::{self, Problem};
use super::spacing::{Wish, spaced};
use super::synthesize::{Track, Work};
use crate::motion::Motion;
use crate::slices::Slices;

/// A fixed element stands where it covers at least this share of its image.
const FIXED_SHARE: f64 = 0.3;
/// How often sequences are solved again with dearer repetitions.
const ROUNDS: usize = 3;
/// What being off the image costs, as a share of the distance: breaks ties.
const OFF_COST: f64 = 0.02;
/// What an element costs that stands where nothing guides it, as a share of its length.
const UNGUIDED_COST: f64 = 0.3;
/// Gaps up to this share of an element between two that share walls are closed.
const CLOSE_SHARE: f64 = 0.6;
/// Elements reach past the ends of their path by at most this, in metres.
const MOST_PAD_M: f64 = 15.0;
/// Elements that share no walls may lie in others with this share of them.
const TOUCH_SHARE: f64 = 0.03;
/// What an element costs of which a share is cut off, as a multiple of that share of its length.
const CUT_COST: f64 = 2.0;
/// The same where nothing guides it: filling a gap with the most that may be cut costs less than the gap.
const UNGUIDED_CUT_COST: f64 = 0.8;
/// Ground counts as taken where the map covers this share of the usual depth.
const TAKEN_DEPTH: f64 = 0.5;

/// A track as a problem of labelling.
pub struct Line<'t, 'a> {
    track: &'t Track<'a>,
    /// Elements with their groups.
    pub pool: Vec<(&'a Group, &'a Element)>,
    /// Metres a step, so that whole steps fill the path, and as asked for.
    step_m: f64,
    nominal_m: f64,
    /// Steps before and behind the path: elements at corners reach past its ends.
    pad: usize,
    problem: Problem,
    /// Where each element's image lies along the path, if it has one.
    image_m: Vec<Option<f64>>,
    /// What stands along the path already.
    standing: Vec<Standing>,
}

/// A body that stands along a path.
struct Standing {
    /// From where to where it stands at the front, if it does.
    front_m: Option<(f64, f64)>,
    /// From where to where it stands in all.
    reach_m: (f64, f64),
    /// As seen from the path.
    slices: Slices,
}

/// What reaches as near to the building line of a path is at its front, in metres.
const FRONT_M: f64 = 8.0;

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
            standing: Vec::new(),
        }
    }

    pub fn of(track: &'t Track<'a>, pool: &[(&'a Group, &'a Element)], work: &Work<'_>) -> Self {
        let settings = work.settings;
        let mut line = Self::empty(track, pool, work);
        let (steps, step_m) = (line.problem.steps, line.step_m);
        let usual_depth =
            pool.iter().map(|(_, e)| e.depth_m).sum::<f64>() / pool.len().max(1) as f64;
        let depth = usual_depth.min(settings.empty_depth).max(1.0);
        line.standing = line.standing(pool, work);
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
    pub fn unguided(
        track: &'t Track<'a>,
        pool: &[(&'a Group, &'a Element)],
        work: &Work<'_>,
    ) -> Self {
        let mut line = Self::empty(track, &[], work);
        line.standing = line.standing(pool, work);
        let taken = |from: f64, to: f64| line.fronts().any(|(low, high)| low < to && from < high);
        let empty: Vec<f64> = (0..line.problem.steps)
            .map(|k| if taken(line.at_m(k), line.at_m(k + 1)) { 0.0 } else { line.step_m })
            .collect();
        for (group, element) in pool {
            let length = line.steps_of_length(element);
            let mut costs = vec![f64::INFINITY; line.problem.steps];
            let starts = (line.problem.steps + 1).saturating_sub(length);
            for (start, cost) in costs.iter_mut().enumerate().take(starts) {
                let (from, to) = (line.at_m(start), line.at_m(start + length));
                if let Some(cut) = line.cut_share(element, from, to, work) {
                    *cost = (UNGUIDED_COST + UNGUIDED_CUT_COST * cut) * (to - from);
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
    pub fn built_m(&self) -> f64 {
        let steps = (0..self.problem.steps).filter(|k| {
            let at = (self.at_m(*k) + self.at_m(k + 1)) / 2.0;
            (0.0..=self.track.path.length_m()).contains(&at)
                && self.fronts().any(|(low, high)| low <= at && at <= high)
        });
        steps.count() as f64 * self.step_m
    }

    /// Stretches of the path with something at its front.
    fn fronts(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.standing.iter().filter_map(|s| s.front_m)
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

    /// What stands along the path already, as deep as elements of `pool` stand there.
    fn standing(&self, pool: &[(&Group, &Element)], work: &Work<'_>) -> Vec<Standing> {
        let path = &self.track.path;
        let mean = |of: &dyn Fn(&Element) -> f64| {
            pool.iter().map(|(_, e)| of(e)).sum::<f64>() / pool.len().max(1) as f64
        };
        let depth_m = mean(&|e| e.depth_m).max(1.0);
        let setback_m =
            |e: &Element| e.rings.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let front_m = (mean(&setback_m) + FRONT_M).min(depth_m);
        let is_near =
            |rings: &&Vec<Vec<Vec2>>| rings[0].iter().any(|p| path.nearest(*p).1 <= depth_m);
        let seen = |rings: &Vec<Vec<Vec2>>| {
            let slices = self.unrolled(rings);
            let reach_m = slices.span_m(f64::INFINITY).unwrap_or((0.0, 0.0));
            Standing { front_m: slices.span_m(front_m), reach_m, slices }
        };
        work.bodies.iter().filter(is_near).map(seen).collect()
    }

    /// The share of an element, between two places along the path, that lies in what stands there, up to
    /// what may be cut off; `None` where it is more, or where it reaches over the outline. What stands
    /// alone is not cut, but for a touch that refinement parts.
    fn cut_share(&self, element: &Element, from_m: f64, to_m: f64, work: &Work<'_>) -> Option<f64> {
        let middle_m = (from_m + to_m) / 2.0;
        let (low, high) = (middle_m + element.reach_m.0, middle_m + element.reach_m.1);
        let met = self.standing.iter().filter(|s| s.reach_m.0 < high && low < s.reach_m.1);
        let share = met.map(|s| element.slices.shared_m2(middle_m, &s.slices)).sum::<f64>()
            / element.area_m2;
        let attached = element.walls.0 || element.walls.1;
        let most = if attached { work.settings.cut } else { work.settings.cut.min(TOUCH_SHARE) };
        let fits = share <= most && work.is_inside(&self.rings(element, from_m, to_m));
        fits.then_some(share)
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
                if share <= least {
                    continue;
                }
                let Some(cut) = self.cut_share(element, from, to, work) else { continue };
                let gaps: f64 = taken[start..start + length].iter().map(|t| 1.0 - t).sum();
                *cost = if settings.printed_cost {
                    element.area_m2 * (1.0 - share)
                } else {
                    (to - from) * (1.0 - share)
                        + settings.gap_cost * gaps * self.step_m
                        + OFF_COST * ((from + to) / 2.0 - at_m).abs()
                };
                *cost += CUT_COST * cut * (to - from);
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
    pub fn solve(&self, settings: &Settings, stretch: f64) -> Vec<(usize, f64)> {
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
    pub fn placed(&self, sequence: &[(usize, f64)], stretch: f64) -> Vec<(&'a Element, Motion)> {
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
            let ends = self.fronts().map(|(from, to)| if up { from } else { to });
            let middle = (start + end) / 2.0;
            let beyond = ends.filter(|at| if up { *at > middle } else { *at < middle });
            if up { beyond.fold(limit, f64::min) } else { beyond.fold(limit, f64::max) }
        };
        let (low, high) = (blocked(before, false), blocked(after, true));
        // What is left on both sides; less than nothing where it lies in others.
        let most_m = stretch * chain.length_m;
        let gap = |wall: bool, gap: f64| {
            let close = wall && gap <= CLOSE_SHARE * chain.length_m;
            if close { gap.max(-most_m) } else { 0.0 }
        };
        let (before, after) = (gap(wall_before, start - low), gap(wall_after, high - end));
        let (from, to) = if before > 0.0 && after > 0.0 && before + after > most_m {
            // Both cannot be closed: the narrower one is, and what is left of the other is one gap.
            let most_m = most_m.min(before.max(after));
            if before <= after {
                (low, end - before + most_m)
            } else {
                (start + after - most_m, high)
            }
        } else {
            (start - before.min(most_m), end + after.min(most_m))
        };
        if to - from > 0.5 * chain.length_m { (from, to) } else { (start, end) }
    }

    pub fn length(&self, e: usize) -> f64 {
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
