//! Readings of the senses, in physical units.

use bevy_egui::egui::{self, Color32};

use super::SensesView;
use super::value_bar::ValueBar;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::text_rows::{title, weak};
use crate::studio::ui::theme;
use snakes_core::control::SenseKind;
use snakes_core::score::Rollout;

/// Senses of the snake as a whole.
const OF_SNAKE: [ShownSense; 4] = [
    (SenseKind::Yaw, "Direction of the head: 0 straight towards the stairs"),
    (SenseKind::SpeedAhead, "Speed of the middle block towards the stairs"),
    (SenseKind::SpeedUp, "Speed of the middle block upwards"),
    (
        SenseKind::Aside,
        "Distance of the middle block from the middle of the stairs: 1 at their edge",
    ),
];
/// Senses of a limb, grouped by organ.
const OF_LIMB: [ShownSense; 8] = [
    (
        SenseKind::Gap,
        "Way from the block's front face to the next riser; full without a riser ahead",
    ),
    (
        SenseKind::StepUp,
        "Height of the next tread over the block's lowest corner; 0 without a riser ahead",
    ),
    (SenseKind::Clearance, "Height of the block's lowest corner over the surface below it"),
    (SenseKind::Touch, "Whether the block touches ground or stairs"),
    (SenseKind::Load, "Force of the contacts upwards; the bar is half full at a block's weight"),
    (
        SenseKind::Blocked,
        "Force of the contacts against the direction in which the block points; the bar is half full at a block's \
         weight",
    ),
    (SenseKind::Pitch, "Slope of the block: positive with its front end up"),
    (SenseKind::Roll, "Turn of the block about its length"),
];
/// Sense of a joint.
const OF_JOINT: ShownSense = (SenseKind::Bend, "Angle of the joint's bend");

/// A sense and its explanation.
type ShownSense = (SenseKind, &'static str);

/// Draws the readings of the senses of the snake, of a limb, and of all joints.
pub(super) fn readouts(ui: &mut egui::Ui, view: &SensesView, rollout: &Rollout) {
    let palette = theme::of(ui);
    let senses = rollout.perception();
    let limbs = senses.limbs.len();
    ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
    let part = match view.limb {
        0 => ", the head",
        last if last + 1 == limbs => ", the tail",
        _ => "",
    };
    title(ui, &format!("Block {} of {limbs}{part}", view.limb + 1));
    let limb_color = match view.limb % 2 {
        0 => theme::flat(palette.red_limb),
        _ => theme::flat(palette.blue_limb),
    };
    OF_LIMB.into_iter().for_each(|sense| row(ui, rollout, sense, view.limb, limb_color));
    if !view.is_selected {
        ui.label(weak(ui, "Click a block on the stage to read its senses.").small());
    }
    title(ui, "Whole snake");
    OF_SNAKE.into_iter().for_each(|sense| row(ui, rollout, sense, 0, palette.accent));
    title(ui, "Joints");
    for joint in 0..senses.joints.len() {
        row(ui, rollout, OF_JOINT, joint, palette.bend);
    }
}

/// Draws the row of a sense, for the part with this index.
fn row(
    ui: &mut egui::Ui,
    rollout: &Rollout,
    (kind, hint): ShownSense,
    part: usize,
    color: Color32,
) {
    let info = kind.info();
    let senses = rollout.perception();
    let sensed = senses.value(kind, part);
    let scale = info.scale.unwrap_or(1.0);
    let (value, [least, most]) = match (kind, sensed * scale, info.range.map(|end| end * scale)) {
        (SenseKind::Pitch | SenseKind::Roll | SenseKind::Yaw, sine, _) => {
            (libm::asinf(sine.clamp(-1.0, 1.0)).to_degrees(), [-90.0, 90.0])
        }
        (SenseKind::Bend, angle_rad, range_rad) => {
            (angle_rad.to_degrees(), range_rad.map(f32::to_degrees))
        }
        (_, value, range) => (value, range),
    };
    let (text, note) = match kind {
        SenseKind::Touch => (if value > 0.5 { "yes" } else { "no" }.to_owned(), String::new()),
        SenseKind::Load | SenseKind::Blocked => {
            // Mean weight of a limb.
            let weight_n = rollout.simulation().weight_n() / senses.limbs.len().max(1) as f32;
            let force_n = weight_n * value / (1.0 - value.min(0.999));
            let note = format!("½ at {weight_n:.0} N");
            (format!("{} N", decimals(force_n, 0)), note)
        }
        SenseKind::Pitch | SenseKind::Roll | SenseKind::Yaw | SenseKind::Bend => {
            (format!("{}°", decimals(value, 0)), format!("±{most:.0}°"))
        }
        SenseKind::Gap => {
            let least_gap = if sensed >= 1.0 { "≥ " } else { "" };
            (format!("{least_gap}{} m", decimals(value, 2)), format!("0 to {most:.0} m"))
        }
        SenseKind::Aside => (decimals(value, 2), format!("±{most:.0} half widths")),
        _ => {
            let from = if least < 0.0 { "±" } else { "0 to " };
            let text = format!("{} {}", decimals(value, 2), info.unit);
            (text, format!("{from}{most:.0} {}", info.unit))
        }
    };
    let is_frozen = !rollout.active_senses().has(info.organ);
    let name = match kind {
        SenseKind::Bend => format!("Joint {} bend", part + 1),
        _ => capitalized(info.name),
    };
    let row = ValueBar {
        name: &name,
        text,
        value,
        range: [least, most],
        note: if is_frozen { "frozen" } else { &note },
        color,
        is_frozen,
        hint: format!("{hint}. The controller receives {}", decimals(sensed, 2)),
        ..ValueBar::of_sense()
    };
    row.ui(ui);
}

fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
