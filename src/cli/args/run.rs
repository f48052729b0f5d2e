//! Conversion of flags into a run: a preset with the values of the flags, and the folders.

use std::path::Path;

use super::task::Args;
use crate::cli::error::{CliError, of_flag};
use crate::cli::replay::name_of;
use crate::cli::resume::run_in;
use snakes_core::check::Invalid;
use snakes_core::evolve::{Champion, Founder, RunPlan, Settings, check_effects, with_fields};
use snakes_core::save::{
    DEFAULT_PRESET, ExistingRun, Preset, SavesFolder, load_champion, load_preset, load_stairs,
    shipped_presets,
};
use snakes_core::schema::Choices;
use snakes_core::score::Fitness;
use snakes_lab::run::RunSource;

impl Args {
    /// Returns the named preset, or else the program's default, without the changes of other flags.
    pub fn preset(&self) -> Result<Preset, CliError> {
        Ok(load_preset(self.run.settings.preset.as_deref().unwrap_or(DEFAULT_PRESET))?)
    }

    /// Returns the folder for this run's champions.
    pub fn saves_folder(&self) -> SavesFolder {
        SavesFolder::find(self.run.out.out.as_deref().or(self.run.saves.as_deref()))
    }

    /// Returns the folder for tables: the folder named by --out, or else the working directory.
    pub fn results_folder(&self) -> SavesFolder {
        SavesFolder::find(Some(self.run.out.out.as_deref().unwrap_or(Path::new("."))))
    }

    /// Returns the run in the folder to resume, or the run that the flags describe.
    pub fn run_source(&self) -> Result<RunSource, CliError> {
        if let Some(folder) = &self.run.resume {
            let mut run = run_in(folder, self.json)?;
            if self.run.restart {
                run.earlier = ExistingRun::Discard;
            }
            return Ok(run);
        }
        let plan = match &self.run.from {
            Some(file) => self.plan_from(file)?,
            None => {
                let (preset, settings) = self.settings_of_run()?;
                RunPlan::new(&preset, self.seed()?, settings)
            }
        };
        let earlier = if self.run.restart { ExistingRun::Discard } else { ExistingRun::Keep };
        Ok(RunSource::in_saves(&self.saves_folder(), plan, earlier))
    }

    /// Returns whether the flags name a run that may exist: by its folder, seed or founder, or to begin it again.
    #[cfg(feature = "studio")]
    pub fn names_run(&self) -> bool {
        self.run.resume.is_some()
            || self.run.seed.seed.is_some()
            || self.run.from.is_some()
            || self.run.restart
    }

    /// Returns the run that begins from a saved champion. Its search is that of the named preset, or else of the champion's preset.
    /// Its world is that of the named preset, or else the champion's own. The ranges of genes are widened to include the champion.
    /// Values of other flags are applied last.
    fn plan_from(&self, file: &Path) -> Result<RunPlan, CliError> {
        let Champion { genome, trial, origin, .. } = load_champion(file)?.champion;
        let mut preset = match &self.run.settings.preset {
            Some(named) => load_preset(named)?,
            None => {
                let shipped = shipped_presets()?;
                let its_own = shipped.into_iter().find(|preset| preset.name == origin.preset);
                its_own.map_or_else(|| self.preset(), Ok)?
            }
        };
        if self.run.settings.preset.is_none() {
            preset.settings.trial = trial;
        }
        preset.settings.genome = preset.settings.genome.widened_for(&genome);
        let (preset, settings) = self.flags_over(preset)?;
        self.check_effects(&settings)?;
        let founder = Founder::new(&name_of(file), genome);
        Ok(RunPlan::new(&preset, self.seed()?, settings).starting_from(founder)?)
    }

    /// Returns the preset's name and its settings, with the values of the flags. All values are checked.
    pub fn settings(&self) -> Result<(String, Settings), CliError> {
        self.flags_over(self.preset()?)
    }

    /// Returns the name of the preset and the settings of the run. Each `--set` must have an effect on the run.
    pub fn settings_of_run(&self) -> Result<(String, Settings), CliError> {
        let (preset, settings) = self.settings()?;
        self.check_effects(&settings)?;
        Ok((preset, settings))
    }

    /// Refuses `--set` for a setting without an effect on a run with these settings, and a start inside the stairs.
    fn check_effects(&self, settings: &Settings) -> Result<(), Invalid> {
        settings.check_start()?;
        let paths =
            self.run.settings.set.iter().filter_map(|text| Some(text.split_once('=')?.0.trim()));
        check_effects(settings, paths)
    }

    /// Returns the settings that `--population`, `--generations`, `--duration`, `--fitness` and `--set` change: names and values.
    pub fn changes(&self) -> Result<Vec<(&str, String)>, CliError> {
        let mut changes = Vec::new();
        for (name, text) in [
            ("evolution.population", &self.run.settings.population),
            ("evolution.generations", &self.run.settings.generations),
            ("trial.duration_s", &self.run.settings.duration),
        ] {
            changes.extend(text.iter().map(|text| (name, text.clone())));
        }
        if let Some(text) = &self.run.settings.fitness {
            changes.push(("trial.fitness", Fitness::named("--fitness", text)?.to_string()));
        }
        for text in &self.run.settings.set {
            let (name, value) = named_value(text)?;
            changes.push((name, value.to_owned()));
        }
        Ok(changes)
    }

    fn flags_over(&self, preset: Preset) -> Result<(String, Settings), CliError> {
        let mut settings = preset.settings;
        let changes = self.changes()?;
        if let Some(named) = &self.run.settings.stairs {
            settings.trial.stairs = load_stairs(named)?.stairs;
        }
        let with = |changes: &[(&str, String)]| {
            with_fields(&settings, changes.iter().map(|(name, value)| (*name, value.as_str())))
        };
        // The changes of --set come last.
        let of_flags = changes.len() - self.run.settings.set.len();
        let changed = with(&changes).map_err(|invalid| {
            // An error that also occurs without --set comes from another flag.
            let is_of_flag = with(&changes[..of_flags]).is_err_and(|other| other == invalid);
            match invalid.field.as_str() {
                "set" => of_flag("--set")(invalid),
                _ if is_of_flag => self.of_its_flag(invalid),
                _ => invalid,
            }
        });
        Ok((preset.name, changed?))
    }

    /// Returns an error about a setting with the name of the flag that gave the value, if there is one.
    pub fn of_its_flag(&self, invalid: Invalid) -> Invalid {
        let flags = [
            ("evolution.population", "--population", &self.run.settings.population),
            ("evolution.generations", "--generations", &self.run.settings.generations),
            ("trial.duration_s", "--duration", &self.run.settings.duration),
            ("trial.fitness", "--fitness", &self.run.settings.fitness),
        ];
        let is_it = |(field, _, given): &&(&str, &str, &Option<String>)| {
            *field == invalid.field && given.is_some()
        };
        match flags.iter().find(is_it) {
            Some((_, flag, _)) => of_flag(flag)(invalid),
            None => invalid,
        }
    }
}

/// Splits `FIELD=VALUE` into the name and the value of a setting.
fn named_value(text: &str) -> Result<(&str, &str), Invalid> {
    let (path, value) = text.split_once('=').ok_or_else(|| {
        let allowed = "FIELD=VALUE, such as surface.friction=0.8";
        Invalid::new("--set", format!("{text:?}"), allowed)
    })?;
    Ok((path.trim(), value.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::flags::CommandLine;
    use crate::cli::args::parse::tests::asked;
    use clap::CommandFactory;

    fn args_of(words: &str) -> Args {
        asked(words).expect("allowed").0
    }

    fn refusal(words: &str) -> String {
        let complaint = asked(words).and_then(|(args, _)| {
            args.seed()?;
            args.threads()?;
            args.settings().map(drop)
        });
        complaint.expect_err("refused").to_string()
    }

    #[test]
    fn the_flags_are_consistent() {
        CommandLine::command().debug_assert();
    }

    #[test]
    fn flags_override_the_preset() {
        let args = args_of("--no-render --seed 7 --population 20 --duration 2.5");
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
            ("--population 0", "--population is 0; allowed: 1 to 100000"),
            ("--population -3", "--population is \"-3\"; allowed: 1 to 100000, whole numbers"),
            ("--duration -1", "--duration is -1; allowed: 0.1 to 600"),
            ("--duration NaN", "--duration is \"NaN\"; allowed: 0.1 to 600 s"),
            (
                "--seed twelve",
                "--seed is \"twelve\"; allowed: a whole number from 0 to 18446744073709551615",
            ),
            (
                "--preset nosuch",
                "--preset is \"nosuch\"; allowed: climb, report, steady, quick, panda-manual, ice, rubber, moon, mud, trampoline, thick-air, senses, mixed-stairs, q-learning, xcs, zcs, waves-by-rules, limb-neurons, neat, bodies, squishy, creatures, house, ladder, poet, generalist, or a file",
            ),
            ("--threads 0", "--threads is 0; allowed: 1 to 1024"),
            (
                "--set evolution.population=0 --population 7",
                "evolution.population is 0; allowed: 1 to 100000",
            ),
            ("--set surface.bounce=2", "trial.surface.bounce is 2; allowed: 0 to 1"),
            (
                "--set surface.bounce",
                "--set is \"surface.bounce\"; allowed: FIELD=VALUE, such as surface.friction=0.8",
            ),
        ] {
            assert_eq!(refusal(words), message, "{words}");
        }
    }

    #[test]
    fn a_setting_without_effect_is_refused() {
        for (words, start) in [
            ("--preset climb --set torque_budget_nm=100", "trial.agent.torque_budget_nm is 100; "),
            ("--preset climb --set soft_parts=4", "trial.agent.soft_parts is 4; "),
            ("--preset climb --set ga.step=0.1", "evolution.ga.step is 0.1; "),
            ("--preset bodies --set limbs=7", "trial.agent.limbs is 7; "),
        ] {
            let refusal = args_of(words).run_source().map(|_| ()).expect_err("refused");
            let text = refusal.to_string();
            assert!(text.starts_with(start) && text.contains("do not use it"), "{text}");
        }
        let soft = "--preset climb --set youngs_modulus_pa=20000 --set soft_parts=4";
        assert!(args_of(soft).run_source().is_ok());
    }

    #[test]
    fn an_unknown_evaluator_is_refused_with_the_names_of_all() {
        let refusal =
            args_of("--evaluator nosuch").local_evaluator().expect_err("refused").to_string();
        assert!(refusal.starts_with("--evaluator is \"nosuch\"; allowed: threads"), "{refusal}");
    }

    #[cfg(feature = "studio")]
    #[test]
    fn a_theme_is_light_or_dark_if_it_is_given() {
        use crate::studio::Theme;
        assert_eq!(args_of("").theme().expect("allowed"), None);
        assert_eq!(args_of("--theme dark").theme().expect("allowed"), Some(Theme::Dark));
        let refusal = args_of("--theme dim").theme().expect_err("refused").to_string();
        assert_eq!(refusal, "--theme is \"dim\"; allowed: light or dark");
    }
}
