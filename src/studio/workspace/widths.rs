//! Widths of the panels beside the stage, in points.
//!
//! The dock stores shares of the window's width. What a person chooses is a width: it shall survive a smaller window
//! and a larger scale, which leave less room for a while. [`PanelWidths`] keeps the chosen widths, and computes the
//! shares anew whenever the room or the arrangement changes. It does not change which panel is where.

use egui_dock::{Node, NodeIndex, Tree};
use serde::{Deserialize, Serialize};

use crate::studio::commands::panel::PanelKind;

/// Minimum width of a panel, in points: its contents, its margins and its scroll bar. The panels' tests check that their
/// contents fit.
pub const LEAST_PANEL: f32 = 356.0;
/// Minimum fraction of the window for the stage, beside panels that are wider than they need to be.
const STAGE_SHARE: f32 = 0.4;
/// Width of the stage, in points, from which the buttons of the player fit below it.
const ROOMY_STAGE: f32 = 400.0;
/// Minimum width of the stage, in points, beside panels of minimum width.
const LEAST_STAGE: f32 = 200.0;
/// Largest difference between shares that are the same.
const SAME: f32 = 1.0e-5;

/// The place of panels beside the stage: the side, and the number of splits further out on the same side.
type Place = (StageSide, usize);

/// A side of the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum StageSide {
    Left,
    Right,
}

/// The chosen widths of the panels beside the stage.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PanelWidths {
    chosen: Vec<(Place, f32)>,
    /// The shares of the stage's side that were set last, by split. Another share is a person's choice.
    #[serde(skip)]
    shares: Vec<(NodeIndex, f32)>,
    /// The width for which they were set, in points.
    #[serde(skip)]
    room: f32,
}

/// A split with the stage on one side and panels on the other.
struct Beside {
    node: NodeIndex,
    place: Place,
    /// Minimum width of the panels, in points.
    least: f32,
    /// Fraction of the split's width on the side of the stage.
    share: f32,
}

impl PanelWidths {
    /// Forgets all widths, for a new layout.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes note that the program has arranged the panels anew. Chosen widths stay.
    pub fn panels_were_rearranged(&mut self) {
        self.shares.clear();
        self.room = 0.0;
    }

    /// Whether the widths can be those of a layout.
    pub fn are_sound(&self) -> bool {
        let is_sound = |width: f32| width.is_finite() && (0.0..=20_000.0).contains(&width);
        self.chosen.len() <= 20 && self.chosen.iter().all(|(_, width)| is_sound(*width))
    }

    /// Takes over what a person has dragged since the last call, and fits the panels into a window of this width, in
    /// points.
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

    /// The chosen width of the panels at a place, in points.
    fn of(&self, place: Place) -> f32 {
        let chosen = self.chosen.iter().find(|(of, _)| *of == place);
        chosen.map_or(LEAST_PANEL, |(_, width)| *width)
    }

    fn choose(&mut self, place: Place, width: f32) {
        self.chosen.retain(|(of, _)| *of != place);
        self.chosen.push((place, width));
    }

    /// Notes the widths of splits that are new or were dragged.
    fn note_dragged(&mut self, splits: &[Beside], width: f32) {
        let is_first = self.shares.is_empty();
        // Shares were dragged in the window as it was.
        let mut room = if self.room > 0.0 { self.room } else { width };
        for split in splits {
            let set = self.shares.iter().find(|(node, _)| *node == split.node);
            let is_as_set = set.is_some_and(|(_, share)| (share - split.share).abs() < SAME);
            let is_restored =
                is_first && self.chosen.iter().any(|(place, _)| *place == split.place);
            if !is_as_set && !is_restored {
                self.choose(split.place, (room * (1.0 - split.share)).max(split.least));
            }
            room *= split.share;
        }
    }
}

/// The splits on the way from the root to the stage, the outermost first.
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

/// Number of panels side by side below a node.
fn columns(tree: &Tree<PanelKind>, node: NodeIndex) -> usize {
    if node.0 >= tree.len() {
        return 1;
    }
    let both = || (columns(tree, node.left()), columns(tree, node.right()));
    match &tree[node] {
        Node::Horizontal(_) => {
            let (left, right) = both();
            left + right
        }
        Node::Vertical(_) => {
            let (above, below) = both();
            above.max(below)
        }
        Node::Leaf(_) | Node::Empty => 1,
    }
}

/// The widths for a window of this width, in points: those that are wanted, if the stage keeps its share. Otherwise all
/// shrink towards their minimum by the same part of what they can spare.
fn fitted(wanted: &[f32], splits: &[Beside], width: f32) -> Vec<f32> {
    let least: f32 = splits.iter().map(|split| split.least).sum();
    let spare: f32 = wanted.iter().zip(splits).map(|(wanted, split)| wanted - split.least).sum();
    let beside_roomy = width - (width * STAGE_SHARE).max(ROOMY_STAGE);
    let room = beside_roomy.max(least).min((width - LEAST_STAGE).max(0.0));
    if room < least {
        // Not even the minimum has room.
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

    // Panels are tested at this width inside their margins and their scroll bar.
    const _: () = assert!(LEAST_PANEL - 3.5 * theme::GAP >= theme::PANEL_WIDTH);

    const LEFT: Place = (StageSide::Left, 0);
    const RIGHT: Place = (StageSide::Right, 0);

    /// The stage between panels of 384 and 420 points, in a window of 1600 points.
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

    /// Widths of the panels on the left and on the right, and of the stage, in points.
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
        // The scales 1.1, 1.25, 1.5 and 1.75 leave that many points.
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
