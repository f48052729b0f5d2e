//! Widths of the panels beside the stage, in points.
//!
//! The dock stores shares of the window's width, but the user chooses a width. A chosen width must survive a
//! temporarily smaller window or larger scale. [`PanelWidths`] keeps the chosen widths, and recomputes the shares
//! whenever the available width or the arrangement changes. It does not move panels.

use egui_dock::{Node, NodeIndex, Tree};
use serde::{Deserialize, Serialize};

use crate::studio::commands::panel::PanelKind;

/// Minimum width of a panel, in points: contents, margins and scroll bar. The panels' tests check that the contents
/// fit.
pub const LEAST_PANEL: f32 = 356.0;
/// Minimum share of the window's width for the stage when panels are wider than their minimum.
const STAGE_SHARE: f32 = 0.4;
/// Minimum width of the stage, in points, at which the player's buttons fit below it.
const ROOMY_STAGE: f32 = 400.0;
/// Minimum width of the stage, in points, beside panels of minimum width.
const LEAST_STAGE: f32 = 200.0;
/// Tolerance within which two shares count as equal.
const SAME: f32 = 1.0e-5;

/// Place of panels beside the stage: the side of the stage, and the number of splits further out on that side.
type Place = (StageSide, usize);

/// Side of the stage on which panels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum StageSide {
    Left,
    Right,
}

/// Widths that the user chose for the panels beside the stage, in points.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PanelWidths {
    chosen: Vec<(Place, f32)>,
    /// Share of each split's width that was set last for the side of the stage. A different share means that the user dragged the split.
    #[serde(skip)]
    shares: Vec<(NodeIndex, f32)>,
    /// Window width for which `shares` were set, in points; 0 if unknown.
    #[serde(skip)]
    room: f32,
}

/// A horizontal split with the stage on one side and panels on the other.
struct Beside {
    node: NodeIndex,
    place: Place,
    /// Minimum width of the panels, in points.
    least: f32,
    /// Fraction of the split's width that the side of the stage takes.
    share: f32,
}

impl PanelWidths {
    /// Marks the shares as outdated after the program has rearranged the panels. Chosen widths stay.
    pub fn panels_were_rearranged(&mut self) {
        self.shares.clear();
        self.room = 0.0;
    }

    /// Checks that the number of widths and each width are plausible.
    pub fn are_sound(&self) -> bool {
        let is_sound = |width: f32| width.is_finite() && (0.0..=20_000.0).contains(&width);
        self.chosen.len() <= 20 && self.chosen.iter().all(|(_, width)| is_sound(*width))
    }

    /// Stores the widths that the user has dragged since the last call, and fits the panels into a window of this
    /// width, in points.
    pub fn fit(&mut self, tree: &mut Tree<PanelKind>, stage: NodeIndex, width: f32) {
        let splits = beside(tree, stage);
        self.note_dragged(&splits, width);
        let wanted: Vec<f32> =
            splits.iter().map(|split| self.of(split.place).max(split.least)).collect();
        let widths = fitted(&wanted, &splits, width);
        let mut room = width.max(1.0);
        self.shares.clear();
        for (split, beside) in splits.iter().zip(widths) {
            let share = (1.0 - beside / room).clamp(0.03, 0.97);
            if let Node::Horizontal(of_node) = &mut tree[split.node] {
                of_node.fraction =
                    if split.place.0 == StageSide::Right { share } else { 1.0 - share };
            }
            self.shares.push((split.node, share));
            room *= share;
        }
        self.room = width;
    }

    /// Returns the chosen width of the panels at a place, in points, or the minimum width.
    fn of(&self, place: Place) -> f32 {
        let chosen = self.chosen.iter().find(|(of, _)| *of == place);
        chosen.map_or(LEAST_PANEL, |(_, width)| *width)
    }

    /// Stores the panel widths of splits that are new or were dragged.
    fn note_dragged(&mut self, splits: &[Beside], width: f32) {
        let is_first = self.shares.is_empty();
        // Dragged shares refer to the window width of the last call.
        let mut room = if self.room > 0.0 { self.room } else { width };
        for split in splits {
            let set = self.shares.iter().find(|(node, _)| *node == split.node);
            let is_as_set = set.is_some_and(|(_, share)| (share - split.share).abs() < SAME);
            let is_restored =
                is_first && self.chosen.iter().any(|(place, _)| *place == split.place);
            if !is_as_set && !is_restored {
                let width = (room * (1.0 - split.share)).max(split.least);
                self.chosen.retain(|(of, _)| *of != split.place);
                self.chosen.push((split.place, width));
            }
            room *= split.share;
        }
    }
}

/// Returns the splits on the path from the root to the stage, the outermost first.
fn beside(tree: &Tree<PanelKind>, stage: NodeIndex) -> Vec<Beside> {
    let mut way: Vec<NodeIndex> =
        std::iter::successors(Some(stage), |node| node.parent()).collect();
    way.reverse();
    let mut counts = [0, 0];
    let split_of = |pair: &[NodeIndex]| {
        let [node, next] = *pair else { return None };
        let Node::Horizontal(split) = &tree[node] else { return None };
        let is_right = next.is_left();
        let (side, panels, share) = if is_right {
            (StageSide::Right, node.right(), split.fraction)
        } else {
            (StageSide::Left, node.left(), 1.0 - split.fraction)
        };
        let count = &mut counts[usize::from(is_right)];
        *count += 1;
        let least = columns(tree, panels) as f32 * LEAST_PANEL;
        Some(Beside { node, place: (side, *count - 1), least, share })
    };
    way.windows(2).filter_map(split_of).collect()
}

/// Counts the panels side by side below a node.
fn columns(tree: &Tree<PanelKind>, node: NodeIndex) -> usize {
    if node.0 >= tree.len() {
        return 1;
    }
    let [first, second] = [node.left(), node.right()].map(|part| columns(tree, part));
    match &tree[node] {
        Node::Horizontal(_) => first + second,
        Node::Vertical(_) => first.max(second),
        Node::Leaf(_) | Node::Empty => 1,
    }
}

/// Computes the panel widths for a window of this width, all in points. Panels get the wanted widths if the stage keeps
/// its share. Otherwise all shrink towards their minimum by the same part of what exceeds it.
fn fitted(wanted: &[f32], splits: &[Beside], width: f32) -> Vec<f32> {
    let least: f32 = splits.iter().map(|split| split.least).sum();
    let spare: f32 = wanted.iter().zip(splits).map(|(wanted, split)| wanted - split.least).sum();
    let beside_roomy = width - (width * STAGE_SHARE).max(ROOMY_STAGE);
    let room = beside_roomy.max(least).min((width - LEAST_STAGE).max(0.0));
    if room < least {
        // The window is too narrow even for the minimum widths.
        return splits.iter().map(|split| split.least * room / least).collect();
    }
    let part = if spare > 0.0 { ((room - least) / spare).min(1.0) } else { 1.0 };
    wanted
        .iter()
        .zip(splits)
        .map(|(wanted, split)| split.least + (wanted - split.least) * part)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::ui::theme;
    use egui_dock::DockState;

    // The panels' tests draw contents of this width, inside the margins and the scroll bar.
    const _: () = assert!(LEAST_PANEL - 3.5 * theme::GAP >= theme::PANEL_WIDTH);

    const LEFT: Place = (StageSide::Left, 0);
    const RIGHT: Place = (StageSide::Right, 0);

    /// Creates the stage between panels of 384 and 420 points, in a window of 1600 points.
    fn on_both_sides() -> (DockState<PanelKind>, PanelWidths) {
        let mut state = DockState::new(vec![PanelKind::Stage]);
        let surface = state.main_surface_mut();
        let [stage, _] =
            surface.split_right(NodeIndex::root(), 1.0 - 420.0 / 1600.0, vec![PanelKind::Charts]);
        surface.split_left(stage, 384.0 / 1180.0, vec![PanelKind::Run]);
        let mut widths = PanelWidths::default();
        fit(&mut state, &mut widths, 1600.0);
        (state, widths)
    }

    fn fit(state: &mut DockState<PanelKind>, widths: &mut PanelWidths, width: f32) {
        let (stage, _) = state.find_main_surface_tab(&PanelKind::Stage).expect("there");
        widths.fit(state.main_surface_mut(), stage, width);
    }

    /// Returns the widths of the left panels, the right panels and the stage, in points.
    fn drawn(state: &DockState<PanelKind>, width: f32) -> [f32; 3] {
        let fraction = |node: NodeIndex| match &state.main_surface()[node] {
            Node::Horizontal(split) => split.fraction,
            _ => panic!("a split"),
        };
        let right = width * (1.0 - fraction(NodeIndex::root()));
        let left = (width - right) * fraction(NodeIndex::root().left());
        [left, right, width - right - left].map(f32::round)
    }

    #[test]
    fn panels_have_their_widths_again_after_a_larger_scale() {
        let (mut state, mut widths) = on_both_sides();
        assert_eq!(drawn(&state, 1600.0), [384.0, 420.0, 796.0]);
        // Window widths in points that the scales 1.1, 1.25, 1.5 and 1.75 leave.
        for points in [1454.5, 1280.0, 1066.7, 914.3] {
            fit(&mut state, &mut widths, points);
            let [left, right, stage] = drawn(&state, points);
            assert!(left >= LEAST_PANEL && right >= LEAST_PANEL, "{left}, {right} of {points}");
            assert!(stage >= LEAST_STAGE, "{stage} of {points}");
        }
        fit(&mut state, &mut widths, 1600.0);
        assert_eq!(drawn(&state, 1600.0), [384.0, 420.0, 796.0]);
    }

    #[test]
    fn a_dragged_panel_keeps_its_new_width_and_no_panel_becomes_too_narrow() {
        let (mut state, mut widths) = on_both_sides();
        let drag = |state: &mut DockState<PanelKind>, fraction: f32| {
            let node = NodeIndex::root().left();
            let Node::Horizontal(split) = &mut state.main_surface_mut()[node] else {
                panic!("a split")
            };
            split.fraction = fraction;
        };
        drag(&mut state, 450.0 / 1180.0);
        fit(&mut state, &mut widths, 1600.0);
        assert_eq!(drawn(&state, 1600.0), [450.0, 420.0, 730.0]);
        assert_eq!(widths.of(LEFT).round(), 450.0);
        drag(&mut state, 100.0 / 1180.0);
        fit(&mut state, &mut widths, 1600.0);
        assert_eq!(drawn(&state, 1600.0)[0], LEAST_PANEL);
    }

    #[test]
    fn widths_survive_as_text_although_the_window_was_small() {
        let (mut state, mut widths) = on_both_sides();
        fit(&mut state, &mut widths, 914.0);
        let text = ron::to_string(&widths).expect("written");
        let mut widths: PanelWidths = ron::from_str(&text).expect("read");
        assert!(widths.are_sound());
        fit(&mut state, &mut widths, 1600.0);
        assert_eq!((widths.of(LEFT).round(), widths.of(RIGHT).round()), (384.0, 420.0));
        assert_eq!(drawn(&state, 1600.0), [384.0, 420.0, 796.0]);
    }

    #[test]
    fn panels_side_by_side_need_room_for_each() {
        let (mut state, mut widths) = on_both_sides();
        let path = state.find_tab(&PanelKind::Run).expect("there");
        state.main_surface_mut().split_below(path.node, 0.5, vec![PanelKind::World]);
        fit(&mut state, &mut widths, 1600.0);
        assert_eq!(drawn(&state, 1600.0)[0], 384.0);
        let path = state.find_tab(&PanelKind::Run).expect("there");
        state.main_surface_mut().split_right(path.node, 0.5, vec![PanelKind::Library]);
        fit(&mut state, &mut widths, 1600.0);
        assert!(drawn(&state, 1600.0)[0] >= 2.0 * LEAST_PANEL - 1.0, "{:?}", drawn(&state, 1600.0));
    }
}
