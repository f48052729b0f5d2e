//! Access to the settings of an experiment by dotted names such as `surface.friction`, for flags, panels and logs.

use super::Settings;
use crate::check::Invalid;
use crate::schema::{SettingValue, find, list, set_text, set_value};

/// Returns the names of all settings with their values as text, in the order of the names: `trial.surface.friction`, `1`.
pub fn fields(settings: &Settings) -> Vec<(String, String)> {
    let listed = list(settings).into_iter();
    let mut fields: Vec<_> = listed.map(|listed| (listed.path, listed.value.to_string())).collect();
    fields.sort();
    fields
}

/// Returns the settings with one field changed, checked as a whole: see [`with_fields`].
///
/// # Errors
/// Fails if no field has the name (the error lists the most similar names), or if the value is not allowed.
pub fn with_field(settings: &Settings, path: &str, text: &str) -> Result<Settings, Invalid> {
    with_fields(settings, [(path, text)])
}

/// Returns the settings with the field of a full dotted name changed, checked as a whole.
///
/// # Errors
/// Fails if no field has the name, or if the value is not allowed.
pub fn with_value(
    settings: &Settings,
    path: &str,
    value: &SettingValue,
) -> Result<Settings, Invalid> {
    let mut settings = settings.clone();
    set_value(&mut settings, path, value)?;
    settings.check()?;
    Ok(settings)
}

/// Returns the fields of `after` whose values differ from those of `before`, in the order of their full dotted names.
pub fn changed_values(before: &Settings, after: &Settings) -> Vec<(String, SettingValue)> {
    let known = list(before);
    let is_known =
        |of: &(String, SettingValue)| known.iter().any(|k| (&k.path, &k.value) == (&of.0, &of.1));
    let all = list(after).into_iter().map(|listed| (listed.path, listed.value));
    let mut changed: Vec<_> = all.filter(|of| !is_known(of)).collect();
    changed.sort_by(|a, b| a.0.cmp(&b.0));
    changed
}

/// Returns the settings with some fields changed. The settings are checked as a whole after the last change.
///
/// A path may lack its beginning: `surface.friction` means `trial.surface.friction`, if no other field ends with these words. Changing a
/// field of the ground, when the ground has no surface of its own, first gives the ground a copy of the stairs' surface.
///
/// # Errors
/// Fails if no field has a name (the error lists the most similar names), or if a value is not allowed.
pub fn with_fields<'a>(
    settings: &Settings,
    changes: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Result<Settings, Invalid> {
    let mut settings = settings.clone();
    for (path, text) in changes {
        let ground = &mut settings.trial.ground;
        if ["ground", "trial.ground"].contains(&path) && text == "none" {
            *ground = None;
            continue;
        }
        if path.trim_start_matches("trial.").starts_with("ground.") {
            ground.get_or_insert_with(|| settings.trial.surface.clone());
        }
        let path = find(&settings, path)?;
        set_text(&mut settings, &path, text)?;
    }
    settings.check()?;
    Ok(settings)
}

/// Checks that each of the fields has an effect on a run with these settings. A path that is not the name of a field, such as the path of a
/// group, is not checked.
///
/// # Errors
/// Names the first field that the strategy, the controller or the bodies of the run do not use.
pub fn check_effects<'a>(
    settings: &Settings,
    paths: impl IntoIterator<Item = &'a str>,
) -> Result<(), Invalid> {
    let listed = list(settings);
    for path in paths {
        let Ok(path) = find(settings, path) else { continue };
        let setting = listed.iter().find(|listed| listed.path == path);
        if let Some(setting) = setting.filter(|setting| !setting.is_used) {
            let allowed = "no value, because this strategy, controller and body do not use it";
            return Err(Invalid::new(&path, setting.value.to_string(), allowed));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::{Fitness, PerPart};
    use crate::world::Surface;

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
            ("limbs", "2.5", "trial.agent.limbs is \"2.5\"; allowed: 2 to 12, whole numbers"),
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
            message.starts_with("set is \"surface.fricton\", an unknown setting; "),
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

    /// Returns the names of all fields, read from the serialized settings instead of the rows.
    fn serialized(value: &serde_json::Value, path: &str) -> Vec<String> {
        let serde_json::Value::Object(fields) = value else { return vec![path.to_owned()] };
        let below = |(name, value)| serialized(value, &format!("{path}.{name}"));
        fields.iter().flat_map(below).collect()
    }

    #[test]
    fn every_field_has_a_row_of_its_name() {
        for ground in [None, Some(Surface::default())] {
            let mut settings = Settings::default();
            settings.trial.ground = ground;
            let value = serde_json::to_value(&settings).expect("serializable");
            let mut names = serialized(&value, "");
            // A setting added to the format later is not serialized at its default. Its name is valid if the reader accepts it.
            for (field, _) in fields(&settings) {
                if !names.contains(&format!(".{field}")) {
                    let mut value = value.clone();
                    field.split('.').fold(&mut value, |value, name| &mut value[name]).take();
                    let refusal = serde_json::from_value::<Settings>(value).err();
                    let refusal = refusal.map(|error| error.to_string()).unwrap_or_default();
                    assert!(!refusal.contains("unknown field"), "{field}: {refusal}");
                    names.push(format!(".{field}"));
                }
            }
            names.sort();
            let listed = fields(&settings).into_iter().map(|(field, _)| format!(".{field}"));
            assert_eq!(listed.collect::<Vec<_>>(), names);
        }
    }
}
