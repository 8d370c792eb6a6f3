//! Natural streets: streets that go on in each other ([`exurb_city::strokes`]).

use exurb_city::strokes;
use exurb_geom::trig;

use crate::{Network, Sample};

/// log10 of the length in metres, weighted by length. Streets that the window cuts count as far as
/// they reach. O(n log n).
pub fn length(network: &Network) -> Sample {
    let lengths = strokes(&network.graph).into_iter().map(|s| s.length_m);
    Sample::weighted(lengths.map(|m| (trig::log10(m.max(1.0)), m)))
}
