//! The steepness of the stairs, and what building codes say about it.

use bevy_egui::egui;

use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use crate::world::{BUILDING_CODES, Stairs, TRUE_MM_PER_M};

/// Draws the mean step in true size, and a line for each building code.
pub(super) fn codes(ui: &mut egui::Ui, stairs: &Stairs) {
    if stairs.steps == 0 {
        return;
    }
    let up = (0..stairs.steps).map(|step| stairs.step_rise_m(step).abs());
    let rise_m = up.sum::<f32>() / stairs.steps as f32;
    let tread_m = stairs.mean_tread_m();
    let degrees = libm::atan2f(rise_m, tread_m).to_degrees();
    let [rise_mm, tread_mm] = [rise_m, tread_m].map(|of_m| of_m * TRUE_MM_PER_M);
    let scale = 1000.0 / TRUE_MM_PER_M;
    let text = format!("Mean step: {degrees:.0}°, {rise_mm:.0} × {tread_mm:.0} mm in true size");
    ui.label(text).on_hover_text(format!(
        "Rise × tread where the snake of five blocks is 3.5 m long: a scale of 1 : {scale:.2}"
    ));
    let palette = theme::of(ui);
    egui::Grid::new("codes").num_columns(2).spacing([theme::GAP, 2.0]).show(ui, |ui| {
        for code in BUILDING_CODES {
            ui.label(code.name).on_hover_text(code.source);
            match code.problem(stairs) {
                None => explain(ui, "allowed"),
                Some(problem) => {
                    let text = egui::RichText::new(problem).color(palette.second);
                    ui.add(egui::Label::new(text).wrap());
                }
            }
            ui.end_row();
        }
    });
}
