//! Layout of the panels: docked, stacked, collapsed or floating. Their widths are in [`super::widths`].

use bevy_egui::egui;
use egui_dock::{DockState, NodeIndex, Style, SurfaceIndex, TabPath};
use xxhash_rust::xxh3::xxh3_64;

use super::widths::PanelWidths;
use crate::studio::commands::panel::PanelKind;
use crate::studio::ui::theme;

/// Layout of the panels: docked, stacked, collapsed or floating.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    state: DockState<PanelKind>,
    widths: PanelWidths,
    /// Whether the window was high in the last frame; `None` before the first one.
    was_high: Option<bool>,
    /// Whether to build the default layout as soon as the window's size is known.
    is_to_be_laid_out: bool,
    /// Panel to focus after the default layout is built.
    first: Option<PanelKind>,
    /// Panels that came to the front or got the focus, the latest last.
    chosen: Vec<PanelKind>,
    /// Panels that were in front of their places when `chosen` was last updated.
    in_front: Vec<PanelKind>,
    /// Whether the panel that is offered was added for this; `None` while no panel is offered.
    offered: Option<bool>,
}

/// Minimum window height for the champions below the other panels, in points.
const HIGH: f32 = 800.0;
/// Width of the left panels, in points. All tab names fit.
const LEFT: f32 = 384.0;

/// Returns whether a window of this size, in points, has room for panels below other panels.
fn is_high(size: egui::Vec2) -> bool {
    size.y >= HIGH
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            state: DockState::new(vec![PanelKind::Stage]),
            widths: PanelWidths::default(),
            was_high: None,
            is_to_be_laid_out: true,
            first: None,
            chosen: Vec::new(),
            in_front: Vec::new(),
            offered: None,
        }
    }
}

impl Layout {
    /// Returns the default layout for a window of this width, in points: all panels are at the left of the stage.
    fn default_of(is_high: bool, width: f32) -> DockState<PanelKind> {
        let mut state = DockState::new(vec![PanelKind::Stage]);
        let surface = state.main_surface_mut();
        let share = (LEFT / width.max(1.0)).clamp(0.1, 0.9);
        let left = PanelKind::INITIAL.to_vec();
        let [_, node] = surface.split_left(NodeIndex::root(), share, left);
        if is_high {
            let _ = surface.split_below(node, 0.68, vec![PanelKind::Champions]);
        }
        state
    }

    /// Requests the default layout, which the next call of `state_in` builds.
    pub fn reset(&mut self) {
        self.is_to_be_laid_out = true;
    }

    /// Returns the dock state to draw in a window of this size, in points.
    ///
    /// Does not adjust the widths while the UI scale is changing (`is_settled == false`).
    pub fn state_in(&mut self, size: egui::Vec2, is_settled: bool) -> &mut DockState<PanelKind> {
        if self.is_to_be_laid_out {
            self.state = Self::default_of(is_high(size), size.x);
            self.widths = PanelWidths::default();
            self.is_to_be_laid_out = false;
            self.chosen.clear();
            self.in_front = self.front_panels();
            self.first.take().into_iter().for_each(|kind| self.open(kind));
        }
        self.note_chosen();
        if is_settled {
            self.follow_height(size);
            if let Some((stage, _)) = self.state.find_main_surface_tab(&PanelKind::Stage) {
                self.widths.fit(self.state.main_surface_mut(), stage, size.x);
            }
        }
        // Hide the tab bar while the stage is the only tab.
        for (_, leaf) in self.state.iter_leaves_mut() {
            leaf.tab_bar_hidden = leaf.tabs == [PanelKind::Stage];
        }
        &mut self.state
    }

    /// Returns to the default layout when the window has become much larger or smaller, unless the user has rearranged the panels.
    fn follow_height(&mut self, size: egui::Vec2) {
        let is_high = is_high(size);
        let before = self.was_high.replace(is_high).filter(|before| *before != is_high);
        let Some(before) = before else { return };
        // An offered tab is no arrangement of the user. It is offered again in the next frame.
        self.offer(PanelKind::Senses, false);
        if arrangement(&self.state) != arrangement(&Self::default_of(before, size.x)) {
            return;
        }
        self.state = Self::default_of(is_high, size.x);
        self.widths.panels_were_rearranged();
        // The panel chosen last comes last, so that it is in front where several panels now share a place.
        self.chosen.clone().into_iter().for_each(|kind| self.open(kind));
        self.in_front = self.front_panels();
    }

    /// Updates `chosen` by the panels that came to the front since the last call, and by the panel with the focus.
    fn note_chosen(&mut self) {
        let front = self.front_panels();
        let focused = self.state.focused_leaf().and_then(|path| self.state.leaf(path).ok());
        let focused = focused.and_then(|leaf| leaf.tabs.get(leaf.active.0).copied());
        let new = front.iter().filter(|kind| !self.in_front.contains(kind)).copied();
        for kind in new.chain(focused).collect::<Vec<_>>() {
            self.chosen.retain(|other| *other != kind);
            self.chosen.push(kind);
        }
        self.in_front = front;
    }

    /// Returns the front panel of each place.
    fn front_panels(&self) -> Vec<PanelKind> {
        let leaves = self.state.iter_leaves();
        leaves.filter_map(|(_, leaf)| leaf.tabs.get(leaf.active.0).copied()).collect()
    }

    /// Returns whether the layout contains a panel, visible or as a tab.
    pub fn has(&self, kind: PanelKind) -> bool {
        self.state.find_tab(&kind).is_some()
    }

    /// Returns the width of each visible tab bar, in points, and its panels.
    pub fn tab_bars(&self) -> Vec<(f32, Vec<PanelKind>)> {
        let leaves = self.state.iter_leaves().filter(|(_, leaf)| !leaf.tab_bar_hidden);
        leaves.map(|(_, leaf)| (leaf.rect().width(), leaf.tabs.clone())).collect()
    }

    /// Closes panels that open on demand, the one chosen longest ago first, while the tabs of a bar do not fit. `least_width`
    /// returns the least width of a bar with these panels, in points. The panels in front stay.
    pub fn fit_tabs(&mut self, least_width: impl Fn(&[PanelKind]) -> f32) {
        let front = self.front_panels();
        for (width, mut kinds) in self.tab_bars() {
            // A bar has no width until it is drawn.
            while width > 0.0 && least_width(&kinds) > width {
                let is_spare =
                    |kind: &&PanelKind| !PanelKind::INITIAL.contains(kind) && !front.contains(kind);
                let chosen = |kind: &&PanelKind| self.chosen.iter().position(|of| of == *kind);
                let Some(spare) = kinds.iter().filter(is_spare).min_by_key(chosen).copied() else {
                    break;
                };
                self.close(spare);
                kinds.retain(|kind| *kind != spare);
            }
        }
    }

    /// Focuses a panel, and restores it if it was closed.
    pub fn open(&mut self, kind: PanelKind) {
        if self.is_to_be_laid_out {
            self.first = Some(kind);
            return;
        }
        self.add(kind);
        if let Some(path) = self.state.find_tab(&kind) {
            let _ = self.state.set_active_tab(path);
            self.state.set_focused_node_and_surface(path.node_path());
            if let Ok(leaf) = self.state.leaf_mut(path.node_path()) {
                leaf.collapsed = false;
            }
        }
    }

    /// Adds a panel as the last tab beside related ones, unless the layout contains it.
    fn add(&mut self, kind: PanelKind) {
        if self.has(kind) {
            return;
        }
        match self.home_of(kind) {
            Some(path) => {
                let leaf = self.state.leaf_mut(path.node_path());
                leaf.into_iter().for_each(|leaf| leaf.tabs.push(kind));
            }
            None => {
                let root = NodeIndex::root();
                let _ = self.state.main_surface_mut().split_left(root, 0.27, vec![kind]);
            }
        }
    }

    /// Adds the tab of a panel when it becomes useful, but does not bring it to the front. Removes the tab when the panel
    /// is not useful any more, unless the user has chosen it.
    pub fn offer(&mut self, kind: PanelKind, is_useful: bool) {
        if self.is_to_be_laid_out || is_useful == self.offered.is_some() {
            return;
        }
        let is_added = self.offered.take() == Some(true);
        if is_useful {
            self.offered = Some(!self.has(kind));
            self.add(kind);
        } else if is_added && !self.chosen.contains(&kind) {
            self.close(kind);
        }
    }

    /// Finds the place for a restored panel: beside a related panel, or else beside any panel.
    fn home_of(&self, kind: PanelKind) -> Option<TabPath> {
        let usual: &[PanelKind] = match kind {
            PanelKind::Charts
            | PanelKind::Library
            | PanelKind::Senses
            | PanelKind::Body
            | PanelKind::Machines => &[PanelKind::Charts, PanelKind::Library, PanelKind::Senses],
            _ => &[PanelKind::Run, PanelKind::World, PanelKind::Lessons],
        };
        let found = |kinds: &[PanelKind]| kinds.iter().find_map(|kind| self.state.find_tab(kind));
        found(usual).or_else(|| found(PanelKind::IN_MENU))
    }

    /// Closes the panel that has the focus.
    pub fn close_front(&mut self) {
        let front = self.state.focused_leaf().and_then(|path| self.state.leaf(path).ok());
        if let Some(kind) = front.and_then(|leaf| leaf.tabs.get(leaf.active.0).copied()) {
            self.close(kind);
        }
    }

    /// Closes a panel. The stage cannot be closed.
    fn close(&mut self, kind: PanelKind) {
        if kind != PanelKind::Stage
            && let Some(path) = self.state.find_tab(&kind)
        {
            self.state.remove_tab(path);
        }
    }

    /// Returns the layout as text with a checksum, or an empty text before the first layout.
    pub fn to_text(&self) -> String {
        if self.is_to_be_laid_out {
            return String::new();
        }
        let text = ron::to_string(&(&self.widths, &self.state)).unwrap_or_default();
        format!("{} {text}", seal(&text))
    }

    /// Reads a layout from its text. Returns the default layout if the text is invalid.
    pub fn from_text(text: &str) -> Self {
        // Text from another version or edited by hand could describe a layout that cannot be drawn.
        let own = text.split_once(' ').filter(|(sum, text)| *sum == seal(text));
        let read = own.and_then(|(_, text)| ron::from_str(text).ok());
        let read =
            read.filter(|(widths, state): &(PanelWidths, _)| widths.are_sound() && is_sound(state));
        read.map_or_else(Self::default, |(widths, state)| Self {
            state,
            widths,
            is_to_be_laid_out: false,
            ..Self::default()
        })
    }
}

/// Computes the checksum of a layout's text together with the program's version.
fn seal(text: &str) -> String {
    format!("{:016x}", xxh3_64(format!("{} {text}", env!("CARGO_PKG_VERSION")).as_bytes()))
}

/// Returns the panels of each place, and whether the place is in the main window.
fn arrangement(state: &DockState<PanelKind>) -> Vec<(bool, Vec<PanelKind>)> {
    let leaves = state.iter_leaves();
    leaves.map(|(path, leaf)| (path.surface == SurfaceIndex::main(), leaf.tabs.clone())).collect()
}

/// Checks that the main window contains the stage, and that no panel occurs twice.
fn is_sound(state: &DockState<PanelKind>) -> bool {
    let kinds: Vec<PanelKind> = state.iter_all_tabs().map(|(_, kind)| *kind).collect();
    let count = |kind: &PanelKind| kinds.iter().filter(|other| *other == kind).count();
    let stage = state.find_tab(&PanelKind::Stage);
    stage.is_some_and(|path| path.surface == SurfaceIndex::main())
        && kinds.iter().all(|kind| count(kind) == 1)
}

/// Returns the style of the dock area.
pub(crate) fn style(ui: &egui::Ui) -> Style {
    let palette = theme::of(ui);
    let mut style = Style::from_egui(ui.style());
    style.dock_area_padding = None;
    style.main_surface_border_stroke = egui::Stroke::NONE;
    style.separator.width = 1.0;
    style.separator.extra_interact_width = theme::GAP;
    style.separator.extra = 120.0;
    style.separator.color_idle = palette.field_hovered;
    style.separator.color_hovered = palette.accent;
    style.separator.color_dragged = palette.accent;
    style.tab_bar.bg_fill = palette.field;
    style.tab_bar.height = theme::TAB_BAR_HEIGHT;
    style.tab_bar.hline_color = palette.field_hovered;
    style.tab_bar.corner_radius = egui::CornerRadius::ZERO;
    style.tab.hline_below_active_tab_name = false;
    style.tab.spacing = 0.0;
    style.tab.tab_body.bg_fill = palette.panel;
    style.tab.tab_body.stroke = egui::Stroke::NONE;
    style.tab.tab_body.corner_radius = egui::CornerRadius::ZERO;
    style.tab.tab_body.inner_margin = egui::Margin::same(theme::GAP as i8 + 2);
    // Reserve no space for the hidden tab bar of the stage.
    style.tab.tab_body.hidden_tab_bar_drag_height = Some(0.0);
    style.buttons.show_tab_bar_size = 0.0;
    style.buttons.show_tab_bar_hover_expand = 0.0;
    for (tab, fill, text) in [
        (&mut style.tab.active, palette.panel, palette.text),
        (&mut style.tab.focused, palette.panel, palette.text),
        (&mut style.tab.inactive, palette.field, palette.text_weak),
        (&mut style.tab.hovered, palette.field_hovered, palette.text),
        (&mut style.tab.active_with_kb_focus, palette.panel, palette.accent),
        (&mut style.tab.focused_with_kb_focus, palette.panel, palette.accent),
        (&mut style.tab.inactive_with_kb_focus, palette.field, palette.accent),
    ] {
        tab.bg_fill = fill;
        tab.text_color = text;
        tab.outline_color = egui::Color32::TRANSPARENT;
        tab.corner_radius = egui::CornerRadius::ZERO;
    }
    style
}

#[cfg(test)]
mod tests;
