//! A network as a graph: inputs on the left, outputs on the right, weights as lines, activities as colours.

use bevy_egui::egui::{self, Align2, Color32, Pos2, Stroke};

use crate::studio::ui::accessible::named;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::text_rows::{explain, weak};
use crate::studio::ui::theme;
use snakes_core::control::{NetworkActivity, NetworkLink, NetworkNode, NodeColumn};

/// Height of an input with a name, in points.
const NAMED_ROW: f32 = theme::GAP * 1.75;
/// Maximum number of inputs with names beside them.
const MOST_NAMED: usize = 28;
/// Maximum height of the graph, in points.
const MOST_HEIGHT: f32 = theme::GAP * 48.0;
/// Minimum height of the graph, in points.
const LEAST_HEIGHT: f32 = theme::GAP * 16.0;
/// Width of the names beside the inputs, and of those beside the outputs, in points.
const INPUT_NAMES: f32 = theme::GAP * 15.5;
const OUTPUT_NAMES: f32 = theme::GAP * 9.5;
/// Maximum radius of a node, in points.
const RADIUS: f32 = theme::GAP * 0.75;
/// Width of the strongest link, in points.
const STRONGEST: f32 = 3.0;

/// Draws the graph of a network.
pub(super) fn network_graph(ui: &mut egui::Ui, network: &NetworkActivity) {
    let whose = network.joint.map_or_else(String::new, |joint| format!("Joint {}. ", joint + 1));
    let text = "Lines are weights, wider for larger ones; nodes show activity. Point at a node to see its links.";
    let names_inputs = count(network, NodeColumn::Input) <= MOST_NAMED;
    let senses = if names_inputs { "" } else { " At the left are all its senses." };
    explain(ui, &format!("{whose}{text}{senses}"));
    legend(ui);
    let places = Places::of(ui, network, names_inputs);
    let mut hovered = None;
    for (index, node) in network.nodes.iter().enumerate() {
        let area = egui::Rect::from_center_size(places.at[index], places.target(node.column));
        let response = ui.interact(area, ui.id().with(("node", index)), egui::Sense::hover());
        let said = format!("{} {}", node.name, decimals(node.value, 2));
        let response = named(response, egui::WidgetType::Other, &said);
        if response.hovered() {
            hovered = Some(index);
        }
        response.on_hover_ui(|ui| strongest(ui, network, index, &said));
    }
    links(ui, network, &places, hovered);
    for (index, node) in network.nodes.iter().enumerate() {
        draw_node(ui, node, index, &places);
    }
}

/// Draws the meaning of the colours.
fn legend(ui: &mut egui::Ui) {
    let palette = theme::of(ui);
    ui.horizontal(|ui| {
        for (color, text) in [(palette.torque_plus, "positive"), (palette.torque_minus, "negative")]
        {
            let size = egui::vec2(theme::SAMPLE_WIDTH, theme::GAP);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(STRONGEST, color));
            ui.label(weak(ui, text).small());
        }
    });
}

/// Returns the number of nodes in a column.
fn count(network: &NetworkActivity, column: NodeColumn) -> usize {
    network.nodes.iter().filter(|node| node.column == column).count()
}

/// Positions of the nodes.
struct Places {
    at: Vec<Pos2>,
    radius: f32,
    /// Whether the inputs have names beside them.
    names_inputs: bool,
    /// Distance between two inputs, in points.
    row: f32,
}

impl Places {
    /// Allocates the area of the graph, and places the nodes in it.
    fn of(ui: &mut egui::Ui, network: &NetworkActivity, names_inputs: bool) -> Self {
        let count = |column| count(network, column);
        let inputs = count(NodeColumn::Input);
        let height = (inputs as f32 * NAMED_ROW).clamp(LEAST_HEIGHT, MOST_HEIGHT);
        let size = egui::vec2(ui.available_width(), height + theme::GAP);
        let (room, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        let row = height / inputs.max(1) as f32;
        let radius = RADIUS.min(row * 0.42);
        let x_of = |column: NodeColumn| {
            let left = room.left() + if names_inputs { INPUT_NAMES } else { RADIUS * 2.0 };
            let right = room.right() - OUTPUT_NAMES;
            match column {
                NodeColumn::Input => left,
                NodeColumn::Hidden => (left + right) / 2.0,
                NodeColumn::Output => right,
            }
        };
        let mut placed = [0_usize; 3];
        let place = |node: &NetworkNode| {
            let total = count(node.column);
            let seen = &mut placed[node.column as usize];
            let share = (*seen as f32 + 0.5) / total.max(1) as f32;
            *seen += 1;
            // If there are many hidden nodes, they are staggered, so that links between them are visible.
            let is_staggered = node.column == NodeColumn::Hidden && total > 6;
            let aside = if is_staggered { (*seen % 3) as f32 - 1.0 } else { 0.0 };
            let x = x_of(node.column) + aside * theme::GAP * 3.0;
            egui::pos2(x, room.top() + theme::GAP / 2.0 + share * height)
        };
        let at = network.nodes.iter().map(place).collect();
        Self { at, radius, names_inputs, row }
    }

    fn radius_of(&self, column: NodeColumn) -> f32 {
        if column == NodeColumn::Input { self.radius } else { RADIUS }
    }

    /// Returns the size of the area around a node in which the pointer hovers over it, in points.
    fn target(&self, column: NodeColumn) -> egui::Vec2 {
        let radius = self.radius_of(column);
        let height = if column == NodeColumn::Input { self.row } else { radius * 2.5 };
        egui::vec2(radius * 2.5, height)
    }
}

/// Draws the links, the strongest on top. If a node is hovered, the links of other nodes are faded.
fn links(ui: &egui::Ui, network: &NetworkActivity, places: &Places, hovered: Option<usize>) {
    let palette = theme::of(ui);
    let most = network.links.iter().map(|link| link.weight.abs()).fold(0.0, f32::max);
    let mut links: Vec<_> = network.links.iter().collect();
    links.sort_by(|a, b| a.weight.abs().total_cmp(&b.weight.abs()));
    for link in links {
        let strength = if most > 0.0 { link.weight.abs() / most } else { 0.0 };
        let is_meant = hovered.is_none_or(|node| link.from == node || link.to == node);
        let full = if link.weight < 0.0 { palette.torque_minus } else { palette.torque_plus };
        // Links are faded towards the panel's colour. Opacity would be blended in linear light, which looks different.
        let shown = if is_meant { 0.2 + 0.8 * strength } else { 0.06 };
        let color = palette.panel.lerp_to_gamma(full, shown);
        let stroke = Stroke::new(0.5 + (STRONGEST - 0.5) * strength, color);
        let (from, to) = (places.at[link.from], places.at[link.to]);
        if link.from == link.to {
            let center = from - egui::vec2(0.0, RADIUS * 1.3);
            ui.painter().circle_stroke(center, RADIUS, stroke);
        } else if (from.x - to.x).abs() < 1.0 {
            // A straight link within a column would cross the nodes in between.
            let aside = egui::vec2(-theme::GAP * 3.0, 0.0);
            let points = [from, from + aside, to + aside, to];
            let curve = egui::epaint::CubicBezierShape::from_points_stroke(
                points,
                false,
                Color32::TRANSPARENT,
                stroke,
            );
            ui.painter().add(curve);
        } else {
            ui.painter().line_segment([from, to], stroke);
        }
    }
}

fn draw_node(ui: &egui::Ui, node: &NetworkNode, index: usize, places: &Places) {
    let palette = theme::of(ui);
    let (at, radius) = (places.at[index], places.radius_of(node.column));
    let full = if node.level < 0.0 { palette.torque_minus } else { palette.torque_plus };
    let fill = palette.panel.lerp_to_gamma(full, node.level.abs());
    ui.painter().circle(at, radius, fill, Stroke::new(1.0, palette.text_weak));
    let font = egui::FontId::proportional(theme::SMALL_SIZE);
    let beside = egui::vec2(radius + theme::GAP / 2.0, 0.0);
    match node.column {
        NodeColumn::Input if places.names_inputs => {
            ui.painter().text(at - beside, Align2::RIGHT_CENTER, &node.name, font, palette.text);
        }
        NodeColumn::Output => {
            let room = OUTPUT_NAMES - beside.x;
            let text =
                ui.fonts_mut(|fonts| fonts.layout(node.name.clone(), font, palette.text, room));
            let corner = at + beside - egui::vec2(0.0, text.size().y / 2.0);
            ui.painter().galley(corner, text, palette.text);
        }
        NodeColumn::Input | NodeColumn::Hidden => {}
    }
}

/// Maximum number of links that the tooltip of a node lists.
const MOST_LISTED: usize = 6;

/// Draws the name of a node, and lists its strongest links.
fn strongest(ui: &mut egui::Ui, network: &NetworkActivity, index: usize, said: &str) {
    ui.label(egui::RichText::new(said).strong());
    let is_of = |link: &&NetworkLink| link.from == index || link.to == index;
    let mut links: Vec<_> = network.links.iter().filter(is_of).collect();
    links.sort_by(|a, b| b.weight.abs().total_cmp(&a.weight.abs()));
    for link in links.iter().take(MOST_LISTED) {
        let (word, other) = if link.to == index { ("from", link.from) } else { ("to", link.to) };
        if let Some(node) = network.nodes.get(other) {
            ui.label(format!("{word} {}: weight {}", node.name, decimals(link.weight, 2)));
        }
    }
    if links.len() > MOST_LISTED {
        ui.label(format!("and {} weaker links", links.len() - MOST_LISTED));
    }
}
