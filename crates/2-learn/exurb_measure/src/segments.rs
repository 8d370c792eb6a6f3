//! Streets between junctions or dead ends: length, sinuosity, curvature.
//!
//! Streets that the window's border cuts are left out; the others count by the inverse of the chance
//! of lying wholly inside ([`crate::network::inclusion_weight`]). O(n) in points.

use exurb_geom::{polyline, trig};

use crate::network::Segment;
use crate::{Network, Sample};

/// A street shorter than this counts as this long, in metres.
const LEAST_LENGTH_M: f64 = 1.0;
/// Sinuosity needs ends farther apart than this, in metres, and ends here.
const LEAST_CHORD_M: f64 = 5.0;
const MOST_SINUOSITY: f64 = 1.0;
/// Curvature is turning over at least this many metres, and ends here, in degrees per 100 m.
const LEAST_CURVED_M: f64 = 20.0;
const MOST_CURVATURE: f64 = 360.0;

/// log10 of the length in metres.
pub fn length(network: &Network) -> Sample {
    of(network, |segment| Some(log_length(segment)))
}

/// log10 of the length in metres of streets that end in a dead end.
pub fn dead_end_length(network: &Network) -> Sample {
    let degree = |node| network.graph.degree(node);
    of(network, |s| (degree(s.from) == 1 || degree(s.to) == 1).then(|| log_length(s)))
}

/// Length over the distance of the ends, less 1, at most 1; where the ends are over 5 m apart.
pub fn sinuosity(network: &Network) -> Sample {
    of(network, |segment| {
        let line = segment.line();
        let chord_m = line[0].distance_m(line[line.len() - 1]);
        let value = (segment.length_m() / chord_m - 1.0).min(MOST_SINUOSITY);
        (chord_m > LEAST_CHORD_M).then_some(value)
    })
}

/// Sum of absolute turning in degrees per 100 m, at most 360.
pub fn curvature(network: &Network) -> Sample {
    of(network, |segment| {
        let turning = polyline::turning(&segment.line_m()).to_degrees();
        Some((turning / segment.length_m().max(LEAST_CURVED_M) * 100.0).min(MOST_CURVATURE))
    })
}

fn log_length(segment: &Segment) -> f64 {
    trig::log10(segment.length_m().max(LEAST_LENGTH_M))
}

fn of(network: &Network, value: impl Fn(&Segment) -> Option<f64>) -> Sample {
    Sample::weighted(
        network.segments().filter_map(|(_, s)| Some((value(s)?, network.weight_of(s.line())))),
    )
}
