//! Blocks of the network: their size and shape.
//!
//! Blocks are the bounded faces of all streets, bridges and tunnels included, that are no slivers:
//! at least 250 m² and 10 m of mean width. Faces that the window's border cuts never close; the
//! others count by the inverse of the chance of lying wholly inside. O(n log n).

use exurb_city::street_graph;
use exurb_geom::{Circle, OrientedBox, Polygon, trig};
use exurb_graph::{Faces, noding};

use crate::{Network, Sample};

/// Slivers have less area, in m², or less mean width, in metres.
const LEAST_AREA_M2: f64 = 250.0;
const LEAST_WIDTH_M: f64 = 10.0;

/// A block between centrelines and what is measured of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockShape {
    /// Its outline, with holes for separate streets inside.
    pub polygon: Polygon,
    /// Weight by the chance of lying inside the window.
    pub weight: f64,
    /// Area in m².
    pub area_m2: f64,
    /// Area over that of the smallest enclosing circle, Φ (Louf & Barthelemy 2014).
    pub phi: f64,
    /// 4π area / perimeter².
    pub compactness: f64,
    /// Shorter over longer side of the smallest enclosing rectangle.
    pub aspect: f64,
    /// Area over that of this rectangle.
    pub rectangularity: f64,
}

/// The blocks of a network, in order of their first street.
pub fn blocks(network: &Network) -> Vec<BlockShape> {
    let line = |edge: &crate::network::Segment| noding::Line {
        points: edge.line().to_vec(),
        level: 0,
        data: (),
    };
    let lines = network.graph.edges().map(|(_, e)| line(e)).collect();
    let noded = noding::node(lines, noding::Options::default());
    let planar =
        street_graph::from_lines(noded.into_iter().map(|l| (l.points, Default::default())));
    let faces = Faces::of(&planar, |_| true).list.into_iter().map(|face| face.polygon);
    faces.filter(is_block).filter_map(|polygon| shape(network, polygon)).collect()
}

fn is_block(face: &Polygon) -> bool {
    face.area_m2() >= LEAST_AREA_M2 && face.mean_width_m() >= LEAST_WIDTH_M
}

fn shape(network: &Network, polygon: Polygon) -> Option<BlockShape> {
    let (area_m2, perimeter_m) = (polygon.area_m2(), polygon.perimeter_m());
    let rectangle = OrientedBox::of(polygon.exterior())?;
    Some(BlockShape {
        weight: network.weight_of(polygon.exterior()),
        area_m2,
        phi: area_m2 / Circle::around(polygon.exterior())?.area_m2(),
        compactness: 4.0 * std::f64::consts::PI * area_m2 / (perimeter_m * perimeter_m),
        aspect: rectangle.aspect(),
        rectangularity: area_m2 / rectangle.area_m2(),
        polygon,
    })
}

/// One measure of all blocks, weighted.
pub fn sample(blocks: &[BlockShape], value: impl Fn(&BlockShape) -> f64) -> Sample {
    Sample::weighted(blocks.iter().map(|b| (value(b), b.weight)))
}

/// log10 of the area in m².
pub fn log_area(block: &BlockShape) -> f64 {
    trig::log10(block.area_m2)
}
