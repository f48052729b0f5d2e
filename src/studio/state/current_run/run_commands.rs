//! Executes commands to the current run.

use super::CurrentRun;
use crate::studio::commands::chart_export::ChartFormat;
use crate::studio::commands::{Command, RunCommand};
use crate::studio::state::chart_export;
use crate::studio::state::new_file::{offer_path, offer_picture};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::{SavePlace, read_notes};
use snakes_core::save::settings_in_words;

impl CurrentRun {
    /// Returns the run's name for the user: the user's own name for it, if any, with its preset and seed.
    fn name(&self) -> String {
        let notes = read_notes(&SavePlace::Run(self.source.folder.clone())).unwrap_or_default();
        let plan = format!("{}, seed {}", settings_in_words(&self.plan_now), self.source.plan.seed);
        notes.own_name().map_or(plan.clone(), |own| format!("{own}: {plan}"))
    }

    /// Executes a command to the current run.
    ///
    /// # Errors
    /// The run, its folder or the operating system does not allow the command, for the returned reason.
    pub fn apply(&mut self, command: &RunCommand, notices: &mut Notices) -> Result<(), String> {
        match command {
            RunCommand::Start => self.start(),
            RunCommand::Pause => self.pause(),
            RunCommand::SingleGeneration => self.single_generation(),
            RunCommand::Extend => self.extend(),
            RunCommand::New => self.begin_next(),
            RunCommand::Reset => {
                let (plan, finished) = (self.source.plan.clone(), self.reports.len());
                let folder = self.source.folder.clone();
                self.reset();
                if finished > 0 && self.source.folder == folder {
                    let text = format!(
                        "{}, seed {} begins anew: \"Start evolution\" replaces its {finished} finished generations.",
                        plan.preset, plan.seed
                    );
                    let resume = Command::Run(RunCommand::Continue(folder));
                    notices.offer("reset", text, [("Resume it instead", resume)]);
                }
                Ok(())
            }
            RunCommand::Continue(folder) => self.go_on_with(folder),
            RunCommand::SetThreads(threads) => self.set_threads(*threads),
            RunCommand::ShowHash => {
                notices
                    .info(self.hash_in_words().ok_or("A run has its hash when it is finished.")?);
                Ok(())
            }
            RunCommand::ListRuns => self.list_runs(),
            RunCommand::Compare(folder) => self.others.toggle(folder),
            RunCommand::ExportChart(chart) => {
                let path = chart_export::export(&self.context.saves, chart, || self.name())?;
                let text = format!("Chart saved to {}", path.display());
                match chart.format {
                    ChartFormat::Png => offer_picture(notices, text, &path),
                    ChartFormat::Csv => offer_path(notices, "table", text, &path),
                }
                Ok(())
            }
        }
    }
}
