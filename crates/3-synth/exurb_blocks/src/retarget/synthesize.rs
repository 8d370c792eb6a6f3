//! The pure core: a layout, a new outline → where the elements go.

use exurb_geom::{GridPoint, Polygon, Rigid, Vec2};

use super::Settings;
use super::correspondence::Correspondence;
use super::groups::{Element, Group, Groups, Kind};
use super::guidance::Guidance;
use super::line::Line;
use super::path::Path;
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
/// A gap is filled where at least this share of an element is missing.
const FILL_SHARE: f64 = 0.6;
/// Elements may reach over the outline by this much, in metres.
const OVER_M: f64 = 1.0;

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
        let is_whole = whole::is_whole(block_m2, &polygons.iter().collect::<Vec<_>>());
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
pub(super) struct Track<'a> {
    /// The line.
    pub(super) path: Path,
    /// Elements with their groups.
    pool: Vec<(&'a Group, &'a Element)>,
    /// How far it follows the guidance map.
    pub(super) weight: f64,
    /// How much longer the line is than what it was.
    stretch: f64,
    /// Share of its length that elements took.
    built_share: f64,
    /// Is it a row inside?
    pub(super) is_row: bool,
}

/// A layout on its way into an outline.
pub(super) struct Work<'a> {
    source: &'a Source,
    /// The guidance map.
    pub(super) guidance: Guidance<'a>,
    /// What a user turned.
    pub(super) settings: &'a Settings,
    placed: Vec<Placement>,
    /// Rings of what stands already.
    pub(super) bodies: Vec<Vec<Vec<Vec2>>>,
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
        let repeatable = |(_, e): &(&Group, &Element)| e.kind == Kind::Repeatable;
        let mut pool: Vec<(&Group, &Element)> =
            track.pool.iter().copied().filter(repeatable).collect();
        if pool.is_empty() {
            // Only corner buildings stood along it: what stands along the other sides is the style.
            let sides = self.source.groups.groups.iter().filter(|g| g.side.is_some());
            let elements = sides.flat_map(|g| g.elements.iter().map(move |e| (g, e)));
            pool = elements.filter(repeatable).collect();
        }
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
            self.bodies.push(rings);
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

    /// Does it stand inside, give or take?
    pub(super) fn is_inside(&self, rings: &[Vec<Vec2>]) -> bool {
        let domain = &self.guidance.domain;
        rings[0].iter().all(|p| {
            domain.contains(GridPoint::round(*p))
                || domain.polygon().boundary_distance_m(*p) < OVER_M
        })
    }
}
