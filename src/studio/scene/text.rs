//! Text in the scene: on the ground, on risers, on flags.
//!
//! All characters share one atlas texture; the mesh of a text has one rectangle per character. The atlas is drawn once
//! from the panels' font, slightly bolder. Its mipmaps keep distant numbers from shimmering.

mod atlas;

use bevy::prelude::*;

use super::meshes::to_mesh;
use super::props::themed;
use snakes_lab::mesh::MeshBuilder;

use atlas::{Atlas, BASELINE, CELL, MARGIN};

/// The atlas of characters, and materials for texts.
#[derive(Resource, Debug)]
pub(crate) struct TextMeshes {
    atlas: Atlas,
    /// Material of text on sunlit surfaces: it darkens or lightens the surface below.
    pub paint: Handle<StandardMaterial>,
    /// Material of text on the flag's cloth.
    pub on_flag: Handle<StandardMaterial>,
}

impl FromWorld for TextMeshes {
    fn from_world(world: &mut World) -> Self {
        let (atlas, picture) = Atlas::draw();
        let picture = world.resource_mut::<Assets<Image>>().add(picture);
        let letters = StandardMaterial {
            base_color_texture: Some(picture),
            unlit: true,
            alpha_mode: AlphaMode::Blend,
            ..default()
        };
        Self {
            atlas,
            paint: themed(world, letters.clone(), |palette| palette.paint),
            on_flag: themed(world, letters, |palette| palette.flag_text),
        }
    }
}

/// Builds one mesh from several texts.
pub(crate) struct TextMeshBuilder<'a> {
    atlas: &'a Atlas,
    solid: MeshBuilder,
    uvs: Vec<[f32; 2]>,
    colors: Vec<[f32; 4]>,
    /// Opacity of the texts that are added next, as a fraction of the usual opacity.
    pub opacity: f32,
}

/// Position and orientation of a text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextPlacement {
    /// Centre of the text in the scene, in metres.
    pub middle: Vec3,
    /// Direction in which the text is written.
    pub right: Dir3,
    /// Up direction of the characters.
    pub up: Dir3,
}

impl TextMeshes {
    /// Starts a mesh without text.
    pub fn begin(&self) -> TextMeshBuilder<'_> {
        let (solid, uvs, colors) = default();
        TextMeshBuilder { atlas: &self.atlas, solid, uvs, colors, opacity: 1.0 }
    }

    /// Returns the width of a text, in metres, with digits of this height, in metres.
    pub fn width_m(&self, text: &str, digit_height_m: f32) -> f32 {
        let pixels: f32 = text.chars().map(|letter| self.atlas.advance(letter)).sum();
        pixels * digit_height_m / self.atlas.digit_height
    }
}

impl TextMeshBuilder<'_> {
    /// Adds a text with digits of this height, in metres.
    pub fn text(&mut self, text: &str, digit_height_m: f32, place: TextPlacement) {
        let metres = digit_height_m / self.atlas.digit_height;
        let width: f32 = text.chars().map(|letter| self.atlas.advance(letter)).sum();
        let mut pen = -width / 2.0;
        for letter in text.chars() {
            let corner = Vec2::new(pen - MARGIN, BASELINE - self.atlas.digit_height / 2.0 - CELL);
            let cell = Rect::from_corners(corner * metres, (corner + CELL) * metres);
            self.rectangle(cell, self.atlas.cell(letter), place);
            pen += self.atlas.advance(letter);
        }
    }

    /// Adds a bar centred on a place, with a width and a height in metres.
    pub fn bar(&mut self, width_m: f32, height_m: f32, place: TextPlacement) {
        let bar = Rect::from_center_size(Vec2::ZERO, Vec2::new(width_m, height_m));
        self.rectangle(bar, self.atlas.solid(), place);
    }

    /// Adds a rectangle in the plane of a place. `part` is its part of the atlas, whose y runs downwards.
    fn rectangle(&mut self, on_plane: Rect, part: Rect, place: TextPlacement) {
        let TextPlacement { middle, right, up } = place;
        let (at, half) = (on_plane.center(), on_plane.half_size());
        self.solid.sheet(middle + right * at.x + up * at.y, right * half.x, up * half.y);
        let Rect { min, max } = part;
        self.uvs.extend([[min.x, max.y], [max.x, max.y], [min.x, min.y], [max.x, min.y]]);
        self.colors.extend([[1.0, 1.0, 1.0, self.opacity]; 4]);
    }

    /// Returns the finished mesh.
    pub fn into_mesh(self) -> Mesh {
        to_mesh(self.solid)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs)
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, self.colors)
    }
}
