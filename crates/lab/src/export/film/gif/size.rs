//! Choice of the size and the frame rate of a GIF, so that its file is small enough for messages and web pages.

/// Maximum size of a GIF, in MB (a million bytes), unless another one is ordered.
pub const MOST_MB: f64 = 8.0;

/// Returns the maximum estimate of a GIF's size, in bytes, from its maximum size. The file may turn out somewhat larger.
pub const fn most_estimated(most_bytes: u64) -> u64 {
    most_bytes / 8 * 7
}

/// Usual number of bytes for a pixel of a frame, before it is measured.
const USUAL_BYTES_PER_PIXEL: f64 = 0.3;

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

/// A size and a frame rate of a GIF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GifChoice {
    /// Width and height, in pixels.
    pub size: (u32, u32),
    /// Frames per second.
    pub fps: u32,
}

/// The sizes and frame rates in which a film may still be made, the best first.
#[derive(Debug, Clone)]
pub struct GifChoices {
    left: Vec<GifChoice>,
    /// Maximum size of the file, in bytes.
    most_bytes: u64,
    /// Duration of the film, in seconds.
    duration_s: f64,
    bytes_per_pixel: f64,
}

impl GifChoices {
    /// Lists the choices for a film that lasts `duration_s` seconds and whose file has at most `most_bytes`. Only the ordered size or frame
    /// rate is left if the film may not be smaller or slower.
    pub fn new(
        ordered: GifChoice,
        (duration_s, most_bytes): (f64, u64),
        (smaller, slower): (bool, bool),
    ) -> Self {
        let (width, height) = ordered.size;
        let scaled = |pixels: u32, share: f64| libm::round(f64::from(pixels) * share) as u32;
        let choice = |(share, fps): (f64, u32)| GifChoice {
            size: if smaller {
                (scaled(width, share), scaled(height, share))
            } else {
                ordered.size
            },
            fps: if slower { fps } else { ordered.fps },
        };
        let mut left: Vec<GifChoice> = QUALITIES.into_iter().map(choice).collect();
        left.dedup();
        Self { left, most_bytes, duration_s, bytes_per_pixel: USUAL_BYTES_PER_PIXEL }
    }

    /// Takes the best choice whose file is expected to be small enough, or else the last one, and drops the better ones. Returns it with
    /// the maximum size of its file in bytes, which the last choice does not have; `None` if no choice is left.
    pub fn take(&mut self) -> Option<(GifChoice, Option<u64>)> {
        let most = most_estimated(self.most_bytes) as f64;
        let is_small = |of: &GifChoice| self.pixels(*of) * self.bytes_per_pixel <= most;
        let worst = self.left.len().checked_sub(1)?;
        let place = self.left.iter().position(is_small).unwrap_or(worst);
        let taken = self.left.drain(..=place).next_back()?;
        Some((taken, (!self.left.is_empty()).then_some(self.most_bytes)))
    }

    /// Notes that the file of a choice would have this many bytes.
    pub fn learn(&mut self, of: GifChoice, bytes: u64) {
        self.bytes_per_pixel = bytes as f64 / self.pixels(of).max(1.0);
    }

    /// Returns the number of pixels of all frames.
    fn pixels(&self, of: GifChoice) -> f64 {
        let (width, height) = of.size;
        f64::from(width) * f64::from(height) * f64::from(of.fps) * self.duration_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ORDERED: GifChoice = GifChoice { size: (640, 360), fps: 20 };

    #[test]
    fn a3_a_gif_gets_smaller_and_slower_until_it_is_small_enough() {
        let mut choices = GifChoices::new(ORDERED, (12.0, 8_000_000), (true, true));
        // As many bytes for a pixel as measured in a film that follows a climber.
        choices.bytes_per_pixel = 0.35;
        let (first, most) = choices.take().expect("a choice");
        assert_eq!(most, Some(8_000_000));
        assert!(choices.pixels(first) * 0.35 <= 7_000_000.0, "{first:?}");
        assert!(first.size.0 >= 448 && first.fps >= 12, "{first:?} is needlessly poor");
        // The choices that were taken do not come again, and the last one has no limit.
        choices.learn(first, 90_000_000);
        let rest: Vec<_> = std::iter::from_fn(|| choices.take()).collect();
        assert_eq!(rest, [(GifChoice { size: (256, 144), fps: 5 }, None)]);
    }

    #[test]
    fn a3_an_ordered_size_or_rate_is_kept() {
        let of = |allowed| GifChoices::new(ORDERED, (12.0, 8_000_000), allowed).left;
        let sizes = of((true, false));
        assert!(sizes.iter().all(|choice| choice.fps == 20) && sizes.len() > 4, "{sizes:?}");
        let rates = of((false, true));
        assert!(rates.iter().all(|choice| choice.size == (640, 360)) && rates.len() > 3);
        assert_eq!(of((false, false)), [ORDERED]);
    }

    #[test]
    fn a_gif_for_messages_begins_with_a_size_that_two_megabytes_hold() {
        // A climb of 25 s, twice as fast.
        let mut choices = GifChoices::new(ORDERED, (12.5, 2_000_000), (true, true));
        let (first, most) = choices.take().expect("a choice");
        assert_eq!((first, most), (GifChoice { size: (320, 180), fps: 8 }, Some(2_000_000)));
        assert!(choices.pixels(first) * USUAL_BYTES_PER_PIXEL <= 1_750_000.0);
    }
}
