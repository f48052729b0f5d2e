//! Textures with mipmaps, from the values of one channel.

use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

/// A rectangle of values from 0 to 1, row by row.
pub(crate) struct Channel {
    /// Number of values in a row.
    pub width: usize,
    /// Values of all rows, from 0 to 1.
    pub values: Vec<f32>,
}

impl Channel {
    /// Builds a texture with this number of mipmaps, including the picture itself. `pixel` converts a value from 0 to 255 to a pixel.
    pub fn into_image(
        self,
        mipmaps: u32,
        format: TextureFormat,
        sampler: ImageSamplerDescriptor,
        pixel: fn(u8) -> [u8; 4],
    ) -> Image {
        let (width, height) = (self.width as u32, (self.values.len() / self.width) as u32);
        let mut image = Image::new_uninit(
            Extent3d { width, height, depth_or_array_layers: 1 },
            TextureDimension::D2,
            format,
            RenderAssetUsages::RENDER_WORLD,
        );
        let (mut size, mut bytes) = (self, Vec::new());
        for mipmap in 0..mipmaps {
            if mipmap > 0 {
                size = size.halved();
            }
            bytes.extend(size.values.iter().flat_map(|value| pixel((value * 255.0).round() as u8)));
        }
        image.data = Some(bytes);
        image.texture_descriptor.mip_level_count = mipmaps;
        image.sampler = ImageSampler::Descriptor(sampler);
        image
    }

    /// Returns the next mipmap: each value is the mean of four.
    fn halved(&self) -> Self {
        let width = self.width / 2;
        let height = self.values.len() / self.width / 2;
        let mean = |at: usize| {
            let corner = at / width * 2 * self.width + at % width * 2;
            let four = [0, 1, self.width, self.width + 1].map(|next| self.values[corner + next]);
            four.iter().sum::<f32>() / 4.0
        };
        Self { width, values: (0..width * height).map(mean).collect() }
    }
}
