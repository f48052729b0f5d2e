//! Guided experiments. A lesson borrows the stage and the next run's settings and restores both at its end; the current
//! run is paused meanwhile.

mod catalogue;

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use super::undo::UndoHistory;
use crate::evolve::{Champion, RunPlan};
use crate::run::{GenerationReport, ParallelRuns, ParallelRunsEvent};
use crate::score::{Evaluation, evaluate};
use crate::studio::commands::LessonCommand;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use crate::studio::ui::notifications::Notices;

use catalogue::{LessonScene, Side, champions, plan};

pub(crate) use catalogue::LESSONS;

/// The current lesson, if any.
#[derive(Resource, Debug, Default)]
pub(crate) struct Lessons {
    current: Option<Current>,
}

/// State of the current lesson.
#[derive(Debug)]
struct Current {
    /// Index of the lesson.
    index: usize,
    /// Index of the scene on the stage.
    scene: usize,
    /// Name and result of each lane of the scene.
    lanes: Vec<(String, Evaluation)>,
    /// Results of the scene's runs.
    runs: Vec<Found>,
    under_way: Option<ParallelRuns>,
    has_tried: bool,
    own: Own,
}

/// Results of a lesson's run.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Name of the run.
    pub name: String,
    /// Reports of the finished generations.
    pub reports: Vec<GenerationReport>,
    /// Hash, once the run is finished.
    pub run_hash: Option<u64>,
}

/// State to restore after the lesson.
#[derive(Debug)]
struct Own {
    next: RunPlan,
    champions: Vec<StagedChampion>,
    mode: StageMode,
    history: UndoHistory,
    pace: Pace,
}

/// How the current run was advancing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pace {
    Running,
    OneGeneration,
    Held,
}

/// View of the current lesson for its panel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LessonView<'l> {
    /// Index of the lesson.
    pub index: usize,
    /// Index of the scene on the stage.
    pub scene: usize,
    /// Name and result of each lane.
    pub lanes: &'l [(String, Evaluation)],
    /// Results of the runs.
    pub runs: &'l [Found],
    /// Whether runs are in progress.
    pub is_busy: bool,
    /// Whether the user has tried something, so that the conclusion may be shown.
    pub has_tried: bool,
}

impl Lessons {
    /// The current lesson.
    pub fn view(&self) -> Option<LessonView<'_>> {
        self.current.as_ref().map(|current| LessonView {
            index: current.index,
            scene: current.scene,
            lanes: &current.lanes,
            runs: &current.runs,
            is_busy: current.under_way.is_some(),
            has_tried: current.has_tried,
        })
    }

    /// Executes a command; returns what the stage shows then. `on_show` is on it now, and returns after the lesson.
    ///
    /// # Errors
    /// There is no such lesson, or its champions or runs cannot be prepared.
    pub fn apply(
        &mut self,
        command: &LessonCommand,
        run: &mut CurrentRun,
        on_show: Show,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        match command {
            LessonCommand::Begin(index) => self.begin(*index, run, on_show, history),
            LessonCommand::ShowScene(scene) => {
                self.allow_answer();
                self.show(*scene)
            }
            LessonCommand::ShowAnswer => {
                self.allow_answer();
                Ok(None)
            }
            LessonCommand::Leave => self.leave(run, history),
        }
    }

    /// Begins a lesson; what is on the stage now comes back at its end.
    pub fn begin(
        &mut self,
        index: usize,
        run: &mut CurrentRun,
        Show { champions, mode }: Show,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        if index >= LESSONS.len() {
            return Err(format!("There are {} lessons.", LESSONS.len()));
        }
        let own = match self.current.take() {
            // From one lesson to the next: keep the state from before the first.
            Some(before) => {
                // Undo steps of the previous lesson do not apply to this one.
                history.give_back(UndoHistory::default());
                before.own
            }
            None => {
                let pace = match run.status() {
                    RunStatus::Running if run.is_single_generation() => Pace::OneGeneration,
                    RunStatus::Running => Pace::Running,
                    RunStatus::Ready | RunStatus::Paused | RunStatus::Finished => Pace::Held,
                };
                run.pause()?;
                run.lend(true);
                let (next, history) = (run.next_plan().clone(), history.lend());
                Own { next, champions, mode, history, pace }
            }
        };
        run.set_next_plan(own.next.clone())?;
        self.current = Some(Current {
            index,
            scene: 0,
            lanes: Vec::new(),
            runs: Vec::new(),
            under_way: None,
            has_tried: false,
            own,
        });
        self.show(0)
    }

    /// Shows the answer from now on.
    fn allow_answer(&mut self) {
        if let Some(current) = &mut self.current {
            current.has_tried = true;
        }
    }

    /// Ends the lesson and restores stage, settings and run.
    pub fn leave(
        &mut self,
        run: &mut CurrentRun,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        let Some(Current { own, .. }) = self.current.take() else { return Ok(None) };
        run.set_next_plan(own.next)?;
        run.lend(false);
        history.give_back(own.history);
        match own.pace {
            Pace::Running if run.status() == RunStatus::Paused => run.start()?,
            Pace::OneGeneration if run.status() == RunStatus::Paused => {
                run.single_generation()?;
            }
            Pace::Running | Pace::OneGeneration | Pace::Held => {}
        }
        Ok(Some(Show { champions: own.champions, mode: own.mode }))
    }

    /// Shows a scene, or starts its runs.
    fn show(&mut self, number: usize) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        let Some(scene) = LESSONS[current.index].scenes.get(number) else { return Ok(None) };
        (current.scene, current.under_way) = (number, None);
        match scene {
            LessonScene::Lanes { lanes, champion, .. } => {
                let champions = champions(champion, lanes)?;
                current.runs.clear();
                current.lanes = champions
                    .iter()
                    .map(|staged| {
                        let evaluation = evaluate(&staged.champion().genome, staged.trial());
                        (staged.label().to_owned(), evaluation)
                    })
                    .collect();
                Ok(Some(if champions.len() > 1 {
                    Show::race(champions)
                } else {
                    Show { champions, mode: StageMode::Solo }
                }))
            }
            LessonScene::Runs { runs, .. } => {
                let plans = runs.iter().map(plan).collect::<Result<Vec<_>, _>>()?;
                current.lanes.clear();
                current.runs = runs.iter().map(found).collect();
                let started = ParallelRuns::start(plans);
                current.under_way = Some(
                    started.map_err(|error| format!("The runs could not be started: {error}"))?,
                );
                Ok(None)
            }
        }
    }

    /// Handles events of the lesson's runs. Once all are finished, returns the best champion of each.
    fn take_in(&mut self) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        while let Some(event) = current.under_way.as_ref().and_then(ParallelRuns::poll) {
            match event {
                ParallelRunsEvent::Generation { run, report } => {
                    current.runs[run].reports.push(*report)
                }
                ParallelRunsEvent::Finished { run, run_hash } => {
                    current.runs[run].run_hash = Some(run_hash)
                }
                ParallelRunsEvent::Failed(problem) => {
                    current.under_way = None;
                    return Err(format!("The lesson's runs failed: {problem}"));
                }
            }
        }
        let is_over = current.runs.iter().all(|found| found.run_hash.is_some());
        if current.under_way.is_none() || !is_over {
            return Ok(None);
        }
        current.under_way = None;
        let best = current.runs.iter().filter_map(|found| {
            let champion = found.best()?;
            Some(StagedChampion::from_lesson(champion).named(found.name.clone()))
        });
        let champions: Vec<StagedChampion> = best.collect();
        Ok((!champions.is_empty()).then(|| Show::race(champions)))
    }
}

impl Found {
    /// The best champion so far.
    pub fn best(&self) -> Option<&Champion> {
        let champions = self.reports.iter().filter_map(|report| report.champion.as_ref());
        champions.max_by(|a, b| a.evaluation.fitness.total_cmp(&b.evaluation.fitness))
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Lessons>().add_systems(FixedUpdate, take_in);
}

fn take_in(
    mut lessons: ResMut<Lessons>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    if lessons.current.is_none() {
        return;
    }
    match lessons.take_in() {
        Ok(shown) => {
            show.write_batch(shown);
        }
        Err(problem) => notices.problem(problem),
    }
}

fn found(side: &Side) -> Found {
    Found { name: side.name.to_owned(), reports: Vec::new(), run_hash: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{Experiment, LocalPool, RunControl};
    use crate::studio::state::current_run::prepared_run;

    /// Evolves the runs of a scene.
    fn outcome(sides: &[Side]) -> Vec<Found> {
        sides
            .iter()
            .map(|side| {
                let (plan, threads) = plan(side).expect("allowed");
                let pool = LocalPool::new(threads).expect("threads");
                let mut experiment = Experiment::new(plan);
                let mut found = found(side);
                while !experiment.is_over() {
                    let report = experiment.run_generation(&pool, &RunControl::default());
                    found.reports.push(report.expect("not cancelled"));
                }
                found.run_hash = Some(experiment.run_hash());
                found
            })
            .collect()
    }

    /// Final distance of the centre in each lane of a scene, in metres.
    fn ends_m(champion: &'static str, lanes: &[Side]) -> Vec<f32> {
        let champions = champions(champion, lanes).expect("they fit");
        let evaluate =
            |staged: &StagedChampion| evaluate(&staged.champion().genome, staged.trial());
        champions.iter().map(|staged| evaluate(staged).centre_y_m).collect()
    }

    fn lanes(lesson: usize, scene: usize) -> &'static [Side] {
        let LessonScene::Lanes { lanes, .. } = &LESSONS[lesson].scenes[scene] else {
            panic!("lanes")
        };
        lanes
    }

    fn runs(lesson: usize, scene: usize) -> &'static [Side] {
        let LessonScene::Runs { runs, .. } = &LESSONS[lesson].scenes[scene] else { panic!("runs") };
        runs
    }

    #[test]
    fn the_conclusion_about_friction_is_true() {
        let ends = ends_m("robust", lanes(0, 0));
        let [little, original, much] = ends[..] else { panic!("three lanes") };
        assert!(original > 21.0, "the original stands on the landing");
        assert!(little < original - 10.0 && much < original - 10.0, "{ends:?}");
        let near = ends_m("robust", lanes(0, 1));
        assert!(near.iter().all(|end| *end > 18.0), "{near:?}");
    }

    #[test]
    fn the_conclusion_about_the_frame_rate_is_true() {
        let ends = ends_m("climber", lanes(1, 0));
        assert!(ends[1..].iter().all(|end| (end - ends[0]).abs() > 0.5), "{ends:?}");
    }

    #[test]
    fn the_conclusion_about_limits_is_true() {
        let found = outcome(runs(2, 1));
        let last = |of: &Found| of.reports.last().and_then(|report| report.statistics);
        let [with, without] = &found[..] else { panic!("two runs") };
        let best = |of: &Found| last(of).expect("a healthy snake").best;
        assert!(best(with) > best(without) + 3.0, "{} and {}", best(with), best(without));
        let out = |of: &Found| of.reports.iter().map(|report| report.disqualified).sum::<u32>();
        assert!(out(without) > out(with), "{} and {}", out(without), out(with));
    }

    #[test]
    fn the_conclusion_about_halving_is_true() {
        let found = outcome(runs(3, 1));
        let [halved, kept] = &found[..] else { panic!("two runs") };
        let best = |of: &Found| of.best().expect("a champion").evaluation.fitness;
        assert!(best(kept) > best(halved) + 3.0, "{} and {}", best(kept), best(halved));
    }

    #[test]
    fn the_conclusion_about_bits_is_true() {
        let twice = outcome(runs(4, 1));
        assert_eq!(twice[0].run_hash, twice[1].run_hash);
        let apart = outcome(runs(4, 2));
        assert_ne!(apart[0].run_hash, apart[1].run_hash);
    }

    #[test]
    fn every_scene_of_every_lesson_can_be_shown() {
        for lesson in &LESSONS {
            for scene in lesson.scenes {
                match scene {
                    LessonScene::Lanes { lanes, champion, .. } => {
                        champions(champion, lanes).expect(lesson.title);
                    }
                    LessonScene::Runs { runs, .. } => {
                        runs.iter().for_each(|side| drop(plan(side).expect(lesson.title)));
                    }
                }
            }
        }
    }

    #[test]
    fn after_a_lesson_stage_and_settings_are_as_they_were() {
        let mut run = prepared_run();
        let own = champions("climber", &[lanes(0, 0)[1].clone()]).expect("it fits");
        let next = run.next_plan().clone();
        let mut lessons = Lessons::default();
        let stage = |champions: Vec<StagedChampion>| Show { champions, mode: StageMode::Solo };
        let mut history = UndoHistory::default();
        let shown = lessons.begin(0, &mut run, stage(own.clone()), &mut history);
        assert_eq!(shown.expect("allowed").expect("a scene").champions.len(), 3);
        run.set_field("surface.friction", "0.2").expect("allowed");
        lessons.begin(1, &mut run, stage(Vec::new()), &mut history).expect("allowed");
        assert_eq!(*run.next_plan(), next, "the next lesson starts with the user's settings");
        run.set_field("surface.friction", "0.3").expect("allowed");
        let back =
            lessons.leave(&mut run, &mut history).expect("allowed").expect("the earlier stage");
        assert_eq!(*run.next_plan(), next);
        assert_eq!(back.mode, StageMode::Solo);
        assert_eq!(back.champions.len(), own.len());
        assert!(lessons.view().is_none());
    }
}
