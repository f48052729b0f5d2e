//! Budgets of volume, length, torque and blocks.

use bevy_egui::egui;

use crate::studio::state::body_editor::EditedBody;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::genome::{BodySpace, MOST_SEGMENTS};

/// Tolerance for rounding errors, as a share of the budget.
const TOLERANCE: f64 = 1.0e-3;

/// A budget: its name, the used and the available amount, the unit and its number of decimals, and the tooltip.
type Budget = (&'static str, [f64; 2], (&'static str, usize), &'static str);

/// Draws the budgets as bars, which are red if the body exceeds the budget.
pub(super) fn budgets(ui: &mut egui::Ui, edited: &EditedBody<'_>) {
    ui.add_space(theme::GAP / 2.0);
    let agent = &edited.original.trial().agent;
    let (body, original) = (&edited.body, edited.original.body());
    let longest_m = f64::from(BodySpace::default().longest_m);
    let list: [Budget; 4] = [
        (
            "Volume",
            [body.volume_m3().into(), original.volume_m3().into()],
            ("m³", 2),
            "All bodies of a run have the same volume: adding, splitting and removing blocks scales the others",
        ),
        (
            "Length",
            [body.length_m().into(), longest_m],
            ("m", 1),
            "A longer body would gain from its length alone",
        ),
        (
            "Torque",
            [body.torque_nm().into(), agent.torque_budget_nm.into()],
            ("N·m", 0),
            "Of all joints together. A body that would have more is made weaker in all joints alike",
        ),
        ("Blocks", [body.limbs() as f64, MOST_SEGMENTS.into()], ("", 0), "From 2 to 12"),
    ];
    let palette = theme::of(ui);
    let is_beyond = |[used, all]: [f64; 2]| used > all * (1.0 + TOLERANCE);
    let exceeds = list.iter().any(|(_, amounts, ..)| is_beyond(*amounts));
    egui::Grid::new("budgets").num_columns(2).show(ui, |ui| {
        for (name, [used, all], (unit, digits), hint) in list {
            ui.label(name).on_hover_text(hint);
            let (fill, color) = match is_beyond([used, all]) {
                true => (palette.problem, palette.panel),
                false => (palette.accent_soft, palette.text),
            };
            let words = format!("{used:.digits$} of {all:.digits$} {unit}");
            let bar = egui::ProgressBar::new((used / all.max(1.0e-9)) as f32).fill(fill);
            let words = egui::RichText::new(words.trim_end()).color(color);
            ui.add(bar.text(words)).on_hover_text(hint);
            ui.end_row();
        }
    });
    if exceeds {
        let text = "Red: more than the snakes of a run may have, so the comparison with the original is not fair. \
                    This snake can be watched and saved all the same.";
        explain(ui, text);
    }
    ui.label(format!(
        "Mass {:.1} kg; the original has {:.1} kg",
        body.mass_kg(),
        original.mass_kg()
    ));
}
