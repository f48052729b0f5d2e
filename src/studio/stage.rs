//! The stage: one rollout, or the recording of one, played in real time.
//!
//! Between frames the physics world lives in a bevy_rapier3d context, so that its debug drawing
//! sees the very bodies that are scored. To advance, the world is lent back to the rollout,
//! which takes whole constant steps; the frame only decides how many. What is drawn lies between the
//! last two steps.

use bevy::prelude::*;
use bevy_rapier3d::render::RapierDebugRenderPlugin;

use super::exhibit::Exhibit;
use super::notice::Notices;
use super::performance::{Context, Performance};
use super::{Frame, Opening};
use crate::ENGINE_VERSION;
use crate::run::caught;
use crate::score::{Evaluation, Trial};
use crate::world::Pose;

/// Asks for an exhibit to be put on the stage, in place of what is there.
#[derive(Message, Debug, Clone)]
pub(super) struct ShowExhibit(pub Exhibit);

/// An exhibit on show. Its entity carries the physics context.
#[derive(Component)]
pub(super) struct Stage {
    exhibit: Exhibit,
    performance: Performance,
    /// Poses before the last step, head first.
    before: Vec<Pose>,
    /// How much time has been shown beyond the last but one step, in seconds.
    owed_s: f32,
    step_s: f32,
    is_playing: bool,
    restart: bool,
    /// Whether it asked, having rested, to be shown once more.
    is_looping: bool,
    /// How long the end has been on show, in seconds.
    rested_s: f32,
    /// Whether the program failed on it: it stays as it was then.
    is_broken: bool,
    /// Whether the end was compared with what was recorded of the champion.
    is_checked: bool,
}

/// How long the end stays on show before the rollout starts again, in seconds.
const REST_S: f32 = 1.5;
/// The most time a single frame may make up for, in seconds. After a longer pause (a moved window, a
/// sleeping laptop) the stage goes on where it was instead of racing.
const MOST_CATCH_UP_S: f32 = 0.5;

pub(super) fn plugin(app: &mut App) {
    app.add_message::<ShowExhibit>()
        .add_plugins(RapierDebugRenderPlugin::default().disabled())
        .add_systems(Startup, show_opening)
        .add_systems(Update, (put_on_stage, advance).chain().in_set(Frame::Advance));
}

impl Stage {
    /// A stage at the start of the exhibit's performance.
    pub fn new(exhibit: Exhibit) -> Self {
        let performance = Performance::of(&exhibit);
        Self {
            before: performance.poses().to_vec(),
            step_s: exhibit.trial().physics.step_s(),
            performance,
            exhibit,
            owed_s: 0.0,
            is_playing: true,
            restart: false,
            is_looping: false,
            rested_s: 0.0,
            is_broken: false,
            is_checked: false,
        }
    }

    /// Goes to the end of the rollout at once. Returns the poses on the way at `moments` equal distances
    /// of time, the start first. The world must not have been lent out.
    pub fn skip_to_end(&mut self, moments: u32) -> Vec<Vec<Pose>> {
        let every = (self.trial().steps() / moments.max(1)).max(1);
        let mut seen = Vec::new();
        loop {
            if self.performance.step().is_multiple_of(every) && seen.len() < moments as usize {
                seen.push(self.performance.poses().to_vec());
            }
            if !self.performance.advance() {
                break;
            }
        }
        self.before.copy_from_slice(self.performance.poses());
        seen
    }

    /// What is on show.
    pub fn exhibit(&self) -> &Exhibit {
        &self.exhibit
    }

    /// The trial on show: the stairs to draw, the limbs' sizes.
    pub fn trial(&self) -> &Trial {
        self.exhibit.trial()
    }

    /// Simulated time of the last step, in seconds.
    pub fn time_s(&self) -> f32 {
        self.performance.step() as f32 * self.step_s
    }

    /// Length of the rollout, in simulated seconds.
    pub fn duration_s(&self) -> f32 {
        self.trial().duration_s
    }

    /// What there is to say of the rollout so far; at its end, the score.
    pub fn evaluation(&self) -> Evaluation {
        self.performance.evaluation(&self.exhibit)
    }

    /// Whether time passes on the stage.
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Holds or resumes.
    pub fn toggle_playback(&mut self) {
        self.is_playing = !self.is_playing;
    }

    /// Starts from the beginning with the next frame.
    pub fn ask_for_restart(&mut self) {
        self.restart = true;
    }

    /// The limbs' poses between the last two steps, head first: where to draw them.
    pub fn drawn_poses(&self) -> impl Iterator<Item = Pose> + '_ {
        let share = (self.owed_s / self.step_s).clamp(0.0, 1.0);
        let pairs = self.before.iter().zip(self.performance.poses());
        pairs.map(move |(before, after)| before.lerp(after, share))
    }

    /// Lets `elapsed_s` of real time pass: takes as many whole steps as fit. The world must have been
    /// lent to the rollout.
    fn pass(&mut self, elapsed_s: f32) {
        self.owed_s += elapsed_s.min(MOST_CATCH_UP_S);
        while self.owed_s >= self.step_s && !self.performance.is_over() {
            self.owed_s -= self.step_s;
            self.before.copy_from_slice(self.performance.poses());
            self.performance.advance();
        }
        if self.performance.is_over() {
            self.owed_s = self.step_s;
            self.rested_s += elapsed_s;
        }
    }
}

/// Puts the exhibit the studio opens with on the stage.
fn show_opening(opening: Res<Opening>, mut show: MessageWriter<ShowExhibit>) {
    show.write(ShowExhibit(Exhibit::saved(&opening.0)));
}

/// Replaces what is on the stage.
fn put_on_stage(
    mut asked: MessageReader<ShowExhibit>,
    stages: Query<(Entity, &Stage)>,
    mut commands: Commands,
    mut notices: ResMut<Notices>,
) {
    // Of several requests in a frame only the last is seen.
    let Some(ShowExhibit(exhibit)) = asked.read().last() else { return };
    let stage = caught(|| Stage::new(exhibit.clone()));
    let mut stage = match stage {
        Ok(stage) => stage,
        Err(message) => return notices.problem(format!("The program failed on it: {message}")),
    };
    if !stages.iter().any(|(_, earlier)| earlier.is_looping) {
        explain_other_engine(exhibit, &mut notices);
    }
    for (entity, earlier) in &stages {
        // Who holds the stage in the very moment in which it begins again still wants it held.
        stage.is_playing &= earlier.is_playing || !earlier.is_looping;
        commands.entity(entity).despawn();
    }
    spawn(&mut commands, stage);
}

/// Spawns a stage whose physics world lives in a context of its own.
fn spawn(commands: &mut Commands, mut stage: Stage) {
    let entity = commands.spawn_empty().id();
    let (mut simulation, mut colliders, mut joints, mut bodies) = Default::default();
    stage.performance.own(entity);
    stage.performance.exchange((&mut simulation, &mut colliders, &mut joints, &mut bodies));
    commands.entity(entity).insert((simulation, colliders, joints, bodies, stage));
}

/// Lets time pass on the stage.
fn advance(
    mut stages: Query<(&mut Stage, Context)>,
    time: Res<Time<Real>>,
    mut show: MessageWriter<ShowExhibit>,
    mut notices: ResMut<Notices>,
) {
    for (mut stage, (mut simulation, mut colliders, mut joints, mut bodies)) in &mut stages {
        if stage.restart || stage.rested_s > REST_S {
            stage.is_looping = !stage.restart;
            show.write(ShowExhibit(stage.exhibit.clone()));
            stage.restart = false;
            stage.rested_s = 0.0;
            continue;
        }
        if stage.is_playing && !stage.is_broken {
            let mut lend = |stage: &mut Stage| {
                let context = (&mut *simulation, &mut *colliders, &mut *joints, &mut *bodies);
                stage.performance.exchange(context);
            };
            lend(&mut stage);
            if let Err(message) = caught(|| stage.pass(time.delta_secs())) {
                stage.is_broken = true;
                notices.problem(format!("The program failed on it: {message}"));
            }
            lend(&mut stage);
        }
        if stage.performance.is_over() && !stage.is_checked {
            stage.is_checked = true;
            let recorded = stage.exhibit.champion().evaluation;
            let mut seen = stage.evaluation();
            if stage.trial().repeats.trials > 1 {
                // Of several trials one is on show; what they scored together it cannot say.
                seen.fitness = recorded.fitness;
            }
            let differs = !seen.agrees_with(&recorded);
            if stage.exhibit.must_match_record() && differs {
                notices.problem(format!(
                    "This replay differs from its record ({:.2} instead of {:.2}): the file was \
                     edited, or this machine computes other bits (see snakes verify).",
                    stage.evaluation().fitness,
                    stage.exhibit.fitness(),
                ));
            }
        }
    }
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
mod tests {
    use super::*;
    use crate::evolve::Champion;
    use crate::save::{LoadedChampion, shipped_champion};
    use crate::score::{Recording, evaluate};
    use bevy::time::TimeUpdateStrategy;
    use bevy_rapier3d::plugin::context::RapierRigidBodySet;
    use std::time::Duration;

    /// A stage without a window, whose frames last as long as `frames_s` says, in turn.
    fn play(frames_s: &[f32], until: impl Fn(&Stage) -> bool) -> App {
        play_loaded(shipped_champion().expect("well formed"), frames_s, until)
    }

    fn play_loaded(
        opening: LoadedChampion,
        frames_s: &[f32],
        until: impl Fn(&Stage) -> bool,
    ) -> App {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .add_message::<ShowExhibit>()
            .init_resource::<Notices>()
            .insert_resource(Opening(opening))
            .add_systems(Startup, show_opening)
            .add_systems(Update, (put_on_stage, advance).chain());
        for frame_s in frames_s.iter().cycle().take(10_000) {
            let length = Duration::from_secs_f32(*frame_s);
            app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
            app.update();
            let mut stages = app.world_mut().query::<&Stage>();
            if stages.iter(app.world()).any(&until) {
                return app;
            }
        }
        panic!("the stage never got there");
    }

    #[test]
    fn a_replay_on_the_stage_has_the_bits_of_the_headless_run_at_any_frame_rate() {
        let opening = shipped_champion().expect("well formed").champion;
        let headless = evaluate(&opening.genome, &opening.trial);
        for frames_s in [&[1.0 / 60.0][..], &[0.25], &[0.004, 0.1, 0.031]] {
            let mut app = play(frames_s, |stage| stage.performance.is_over());
            let mut stages = app.world_mut().query::<&Stage>();
            let stage = stages.single(app.world()).expect("one stage");
            assert_eq!(stage.evaluation(), headless, "with frames of {frames_s:?} s");
        }
    }

    #[test]
    fn a_stage_that_is_held_while_it_begins_again_stays_held() {
        let mut app = play(&[0.1], |stage| stage.is_looping);
        let mut stages = app.world_mut().query::<&mut Stage>();
        stages.single_mut(app.world_mut()).expect("one stage").toggle_playback();
        app.update();
        app.update();
        let stage = stages.single(app.world()).expect("one stage");
        assert!(!stage.is_playing() && stage.performance.step() == 0, "held at the start");
    }

    #[test]
    fn a_replay_that_differs_from_its_record_says_so_once() {
        let honest = shipped_champion().expect("well formed");
        let mut edited = honest.clone();
        edited.champion.genome.density_kg_m3 *= 1.2;
        for (loaded, notices) in [(honest, 0), (edited, 1)] {
            let mut app = play_loaded(loaded, &[0.1], |stage| stage.rested_s > 1.0);
            app.update();
            assert_eq!(app.world().resource::<Notices>().len(), notices);
        }
    }

    #[test]
    fn what_another_engine_found_is_played_from_its_recording_and_can_be_simulated() {
        let mut loaded = shipped_champion().expect("well formed");
        let Champion { genome, trial, .. } = &loaded.champion;
        let recording = Recording::of(genome, trial);
        // It went elsewhere then: a metre to the side.
        let aside = |pose: &Pose| Pose { translation: pose.translation + Vec3::X, ..*pose };
        let poses = recording.frames().flatten().map(aside).collect();
        loaded.recording = Recording::new(recording.every_steps(), recording.limbs(), poses);
        loaded.engine = 1;
        let last = loaded.recording.as_ref().expect("whole frames").at(1.0e9);
        let mut app = play_loaded(loaded.clone(), &[0.1], |stage| stage.rested_s > 1.0);
        assert_eq!(app.world().resource::<Notices>().len(), 1, "it says so, and finds no fault");
        let mut stages = app.world_mut().query::<&Stage>();
        let stage = stages.single(app.world()).expect("one stage");
        for (drawn, recorded) in stage.drawn_poses().zip(last) {
            assert!((drawn.translation - recorded.translation).length() < 1e-5);
        }
        assert!(stage.exhibit().caption().contains("as engine 1 recorded it"));
        let simulated = stage.exhibit().simulated();
        app.world_mut().write_message(ShowExhibit(simulated));
        for _ in 0..155 {
            app.update();
        }
        let stage = stages.single(app.world()).expect("one stage");
        assert_eq!(stage.evaluation().trace_hash, loaded.champion.evaluation.trace_hash);
        assert!(stage.exhibit().could_be_as_found());
    }

    #[test]
    fn between_frames_the_world_is_in_the_rapier_context() {
        let mut app = play(&[0.1], |stage| stage.performance.step() > 20);
        let mut contexts = app.world_mut().query::<(&Stage, &RapierRigidBodySet)>();
        let (stage, bodies) = contexts.single(app.world()).expect("one stage");
        assert_eq!(stage.performance.simulation().expect("simulated").physics().bodies.len(), 0);
        let simulation = stage.performance.simulation().expect("simulated");
        let in_context = simulation.limb_handles().iter();
        let poses: Vec<Pose> = in_context.map(|&limb| *bodies.bodies[limb].position()).collect();
        assert_eq!(poses, stage.performance.poses());
    }

    #[test]
    fn it_draws_between_the_last_two_steps() {
        let mut app = play(&[0.0251], |stage| stage.performance.step() > 60);
        let mut stages = app.world_mut().query::<&Stage>();
        let stage = stages.single(app.world()).expect("one stage");
        let (before, after) =
            (stage.before[0].translation.y, stage.performance.poses()[0].translation.y);
        let drawn = stage.drawn_poses().next().expect("a head").translation.y;
        assert!((after - before).abs() > 1e-4, "the head moves: {before} to {after}");
        let share = stage.owed_s / stage.step_s;
        assert!((0.1..0.9).contains(&share), "the frame ends {share} of the way through a step");
        let expected = before + (after - before) * share;
        assert!((drawn - expected).abs() < 1e-5, "{drawn} for {expected}");
    }
}
