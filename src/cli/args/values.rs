//! Values of single flags, checked.

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

/// The words of an error for a whole number without another limit.
pub const WHOLE: &str = "a whole number from 0 up";

/// Reads a number; `allowed` is what the error calls one.
pub fn number<T: FromStr>(flag: &str, text: &str, allowed: &str) -> Result<T, Invalid> {
    text.parse().map_err(|_| Invalid::new(flag, format!("{text:?}"), allowed))
}

/// Reads the number of a flag, if that is given; `allowed` is what the error calls one.
pub fn number_or<T: FromStr>(
    flag: &str,
    text: &Option<String>,
    default: T,
    allowed: &str,
) -> Result<T, Invalid> {
    text.as_deref().map_or(Ok(default), |text| number(flag, text, allowed))
}

/// Reads the whole number of a flag, if that is given.
fn whole<T: FromStr + PartialOrd + Display + Copy>(
    flag: &str,
    text: &Option<String>,
    range: RangeInclusive<T>,
) -> Result<Option<T>, Invalid> {
    let Some(text) = text else { return Ok(None) };
    let allowed = format!("a whole number from {} to {}", range.start(), range.end());
    let value = number(flag, text, &allowed)?;
    within(flag, value, range).map(|()| Some(value))
}

/// Reads a size in pixels, such as 1280x720.
#[cfg(feature = "studio")]
pub fn size(flag: &str, text: &str, least: (u32, u32), most: u32) -> Result<(u32, u32), Invalid> {
    let allowed = "WIDTHxHEIGHT, such as 1280x720";
    let wrong = || Invalid::new(flag, format!("{text:?}"), allowed);
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let (width, height) = (number(flag, width, allowed)?, number(flag, height, allowed)?);
    within(&format!("{flag} width"), width, least.0..=most)?;
    within(&format!("{flag} height"), height, least.1..=most)?;
    Ok((width, height))
}

impl Args {
    /// The seed of the run.
    pub fn seed(&self) -> Result<u64, CliError> {
        self.seed_or(1)
    }

    /// The seed that is given, else this one.
    pub fn seed_or(&self, default: u64) -> Result<u64, CliError> {
        let allowed = "a whole number from 0 to 18446744073709551615";
        Ok(number_or("--seed", &self.run.seed.seed, default, allowed)?)
    }

    /// The duration of trials in s, if it is given.
    pub fn duration_s(&self) -> Result<Option<f32>, CliError> {
        let given = self.run.settings.duration.as_deref();
        Ok(given.map(|text| number("--duration", text, "a number")).transpose()?)
    }

    /// Number of worker threads without a window.
    pub fn threads(&self) -> Result<usize, CliError> {
        self.threads_or(available_cores())
    }

    /// Number of workers on other machines that a run waits for.
    #[cfg(feature = "cluster")]
    pub fn expect_workers(&self) -> Result<usize, CliError> {
        let default = usize::from(self.local_threads()? == 0);
        let given = whole("--expect-workers", &self.workers.expect_workers, 1..=10_000)?;
        Ok(given.unwrap_or(default))
    }

    /// Number of threads of this computer that compute beside the workers on other machines.
    #[cfg(feature = "cluster")]
    pub fn local_threads(&self) -> Result<usize, CliError> {
        let given = whole("--local-threads", &self.workers.local_threads, THREADS_RANGE)?;
        Ok(given.unwrap_or(0))
    }

    /// The evaluator without a window, on this computer.
    pub fn local_evaluator(&self) -> Result<Arc<dyn Evaluator>, CliError> {
        self.evaluator_of(self.threads()?)
    }

    /// The evaluator beside a window, which leaves one core free for it.
    #[cfg(feature = "studio")]
    pub fn studio_evaluator(&self) -> Result<Arc<dyn Evaluator>, CliError> {
        self.evaluator_of(self.threads_or(available_cores().saturating_sub(1).max(1))?)
    }

    /// The evaluator that is named, else the default.
    fn evaluator_of(&self, workers: usize) -> Result<Arc<dyn Evaluator>, CliError> {
        let name = self.workers.threads.evaluator.as_deref().unwrap_or(EVALUATORS[0].name);
        let row = EVALUATORS.iter().find(|row| row.name == name).ok_or_else(|| {
            let names: Vec<&str> = EVALUATORS.iter().map(|row| row.name).collect();
            Invalid::new("--evaluator", format!("{name:?}"), names.join(", "))
        })?;
        Ok((row.start)(workers).map_err(HeadlessError::from)?)
    }

    fn threads_or(&self, default: usize) -> Result<usize, CliError> {
        let given = whole("--threads", &self.workers.threads.threads, THREADS_RANGE)?;
        Ok(given.unwrap_or(default))
    }

    /// The window's size in physical pixels, if it is given.
    #[cfg(feature = "studio")]
    pub fn window_size(&self) -> Result<Option<(u32, u32)>, CliError> {
        let given = self.window.window_size.as_deref();
        Ok(given.map(|text| size("--window-size", text, (320, 240), 16_384)).transpose()?)
    }

    /// The colour theme of the window and of pictures, if it is given.
    #[cfg(feature = "studio")]
    pub fn theme(&self) -> Result<Option<Theme>, CliError> {
        let named = self.window.theme.as_deref().map(str::parse).transpose();
        Ok(named.map_err(of_flag("--theme"))?)
    }

    /// The file for window preferences.
    #[cfg(feature = "studio")]
    pub fn preferences(&self) -> PreferencesFile {
        match self.window.preferences.as_deref() {
            None => PreferencesFile::find(),
            Some(path) if path.as_os_str() == "none" => PreferencesFile::nowhere(),
            Some(path) => PreferencesFile::at(path),
        }
    }

    /// The number of frames after which the window closes by itself.
    #[cfg(feature = "studio")]
    pub fn exit_after_frames(&self) -> Result<Option<u32>, CliError> {
        let Some(text) = &self.window.exit_after_frames else { return Ok(None) };
        let frames = number("--exit-after-frames", text, "a whole number from 1 up")?;
        within("--exit-after-frames", frames, 1..=u32::MAX)?;
        Ok(Some(frames))
    }
}
