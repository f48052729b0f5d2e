//! Texture atlas with all characters.

use ab_glyph::{Font, FontRef, GlyphId, ScaleFont};
use bevy::image::{ImageFilterMode, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;

use crate::studio::scene::mipmaps::Channel;

/// Side length of a character's cell, in pixels.
pub const CELL: f32 = CELL_PIXELS as f32;
const CELL_PIXELS: usize = 64;
/// Left margin of a character in its cell, in pixels.
pub const MARGIN: f32 = 8.0;
/// Baseline within a cell, in pixels from the top.
pub const BASELINE: f32 = 47.0;
/// Cells per row of the atlas, and number of rows: printable ASCII, and a fully covered cell in the last place.
const COLUMNS: usize = 16;
const ROWS: usize = 6;
const FIRST: usize = ' ' as usize;
const LAST: usize = FIRST + COLUMNS * ROWS - 1;
/// Font height, in pixels. Every character fits into its cell.
const FONT_PIXELS: f32 = 52.0;
/// Width added to all sides of a character's strokes, in pixels. The panels' font is too thin for numbers on the ground.
const BOLDER: f32 = 1.7;
/// Number of mipmaps. In the last one a cell has four pixels; further ones would blend adjacent characters.
const SIZES: u32 = 5;

/// Character widths and digit height in the atlas.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// Advance width of each character, in pixels.
    advances: Vec<f32>,
    /// Height of a digit, in pixels.
    pub digit_height: f32,
}

impl Atlas {
    /// Renders the atlas, and measures its characters.
    pub fn draw() -> (Self, Image) {
        let (width, height) = (COLUMNS * CELL_PIXELS, ROWS * CELL_PIXELS);
        let mut all = Channel { width, values: vec![0.0; width * height] };
        let mut atlas = Self { advances: vec![0.0; COLUMNS * ROWS], digit_height: FONT_PIXELS };
        // The font is part of the program, and a test checks it.
        if let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) {
            let font = font.as_scaled(FONT_PIXELS);
            let digit = font.outline_glyph(font.glyph_id('0').with_scale(FONT_PIXELS));
            atlas.digit_height = digit.map_or(FONT_PIXELS, |digit| digit.px_bounds().height());
            for (index, letter) in (FIRST..LAST).enumerate() {
                let letter = font.glyph_id(char::from(letter as u8));
                atlas.advances[index] = font.h_advance(letter) + BOLDER;
                put(&mut all, index, &letter_alone(font.font(), letter));
            }
        }
        put(&mut all, LAST - FIRST, &[1.0; CELL_PIXELS * CELL_PIXELS]);
        let sampler = ImageSamplerDescriptor {
            mipmap_filter: ImageFilterMode::Linear,
            // Text on the ground is seen at a flat angle, which needs anisotropic filtering.
            anisotropy_clamp: 4,
            ..ImageSamplerDescriptor::linear()
        };
        // White pixels, whose alpha is their coverage.
        let pixel = |opacity| [255, 255, 255, opacity];
        (atlas, all.into_image(SIZES, TextureFormat::Rgba8UnormSrgb, sampler, pixel))
    }

    /// Returns the advance width of a character, in pixels.
    pub fn advance(&self, letter: char) -> f32 {
        self.advances[index_of(letter)]
    }

    /// Returns the rectangle of a character's cell, in texture coordinates.
    pub fn cell(&self, letter: char) -> Rect {
        cell(index_of(letter))
    }

    /// Returns an empty rectangle in the middle of the fully covered cell, in texture coordinates.
    pub fn solid(&self) -> Rect {
        Rect::from_center_size(cell(LAST - FIRST).center(), Vec2::ZERO)
    }
}

/// Returns the index of a character's cell. An unknown character gets the blank cell.
fn index_of(letter: char) -> usize {
    let code = letter as usize;
    if (FIRST..LAST).contains(&code) { code - FIRST } else { 0 }
}

fn cell(index: usize) -> Rect {
    let cells = Vec2::new(COLUMNS as f32, ROWS as f32);
    let corner = Vec2::new((index % COLUMNS) as f32, (index / COLUMNS) as f32);
    Rect::from_corners(corner / cells, (corner + Vec2::ONE) / cells)
}

/// Renders a character into a single cell. Returns the coverage of the pixels, row by row.
fn letter_alone(font: &FontRef<'_>, letter: GlyphId) -> Vec<f32> {
    let mut thin = vec![0.0; CELL_PIXELS * CELL_PIXELS];
    let at = ab_glyph::point(MARGIN, BASELINE);
    if let Some(outline) = font.outline_glyph(letter.with_scale_and_position(FONT_PIXELS, at)) {
        let corner = outline.px_bounds().min;
        outline.draw(|x, y, covered| {
            let (x, y) = (x as i32 + corner.x as i32, y as i32 + corner.y as i32);
            if let Some(pixel) = pixel_at(x, y) {
                thin[pixel] = covered.clamp(0.0, 1.0);
            }
        });
    }
    let reach = BOLDER as i32 + 1;
    let pixels = (0..thin.len()).map(|pixel| {
        let (x, y) = ((pixel % CELL_PIXELS) as i32, (pixel / CELL_PIXELS) as i32);
        let mut most: f32 = 0.0;
        for aside in -reach..=reach {
            for above in -reach..=reach {
                let distance = ((aside * aside + above * above) as f32).sqrt();
                let weight = (BOLDER + 0.5 - distance).clamp(0.0, 1.0);
                let near = pixel_at(x + aside, y + above).map_or(0.0, |near| thin[near]);
                most = most.max(near * weight);
            }
        }
        most
    });
    pixels.collect()
}

fn pixel_at(x: i32, y: i32) -> Option<usize> {
    let side = 0..CELL_PIXELS as i32;
    (side.contains(&x) && side.contains(&y)).then(|| y as usize * CELL_PIXELS + x as usize)
}

/// Copies the coverage of a character into its cell of the atlas.
fn put(all: &mut Channel, index: usize, letter: &[f32]) {
    let (left, top) = (index % COLUMNS * CELL_PIXELS, index / COLUMNS * CELL_PIXELS);
    for (row, line) in letter.chunks(CELL_PIXELS).enumerate() {
        let start = (top + row) * all.width + left;
        all.values[start..start + CELL_PIXELS].copy_from_slice(line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_fits_its_cell_and_all_mipmaps_exist() {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("a font");
        for letter in (FIRST + 1..LAST).map(|code| char::from(code as u8)) {
            let alone = letter_alone(&font, font.glyph_id(letter));
            assert!(alone.iter().sum::<f32>() > 20.0, "{letter} is blank");
            let edge = (0..CELL_PIXELS).flat_map(|at| {
                let last = CELL_PIXELS - 1;
                [(at, 0), (at, last), (0, at), (last, at)]
            });
            let edge = edge.map(|(x, y)| alone[y * CELL_PIXELS + x]);
            assert!(edge.into_iter().all(|covered| covered == 0.0), "{letter} touches its edge");
        }
        let (atlas, image) = Atlas::draw();
        assert!(atlas.advance('0') > 10.0 && atlas.advance('\u{2212}') > 0.0);
        let expected: usize = (0..SIZES).map(|size| (1024 >> size) * (384 >> size) * 4).sum();
        assert_eq!(image.data.map(|data| data.len()), Some(expected));
    }
}
