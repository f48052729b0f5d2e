//! View of a joint's reflexes: what each sense adds to the bend target of the gait.

use bevy_egui::egui;

use super::value_bar::ValueBar;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::control::ReflexActivity;

/// Draws the reflexes of a joint.
pub(super) fn reflex_view(ui: &mut egui::Ui, reflex: &ReflexActivity) {
    let palette = theme::of(ui);
    let (moved_deg, reach_deg) = (reflex.moved_rad.to_degrees(), reflex.reach_rad.to_degrees());
    explain(ui, &format!("Joint {}: what each sense adds to its bend target", reflex.joint + 1));
    let most = reflex.pushes.iter().map(|push| push.push.abs()).fold(1.0, f32::max);
    for push in &reflex.pushes {
        let color = if push.push < 0.0 { palette.torque_minus } else { palette.torque_plus };
        let row = ValueBar {
            name: push.name,
            text: decimals(push.push, 2),
            value: push.push,
            range: [-most, most],
            color,
            hint: format!("Weight times sense, which is {}", decimals(push.value, 2)),
            ..ValueBar::of_sense()
        };
        row.ui(ui);
    }
    let row = ValueBar {
        name: "Target moved",
        text: format!("{}°", decimals(moved_deg, 1)),
        value: moved_deg,
        range: [-reach_deg, reach_deg],
        note: &format!("±{reach_deg:.0}°"),
        color: palette.bend,
        is_chosen: true,
        hint: "The sum of all, limited to the reach of the reflexes".to_owned(),
        ..ValueBar::of_sense()
    };
    row.ui(ui);
    let turns = reflex.shift_rad / std::f32::consts::TAU;
    let text = format!("Its wave is shifted by {} periods since the start.", decimals(turns, 2));
    explain(ui, &text);
}
