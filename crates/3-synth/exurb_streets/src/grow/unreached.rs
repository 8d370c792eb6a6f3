//! Streets of a piece that growth did not reach: on its ground, but tied to it by streets elsewhere.
//!
//! They are laid from where they are; those that leave the piece's ground tie them to the rest, or
//! they are given up in the end.

use exurb_geom::GridPoint;
use exurb_operation::Run;

use super::error::Error;
use super::growth::Growth;
use super::layer::NodeKind;
use super::network::{Coherent, Vertex};
use super::placing;

/// A junction with a street nearer than this counts as reached, in metres.
const NEAR_M: f64 = 25.0;

/// Lays what no piece on the growth's ground has reached.
pub fn lay(growth: &mut Growth, run: &Run) -> Result<(), Error> {
    for piece in growth.claims.pieces_here() {
        for own in unreached(growth, &piece) {
            let node = &growth.style(piece.example).layer.nodes[own];
            let (place, link) = (piece.place(node.at), Some(node.example));
            if growth.net.edge_near(place, NEAR_M).is_some() {
                continue;
            }
            let vertex = Vertex { link, piece: Some(piece), ..Vertex::default() };
            let node = growth.net.add_node(GridPoint::round(place), vertex);
            if placing::continuation(growth, node, piece, own) {
                growth.run(run)?;
            }
            growth.net.remove_lonely(node);
        }
    }
    Ok(())
}

/// Junctions of the example on the piece's ground with no street near, in the example's order.
fn unreached(growth: &Growth, piece: &Coherent) -> Vec<usize> {
    let style = growth.style(piece.example);
    let mut found = Vec::new();
    style.places.visit(piece.source, growth.claims.reach_m(piece), |own| {
        let node = &style.layer.nodes[own as usize];
        let place = piece.place(node.at);
        let counts = node.kind == NodeKind::Junction
            && node.ends.len() > 2
            && growth.claims.owner(place) == Some(piece.id)
            && growth.inside.contains(GridPoint::round(place))
            && growth.net.edge_near(place, NEAR_M).is_none();
        if counts {
            found.push(own as usize);
        }
    });
    found.sort_unstable();
    found
}
