//! Names and fingerprints of runs: hashes over everything that determines the bits of a run.

use xxhash_rust::xxh3::xxh3_64;

use super::same_engine::engine_of;
use crate::evolve::{RunPlan, SettingChange, Settings};

/// Returns the name of a run's folder: the preset, the seed, and eight hexadecimal digits that stand for everything else that determines
/// the bits. Folders with equal names therefore have the same run, and no run overwrites another.
pub fn run_name(plan: &RunPlan) -> String {
    let plain = plan.preset.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-');
    let preset: String = plain.take(40).collect();
    format!("{preset}-seed{}-{}", plan.seed, settings_fingerprint(plan))
}

/// Returns eight hexadecimal digits that stand for a plan's settings, its founder and the engine.
pub fn settings_fingerprint(plan: &RunPlan) -> String {
    let settings = ron::to_string(&plan.settings).unwrap_or_default();
    let founder = plan.founder.as_ref().map(|founder| {
        let genome = founder.genome();
        format!(" from {} {:016x}", genome.controller.kind(), genome.hash())
    });
    let Settings { trial, genome, .. } = &plan.settings;
    let engine = engine_of(trial.physics.engine, genome.has_creatures());
    let text = format!("{engine} {settings}{}", founder.unwrap_or_default());
    format!("{:08x}", xxh3_64(text.as_bytes()) as u32)
}

/// Returns sixteen hexadecimal digits that stand for everything that determines the bits of a run, its changes included.
pub fn fingerprint(plan: &RunPlan) -> String {
    let mut text = format!("{} {}", plan.seed, settings_fingerprint(plan));
    for SettingChange { generation, field, value } in plan.changes.made() {
        text += &format!(" {generation} {field} {:?}", value.to_string());
    }
    format!("{:016x}", xxh3_64(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_names_differ_between_runs_and_contain_no_path_separator() {
        let name = |preset: &str, seed, population| {
            let mut settings = Settings::default();
            settings.evolution.population = population;
            run_name(&RunPlan::new(preset, seed, settings))
        };
        let first = name("report", 1, 500);
        assert!(first.starts_with("report-seed1-"), "{first}");
        assert_eq!(first, name("report", 1, 500));
        assert_ne!(first, name("report", 2, 500));
        assert_ne!(first, name("report", 1, 501));
        let hostile = name("../../etc/x", 1, 500);
        assert!(hostile.starts_with("etcx-seed1"), "{hostile}");
    }
}
