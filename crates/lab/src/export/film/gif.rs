//! A film as GIF. The whole film has one palette, chosen from frames throughout it, so that no colour flickers. The
//! pattern of the ordered dithering is stationary, and only changed pixels are stored.

mod size;

use std::borrow::Cow;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, Frame, Repeat};

use crate::export::ExportError;
use snakes_core::check::within;
use snakes_core::save::{Picture, UnfinishedFile};

pub use size::{GifChoice, GifChoices, MOST_MB, most_estimated};

/// Allowed frames per second. Browsers show a frame of less than 0.02 s for 0.1 s.
pub const GIF_FPS: RangeInclusive<u32> = 1..=50;

/// Number of pairs of frames from which the palette and the size of the file are estimated.
pub const PAIRS: usize = 6;
/// Number of colours of the palette; one more index marks unchanged pixels.
const COLORS: usize = 255;
/// Index of pixels that do not change.
const UNCHANGED: u8 = 255;
/// Sampling of the palette's choice: every this-many-th pixel is used.
const SAMPLE_FACTOR: i32 = 7;
/// Bits per channel of the lookup table from colours to the palette.
const TABLE_BITS: u32 = 6;
/// Amplitude of the dithering, in steps of a colour channel.
const DITHER: i32 = 5;

/// Thresholds of ordered dithering (Bayer), from 0 to 63.
#[rustfmt::skip]
const BAYER: [[i32; 8]; 8] = [
    [ 0, 32,  8, 40,  2, 34, 10, 42],
    [48, 16, 56, 24, 50, 18, 58, 26],
    [12, 44,  4, 36, 14, 46,  6, 38],
    [60, 28, 52, 20, 62, 30, 54, 22],
    [ 3, 35, 11, 43,  1, 33,  9, 41],
    [51, 19, 59, 27, 49, 17, 57, 25],
    [15, 47,  7, 39, 13, 45,  5, 37],
    [63, 31, 55, 23, 61, 29, 53, 21],
];

/// The palette of a film.
pub struct GifPalette {
    /// Red, green and blue of each colour, one after another.
    rgb: Vec<u8>,
    /// Index of the palette's nearest colour, by the upper bits of red, green and blue.
    nearest: Vec<u8>,
}

impl GifPalette {
    /// Chooses the palette from some frames, each with its index in the film.
    pub fn of(samples: &[(usize, Picture)]) -> Self {
        let pixels = samples.iter().flat_map(|(_, frame)| frame.rgb.as_chunks::<3>().0);
        let rgba: Vec<u8> = pixels.flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
        let network = NeuQuant::new(SAMPLE_FACTOR, COLORS, &rgba);
        let shift = 8 - TABLE_BITS;
        let levels = 1_u32 << TABLE_BITS;
        // The centre of the colours that share these upper bits.
        let channel = |bits: u32| ((bits << shift) | (1 << (shift - 1))) as u8;
        let index = |cell: u32| {
            let [r, g, b] = [cell >> (2 * TABLE_BITS), cell >> TABLE_BITS, cell];
            let [r, g, b] = [r, g, b].map(|bits| channel(bits % levels));
            network.index_of(&[r, g, b, 255]) as u8
        };
        Self { rgb: network.color_map_rgb(), nearest: (0..levels.pow(3)).map(index).collect() }
    }

    /// Estimates the size of a film with this number of frames from some of them, in bytes.
    pub fn expected_bytes(&self, samples: &[(usize, Picture)], frames: usize) -> u64 {
        let indices: Vec<_> = samples.iter().map(|(at, of)| (*at, self.indices(of))).collect();
        let width = samples.first().map_or(0, |(_, frame)| frame.width as usize);
        let bytes = |indices: &[u8], last: &[u8]| encoded(indices, last, width).buffer.len() as f64;
        let first = indices.first().map_or(0.0, |(_, first)| bytes(first, &[]));
        let neighbours = indices.windows(2).filter(|pair| pair[0].0 + 1 == pair[1].0);
        let later: Vec<f64> = neighbours.map(|pair| bytes(&pair[1].1, &pair[0].1)).collect();
        let mean = later.iter().sum::<f64>() / later.len().max(1) as f64;
        (first + mean * frames.saturating_sub(1) as f64) as u64
    }

    /// Returns the palette index of each pixel of a frame, with dithering.
    fn indices(&self, frame: &Picture) -> Vec<u8> {
        let rows = frame.rgb.chunks_exact(frame.width as usize * 3).zip(BAYER.iter().cycle());
        let row = |(row, thresholds): (&[u8], &[i32; 8])| -> Vec<u8> {
            let pixels = row.as_chunks::<3>().0.iter().zip(thresholds.iter().cycle());
            let index = |(pixel, threshold): (&[u8; 3], &i32)| {
                let added = (threshold * 2 - 63) * DITHER / 64;
                let [r, g, b] = pixel.map(|channel| {
                    let dithered = (i32::from(channel) + added).clamp(0, 255);
                    dithered as usize >> (8 - TABLE_BITS)
                });
                self.nearest[((r << TABLE_BITS | g) << TABLE_BITS) | b]
            };
            pixels.map(index).collect()
        };
        rows.flat_map(row).collect()
    }
}

/// A GIF file that was begun, before its palette is known.
pub struct BegunGif {
    file: UnfinishedFile,
    path: PathBuf,
    size: [u16; 2],
    fps: u32,
}

/// A GIF that is being written.
pub struct GifFile {
    palette: GifPalette,
    encoder: Encoder<UnfinishedFile>,
    path: PathBuf,
    /// Width of the film, in pixels.
    width: usize,
    fps: u32,
    /// Palette indices of the last frame; empty before the first one.
    last: Vec<u8>,
    frames: u32,
    /// Number of bytes of all frames so far.
    bytes: u64,
}

impl BegunGif {
    /// Creates the file.
    ///
    /// # Errors
    /// A GIF cannot have this size in pixels or this frame rate, or the file cannot be written.
    pub fn begin(path: &Path, size: (u32, u32), fps: u32) -> Result<Self, ExportError> {
        within("--fps", fps, GIF_FPS)?;
        within("--size", size.0.max(size.1), 1..=u32::from(u16::MAX))?;
        let file = UnfinishedFile::create(path)?;
        Ok(Self { file, path: path.to_owned(), size: [size.0 as u16, size.1 as u16], fps })
    }

    /// Sets the palette of the film, and writes the header.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn with_palette(self, palette: GifPalette) -> Result<GifFile, ExportError> {
        let Self { file, path, size: [width, height], fps } = self;
        let encoder = Encoder::new(file, width, height, &palette.rgb);
        let mut encoder = encoder.map_err(ExportError::unwritable(&path))?;
        encoder.set_repeat(Repeat::Infinite).map_err(ExportError::unwritable(&path))?;
        let (width, last) = (usize::from(width), Vec::new());
        Ok(GifFile { palette, encoder, path, width, fps, last, frames: 0, bytes: 0 })
    }
}

/// Returns the part of a frame that differs from the last one, compressed. `width` is that of the film, in pixels.
fn encoded(indices: &[u8], last: &[u8], width: usize) -> Frame<'static> {
    let (left, top, width, height, buffer) = cropped(&changed(indices, last), width);
    let mut part = Frame {
        dispose: DisposalMethod::Keep,
        transparent: Some(UNCHANGED),
        left,
        top,
        width,
        height,
        buffer: Cow::Owned(buffer),
        ..Frame::default()
    };
    part.make_lzw_pre_encoded();
    part
}

impl GifFile {
    /// Returns the number of bytes of all frames so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Adds the next frame of the film.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, frame: &Picture) -> Result<(), ExportError> {
        let indices = self.palette.indices(frame);
        // Rounded in a way that does not accumulate errors.
        let delay = hundredths(self.frames + 1, self.fps) - hundredths(self.frames, self.fps);
        let part = Frame { delay: delay as u16, ..encoded(&indices, &self.last, self.width) };
        let written = self.encoder.write_lzw_pre_encoded_frame(&part);
        written.map_err(ExportError::unwritable(&self.path))?;
        self.bytes += part.buffer.len() as u64;
        self.last = indices;
        self.frames += 1;
        Ok(())
    }

    /// Completes the film, and gives it its final name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), ExportError> {
        let Self { encoder, path, .. } = self;
        let file = encoder.into_inner().map_err(ExportError::unwritable(&path))?;
        Ok(file.finish()?)
    }
}

/// Returns the time at which a frame begins, in hundredths of a second.
fn hundredths(frame: u32, fps: u32) -> u32 {
    (u64::from(frame) * 100).saturating_add(u64::from(fps) / 2).wrapping_div(u64::from(fps)) as u32
}

/// Returns the palette indices of a frame, with unchanged pixels marked by `UNCHANGED`.
fn changed(indices: &[u8], last: &[u8]) -> Vec<u8> {
    if last.is_empty() {
        return indices.to_vec();
    }
    let pairs = indices.iter().zip(last);
    pairs.map(|(index, last)| if index == last { UNCHANGED } else { *index }).collect()
}

/// Returns the smallest rectangle of a frame that contains all changed pixels, at least one pixel large: left, top,
/// width, height, palette indices.
fn cropped(shown: &[u8], width: usize) -> (u16, u16, u16, u16, Vec<u8>) {
    let has_changed = |row: &[u8]| row.iter().any(|index| *index != UNCHANGED);
    let rows = || shown.chunks_exact(width);
    let top = rows().position(has_changed).unwrap_or(0);
    let bottom = rows().rposition(has_changed).map_or(top + 1, |last| last + 1);
    let columns = |row: &[u8]| {
        let is_new = |index: &u8| *index != UNCHANGED;
        Some((row.iter().position(is_new)?, row.iter().rposition(is_new)? + 1))
    };
    let ends = rows().filter_map(columns);
    let widest = ends.reduce(|(left, right), (a, b)| (left.min(a), right.max(b)));
    let (left, right) = widest.unwrap_or((0, 1));
    let part = rows().take(bottom).skip(top).flat_map(|row| &row[left..right]);
    let buffer = part.copied().collect();
    (left as u16, top as u16, (right - left) as u16, (bottom - top) as u16, buffer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_delays_of_all_frames_add_up_to_the_time_of_the_film() {
        for fps in [1, 7, 24, 25, 30, 50] {
            let delays =
                (0..fps * 3).map(|frame| hundredths(frame + 1, fps) - hundredths(frame, fps));
            let delays: Vec<u32> = delays.collect();
            assert_eq!(delays.iter().sum::<u32>(), 300, "{fps}");
            assert!(delays.iter().all(|delay| *delay >= 2), "{fps}: {delays:?}");
        }
    }

    #[test]
    fn only_the_part_that_changes_is_kept() {
        let last = vec![7; 20];
        let mut next = last.clone();
        (next[6], next[12]) = (1, 2);
        let shown = changed(&next, &last);
        let (left, top, width, height, part) = cropped(&shown, 5);
        assert_eq!((left, top, width, height), (1, 1, 2, 2));
        assert_eq!(part, [1, UNCHANGED, UNCHANGED, 2]);
        let (_, _, width, height, part) = cropped(&changed(&last, &last), 5);
        assert_eq!((width, height, part), (1, 1, vec![UNCHANGED]), "nothing changes");
    }

    #[test]
    fn the_palette_has_the_colours_of_the_film() {
        let mut frame = Picture::new(64, 64);
        for (number, pixel) in frame.rgb.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let share = (number % 64) as u8;
            *pixel = if number < 2048 { [230, 40, 40] } else { [share * 2, share * 3, 250] };
        }
        let palette = GifPalette::of(&[(0, frame.clone())]);
        let indices = palette.indices(&frame);
        for (pixel, index) in frame.rgb.as_chunks::<3>().0.iter().zip(indices) {
            assert_ne!(index, UNCHANGED);
            let shown = &palette.rgb[usize::from(index) * 3..][..3];
            for (channel, shown) in pixel.iter().zip(shown) {
                assert!(channel.abs_diff(*shown) < 24, "{pixel:?} as {shown:?}");
            }
        }
    }
}
