//! Values of single flags, read and checked.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::sync::Arc;

use super::task::Args;
use crate::cli::error::CliError;
#[cfg(feature = "studio")]
use crate::cli::error::of_flag;
#[cfg(feature = "studio")]
use crate::studio::Theme;
use snakes_core::check::{Invalid, within};
#[cfg(feature = "studio")]
use snakes_core::save::PreferencesFile;
use snakes_lab::run::evaluators::EVALUATORS;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::{Evaluator, THREADS_RANGE, available_cores};

/// Reads the number of a flag, which is in `range`. The errors of all wrong texts name the same range.
pub fn number<T: FromStr + PartialOrd + Display + Copy>(
    flag: &str,
    text: &str,
    range: RangeInclusive<T>,
) -> Result<T, Invalid> {
    let value = text.parse().map_err(|_| {
        let is_whole = "0.5".parse::<T>().is_err();
        let kind = if is_whole { "a whole number from " } else { "" };
        let allowed = format!("{kind}{} to {}", range.start(), range.end());
        Invalid::new(flag, format!("{text:?}"), allowed)
    })?;
    within(flag, value, range)?;
    Ok(value)
}

/// Reads the number of a flag, which is in `range`; `None` if the flag is not given.
pub fn number_if<T: FromStr + PartialOrd + Display + Copy>(
    flag: &str,
    text: &Option<String>,
    range: RangeInclusive<T>,
) -> Result<Option<T>, Invalid> {
    text.as_deref().map(|text| number(flag, text, range)).transpose()
}

/// Reads a size in pixels, such as 1280x720.
#[cfg(feature = "studio")]
pub fn size(flag: &str, text: &str, least: (u32, u32), most: u32) -> Result<(u32, u32), Invalid> {
    let (least_width, least_height) = least;
    let wrong = || {
        let allowed = format!("WIDTHxHEIGHT, {least_width}x{least_height} to {most}x{most}");
        Invalid::new(flag, format!("{text:?}"), allowed)
    };
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let pixels = |text: &str| text.parse().map_err(|_| wrong());
    let (width, height) = (pixels(width)?, pixels(height)?);
    within(&format!("{flag} width"), width, least_width..=most)?;
    within(&format!("{flag} height"), height, least_height..=most)?;
    Ok((width, height))
}

impl Args {
    /// Returns the seed of the run; 1 by default.
    pub fn seed(&self) -> Result<u64, CliError> {
        self.seed_or(1)
    }

    /// Returns the given seed, or else `default`.
    pub fn seed_or(&self, default: u64) -> Result<u64, CliError> {
        Ok(number_if("--seed", &self.run.seed.seed, 0..=u64::MAX)?.unwrap_or(default))
    }

    /// Returns the number of worker threads for a command without a window.
    pub fn threads(&self) -> Result<usize, CliError> {
        self.threads_or(available_cores())
    }

    /// Returns the number of workers on other machines that a run waits for.
    #[cfg(feature = "cluster")]
    pub fn expect_workers(&self) -> Result<usize, CliError> {
        let default = usize::from(self.local_threads()? == 0);
        let given = number_if("--expect-workers", &self.workers.expect_workers, 1..=10_000)?;
        Ok(given.unwrap_or(default))
    }

    /// Returns the number of threads of this computer that compute besides the workers on other machines.
    #[cfg(feature = "cluster")]
    pub fn local_threads(&self) -> Result<usize, CliError> {
        let given = number_if("--local-threads", &self.workers.local_threads, THREADS_RANGE)?;
        Ok(given.unwrap_or(0))
    }

    /// Returns the evaluator on this computer for a command without a window.
    pub fn local_evaluator(&self) -> Result<Arc<dyn Evaluator>, CliError> {
        self.evaluator_of(self.threads()?)
    }

    /// Returns the evaluator for a program with a window. By default it leaves one core free for the window.
    #[cfg(feature = "studio")]
    pub fn studio_evaluator(&self) -> Result<Arc<dyn Evaluator>, CliError> {
        self.evaluator_of(self.threads_or(available_cores().saturating_sub(1).max(1))?)
    }

    /// Returns the named evaluator, or else the default one, with this number of workers.
    fn evaluator_of(&self, workers: usize) -> Result<Arc<dyn Evaluator>, CliError> {
        let name = self.workers.threads.evaluator.as_deref().unwrap_or(EVALUATORS[0].name);
        let row = EVALUATORS.iter().find(|row| row.name == name).ok_or_else(|| {
            let names: Vec<&str> = EVALUATORS.iter().map(|row| row.name).collect();
            Invalid::new("--evaluator", format!("{name:?}"), names.join(", "))
        })?;
        Ok((row.start)(workers).map_err(HeadlessError::from)?)
    }

    fn threads_or(&self, default: usize) -> Result<usize, CliError> {
        let given = number_if("--threads", &self.workers.threads.threads, THREADS_RANGE)?;
        Ok(given.unwrap_or(default))
    }

    /// Returns the window's size in physical pixels, if it is given.
    #[cfg(feature = "studio")]
    pub fn window_size(&self) -> Result<Option<(u32, u32)>, CliError> {
        let given = self.window.window_size.as_deref();
        Ok(given.map(|text| size("--window-size", text, (320, 240), 16_384)).transpose()?)
    }

    /// Returns the colour theme of the window and of pictures, if it is given.
    #[cfg(feature = "studio")]
    pub fn theme(&self) -> Result<Option<Theme>, CliError> {
        let named = self.window.theme.as_deref().map(str::parse).transpose();
        Ok(named.map_err(of_flag("--theme"))?)
    }

    /// Returns the file for window preferences.
    #[cfg(feature = "studio")]
    pub fn preferences(&self) -> PreferencesFile {
        match self.window.preferences.as_deref() {
            None => PreferencesFile::find(),
            Some(path) if path.as_os_str() == "none" => PreferencesFile::nowhere(),
            Some(path) => PreferencesFile::at(path),
        }
    }

    /// Returns the number of frames after which the window closes by itself, if it is given.
    #[cfg(feature = "studio")]
    pub fn exit_after_frames(&self) -> Result<Option<u32>, CliError> {
        Ok(number_if("--exit-after-frames", &self.window.exit_after_frames, 1..=u32::MAX)?)
    }
}
