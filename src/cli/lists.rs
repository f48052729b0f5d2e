//! `snakes show presets` and `snakes show settings`.

use super::args::Args;
use super::error::CliError;
use super::output::{print, print_json, print_names};
use snakes_core::evolve::fields;
use snakes_core::save::shipped_presets;
use snakes_core::schema::markdown;
use snakes_lab::run::with_short_numbers;

/// Prints the built-in presets.
pub fn print_presets(json: bool) -> Result<(), CliError> {
    let presets = shipped_presets()?.into_iter().map(|preset| (preset.name, preset.about));
    print_names("preset", &presets.collect::<Vec<_>>(), json)
}

/// Prints every setting with its value, or the tables of `docs/settings.md`, which describe the settings.
pub fn print_settings(args: &Args, as_markdown: bool) -> Result<(), CliError> {
    let (preset, settings) = args.settings()?;
    if as_markdown {
        return print(&format!(
            "# Settings\n\n\
             `snakes --set NAME=VALUE` changes a setting. The start of a name may be left out if the rest is \
             unambiguous: `--set rise_m=0.4`. The studio's panels change the same settings.\n\n\
             Angles are in radians here, after `--set` and in all files. The studio shows them, and reads what you \
             type, in degrees: 1 rad is 57.3°.\n\n\
             The values below, and whether a setting is fixed, are those of the preset `{preset}`. If a setting may \
             change, a new value takes effect with the next generation of the current run, provided that the run's \
             strategy uses it; a fixed setting takes effect with the next run.\n\n\
             The program generates this page: `snakes show settings --markdown > docs/settings.md`.\n{}",
            markdown(&settings)
        ));
    }
    if args.json {
        let line = serde_json::json!({"type": "settings", "preset": preset, "settings": settings});
        return print_json(&with_short_numbers(&line));
    }
    let fields = fields(&settings);
    let width = fields.iter().map(|(path, _)| path.len()).max().unwrap_or(0);
    let lines = fields.iter().map(|(path, value)| format!("{path:<width$} = {value}\n"));
    print(&lines.collect::<String>())
}
