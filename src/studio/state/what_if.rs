//! What-if: a copy of the champion in a changed world, beside the original.

use bevy::prelude::*;

use super::current_run::CurrentRun;
use super::wording::world_in_words;
use crate::evolve::{Settings, with_fields};
use crate::score::Trial;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};

/// A change of the world.
#[derive(Debug, Clone)]
pub(crate) enum WorldChange<'a> {
    /// New values of settings, by their names: see [`with_fields`].
    Fields(Vec<(&'a str, &'a str)>),
    /// The world of a preset.
    Preset(&'a str),
}

/// Applies a change to the next run. Returns the first champion on the stage, unchanged and in the changed world;
/// `None` if the change does not affect it.
pub(crate) fn what_if(
    run: &mut CurrentRun,
    on_show: &[StagedChampion],
    mode: &StageMode,
    change: &WorldChange,
) -> Result<Option<Show>, String> {
    let before = match mode {
        StageMode::WhatIf { before } => before.clone(),
        StageMode::Solo | StageMode::Race | StageMode::Generation { .. } => {
            Box::new(run.next_plan().clone())
        }
    };
    match change {
        WorldChange::Fields(changes) => run.set_fields(changes)?,
        WorldChange::Preset(name) => run.set_preset(name)?,
    }
    // Both lanes are simulated, so that only the change makes a difference.
    let Some(original) = on_show.first().map(StagedChampion::simulated) else { return Ok(None) };
    let original = &original;
    // Changes accumulate.
    let so_far = match mode {
        StageMode::WhatIf { .. } => on_show.last().unwrap_or(original),
        StageMode::Solo | StageMode::Race | StageMode::Generation { .. } => original,
    };
    let next = run.next_settings();
    let trial = match change {
        // Other differences of the next run's world are left out.
        WorldChange::Fields(changes) => {
            let settings = Settings { trial: so_far.trial().clone(), ..next.clone() };
            let changed = with_fields(&settings, changes.iter().copied());
            changed.map_err(|error| error.to_string())?.trial
        }
        // Duration and fitness stay, so that the lanes can be compared.
        WorldChange::Preset(_) => Trial {
            duration_s: so_far.trial().duration_s,
            fitness: so_far.trial().fitness,
            energy_cost_per_kj: so_far.trial().energy_cost_per_kj,
            repeats: so_far.trial().repeats.clone(),
            ..next.trial.clone()
        },
    };
    if trial == *so_far.trial() {
        return Ok(None);
    }
    if trial == *original.trial() {
        return Ok(Some(Show::solo(original.clone())));
    }
    let label = match change {
        WorldChange::Preset(name) => (*name).to_owned(),
        WorldChange::Fields(_) => world_in_words(&original.champion().trial, &trial),
    };
    let changed = original.in_world(&trial, label);
    changed.check().map_err(|reason| {
        format!("The snake on the stage stays in its world, because it does not fit the new one: {reason}")
    })?;
    let champions = vec![original.clone(), changed];
    Ok(Some(Show { champions, mode: StageMode::WhatIf { before } }))
}

/// Discards the changes.
pub(crate) fn dropped(
    run: &mut CurrentRun,
    on_show: &[StagedChampion],
    mode: &StageMode,
) -> Result<Option<Show>, String> {
    let StageMode::WhatIf { before } = mode else { return Ok(None) };
    run.undo_world(before)?;
    Ok(on_show.first().cloned().map(Show::solo))
}

/// Keeps the changed lane.
pub(crate) fn kept(on_show: &[StagedChampion], mode: &StageMode) -> Option<Show> {
    let is_what_if = matches!(mode, StageMode::WhatIf { .. });
    on_show.last().filter(|_| is_what_if).cloned().map(Show::solo)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::state::current_run::prepared_run;

    fn saved(index: usize) -> StagedChampion {
        StagedChampion::from_file(&shipped_champion().expect("well formed"), index, "climber")
    }

    #[test]
    fn changes_add_up_beside_the_original_and_can_be_kept_or_dropped() {
        let mut run = prepared_run();
        let plan = run.next_plan().clone();
        let field = |field, text| WorldChange::Fields(vec![(field, text)]);
        let first =
            what_if(&mut run, &[saved(0)], &StageMode::Solo, &field("surface.friction", "0.3"))
                .expect("allowed")
                .expect("it matters");
        assert_eq!(first.champions[1].label(), "friction 0.3");
        let second =
            what_if(&mut run, &first.champions, &first.mode, &field("stairs.rise_m", "0.7"))
                .expect("allowed")
                .expect("it matters");
        let [original, changed] = &second.champions[..] else { panic!("two lanes") };
        assert!(!original.is_changed() && changed.is_changed());
        assert_eq!(changed.label(), "rise 0.7, friction 0.3");
        let ground = field("ground.friction", "1");
        let third = what_if(&mut run, &second.champions, &second.mode, &ground);
        let third = third.expect("allowed").expect("it matters");
        assert_eq!(third.champions[1].label(), "separate ground, rise 0.7 and 1 more");
        assert_eq!(changed.trial().surface.friction, 0.3);
        assert_eq!(changed.trial().duration_s, original.trial().duration_s, "nothing else");
        let kept = kept(&second.champions, &second.mode).expect("kept");
        assert_eq!(kept.champions[0].trial(), changed.trial());
        let shown = dropped(&mut run, &second.champions, &second.mode);
        let shown = shown.expect("allowed").expect("the original");
        assert_eq!(shown.champions[0].trial(), original.trial());
        assert_eq!(*run.next_plan(), plan, "as it was before the first change");
        // Other settings changed meanwhile stay.
        what_if(&mut run, &[saved(0)], &StageMode::Solo, &field("surface.friction", "0.3"))
            .expect("allowed");
        run.set_seed(77).expect("allowed");
        run.set_population(9).expect("allowed");
        dropped(&mut run, &second.champions, &second.mode).expect("allowed");
        assert_eq!((run.next_seed(), run.next_settings().evolution.population), (77, 9));
        assert_eq!(run.next_settings().trial, plan.settings.trial);
    }

    #[test]
    fn a_second_change_names_the_first_one_that_was_kept() {
        let mut run = prepared_run();
        let change = |field, text| WorldChange::Fields(vec![(field, text)]);
        let first = change("surface.friction", "0.3");
        let first = what_if(&mut run, &[saved(0)], &StageMode::Solo, &first);
        let first = first.expect("allowed").expect("it matters");
        let kept = kept(&first.champions, &first.mode).expect("kept");
        let second = change("stairs.rise_m", "0.7");
        let second = what_if(&mut run, &kept.champions, &kept.mode, &second);
        let second = second.expect("allowed").expect("it matters");
        let labels: Vec<&str> = second.champions.iter().map(StagedChampion::label).collect();
        assert_eq!(labels, ["friction 0.3", "rise 0.7, friction 0.3"]);
    }

    #[test]
    fn a_world_that_the_genome_does_not_fit_is_refused_with_the_reason() {
        let mut run = prepared_run();
        let limbs = WorldChange::Fields(vec![("agent.limbs", "7")]);
        let refusal = what_if(&mut run, &[saved(0)], &StageMode::Solo, &limbs);
        let refusal = refusal.expect_err("refused");
        assert!(refusal.contains("joints is 4 joints") && refusal.contains("7 limbs"), "{refusal}");
        let preset = what_if(&mut run, &[saved(0)], &StageMode::Solo, &WorldChange::Preset("ice"));
        let preset = preset.expect("allowed").expect("another world");
        assert_eq!(preset.champions[1].label(), "ice");
    }

    #[test]
    fn settings_outside_the_world_do_not_affect_the_stage() {
        let mut run = prepared_run();
        let parents = WorldChange::Fields(vec![("evolution.population", "7")]);
        let shown = what_if(&mut run, &[saved(0)], &StageMode::Solo, &parents).expect("allowed");
        assert!(shown.is_none());
        assert_eq!(run.next_settings().evolution.population, 7);
    }
}
