//! The stage: its lanes, side by side, and what they show together: a replay, a race, or a what-if.

use bevy::prelude::*;

use super::exhibit::Exhibit;
use super::hands::Hands;
use super::lane::{Lane, MOST_STEPS_A_FRAME};
use super::notice::Notices;
use super::performance::Context;
use super::playback::Playback;
use super::{Frame, Opening};
use crate::ENGINE_VERSION;
use crate::evolve::RunPlan;
use crate::run::caught;

/// Asks for exhibits to be put on the stage, in place of what is there. Whoever asks sets the clock.
#[derive(Message, Debug, Clone)]
pub(super) struct Show {
    /// Lane by lane.
    pub exhibits: Vec<Exhibit>,
    /// What they show together.
    pub programme: Programme,
}

/// What the lanes show together.
#[derive(Resource, Debug, Clone, PartialEq, Default)]
pub(super) enum Programme {
    /// One snake.
    #[default]
    Solo,
    /// Several, side by side.
    Race,
    /// The same snake as it is, and in another world.
    WhatIf {
        /// The plan of the next run before anything was changed.
        before: Box<RunPlan>,
    },
}

/// The most lanes that can be told apart, and simulated within a frame.
pub const MOST_LANES: usize = 10;
/// Between two lanes, in metres.
const GAP_M: f32 = 1.0;

impl Show {
    /// One exhibit alone.
    pub fn solo(exhibit: Exhibit) -> Self {
        Self { exhibits: vec![exhibit], programme: Programme::Solo }
    }

    /// Several side by side; one is alone.
    pub fn race(exhibits: Vec<Exhibit>) -> Self {
        let programme = if exhibits.len() > 1 { Programme::Race } else { Programme::Solo };
        Self { exhibits, programme }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_message::<Show>()
        .init_resource::<Playback>()
        .init_resource::<Programme>()
        .add_systems(Startup, show_opening)
        .add_systems(Update, (put_on_stage, advance).chain().in_set(Frame::Advance));
}

/// When the last lane ends, in simulated seconds.
pub(super) fn end_s<'a>(lanes: impl IntoIterator<Item = &'a Lane>) -> f64 {
    lanes.into_iter().map(Lane::end_s).fold(0.0, f64::max)
}

/// Lanes for exhibits, the first one nearest to the usual camera.
///
/// # Errors
/// For each exhibit that cannot be shown, its name and the reason.
pub(super) fn lanes(exhibits: Vec<Exhibit>) -> (Vec<Lane>, Vec<String>) {
    let mut problems = Vec::new();
    let mut lanes = Vec::new();
    for exhibit in exhibits {
        let name = exhibit.name().to_owned();
        let built = exhibit.check().map_err(|invalid| invalid.to_string()).and_then(|()| {
            caught(|| Lane::new(exhibit, lanes.len()))
                .map_err(|message| format!("the program failed on it: {message}"))
        });
        match built {
            Ok(lane) => lanes.push(lane),
            Err(reason) => problems.push(format!("{name} cannot be shown: {reason}.")),
        }
    }
    let width_m = |lane: &Lane| {
        let agent = &lane.trial().agent;
        let widest = (0..agent.limbs as usize).map(|limb| agent.limb_size_m(limb)[0]);
        widest.fold(lane.trial().stairs.width_m, f32::max)
    };
    let spacing_m = lanes.iter().map(width_m).fold(0.0, f32::max) + GAP_M;
    let middle = (lanes.len().saturating_sub(1)) as f32 / 2.0;
    let placed = lanes.into_iter().map(|lane| {
        let offset_m = (middle - lane.number() as f32) * spacing_m;
        lane.at_x(offset_m)
    });
    (placed.collect(), problems)
}

/// Puts the exhibits the studio opens with on the stage.
fn show_opening(
    opening: Res<Opening>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    let exhibits = (0..opening.0.len()).filter_map(|index| opening.exhibit(index));
    show.write(Show::race(exhibits.take(MOST_LANES).collect()));
    let left_out = opening.0.len().saturating_sub(MOST_LANES);
    if left_out > 0 {
        notices.news(format!(
            "The stage has room for {MOST_LANES} lanes; {left_out} more are in the list of champions."
        ));
    }
}

/// Replaces what is on the stage.
fn put_on_stage(
    mut asked: MessageReader<Show>,
    earlier: Query<Entity, With<Lane>>,
    mut commands: Commands,
    mut notices: ResMut<Notices>,
    mut on_stage: ResMut<Programme>,
) {
    // Of several requests in a frame only the last is seen.
    let Some(Show { exhibits, programme }) = asked.read().last().cloned() else { return };
    exhibits.iter().for_each(|exhibit| explain_other_engine(exhibit, &mut notices));
    let (lanes, problems) = lanes(exhibits);
    problems.into_iter().for_each(|problem| notices.problem(problem));
    if lanes.is_empty() {
        // What was on show is better than nothing.
        return;
    }
    earlier.iter().for_each(|lane| commands.entity(lane).despawn());
    *on_stage = if lanes.len() > 1 { programme } else { Programme::Solo };
    lanes.into_iter().for_each(|lane| spawn(&mut commands, lane));
}

/// Spawns a lane whose physics world lives in a context of its own.
fn spawn(commands: &mut Commands, mut lane: Lane) {
    let entity = commands.spawn_empty().id();
    let (mut simulation, mut colliders, mut joints, mut bodies) = Default::default();
    lane.move_in((&mut simulation, &mut colliders, &mut joints, &mut bodies));
    let place = Transform::from_translation(lane.offset());
    let drawn = (place, Visibility::default());
    commands.entity(entity).insert((simulation, colliders, joints, bodies, lane, drawn));
}

/// Lets time pass on the stage, and brings every lane to its moment.
fn advance(
    mut lanes: Query<(Entity, &mut Lane, Context)>,
    mut playback: ResMut<Playback>,
    hands: Option<Res<Hands>>,
    time: Res<Time<Real>>,
    mut notices: ResMut<Notices>,
) {
    let (mut steps_per_s, mut end_s) = (0.0, 0.0_f64);
    for (_, lane, _) in &lanes {
        steps_per_s += lane.step_s().recip();
        end_s = end_s.max(lane.end_s());
    }
    if steps_per_s == 0.0 {
        return;
    }
    playback.pass(time.delta_secs(), f64::from(MOST_STEPS_A_FRAME) / steps_per_s, end_s);
    for (entity, mut lane, (mut simulation, mut colliders, mut joints, mut bodies)) in &mut lanes {
        let context = (&mut *simulation, &mut *colliders, &mut *joints, &mut *bodies);
        let pull = hands.as_ref().and_then(|hands| hands.pull_on(entity));
        let failed = lane.show(playback.time_s(), pull, context).err();
        notices.problems(failed.map(|message| format!("The program failed on it: {message}")));
        lane.look_ahead();
        if lane.has_just_ended() {
            notices.problems(differs_from_record(&lane));
        }
    }
}

/// What there is to say if a replay does not end as it was recorded.
fn differs_from_record(lane: &Lane) -> Option<String> {
    let recorded = lane.exhibit().champion().evaluation;
    let mut seen = lane.evaluation();
    if lane.trial().repeats.trials > 1 {
        // Of several trials one is on show; what they scored together it cannot say.
        seen.fitness = recorded.fitness;
    }
    let differs = lane.exhibit().must_match_record() && !seen.agrees_with(&recorded);
    differs.then(|| {
        format!(
            "This replay differs from its record ({:.2} instead of {:.2}): the file was \
             edited, or this machine computes other bits (see snakes verify).",
            lane.evaluation().fitness,
            lane.exhibit().fitness(),
        )
    })
}

/// Says what is not to be taken for granted about an exhibit of another engine.
fn explain_other_engine(exhibit: &Exhibit, notices: &mut Notices) {
    let Some(engine) = exhibit.other_engine() else { return };
    let text = if exhibit.recording().is_some() {
        "you see what was recorded then. \"Simulate here\" shows what this engine makes of it."
    } else {
        "what you see is simulated anew, and may go another way than it did then."
    };
    notices.news(format!("Found by engine {engine}, this is engine {ENGINE_VERSION}: {text}"));
}

#[cfg(test)]
mod tests;
