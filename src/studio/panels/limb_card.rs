//! The numbers of the limb that a person has clicked.

use bevy_egui::egui;

use crate::studio::lane::Lane;
use crate::studio::look;
use crate::world::JointState;

/// Draws the numbers of a limb; the head is 0.
pub(super) fn limb_card(ui: &mut egui::Ui, lane: &Lane, limb: usize) {
    let Some(pose) = lane.last_poses().get(limb) else { return };
    // From its first frame on.
    ui.set_min_width(look::LIMB_WIDTH);
    let agent = &lane.trial().agent;
    let palette = look::of(ui);
    let count = agent.limbs as usize;
    let part = match limb {
        0 => ", the head",
        last if last + 1 == count => ", the tail",
        _ => "",
    };
    let title = format!("Limb {} of {count}{part}", limb + 1);
    ui.label(egui::RichText::new(title).size(look::TITLE_SIZE).strong());
    let readings = lane.readings();
    let body = agent.body_plan(&lane.exhibit().champion().genome);
    let at = pose.translation;
    let ahead = pose.rotation * bevy::prelude::Vec3::Y;
    let slope_deg = libm::asinf(ahead.z.clamp(-1.0, 1.0)).to_degrees();
    let [width_m, length_m, height_m] = agent.limb_size_m(limb);
    let contacts = readings.contacts.iter().filter(|contact| contact.limb == limb);
    let (points, force_n) = contacts
        .fold((0, bevy::prelude::Vec3::ZERO), |(points, sum), contact| {
            (points + 1, sum + contact.force_n)
        });
    let mut rows = vec![
        ("Size", format!("{width_m:.2} × {length_m:.2} × {height_m:.2} m")),
        (
            "Mass",
            body.limbs.get(limb).map_or(String::new(), |plan| format!("{:.2} kg", plan.mass_kg())),
        ),
        ("Place", format!("x {:.2}  y {:.2}  z {:.2} m", at.x, at.y, at.z)),
        ("Slope", format!("{slope_deg:+.1}°")),
    ];
    if let Some(speed_m_s) = readings.speeds_m_s.get(limb) {
        rows.push(("Speed", format!("{speed_m_s:.2} m/s")));
        let touch = match points {
            0 => "nothing".to_owned(),
            1 => format!("1 point, {:.0} N", force_n.length()),
            points => format!("{points} points, {:.0} N", force_n.length()),
        };
        rows.push(("Touches", touch));
    }
    let joint = |index: usize| {
        let state: &JointState = readings.joints.get(index)?;
        let torque = readings.torques.get(index)?;
        // A tenth that is rounded to nothing has no sign.
        let tenths = |value: f32| (value * 10.0).round() / 10.0 + 0.0;
        let line = |angle_rad: f32, torque_nm: f32| {
            format!("{:+6.1}°  {:+7.1} N·m", tenths(angle_rad.to_degrees()), tenths(torque_nm))
        };
        Some([line(state.bend_rad, torque.bend_nm), line(state.twist_rad, torque.twist_nm)])
    };
    let joints = [
        limb.checked_sub(1).and_then(joint).map(|texts| (["Front bend", "Front twist"], texts)),
        joint(limb).map(|texts| (["Rear bend", "Rear twist"], texts)),
    ];
    for (names, texts) in joints.into_iter().flatten() {
        rows.extend(names.into_iter().zip(texts));
    }
    egui::Grid::new("limb").num_columns(2).spacing([look::GAP * 1.5, look::GAP / 4.0]).show(
        ui,
        |ui| {
            for (name, value) in rows {
                ui.label(egui::RichText::new(name).color(palette.text_weak));
                ui.label(egui::RichText::new(value).monospace());
                ui.end_row();
            }
        },
    );
    let text = egui::RichText::new("Drag it to pull it").small().color(palette.text_weak);
    ui.label(text);
}
