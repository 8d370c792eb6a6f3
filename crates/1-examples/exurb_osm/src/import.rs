//! From the elements of a file to a draft of a city, in passes: 1 which ways and relations matter; 2 where
//! their nodes lie; 3 streets, buildings, areas and features.

use exurb_city::{Draft, ImportOptions};
use exurb_geom::{Frame, LonLat};

use crate::elements::{Bounds, Elements};
use crate::places::{self, Places};
use crate::{Error, streets, surfaces};

/// Attribution of every OpenStreetMap file.
pub const ATTRIBUTION: &str = "© OpenStreetMap contributors, ODbL 1.0";

/// What sorted elements hold, in the local frame, and one sentence for each thing to know.
pub fn draft(
    elements: Elements,
    file: &str,
    options: &ImportOptions,
) -> Result<(Draft, Vec<String>), Error> {
    let mut warnings: Vec<String> = elements
        .remarks
        .iter()
        .map(|remark| format!("the map may not be whole; its server says: {remark}"))
        .collect();
    if elements.nodes.is_empty()
        && let Some(remark) = elements.remarks.first()
    {
        let what = format!("its server says: {remark}");
        return Err(Error::Unmade { file: file.to_owned(), what });
    }
    let extent = elements.bounds.filter(usable);
    if elements.bounds.is_some() && extent.is_none() {
        warnings.push(
            "the bounds the file declares are no place on earth; they are ignored".to_owned(),
        );
    }
    let needed = needed(&elements);
    let frame = frame(&elements, extent, options, &needed)
        .map_err(|source| Error::Frame { file: file.to_owned(), source })?;
    let places = Places::find(&elements, &needed, &frame);

    let mut draft = Draft::new(frame);
    let corner = |lon, lat| LonLat { lon, lat };
    draft.extent =
        extent.and_then(|[w, s, e, n]| draft.frame.rectangle_inside(corner(w, s), corner(e, n)));
    let streets = streets::read(&elements, &places);
    draft.streets.ways = streets.ways;
    draft.broken_ends = streets.broken_ends;
    let node = |id: &i64| places::search(&elements.nodes, *id, 0).map(|i| &elements.nodes[i]);
    let continued = elements.continued.iter().filter_map(node);
    draft.broken_ends.extend(continued.filter_map(|node| places::project(&draft.frame, node)));
    surfaces::read(&elements, &places, &mut draft, &mut warnings);

    draft.metadata.name = name(file).into();
    if !elements.is_ours {
        draft.metadata.credit(&[ATTRIBUTION.to_owned()]);
    }
    draft.metadata.credit(&elements.attribution);
    if elements.misplaced > 0 {
        let n = elements.misplaced;
        warnings.push(format!("{n} nodes lie outside ±180 and ±90 degrees; ways are split there"));
    }
    Ok((draft, warnings))
}

/// The file's name without folders and endings.
fn name(file: &str) -> &str {
    let base = file.rsplit(['/', '\\']).next().unwrap_or(file);
    base.split_once('.').map_or(base, |(stem, _)| if stem.is_empty() { base } else { stem })
}

/// Pass 1: the ways whose nodes matter, by their own tags or as members of relations that do.
fn needed(elements: &Elements) -> Vec<bool> {
    let mut needed: Vec<bool> = elements
        .ways
        .iter()
        .map(|w| streets::class(&w.tags).is_some() || surfaces::matters(&w.tags))
        .collect();
    for relation in &elements.relations {
        for id in &relation.ways {
            if let Some(way) = elements.way_index(*id) {
                needed[way] = true;
            }
        }
    }
    needed
}

fn usable(b: &Bounds) -> bool {
    let corners = [(b[0], b[1]), (b[2], b[3])];
    b[0] < b[2]
        && b[1] < b[3]
        && corners.iter().all(|(lon, lat)| LonLat { lon: *lon, lat: *lat }.is_valid())
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// The frame at the middle of the part asked for, of the declared extent, of the streets, or of
/// whatever there is.
fn frame(
    elements: &Elements,
    extent: Option<Bounds>,
    options: &ImportOptions,
    needed: &[bool],
) -> Result<Frame, exurb_geom::projection::FrameError> {
    let asked = options.bbox.map(|[sw, ne]| [sw.lon, sw.lat, ne.lon, ne.lat]);
    let bounds = asked
        .filter(|asked| usable(asked) && extent.is_none_or(|extent| overlap(asked, &extent)))
        .or(extent)
        .or_else(|| street_bounds(elements))
        .or_else(|| {
            let ways = elements.ways.iter().zip(needed).filter(|(_, n)| **n).map(|(w, _)| w);
            node_bounds(elements, ways.flat_map(|w| elements.refs_of(w)).copied())
        })
        .or_else(|| node_bounds(elements, elements.nodes.iter().map(|n| n.id)))
        .unwrap_or_default();
    let middle = |a: f64, b: f64| (a + b) / 2.0;
    Frame::new(LonLat { lon: middle(bounds[0], bounds[2]), lat: middle(bounds[1], bounds[3]) })
}

fn street_bounds(elements: &Elements) -> Option<Bounds> {
    let ways = elements.ways.iter().filter(|w| streets::class(&w.tags).is_some());
    node_bounds(elements, ways.flat_map(|w| elements.refs_of(w)).copied())
}

fn node_bounds(elements: &Elements, ids: impl Iterator<Item = i64>) -> Option<Bounds> {
    let mut last = 0;
    let mut bounds: Option<[i32; 4]> = None;
    for id in ids {
        let Some(at) = places::search(&elements.nodes, id, last) else { continue };
        last = at;
        let n = elements.nodes[at];
        let [w, s, e, north] = bounds.unwrap_or([n.lon, n.lat, n.lon, n.lat]);
        bounds = Some([w.min(n.lon), s.min(n.lat), e.max(n.lon), north.max(n.lat)]);
    }
    bounds.map(|b| b.map(places::degrees))
}
