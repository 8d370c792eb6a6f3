//! glTF 2.0, binary.
//!
//! A root node named `city` holds one node per layer; a layer is one mesh with one primitive per
//! material. Node `extras` are `{"layer": name, "ids": [...]}`. Primitive `extras` are
//! `{"ids": [...], "first_index": [...]}`: element `ids[k]` owns the indices from `first_index[k]`
//! up to `first_index[k + 1]` (the last one to the end). Number 0 is what belongs to no element.
//! `asset.extras` holds the georeference and the attributions.

use std::path::Path;

use exurb_city::City;
use glam::Vec3;
use gltf_json as json;
use json::validation::Checked::Valid;
use json::validation::{USize64, Validate};
use serde_json::{json, value::to_raw_value};

use crate::mesh::Mesh;
use crate::scene::{Layer, Material, Part, Scene};
use crate::{Error, Options, facade, write};

/// Writes [`to_glb`] to a file.
pub fn write_glb(city: &City, options: &Options, path: &Path) -> Result<(), Error> {
    write::whole(path, &to_glb(city, options)?)
}

/// The city as GLB. Equal cities give equal bytes, whatever the number of threads.
pub fn to_glb(city: &City, options: &Options) -> Result<Vec<u8>, Error> {
    let scene = Scene::of(city, options);
    let mut file = File::default();
    file.root.asset = asset(city, &scene)?;
    let mut children = Vec::new();
    // A layer that is written is let go: large cities need the room.
    for layer in scene.layers {
        children.push(file.layer(&layer)?);
    }
    let root = file.root.push(json::Node {
        children: (!children.is_empty()).then_some(children),
        name: Some("city".to_owned()),
        ..Default::default()
    });
    let scene = json::Scene {
        extensions: None,
        extras: None,
        name: Some(city.metadata.name.to_string()).filter(|n| !n.is_empty()),
        nodes: vec![root],
    };
    file.root.scene = Some(file.root.push(scene));
    file.pack()
}

fn asset(city: &City, scene: &Scene) -> Result<json::Asset, Error> {
    let origin = city.frame.origin();
    let place = city.frame.unproject(scene.center);
    let mut extras = json!({
        "georeference": {
            "frame_origin": { "lon": origin.lon, "lat": origin.lat },
            "frame_wkt": city.frame.to_wkt(),
            "model_origin": { "lon": place.lon, "lat": place.lat },
            "model_origin_in_frame_m": [scene.center.x, scene.center.y],
            "axes": "x east, y up, z south, metres",
        },
        "attribution": city.metadata.attribution,
    });
    if city.terrain.is_some() {
        extras["georeference"]["model_origin_height_m"] = json!(scene.datum_m);
    }
    Ok(json::Asset {
        copyright: Some(city.metadata.attribution.join("; ")).filter(|c| !c.is_empty()),
        extras: Some(to_raw_value(&extras)?),
        generator: Some(concat!("exurb ", env!("CARGO_PKG_VERSION")).to_owned()),
        ..Default::default()
    })
}

/// A file in the making.
#[derive(Default)]
struct File {
    root: json::Root,
    data: Vec<u8>,
    materials: Vec<(Material, json::Index<json::Material>)>,
}

impl File {
    fn layer(&mut self, layer: &Layer) -> Result<json::Index<json::Node>, Error> {
        let mut primitives = Vec::new();
        let mut ids: Vec<u32> = Vec::new();
        for part in &layer.parts {
            ids.extend(part.elements.iter().map(|(id, _)| *id).filter(|id| *id > 0));
            primitives.push(self.primitive(part)?);
        }
        ids.sort_unstable();
        ids.dedup();
        let mesh = self.root.push(json::Mesh {
            extensions: None,
            extras: None,
            name: Some(layer.name.to_owned()),
            primitives,
            weights: None,
        });
        Ok(self.root.push(json::Node {
            mesh: Some(mesh),
            name: Some(layer.name.to_owned()),
            extras: Some(to_raw_value(&json!({ "layer": layer.name, "ids": ids }))?),
            ..Default::default()
        }))
    }

    fn primitive(&mut self, part: &Part) -> Result<json::mesh::Primitive, Error> {
        use json::mesh::Semantic;
        let mesh = &part.mesh;
        let mut attributes = std::collections::BTreeMap::new();
        let positions = self.floats(mesh.positions.as_flattened(), 3, Some(bounds(mesh)));
        attributes.insert(Valid(Semantic::Positions), positions);
        let normals = self.floats(mesh.normals.as_flattened(), 3, None);
        attributes.insert(Valid(Semantic::Normals), normals);
        if !mesh.uvs.is_empty() {
            let uvs = self.floats(mesh.uvs.as_flattened(), 2, None);
            attributes.insert(Valid(Semantic::TexCoords(0)), uvs);
        }
        let colors = mesh.colors.as_flattened();
        let view = self.view(colors.iter().copied(), colors.len(), Some(4), Target::ArrayBuffer);
        let mut accessor = accessor(view, Type::Vec4, Component::U8, mesh.colors.len());
        accessor.normalized = true;
        attributes.insert(Valid(Semantic::Colors(0)), self.root.push(accessor));

        let bytes = mesh.indices.iter().flat_map(|i| i.to_le_bytes());
        let view = self.view(bytes, mesh.indices.len() * 4, None, Target::ElementArrayBuffer);
        let indices = self.root.push(accessor_of_indices(view, mesh.indices.len()));
        let ids: Vec<u32> = part.elements.iter().map(|e| e.0).collect();
        let first: Vec<u32> = part.elements.iter().map(|e| e.1).collect();
        Ok(json::mesh::Primitive {
            attributes,
            extensions: None,
            extras: Some(to_raw_value(&json!({ "ids": ids, "first_index": first }))?),
            indices: Some(indices),
            material: Some(self.material(part.material)?),
            mode: Valid(json::mesh::Mode::Triangles),
            targets: None,
        })
    }

    fn floats(
        &mut self,
        values: &[f32],
        width: usize,
        bounds: Option<([f32; 3], [f32; 3])>,
    ) -> json::Index<json::Accessor> {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes());
        let view = self.view(bytes, values.len() * 4, Some(width * 4), Target::ArrayBuffer);
        let kind = if width == 3 { Type::Vec3 } else { Type::Vec2 };
        let mut accessor = accessor(view, kind, Component::F32, values.len() / width);
        if let Some((min, max)) = bounds {
            accessor.min = Some(json::Value::from(min.to_vec()));
            accessor.max = Some(json::Value::from(max.to_vec()));
        }
        self.root.push(accessor)
    }

    fn view(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        length: usize,
        stride: Option<usize>,
        target: Target,
    ) -> json::Index<json::buffer::View> {
        let offset = self.data.len();
        self.data.reserve(length);
        self.data.extend(bytes);
        self.root.push(json::buffer::View {
            buffer: json::Index::new(0),
            byte_length: USize64::from(length),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: stride.map(json::buffer::Stride),
            name: None,
            target: match target {
                Target::None => None,
                Target::ArrayBuffer => Some(Valid(json::buffer::Target::ArrayBuffer)),
                Target::ElementArrayBuffer => Some(Valid(json::buffer::Target::ElementArrayBuffer)),
            },
            extensions: None,
            extras: None,
        })
    }

    fn material(&mut self, kind: Material) -> Result<json::Index<json::Material>, Error> {
        if let Some((_, known)) = self.materials.iter().find(|(k, _)| *k == kind) {
            return Ok(*known);
        }
        let texture = match facade::picture(kind) {
            Some(picture) => Some(self.texture(kind, &facade::png(&picture)?)),
            None => None,
        };
        let roughness = if kind == Material::Water { 0.2 } else { 0.9 };
        let index = self.root.push(json::Material {
            name: Some(kind.as_str().to_owned()),
            pbr_metallic_roughness: json::material::PbrMetallicRoughness {
                base_color_texture: texture.map(|index| json::texture::Info {
                    index,
                    tex_coord: 0,
                    extensions: None,
                    extras: None,
                }),
                metallic_factor: json::material::StrengthFactor(0.0),
                roughness_factor: json::material::StrengthFactor(roughness),
                ..Default::default()
            },
            ..Default::default()
        });
        self.materials.push((kind, index));
        Ok(index)
    }

    fn texture(&mut self, kind: Material, png: &[u8]) -> json::Index<json::Texture> {
        let view = self.view(png.iter().copied(), png.len(), None, Target::None);
        self.align();
        let source = self.root.push(json::Image {
            buffer_view: Some(view),
            mime_type: Some(json::image::MimeType("image/png".to_owned())),
            name: Some(kind.as_str().to_owned()),
            uri: None,
            extensions: None,
            extras: None,
        });
        let sampler = self.root.push(json::texture::Sampler {
            mag_filter: Some(Valid(json::texture::MagFilter::Linear)),
            min_filter: Some(Valid(json::texture::MinFilter::LinearMipmapLinear)),
            ..Default::default()
        });
        self.root.push(json::Texture {
            name: Some(kind.as_str().to_owned()),
            sampler: Some(sampler),
            source,
            extensions: None,
            extras: None,
        })
    }

    /// Numbers of four bytes begin at multiples of four.
    fn align(&mut self) {
        self.data.resize(self.data.len().next_multiple_of(4), 0);
    }

    /// Header, JSON padded with spaces, data padded with zeros.
    fn pack(mut self) -> Result<Vec<u8>, Error> {
        self.align();
        if !self.data.is_empty() {
            self.root.push(json::Buffer {
                byte_length: USize64::from(self.data.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: None,
            });
        }
        debug_assert!(is_sound(&self.root));
        let mut text = self.root.to_vec()?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let with_data = if self.data.is_empty() { 0 } else { 8 + self.data.len() };
        let total = 12 + 8 + text.len() + with_data;
        let word = |v: usize| u32::try_from(v).map(u32::to_le_bytes);
        let total_word = word(total).map_err(|_| Error::TooLarge(total as u64))?;
        let mut out = Vec::with_capacity(total);
        out.extend(b"glTF");
        out.extend(2u32.to_le_bytes());
        out.extend(total_word);
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.data)] {
            if !chunk.is_empty() {
                out.extend(word(chunk.len()).map_err(|_| Error::TooLarge(total as u64))?);
                out.extend(kind);
                out.extend(chunk);
            }
        }
        Ok(out)
    }
}

use json::accessor::{ComponentType as Component, Type};

/// What a buffer view feeds.
enum Target {
    None,
    ArrayBuffer,
    ElementArrayBuffer,
}

fn accessor(
    view: json::Index<json::buffer::View>,
    kind: Type,
    component: Component,
    count: usize,
) -> json::Accessor {
    json::Accessor {
        buffer_view: Some(view),
        byte_offset: None,
        count: USize64::from(count),
        component_type: Valid(json::accessor::GenericComponentType(component)),
        type_: Valid(kind),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: None,
    }
}

fn accessor_of_indices(view: json::Index<json::buffer::View>, count: usize) -> json::Accessor {
    accessor(view, Type::Scalar, Component::U32, count)
}

fn bounds(mesh: &Mesh) -> ([f32; 3], [f32; 3]) {
    let points = || mesh.positions.iter().map(|p| Vec3::from(*p));
    let low = points().fold(Vec3::MAX, Vec3::min);
    let high = points().fold(Vec3::MIN, Vec3::max);
    (low.to_array(), high.to_array())
}

fn is_sound(root: &json::Root) -> bool {
    let mut sound = true;
    root.validate(root, json::Path::new, &mut |_, _| sound = false);
    sound
}
