//! Pictures of the bodies in an archive: a small one in each cell, and a large one beside the pointer.

use bevy_egui::egui;

use crate::studio::ui::theme;
use snakes_core::evolve::{Archive, EliteGenes};
use snakes_core::score::AgentSettings;
use snakes_core::world::BodyPlan;
use snakes_lab::mesh::Outlines;
use snakes_lab::plot::Role;

/// Minimum width of a cell with a picture, in points. In a narrower cell the picture would be unrecognizable.
const LEAST_WIDTH: f32 = 16.0;
/// Maximum share of a cell's width that its picture takes.
const FILLED: f32 = 0.9;
/// Maximum size of the large picture, in points.
const LARGE: egui::Vec2 = egui::vec2(200.0, 60.0);

/// A body, seen from the side.
#[derive(Debug, Clone)]
struct SideView {
    length_m: f32,
    height_m: f32,
    /// Outline of each limb: see [`Outlines::seen`].
    limbs_m: Vec<Vec<[f32; 2]>>,
}

/// Bodies of an archive's elites, in the order of their cells. Empty if all elites have the same body.
#[derive(Debug, Clone, Default)]
pub(super) struct ArchivePictures {
    bodies: Vec<SideView>,
    longest_m: f32,
}

impl ArchivePictures {
    /// Creates the pictures of the elites, if the elites have different bodies.
    pub fn of(archive: &Archive, agent: &AgentSettings) -> Self {
        let body = |genes: &EliteGenes| match genes {
            EliteGenes::Point(_) => None,
            EliteGenes::Genome(genome) => Some(SideView::of(&agent.body_plan(genome))),
        };
        let bodies: Option<Vec<SideView>> =
            archive.elites().map(|(_, elite)| body(&elite.genes)).collect();
        let bodies = bodies.unwrap_or_default();
        let longest_m = bodies.iter().map(|body| body.length_m).fold(0.0, f32::max);
        Self { bodies, longest_m }
    }

    /// Draws the body of the cell with this index from the side, with the head on the right, as large as the cell
    /// allows. The length is given by the cell's row. `ground` is the colour of the cell.
    pub fn draw(
        &self,
        painter: &egui::Painter,
        index: usize,
        rect: egui::Rect,
        ground: egui::Color32,
    ) {
        let Some(body) = self.bodies.get(index).filter(|_| rect.width() >= LEAST_WIDTH) else {
            return;
        };
        let scale = FILLED * body.scale(body.length_m, rect.size());
        let ink = theme::palette::text_on(ground);
        let shades = [ink.gamma_multiply(0.9), ink.gamma_multiply(0.5)];
        body.draw(painter, rect.center(), scale, shades);
    }

    /// Draws a large picture of the body in the cell with this index, in red and blue.
    pub fn large(&self, ui: &mut egui::Ui, index: usize) {
        let Some(body) = self.bodies.get(index) else { return };
        let scale = body.scale(self.longest_m, LARGE);
        let size = egui::vec2(body.length_m, body.height_m) * scale;
        let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        let palette = theme::of(ui);
        let colors = [palette.role(Role::Red), palette.role(Role::Blue)];
        body.draw(ui.painter(), area.center(), scale, colors);
    }
}

impl SideView {
    fn of(body: &BodyPlan) -> Self {
        let outlines = Outlines::of(body);
        let [_, length_m, height_m] = outlines.size_m();
        Self { length_m, height_m, limbs_m: outlines.seen(2) }
    }

    /// Returns the points per metre with which a body of this height and of a length in metres fits into a room.
    fn scale(&self, length_m: f32, room: egui::Vec2) -> f32 {
        let size_m = egui::vec2(length_m, self.height_m).max(egui::Vec2::splat(f32::MIN_POSITIVE));
        (room / size_m).min_elem()
    }

    /// Draws the limbs alternately in two colours, with the head on the right, where the stairs are.
    fn draw(
        &self,
        painter: &egui::Painter,
        center: egui::Pos2,
        scale: f32,
        colors: [egui::Color32; 2],
    ) {
        let corner = center + egui::vec2(self.length_m, -self.height_m) * (scale / 2.0);
        let point = |[along_m, down_m]: &[f32; 2]| corner + egui::vec2(-along_m, *down_m) * scale;
        for (limb, corners) in self.limbs_m.iter().enumerate() {
            let points = corners.iter().map(point).collect();
            painter.add(egui::Shape::convex_polygon(points, colors[limb % 2], egui::Stroke::NONE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{bodies_run, explored_run};

    #[test]
    fn every_elite_with_a_body_of_its_own_has_a_picture() {
        let run = bodies_run();
        let exploration = run.exploration().expect("explored");
        let archive = exploration.archive.as_ref().expect("MAP-Elites keeps one");
        let pictures = ArchivePictures::of(archive, &run.settings().trial.agent);
        assert_eq!(pictures.bodies.len(), archive.elites().len());
        for ((cell, _), body) in archive.elites().zip(&pictures.bodies) {
            let [column, _] = archive.place(cell);
            assert_eq!(body.limbs_m.len() as u32, column + 2, "the columns are numbers of blocks");
        }
        assert!((4.0..=12.01).contains(&pictures.longest_m), "{} m", pictures.longest_m);
    }

    #[test]
    fn snakes_with_a_common_body_have_none() {
        let run = explored_run();
        let archive = run.exploration().and_then(|of| of.archive.as_ref()).expect("one");
        let pictures = ArchivePictures::of(archive, &run.settings().trial.agent);
        assert!(pictures.bodies.is_empty());
    }
}
