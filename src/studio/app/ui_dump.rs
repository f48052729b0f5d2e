//! Writes all controls of the panels to a file for scripts and tests: role, label, rectangle and value, as a screen
//! reader receives them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use bevy::prelude::*;
use bevy_egui::egui::accesskit::{Node, NodeId, Role, Toggled};
use bevy_egui::{EguiContext, EguiOutput, EguiPostUpdateSet, PrimaryEguiContext};

use crate::studio::ui::notifications::Notices;
use snakes_core::save::store_text;

/// File to which the controls are written; `None` to write nothing.
#[derive(Resource, Debug, Default)]
pub(crate) struct UiDumpFile(pub Option<PathBuf>);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<UiDumpFile>().add_systems(
        PostUpdate,
        describe
            .after(EguiPostUpdateSet::ProcessOutput)
            .run_if(|places: Res<UiDumpFile>| places.0.is_some()),
    );
}

/// Writes one line per control, separated by tabs: role; left, top, right, bottom in logical pixels; label; value. The
/// value in the first line is the number of the frame, so that a script can wait for the frames after its input.
fn describe(
    mut places: ResMut<UiDumpFile>,
    mut contexts: Query<(&mut EguiContext, &EguiOutput), With<PrimaryEguiContext>>,
    mut notices: ResMut<Notices>,
    mut frame: Local<u64>,
) {
    let Some(path) = &places.0 else { return };
    for (mut context, output) in &mut contexts {
        let context = context.get_mut();
        context.enable_accesskit();
        let Some(update) = &output.platform_output.accesskit_update else { continue };
        *frame += 1;
        let controls = listed(&update.nodes, f64::from(context.zoom_factor()));
        let text = format!("Frame\t0\t0\t0\t0\tFrame\t{}\n{controls}", *frame);
        if let Err(error) = store_text(path, &text) {
            notices.problem(error.to_string());
            places.0 = None;
            return;
        }
    }
}

/// Lists each node with a name or a value in a line. `scale` is the number of logical pixels per point.
fn listed(nodes: &[(NodeId, Node)], scale: f64) -> String {
    let by_id: BTreeMap<NodeId, &Node> = nodes.iter().map(|(id, node)| (*id, node)).collect();
    let mut lines = Vec::new();
    for (_, node) in nodes {
        let (role, label, value) = (node.role(), label_of(node, &by_id), value_of(node));
        // A text run is skipped, because its parent's label or value already contains the text.
        let is_named = !(label.is_empty() && value.is_empty()) && role != Role::TextRun;
        let Some(place) = node.bounds().filter(|_| is_named) else { continue };
        let ends = [place.x0, place.y0, place.x1, place.y1].map(|end| (end * scale).round() as i64);
        let [left, top, right, bottom] = ends;
        let line = format!("{role:?}\t{left}\t{top}\t{right}\t{bottom}\t{label}\t{value}\n");
        lines.push(([top, left], line));
    }
    // Sorts the lines by position, from top to bottom.
    lines.sort();
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Returns the node's own label, or that of the node that labels it.
fn label_of(node: &Node, by_id: &BTreeMap<NodeId, &Node>) -> String {
    let beside = || node.labelled_by().iter().find_map(|id| by_id.get(id)?.value());
    // The text of a label that does not label another control is its value.
    let label = node.label().or_else(beside).or(node.value());
    in_one_line(label.unwrap_or_default())
}

/// Returns the node's number or text, or whether it is on.
fn value_of(node: &Node) -> String {
    match (node.numeric_value(), node.toggled()) {
        (Some(number), _) => number.to_string(),
        (None, Some(Toggled::True)) => "on".to_owned(),
        (None, Some(_)) => "off".to_owned(),
        (None, None) => in_one_line(node.value().unwrap_or_default()),
    }
}

fn in_one_line(text: &str) -> String {
    text.replace(['\n', '\t'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::accesskit::Rect;

    #[test]
    fn a_control_is_listed_with_its_label_and_value() {
        let node = |role: Role, left: f64| {
            let mut node = Node::new(role);
            node.set_bounds(Rect::new(left, 0.0, left + 10.0, 10.0));
            node
        };
        let mut words = node(Role::Label, 0.0);
        words.set_value("Friction");
        let mut slider = node(Role::Slider, 20.0);
        slider.push_labelled_by(NodeId(1));
        slider.set_numeric_value(0.5);
        let mut tick = node(Role::CheckBox, 40.0);
        tick.set_label("Two\nlines");
        tick.set_toggled(Toggled::True);
        let nodes = [
            (NodeId(1), words),
            (NodeId(2), slider),
            (NodeId(3), tick),
            (NodeId(4), node(Role::Pane, 0.0)),
        ];
        let expected = "Label\t0\t0\t15\t15\tFriction\tFriction\n\
                        Slider\t30\t0\t45\t15\tFriction\t0.5\n\
                        CheckBox\t60\t0\t75\t15\tTwo lines\ton\n";
        assert_eq!(listed(&nodes, 1.5), expected);
    }
}
