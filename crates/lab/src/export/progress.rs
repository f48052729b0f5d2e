//! Progress and cancellation of an export.

use super::ExportError;
use crate::run::RunControl;

/// Shows the progress of an export, and checks whether it was cancelled.
#[derive(Clone, Copy)]
pub struct ExportProgress<'p> {
    show: &'p dyn Fn(f64),
    control: &'p RunControl,
    /// Takes the expected size of the file, in bytes.
    expect: Option<&'p dyn Fn(u64)>,
    /// Start and end of the current part, as shares of the whole.
    part: [f64; 2],
}

impl<'p> ExportProgress<'p> {
    /// Creates a progress from 0 to 1, which `show` displays, until `control` is cancelled.
    pub fn new(show: &'p dyn Fn(f64), control: &'p RunControl) -> Self {
        Self { show, control, expect: None, part: [0.0, 1.0] }
    }

    /// Returns this progress, with a function that is told the expected size of the file, in bytes.
    pub fn telling(self, expect: &'p dyn Fn(u64)) -> Self {
        Self { expect: Some(expect), ..self }
    }

    /// Tells the size that the file will have, in bytes, before it is written.
    pub fn expect(&self, bytes: u64) {
        self.expect.iter().for_each(|tell| tell(bytes));
    }

    /// Returns the progress of part number `index` of `count` equal parts.
    pub fn part(&self, index: usize, count: usize) -> Self {
        let [start, end] = self.part;
        let at = |index: usize| start + (end - start) * index as f64 / count.max(1) as f64;
        Self { part: [at(index), at(index + 1)], ..*self }
    }

    /// Reports that `share` of this part is done, from 0 to 1.
    ///
    /// # Errors
    /// [`ExportError::Cancelled`], if the user cancelled the export.
    pub fn reach(&self, share: f64) -> Result<(), ExportError> {
        if self.control.is_cancelled() {
            return Err(ExportError::Cancelled);
        }
        let [start, end] = self.part;
        (self.show)(start + (end - start) * share);
        Ok(())
    }
}
