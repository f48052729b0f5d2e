//! Changes of settings during a run: `changes.jsonl`, one line per change.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::log::{parse_log, read_log_bytes};
use super::plan::load_plan;
use crate::check::within;
use crate::evolve::{MOST_CHANGES, RunPlan, SettingChange};

pub const CHANGES_FILE: &str = "changes.jsonl";

/// A change of one setting, as a line of the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangeRecord {
    /// First generation that uses the new value.
    generation: u32,
    field: String,
    value: String,
}

impl From<&SettingChange> for ChangeRecord {
    fn from(change: &SettingChange) -> Self {
        let SettingChange { generation, field, value } = change;
        Self { generation: *generation, field: field.clone(), value: value.to_string() }
    }
}

/// Reads the changes of the run in a folder, the earliest first; empty if the run was never changed.
pub fn read_changes(folder: &Path, plan: &RunPlan) -> Result<Vec<SettingChange>, SaveError> {
    let path = folder.join(CHANGES_FILE);
    parse_changes(&path, &read_log_bytes(&path)?, plan)
}

/// Reads the plan of the run in a folder, after all its changes.
pub fn load_changed_plan(folder: &Path) -> Result<RunPlan, SaveError> {
    let plan = load_plan(folder)?;
    let changes = read_changes(folder, &plan)?;
    let changed = plan.in_generation(u32::MAX, &changes);
    changed.map_err(SaveError::invalid(&folder.join(CHANGES_FILE)))
}

/// Parses the changes of the run that began with `plan`; errors name the file `path`.
///
/// # Errors
/// Fails if a complete line is damaged, is out of order, or changes a setting that may not change during a run.
pub fn parse_changes(
    path: &Path,
    bytes: &[u8],
    plan: &RunPlan,
) -> Result<Vec<SettingChange>, SaveError> {
    let records: Vec<ChangeRecord> = parse_log(path, bytes)?;
    let mut plan = plan.clone();
    let read = |ChangeRecord { generation, field, value }| {
        let change = plan.change_of_text(generation, &field, &value)?;
        plan.change(&change).map(|()| change)
    };
    let changes = within("changes", records.len(), 0..=MOST_CHANGES)
        .and_then(|()| records.into_iter().map(read).collect());
    changes.map_err(SaveError::invalid(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::save::log::Log;

    fn plan() -> RunPlan {
        RunPlan::new("test", 1, Settings::default())
    }

    fn change(generation: u32, field: &str, value: &str) -> ChangeRecord {
        ChangeRecord { generation, field: format!("evolution.{field}"), value: value.to_owned() }
    }

    fn read(changes: &[ChangeRecord]) -> Result<Vec<SettingChange>, SaveError> {
        let folder = tempfile::tempdir().expect("a folder");
        let mut log = Log::open(&folder.path().join(CHANGES_FILE), 0).expect("opened");
        for change in changes {
            log.append(change).expect("written");
        }
        read_changes(folder.path(), &plan())
    }

    #[test]
    fn changes_are_read_back_in_order() {
        let changes = [
            change(2, "halving.parents", "7"),
            change(3, "halving.mutation_range_nm", "0.1"),
            change(3, "generations", "9"),
            change(8, "population", "50"),
        ];
        let read_back: Vec<_> =
            read(&changes).expect("allowed").iter().map(ChangeRecord::from).collect();
        assert_eq!(read_back, changes);
        assert_eq!(read(&[]).expect("none"), []);
    }

    #[test]
    fn an_impossible_change_is_refused_with_the_file_and_the_reason() {
        for (changes, complaint) in [
            (vec![change(8, "generations", "9")], "generation is 8; allowed: 1 to 7"),
            (vec![change(0, "population", "9")], "generation is 0; allowed: 1 to 6"),
            (
                vec![change(3, "halving.parents", "7"), change(2, "halving.parents", "8")],
                "generation is 2; allowed: 3 to 6",
            ),
            (vec![change(2, "halving.parents", "0")], "evolution.halving.parents is 0; allowed: 1"),
            (
                vec![change(2, "strategy", "ga")],
                "changed setting is \"evolution.strategy\"; allowed: a setting that may change during a run (takes effect with the next run, because another strategy",
            ),
            (vec![change(2, "halving.parents", "7"); 2001], "changes is 2001; allowed: 0 to 2000"),
        ] {
            let error = read(&changes).expect_err("refused").to_string();
            assert!(error.contains(CHANGES_FILE) && error.contains(complaint), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}
