//! Any single setting by its dotted name, for flags and panels: `surface.friction`.

use serde_json::{Map, Value};
use std::fmt::Write;

use super::{Descriptor, Settings, StrategyKind};
use crate::check::Invalid;
use crate::genome::ControllerKind;
use crate::score::{Counts, Fitness};

/// All settings with their values as text, by name: `trial.surface.friction`, `1`.
pub fn fields(settings: &Settings) -> Vec<(String, String)> {
    let mut found = Vec::new();
    collect(&value_of(settings), String::new(), &mut found);
    found.into_iter().map(|(path, value)| (path, text_of(&value))).collect()
}

/// The settings with one field changed, checked as a whole: see [`with_fields`].
///
/// # Errors
/// There is no such field (the nearest names are listed), or its value is not allowed.
pub fn with_field(settings: &Settings, path: &str, text: &str) -> Result<Settings, Invalid> {
    with_fields(settings, [(path, text)])
}

/// The settings with some fields changed, checked as a whole after the last.
///
/// A path may leave out what comes before: `surface.friction` for `trial.surface.friction`, if no
/// other field ends like that. A field of the ground that has no surface of its own gives it one: a
/// copy of the stairs'.
///
/// # Errors
/// There is no such field (the nearest names are listed), or a value is not allowed.
pub fn with_fields<'a>(
    settings: &Settings,
    changes: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Result<Settings, Invalid> {
    let mut settings = settings.clone();
    for (path, text) in changes {
        settings = unchecked(settings, path, text)?;
    }
    settings.check()?;
    Ok(settings)
}

fn unchecked(mut settings: Settings, path: &str, text: &str) -> Result<Settings, Invalid> {
    if ["ground", "trial.ground"].contains(&path) && text == "none" {
        settings.trial.ground = None;
        return Ok(settings);
    }
    if settings.trial.ground.is_none() && path.trim_start_matches("trial.").starts_with("ground.") {
        settings.trial.ground = Some(settings.trial.surface.clone());
    }
    let mut root = value_of(&settings);
    let path = resolve(&root, path)?;
    let target = at(&mut root, &path);
    let allowed = allowed(&path, target);
    // A restart of none is a name; elsewhere none means that there is no value.
    *target = match text {
        "none" if names_in(path.rsplit('.').next().unwrap_or_default()).is_none() => Value::Null,
        text => serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_owned())),
    };
    serde_json::from_value(root).map_err(|_| Invalid::new(path, format!("{text:?}"), allowed))
}

fn value_of(settings: &Settings) -> Value {
    // Settings are plain numbers, names and lists, which JSON always can hold.
    serde_json::to_value(settings).unwrap_or(Value::Null)
}

/// Finds every field below `value`, which stands at `path`.
fn collect(value: &Value, path: String, found: &mut Vec<(String, Value)>) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                let below = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                collect(value, below, found);
            }
        }
        leaf => found.push((path, leaf.clone())),
    }
}

/// The full path of the one field that ends like this.
fn resolve(root: &Value, path: &str) -> Result<String, Invalid> {
    let mut known = Vec::new();
    collect(root, String::new(), &mut known);
    let known: Vec<String> = known.into_iter().map(|(path, _)| path).collect();
    let ending = format!(".{path}");
    let matches = |known: &&String| *known == path || known.ends_with(&ending);
    let matching: Vec<&String> = known.iter().filter(matches).collect();
    match matching.as_slice() {
        [only] => Ok((*only).clone()),
        [] => {
            let words = path.split('.').count();
            let mut near: Vec<(f64, &str)> =
                known.iter().map(|known| (likeness(known, path, words), known.as_str())).collect();
            near.sort_by(|a, b| b.0.total_cmp(&a.0));
            let names: Vec<&str> = near.iter().take(4).map(|(_, name)| *name).collect();
            let allowed = format!("(nearest) {}", names.join(", "));
            Err(Invalid::new("set", format!("{path:?}, which is no setting"), allowed))
        }
        several => {
            let names: Vec<&str> = several.iter().map(|name| name.as_str()).collect();
            Err(Invalid::new("set", format!("{path:?}, which is several"), names.join(", ")))
        }
    }
}

/// How much the last `words` of a known path are like what was typed, and its last word like the last.
fn likeness(known: &str, typed: &str, words: usize) -> f64 {
    let parts: Vec<&str> = known.split('.').collect();
    let tail = parts[parts.len().saturating_sub(words)..].join(".");
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    strsim::jaro_winkler(&tail, typed) + strsim::jaro_winkler(&last(known), &last(typed))
}

/// The value at a path that exists.
fn at<'a>(root: &'a mut Value, path: &str) -> &'a mut Value {
    path.split('.').fold(root, |value, name| {
        if !value.is_object() {
            *value = Value::Object(Map::new());
        }
        &mut value[name]
    })
}

/// The names that may stand in a field, if it takes names.
fn names_in(last: &str) -> Option<Vec<&'static str>> {
    let of = |names: &[&'static str]| Some(names.to_vec());
    match last {
        "fitness" => of(&Fitness::ALL.map(Fitness::name)),
        "controller" => of(&ControllerKind::ALL.map(ControllerKind::name)),
        "strategy" => of(&StrategyKind::ALL.map(StrategyKind::name)),
        "counts" => of(&Counts::ALL.map(Counts::name)),
        "x" | "y" | "first" | "second" => of(&Descriptor::ALL.map(Descriptor::name)),
        "selection" => of(&["tournament", "rank"]),
        "crossover" => of(&["uniform", "one_point"]),
        "mutation" => of(&["gaussian", "uniform"]),
        "restarts" => of(&["none", "ipop", "bipop"]),
        "active" => of(&["true", "false"]),
        _ => None,
    }
}

/// What may stand in a field, by its name and what stands there now.
fn allowed(path: &str, now: &Value) -> String {
    let last = path.rsplit('.').next().unwrap_or_default();
    if let Some(names) = names_in(last) {
        return names.join(", ");
    }
    let is_optional = ["density_kg_m3", "bend_limit_rad", "twist_limit_rad"].contains(&last);
    match now {
        _ if is_optional => "a number, a list such as [1, 2], or none".to_owned(),
        _ if last == "ground" => "none, or set ground.friction and its like".to_owned(),
        Value::Number(number) if number.is_u64() => "a whole number from 0 up".to_owned(),
        Value::Array(_) if last.ends_with("limits_rad") => "a list such as [0.6, 0.8]".to_owned(),
        _ if path.starts_with("trial.agent.") && !path.contains(".skin.") => {
            "a number, or a list such as [1, 2]".to_owned()
        }
        _ => "a number".to_owned(),
    }
}

/// A value as a person would type it.
fn text_of(value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::String(text) => text.clone(),
        Value::Array(values) => {
            let texts: Vec<String> = values.iter().map(text_of).collect();
            format!("[{}]", texts.join(", "))
        }
        Value::Number(number) if number.is_f64() => {
            // Settings are 32-bit floats; their shortest text is the one a person typed.
            let mut text = String::new();
            #[expect(clippy::cast_possible_truncation, reason = "it was one")]
            let _ = write!(text, "{}", number.as_f64().unwrap_or(0.0) as f32);
            text
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::PerPart;

    fn refusal(path: &str, text: &str) -> String {
        with_field(&Settings::default(), path, text).unwrap_err().to_string()
    }

    #[test]
    fn a_field_is_found_by_the_end_of_its_path() {
        let settings = Settings::default();
        for path in ["surface.friction", "trial.surface.friction"] {
            let changed = with_field(&settings, path, "0.8").expect("allowed");
            assert_eq!(changed.trial.surface.friction, 0.8);
        }
        let changed = with_field(&settings, "fitness", "head").expect("allowed");
        assert_eq!(changed.trial.fitness, Fitness::Head);
        let changed = with_field(&settings, "stairs.steps", "4").expect("allowed");
        assert_eq!(changed.trial.stairs.steps, 4);
    }

    #[test]
    fn a_list_sets_one_value_for_each_part_and_none_gives_it_back_to_the_genome() {
        let settings = Settings::default();
        let path = "joint_damping_nms_per_rad";
        let changed = with_field(&settings, path, "[10, 20, 30, 40]").expect("allowed");
        let list = PerPart::Each(vec![10.0, 20.0, 30.0, 40.0]);
        assert_eq!(changed.trial.agent.joint_damping_nms_per_rad, list);
        let fixed = with_field(&settings, "agent.bend_limit_rad", "0.5").expect("allowed");
        assert_eq!(fixed.trial.agent.bend_limit_rad, Some(PerPart::All(0.5)));
        let free = with_field(&fixed, "agent.bend_limit_rad", "none").expect("allowed");
        assert_eq!(free, settings);
    }

    #[test]
    fn setting_one_field_of_the_ground_gives_it_a_surface_of_its_own() {
        let mut settings = Settings::default();
        settings.trial.surface.bounce = 0.5;
        let changed = with_field(&settings, "ground.friction", "0.1").expect("allowed");
        let ground = changed.trial.ground.expect("its own");
        assert_eq!((ground.friction, ground.bounce), (0.1, 0.5));
        assert_eq!(changed.trial.surface, settings.trial.surface);
        let changed = with_field(&settings, "ground.friction", "0.1").expect("allowed");
        for path in ["ground", "trial.ground"] {
            assert_eq!(with_field(&changed, path, "none").expect("allowed"), settings);
        }
    }

    #[test]
    fn fields_that_depend_on_each_other_are_checked_together() {
        let density = [("density_min_kg_m3", "0.6"), ("density_max_kg_m3", "0.8")];
        for changes in [density, [density[1], density[0]]] {
            let changed = with_fields(&Settings::default(), changes).expect("allowed");
            assert_eq!(changed.genome.density_max_kg_m3, 0.8);
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (path, text, message) in [
            ("surface.friction", "-1", "trial.surface.friction is -1; allowed: 0 to 1000"),
            ("surface.friction", "NaN", "trial.surface.friction is \"NaN\"; allowed: a number"),
            ("limbs", "2.5", "trial.agent.limbs is \"2.5\"; allowed: a whole number from 0 up"),
            (
                "limb_width_m",
                "[1, 2]",
                "trial.agent.limb_width_m is a list of 2; allowed: one value, or a list of 5",
            ),
        ] {
            assert_eq!(refusal(path, text), message);
        }
        assert!(refusal("fitness", "speed").contains("allowed: centre, head, centre_of_mass"));
    }

    #[test]
    fn an_unknown_path_lists_the_nearest_names_and_an_unclear_one_all() {
        let message = refusal("surface.fricton", "1");
        assert!(
            message.starts_with("set is \"surface.fricton\", which is no setting; "),
            "{message}"
        );
        assert!(message.contains("(nearest) trial.surface.friction"), "{message}");
        assert!(refusal("surface.soft_cfm", "1").contains("trial.surface.soft_cfm_m_s_per_n"));
        let message = refusal("friction", "1");
        assert!(
            ["surface", "agent.skin", "repeats.off"]
                .iter()
                .all(|place| message.contains(&format!("trial.{place}.friction"))),
            "{message}"
        );
    }

    #[test]
    fn every_field_can_be_set_to_what_it_is() {
        let mut settings = Settings::default();
        settings.trial.ground = Some(settings.trial.surface.clone());
        let fields = fields(&settings);
        assert!(fields.len() > 50, "{} fields", fields.len());
        for (path, text) in fields {
            let same = with_field(&settings, &path, &text).expect(&path);
            assert_eq!(same, settings, "{path} = {text}");
        }
    }
}
