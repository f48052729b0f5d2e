//! A glTF file in progress: its JSON description, and its buffer.

use std::collections::BTreeMap;
use std::io;

use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Asset, Buffer, Index, Material, Mesh, Root, Value};

use crate::mesh::MeshBuilder;
use snakes_core::world::Vector;

/// A glTF file in progress.
pub(super) struct SceneParts {
    pub root: Root,
    buffer: Vec<u8>,
    bytes: Index<Buffer>,
}

/// A material: a colour in sRGB, and its roughness from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub name: &'static str,
    pub color: [f32; 3],
    pub roughness: f32,
}

impl SceneParts {
    /// Creates an empty file with this metadata.
    pub fn new(asset: Asset) -> Self {
        let mut root = Root { asset, ..Root::default() };
        let bytes = root.push(Buffer {
            byte_length: USize64(0),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        Self { root, buffer: Vec::new(), bytes }
    }

    /// Adds a material.
    pub fn material(&mut self, look: Look) -> Index<Material> {
        let [red, green, blue] = look.color.map(linear);
        self.root.push(Material {
            name: Some(look.name.to_owned()),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([red, green, blue, 1.0]),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(look.roughness),
                ..PbrMetallicRoughness::default()
            },
            ..Material::default()
        })
    }

    /// Adds a mesh that consists of shapes, each with a material.
    pub fn mesh(&mut self, name: &str, shapes: &[(MeshBuilder, Index<Material>)]) -> Index<Mesh> {
        let primitives = shapes.iter().map(|(shape, material)| {
            let positions = self.vectors(&shape.positions, true);
            let normals = self.vectors(&shape.normals, false);
            let attributes = BTreeMap::from([
                (Checked::Valid(Semantic::Positions), positions),
                (Checked::Valid(Semantic::Normals), normals),
            ]);
            Primitive {
                attributes,
                extensions: None,
                extras: None,
                indices: Some(self.indices(&shape.indices)),
                material: Some(*material),
                mode: Checked::Valid(Mode::Triangles),
                targets: None,
            }
        });
        let primitives = primitives.collect();
        self.root.push(Mesh {
            extensions: None,
            extras: None,
            name: Some(name.to_owned()),
            primitives,
            weights: None,
        })
    }

    fn vectors(&mut self, vectors: &[Vector], with_bounds: bool) -> Index<Accessor> {
        let numbers: Vec<f32> = vectors.iter().flat_map(|vector| vector.to_array()).collect();
        let accessor = self.floats(&numbers, Type::Vec3, Some(Target::ArrayBuffer));
        if with_bounds {
            let bound = |least: fn(f32, f32) -> f32, start: f32| -> Value {
                let of = |axis: usize| vectors.iter().map(|at| at[axis]).fold(start, least);
                [0, 1, 2].map(of).to_vec().into()
            };
            let accessor = &mut self.root.accessors[accessor.value()];
            accessor.min = Some(bound(f32::min, f32::MAX));
            accessor.max = Some(bound(f32::max, f32::MIN));
        }
        accessor
    }

    fn indices(&mut self, indices: &[u32]) -> Index<Accessor> {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        self.accessor(&bytes, ComponentType::U32, Type::Scalar, Some(Target::ElementArrayBuffer))
    }

    /// Adds the times of an animation's samples, in s.
    pub fn times(&mut self, times_s: &[f32]) -> Index<Accessor> {
        let accessor = self.floats(times_s, Type::Scalar, None);
        let ends = [times_s.first(), times_s.last()];
        let [min, max] = ends.map(|time_s| time_s.map(|time_s| Value::from(vec![*time_s])));
        let described = &mut self.root.accessors[accessor.value()];
        (described.min, described.max) = (min, max);
        accessor
    }

    /// Adds numbers as elements of a type, such as vectors.
    pub fn floats(
        &mut self,
        numbers: &[f32],
        element: Type,
        target: Option<Target>,
    ) -> Index<Accessor> {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(&bytes, ComponentType::F32, element, target)
    }

    fn accessor(
        &mut self,
        bytes: &[u8],
        component: ComponentType,
        element: Type,
        target: Option<Target>,
    ) -> Index<Accessor> {
        // All components have four bytes, so everything is aligned.
        let view = self.root.push(View {
            buffer: self.bytes,
            byte_length: bytes.len().into(),
            byte_offset: Some(self.buffer.len().into()),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        });
        self.buffer.extend(bytes);
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: (bytes.len() / (component.size() * element.multiplicity())).into(),
            component_type: Checked::Valid(GenericComponentType(component)),
            extensions: None,
            extras: None,
            type_: Checked::Valid(element),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    /// Returns the bytes of the file: a header, and two chunks with their lengths.
    pub fn into_glb(mut self) -> io::Result<Vec<u8>> {
        self.root.buffers[self.bytes.value()].byte_length = self.buffer.len().into();
        let mut json = self.root.to_vec().map_err(io::Error::from)?;
        // The length of a chunk must be a multiple of four bytes.
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = |bytes: usize| {
            let too_long = |_| io::Error::other("more than 4 GiB, the most that glTF allows");
            u32::try_from(bytes).map(u32::to_le_bytes).map_err(too_long)
        };
        let mut file = Vec::new();
        file.extend(b"glTF");
        file.extend(2_u32.to_le_bytes());
        file.extend(length(12 + 8 + json.len() + 8 + self.buffer.len())?);
        for (kind, chunk) in [(b"JSON", json), (b"BIN\0", self.buffer)] {
            file.extend(length(chunk.len())?);
            file.extend(kind);
            file.extend(chunk);
        }
        Ok(file)
    }
}

/// Converts one component of an sRGB colour, 0 to 1, to linear light.
fn linear(part: f32) -> f32 {
    if part <= 0.04045 { part / 12.92 } else { libm::powf((part + 0.055) / 1.055, 2.4) }
}
