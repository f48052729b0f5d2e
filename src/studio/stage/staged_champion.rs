//! A champion on the stage: its origin and the way in which it is shown.

use std::sync::Arc;

use snakes_core::Engine;
use snakes_core::check::Invalid;
use snakes_core::evolve::Champion;
use snakes_core::save::LoadedChampion;
use snakes_core::score::{Evaluation, Recording, Rollout, Trial};
use snakes_core::world::{BodyPlan, Discontinuity};

/// A champion on the stage, with its caption.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StagedChampion {
    champion: Champion,
    name: String,
    source: ChampionSource,
    /// Engine version that found the champion, and its recording, if it was another version than this program's.
    elsewhere: Option<(Engine, Option<Arc<Recording>>)>,
    shown_as: ShownAs,
}

/// Origin of a staged champion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ChampionSource {
    /// File with which the studio was opened, by its index; the first is 0.
    Opened(usize),
    /// Entry of the library, by the number of its place.
    Library(u64),
    /// Run since the start of the program, by its index; the first is 0. The champion's own origin has the generation.
    Run(u32),
    /// Lesson.
    Lesson,
    /// Editor of bodies.
    Edited,
}

/// World and engine in which a champion is shown.
#[derive(Debug, Clone, PartialEq)]
enum ShownAs {
    /// Shown in the champion's own world. A champion of another engine version plays from its recording, if it has one.
    Found,
    /// Simulated by this engine in the champion's own world.
    Simulated,
    /// Simulated by this engine in a changed world.
    Changed(Box<ChangedWorld>),
}

/// A world that differs from the one in which a champion was found.
#[derive(Debug, Clone, PartialEq)]
struct ChangedWorld {
    trial: Trial,
    /// Difference from the world in which the champion was found, in words.
    what_is_other: String,
    beginning: Beginning,
    /// Whether the world is a trial of the champion's exam rather than a change by the user.
    is_of_exam: bool,
}

/// Time from which a champion is shown in a changed world.
#[derive(Debug, Clone, PartialEq)]
enum Beginning {
    /// The world is changed from the start.
    Start,
    /// The world is changed from the start, because the champion's state at the time of the change does not fit the changed world.
    StartBecause(Discontinuity),
    /// The world is changed from this physics step on, with the champion's state at that step. Before it, this trial applies.
    Step(u32, Box<Trial>),
}

impl StagedChampion {
    /// Creates a staged champion from a file with which the studio was opened, with its index and name.
    pub fn from_file(loaded: &LoadedChampion, index: usize, name: &str) -> Self {
        let recording = loaded.recording.clone().map(Arc::new);
        Self {
            champion: loaded.champion.clone(),
            name: name.to_owned(),
            source: ChampionSource::Opened(index),
            elsewhere: (!loaded.is_of_this_engine()).then_some((loaded.engine, recording)),
            shown_as: ShownAs::Found,
        }
    }

    /// Creates a staged champion from the library, with the number of its place and its name.
    pub fn from_library(loaded: &LoadedChampion, place: u64, name: &str) -> Self {
        Self { source: ChampionSource::Library(place), ..Self::from_file(loaded, 0, name) }
    }

    /// Creates a staged champion from the run with this index since the start of the program.
    pub fn from_run(champion: &Champion, run: u32) -> Self {
        Self {
            champion: champion.clone(),
            name: format!("Generation {}", champion.origin.generation),
            source: ChampionSource::Run(run),
            elsewhere: None,
            shown_as: ShownAs::Found,
        }
    }

    /// Creates a staged champion for a lesson.
    pub fn from_lesson(champion: &Champion) -> Self {
        Self { source: ChampionSource::Lesson, ..Self::from_run(champion, 0) }
    }

    /// Creates a staged champion from a snake whose body was edited.
    pub fn from_edited(champion: &Champion) -> Self {
        Self { source: ChampionSource::Edited, ..Self::from_run(champion, 0) }
    }

    /// Returns the champion under another name.
    pub fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// Returns the champion in another world. The genome may not fit that world: see [`Self::check`].
    pub fn in_world(&self, trial: &Trial, what_is_other: String) -> Self {
        if *trial == self.champion.trial {
            return self.as_found();
        }
        self.changed(trial, what_is_other, Beginning::Start, false)
    }

    /// Returns the champion in another world from a state of its rollout on. The other world applies from the start if
    /// there is no state, or if the state does not fit that world.
    pub fn in_world_from(
        &self,
        moment: Option<&Rollout>,
        trial: &Trial,
        what_is_other: String,
    ) -> Self {
        let Some(moment) = moment else { return self.in_world(trial, what_is_other) };
        let beginning = match moment.can_continue(&self.champion.genome, trial) {
            Ok(()) => Beginning::Step(moment.step(), Box::new(self.trial().clone())),
            Err(reason) => Beginning::StartBecause(reason),
        };
        let is_own = *trial == self.champion.trial;
        let what = if is_own { "its own world".to_owned() } else { what_is_other };
        self.changed(trial, what, beginning, false)
    }

    fn changed(
        &self,
        trial: &Trial,
        what_is_other: String,
        beginning: Beginning,
        is_of_exam: bool,
    ) -> Self {
        let world = ChangedWorld { trial: trial.clone(), what_is_other, beginning, is_of_exam };
        Self { shown_as: ShownAs::Changed(Box::new(world)), ..self.clone() }
    }

    /// Returns the changed world in which the champion is shown, if it is shown in one.
    fn world(&self) -> Option<&ChangedWorld> {
        match &self.shown_as {
            ShownAs::Changed(world) => Some(world),
            ShownAs::Found | ShownAs::Simulated => None,
        }
    }

    /// Returns the champion in a trial of its exam. `stairs` describes the trial's stairs in words.
    pub fn on_stairs_of_exam(&self, trial: &Trial, stairs: String) -> Self {
        self.changed(trial, stairs, Beginning::Start, true)
    }

    /// Returns whether the champion is shown in a trial of its exam.
    pub fn is_on_stairs_of_exam(&self) -> bool {
        self.world().is_some_and(|world| world.is_of_exam)
    }

    /// Returns the champion in its present world, from the start.
    pub fn shown_from_start(&self) -> Self {
        let in_world = |of: &ChangedWorld| self.in_world(&of.trial, of.what_is_other.clone());
        self.world().map_or_else(|| self.clone(), in_world)
    }

    /// Returns the physics step at which the champion's world changes; `None` if it does not change after the start.
    pub fn changes_at_step(&self) -> Option<u32> {
        match self.world()?.beginning {
            Beginning::Step(step, _) => Some(step),
            Beginning::Start | Beginning::StartBecause(_) => None,
        }
    }

    /// Describes the time from which the champion's world is changed: "from 5.20 s on". Returns `None` if nothing has
    /// to be explained.
    pub fn beginning_in_words(&self) -> Option<String> {
        let world = self.world()?;
        match &world.beginning {
            Beginning::Start => None,
            Beginning::StartBecause(reason) => {
                Some(format!("from the start, because {}", reason.words()))
            }
            Beginning::Step(step, _) => {
                let time_s = f64::from(*step) / f64::from(world.trial.physics.steps_per_s);
                Some(format!("from {time_s:.2} s on"))
            }
        }
    }

    /// Returns the champion's rollout at the start. The champion must have passed [`Self::check`].
    pub fn rollout(&self) -> Rollout {
        let genome = &self.champion.genome;
        if let Some(world) = self.world()
            && let Beginning::Step(step, earlier) = &world.beginning
            // The state was checked against the changed world when the change was made.
            && let Ok(rollout) =
                Rollout::new(genome, earlier).changing_at(*step, genome, &world.trial)
        {
            return rollout;
        }
        Rollout::new(genome, self.trial())
    }

    /// Returns the result that the stage shows at the end: that of one trial, even where the record is the mean of several.
    pub fn shown_result(&self) -> Evaluation {
        let mut rollout = self.rollout();
        while rollout.advance() {}
        rollout.evaluation()
    }

    /// Continues the unchanged champion's rollout in the changed world. Returns `None` unless `original` is at the step of the change.
    pub fn continued_from(&self, original: Rollout) -> Option<Rollout> {
        let step = self.changes_at_step().filter(|step| *step == original.step())?;
        original.changing_at(step, &self.champion.genome, self.trial()).ok()
    }

    /// Checks that the genome fits the world in which the champion is shown.
    pub fn check(&self) -> Result<(), Invalid> {
        self.trial().check().map_err(|error| error.inside("trial"))?;
        self.trial().check_genome(&self.champion.genome).map_err(|error| error.inside("genome"))
    }

    /// Returns the champion in its own world.
    pub fn as_found(&self) -> Self {
        Self { shown_as: ShownAs::Found, ..self.clone() }
    }

    /// Returns the champion, simulated by this engine instead of played from a recording.
    pub fn simulated(&self) -> Self {
        let shown_as = match &self.shown_as {
            ShownAs::Found if self.recording().is_some() => ShownAs::Simulated,
            other => other.clone(),
        };
        Self { shown_as, ..self.clone() }
    }

    /// Returns whether the champion is shown in a changed world.
    pub fn is_changed(&self) -> bool {
        self.world().is_some()
    }

    /// Returns the recording to play instead of a simulation, if any.
    pub fn recording(&self) -> Option<&Arc<Recording>> {
        match (&self.shown_as, &self.elsewhere) {
            (ShownAs::Found, Some((_, recording))) => recording.as_ref(),
            _ => None,
        }
    }

    /// Returns the engine version that found the champion, if it was another version than this program's.
    pub fn other_engine(&self) -> Option<Engine> {
        self.elsewhere.as_ref().map(|(engine, _)| *engine)
    }

    /// Returns whether a simulation must end as recorded, because this engine version recorded it in the same world.
    pub fn must_match_record(&self) -> bool {
        self.elsewhere.is_none() && !self.is_changed()
    }

    /// Returns whether the champion is shown otherwise than as it was found, although that is possible.
    pub fn could_be_as_found(&self) -> bool {
        self.shown_as != ShownAs::Found
    }

    /// Returns the champion as it was found.
    pub fn champion(&self) -> &Champion {
        &self.champion
    }

    /// Returns the body that the genome builds in the world in which the champion is shown.
    pub fn body(&self) -> BodyPlan {
        self.trial().agent.body_plan(&self.champion.genome)
    }

    /// Returns the world in which the champion is shown.
    pub fn trial(&self) -> &Trial {
        self.world().map_or(&self.champion.trial, |world| &world.trial)
    }

    /// Returns the origin of the champion.
    pub fn source(&self) -> ChampionSource {
        self.source
    }

    /// Returns the champion's short name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns a label that distinguishes the champion from other lanes: its name, or the difference of its world.
    pub fn label(&self) -> &str {
        self.world().map_or(&self.name, |world| &world.what_is_other)
    }

    /// Describes the champion in one line, with the recorded result.
    pub fn caption(&self) -> String {
        let name = &self.name;
        let shown_as = match (self.world(), self.other_engine()) {
            // The recorded score describes a position in the champion's own world.
            (Some(world), _) => {
                let (what, score) = (&world.what_is_other, self.champion.score());
                return match self.beginning_in_words() {
                    _ if world.is_of_exam => {
                        format!("{name} on other stairs: {what} (on its own: {score})")
                    }
                    Some(beginning) => format!("What if: {what}, {beginning} ({name})"),
                    None => format!("{name} with a change: {what} (originally {score})"),
                };
            }
            (_, None) => ": ".to_owned(),
            (_, Some(engine)) if self.recording().is_some() => {
                format!(" as recorded by engine {engine}: ")
            }
            (_, Some(engine)) => format!(", simulated again; engine {engine} recorded "),
        };
        format!("{name}{shown_as}{}", self.champion.reached())
    }
}
