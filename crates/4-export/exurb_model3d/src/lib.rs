//! The city as meshes: GLB, OBJ and perspective pictures.
//!
//! 1. [`Scene::of`] turns every layer of a city into triangles: `ground`, `streets`, `buildings`
//!    (`shell` under `roof`), `plants`.
//! 2. [`to_glb`], [`to_obj`] write them; [`render_png`] looks at them.
//!
//! Lengths are metres; x points east, y up, z south; the origin lies on the ground at the middle of
//! the target. On a terrain everything lies draped over it (`drape`). Surfaces that meet share no plane with others, so that viewers do not flicker.
//! Whatever a map does not tell (roof shapes, heights, colours) is filled in by the element's
//! number, the same in every run.

mod buildings;
mod drape;
mod error;
mod facade;
mod glb;
mod ground;
mod mesh;
mod obj;
mod options;
mod palette;
mod plants;
mod render;
mod roof;
mod scene;
mod shell;
mod streets;
mod write;

pub use error::Error;
pub use glb::{to_glb, write_glb};
pub use mesh::Mesh;
pub use obj::{Obj, to_obj, write_obj};
pub use options::Options;
pub use render::{View, render_png};
pub use scene::{Layer, Material, Part, Scene};

#[cfg(test)]
mod terrain_tests;
#[cfg(test)]
mod tests;
