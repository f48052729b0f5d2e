//! Editor of a snake's blocks: changes with undo, a preview beside the original, and tuning of the gait.

use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::current_run::CurrentRun;
use crate::studio::commands::{BlockSize, BodyCommand, Command};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::Show;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::Champion;
use snakes_core::genome::{BodyChange, ControllerKind, Genome, GenomeSpace, Segment};
use snakes_core::rng::{Purpose, stream};
use snakes_core::score::evaluate;
use snakes_core::world::BodyPlan;
use snakes_lab::run::{BackgroundTask, Tuned, caught, tune_controller};

/// Time between the last change of the body and its preview on the stage.
const PREVIEW_AFTER: Duration = Duration::from_millis(500);
/// Number of evaluations of one tuning.
const TUNING: usize = 60;
/// Maximum number of changes of the body that can be undone.
const MOST_STEPS: usize = 200;
/// Subject of messages about the edited body, which replace each other.
const SUBJECT: &str = "body editor";

/// Editor of one body at a time.
#[derive(Resource, Debug, Default)]
pub(crate) struct BodyEditor {
    edited: Option<Edited>,
}

/// A body that is being edited, with its history.
#[derive(Debug)]
struct Edited {
    /// Snake to whose body the changes apply.
    original: StagedChampion,
    genome: Genome,
    past: Vec<Genome>,
    future: Vec<Genome>,
    /// Number of a block that the last command set. Further changes of this number are part of the same undo step.
    last_set: Option<(usize, BlockSize)>,
    /// Edited snake as the stage last showed it.
    previewed: Option<StagedChampion>,
    /// Genome of the edited snake as it was last saved, if it was.
    saved: Option<Genome>,
    /// Time of the last change of the body, until its preview begins.
    changed_at: Option<Instant>,
    /// Evaluation of the edited snake for the preview, in progress.
    evaluation: Option<BackgroundTask<Result<Champion, String>>>,
    /// Evaluated snake that the stage does not show yet.
    ready: Option<Champion>,
    tuning: Option<BackgroundTask<Option<Tuned>>>,
    /// Number of tunings so far. Each tries other gaits.
    attempts: u32,
}

/// State of the edited body, for its panel.
#[derive(Debug)]
pub(crate) struct EditedBody<'a> {
    /// Blocks of the body as genes, from the head.
    pub segments: &'a [Segment],
    /// Body that the blocks form in the world of the original.
    pub body: BodyPlan,
    /// Snake to whose body the changes apply.
    pub original: &'a StagedChampion,
    /// Whether there is a change to undo, and one to redo.
    pub steps: [bool; 2],
    /// Whether the body was changed, and is not saved as it is now.
    pub is_unsaved: bool,
    /// Number of finished evaluations and of all evaluations of the tuning, if one is in progress.
    pub tuning: Option<[usize; 2]>,
    /// Reason why the body cannot be simulated, if there is one.
    pub problem: Option<String>,
}

impl BodyEditor {
    /// Returns the state of the body that is being edited, if any.
    pub fn edited(&self) -> Option<EditedBody<'_>> {
        let edited = self.edited.as_ref()?;
        Some(EditedBody {
            segments: &edited.genome.body.segments,
            body: edited.original.trial().agent.body_plan(&edited.genome),
            original: &edited.original,
            steps: [!edited.past.is_empty(), !edited.future.is_empty()],
            is_unsaved: !edited.past.is_empty() && edited.saved.as_ref() != Some(&edited.genome),
            tuning: edited.tuning.as_ref().map(|task| [task.done(), task.total()]),
            problem: edited.check().err(),
        })
    }

    /// Returns the reason why the body of a snake cannot be edited, if there is one.
    pub fn refusal(staged: &StagedChampion) -> Option<String> {
        own_blocks(staged).err()
    }

    /// Returns the edited snake, to save it.
    ///
    /// # Errors
    /// The body is not simulated yet, or cannot be simulated.
    pub fn to_save(&self) -> Result<StagedChampion, String> {
        let edited = self.edited.as_ref().ok_or("No body is being edited.")?;
        let previewed = edited.previewed.as_ref();
        let is_present = |of: &&StagedChampion| of.champion().genome == edited.genome;
        let missing = "The changed body is not simulated yet: save it in a moment.";
        Ok(previewed.filter(is_present).ok_or(missing)?.clone())
    }

    /// Notes that a snake of the stage was saved, which may be the edited one.
    pub fn note_saved(&mut self, staged: &StagedChampion) {
        let genome = &staged.champion().genome;
        if let Some(edited) = self.edited.as_mut().filter(|edited| edited.genome == *genome) {
            edited.saved = Some(genome.clone());
        }
    }

    /// Executes a command. The command to edit begins with the selected champion of the stage. Returns what to show on
    /// the stage, if anything.
    ///
    /// # Errors
    /// The command cannot be executed, for the returned reason.
    pub fn apply(
        &mut self,
        command: &BodyCommand,
        selected: Option<&StagedChampion>,
        run: &mut CurrentRun,
    ) -> Result<Option<Show>, String> {
        if *command == BodyCommand::Edit {
            self.edited = Some(Edited::of(selected.ok_or("There is no snake on the stage.")?)?);
            return Ok(None);
        }
        let Some(edited) = &mut self.edited else { return Ok(None) };
        match command {
            BodyCommand::CancelTuning => edited.tuning.iter().for_each(BackgroundTask::cancel),
            BodyCommand::Preview => return Ok(edited.show()),
            BodyCommand::Close => {
                edited.tuning.iter().for_each(BackgroundTask::cancel);
                let original = edited.original.clone();
                self.edited = None;
                return Ok(Some(Show::solo(original)));
            }
            _ if edited.tuning.is_some() => {
                return Err("The gait is being tuned: wait, or cancel it.".to_owned());
            }
            // The caller saves the snake, because it has the library.
            BodyCommand::Edit | BodyCommand::Save => {}
            BodyCommand::Set { block, size, value } => edited.set(*block, *size, *value),
            BodyCommand::MakeRigid { block } => {
                let rigid = edited.with_block(*block, |segment| segment.youngs_modulus_pa = None);
                rigid.into_iter().for_each(|genome| edited.replace(genome));
            }
            BodyCommand::Change { block, change } => edited.change(*block, *change)?,
            BodyCommand::Undo => edited.step(true),
            BodyCommand::Redo => edited.step(false),
            BodyCommand::Tune => edited.tune()?,
            BodyCommand::Evolve => {
                let mut champion = edited.unevaluated()?;
                // A world that was changed for the next run stays.
                let next = &run.next_settings().trial;
                if *next != run.settings().trial {
                    let unfit = |error| format!("The world of the next run does not fit: {error}");
                    next.check_genome(&champion.genome).map_err(unfit)?;
                    champion.trial = next.clone();
                }
                run.start_next_from(&champion, &format!("{}, edited", edited.original.name()))?;
                run.begin_next()?;
                self.edited = None;
            }
        }
        Ok(None)
    }

    /// Processes finished background work, and begins the preview of a change that is old enough. Returns whether a
    /// preview is ready.
    fn follow(&mut self, notices: &mut Notices) -> bool {
        let Some(edited) = &mut self.edited else { return false };
        edited.take_in_tuning(notices);
        if edited.changed_at.is_some_and(|at| at.elapsed() >= PREVIEW_AFTER) {
            edited.begin_preview(notices);
        }
        edited.take_in_preview(notices)
    }
}

/// Returns the genome of a snake with each of its blocks as genes.
///
/// # Errors
/// The snake's body cannot be edited, for the returned reason.
fn own_blocks(original: &StagedChampion) -> Result<Genome, String> {
    if let Some(engine) = original.other_engine() {
        return Err(format!(
            "Engine {engine} found this snake, and here it would move differently"
        ));
    }
    let genome = &original.champion().genome;
    original.trial().with_own_blocks(genome).map_err(|error| match genome.controller.kind() {
        ControllerKind::Wave | ControllerKind::Gait => format!(
            "In this snake's world, joints differ from one another, or joints or surfaces are soft, so no block can change \
             alone. If this snake is a copy in a comparison, Esc goes back to the original. ({error})"
        ),
        other => format!(
            "The controller of this snake, {}, cannot follow a changed body: only gaits and waves do",
            other.title().to_lowercase()
        ),
    })
}

impl Edited {
    /// Processes the result of a finished tuning.
    fn take_in_tuning(&mut self, notices: &mut Notices) {
        let Some(result) = BackgroundTask::take_result(&mut self.tuning) else { return };
        match result {
            Ok(Some(tuned)) => {
                let unit = self.original.trial().fitness.unit();
                let [before, after] = [tuned.before.fitness, tuned.evaluation.fitness];
                let text = format!("Adapted: fitness {before:.2}{unit} became {after:.2}{unit}.");
                notices.update(SUBJECT, text);
                if tuned.genome != self.genome {
                    self.replace(tuned.genome);
                }
            }
            Ok(None) => notices.problem("This body cannot be simulated.".to_owned()),
            Err(problem) => notices.problem(format!("The gait could not be adapted: {problem}")),
        }
    }

    /// Begins to evaluate the edited snake for its preview. An invalid body has no preview; the panel shows the reason.
    fn begin_preview(&mut self, notices: &mut Notices) {
        self.changed_at = None;
        // The next change is a separate undo step.
        self.last_set = None;
        self.ready = None;
        let Ok(champion) = self.unevaluated() else { return };
        let evaluated = move || {
            let evaluation = caught(|| evaluate(&champion.genome, &champion.trial))?;
            Ok(Champion { evaluation, ..champion })
        };
        match BackgroundTask::start(evaluated) {
            Ok(task) => self.evaluation = Some(task),
            Err(error) => notices.problem(format!("The preview could not start: {error}.")),
        }
    }

    /// Processes the result of a finished evaluation. Returns whether a preview is ready.
    fn take_in_preview(&mut self, notices: &mut Notices) -> bool {
        let Some(result) = BackgroundTask::take_result(&mut self.evaluation) else { return false };
        let failed = |reason| notices.problem(format!("This body cannot be simulated: {reason}"));
        self.ready = result.flatten().map_err(failed).ok();
        self.ready.is_some()
    }

    fn of(original: &StagedChampion) -> Result<Self, String> {
        Ok(Self {
            original: original.simulated(),
            genome: own_blocks(original)?,
            past: Vec::new(),
            future: Vec::new(),
            last_set: None,
            previewed: None,
            saved: None,
            changed_at: None,
            evaluation: None,
            ready: None,
            tuning: None,
            attempts: 0,
        })
    }

    /// Checks whether the body can be simulated.
    fn check(&self) -> Result<(), String> {
        Ok(self.original.trial().check_genome(&self.genome)?)
    }

    /// Replaces the genome, as a step that can be undone.
    fn replace(&mut self, genome: Genome) {
        self.past.push(std::mem::replace(&mut self.genome, genome));
        let too_many = self.past.len().saturating_sub(MOST_STEPS);
        self.past.drain(..too_many);
        self.future.clear();
        self.last_set = None;
        self.changed_at = Some(Instant::now());
    }

    fn set(&mut self, block: usize, size: BlockSize, value: f32) {
        let set = |segment: &mut Segment| *size.of_mut(segment) = value;
        let Some(genome) = self.with_block(block, set) else { return };
        if self.last_set == Some((block, size)) {
            self.genome = genome;
            self.changed_at = Some(Instant::now());
        } else {
            self.replace(genome);
            self.last_set = Some((block, size));
        }
    }

    /// Returns the genome with an edited block; `None` if nothing differs or there is no such block.
    fn with_block(&self, block: usize, edit: impl FnOnce(&mut Segment)) -> Option<Genome> {
        let mut genome = self.genome.clone();
        edit(genome.body.segments.get_mut(block)?);
        (genome != self.genome).then_some(genome)
    }

    fn change(&mut self, block: usize, change: BodyChange) -> Result<(), String> {
        let changed = changed_body(&self.genome, change, block).ok_or_else(|| {
            let limits = "2 to 12 blocks of 0.4 to 4 m and at most 12 m in all, and neighbours differ by a factor of 8 \
                          in mass and of 10 in inertia at most";
            format!("Not possible here: a body that evolves has {limits}.")
        })?;
        self.replace(changed);
        Ok(())
    }

    fn step(&mut self, is_back: bool) {
        let (mut from, mut to) = (&mut self.past, &mut self.future);
        if !is_back {
            std::mem::swap(&mut from, &mut to);
        }
        if let Some(genome) = from.pop() {
            to.push(std::mem::replace(&mut self.genome, genome));
            self.last_set = None;
            self.changed_at = Some(Instant::now());
        }
    }

    /// Returns the edited snake, with the evaluation of the original in place of its own.
    fn unevaluated(&self) -> Result<Champion, String> {
        self.check()?;
        let (genome, trial) = (self.genome.clone(), self.original.trial().clone());
        let original = self.original.champion();
        let (evaluation, origin) = (original.evaluation, original.origin.clone());
        Ok(Champion { genome, trial, evaluation, chosen_by: None, origin })
    }

    /// Returns the edited snake, which the stage then selects, beside the original, if a preview is ready.
    fn show(&mut self) -> Option<Show> {
        let champion = self.ready.take()?;
        let edited = StagedChampion::from_edited(&champion).named("Edited".to_owned());
        self.previewed = Some(edited.clone());
        Some(Show::race(vec![edited, self.original.clone()]))
    }

    fn tune(&mut self) -> Result<(), String> {
        self.check()?;
        let (genome, trial) = (self.genome.clone(), self.original.trial().clone());
        self.attempts += 1;
        let size = (TUNING, self.attempts);
        let task = BackgroundTask::start_counted(TUNING, move |control| {
            tune_controller(&genome, &trial, size, control)
        });
        self.tuning =
            Some(task.map_err(|error| format!("The gait could not be adapted: {error}."))?);
        Ok(())
    }
}

/// Changes the body of a genome at a block, with the same volume and within the usual limits of evolving bodies.
/// Returns `None` if this is not possible. The same change always has the same result.
pub(super) fn changed_body(genome: &Genome, change: BodyChange, block: usize) -> Option<Genome> {
    let mut rng = stream(genome.hash(), 1, block as u32, Purpose::Mutation);
    let space = GenomeSpace::default().widened_for(genome);
    space.with_body_change_at(genome, change, block, &mut rng)
}

fn follow(
    mut editor: ResMut<BodyEditor>,
    mut notices: ResMut<Notices>,
    mut send: MessageWriter<Command>,
) {
    if editor.edited.is_some() && editor.follow(&mut notices) {
        send.write(Command::Body(BodyCommand::Preview));
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<BodyEditor>().add_systems(Update, follow.in_set(FrameSet::TakeIn));
}

#[cfg(test)]
mod tests;
