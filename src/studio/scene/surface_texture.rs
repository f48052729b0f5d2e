//! Procedural textures of surfaces: speckle, cracks in ice, shine of glue, ripples of mud, the weave of a mat.
//!
//! A texture only darkens the colour of its material, as a factor in linear light. Its shapes are several pixels wide
//! and it has mipmaps, so that nothing shimmers in the distance. The same look has the same texture on every machine.

use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;

use super::mipmaps::Channel;
use super::surface_look::SurfaceLook;

/// Side of the square that a texture covers, in metres.
pub(crate) const TILE_M: f32 = 4.0;
/// Side of a texture, in pixels: a power of two.
pub(super) const SIDE: usize = 256;
/// Number of threads of the weave along a side of the texture.
const THREADS: usize = 16;
/// Number of steps of each share in [`Grain`].
const LEVELS: f32 = 8.0;

/// Function that returns the brightness of a kind of surface at a pixel, from 0 to 1.
type Drawn = fn(usize, usize) -> f32;

/// Shares of a look that affect its texture, in coarse steps, so that few textures are needed: that of speckle, and those of the
/// layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grain([u8; 6]);

impl From<&SurfaceLook> for Grain {
    fn from(look: &SurfaceLook) -> Self {
        let [ice, glue, rubber, woven, mud] = look.layers;
        Self(
            [look.speckle, ice, glue, rubber, woven, mud]
                .map(|share| (share * LEVELS).round() as u8),
        )
    }
}

impl Grain {
    /// Returns the brightness of the texture at a pixel, from 0 to 1.
    fn at(self, x: usize, y: usize) -> f32 {
        let share = |step: u8| f32::from(step) / LEVELS;
        let [speckle, layers @ ..] = self.0;
        // Stone: dark and pale grains of some centimetres on larger clouds.
        let clouds = noise(x, y, 8, 1) * 0.6 + noise(x, y, 16, 2) * 0.4;
        let dark = rise(noise(x, y, 64, 3), 0.66, 0.80);
        let pale = rise(noise(x, y, 64, 4), 0.70, 0.82);
        let stone = 0.86 + 0.08 * (clouds - 0.5) - 0.17 * dark + 0.10 * pale;
        let mut value = 0.90.lerp(stone, share(speckle));
        let drawn: [Drawn; 5] = [ice, glue, rubber, woven, mud];
        for (step, of) in layers.into_iter().zip(drawn) {
            if step > 0 {
                value = value.lerp(of(x, y), share(step));
            }
        }
        value.clamp(0.0, 1.0)
    }

    /// Draws the texture with all its mipmaps.
    pub fn draw(self) -> Image {
        tile(|x, y| self.at(x, y))
    }
}

/// Draws the texture of the meadow around the lanes: clouds of many sizes.
pub(super) fn meadow() -> Image {
    tile(|x, y| {
        let patches = noise(x, y, 5, 81) * 0.5 + noise(x, y, 13, 82) * 0.5;
        let blades = noise(x, y, 64, 83) * 0.5 + noise(x, y, 100, 84) * 0.5;
        (0.74 + 0.18 * patches + 0.16 * blades).min(1.0)
    })
}

/// Draws a texture that repeats, with all its mipmaps, from the brightness of each pixel.
fn tile(at: impl Fn(usize, usize) -> f32) -> Image {
    let values = (0..SIDE * SIDE).map(|pixel| at(pixel % SIDE, pixel / SIDE));
    let brightness = Channel { width: SIDE, values: values.collect() };
    let sampler = ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        anisotropy_clamp: 4,
        ..default()
    };
    let pixel = |gray| [gray, gray, gray, u8::MAX];
    brightness.into_image(SIDE.ilog2() + 1, TextureFormat::Rgba8Unorm, sampler, pixel)
}

/// Draws clouded ice with straight, pale cracks of limited length.
fn ice(x: usize, y: usize) -> f32 {
    let clouds = noise(x, y, 4, 11) * 0.7 + noise(x, y, 8, 12) * 0.3;
    let is_cracked = rise(noise(x, y, 5, 13), 0.45, 0.65);
    let cracks = 1.0 - rise(between_cells(x, y, 4, 14), 0.0, 0.05);
    let sheen = 0.66 + 0.16 * clouds;
    sheen.lerp(1.0, cracks * is_cracked)
}

/// Draws thick, smooth waves with highlights.
fn glue(x: usize, y: usize) -> f32 {
    let height = |x, y| noise(x, y, 7, 21) * 0.5 + noise(x, y, 4, 22) * 0.5;
    0.80 + 2.2 * slope(x, y, height)
}

/// Draws bright flecks in a dark mat.
fn rubber(x: usize, y: usize) -> f32 {
    let flecks = rise(noise(x, y, 64, 31), 0.70, 0.78).max(rise(noise(x, y, 40, 32), 0.74, 0.80));
    0.32 + 0.06 * noise(x, y, 16, 33) + 0.62 * flecks
}

/// Draws threads that cross over and under each other.
fn woven(x: usize, y: usize) -> f32 {
    let across = |at: usize| {
        let place = at as f32 * THREADS as f32 / SIDE as f32;
        (place as usize, place - libm::floorf(place))
    };
    let ((column, in_column), (row, in_row)) = (across(x), across(y));
    // The upper thread is bright along its middle; the gap between two threads is dark.
    let round = |share: f32| libm::sinf(share * std::f32::consts::PI);
    let (along, beside) =
        if (column + row) % 2 == 0 { (in_row, in_column) } else { (in_column, in_row) };
    0.30 + 0.70 * rise(round(beside), 0.1, 0.75) * (0.55 + 0.45 * round(along))
}

/// Draws heavy lumps and puddles.
fn mud(x: usize, y: usize) -> f32 {
    let height = |x, y| noise(x, y, 24, 41) * 0.35 + noise(x, y, 9, 42) * 0.65;
    let puddle = rise(height(x, y), 0.42, 0.30);
    let lumps = 0.62 + 2.2 * slope(x, y, height) + 0.3 * (height(x, y) - 0.5);
    lumps.lerp(0.50, puddle)
}

/// Returns how far a relief rises towards the corner of the texture from which it is lit.
fn slope(x: usize, y: usize, height: impl Fn(usize, usize) -> f32) -> f32 {
    /// Distance over which the heights are compared, in pixels.
    const OVER: usize = 3;
    let back = |at: usize| (at + SIDE - OVER) % SIDE;
    let on = |at: usize| (at + OVER) % SIDE;
    height(on(x), on(y)) - height(back(x), back(y))
}

/// Interpolates smoothly from 0 at `from` to 1 at `to`.
pub(super) fn rise(value: f32, from: f32, to: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Returns smooth noise from 0 to 1 with `cells` cells per side. The noise continues across the edges of the texture.
pub(super) fn noise(x: usize, y: usize, cells: usize, seed: u32) -> f32 {
    let across = |at: usize| {
        let place = at as f32 * cells as f32 / SIDE as f32;
        (place as usize, rise(place - libm::floorf(place), 0.0, 1.0))
    };
    let ((column, right), (row, up)) = (across(x), across(y));
    let corner = |right: usize, up: usize| {
        random(((column + right) % cells) as u32, ((row + up) % cells) as u32, seed)
    };
    let low = corner(0, 0).lerp(corner(1, 0), right);
    let high = corner(0, 1).lerp(corner(1, 1), right);
    low.lerp(high, up)
}

/// Returns the distance from the border between irregular cells, `cells` per side, as a share of a cell.
fn between_cells(x: usize, y: usize, cells: usize, seed: u32) -> f32 {
    let at = Vec2::new(x as f32, y as f32) * cells as f32 / SIDE as f32;
    let own = at.floor();
    let (mut nearest, mut second) = (f32::MAX, f32::MAX);
    for (right, up) in (-2..=2).flat_map(|right| (-2..=2).map(move |up| (right, up))) {
        let cell = own + Vec2::new(right as f32, up as f32);
        let wrapped = cell.rem_euclid(Vec2::splat(cells as f32)).as_uvec2();
        let point = |salt: u32| random(wrapped.x, wrapped.y, seed + salt);
        let distance = at.distance(cell + Vec2::new(point(0), point(1)));
        if distance < nearest {
            (nearest, second) = (distance, nearest);
        } else {
            second = second.min(distance);
        }
    }
    second - nearest
}

/// Returns a pseudorandom number from 0 to 1 that depends only on its arguments.
pub(super) fn random(x: u32, y: u32, seed: u32) -> f32 {
    let mut mixed =
        x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2C1B_3C6D);
    mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0x297A_2D39);
    (mixed ^ (mixed >> 15)) as f32 / u32::MAX as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::world::Surface;

    fn grain(change: fn(&mut Surface)) -> Grain {
        let mut surface = Surface::default();
        change(&mut surface);
        Grain::from(&SurfaceLook::of(&surface))
    }

    fn grains() -> [Grain; 5] {
        [
            grain(|_| {}),
            grain(|surface| surface.friction = 0.0),
            grain(|surface| surface.friction = 5.0),
            grain(|surface| (surface.soft_cfm_m_s_per_n, surface.soft_erp) = (0.5, 0.95)),
            grain(|surface| {
                (surface.soft_cfm_m_s_per_n, surface.soft_erp, surface.dampen_per_s) =
                    (0.05, 0.05, 2.0);
            }),
        ]
    }

    #[test]
    fn a_texture_has_all_mipmaps_and_is_the_same_every_time() {
        let [stone, ..] = grains();
        let image = stone.draw();
        let pixels: usize = (0..=8).map(|level| (SIDE >> level) * (SIDE >> level)).sum();
        assert_eq!(image.texture_descriptor.mip_level_count, 9);
        assert_eq!(image.data.as_ref().map(Vec::len), Some(pixels * 4));
        assert_eq!(image.data, stone.draw().data);
    }

    #[test]
    fn textures_continue_over_their_edges() {
        for grain in grains() {
            let difference = |a: (usize, usize), b: (usize, usize)| {
                (grain.at(a.0, a.1) - grain.at(b.0, b.1)).abs()
            };
            // Mean difference between two columns of pixels.
            let between = |left: usize, right: usize| {
                let rows = (0..SIDE).step_by(4).map(|y| difference((left, y), (right, y)));
                rows.sum::<f32>() * 4.0 / SIDE as f32
            };
            let seam = between(SIDE - 1, 0);
            let most = (1..SIDE).map(|x| between(x - 1, x)).fold(0.0, f32::max);
            assert!(seam <= most * 1.05, "{grain:?}: {seam} at the seam, {most} inside");
        }
    }

    #[test]
    fn each_kind_of_surface_has_its_own_grain() {
        for (index, one) in grains().into_iter().enumerate() {
            for other in &grains()[..index] {
                let pixels = (0..SIDE * SIDE).step_by(7).map(|at| (at % SIDE, at / SIDE));
                let apart: Vec<f32> =
                    pixels.map(|(x, y)| (one.at(x, y) - other.at(x, y)).abs()).collect();
                let mean = apart.iter().sum::<f32>() / apart.len() as f32;
                assert!(mean > 0.04, "{one:?} and {other:?} are {mean} apart");
            }
        }
    }
}
