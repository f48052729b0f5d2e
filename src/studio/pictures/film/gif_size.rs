//! Choice of the size and the frame rate of a GIF, so that its file is small enough for messages and web pages.

use super::order::FilmOrder;

/// Maximum size of a GIF whose size or frame rate was not ordered, in bytes.
pub const MOST_BYTES: u64 = 8_000_000;
/// Maximum estimate of a GIF's size, in bytes. The file may turn out somewhat larger.
pub const ESTIMATED_BYTES: u64 = 7_000_000;
/// Usual number of bytes for a pixel of a frame, before it is measured.
pub const USUAL_BYTES_PER_PIXEL: f64 = 0.3;

/// Width as a share of the ordered one, and frames per second, the best first.
const QUALITIES: [(f64, u32); 11] = [
    (1.0, 20),
    (1.0, 15),
    (0.9, 15),
    (0.8, 15),
    (0.8, 12),
    (0.7, 12),
    (0.6, 12),
    (0.5, 10),
    (0.5, 8),
    (0.4, 8),
    (0.4, 5),
];

/// A size and frame rate of a GIF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GifChoice {
    /// Width and height, in pixels.
    pub size: (u32, u32),
    /// Frames per second.
    pub fps: u32,
}

impl GifChoice {
    /// Returns the number of pixels of all frames, if the film has `frames` at `fps`.
    fn pixels(self, fps: u32, frames: usize) -> f64 {
        let frames = frames as f64 * f64::from(self.fps) / f64::from(fps.max(1));
        f64::from(self.size.0) * f64::from(self.size.1) * frames
    }

    /// Returns the number of bytes for a pixel of a frame in a file of this size.
    pub fn bytes_per_pixel(self, fps: u32, frames: usize, bytes: u64) -> f64 {
        bytes as f64 / self.pixels(fps, frames).max(1.0)
    }
}

/// Returns the sizes and frame rates in which a film may be made, the best first.
pub fn choices(order: &FilmOrder) -> Vec<GifChoice> {
    let (width, height) = order.size;
    let scaled = |pixels: u32, share: f64| libm::round(f64::from(pixels) * share) as u32;
    let choice = |(share, fps): (f64, u32)| GifChoice {
        size: match order.may_be_smaller {
            true => (scaled(width, share), scaled(height, share)),
            false => order.size,
        },
        fps: if order.may_be_slower { fps } else { order.fps },
    };
    let mut choices: Vec<GifChoice> = QUALITIES.into_iter().map(choice).collect();
    choices.dedup();
    choices
}

/// Takes the first choice whose file is expected to be small enough, or else the last one, and removes the better ones. The
/// film has `frames` at `fps`. Returns `None` if no choice is left.
pub fn first_small(
    choices: &mut Vec<GifChoice>,
    fps: u32,
    frames: usize,
    bytes_per_pixel: f64,
) -> Option<GifChoice> {
    let is_small = |choice: &GifChoice| {
        choice.pixels(fps, frames) * bytes_per_pixel <= ESTIMATED_BYTES as f64
    };
    let worst = choices.len().saturating_sub(1);
    let place = choices.iter().position(is_small).unwrap_or(worst);
    choices.drain(..choices.len().min(place + 1)).next_back()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::camera_mode::CameraMode;
    use crate::studio::ui::theme::Theme;

    fn order(may_be_smaller: bool, may_be_slower: bool) -> FilmOrder {
        FilmOrder {
            parts: Vec::new(),
            start_s: 0.0,
            end_s: None,
            speed: 1.0,
            fps: 20,
            size: (640, 360),
            may_be_smaller,
            may_be_slower,
            ends_with_climb: true,
            camera: CameraMode::Follow,
            theme: Theme::Light,
            overlays: Vec::new(),
            has_captions: true,
        }
    }

    #[test]
    fn a3_a_gif_gets_smaller_and_slower_until_it_is_small_enough() {
        let all = choices(&order(true, true));
        let mut left = all.clone();
        // A film of 12 s, with as many bytes for a pixel as measured in a film that follows a climber.
        let first = first_small(&mut left, 20, 240, 0.35).expect("a choice");
        let bytes = |choice: GifChoice, bytes_per_pixel| {
            choice.pixels(20, 240) * bytes_per_pixel
        };
        assert!(bytes(first, 0.35) <= ESTIMATED_BYTES as f64, "{first:?}");
        assert!(first.size.0 >= 448 && first.fps >= 12, "{first:?} is needlessly poor");
        // What was tried is not tried again, even if nothing is small enough.
        let tries = std::iter::from_fn(|| first_small(&mut left, 20, 240, 99.0));
        assert_eq!(tries.last(), all.last().copied());
        assert!(left.is_empty());
    }

    #[test]
    fn a3_an_ordered_size_or_rate_is_kept() {
        let sizes = choices(&order(true, false));
        assert!(sizes.iter().all(|choice| choice.fps == 20) && sizes.len() > 4, "{sizes:?}");
        let rates = choices(&order(false, true));
        assert!(rates.iter().all(|choice| choice.size == (640, 360)) && rates.len() > 3);
        assert_eq!(choices(&order(false, false)), [GifChoice { size: (640, 360), fps: 20 }]);
    }
}
