//! Card with the readings of the selected limb.

use bevy_egui::egui;

use crate::studio::stage::contact_meter::SPAN_S;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::decimals::{decimals, in_percent};
use crate::studio::ui::text_rows::weak;
use crate::studio::ui::theme;
use snakes_core::world::JointState;

/// A line of the card: a reading with its name.
struct Reading {
    name: &'static str,
    value: String,
    /// Time of the reading, where this is not obvious.
    when: String,
}

impl Reading {
    fn of(name: &'static str, value: String) -> Self {
        Self { name, value, when: String::new() }
    }
}

/// Rounds to a tenth, and turns -0.0 into 0.0.
fn tenths(value: f32) -> f32 {
    (value * 10.0).round() / 10.0 + 0.0
}

/// Size of the card, which determines how much it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CardSize {
    /// Shows all readings of the limb.
    Full,
    /// Shows all readings that change, with fewer digits.
    Narrow,
    /// Shows only speed and contact.
    Least,
}

/// Minimum width and height of the stage below the camera bar for the full card, in points. A limb in the middle of the
/// stage is then visible beside the card.
const FULL_NEEDS: egui::Vec2 = egui::vec2(720.0, 300.0);
/// Minimum width and height of the stage below the camera bar for the narrow card, in points.
const NARROW_NEEDS: egui::Vec2 = egui::vec2(560.0, 225.0);

impl CardSize {
    /// Returns the largest card that fits onto a stage of this size, in points.
    pub fn for_stage(size: egui::Vec2) -> Self {
        let has = |needed: egui::Vec2| size.x >= needed.x && size.y >= needed.y;
        match () {
            () if has(FULL_NEEDS) => Self::Full,
            () if has(NARROW_NEEDS) => Self::Narrow,
            () => Self::Least,
        }
    }

    /// Returns the minimum width of the card's contents, in points. It keeps the card from growing in its first frames.
    pub fn width(self) -> f32 {
        match self {
            Self::Full => theme::LIMB_CARD_WIDTH,
            Self::Narrow => theme::GAP * 28.0,
            Self::Least => theme::GAP * 19.0,
        }
    }
}

/// Returns the title of the card of a limb; the head is 0.
pub(super) fn limb_title(lane: &Lane, limb: usize) -> String {
    let (body, count) = (&lane.body, lane.body.limbs());
    let part = match limb {
        0 => ", the head",
        last if last + 1 == count && !body.is_branching() => ", the tail",
        _ => "",
    };
    format!("Block {} of {count}{part}", limb + 1)
}

/// Draws the readings of a limb; the head is 0. While the stage plays (`is_playing`), the readings of contacts change
/// only a few times per second.
pub(super) fn limb_card(
    ui: &mut egui::Ui,
    lane: &Lane,
    limb: usize,
    is_playing: bool,
    size: CardSize,
) {
    let body = &lane.body;
    let poses = body.limb_poses(lane.replay.poses());
    let Some(pose) = poses.get(limb) else { return };
    ui.set_min_width(size.width());
    let mut rows = Vec::new();
    if size == CardSize::Full {
        let [width_m, length_m, height_m] = body.limb_size_m(limb);
        rows.push(Reading::of("Size", format!("{width_m:.2} × {length_m:.2} × {height_m:.2} m")));
        rows.push(Reading::of("Mass", format!("{:.2} kg", body.limb_mass_kg(limb))));
        if let Some(spring) = body.spring_of(limb) {
            let [bending, _, _] = spring.stiffness_nm_per_rad;
            let text = format!("{} parts, {bending:.0} N·m/rad", body.parts_of(limb).len());
            rows.push(Reading::of("Springs", text));
        }
    }
    if size != CardSize::Least {
        let digits = if size == CardSize::Full { 2 } else { 1 };
        let [x, y, z] = pose.translation.to_array().map(|along_m| decimals(along_m, digits));
        rows.push(match size {
            CardSize::Full => Reading::of("Position", format!("x {x}  y {y}  z {z} m")),
            CardSize::Narrow | CardSize::Least => {
                Reading::of("x, y, z", format!("{x}  {y}  {z} m"))
            }
        });
        let ahead = pose.rotation * bevy::prelude::Vec3::Y;
        let slope_deg = libm::asinf(ahead.z.clamp(-1.0, 1.0)).to_degrees();
        rows.push(Reading::of("Slope", format!("{:+.1}°", tenths(slope_deg))));
    }
    rows.extend(contact_rows(lane, limb, is_playing, size));
    if size != CardSize::Least {
        rows.extend(joint_rows(lane, limb, size));
    }
    // The rows are low, because on a small stage a high card would cover the snake.
    let grid = egui::Grid::new("limb").num_columns(2).min_row_height(theme::GAP * 2.25);
    grid.spacing([theme::GAP * 1.5, 0.0]).show(ui, |ui| {
        ui.spacing_mut().interact_size.y = theme::GAP * 2.25;
        for Reading { name, value, when } in rows {
            ui.label(weak(ui, name));
            ui.horizontal(|ui| {
                ui.label(egui::RichText::new(value).monospace());
                if !when.is_empty() {
                    ui.label(weak(ui, when).small());
                }
            });
            ui.end_row();
        }
    });
    if size == CardSize::Full {
        ui.label(weak(ui, "Drag the block to pull it").small());
    }
}

/// Returns the readings of a limb's speed and contacts. Each reading of a contact states whether it is instantaneous or an average.
fn contact_rows(lane: &Lane, limb: usize, is_playing: bool, size: CardSize) -> Vec<Reading> {
    let readings = &lane.readings;
    let Some(speed_m_s) = readings.speeds_m_s.get(limb) else { return Vec::new() };
    let contacts = readings.contacts.iter().filter(|contact| contact.limb == limb);
    let (points, force_n) = contacts
        .fold((0, bevy::prelude::Vec3::ZERO), |(points, sum), contact| {
            (points + 1, sum + contact.force_n)
        });
    let is_least = size == CardSize::Least;
    let touch = match points {
        0 => "none".to_owned(),
        _ if is_least => format!("{:.0} N", force_n.length()),
        1 => format!("1 point, {:.0} N", force_n.length()),
        points => format!("{points} points, {:.0} N", force_n.length()),
    };
    let when = |text: String| if is_least { String::new() } else { text };
    let name = |plain, least| if is_least { least } else { plain };
    let mut rows = vec![
        Reading::of("Speed", format!("{speed_m_s:.2} m/s")),
        Reading {
            when: when("now".to_owned()),
            ..Reading::of(name("Contact", "Contact now"), touch)
        },
    ];
    if lane.is_ghost {
        return rows;
    }
    let surface = readings.meter.limb(is_playing, limb, |_| true);
    let slip = surface.map(|surface| format!("{:.2} m/s", surface.slip_m_s));
    let grip = surface.and_then(|surface| surface.grip_share).map(in_percent);
    for (name, value) in
        [(name("Slip speed", "Slip, 0.25 s"), slip), (name("Grip used", "Grip, 0.25 s"), grip)]
    {
        let span = match size {
            CardSize::Full => format!("mean of the last {SPAN_S} s"),
            CardSize::Narrow | CardSize::Least => format!("last {SPAN_S} s"),
        };
        let value = value.unwrap_or_else(|| "-".to_owned());
        rows.push(Reading { when: when(span), ..Reading::of(name, value) });
    }
    rows
}

/// Returns the readings of angles and torques at the joints of a limb.
fn joint_rows(lane: &Lane, limb: usize, size: CardSize) -> Vec<Reading> {
    let readings = &lane.readings;
    let joint = |index: usize| {
        let state: &JointState = readings.joints.get(index)?;
        let torque = readings.torques.get(index)?;
        let line = |angle_rad: f32, torque_nm: f32| {
            let (angle_deg, torque_nm) = (tenths(angle_rad.to_degrees()), tenths(torque_nm));
            match size {
                CardSize::Full => format!("{angle_deg:+6.1}°  {torque_nm:+7.1} N·m"),
                CardSize::Narrow | CardSize::Least => {
                    format!("{angle_deg:+6.1}° {:+5.0} N·m", torque_nm.round() + 0.0)
                }
            }
        };
        Some([line(state.bend_rad, torque.bend_nm), line(state.twist_rad, torque.twist_nm)])
    };
    let mut rows = Vec::new();
    let body = &lane.body;
    for (index, of) in body.joints.iter().enumerate() {
        let [front, rear] = [of.parent, of.child].map(|part| body.parts[part].limb);
        let names = if rear == limb {
            ["Front bend", "Front twist"]
        } else if front == limb && !body.is_branching() {
            // A limb of a creature may carry several others, whose own cards show these joints.
            ["Rear bend", "Rear twist"]
        } else {
            continue;
        };
        let lines = names.into_iter().zip(joint(index).into_iter().flatten());
        rows.extend(lines.map(|(name, value)| Reading::of(name, value)));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::climber_lane;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_limb_that_has_just_left_the_ground_says_which_readings_are_of_the_moment() {
        let mut lane = climber_lane(0, "climber");
        let has_left = |lane: &Lane| {
            let touches = lane.readings.contacts.iter().any(|contact| contact.limb == 0);
            !touches && lane.readings.meter.limb(false, 0, |_| true).is_some()
        };
        let mut times_s = (0..900).map(|step| f64::from(step) / 60.0);
        let left_s = times_s.find(|time_s| {
            lane.show(*time_s, None, 3000).expect("shown");
            has_left(&lane)
        });
        assert!(left_s.is_some(), "the head leaves the ground");
        let card = Harness::new_ui(|ui| limb_card(ui, &lane, 0, false, CardSize::Full));
        let top_of = |label: &str| card.get_by_label(label).rect().center().y;
        let is_beside = |a: f32, b: f32| (a - b).abs() < 5.0;
        assert!(is_beside(top_of("now"), top_of("Contact")));
        assert!(is_beside(top_of("none"), top_of("Contact")));
        let spans: Vec<f32> = card
            .query_all_by_label("mean of the last 0.25 s")
            .map(|span| span.rect().center().y)
            .collect();
        assert!(is_beside(spans[0], top_of("Slip speed")), "{spans:?}");
        assert!(is_beside(spans[1], top_of("Grip used")), "{spans:?}");
    }

    #[test]
    fn a_reading_that_rounds_to_zero_has_no_minus() {
        assert_eq!(format!("{:+.1}", tenths(-0.04)), "+0.0");
        // The limb is at x = 0 at first.
        let lane = climber_lane(0, "climber");
        let card = Harness::new_ui(|ui| limb_card(ui, &lane, 2, false, CardSize::Full));
        assert!(card.query_by_label_contains("-0.0").is_none());
        assert!(card.query_by_label_contains("x 0.00").is_some());
    }

    #[test]
    fn a_small_stage_has_a_smaller_card() {
        let mut lane = climber_lane(0, "climber");
        lane.show(4.0, None, 3000).expect("healthy");
        let mut sizes = Vec::new();
        for stage in [egui::vec2(895.0, 500.0), egui::vec2(640.0, 355.0), egui::vec2(435.0, 228.0)]
        {
            let mut used = egui::Vec2::ZERO;
            let size = CardSize::for_stage(stage);
            let mut card = Harness::builder().with_size(stage).build_ui(|ui| {
                theme::apply(ui.ctx());
                used = ui.scope(|ui| limb_card(ui, &lane, 2, false, size)).response.rect.size();
            });
            card.run();
            drop(card);
            // With their margins, two cards fit side by side, and one fits below the camera bar.
            let (outer, room) = (used + egui::vec2(26.0, 18.0), stage - egui::vec2(24.0, 12.0));
            assert!(outer.x < room.x / 2.0 && outer.y < room.y, "{outer} in {room}");
            sizes.push(size);
        }
        assert_eq!(sizes, [CardSize::Full, CardSize::Narrow, CardSize::Least]);
    }
}
