//! Shows the progress of evolution on the stage: each better generation of the current run, or a story of some of them.
//!
//! Any other command to the stage ends the following, so that the user's own choice stays.

use std::time::Duration;

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use super::milestones::Milestone;
use crate::studio::commands::{Command, StageCommand};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::{Show, end_s, evenly};
use crate::studio::ui::notifications::Notices;

/// Determines which generation of the current run the stage shows.
#[derive(Resource, Debug, Clone, Default)]
pub(crate) struct Following {
    plan: FollowPlan,
    /// Whether the run began since the program started and its first generation is still to be shown.
    is_new: bool,
    /// Whether the playback is held at its start until the first generation is finished.
    pub holds: bool,
    /// Whether nothing else is shown for now, because the user is choosing what to do with the snake on the stage.
    pub is_held: bool,
    /// Number of the run that is followed.
    run: u32,
    /// Whether a story is repeated after its end. This does not change what the stage shows.
    pub repeats: bool,
    /// Whether the best snake of the shown generation lands. It stays until all its snakes have ended, so that the landing can be watched.
    is_landing: bool,
    /// Generation that the stage shows, if any.
    shown: Option<u32>,
    /// Latest generation that the stage showed or a message announced.
    announced: u32,
    /// Real time for which the shown generation has been played.
    shown_for: Duration,
}

/// Generations of the run that the stage shows next.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
enum FollowPlan {
    /// There is no plan: the user's choice stays on the stage.
    #[default]
    Nothing,
    /// Show each generation that is better than all earlier ones.
    Evolution,
    /// Show these generations in turn; `next` is the index of the next one.
    Story { generations: Vec<u32>, next: usize },
}

/// Minimum time for which a generation is played before a better one replaces it.
const LEAST_SHOWN: Duration = Duration::from_secs(8);
/// Time for which each part of a story is played, unless all its snakes end earlier.
const STORY_PART: Duration = Duration::from_secs(12);
/// Maximum number of generations in a story: the first, a middle one and the latest.
const STORY_PARTS: usize = 3;

impl Following {
    /// Follows the first run from its first generation on. The playback is held until that generation is finished.
    pub fn from_start() -> Self {
        let plan = FollowPlan::Evolution;
        Self { plan, is_new: true, holds: true, ..Self::default() }
    }

    /// Returns whether better generations are shown automatically.
    pub fn follows_evolution(&self) -> bool {
        self.plan == FollowPlan::Evolution
    }

    /// Returns whether better generations are shown automatically, for a check box; `None` after the end of the run, which finds no better
    /// ones.
    pub fn offered(&self, run: &CurrentRun) -> Option<bool> {
        (run.status() != RunStatus::Finished).then(|| self.follows_evolution())
    }

    /// Returns the number of the story's part on the stage, from 1, and the number of parts; `None` without a story.
    pub fn story_part(&self) -> Option<(usize, usize)> {
        let FollowPlan::Story { generations, next } = &self.plan else { return None };
        Some((*next, generations.len()))
    }

    /// Shows each better generation from now on, beginning with the latest of them.
    pub fn follow_evolution(&mut self) {
        (self.plan, self.shown) = (FollowPlan::Evolution, None);
        (self.is_new, self.is_landing) = (false, false);
    }

    /// Stops following, so that the user's choice stays on the stage.
    pub fn stop(&mut self) {
        (self.plan, self.holds) = (FollowPlan::Nothing, false);
    }

    /// Follows again what an earlier scene followed, unless another run has begun since. No generation is announced twice.
    pub fn restore(&mut self, earlier: Self) {
        if earlier.run == self.run {
            *self = Self { announced: self.announced, repeats: self.repeats, ..earlier };
        }
    }

    /// Shows the first, a middle and the latest of the better generations in turn.
    ///
    /// # Errors
    /// There are fewer than two better generations; the error is a sentence for the user.
    pub fn tell_story(&mut self, run: &CurrentRun) -> Result<(), String> {
        let milestones = &run.milestones;
        if milestones.len() < 2 {
            return Err(
                "There is no story yet: it begins once a later generation beats the first."
                    .to_owned(),
            );
        }
        let chosen = evenly(milestones.len(), STORY_PARTS, STORY_PARTS);
        let generations = chosen.map(|index| milestones[index].generation).collect();
        (self.plan, self.holds) = (FollowPlan::Story { generations, next: 0 }, false);
        Ok(())
    }

    /// Returns the generation to show next, if it is time for another one. `is_over` tells whether all snakes on the
    /// stage have ended.
    fn due(&mut self, run: &CurrentRun, is_over: bool) -> Option<u32> {
        match &mut self.plan {
            FollowPlan::Nothing => None,
            FollowPlan::Evolution => {
                let milestones = &run.milestones;
                let next = match self.shown {
                    // A new run is shown from its first generation on, even if better ones follow quickly.
                    None => {
                        let begins =
                            milestones.iter().find(|first| self.is_new && first.is_whole());
                        begins.or(milestones.last())?
                    }
                    Some(_) if !is_over && (self.is_landing || self.shown_for < LEAST_SHOWN) => {
                        return None;
                    }
                    Some(shown) => next_of(milestones, shown)?,
                };
                self.is_new = false;
                self.is_landing = next.is_landed;
                Some(next.generation)
            }
            FollowPlan::Story { generations, next } => {
                let is_first = *next == 0;
                if !(is_first || is_over || self.shown_for >= STORY_PART) {
                    return None;
                }
                if let Some(generation) = generations.get(*next).copied() {
                    *next += 1;
                    return Some(generation);
                }
                self.plan = FollowPlan::Nothing;
                // The repeated story includes the generations that were better meanwhile.
                let begins_again = self.repeats && self.tell_story(run).is_ok();
                if begins_again { self.due(run, is_over) } else { None }
            }
        }
    }
}

/// Returns the milestone to show after that of generation `shown`. If several were found meanwhile, this is the one
/// half way to the latest, or to the first landing.
fn next_of(milestones: &[Milestone], shown: u32) -> Option<&Milestone> {
    let begin = milestones.partition_point(|milestone| milestone.generation <= shown);
    let left = milestones.get(begin..)?;
    let landing = left.iter().position(|milestone| milestone.is_landed);
    let left = &left[..landing.map_or(left.len(), |landing| landing + 1)];
    left.get(left.len().saturating_sub(1) / 2)
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Following>()
        .add_systems(Startup, await_first)
        .add_systems(Update, (follow, announce).chain().in_set(FrameSet::TakeIn));
}

/// Holds the playback at its start until the first generation is finished.
fn await_first(following: Res<Following>, mut playback: ResMut<Playback>) {
    if following.holds {
        playback.hold_at(0.0);
    }
}

/// Shows the generation that is due on the stage.
fn follow(
    mut following: ResMut<Following>,
    run: Res<CurrentRun>,
    mut playback: ResMut<Playback>,
    lanes: Query<&Lane>,
    time: Res<Time<Real>>,
    mut show: MessageWriter<Show>,
) {
    if run.is_lent {
        // A lesson uses the stage.
        return;
    }
    if following.run != run.number {
        // The user has begun another run, which is followed from its first generation on.
        (following.run, following.announced) = (run.number, 0);
        following.follow_evolution();
        following.is_new = true;
        playback.restart();
    }
    if following.holds && (playback.is_playing || run.status() != RunStatus::Running) {
        // The user plays the present champion, or evolution is not running.
        following.holds = false;
        if !playback.is_playing {
            playback.restart();
        }
    }
    if playback.is_playing {
        following.shown_for += time.delta();
    } else if !following.holds {
        // The user is looking at the paused stage.
        return;
    }
    if following.is_held || lanes.iter().any(|lane| lane.replay.is_disturbed()) {
        return;
    }
    let is_over = playback.time_s() > 0.0 && playback.time_s() >= end_s(lanes);
    let Some(generation) = following.due(&run, is_over) else { return };
    following.shown = Some(generation);
    following.announced = following.announced.max(generation);
    following.shown_for = Duration::ZERO;
    following.holds = false;
    if let Some(generation) = run.whole_generation(generation) {
        playback.restart();
        show.write(generation);
    }
}

/// Announces a generation that is better than all earlier ones, unless the stage shows better ones automatically.
fn announce(mut following: ResMut<Following>, run: Res<CurrentRun>, mut notices: ResMut<Notices>) {
    let Some(latest) = run.milestones.last() else { return };
    if following.follows_evolution() || latest.generation <= following.announced {
        return;
    }
    following.announced = latest.generation;
    // A generation without kept snakes was finished before the program started, or is of a run whose stairs evolve.
    if let Some(best) = run.champion_of(latest.generation).filter(|_| latest.is_whole()) {
        let generation = latest.generation;
        let text = format!("Generation {generation} is the best so far: {}", best.reached());
        let show = Command::Stage(StageCommand::ShowGeneration(Some(generation)));
        notices.offer("best", text, [("Show it", show)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{explored_run, landed_run, prepared_run};
    use std::sync::Arc;

    #[test]
    fn a_new_run_is_shown_from_its_first_generation_and_then_from_the_latest() {
        let run = explored_run();
        let [first, .., last] = &run.milestones[..] else { panic!("two better generations") };
        let (first, last) = (first.generation, last.generation);
        let mut following = Following::from_start();
        assert_eq!(following.due(&prepared_run(), false), None, "nothing is finished");
        assert_eq!(following.due(&run, false), Some(first));
        (following.shown, following.shown_for) = (Some(first), Duration::ZERO);
        assert_eq!(following.due(&run, false), None, "the first has only just come");
        following.shown_for = LEAST_SHOWN;
        assert_eq!(following.due(&run, false), Some(last));
        (following.shown, following.shown_for) = (Some(last), LEAST_SHOWN);
        assert_eq!(following.due(&run, true), None, "nothing better");
        following.follow_evolution();
        assert_eq!(following.due(&run, false), Some(last), "the user asked to see where it is");
        following = Following::from_start();
        following.stop();
        assert_eq!((following.due(&run, true), following.holds), (None, false), "what was chosen");
    }

    #[test]
    fn a4_the_first_landing_is_watched_to_its_end_and_evolution_is_followed_on() {
        let run = landed_run();
        let mut following = Following::from_start();
        let landing = run.milestones.iter().find(|of| of.is_landed).expect("it lands").generation;
        while let Some(generation) = following.due(&run, true) {
            following.shown = Some(generation);
            if generation == landing {
                following.shown_for = LEAST_SHOWN;
                assert_eq!(following.due(&run, false), None, "it is not over");
            }
        }
        assert!(following.follows_evolution(), "nobody ended it");
        let last = run.milestones.last().map(|last| last.generation);
        assert_eq!(following.shown, last, "the best of all");
    }

    #[test]
    fn following_evolution_is_offered_until_the_run_is_finished() {
        let (mut run, mut following) = (explored_run(), Following::from_start());
        assert_eq!(following.offered(&run), Some(true));
        following.stop();
        assert_eq!(following.offered(&run), Some(false));
        run.run_hash = Some(1);
        following.follow_evolution();
        assert_eq!(following.offered(&run), None);
        assert!(following.due(&run, true).is_some(), "the best one still comes onto the stage");
    }

    #[test]
    fn of_many_better_generations_some_are_shown_and_the_first_landing_always() {
        let milestone = |generation, is_landed| Milestone {
            generation,
            stairs_m: 5.0,
            fitness: generation as f32,
            is_landed,
            members: Arc::default(),
            size: 0,
        };
        let found: Vec<Milestone> =
            [1, 2, 3, 5, 6, 9].map(|generation| milestone(generation, generation >= 6)).into();
        let mut shown = vec![1];
        while let Some(next) = next_of(&found, shown[shown.len() - 1]) {
            shown.push(next.generation);
            if next.is_landed {
                break;
            }
        }
        assert_eq!(shown, [1, 3, 5, 6]);
        assert!(next_of(&found, 9).is_none());
    }

    #[test]
    fn a_generation_is_announced_once_even_if_an_earlier_scene_comes_back() {
        let mut app = App::new();
        app.insert_resource(explored_run())
            .init_resource::<Following>()
            .init_resource::<Notices>()
            .add_systems(Update, announce);
        let earlier = app.world().resource::<Following>().clone();
        app.update();
        assert_eq!(app.world().resource::<Notices>().len(), 1);
        app.insert_resource(Notices::default());
        app.world_mut().resource_mut::<Following>().restore(earlier);
        app.update();
        assert_eq!(app.world().resource::<Notices>().len(), 0, "it was announced before");
    }

    #[test]
    fn while_a_menu_is_open_the_stage_keeps_its_snakes() {
        let mut app = App::new();
        let mut playback = Playback::default();
        playback.is_playing = true;
        app.add_message::<Show>()
            .insert_resource(explored_run())
            .insert_resource(Following::from_start())
            .insert_resource(playback)
            .init_resource::<Time<Real>>()
            .add_systems(Update, follow);
        let mut shown = |is_held| {
            app.world_mut().resource_mut::<Following>().is_held = is_held;
            app.update();
            app.world_mut().resource_mut::<Messages<Show>>().drain().count()
        };
        assert_eq!([shown(true), shown(true), shown(false), shown(false)], [0, 0, 1, 0]);
    }

    #[test]
    fn a_story_shows_first_and_latest_in_turn_and_ends() {
        let run = explored_run();
        let mut following = Following::default();
        assert!(following.tell_story(&prepared_run()).is_err());
        following.tell_story(&run).expect("two better generations");
        let parts = following.story_part().expect("a story").1;
        let told: Vec<u32> = (0..parts).filter_map(|_| following.due(&run, true)).collect();
        assert_eq!(told.first(), run.milestones.first().map(|first| &first.generation));
        assert_eq!(told.last(), run.milestones.last().map(|last| &last.generation));
        assert_eq!(following.due(&run, true), None);
        assert_eq!(following.story_part(), None, "it is over");
    }

    #[test]
    fn a_repeated_story_begins_again_until_repeating_ends() {
        let run = explored_run();
        let mut following = Following { repeats: true, ..Following::default() };
        assert_eq!(following.due(&run, true), None, "what was chosen stays");
        following.tell_story(&run).expect("two better generations");
        let parts = following.story_part().expect("a story").1;
        let told: Vec<_> = (0..2 * parts).map(|_| following.due(&run, true)).collect();
        assert!(told[0].is_some());
        assert_eq!(told[..parts], told[parts..]);
        following.repeats = false;
        let left: Vec<_> = (0..=parts).map(|_| following.due(&run, true)).collect();
        assert_eq!(left.last(), Some(&None), "it ends");
        following.repeats = true;
        assert_eq!(following.due(&run, true), None, "it stays over");
    }
}
