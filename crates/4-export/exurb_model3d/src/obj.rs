//! Wavefront OBJ and MTL: a group per element, metres, x east, y up, z south (Blender's importer
//! turns that by itself: forward −Z, up Y).

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use exurb_city::City;

use crate::palette::{Linear, to_srgb};
use crate::scene::{Layer, Material, Part, Scene};
use crate::{Error, Options, facade, write};

/// A model in files.
#[derive(Clone, Debug, PartialEq)]
pub struct Obj {
    /// The `.obj`.
    pub obj: String,
    /// The `.mtl` it names.
    pub mtl: String,
    /// Names and PNG bytes of the textures that the `.mtl` names.
    pub textures: Vec<(String, Vec<u8>)>,
}

/// Writes `path` (an `.obj`), and beside it the `.mtl` and the textures of the same stem.
pub fn write_obj(city: &City, options: &Options, path: &Path) -> Result<(), Error> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace(' ', "_");
    let files = to_obj(city, options, &stem)?;
    for (name, png) in &files.textures {
        write::whole(&path.with_file_name(name), png)?;
    }
    write::whole(&path.with_file_name(format!("{stem}.mtl")), files.mtl.as_bytes())?;
    write::whole(path, files.obj.as_bytes())
}

/// Writing to a string cannot fail.
macro_rules! put {
    ($out:expr, $($arg:tt)*) => { writeln!($out, $($arg)*).expect("strings take everything") };
}

/// The city as OBJ whose other files are named after `stem`.
pub fn to_obj(city: &City, options: &Options, stem: &str) -> Result<Obj, Error> {
    let scene = Scene::of(city, options);
    let mut writer = Writer::default();
    let obj = &mut writer.obj;
    put!(obj, "# exurb {}", env!("CARGO_PKG_VERSION"));
    put!(obj, "# metres; x east, y up, z south");
    for attribution in &city.metadata.attribution {
        put!(obj, "# {}", attribution.replace(['\n', '\r'], " "));
    }
    let place = city.frame.unproject(scene.center);
    put!(obj, "# origin: longitude {:.7}, latitude {:.7}", place.lon, place.lat);
    put!(obj, "mtllib {stem}.mtl");
    for layer in &scene.layers {
        writer.layer(layer);
    }
    let mut textures = Vec::new();
    for kind in Material::ALL {
        if let Some(picture) = facade::picture(kind)
            && writer.materials.keys().any(|(k, _)| *k == kind)
        {
            textures.push((texture_name(stem, kind), facade::png(&picture)?));
        }
    }
    let mtl = writer.mtl(stem);
    Ok(Obj { obj: writer.obj, mtl, textures })
}

fn texture_name(stem: &str, kind: Material) -> String {
    format!("{stem}_{}.png", kind.as_str())
}

#[derive(Default)]
struct Writer {
    obj: String,
    /// Names of materials by look and colour.
    materials: BTreeMap<(Material, Linear), String>,
    /// Numbers of OBJ count through the file, from 1.
    vertices: usize,
    uvs: usize,
    normals: usize,
}

impl Writer {
    fn layer(&mut self, layer: &Layer) {
        put!(self.obj, "o {}", layer.name);
        for part in &layer.parts {
            self.part(layer.name, part);
        }
    }

    fn part(&mut self, layer: &str, part: &Part) {
        let mesh = &part.mesh;
        for [x, y, z] in &mesh.positions {
            put!(self.obj, "v {x:.3} {y:.3} {z:.3}");
        }
        for [u, v] in &mesh.uvs {
            // OBJ counts v from below.
            put!(self.obj, "vt {u:.4} {:.4}", 1.0 - v);
        }
        for [x, y, z] in &mesh.normals {
            put!(self.obj, "vn {x:.4} {y:.4} {z:.4}");
        }
        let mut material = None;
        let mut elements = part.elements.iter().peekable();
        for (at, t) in mesh.indices.chunks_exact(3).enumerate() {
            while let Some((id, _)) = elements.next_if(|(_, first)| *first as usize <= at * 3) {
                put!(self.obj, "g {layer}_{id}");
            }
            let key = (part.material, mesh.colors[t[0] as usize]);
            if material != Some(key) {
                material = Some(key);
                let [r, g, b, _] = key.1;
                let name = || format!("{}_{r:02x}{g:02x}{b:02x}", key.0.as_str());
                put!(self.obj, "usemtl {}", self.materials.entry(key).or_insert_with(name));
            }
            self.face(t, !mesh.uvs.is_empty());
        }
        self.vertices += mesh.positions.len();
        self.uvs += mesh.uvs.len();
        self.normals += mesh.normals.len();
    }

    fn face(&mut self, triangle: &[u32], textured: bool) {
        self.obj.push('f');
        for i in triangle.iter().map(|i| *i as usize + 1) {
            let (v, n) = (self.vertices + i, self.normals + i);
            if textured {
                write!(self.obj, " {v}/{}/{n}", self.uvs + i).expect("strings take everything");
            } else {
                write!(self.obj, " {v}//{n}").expect("strings take everything");
            }
        }
        self.obj.push('\n');
    }

    fn mtl(&self, stem: &str) -> String {
        let mut out = format!("# exurb {}\n", env!("CARGO_PKG_VERSION"));
        for ((kind, color), name) in &self.materials {
            let [r, g, b] = [0, 1, 2].map(|k| to_srgb(f64::from(color[k]) / 255.0));
            put!(out, "newmtl {name}\nKd {r:.4} {g:.4} {b:.4}\nKs 0 0 0\nillum 1");
            if kind.is_textured() {
                put!(out, "map_Kd {}", texture_name(stem, *kind));
            }
        }
        out
    }
}
