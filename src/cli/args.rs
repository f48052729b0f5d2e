//! The flags, and how they override a preset.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

use super::CliError;
use super::compare::CompareArgs;
use super::render::RenderArgs;
use super::robust::OffBy;
use crate::check::{Invalid, within};
use crate::evolve::{Champion, Founder, RunPlan, Settings, with_fields};
use crate::run::{RunSource, THREADS_RANGE, available_cores};
#[cfg(feature = "studio")]
use crate::save::PreferencesFile;
use crate::save::{
    DEFAULT_PRESET, Earlier, Preset, SavesFolder, load_champion, load_preset, shipped_presets,
};
#[cfg(feature = "studio")]
use crate::studio::Theme;

/// A five-block snake evolves until it climbs a staircase.
///
/// Without arguments a window opens, with a champion climbing and a fresh run evolving behind it.
#[derive(Debug, Parser)]
#[command(name = "snakes", version, subcommand_precedence_over_arg = true)]
pub struct Args {
    /// Work in the terminal: no window, no display needed
    #[arg(long, global = true)]
    pub no_render: bool,
    /// Print JSON, one object a line
    #[arg(long, global = true)]
    pub json: bool,
    /// A preset's name (see `snakes presets`) or the path of your own preset file
    #[arg(long, global = true, value_name = "NAME")]
    preset: Option<String>,
    /// Seed of the run; the same seed gives the same bits [default: 1]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    seed: Option<String>,
    /// Individuals per generation
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    population: Option<String>,
    /// Generations in the run
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    generations: Option<String>,
    /// How many of the best become parents
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    parents: Option<String>,
    /// Mutation range of the second generation, in N·m; it halves with each further one
    #[arg(long, global = true, value_name = "NM", allow_negative_numbers = true)]
    mutation_range: Option<String>,
    /// Torque points that take effect per second
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    points_per_s: Option<String>,
    /// Length of each simulation, in simulated seconds
    #[arg(long, global = true, value_name = "S", allow_negative_numbers = true)]
    duration: Option<String>,
    /// Physics steps per simulated second
    #[arg(long, global = true, value_name = "HZ", allow_negative_numbers = true)]
    steps_per_s: Option<String>,
    /// Solver substeps within a physics step
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    substeps: Option<String>,
    /// Gravity, in m/s²
    #[arg(long, global = true, value_name = "G", allow_negative_numbers = true)]
    gravity: Option<String>,
    /// What is rewarded: centre, head, centre_of_mass, height, furthest_y or steps_climbed
    #[arg(long, global = true, value_name = "NAME")]
    fitness: Option<String>,
    /// Change any single setting, such as surface.friction=0.8 (see `snakes settings`); repeatable
    #[arg(long, global = true, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Go on with the run in this folder, from its last finished generation
    #[arg(
        long,
        global = true,
        value_name = "DIR",
        conflicts_with_all = [
            "preset", "seed", "population", "generations", "parents", "mutation_range",
            "points_per_s", "duration", "steps_per_s", "substeps", "gravity", "fitness", "set", "out",
            "restart", "from",
        ]
    )]
    resume: Option<PathBuf>,
    /// Begin a run from a saved champion: the first generation descends from it, in its own world unless --preset
    /// or --set say otherwise
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    from: Option<PathBuf>,
    /// Begin the run anew; without this, one that was stopped goes on, and a finished one is shown
    #[arg(long, global = true)]
    pub restart: bool,
    /// Worker threads [default: all cores; with a window, all but one]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    threads: Option<String>,
    /// Folder to write this run's champions, tables and pictures to
    #[arg(long, global = true, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of saved champions [default: ./saves if there is one, else the platform's data folder]
    #[arg(long, global = true, value_name = "DIR")]
    saves: Option<PathBuf>,
    /// Open the studio with the result of `snakes compare`
    #[arg(long, global = true, value_name = "FILE")]
    pub comparison: Option<PathBuf>,
    /// Size of the window in pixels; where several make up one, in those
    #[arg(long, global = true, value_name = "WIDTHxHEIGHT")]
    window_size: Option<String>,
    /// The colours: light or dark [default: those chosen last; at first light]
    #[arg(long, global = true, value_name = "NAME")]
    theme: Option<String>,
    /// Where it is kept what you choose for the window: a file, or none [default: the platform's folder for settings]
    #[arg(long, global = true, value_name = "FILE")]
    preferences: Option<PathBuf>,
    /// Write role, place and label of all that the panels show to a file, whenever it changes
    #[arg(long, global = true, value_name = "FILE", hide_short_help = true)]
    pub places: Option<PathBuf>,
    /// Close the window after that many frames and print the time each took
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true)]
    exit_after_frames: Option<String>,
    /// What to do instead of evolving
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Replay a saved champion exactly, or race several; with --no-render, check them against their records
    Replay {
        /// The saved champions
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// Measure how fast the simulation is on this machine
    Bench,
    /// Check that this machine computes the same bits as every other: golden trajectories, one fingerprint
    Verify,
    /// In how many trials that are a little off does a champion reach each step?
    Robust {
        /// The saved champion
        file: PathBuf,
        /// How many trials
        #[arg(long, value_name = "N", default_value_t = 100)]
        trials: u32,
        /// How far they are off
        #[command(flatten)]
        range: OffBy,
    },
    /// Run several methods under equal budgets and show who learns what
    Compare(CompareArgs),
    /// Run the report's protocol with several seeds and print its Table 1 beside ours
    Table1 {
        /// How many seeds
        #[arg(long, value_name = "N", default_value_t = 10)]
        seeds: u64,
        /// The first of them
        #[arg(long, value_name = "N", default_value_t = 1)]
        first_seed: u64,
    },
    /// Draw the champion of each generation of a run, and a signal, as PNG; no window is opened
    Figures {
        /// The run's folder, as `snakes --no-render` names it
        run: PathBuf,
    },
    /// Draw a moment of a saved champion, or of several side by side, as PNG; no window is opened
    Render(RenderArgs),
    /// Search for what the report left free: duration, points per second, density, damping, surface
    Calibrate {
        /// How many candidates to try
        #[arg(long, value_name = "N", default_value_t = 200)]
        tries: u32,
        /// With how many seeds each
        #[arg(long, value_name = "N", default_value_t = 4)]
        seeds: u64,
        /// The first of them; test what is found with others
        #[arg(long, value_name = "N", default_value_t = 1000)]
        first_seed: u64,
    },
    /// List the presets
    Presets,
    /// List every setting and its value, as --set takes them
    Settings,
}

/// What the arguments ask for.
pub enum Parsed {
    /// A mode of the program.
    Run(Box<Args>),
    /// Only a text: help or version.
    Print(String),
}

/// Parses the arguments, turning clap's page of complaint into one line.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Parsed, CliError> {
    match Args::try_parse_from(arguments) {
        Ok(args) => Ok(Parsed::Run(Box::new(args))),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                Ok(Parsed::Print(error.render().to_string()))
            }
            _ => Err(CliError::Usage(one_line(&error.render().to_string()))),
        },
    }
}

/// The complaint itself and clap's tip, if it has one, on one line.
fn one_line(text: &str) -> String {
    let paragraphs = text.split("\n\n").enumerate();
    let kept = paragraphs.filter(|(index, text)| *index == 0 || text.trim().starts_with("tip:"));
    let words: Vec<&str> = kept.flat_map(|(_, text)| text.split_whitespace()).collect();
    let line = words.join(" ");
    format!("{} (see snakes --help)", line.trim_start_matches("error: "))
}

/// Reads a number, or says what would have been one.
fn number<T: FromStr>(flag: &str, text: &str, allowed: &str) -> Result<T, Invalid> {
    text.parse().map_err(|_| Invalid::new(flag, format!("{text:?}"), allowed))
}

/// Reads a size in pixels, such as 1280x720.
#[cfg(feature = "studio")]
pub fn size(flag: &str, text: &str, least: (u32, u32), most: u32) -> Result<(u32, u32), Invalid> {
    let allowed = "WIDTHxHEIGHT, such as 1280x720";
    let wrong = || Invalid::new(flag, format!("{text:?}"), allowed);
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let (width, height) = (number(flag, width, allowed)?, number(flag, height, allowed)?);
    within(&format!("{flag}.width"), width, least.0..=most)?;
    within(&format!("{flag}.height"), height, least.1..=most)?;
    Ok((width, height))
}

const WHOLE: &str = "a whole number from 0 up";
const DECIMAL: &str = "a number";

impl Args {
    /// The preset that was named, or the default of the command, as it stands in its file.
    pub fn preset(&self) -> Result<Preset, CliError> {
        let default = match self.command {
            // What they are about is the report's run.
            Some(Command::Table1 { .. } | Command::Calibrate { .. } | Command::Bench) => "report",
            _ => DEFAULT_PRESET,
        };
        Ok(load_preset(self.preset.as_deref().unwrap_or(default))?)
    }

    /// Where this run's champions go.
    pub fn saves_folder(&self) -> SavesFolder {
        SavesFolder::find(self.out.as_deref().or(self.saves.as_deref()))
    }

    /// The folder that was named for results.
    #[cfg(feature = "studio")]
    pub fn out_folder(&self) -> Option<&Path> {
        self.out.as_deref()
    }

    /// Where tables go: the working directory, unless named.
    pub fn results_folder(&self) -> SavesFolder {
        SavesFolder::find(Some(self.out.as_deref().unwrap_or(Path::new("."))))
    }

    /// The run that is meant: the one in a folder, or the one of the flags.
    pub fn run_source(&self) -> Result<RunSource, CliError> {
        if let Some(folder) = &self.resume {
            return Ok(RunSource::in_folder(folder)?);
        }
        let plan = match &self.from {
            Some(file) => self.plan_from(file)?,
            None => {
                let (preset, settings) = self.settings()?;
                RunPlan::new(&preset, self.seed()?, settings)
            }
        };
        let earlier = if self.restart { Earlier::Discard } else { Earlier::Keep };
        Ok(RunSource::in_saves(&self.saves_folder(), plan, earlier))
    }

    /// The run that begins from a saved champion. It searches by the preset that was named, else by the one the
    /// champion comes from; the world is that of the preset that was named, else the champion's own. Genomes may be
    /// what the preset says, and what the champion is; then the flags' values are put in.
    fn plan_from(&self, file: &Path) -> Result<RunPlan, CliError> {
        let Champion { genome, trial, origin, .. } = load_champion(file)?.champion;
        let mut preset = match &self.preset {
            Some(named) => load_preset(named)?,
            None => {
                let shipped = shipped_presets()?;
                let its_own = shipped.into_iter().find(|preset| preset.name == origin.preset);
                its_own.map_or_else(|| self.preset(), Ok)?
            }
        };
        if self.preset.is_none() {
            preset.settings.trial = trial;
        }
        preset.settings.genome = preset.settings.genome.widened_for(&genome);
        let (preset, settings) = self.flags_over(preset)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        let founder = Founder::new(&name, genome);
        Ok(RunPlan::new(&preset, self.seed()?, settings).founded_by(founder)?)
    }

    /// The preset's name and its settings, with the flags' values put in and everything checked.
    pub fn settings(&self) -> Result<(String, Settings), CliError> {
        self.flags_over(self.preset()?)
    }

    fn flags_over(&self, preset: Preset) -> Result<(String, Settings), CliError> {
        let mut settings = preset.settings;
        let Settings { trial, genome, evolution } = &mut settings;
        for (flag, given, target) in [
            ("population", &self.population, &mut evolution.population),
            ("generations", &self.generations, &mut evolution.generations),
            ("parents", &self.parents, &mut evolution.halving.parents),
            ("steps-per-s", &self.steps_per_s, &mut trial.physics.steps_per_s),
            ("substeps", &self.substeps, &mut trial.physics.substeps),
        ] {
            if let Some(text) = given {
                *target = number(flag, text, WHOLE)?;
            }
        }
        for (flag, given, target) in [
            ("mutation-range", &self.mutation_range, &mut evolution.halving.mutation_range_nm),
            ("points-per-s", &self.points_per_s, &mut genome.points_per_s),
            ("duration", &self.duration, &mut trial.duration_s),
            ("gravity", &self.gravity, &mut trial.physics.gravity_m_s2),
        ] {
            if let Some(text) = given {
                *target = number(flag, text, DECIMAL)?;
            }
        }
        if let Some(text) = &self.fitness {
            trial.fitness = text.parse()?;
        }
        let mut changes = Vec::new();
        for text in &self.set {
            let (path, value) = text.split_once('=').ok_or_else(|| {
                Invalid::new(
                    "set",
                    format!("{text:?}"),
                    "FIELD=VALUE, such as surface.friction=0.8",
                )
            })?;
            changes.push((path.trim(), value.trim()));
        }
        Ok((preset.name, with_fields(&settings, changes)?))
    }

    /// The seed of the run.
    pub fn seed(&self) -> Result<u64, CliError> {
        let allowed = "a whole number from 0 to 18446744073709551615";
        let given = self.seed.as_deref();
        Ok(given.map_or(Ok(1), |text| number("seed", text, allowed))?)
    }

    /// Worker threads without a window.
    pub fn threads(&self) -> Result<usize, CliError> {
        self.threads_or(available_cores())
    }

    /// Worker threads beside a window: a core is left free for it.
    #[cfg(feature = "studio")]
    pub fn studio_threads(&self) -> Result<usize, CliError> {
        self.threads_or(available_cores().saturating_sub(1).max(1))
    }

    fn threads_or(&self, default: usize) -> Result<usize, CliError> {
        let Some(text) = &self.threads else { return Ok(default) };
        let threads = number("threads", text, "a whole number from 1 to 1024")?;
        within("threads", threads, THREADS_RANGE)?;
        Ok(threads)
    }

    /// The window's size in pixels, if it is given.
    #[cfg(feature = "studio")]
    pub fn window_size(&self) -> Result<Option<(u32, u32)>, CliError> {
        let given = self.window_size.as_deref();
        Ok(given.map(|text| size("window-size", text, (320, 240), 16_384)).transpose()?)
    }

    /// The colours of the window, and of pictures, if they are given.
    #[cfg(feature = "studio")]
    pub fn theme(&self) -> Result<Option<Theme>, CliError> {
        Ok(self.theme.as_deref().map(str::parse).transpose()?)
    }

    /// Where it is kept what a person chooses for the window.
    #[cfg(feature = "studio")]
    pub fn preferences(&self) -> PreferencesFile {
        match self.preferences.as_deref() {
            None => PreferencesFile::find(),
            Some(path) if path.as_os_str() == "none" => PreferencesFile::nowhere(),
            Some(path) => PreferencesFile::at(path),
        }
    }

    /// After how many frames to close the window by itself.
    #[cfg(feature = "studio")]
    pub fn exit_after_frames(&self) -> Result<Option<u32>, CliError> {
        let Some(text) = &self.exit_after_frames else { return Ok(None) };
        let frames = number("exit-after-frames", text, "a whole number from 1 up")?;
        within("exit-after-frames", frames, 1..=u32::MAX)?;
        Ok(Some(frames))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn args(words: &str) -> Result<Args, CliError> {
        let arguments = ["snakes"].into_iter().chain(words.split_whitespace());
        match parse(arguments.map(OsString::from))? {
            Parsed::Run(args) => Ok(*args),
            Parsed::Print(_) => unreachable!("no help was asked for"),
        }
    }

    fn args_of(words: &str) -> Args {
        args(words).expect("allowed")
    }

    fn refusal(words: &str) -> String {
        let complaint = args(words).and_then(|args| {
            args.seed()?;
            args.threads()?;
            args.settings().map(drop)
        });
        complaint.expect_err("refused").to_string()
    }

    #[test]
    fn the_flags_are_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn flags_override_the_preset() {
        let args = args("--no-render --seed 7 --population 20 --duration 2.5").expect("allowed");
        let (preset, settings) = args.settings().expect("allowed");
        assert_eq!(preset, "climb");
        assert_eq!(settings.evolution.population, 20);
        assert_eq!(settings.trial.duration_s, 2.5);
        assert_eq!(args.seed().expect("allowed"), 7);
        let args =
            args_of("--no-render --set surface.friction=0.8 --set ground.slip_m_s_per_n=0.1");
        let (_, settings) = args.settings().expect("allowed");
        assert_eq!(settings.trial.surface.friction, 0.8);
        assert_eq!(settings.trial.ground.map(|ground| ground.slip_m_s_per_n), Some(0.1));
    }

    #[test]
    fn wrong_values_are_refused_with_field_value_and_range() {
        for (words, message) in [
            ("--population 0", "evolution.population is 0; allowed: 1 to 100000"),
            ("--population -3", "population is \"-3\"; allowed: a whole number from 0 up"),
            ("--duration -1", "trial.duration_s is -1; allowed: 0.1 to 600"),
            ("--duration NaN", "trial.duration_s is NaN; allowed: 0.1 to 600"),
            (
                "--seed twelve",
                "seed is \"twelve\"; allowed: a whole number from 0 to 18446744073709551615",
            ),
            (
                "--preset nosuch",
                "preset is \"nosuch\"; allowed: climb, report, steady, quick, panda-manual, ice, rubber, moon, mud, trampoline, or a file",
            ),
            ("--threads 0", "threads is 0; allowed: 1 to 1024"),
            ("--set surface.bounce=2", "trial.surface.bounce is 2; allowed: 0 to 1"),
            (
                "--set surface.bounce",
                "set is \"surface.bounce\"; allowed: FIELD=VALUE, such as surface.friction=0.8",
            ),
        ] {
            assert_eq!(refusal(words), message, "{words}");
        }
    }

    #[cfg(feature = "studio")]
    #[test]
    fn a_theme_is_one_of_two_if_it_is_named() {
        assert_eq!(args_of("").theme().expect("allowed"), None);
        assert_eq!(args_of("--theme dark").theme().expect("allowed"), Some(Theme::Dark));
        let refusal = args_of("--theme dim").theme().expect_err("refused").to_string();
        assert_eq!(refusal, "theme is \"dim\"; allowed: light or dark");
    }

    #[test]
    fn an_unknown_flag_is_one_line() {
        let message = refusal("--polulation 3");
        assert!(message.contains("--polulation") && !message.contains('\n'), "{message}");
        assert!(message.contains("tip: a similar argument exists: '--population'"), "{message}");
    }
}
