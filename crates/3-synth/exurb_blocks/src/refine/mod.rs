//! Layout refinement: footprints that reach over the kerb or into each other are moved until nothing
//! overlaps, or dropped.
//!
//! Source: Hartmann 2018, section 5.1.4; Müller, Heidelberger, Hennix, Ratcliff 2007, *Position Based
//! Dynamics*. Steps: 1 a footprint whose middle lies outside the block is dropped; 2 those that come
//! nearer to the kerb than they may, and the smaller ones of overlapping pairs, are conflicted, the
//! others stand fast; 3 conflicted bodies are pushed off the kerb and out of others and brought back
//! to their shape, over and over in fixed order ([`solve`]); where that does not end, the bodies pushed
//! against give way, too; 4 what little still overlaps is trimmed; a footprint that would lose more
//! than the tolerance is dropped.
//!
//! Departures: edge lengths alone let a rectangle lean over, so shapes are held by shape matching; only
//! in the last steps may they give by the tolerance. A layout is to come to rest, so positions carry no
//! velocity. The paper drops what reaches beyond the centrelines, which loses corner buildings; here
//! the middle decides. O(steps · corners · log kerb).

mod solve;
#[cfg(test)]
mod tests;

use exurb_geom::{BoxGrid, GridPoint, Polygon, offset, overlap, overlay};

use crate::kerb::Kerb;

/// A block that bodies stand in.
pub struct Ground<'a> {
    /// The block up to the kerb.
    pub block: &'a Polygon,
    /// Its kerb.
    pub kerb: &'a Kerb,
    /// What stands there and stays.
    pub standing: &'a [Polygon],
    /// Do the bodies stand where they stood in the example? Then none is pushed by another: what is in
    /// the way of something is trimmed or dropped.
    pub at_home: bool,
}

/// A footprint where it is wished for.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its outline.
    pub polygon: Polygon,
    /// Distance to the kerb that it keeps, in metres.
    pub clearance_m: f64,
}

/// What became of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Fate {
    /// It stands where it was wished for.
    Stays,
    /// It was moved or trimmed.
    Moved(Polygon),
    /// It found no place.
    Dropped(Why),
}

/// Why a body was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// Its middle lies outside the block.
    Outside,
    /// It cannot be brought off the street.
    Street,
    /// It cannot be brought apart from another.
    Neighbour,
    /// Its outline crosses itself.
    Shape,
    /// It would stand on water or open land.
    OpenLand,
}

/// Shared areas up to this are rounding, in m²; half of what the laws allow.
pub(crate) const SLACK_M2: f64 = 0.05;
/// What the kerb may come nearer than it should, in metres.
const SLACK_M: f64 = 0.01;

/// Brings `bodies` apart and off the street; one fate each. Areas and sides change by at most
/// `tolerance`, a share.
pub fn refine(ground: &Ground<'_>, bodies: &[Body], tolerance: f64) -> Vec<Fate> {
    let count = bodies.len();
    let stays = ground.standing.iter().map(|p| Body { polygon: p.clone(), clearance_m: 0.0 });
    let bodies: Vec<Body> = bodies.iter().cloned().chain(stays).collect();
    let (bodies, stays) = (&bodies[..], |i: usize| i >= count);
    let admitted = |(i, body)| if stays(i) { Fate::Stays } else { admitted(ground, body) };
    let mut fates: Vec<Fate> = bodies.iter().enumerate().map(admitted).collect();
    let boxes = BoxGrid::of(bodies.iter().map(|b| &b.polygon));
    let conflicted = conflicted(ground, bodies, count, &fates, &boxes);
    if !conflicted.contains(&true) {
        fates.truncate(count);
        return fates;
    }
    let present: Vec<bool> = fates.iter().map(|f| *f == Fate::Stays).collect();
    let moved = match ground.at_home {
        true => conflicted.iter().zip(bodies).map(|(c, b)| c.then(|| b.polygon.clone())).collect(),
        false => solve::solve(ground, bodies, count, &present, &conflicted, tolerance),
    };
    settle(ground, bodies, moved, tolerance, &mut fates);
    fates.truncate(count);
    fates
}

fn admitted(ground: &Ground<'_>, body: &Body) -> Fate {
    if !body.polygon.is_valid() {
        return Fate::Dropped(Why::Shape);
    }
    let inside = ground.block.contains(GridPoint::round(body.polygon.interior_point()));
    if inside { Fate::Stays } else { Fate::Dropped(Why::Outside) }
}

/// Which of the first `count` bodies have to move; the others stand fast.
fn conflicted(
    ground: &Ground<'_>,
    bodies: &[Body],
    count: usize,
    fates: &[Fate],
    boxes: &BoxGrid,
) -> Vec<bool> {
    let present = |i: usize| fates[i] == Fate::Stays;
    let mut out: Vec<bool> = (0..bodies.len())
        .map(|i| i < count && present(i) && !is_off_kerb(ground, &bodies[i]))
        .collect();
    let mut near = Vec::new();
    for i in (0..count).filter(|i| present(*i)) {
        boxes.meeting_polygon(&bodies[i].polygon, &mut near);
        for j in near.iter().map(|j| *j as usize).filter(|j| *j > i && present(*j)) {
            let (a, b) = (&bodies[i].polygon, &bodies[j].polygon);
            if overlap::shared_m2(a, b, SLACK_M2) > SLACK_M2 {
                out[if j >= count || b.area_m2() > a.area_m2() { i } else { j }] = true;
            }
        }
    }
    out
}

/// Does a body keep its distance to the kerb?
pub(crate) fn is_off_kerb(ground: &Ground<'_>, body: &Body) -> bool {
    let enough_m = body.clearance_m.max(0.0) + 1.0;
    let clearance_m = ground.kerb.clearance_up_to_m(enough_m, &body.polygon);
    clearance_m >= body.clearance_m - SLACK_M
        && (clearance_m >= 0.0 || overlap::outside_m2(&body.polygon, ground.block) <= SLACK_M2)
}

/// Writes the fates of moved bodies, larger ones first: what overlaps is trimmed or dropped.
fn settle(
    ground: &Ground<'_>,
    bodies: &[Body],
    moved: Vec<Option<Polygon>>,
    tolerance: f64,
    fates: &mut [Fate],
) {
    let place = |i: usize| moved[i].as_ref().unwrap_or(&bodies[i].polygon);
    let boxes = BoxGrid::of((0..bodies.len()).map(place));
    let mut order: Vec<usize> = (0..bodies.len()).filter(|i| moved[*i].is_some()).collect();
    let area_m2 = |i: usize| bodies[i].polygon.area_m2();
    order.sort_by(|i, j| area_m2(*j).total_cmp(&area_m2(*i)).then(i.cmp(j)));
    let mut settled: Vec<bool> =
        (0..bodies.len()).map(|i| fates[i] == Fate::Stays && moved[i].is_none()).collect();
    let mut near = Vec::new();
    let mut insets = Insets { block: ground.block, made: Vec::new() };
    for i in order {
        boxes.meeting_polygon(place(i), &mut near);
        let neighbours: Vec<Polygon> = near
            .iter()
            .map(|j| *j as usize)
            .filter(|j| settled[*j])
            .map(|j| standing(&fates[j], place(j)).clone())
            .collect();
        let least_m2 = area_m2(i) * (1.0 - tolerance);
        let body = |i: usize| Body { polygon: place(i).clone(), ..bodies[i] };
        fates[i] = match trimmed(ground, &mut insets, &body(i), &neighbours, least_m2) {
            Ok(polygon) if polygon == bodies[i].polygon => Fate::Stays,
            Ok(polygon) => Fate::Moved(polygon),
            Err(why) => Fate::Dropped(why),
        };
        settled[i] = !matches!(fates[i], Fate::Dropped(_));
    }
}

fn standing<'a>(fate: &'a Fate, place: &'a Polygon) -> &'a Polygon {
    if let Fate::Moved(polygon) = fate { polygon } else { place }
}

/// A block less what lies nearer to its kerb than so many metres, for few different distances.
struct Insets<'a> {
    block: &'a Polygon,
    made: Vec<(f64, Vec<Polygon>)>,
}

impl Insets<'_> {
    fn by(&mut self, distance_m: f64) -> &[Polygon] {
        let known = self.made.iter().position(|(by, _)| *by == distance_m);
        let at = known.unwrap_or_else(|| {
            self.made.push((distance_m, offset::inset(self.block, distance_m)));
            self.made.len() - 1
        });
        &self.made[at].1
    }
}

/// What was wished for less what lies on the street or in a neighbour.
fn trimmed(
    ground: &Ground<'_>,
    insets: &mut Insets<'_>,
    wished: &Body,
    neighbours: &[Polygon],
    least_m2: f64,
) -> Result<Polygon, Why> {
    let clearance_m = wished.clearance_m;
    let mut out = wished.polygon.clone();
    if !out.is_valid() {
        out = largest(overlay::repair(&out)).ok_or(Why::Shape)?;
    }
    let body = Body { polygon: out, clearance_m };
    out = if is_off_kerb(ground, &body) {
        body.polygon
    } else {
        let free = insets.by(clearance_m.max(0.0));
        let inside = free.iter().flat_map(|f| overlay::intersection(&body.polygon, f)).collect();
        largest(inside).filter(|p| p.area_m2() >= least_m2).ok_or(Why::Street)?
    };
    let overlapping: Vec<&Polygon> =
        neighbours.iter().filter(|n| overlap::shared_m2(&out, n, SLACK_M2) > SLACK_M2).collect();
    if !overlapping.is_empty() {
        out = largest(overlay::difference(&out, overlapping)).ok_or(Why::Neighbour)?;
    }
    if out.area_m2() < least_m2 || !out.is_valid() { Err(Why::Neighbour) } else { Ok(out) }
}

fn largest(polygons: Vec<Polygon>) -> Option<Polygon> {
    polygons.into_iter().next()
}
