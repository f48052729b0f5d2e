//! The stage: lanes side by side that show a replay, a race or a what-if.

pub mod contact_meter;
pub mod lane;
pub mod opening;
pub mod playback;
pub mod ranking;
pub mod readings;
pub mod replay;
pub mod selection;
pub mod staged_champion;
pub mod staged_world;

use bevy::prelude::*;

use super::OpeningChampions;
use super::schedule::FrameSet;
use super::ui::notifications::Notices;
use snakes_core::Engine;
use snakes_core::evolve::RunPlan;
use snakes_lab::run::caught;

use lane::{Lane, MAX_STEPS_PER_FRAME};
use playback::Playback;
use selection::Selection;
use staged_champion::StagedChampion;

/// Request to replace the champions on the stage. The sender of the request also sets the clock.
#[derive(Message, Debug, Clone)]
pub(super) struct Show {
    /// Champions to show, one per lane.
    pub champions: Vec<StagedChampion>,
    /// Relation between the lanes.
    pub mode: StageMode,
}

/// Relation between the lanes of the stage.
#[derive(Resource, Debug, Clone, PartialEq, Default)]
pub(super) enum StageMode {
    /// One snake alone.
    #[default]
    Solo,
    /// Several snakes side by side.
    Race,
    /// One snake in its own world, and copies in changed worlds, in the order of the changes.
    WhatIf {
        /// Plan of the next run before the first change.
        before: Box<RunPlan>,
        /// Plans of the changed lanes that are kept when another lane is added, from lane 1 on.
        beside: Vec<RunPlan>,
        /// Lane whose world the next run uses. If it is the one after the kept lanes, the next change replaces it.
        current: usize,
    },
    /// Snakes of one generation on the same stairs: the best, and others as ghosts.
    Generation {
        /// Number of the generation; the first is 1.
        number: u32,
        /// Number of snakes in the generation; the stage may show only some of them.
        size: u32,
    },
}

/// Maximum number of lanes side by side. More lanes could neither be distinguished nor simulated within a frame.
pub const MAX_LANES: usize = 10;
/// Maximum number of lanes of a what-if, including the original. More would leave no room for their labels.
pub const MAX_WHAT_IF_LANES: usize = 5;
/// Maximum number of snakes of a generation on the stage. A generation of 30 is shown completely, a larger one in part.
pub const MAX_GENERATION: usize = 40;
/// Gap between two lanes, in metres.
const GAP_M: f32 = 1.0;

impl Show {
    /// Creates a request to show one champion alone.
    pub fn solo(staged: StagedChampion) -> Self {
        Self { champions: vec![staged], mode: StageMode::Solo }
    }

    /// Creates a request to show champions side by side. A single champion is shown alone.
    pub fn race(champions: Vec<StagedChampion>) -> Self {
        let mode = if champions.len() > 1 { StageMode::Race } else { StageMode::Solo };
        Self { champions, mode }
    }
}

impl StageMode {
    /// Creates the mode of a what-if with one change, beside the original, for tests.
    #[cfg(test)]
    pub fn what_if(before: RunPlan) -> Self {
        Self::WhatIf { before: Box::new(before), beside: Vec::new(), current: 1 }
    }

    /// Returns whether the latest lane of a what-if can be kept while another one is added.
    pub fn can_try_another(&self) -> bool {
        let Self::WhatIf { beside, current, .. } = self else { return false };
        *current > beside.len() && current + 1 < MAX_WHAT_IF_LANES
    }
}

/// Returns all indices below `count` if they are at most `most`; otherwise `few` of them, evenly spaced from the first to the last.
pub(super) fn evenly(count: usize, most: usize, few: usize) -> impl Iterator<Item = usize> {
    let chosen = if count <= most { count } else { few };
    (0..chosen).map(move |index| index * (count - 1) / (chosen - 1).max(1))
}

pub(super) fn plugin(app: &mut App) {
    app.add_message::<Show>()
        .init_resource::<Playback>()
        .init_resource::<StageMode>()
        .add_systems(Startup, show_opening)
        .add_systems(Update, (put_on_stage, advance).chain().in_set(FrameSet::Advance));
}

/// Returns the end of the longest lane, in simulated seconds.
pub(super) fn end_s<'a>(lanes: impl IntoIterator<Item = &'a Lane>) -> f64 {
    lanes.into_iter().map(Lane::end_s).fold(0.0, f64::max)
}

/// Builds lanes for champions, the first one nearest to the default camera, and reuses the computed steps of earlier lanes.
/// In a generation, all but the first are ghosts in its place.
///
/// # Errors
/// Returns beside the lanes a message for each champion that cannot be shown, with the reason.
pub(super) fn lanes(
    champions: Vec<StagedChampion>,
    mode: &StageMode,
    earlier: &mut [Mut<Lane>],
) -> (Vec<Lane>, Vec<String>) {
    let is_generation = matches!(mode, StageMode::Generation { .. });
    let mut problems = Vec::new();
    let mut lanes: Vec<Lane> = Vec::new();
    for staged in champions {
        let name = staged.name().to_owned();
        let number = lanes.len();
        let same = earlier.iter_mut().find(|lane| lane.number == number && lane.suits(&staged));
        let built = staged.check().map_err(|invalid| invalid.to_string()).and_then(|()| {
            caught(|| match (same, lanes.first()) {
                (_, Some(_)) if is_generation => Lane::ghost(staged, number),
                (Some(same), _) => same.renewed(),
                (None, Some(original)) => Lane::new(staged, number).after_change(original),
                (None, None) => Lane::new(staged, number),
            })
            .map_err(|message| format!("its simulation failed: {message}"))
        });
        match built {
            Ok(lane) => lanes.push(lane),
            Err(reason) => problems.push(format!("{name} cannot be shown: {reason}.")),
        }
    }
    let width_m = |lane: &Lane| lane.body.width_m().max(lane.trial().stairs.width_m);
    let beside_m = lanes.iter().map(width_m).fold(0.0, f32::max) + GAP_M;
    let spacing_m = if is_generation { 0.0 } else { beside_m };
    let middle = (lanes.len().saturating_sub(1)) as f32 / 2.0;
    for lane in &mut lanes {
        lane.offset_x_m = (middle - lane.number as f32) * spacing_m;
    }
    (lanes, problems)
}

/// Shows the champions with which the studio was opened.
fn show_opening(
    opening: Res<OpeningChampions>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    let champions = (0..opening.0.len()).filter_map(|index| opening.staged(index));
    show.write(Show::race(champions.take(MAX_LANES).collect()));
    let left_out = opening.0.len().saturating_sub(MAX_LANES);
    if left_out > 0 {
        notices.info(format!(
            "The stage has room for {MAX_LANES} snakes; {left_out} more are listed in the Champions panel."
        ));
    }
}

/// Replaces the lanes of the stage.
fn put_on_stage(
    mut requests: MessageReader<Show>,
    mut earlier: Query<(Entity, &mut Lane)>,
    mut commands: Commands,
    mut notices: ResMut<Notices>,
    mut on_stage: ResMut<StageMode>,
) {
    // If there are several requests in a frame, only the last one would be visible.
    let Some(Show { champions, mode }) = requests.read().last().cloned() else { return };
    champions.iter().for_each(|staged| explain_other_engine(staged, &mut notices));
    let (entities, mut earlier): (Vec<Entity>, Vec<Mut<Lane>>) = earlier.iter_mut().unzip();
    let (lanes, problems) = lanes(champions, &mode, &mut earlier);
    problems.into_iter().for_each(|problem| notices.problem(problem));
    if lanes.is_empty() {
        // If none of the new lanes can be built, the earlier ones stay.
        return;
    }
    let mut outdated: Vec<(Entity, Mut<Lane>)> = entities.into_iter().zip(earlier).collect();
    *on_stage = if lanes.len() > 1 { mode } else { StageMode::Solo };
    for lane in lanes {
        // In a what-if, the unchanged lanes stay on the stage.
        let stays = matches!(*on_stage, StageMode::WhatIf { .. });
        match outdated.iter().position(|(_, earlier)| stays && earlier.is_like(&lane)) {
            Some(index) => *outdated.swap_remove(index).1 = lane,
            None => {
                commands.spawn(placed(lane));
            }
        }
    }
    outdated.into_iter().for_each(|(lane, _)| commands.entity(lane).despawn());
}

/// Returns the components of a lane at its offset.
pub(super) fn placed(lane: Lane) -> impl Bundle {
    (Transform::from_translation(lane.offset()), Visibility::default(), lane)
}

/// Advances the clock, and brings every lane to the clock's time.
fn advance(
    mut lanes: Query<(Entity, &mut Lane)>,
    mut playback: ResMut<Playback>,
    selection: Option<Res<Selection>>,
    time: Res<Time<Real>>,
    mut notices: ResMut<Notices>,
) {
    // The physics steps of a frame are divided among the lanes.
    let most_steps = MAX_STEPS_PER_FRAME / (lanes.iter().len() as u32).max(1);
    let steps_per_s: f64 = lanes.iter().map(|(_, lane)| lane.step_s.recip()).sum();
    let end_s = end_s(lanes.iter().map(|(_, lane)| lane));
    if steps_per_s == 0.0 {
        return;
    }
    if selection.as_ref().is_some_and(|of| of.held.is_some_and(|held| held.is_pulling)) {
        playback.is_playing = true;
    }
    let are_several = lanes.iter().filter(|(_, lane)| !lane.is_ghost).nth(1).is_some();
    let rest_s = if are_several { playback::REST_OF_SEVERAL_S } else { playback::REST_S };
    let most_s = f64::from(MAX_STEPS_PER_FRAME) / steps_per_s;
    playback.pass(time.delta_secs(), most_s, end_s, rest_s);
    for (entity, mut lane) in &mut lanes {
        let pull = selection.as_ref().and_then(|selection| selection.pull_on(entity));
        let failed = lane.show(playback.time_s(), pull, most_steps).err();
        notices.problems(failed.map(|message| format!("The simulation failed: {message}")));
        lane.lookahead.poll();
        if lane.has_just_ended() {
            notices.problems(differs_from_record(&lane));
        }
    }
}

/// Returns a message if an undisturbed replay does not end as recorded.
fn differs_from_record(lane: &Lane) -> Option<String> {
    let recorded = lane.staged.champion().evaluation;
    let mut seen = lane.evaluation();
    if lane.trial().repeats.trials > 1 {
        // The stage shows a single trial, which cannot be compared with the mean over several repeats.
        seen.fitness = recorded.fitness;
    }
    let differs = lane.staged.must_match_record() && !seen.agrees_with(&recorded);
    differs.then(|| {
        format!(
            "This replay differs from its record ({:.2} instead of {:.2}): the file was \
             edited, or this machine computes different results (see snakes verify).",
            lane.evaluation().fitness,
            recorded.fitness,
        )
    })
}

/// Tells the user that a champion is from another engine version, and what that means for its display.
fn explain_other_engine(staged: &StagedChampion, notices: &mut Notices) {
    let Some(engine) = staged.other_engine() else { return };
    let text = if staged.recording().is_some() {
        "Its recording is shown; \"Simulate again\" simulates it with this engine."
    } else {
        "It is simulated again, so its motion may differ."
    };
    notices.info(format!(
        "This champion was found with engine {engine}; this is engine {}. {text}",
        Engine::THIS
    ));
}

#[cfg(test)]
mod tests;
