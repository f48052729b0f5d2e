//! Access to settings by name: listing, checking, finding, setting.

use super::value::{SettingField, SettingValue};
use super::walk::{ListedSetting, SettingGroup, SettingVisitor, walk};
use crate::check::Invalid;

/// Lists all settings with their rows and values, in the order of the walk.
pub fn list(group: &(impl SettingGroup + Clone)) -> Vec<ListedSetting> {
    struct Listing(Vec<ListedSetting>);
    impl SettingVisitor for Listing {
        fn setting(&mut self, listed: ListedSetting, _: &mut dyn SettingField) {
            self.0.push(listed);
        }
    }
    let mut listing = Listing(Vec::new());
    walk(&mut group.clone(), &mut listing);
    listing.0
}

/// Checks every setting against its range, and settings that depend on each other together.
///
/// # Errors
/// Names the first value that is not allowed: its dotted name, its value, and the allowed values.
pub fn check(group: &(impl SettingGroup + Clone)) -> Result<(), Invalid> {
    struct Checking(Result<(), Invalid>);
    impl SettingVisitor for Checking {
        fn setting(&mut self, listed: ListedSetting, _: &mut dyn SettingField) {
            if self.0.is_ok() {
                self.0 = listed.setting.check(&listed.path, &listed.value);
            }
        }

        fn leave(&mut self, path: &str, group: &dyn SettingGroup) {
            if self.0.is_ok() {
                let inside =
                    |error: Invalid| if path.is_empty() { error } else { error.inside(path) };
                self.0 = group.check_together().map_err(inside);
            }
        }
    }
    let mut checking = Checking(Ok(()));
    walk(&mut group.clone(), &mut checking);
    checking.0
}

/// Sets the setting with the full dotted name `path` to the value in `text`. Does not check the value against the range.
///
/// # Errors
/// Fails if no setting has the name, or if the text is not a value of the setting's type.
pub fn set_text(group: &mut dyn SettingGroup, path: &str, text: &str) -> Result<(), Invalid> {
    visit(group, path, &mut |listed, field| {
        let value = listed.setting.parse(text);
        let is_set = value.is_some_and(|value| field.set(value));
        is_set.then_some(()).ok_or_else(|| refused(&listed, format!("{text:?}")))
    })
}

/// Sets the setting with the full dotted name `path` to `value`. Does not check the value against the range.
///
/// # Errors
/// Fails if no setting has the name, or if the setting's values are of another type.
pub fn set_value(
    group: &mut dyn SettingGroup,
    path: &str,
    value: &SettingValue,
) -> Result<(), Invalid> {
    visit(group, path, &mut |listed, field| {
        let is_set = field.set(value.clone());
        is_set.then_some(()).ok_or_else(|| refused(&listed, value.to_string()))
    })
}

fn refused(listed: &ListedSetting, value: String) -> Invalid {
    Invalid::new(&listed.path, value, listed.setting.allowed())
}

/// Calls `act` with the setting that has the full dotted name `path`, and with its field.
fn visit(
    group: &mut dyn SettingGroup,
    path: &str,
    act: &mut dyn FnMut(ListedSetting, &mut dyn SettingField) -> Result<(), Invalid>,
) -> Result<(), Invalid> {
    struct Visit<'a> {
        path: &'a str,
        act: &'a mut dyn FnMut(ListedSetting, &mut dyn SettingField) -> Result<(), Invalid>,
        done: Option<Result<(), Invalid>>,
    }
    impl SettingVisitor for Visit<'_> {
        fn setting(&mut self, listed: ListedSetting, field: &mut dyn SettingField) {
            if listed.path == self.path {
                self.done = Some((self.act)(listed, field));
            }
        }
    }
    let mut visit = Visit { path, act, done: None };
    walk(group, &mut visit);
    let unknown = || Invalid::new("setting", format!("{path:?}"), "the full name of a setting");
    visit.done.unwrap_or_else(|| Err(unknown()))
}

/// Returns the full dotted name of the only setting whose name is `path` or ends with its words.
///
/// # Errors
/// Fails if no setting matches (the error lists the four most similar names), or if several do (the error lists them).
pub fn find(group: &(impl SettingGroup + Clone), path: &str) -> Result<String, Invalid> {
    let mut known: Vec<String> = list(group).into_iter().map(|listed| listed.path).collect();
    known.sort();
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
            let value = format!("{path:?}, an unknown setting");
            Err(Invalid::new("set", value, format!("(nearest) {}", names.join(", "))))
        }
        several => {
            let names: Vec<&str> = several.iter().map(|name| name.as_str()).collect();
            let value = format!("{path:?}, an ambiguous name");
            Err(Invalid::new("set", value, names.join(", ")))
        }
    }
}

/// Returns the similarity (Jaro-Winkler) of the last `words` words of a known path to the typed path, plus that of their last words.
fn likeness(known: &str, typed: &str, words: usize) -> f64 {
    let parts: Vec<&str> = known.split('.').collect();
    let tail = parts[parts.len().saturating_sub(words)..].join(".");
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    strsim::jaro_winkler(&tail, typed) + strsim::jaro_winkler(&last(known), &last(typed))
}
