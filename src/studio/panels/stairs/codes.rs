//! The steepness of the stairs, and a comparison with building codes.

use bevy_egui::egui;

use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::world::{BUILDING_CODES, Stairs, TRUE_MM_PER_M};

/// Draws the mean step in its real size, and a line for each building code.
pub(super) fn codes(ui: &mut egui::Ui, stairs: &Stairs) {
    let Some([rise_mm, tread_mm]) = stairs.mean_step_mm() else { return };
    let degrees = libm::atan2f(rise_mm, tread_mm).to_degrees();
    let scale = 1000.0 / TRUE_MM_PER_M;
    let text = format!("Like a real step of {rise_mm:.0} × {tread_mm:.0} mm, {degrees:.0}° steep");
    ui.label(text).on_hover_text(format!(
        "Rise × tread where the snake of five blocks is 3.5 m long: these stairs are {scale:.2} times as large as real ones"
    ));
    let palette = theme::of(ui);
    egui::Grid::new("codes").num_columns(2).spacing([theme::GAP, 2.0]).show(ui, |ui| {
        for code in BUILDING_CODES {
            ui.label(code.name).on_hover_text(code.source);
            match code.problem(stairs) {
                None => explain(ui, "rises and treads allowed"),
                Some(problem) => {
                    let text = egui::RichText::new(problem).color(palette.second);
                    ui.add(egui::Label::new(text).wrap());
                }
            }
            ui.end_row();
        }
    });
}
