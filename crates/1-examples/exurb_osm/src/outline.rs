//! From ways and relations to polygons.

use exurb_geom::{GridPoint, Polygon, overlay};

use crate::elements::{Elements, Way};
use crate::places::{Places, Vertex};

/// What became of the outlines of one kind of element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Outlines that cross themselves, mended by the even-odd rule.
    pub mended: usize,
    /// Outlines closed across missing nodes.
    pub bridged: usize,
    /// Outlines that do not close or have no area, left out.
    pub dropped: usize,
}

impl Repairs {
    /// Adds another count.
    pub fn add(&mut self, other: Self) {
        self.mended += other.mended;
        self.bridged += other.bridged;
        self.dropped += other.dropped;
    }

    /// One sentence on `what`, if there is anything to say.
    pub fn warning(self, what: &str) -> Option<String> {
        let said: Vec<String> = [
            (self.mended, "that cross themselves were mended"),
            (self.bridged, "with missing nodes were closed across the gap"),
            (self.dropped, "that do not close or have no area were left out"),
        ]
        .into_iter()
        .filter(|(n, _)| *n > 0)
        .map(|(n, done)| format!("{n} outlines of {what} {done}"))
        .collect();
        (!said.is_empty()).then(|| said.join(", "))
    }
}

/// Does the way end where it begins?
pub fn is_closed(elements: &Elements, way: &Way) -> bool {
    let refs = elements.refs_of(way);
    refs.len() >= 4 && refs.first() == refs.last()
}

/// The polygons of a closed way. Missing nodes are skipped when `bridge` is set and at least three
/// are left; else the way gives none.
pub fn of_way(
    elements: &Elements,
    places: &Places,
    way: &Way,
    bridge: bool,
    repairs: &mut Repairs,
) -> Vec<Polygon> {
    let vertices: Vec<Option<Vertex>> = places.vertices(elements, way).collect();
    let gaps = vertices.iter().any(Option::is_none);
    if gaps && !bridge {
        repairs.dropped += 1;
        return Vec::new();
    }
    let ring: Vec<GridPoint> = vertices.into_iter().flatten().map(|(_, p)| p).collect();
    repairs.bridged += usize::from(gaps && ring.len() >= 3);
    valid(Polygon::new(ring, Vec::new()), repairs)
}

/// The polygons of the rings that `ways` make, holes by nesting: a ring inside an odd number of
/// others is a hole. Roles are not asked, because maps often lack or mix them.
pub fn of_ways(
    elements: &Elements,
    places: &Places,
    ways: &[&Way],
    repairs: &mut Repairs,
) -> Vec<Polygon> {
    let mut lines: Vec<Vec<Vertex>> = Vec::new();
    for way in ways {
        match places.whole(elements, way) {
            Some(line) if line.len() > 1 => lines.push(line),
            _ => repairs.dropped += 1,
        }
    }
    let (rings, open) = rings(lines);
    repairs.dropped += open;
    let mut outlines: Vec<Polygon> = Vec::new();
    for ring in rings {
        let ring = ring.into_iter().map(|(_, p)| p).collect();
        outlines.extend(Polygon::new(ring, Vec::new()));
    }
    nest(outlines).into_iter().flat_map(|p| valid(Some(p), repairs)).collect()
}

/// Joins lines end to end at shared nodes into closed rings, whatever their order and direction;
/// also returns the number of lines that do not close. O(n²) in lines.
pub fn rings(lines: Vec<Vec<Vertex>>) -> (Vec<Vec<Vertex>>, usize) {
    let mut left: Vec<Option<Vec<Vertex>>> = lines.into_iter().map(Some).collect();
    let mut out = Vec::new();
    let mut open = 0;
    for first in 0..left.len() {
        let Some(mut ring) = left[first].take() else { continue };
        let mut joined = 1;
        while ring[0].0 != ring[ring.len() - 1].0 {
            let end = ring[ring.len() - 1].0;
            let next = left.iter().position(|line| {
                line.as_ref().is_some_and(|l| l[0].0 == end || l[l.len() - 1].0 == end)
            });
            let Some(mut line) = next.and_then(|i| left[i].take()) else { break };
            if line[0].0 != end {
                line.reverse();
            }
            ring.extend(line.into_iter().skip(1));
            joined += 1;
        }
        if ring[0].0 == ring[ring.len() - 1].0 {
            out.push(ring);
        } else {
            open += joined;
        }
    }
    (out, open)
}

/// Outlines without holes become polygons with holes; in order of area, largest first.
fn nest(mut outlines: Vec<Polygon>) -> Vec<Polygon> {
    if outlines.len() < 2 {
        return outlines;
    }
    outlines.sort_by(|a, b| b.area_m2().total_cmp(&a.area_m2()).then_with(|| a.cmp(b)));
    // Of every ring the rings around it, innermost last.
    let mut homes: Vec<Vec<usize>> = Vec::new();
    for (i, inner) in outlines.iter().enumerate() {
        let at = inner.interior_point();
        let around = (0..i).filter(|j| {
            outlines[*j].bounds().contains(at) && outlines[*j].contains(GridPoint::round(at))
        });
        homes.push(around.collect());
    }
    let mut holes: Vec<Vec<Vec<GridPoint>>> = vec![Vec::new(); outlines.len()];
    for (inner, home) in outlines.iter().zip(&homes).filter(|(_, home)| home.len() % 2 == 1) {
        holes[home[home.len() - 1]].push(inner.exterior().to_vec());
    }
    let solid = outlines.iter().zip(&homes).zip(holes).filter(|((_, home), _)| home.len() % 2 == 0);
    solid.filter_map(|((p, _), holes)| Polygon::new(p.exterior().to_vec(), holes)).collect()
}

/// The polygon itself if it is valid, else its repair.
fn valid(polygon: Option<Polygon>, repairs: &mut Repairs) -> Vec<Polygon> {
    let Some(polygon) = polygon else {
        repairs.dropped += 1;
        return Vec::new();
    };
    if polygon.is_valid() {
        return vec![polygon];
    }
    let mended = overlay::repair(&polygon);
    if mended.is_empty() {
        repairs.dropped += 1;
    } else {
        repairs.mended += 1;
    }
    mended
}
