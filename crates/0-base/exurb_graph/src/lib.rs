//! Planar street graph: nodes, edges with polylines, darts, faces, edits, and their laws.
//!
//! A [`Graph`] knows positions on the millimetre grid and one payload per node and edge; what a
//! street is belongs to the city model. Ids stay valid while other elements come and go.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Graph`] | the structure: nodes, edges, darts and walks along them |
//! | [`edit`] | split, merge, snap, dissolve, collapse, clip |
//! | [`noding`] | linework → lines that meet at their ends only |
//! | [`faces`] | the faces between the edges, with dead ends and islands |
//! | [`laws`] | what every finished graph keeps |

mod clip;
pub mod edit;
pub mod faces;
mod graph;
mod ids;
pub mod laws;
pub mod noding;

pub use clip::Cut;
pub use faces::{Face, FaceId, Faces};
pub use graph::{Edge, Graph, Node};
pub use ids::{Dart, EdgeId, NodeId};
