//! Readings of the selected limb.

use bevy_egui::egui;

use crate::studio::panels::world::surface_readout::in_percent;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme;
use crate::world::JointState;

/// Draws the readings of a limb; the head is 0. While the stage plays (`is_playing`), those of its contacts change a few
/// times per second only.
pub(crate) fn limb_card(ui: &mut egui::Ui, lane: &Lane, limb: usize, is_playing: bool) {
    let body = lane.body();
    let (Some(pose), Some(plan)) = (lane.last_poses().get(limb), body.limbs.get(limb)) else {
        return;
    };
    // A fixed width keeps the card from growing in its first frames.
    ui.set_min_width(theme::LIMB_CARD_WIDTH);
    let palette = theme::of(ui);
    let count = body.limbs.len();
    let part = match limb {
        0 => ", the head",
        last if last + 1 == count => ", the tail",
        _ => "",
    };
    let title = format!("Limb {} of {count}{part}", limb + 1);
    ui.label(egui::RichText::new(title).size(theme::TITLE_SIZE).strong());
    let readings = lane.readings();
    let at = pose.translation;
    let ahead = pose.rotation * bevy::prelude::Vec3::Y;
    let slope_deg = libm::asinf(ahead.z.clamp(-1.0, 1.0)).to_degrees();
    let [width_m, length_m, height_m] = plan.size_m();
    let contacts = readings.contacts.iter().filter(|contact| contact.limb == limb);
    let (points, force_n) = contacts
        .fold((0, bevy::prelude::Vec3::ZERO), |(points, sum), contact| {
            (points + 1, sum + contact.force_n)
        });
    let mut rows = vec![
        ("Size", format!("{width_m:.2} × {length_m:.2} × {height_m:.2} m")),
        ("Mass", format!("{:.2} kg", plan.mass_kg())),
        ("Position", format!("x {:.2}  y {:.2}  z {:.2} m", at.x, at.y, at.z)),
        ("Slope", format!("{slope_deg:+.1}°")),
    ];
    if let Some(speed_m_s) = readings.speeds_m_s.get(limb) {
        rows.push(("Speed", format!("{speed_m_s:.2} m/s")));
        let touch = match points {
            0 => "none".to_owned(),
            1 => format!("1 point, {:.0} N", force_n.length()),
            points => format!("{points} points, {:.0} N", force_n.length()),
        };
        rows.push(("Contact", touch));
        if !lane.is_ghost() {
            let surface = readings.meter.limb(is_playing, limb, |_| true);
            let slip = surface.map(|surface| format!("{:.2} m/s", surface.slip_m_s));
            let grip = surface.and_then(|surface| surface.grip_share).map(in_percent);
            let known = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
            rows.extend([("Slip speed", known(slip)), ("Grip used", known(grip))]);
        }
    }
    let joint = |index: usize| {
        let state: &JointState = readings.joints.get(index)?;
        let torque = readings.torques.get(index)?;
        // Avoids "-0.0".
        let tenths = |value: f32| (value * 10.0).round() / 10.0 + 0.0;
        let line = |angle_rad: f32, torque_nm: f32| {
            format!("{:+6.1}°  {:+7.1} N·m", tenths(angle_rad.to_degrees()), tenths(torque_nm))
        };
        Some([line(state.bend_rad, torque.bend_nm), line(state.twist_rad, torque.twist_nm)])
    };
    for (index, plan) in body.joints.iter().enumerate() {
        let names = if plan.child == limb {
            ["Front bend", "Front twist"]
        } else if plan.parent == limb {
            ["Rear bend", "Rear twist"]
        } else {
            continue;
        };
        rows.extend(names.into_iter().zip(joint(index).into_iter().flatten()));
    }
    egui::Grid::new("limb").num_columns(2).spacing([theme::GAP * 1.5, theme::GAP / 4.0]).show(
        ui,
        |ui| {
            for (name, value) in rows {
                ui.label(egui::RichText::new(name).color(palette.text_weak));
                ui.label(egui::RichText::new(value).monospace());
                ui.end_row();
            }
        },
    );
    let text = egui::RichText::new("Drag the limb to pull it").small().color(palette.text_weak);
    ui.label(text);
}
