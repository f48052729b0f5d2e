//! Executes the commands to the plan of the next run.

use super::current_run::CurrentRun;
use super::library::{Library, founder_of};
use super::lineup::champion_of;
use super::sweep::changes_of;
use super::what_if::{ChangedStage, WorldChange, dropped, kept, kept_lane, what_if};
use crate::studio::commands::PlanCommand;
use crate::studio::stage::Show;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::schema::Choices;

/// Describes the setting that was changed because it has to suit the chosen strategy or controller.
fn partner_in_words((field, name): (&str, &str)) -> String {
    match field {
        "genome.controller" => ControllerKind::named(field, name)
            .map(|kind| format!("The controller is now {}, to suit the strategy.", kind.title()))
            .unwrap_or_default(),
        "genome.bodies.vary" if name == "true" => {
            "Bodies evolve now, to suit the strategy.".to_owned()
        }
        "genome.bodies.vary" => "Bodies no longer evolve, to suit the strategy.".to_owned(),
        _ => StrategyKind::named(field, name)
            .map(|kind| format!("The strategy is now {}, to suit your choice.", kind.title()))
            .unwrap_or_default(),
    }
}

/// Borrows the names and texts of changes.
pub(crate) fn borrowed(changes: &[(String, String)]) -> Vec<(&str, &str)> {
    changes.iter().map(|(field, text)| (field.as_str(), text.as_str())).collect()
}

/// Executes a command to the plan. Returns what to show on the stage, if that changes.
///
/// # Errors
/// The command does not suit the plan, the stage or the saves; the error states the reason.
pub(crate) fn apply_to_plan(
    command: &PlanCommand,
    run: &mut CurrentRun,
    (library, opening): (&Library, &OpeningChampions),
    stage: ChangedStage,
    notices: &mut Notices,
) -> Result<Option<Show>, String> {
    let on_show = &stage.show.champions;
    match command {
        PlanCommand::SetSeed(seed) => run.set_seed(*seed),
        PlanCommand::SetField { field, text } => {
            let mut fields = vec![(field.as_str(), text.as_str())];
            // Without the changes of the partners, the strategy, the controller and the bodies would not suit each
            // other, and the change would be refused.
            for partner in run.next_settings().partner_changes(field, text) {
                notices.info(partner_in_words(partner));
                fields.push(partner);
            }
            return what_if(run, stage, &WorldChange::Fields(fields));
        }
        PlanCommand::SetFields(changes) => {
            return what_if(run, stage, &WorldChange::Fields(borrowed(changes)));
        }
        PlanCommand::SetPreset(name) => {
            if !run.preset_suits(name, on_show.first())? {
                run.set_preset(name)?;
                notices.offer_next_run(format!(
                    "The snakes of the preset {name} are of another kind than the one on the stage. They need a new run."
                ));
                return Ok(None);
            }
            return what_if(run, stage, &WorldChange::Preset(name));
        }
        PlanCommand::StorePreset(name) => run.store_preset(name)?,
        PlanCommand::ListPresets => run.list_presets(),
        PlanCommand::StoreStairs(name) => {
            run.store_stairs(name)?;
            notices.info(format!("The stairs are saved as {name}."));
        }
        PlanCommand::ListStairs => run.list_stairs(),
        PlanCommand::StartFrom(pick) => {
            if let Some(founder) = champion_of(pick, run, opening) {
                run.start_next_from(founder.champion(), founder.name())?;
                notices.info(format!("The next run starts from {}.", founder.name()));
            }
        }
        PlanCommand::StartFromSave(place) => {
            let founder = founder_of(place, library.best_of(place))?;
            let name = library.name_of(place);
            run.start_next_from(&founder, &name)?;
            run.begin_next()?;
            notices.info(format!("A run started from {name}."));
            // The new run uses the changed world of a what-if.
            return Ok(kept(stage.show));
        }
        PlanCommand::ForgetFounder => run.forget_founder(),
        PlanCommand::UseWorldOfLane => {
            let changes = on_show.first().map(changes_of).unwrap_or_default();
            run.set_fields(&borrowed(&changes))?;
            notices.info("The next run uses this world.".to_owned());
        }
        PlanCommand::KeepLane(lane) => return kept_lane(run, stage.show, *lane),
        PlanCommand::DropChange => return dropped(run, stage.show),
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::super::what_if::tests::{solo, stage};
    use super::*;
    use crate::studio::commands::{Command, RunCommand};
    use crate::studio::state::current_run::prepared_run;
    use snakes_core::save::SavesFolder;

    #[test]
    fn a9_a_preset_with_snakes_of_another_kind_offers_a_new_run_instead_of_a_what_if() {
        let (library, opening) = (Library::new(SavesFolder::find(None)), OpeningChampions(vec![]));
        for (name, is_tried) in [("ice", true), ("creatures", false), ("bodies", false)] {
            let (mut run, mut notices, show) = (prepared_run(), Notices::default(), solo());
            let command = PlanCommand::SetPreset(name.to_owned());
            let places = (&library, &opening);
            let shown = apply_to_plan(&command, &mut run, places, stage(&show), &mut notices);
            assert_eq!(shown.expect("shipped").is_some(), is_tried, "{name}");
            assert_eq!(run.plan_next.preset, name);
            let begin = [RunCommand::Reset, RunCommand::Start].map(Command::Run);
            let begin = begin.map(|command| ("Begin a new run".to_owned(), command));
            assert_eq!(notices.last_offers(), if is_tried { vec![] } else { begin.to_vec() });
        }
    }
}
