//! The experiment behind the window: started, held, reset; its reports kept for the panels.

use std::sync::Arc;

use bevy::prelude::*;
use rayon::ThreadPool;

use super::notice::Notices;
use super::stage::{Exhibit, ShowExhibit, Stage};
use super::{Frame, Options, StudioError};
use crate::check::Invalid;
use crate::evolve::{Champion, Settings, with_field};
use crate::run::headless::HeadlessError;
use crate::run::{Background, Event, Experiment, GenerationReport, Keeper, pool};
use crate::save::{SavesFolder, load_preset};

/// What every run of this session shares.
#[derive(Resource, Debug, Clone)]
pub(super) struct Engine {
    pool: Arc<ThreadPool>,
    saves: SavesFolder,
    preset: String,
    seed: u64,
    settings: Settings,
}

impl Engine {
    /// Starts the worker threads.
    pub fn new(options: &Options) -> Result<Self, StudioError> {
        let pool = pool(options.threads).map_err(HeadlessError::from)?;
        Ok(Self {
            pool: Arc::new(pool),
            saves: options.saves.clone(),
            preset: options.preset.clone(),
            seed: options.seed,
            settings: options.settings.clone(),
        })
    }
}

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    /// Prepared, nothing evaluated yet.
    Ready,
    /// Evaluating.
    Running,
    /// Held.
    Paused,
    /// All generations are done.
    Finished,
}

/// The current run and what it found.
#[derive(Resource, Debug)]
pub(super) struct Evolution {
    engine: Engine,
    /// Which run of this session it is; the first is 0.
    number: u32,
    /// Preset, seed and settings of the current run; the engine's are those of the next.
    preset: String,
    seed: u64,
    settings: Settings,
    background: Option<Background>,
    reports: Vec<GenerationReport>,
    run_hash: Option<u64>,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Evolution>()
        .add_systems(Startup, start_at_once)
        .add_systems(Update, take_in.in_set(Frame::TakeIn));
}

impl FromWorld for Evolution {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<Engine>().clone())
    }
}

impl Evolution {
    /// A prepared run.
    pub fn new(engine: Engine) -> Self {
        Self {
            preset: engine.preset.clone(),
            seed: engine.seed,
            settings: engine.settings.clone(),
            engine,
            number: 0,
            background: None,
            reports: Vec::new(),
            run_hash: None,
        }
    }

    /// Where the run stands.
    pub fn status(&self) -> Status {
        match &self.background {
            _ if self.run_hash.is_some() => Status::Finished,
            None => Status::Ready,
            Some(background) if background.is_paused() => Status::Paused,
            Some(_) => Status::Running,
        }
    }

    /// Which run of this session it is; the first is 0.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Name of the preset that the current run started from.
    pub fn preset(&self) -> &str {
        &self.preset
    }

    /// Seed of the current run.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Seed of the next run.
    pub fn next_seed(&self) -> u64 {
        self.engine.seed
    }

    /// Settings of the current run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Settings of the next run.
    pub fn next_settings(&self) -> &Settings {
        &self.engine.settings
    }

    /// Name of the preset that the next run starts from.
    pub fn next_preset(&self) -> &str {
        &self.engine.preset
    }

    /// Population of the next run.
    pub fn next_population(&self) -> u32 {
        self.engine.settings.evolution.population
    }

    /// Whether seed or settings were changed since the run was prepared.
    pub fn next_run_differs(&self) -> bool {
        self.seed != self.engine.seed || self.settings != self.engine.settings
    }

    /// Reports of the finished generations, the first generation first.
    pub fn reports(&self) -> &[GenerationReport] {
        &self.reports
    }

    /// Finished evaluations of the current generation, and how many it has.
    pub fn progress(&self) -> (u32, u32) {
        match &self.background {
            Some(background) => background.progress(),
            None => (0, self.settings.evolution.population),
        }
    }

    /// Hash of the run, once it is finished.
    pub fn run_hash(&self) -> Option<u64> {
        self.run_hash
    }

    /// The best of a generation; the first generation is 1.
    pub fn champion_of(&self, generation: u32) -> Option<&Champion> {
        let index = (generation as usize).checked_sub(1)?;
        self.reports.get(index)?.champion.as_ref()
    }

    /// Evolves until held or finished. After the end of a run it begins the next one.
    pub fn start(&mut self) -> Result<(), String> {
        self.begin_next_if_over()?;
        self.background()?.resume();
        Ok(())
    }

    /// Holds evolution.
    pub fn pause(&mut self) -> Result<(), String> {
        if self.status() == Status::Running {
            self.background()?.pause();
        }
        Ok(())
    }

    /// Evolves to the end of the current generation.
    pub fn single_generation(&mut self) -> Result<(), String> {
        if self.status() == Status::Finished {
            return Err("The run is finished; \"New run\" begins another.".to_owned());
        }
        self.background()?.run_single_generation();
        Ok(())
    }

    /// Throws the current run away and prepares the next.
    pub fn reset(&mut self) -> Result<(), String> {
        let number = self.number + 1;
        *self = Self { number, ..Self::new(self.engine.clone()) };
        Ok(())
    }

    /// Sets the seed of the next run; a run that has not begun takes it at once.
    pub fn set_seed(&mut self, seed: u64) -> Result<(), String> {
        self.engine.seed = seed;
        self.take_over_if_ready()
    }

    /// Sets the population of the next run; a run that has not begun takes it at once.
    pub fn set_population(&mut self, population: u32) -> Result<(), String> {
        self.set_field("evolution.population", &population.to_string())
    }

    /// Sets one setting of the next run, by its name; a run that has not begun takes it at once.
    pub fn set_field(&mut self, field: &str, text: &str) -> Result<(), String> {
        self.engine.settings = with_field(&self.engine.settings, field, text)
            .map_err(|error: Invalid| error.to_string())?;
        self.take_over_if_ready()
    }

    /// Takes a shipped preset for the next run.
    pub fn set_preset(&mut self, name: &str) -> Result<(), String> {
        let preset = load_preset(name).map_err(|error| error.to_string())?;
        self.engine.preset = preset.name;
        self.engine.settings = preset.settings;
        self.take_over_if_ready()
    }

    fn take_over_if_ready(&mut self) -> Result<(), String> {
        if self.status() == Status::Ready { self.reset() } else { Ok(()) }
    }

    fn begin_next_if_over(&mut self) -> Result<(), String> {
        if self.status() == Status::Finished { self.reset() } else { Ok(()) }
    }

    /// The run's thread, started if it was not.
    fn background(&mut self) -> Result<&Background, String> {
        let background = match self.background.take() {
            Some(background) => background,
            None => {
                let settings = self.settings.clone();
                let experiment = Experiment::new(&self.preset, self.seed, settings);
                let keeper = Keeper::new(self.engine.saves.clone());
                Background::start(experiment, Arc::clone(&self.engine.pool), keeper)
                    .map_err(|error| format!("evolution could not be started: {error}"))?
            }
        };
        Ok(self.background.insert(background))
    }
}

/// A fresh run evolves from the first moment.
fn start_at_once(mut evolution: ResMut<Evolution>, mut notices: ResMut<Notices>) {
    if let Err(problem) = evolution.start() {
        notices.problem(problem);
    }
}

/// Takes in what the background found. A champion that beats the one on show takes its place, unless
/// the stage is held: then somebody is looking at something.
fn take_in(
    mut evolution: ResMut<Evolution>,
    mut notices: ResMut<Notices>,
    mut show: MessageWriter<ShowExhibit>,
    stages: Query<&Stage>,
) {
    let Some(background) = &evolution.background else { return };
    let events: Vec<Event> = std::iter::from_fn(|| background.poll()).collect();
    // Only what was found in the world of this run can be compared with what it finds.
    let world = &evolution.settings.trial;
    let rivals = stages.iter().map(Stage::exhibit);
    let rivals = rivals.filter(|exhibit| exhibit.champion().trial == *world);
    let mut to_beat = rivals.map(Exhibit::fitness).fold(f32::MIN, f32::max);
    // Who holds the stage, or tries out another world than the run's, is looking at something.
    let is_tried = |stage: &Stage| stage.exhibit().is_changed() && stage.trial() != world;
    let is_held = stages.iter().any(|stage| !stage.is_playing() || is_tried(stage));
    for event in events {
        match event {
            Event::Generation(report) => {
                if let Some(champion) = &report.champion
                    && champion.evaluation.fitness > to_beat
                {
                    to_beat = champion.evaluation.fitness;
                    let exhibit = Exhibit::found(champion, evolution.number);
                    if is_held {
                        notices.news(format!("Better than what is on show: {}", exhibit.caption()));
                    } else {
                        notices.news(format!("New on stage: {}", exhibit.caption()));
                        show.write(ShowExhibit(exhibit));
                    }
                }
                evolution.reports.push(*report);
            }
            Event::Finished { run_hash } => {
                evolution.run_hash = Some(run_hash);
                notices.news("The run is finished.".to_owned());
            }
            Event::BrokeOff => {
                notices.problem("The run broke off by an error of the program.".to_owned());
                evolution.background = None;
            }
            Event::NotSaved(problem) => notices.problem(format!("Not saved: {problem}")),
        }
    }
}

/// A run of the default settings that has not begun, for tests of panels.
#[cfg(test)]
pub(super) fn prepared_run() -> Evolution {
    let folder = std::env::temp_dir().join("snakes-and-stairs-panel-test");
    let options = Options {
        preset: "report".to_owned(),
        settings: Settings::default(),
        seed: 1,
        threads: 1,
        saves: SavesFolder::find(Some(&folder)),
        champion: None,
        window_size: (1280, 720),
        exit_after_frames: None,
    };
    Evolution::new(Engine::new(&options).expect("threads"))
}
