//! Materials of surfaces, shared by all lanes whose surfaces look the same.

use bevy::prelude::*;

use super::cache::cached;
use super::surface_look::SurfaceLook;
use super::surface_texture::Grain;
use crate::studio::ui::theme::Theme;
use snakes_core::world::Surface;

/// A look and its material.
type LookMaterial = (SurfaceLook, Handle<StandardMaterial>);

/// Cached materials and textures, by their look.
#[derive(Resource, Debug, Default)]
pub(crate) struct SurfaceMaterials {
    materials: Vec<([u8; 11], LookMaterial)>,
    textures: Vec<(Grain, Handle<Image>)>,
}

/// Maximum number of cached materials and textures: more than lanes show at once. Dragging a slider creates many.
const MAX_CACHED: usize = 48;

impl SurfaceMaterials {
    /// Returns the material of a surface. Surfaces that look the same share it.
    pub fn of(
        &mut self,
        surface: &Surface,
        theme: Theme,
        materials: &mut Assets<StandardMaterial>,
        images: &mut Assets<Image>,
    ) -> Handle<StandardMaterial> {
        let look = SurfaceLook::of(surface);
        let (_, material) = cached(&mut self.materials, &look.key(), MAX_CACHED, || {
            let grain = Grain::from(&look);
            let texture =
                cached(&mut self.textures, &grain, MAX_CACHED, || images.add(grain.draw()));
            let material = materials.add(StandardMaterial {
                base_color: look.tint(theme.palette()),
                base_color_texture: Some(texture),
                // Zero would be a mirror, whose highlight is smaller than a pixel.
                perceptual_roughness: look.roughness.max(0.08),
                reflectance: look.gloss,
                ..default()
            });
            (look, material)
        });
        material
    }
}

/// Applies the theme's colours to the materials of surfaces.
pub(super) fn dress(
    theme: Res<Theme>,
    surfaces: Res<SurfaceMaterials>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (_, (look, handle)) in &surfaces.materials {
        if let Some(mut material) = materials.get_mut(handle) {
            material.base_color = look.tint(theme.palette());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_looks_share_a_material_and_the_cache_stays_small() {
        let (mut materials, mut images) = (Assets::default(), Assets::default());
        let mut surfaces = SurfaceMaterials::default();
        let mut of = |friction: f32| {
            let surface = Surface { friction, ..Surface::default() };
            surfaces.of(&surface, Theme::Light, &mut materials, &mut images)
        };
        assert_eq!(of(1.0), of(1.0));
        assert_ne!(of(1.0), of(0.1));
        let seen: Vec<_> = (0..400).map(|part| of(0.02 + part as f32 * 0.4)).collect();
        assert_ne!(seen[0], seen[399]);
        assert!(surfaces.materials.len() <= MAX_CACHED);
        assert!(surfaces.textures.len() <= MAX_CACHED);
    }
}
