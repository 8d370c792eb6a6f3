//! The patches that give the new city away, beside what the example shows instead.

use std::fmt::Write;

use exurb_geom::{Bounds, Vec2};

use exurb_likeness::patches::{PIXEL_M, Patches, SIDE, telling};
use exurb_measure::Network;

use crate::Column;

/// Patches shown of each city.
const SHOWN: usize = 4;
/// Two patches shown lie at least this far apart, in metres.
const APART_M: f64 = 400.0;

/// Two rows of patches; nothing where the windows are smaller than a patch.
pub fn tiles(column: &Column) -> Option<String> {
    let candidate = &column.likeness.candidate;
    let (new, held_out) =
        (candidate.patches.as_ref()?, column.reference.yardstick.held_out().patches()?);
    let row = |title: &str, network: &Network, patches: &Patches, scores: &[f64]| {
        let squares = most(network, patches, scores).into_iter();
        let drawn: String = squares.map(|square| drawing(network, square)).collect();
        format!("<div class=\"tiles\"><p>{title}</p>{drawn}</div>\n")
    };
    let of_new = telling(new, held_out);
    let of_held_out = telling(held_out, new);
    Some(
        row("The new city where it is least like the example", &candidate.network, new, &of_new)
            + &row(
                "The example's held-out part where it is least like the new city",
                &column.reference.held_out,
                held_out,
                &of_held_out,
            ),
    )
}

/// The squares of the patches with the highest scores, apart from each other.
fn most(network: &Network, patches: &Patches, scores: &[f64]) -> Vec<Bounds> {
    let mut order: Vec<usize> = (0..patches.places.len()).collect();
    order.sort_by(|i, j| scores[*j].total_cmp(&scores[*i]).then(i.cmp(j)));
    let side_m = SIDE as f64 * PIXEL_M;
    let mut out: Vec<Bounds> = Vec::new();
    for [x, y] in order.into_iter().map(|i| patches.places[i]) {
        let min = network.window.min + Vec2::new(f64::from(x), f64::from(y)) * PIXEL_M;
        if out.len() < SHOWN && out.iter().all(|o| o.min.distance(min) >= APART_M) {
            out.push(Bounds { min, max: min + side_m });
        }
    }
    out
}

fn drawing(network: &Network, square: Bounds) -> String {
    let side = square.size().x;
    let mut path = String::new();
    for (_, edge) in network.graph.edges() {
        let touches = Bounds::of(edge.line().iter().copied()).is_some_and(|b| b.intersects(square));
        for (i, p) in edge.line().iter().filter(|_| touches).enumerate() {
            let at = p.to_m() - square.min;
            let word = if i == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{word}{:.0} {:.0}", at.x, side - at.y);
        }
    }
    format!("<svg viewBox=\"0 0 {side:.0} {side:.0}\"><path d=\"{path}\"/></svg>")
}
