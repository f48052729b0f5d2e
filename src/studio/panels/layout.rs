//! Where the panels are: beside the stage, stacked, folded up, floating, as a person has put them.

use bevy_egui::egui;
use egui_dock::{DockState, Node, NodeIndex, Style, SurfaceIndex, TabPath};
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use crate::studio::look;

/// A panel that can be put anywhere, and the stage, which stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::studio) enum PanelKind {
    /// What everything else stands around: the world with its player.
    Stage,
    /// Steer evolution.
    Run,
    /// The world and the snake: tune them.
    World,
    /// What evolution does.
    Charts,
    /// The best of every generation.
    Champions,
    /// What was kept.
    Library,
    /// What the report found out, to try.
    Lessons,
}

impl PanelKind {
    /// All but the stage, in the order of the menu.
    pub const ALL: [Self; 6] =
        [Self::Run, Self::World, Self::Charts, Self::Champions, Self::Library, Self::Lessons];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stage => "Stage",
            Self::Run => "Run",
            Self::World => "World",
            Self::Charts => "Charts",
            Self::Champions => "Champions",
            Self::Library => "Library",
            Self::Lessons => "Lessons",
        }
    }

    /// What it is for.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Stage => "The snake on its stairs",
            Self::Run => "Steer evolution (Ctrl 1)",
            Self::World => "Tune the surface, the snake and the stairs (Ctrl 2)",
            Self::Charts => "See what evolution does (Ctrl 3)",
            Self::Champions => "Replay the best of every generation (Ctrl 4)",
            Self::Library => "Everything that was kept: replay it, share it (Ctrl 5)",
            Self::Lessons => "Five short lessons to try out (Ctrl 6)",
        }
    }
}

/// Where the panels are.
#[derive(Debug, Clone)]
pub(in crate::studio) struct Layout {
    state: DockState<PanelKind>,
    /// Whether the panels shall be where they are at first, as soon as the window's size is known.
    is_to_be_laid_out: bool,
    /// The panel to be brought to the front then.
    first: Option<PanelKind>,
}

/// A window that is as wide has room for panels on both sides of the stage, in points.
const WIDE: f32 = 1500.0;
/// A window that is as high has room for the champions below the other panels, in points.
const HIGH: f32 = 800.0;
/// Width of the panels at the left, in points: all their names fit.
const LEFT: f32 = 384.0;
/// The stage has at least this share of what it divides with the panels beside it.
const LEAST_STAGE: f32 = 0.4;
/// Width of the panels at the right of a wide window, in points.
const RIGHT: f32 = 420.0;

impl Default for Layout {
    fn default() -> Self {
        Self { state: DockState::new(vec![PanelKind::Stage]), is_to_be_laid_out: true, first: None }
    }
}

impl Layout {
    /// The panels as they are at first in a window of this size, in points.
    fn at_first(size: egui::Vec2) -> DockState<PanelKind> {
        let mut state = DockState::new(vec![PanelKind::Stage]);
        let surface = state.main_surface_mut();
        let (is_wide, is_high) = (size.x >= WIDE, size.y >= HIGH);
        let mut left = PanelKind::ALL.to_vec();
        let mut stage = NodeIndex::root();
        if is_wide {
            left.retain(|kind| ![PanelKind::Charts, PanelKind::Library].contains(kind));
            let right = vec![PanelKind::Charts, PanelKind::Library];
            [stage, _] = surface.split_right(stage, 1.0 - RIGHT / size.x, right);
        }
        let room = if is_wide { size.x - RIGHT } else { size.x };
        let share = (LEFT / room.max(1.0)).min(1.0 - LEAST_STAGE);
        left.retain(|kind| !is_high || *kind != PanelKind::Champions);
        let [_, node] = surface.split_left(stage, share, left);
        if is_high {
            let _ = surface.split_below(node, 0.68, vec![PanelKind::Champions]);
        }
        state
    }

    /// Puts the panels back where they are at first.
    pub fn reset(&mut self) {
        self.is_to_be_laid_out = true;
    }

    /// The panels in a window of this size, in points, to be drawn.
    ///
    /// While the panels' size is changing, which is `is_settled` no more, nothing is measured.
    pub fn state_in(&mut self, size: egui::Vec2, is_settled: bool) -> &mut DockState<PanelKind> {
        if self.is_to_be_laid_out {
            self.state = Self::at_first(size);
            self.is_to_be_laid_out = false;
            self.first.take().into_iter().for_each(|kind| self.open(kind));
        }
        if is_settled {
            self.keep_widths(size.x);
        }
        // The stage alone needs no tab to choose it by; with company it does.
        for (_, leaf) in self.state.iter_leaves_mut() {
            leaf.tab_bar_hidden = leaf.tabs == [PanelKind::Stage];
        }
        &mut self.state
    }

    /// In a window of another width than before the panels beside the stage stay as wide as they were, in points.
    fn keep_widths(&mut self, width: f32) {
        let Some((stage, _)) = self.state.find_main_surface_tab(&PanelKind::Stage) else { return };
        let tree = self.state.main_surface_mut();
        let before = tree.root_node().and_then(Node::rect).map_or(0.0, |rect| rect.width());
        if !before.is_finite() || before <= 0.0 || (before - width).abs() < 1.0 {
            return;
        }
        // From the root to the stage.
        let up = std::iter::successors(Some(stage), |node| node.parent());
        let mut way: Vec<NodeIndex> = up.collect();
        way.reverse();
        let (mut before, mut now) = (before, width);
        for pair in way.windows(2) {
            let is_first = pair[1].is_left();
            if let Node::Horizontal(split) = &mut tree[pair[0]] {
                let of_stage = |fraction: f32| if is_first { fraction } else { 1.0 - fraction };
                let share = of_stage(split.fraction);
                let beside = before * (1.0 - share);
                let next = (1.0 - beside / now.max(1.0)).clamp(LEAST_STAGE, 0.97);
                split.fraction = of_stage(next);
                (before, now) = (before * share, now * next);
            }
        }
    }

    /// Whether a panel is to be seen, or could be by a click on its name.
    pub fn has(&self, kind: PanelKind) -> bool {
        self.state.find_tab(&kind).is_some()
    }

    /// Brings a panel to the front, back to where panels are if it was closed.
    pub fn open(&mut self, kind: PanelKind) {
        if self.is_to_be_laid_out {
            self.first = Some(kind);
            return;
        }
        if !self.has(kind) {
            let home = self.home_of(kind);
            match home {
                Some(path) => {
                    if let Ok(leaf) = self.state.leaf_mut(path.node_path()) {
                        leaf.tabs.push(kind);
                    }
                }
                None => {
                    let root = NodeIndex::root();
                    let _ = self.state.main_surface_mut().split_left(root, 0.27, vec![kind]);
                }
            }
        }
        if let Some(path) = self.state.find_tab(&kind) {
            let _ = self.state.set_active_tab(path);
            self.state.set_focused_node_and_surface(path.node_path());
            if let Ok(leaf) = self.state.leaf_mut(path.node_path()) {
                leaf.collapsed = false;
            }
        }
    }

    /// Where a panel goes that was closed: beside one it usually stands with, or beside any.
    fn home_of(&self, kind: PanelKind) -> Option<TabPath> {
        let usual: &[PanelKind] = match kind {
            PanelKind::Charts | PanelKind::Library => &[PanelKind::Charts, PanelKind::Library],
            _ => &[PanelKind::Run, PanelKind::World, PanelKind::Lessons],
        };
        let found = |kinds: &[PanelKind]| kinds.iter().find_map(|kind| self.state.find_tab(kind));
        found(usual).or_else(|| found(&PanelKind::ALL))
    }

    /// Closes the panel that was used last.
    pub fn close_front(&mut self) {
        let front = self.state.focused_leaf().and_then(|path| self.state.leaf(path).ok());
        if let Some(kind) = front.and_then(|leaf| leaf.tabs.get(leaf.active.0).copied()) {
            self.close(kind);
        }
    }

    /// Closes a panel. The stage stays.
    fn close(&mut self, kind: PanelKind) {
        if kind != PanelKind::Stage
            && let Some(path) = self.state.find_tab(&kind)
        {
            self.state.remove_tab(path);
        }
    }

    /// Where the panels are, as text.
    pub fn to_text(&self) -> String {
        if self.is_to_be_laid_out {
            return String::new();
        }
        let text = ron::to_string(&self.state).unwrap_or_default();
        format!("{} {text}", seal(&text))
    }

    /// The panels where a text says; where they are at first, if it does not make sense.
    pub fn from_text(text: &str) -> Self {
        // What another version wrote, or a hand, could be a layout that cannot be drawn.
        let own = text.split_once(' ').filter(|(sum, text)| *sum == seal(text));
        let read = own.and_then(|(_, text)| ron::from_str(text).ok()).filter(is_sound);
        read.map_or_else(Self::default, |state| Self {
            state,
            is_to_be_laid_out: false,
            first: None,
        })
    }
}

/// Stands for a layout's text and the version of the program that wrote it.
fn seal(text: &str) -> String {
    format!("{:016x}", xxh3_64(format!("{} {text}", env!("CARGO_PKG_VERSION")).as_bytes()))
}

/// Whether there is one stage, in the window itself, and nothing twice.
fn is_sound(state: &DockState<PanelKind>) -> bool {
    let kinds: Vec<PanelKind> = state.iter_all_tabs().map(|(_, kind)| *kind).collect();
    let count = |kind: &PanelKind| kinds.iter().filter(|other| *other == kind).count();
    let stage = state.find_tab(&PanelKind::Stage);
    stage.is_some_and(|path| path.surface == SurfaceIndex::main())
        && kinds.iter().all(|kind| count(kind) == 1)
}

/// How the panels' frames look.
pub(super) fn style(ui: &egui::Ui) -> Style {
    let palette = look::of(ui);
    let mut style = Style::from_egui(ui.style());
    style.dock_area_padding = None;
    style.main_surface_border_stroke = egui::Stroke::NONE;
    style.separator.width = 1.0;
    style.separator.extra_interact_width = look::GAP;
    style.separator.extra = 120.0;
    style.separator.color_idle = palette.field_hovered;
    style.separator.color_hovered = palette.accent;
    style.separator.color_dragged = palette.accent;
    style.tab_bar.bg_fill = palette.field;
    style.tab_bar.height = look::TAB_BAR_HEIGHT;
    style.tab_bar.hline_color = palette.field_hovered;
    style.tab_bar.corner_radius = egui::CornerRadius::ZERO;
    style.tab.hline_below_active_tab_name = false;
    style.tab.spacing = 0.0;
    style.tab.tab_body.bg_fill = palette.panel;
    style.tab.tab_body.stroke = egui::Stroke::NONE;
    style.tab.tab_body.corner_radius = egui::CornerRadius::ZERO;
    style.tab.tab_body.inner_margin = egui::Margin::same(look::GAP as i8 + 2);
    // The stage's tab, which hides when it is alone, leaves nothing of itself.
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
mod tests {
    use super::*;

    fn laid_out(width: f32) -> Layout {
        let mut layout = Layout::default();
        layout.state_in(egui::vec2(width, width * 9.0 / 16.0), true);
        layout
    }

    #[test]
    fn at_first_every_panel_is_there_once_in_a_narrow_window_and_in_a_wide_one() {
        for width in [640.0, 1280.0, 2560.0] {
            let layout = laid_out(width);
            assert!(PanelKind::ALL.iter().all(|kind| layout.has(*kind)), "{width}");
            assert!(is_sound(&layout.state), "{width}");
        }
    }

    #[test]
    fn a_panel_that_was_closed_comes_back_and_the_stage_cannot_be_closed() {
        let mut layout = laid_out(1280.0);
        for kind in PanelKind::ALL {
            layout.close(kind);
            assert!(!layout.has(kind));
        }
        layout.close(PanelKind::Stage);
        assert!(layout.has(PanelKind::Stage));
        for kind in PanelKind::ALL {
            layout.open(kind);
            assert!(layout.has(kind));
        }
        assert!(is_sound(&layout.state));
    }

    #[test]
    fn in_a_wider_window_the_stage_grows_and_the_panels_stay() {
        let left = |layout: &Layout| {
            let path = layout.state.find_tab(&PanelKind::Run).expect("there");
            let root = layout.state.main_surface().root_node().expect("a root");
            let Node::Horizontal(split) = root else { panic!("split") };
            assert_eq!(path.node, NodeIndex(1));
            split.fraction
        };
        let mut layout = laid_out(1280.0);
        assert!((left(&layout) * 1280.0 - LEFT).abs() < 1.0);
        // Drawing says where it was drawn.
        let drawn = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 700.0));
        layout.state.main_surface_mut().root_node_mut().expect("a root").set_rect(drawn);
        layout.state_in(egui::vec2(1920.0, 1080.0), true);
        assert!((left(&layout) * 1920.0 - LEFT).abs() < 1.0);
    }

    #[test]
    fn a_panel_asked_for_before_the_window_has_a_size_is_in_front_then() {
        let mut layout = Layout::default();
        layout.open(PanelKind::Charts);
        layout.state_in(egui::vec2(1280.0, 720.0), true);
        let path = layout.state.find_tab(&PanelKind::Charts).expect("there");
        let leaf = layout.state.leaf(path.node_path()).expect("a leaf");
        assert_eq!(leaf.active, path.tab);
    }

    #[test]
    fn where_the_panels_are_comes_back_from_its_text_and_nonsense_does_not() {
        let mut layout = laid_out(1280.0);
        layout.close(PanelKind::Lessons);
        let again = Layout::from_text(&layout.to_text());
        assert!(!again.is_to_be_laid_out && !again.has(PanelKind::Lessons));
        assert!(again.has(PanelKind::Charts));
        for text in ["", "(", "()", "(surfaces:[],focused_surface:None)"] {
            assert!(Layout::from_text(text).is_to_be_laid_out, "{text}");
        }
        let by_hand = layout.to_text().replace("fraction:0.3", "fraction:0.4");
        assert!(Layout::from_text(&by_hand).is_to_be_laid_out);
        let twice = layout.to_text().replace("Stage", "Lessons");
        let text = twice.split_once(' ').expect("sealed").1;
        assert!(Layout::from_text(&format!("{} {text}", seal(text))).is_to_be_laid_out);
    }
}
