//! The settings as tables in Markdown, for `docs/settings.md`.

use std::fmt::Write;

use super::walk::SettingGroup;
use super::{ListedSetting, Section, SettingKind, list};

/// Writes all settings of a group, with a table for each section. The column "value" has the group's present values.
pub fn markdown(group: &(impl SettingGroup + Clone)) -> String {
    let all = list(group);
    let mut sections: Vec<Section> = Vec::new();
    for listed in &all {
        if !sections.contains(&listed.section) {
            sections.push(listed.section);
        }
    }
    let mut text = String::new();
    for section in sections {
        let Section { title, about } = section;
        let _ = write!(text, "\n## {title}\n\n{about}\n\n");
        text += "| setting | allowed | value | during a run | effect |\n|---|---|---|---|---|\n";
        for listed in all.iter().filter(|listed| listed.section == section) {
            text += &line(listed);
        }
    }
    text
}

fn line(listed: &ListedSetting) -> String {
    let ListedSetting { path, setting, value, fixed, .. } = listed;
    let allowed = match setting.kind {
        SettingKind::Choice(choices) => {
            let names: Vec<String> =
                choices().iter().map(|choice| format!("`{}`", choice.name)).collect();
            names.join(", ")
        }
        _ => setting.allowed(),
    };
    let allowed = match (setting.display, setting.kind) {
        (Some(display), SettingKind::Number(range) | SettingKind::List(range)) => {
            let shown = setting.shown_range(&range).in_words();
            format!("{allowed}; in the studio {shown}{}", display.unit)
        }
        _ => allowed,
    };
    let live = if fixed.is_some() { "fixed" } else { "may change" };
    let (label, hint) = (setting.label, setting.hint);
    format!("| `{path}` | {allowed} | `{value}` | {live} | {label}: {hint}. |\n")
}
