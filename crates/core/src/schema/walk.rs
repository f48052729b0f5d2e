//! The walk through all settings: groups, sections, and a visit to each field.

use super::setting::{Need, Setting, SettingRow};
use super::value::{SettingField, SettingValue};
use crate::check::Invalid;

/// A group of settings that is shown under a title.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// Title of the section; no other section has it.
    pub title: &'static str,
    /// Sentence about the settings of the section.
    pub about: &'static str,
}

/// A struct of settings that a `Walk` can visit.
pub trait SettingGroup {
    /// Visits every field with `walk`. Destructure `self` without `..`: a field without a row then does not compile.
    fn walk(&mut self, walk: &mut Walk<'_>);

    /// Checks values that depend on each other, which the range of a single setting cannot express.
    ///
    /// # Errors
    /// Names the field, its value, and the values that are allowed together with the other settings.
    fn check_together(&self) -> Result<(), Invalid> {
        Ok(())
    }
}

/// A setting with its value, and whether it is used and may change.
#[derive(Debug, Clone)]
pub struct ListedSetting {
    /// Full dotted name, from the struct at which the walk began.
    pub path: String,
    /// Section that contains the setting.
    pub section: Section,
    /// Row of the setting.
    pub setting: Setting,
    /// Present value of the setting.
    pub value: SettingValue,
    /// Whether the setting has an effect with the other settings, such as the chosen strategy or controller.
    pub is_used: bool,
    /// Reason why the setting may not change during any run, as a sentence. None: it may change in a run that uses it.
    pub fixed: Option<&'static str>,
    /// Whether the setting may change during this run; if not, the reason as a sentence.
    pub live: Result<(), &'static str>,
}

/// Visitor of settings, one after the other.
pub trait SettingVisitor {
    /// Visits a setting and its field.
    fn setting(&mut self, listed: ListedSetting, field: &mut dyn SettingField);

    /// Follows the visits to all settings of `group`, whose dotted name is `path`.
    fn leave(&mut self, _path: &str, _group: &dyn SettingGroup) {}
}

/// State of a walk through the settings: the visitor, the path, and the properties of the settings that come next.
pub struct Walk<'a> {
    visitor: &'a mut dyn SettingVisitor,
    path: String,
    state: State,
}

/// Properties of the settings that come next, until the end of their group.
#[derive(Clone)]
struct State {
    section: Section,
    is_used: bool,
    /// Length of a group's path, and the names below it of settings without effect.
    without_effect: (usize, Vec<&'static str>),
    /// Needs that the run does not meet.
    unmet: Vec<Need>,
    fixed: Option<&'static str>,
}

/// Reason why a setting that the run does not use cannot change during the run.
const UNUSED: &str = "Takes effect with the next run, because the current run does not use it.";

/// Visits every setting of a group with a visitor.
pub fn walk(group: &mut dyn SettingGroup, visitor: &mut dyn SettingVisitor) {
    let section = Section { title: "Settings", about: "All settings." };
    let without_effect = (0, Vec::new());
    let state = State { section, is_used: true, without_effect, unmet: Vec::new(), fixed: None };
    let mut walk = Walk { visitor, path: String::new(), state };
    group.walk(&mut walk);
    walk.visitor.leave("", group);
}

impl Walk<'_> {
    /// Assigns the next settings of this group to a section.
    pub fn section(&mut self, section: Section) {
        self.state.section = section;
    }

    /// Sets whether the next settings of this group have an effect, given settings outside the group.
    pub fn used_if(&mut self, is_used: bool) {
        self.state.is_used = is_used;
    }

    /// Sets the paths, below this group, of settings that have no effect, given settings outside the group.
    pub fn without_effect(&mut self, names: Vec<&'static str>) {
        self.state.without_effect = (self.path.len(), names);
    }

    /// Records whether the run meets a need of the next settings of this group. A need that is not recorded is met.
    pub fn meet(&mut self, need: Need, is_met: bool) {
        if !is_met {
            self.state.unmet.push(need);
        }
    }

    /// Returns whether the run meets a need.
    pub fn meets(&self, need: Need) -> bool {
        !self.state.unmet.contains(&need)
    }

    /// Forbids changes of the next settings of this group during a run, for a reason that is a sentence.
    pub fn fixed(&mut self, reason: &'static str) {
        self.state.fixed = Some(reason);
    }

    /// Visits a field under its row. `name` is the name of the field.
    pub fn setting<T: SettingField>(
        &mut self,
        name: &'static str,
        row: SettingRow<T>,
        field: &mut T,
    ) {
        let setting = Setting { name, ..row.setting };
        let length = self.enter(setting.name);
        let State { section, fixed, .. } = self.state;
        let is_used = self.state.is_used
            && row.is_used
            && row.need.is_none_or(|need| self.meets(need))
            && self.has_effect();
        let live = match fixed {
            Some(reason) => Err(reason),
            None if !is_used => Err(UNUSED),
            None => setting.fixed.map_or(Ok(()), Err),
        };
        let fixed = fixed.or(setting.fixed);
        let (path, value) = (self.path.clone(), field.value());
        let listed = ListedSetting { path, section, setting, value, is_used, fixed, live };
        self.visitor.setting(listed, field);
        self.path.truncate(length);
    }

    /// Visits a group of settings that is the field `name` of this group.
    pub fn group(&mut self, name: &str, group: &mut dyn SettingGroup) {
        let state = self.state.clone();
        let length = self.enter(name);
        group.walk(self);
        self.visitor.leave(&self.path, group);
        self.path.truncate(length);
        self.state = state;
    }

    /// Returns whether the setting at the present path is not among the settings without effect.
    fn has_effect(&self) -> bool {
        let (below, names) = &self.state.without_effect;
        let name = self.path.get(*below..).unwrap_or_default();
        !names.contains(&name.strip_prefix('.').unwrap_or(name))
    }

    /// Appends a name to the path. Returns the length of the path before.
    fn enter(&mut self, name: &str) -> usize {
        let length = self.path.len();
        if length > 0 {
            self.path.push('.');
        }
        self.path.push_str(name);
        length
    }
}
