//! What can be drawn over the scene to understand it: forces, torques, the way so far, the line that counts.

use bevy::prelude::*;
use bevy_egui::egui::Color32;

use super::Frame;
use super::hands::Hands;
use super::lane::Lane;
use super::look::{Palette, Theme};
use crate::check::Invalid;
use crate::world::JointTorque;

/// Something that can be drawn over the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overlay {
    /// Where the snake touches the world, and with what force.
    Contacts,
    /// The torques on its joints.
    Torques,
    /// Where its middle has been.
    Trail,
    /// How far it has come.
    FitnessLine,
    /// What the physics engine sees.
    Wireframe,
}

/// Which of them are drawn.
#[derive(Resource, Debug, Default)]
pub(super) struct Overlays(Vec<Overlay>);

/// Lines that nothing hides.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct OnTop;

impl Overlay {
    /// All of them, in the order of their buttons.
    pub const ALL: [Self; 5] =
        [Self::Contacts, Self::Torques, Self::Trail, Self::FitnessLine, Self::Wireframe];

    /// The one with this name, in small letters and in one word.
    ///
    /// # Errors
    /// There is none.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        match name {
            "contacts" => Ok(Self::Contacts),
            "torques" => Ok(Self::Torques),
            "trail" => Ok(Self::Trail),
            "line" => Ok(Self::FitnessLine),
            _ => Err(Invalid::new("show", format!("{name:?}"), "contacts, torques, trail or line")),
        }
    }

    /// Its name on a button, and what it shows.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Contacts => ("Contacts", "Where it touches, and with what force (V)"),
            Self::Torques => ("Torques", "Bend and twist torques on the joints (J)"),
            Self::Trail => ("Trail", "Where its middle has been (B)"),
            Self::FitnessLine => ("Fitness line", "How far its middle has come (L)"),
            Self::Wireframe => ("Wireframe", "What the physics engine sees (D)"),
        }
    }
}

impl Overlays {
    /// Whether it is drawn.
    pub fn shows(&self, overlay: Overlay) -> bool {
        self.0.contains(&overlay)
    }

    /// Shows or hides it.
    pub fn toggle(&mut self, overlay: Overlay) {
        if self.shows(overlay) {
            self.0.retain(|shown| *shown != overlay);
        } else {
            self.0.push(overlay);
        }
    }
}

/// Width of lines, in pixels.
const LINE_PIXELS: f32 = 3.0;
/// A force as large as the snake's weight is an arrow of this length, in metres.
const WEIGHT_M: f32 = 3.0;
/// No arrow is longer, in metres: an impact can be a hundred times the weight.
const LONGEST_ARROW_M: f32 = 6.0;
/// Radius of a torque's arrow, as a share of the limb's larger side across.
const TORQUE_RADIUS: f32 = 0.8;
/// The largest torque turns its arrow by this angle, in radians.
const FULL_TORQUE_RAD: f32 = 4.7;
/// A smaller share of the largest torque is not drawn.
const LEAST_TORQUE: f32 = 0.02;
/// Just above a tread, in metres.
const ABOVE_M: f32 = 0.04;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Overlays>()
        .init_gizmo_group::<OnTop>()
        .add_systems(Startup, set_up)
        .add_systems(Update, draw.in_set(Frame::Draw));
}

fn set_up(mut config: ResMut<GizmoConfigStore>) {
    let (on_top, _) = config.config_mut::<OnTop>();
    on_top.depth_bias = -1.0;
    on_top.line.width = LINE_PIXELS;
    let (usual, _) = config.config_mut::<DefaultGizmoConfigGroup>();
    usual.line.width = LINE_PIXELS;
}

fn draw(
    overlays: Res<Overlays>,
    hands: Option<Res<Hands>>,
    lanes: Query<(Entity, &Lane)>,
    theme: Res<Theme>,
    mut on_top: Gizmos<OnTop>,
    mut hidden: Gizmos,
) {
    let palette = theme.palette();
    for (entity, lane) in &lanes {
        if overlays.shows(Overlay::Contacts) {
            contacts(lane, palette, &mut on_top);
        }
        if overlays.shows(Overlay::Torques) {
            torques(lane, palette, &mut on_top);
        }
        if overlays.shows(Overlay::Trail) {
            let color = if lane.is_disturbed() { palette.pull } else { palette.trail };
            let way = lane.trail_m().into_iter().map(|at| at + lane.offset());
            hidden.linestrip(way, color);
        }
        if overlays.shows(Overlay::FitnessLine) {
            fitness_line(lane, palette, &mut on_top);
        }
        if let Some(hands) = &hands
            && hands.lane == lane.number()
            && let Some(limb) = hands.limb
        {
            outline(lane, limb, palette, &mut on_top);
        }
        let pull = hands.as_ref().and_then(|hands| hands.pull_on(entity));
        if let Some(pull) = pull {
            let from = lane.point_of(pull.limb, pull.held_at_m) + lane.offset();
            let to = pull.to_m + lane.offset();
            on_top.line(from, to, palette.pull);
            on_top.sphere(Isometry3d::from_translation(to), 0.12, palette.pull).resolution(12);
        }
    }
}

/// The edges of the limb whose numbers are shown.
fn outline(lane: &Lane, limb: usize, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let Some(pose) = lane.drawn_poses().nth(limb) else { return };
    let size = Vec3::from(lane.trial().agent.limb_size_m(limb)) * 1.02;
    let at = Transform::from_translation(pose.translation + lane.offset());
    gizmos.cube(at.with_rotation(pose.rotation).with_scale(size), in_scene(palette.second));
}

/// A cross at every contact, and the force on the limb as an arrow from it.
fn contacts(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let plan = lane.trial().world_plan(&lane.exhibit().champion().genome);
    let weight_n = plan.body.mass_kg() * plan.physics.gravity_m_s2.max(0.1);
    for contact in &lane.readings().contacts {
        let at = contact.at_m + lane.offset();
        let arrow = (contact.force_n * (WEIGHT_M / weight_n)).clamp_length_max(LONGEST_ARROW_M);
        gizmos.cross(Isometry3d::from_translation(at), 0.1, palette.force);
        if arrow.length() > 0.05 {
            gizmos.arrow(at, at + arrow, palette.force).with_tip_length(0.18);
        }
    }
}

/// An arrow around each axis of each joint, as far round as the torque is large.
fn torques(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let agent = &lane.trial().agent;
    let poses: Vec<_> = lane.drawn_poses().collect();
    for (joint, torque) in lane.readings().torques.iter().enumerate() {
        let Some(front) = poses.get(joint) else { continue };
        let [width_m, length_m, height_m] = agent.limb_size_m(joint);
        let at = *front * Vec3::new(0.0, -length_m / 2.0, 0.0) + lane.offset();
        let most = JointTorque {
            bend_nm: agent.max_bend_torque_nm.at(joint),
            twist_nm: agent.max_twist_torque_nm.at(joint),
        };
        let radius_m = width_m.max(height_m) * TORQUE_RADIUS;
        // About x, from above; at the limb's sides, where it can be seen.
        let share = torque.bend_nm / most.bend_nm.max(1.0e-6);
        for side in [-1.0, 1.0] {
            let centre = at + front.rotation * Vec3::X * (side * (width_m / 2.0 + 0.1));
            let (up, ahead) = (front.rotation * Vec3::Z, front.rotation * Vec3::NEG_Y);
            bent_arrow(gizmos, centre, [up, ahead], radius_m * 0.75, share, in_scene(palette.bend));
        }
        // About y, from above.
        let share = torque.twist_nm / most.twist_nm.max(1.0e-6);
        let (up, aside) = (front.rotation * Vec3::Z, front.rotation * Vec3::X);
        bent_arrow(gizmos, at, [up, aside], radius_m * 1.1, share, in_scene(palette.twist));
    }
}

/// An arrow along a circle, from the direction `from` towards the direction `towards`, or the other way round.
fn bent_arrow(
    gizmos: &mut Gizmos<OnTop>,
    centre: Vec3,
    [from, towards]: [Vec3; 2],
    radius_m: f32,
    share: f32,
    color: Color,
) {
    const PARTS: u32 = 20;
    if share.abs() < LEAST_TORQUE {
        return;
    }
    let point = |part: f32| {
        let angle_rad = share.clamp(-1.0, 1.0) * FULL_TORQUE_RAD * part / PARTS as f32;
        let (sin, cos) = libm::sincosf(angle_rad);
        centre + (from * cos + towards * sin) * radius_m
    };
    gizmos.linestrip((0..PARTS).map(|part| point(part as f32)), color);
    let (before, end) = (point(PARTS as f32 - 1.0), point(PARTS as f32));
    gizmos.arrow(before, end, color).with_tip_length(0.16);
}

/// A panel's colour in the scene.
fn in_scene(color: Color32) -> Color {
    let [red, green, blue, _] = color.to_array();
    Color::srgb_u8(red, green, blue)
}

/// A line across the lane where the middle limb's centre is, and one up to it.
fn fitness_line(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let middle = lane.drawn_middle();
    let stairs = &lane.trial().stairs;
    let on_floor = Vec3::new(0.0, middle.y, stairs.surface_z_m(0.0, middle.y) + ABOVE_M);
    let half_width = Vec3::X * (stairs.width_m / 2.0);
    let color = in_scene(palette.accent);
    let at = on_floor + lane.offset();
    gizmos.line(at - half_width, at + half_width, color);
    gizmos.line(on_floor.with_x(middle.x) + lane.offset(), middle + lane.offset(), color);
}
