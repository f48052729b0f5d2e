//! Columns of the table of motion, which has one row for each limb at each step.

use snakes_core::score::Rollout;
use snakes_core::world::{LimbReading, SnakeReading, Vector};

/// A column of the table of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name of the column. It ends in the unit of the values, unless they are pure numbers.
    pub name: &'static str,
    /// Meaning of the values, for users.
    pub meaning: &'static str,
}

/// Makes a column.
const fn column(name: &'static str, meaning: &'static str) -> Column {
    Column { name, meaning }
}

/// Columns that identify a row. All are whole numbers, except the champion's name, which is text, and the time.
pub(super) const KEYS: [Column; 6] = [
    column("champion", "name of the champion"),
    column("seed", "seed of the run that found it"),
    column("generation", "generation of that run in which it was found; the first is 1"),
    column("step", "number of the physics step; 0 is the start"),
    column("time_s", "simulated time"),
    column("limb", "number of the limb; the head is 1"),
];

/// Columns with the values of a row.
pub(super) const VALUES: [Column; 33] = [
    column("x_m", "position of the limb's centre across the stairs"),
    column("y_m", "position towards and up the stairs"),
    column("z_m", "position upwards"),
    column("rotation_x", "rotation of the limb in the world, a unit quaternion"),
    column("rotation_y", "the same"),
    column("rotation_z", "the same"),
    column("rotation_w", "the same, real part"),
    column("velocity_x_m_s", "velocity of the limb's centre"),
    column("velocity_y_m_s", "the same along y"),
    column("velocity_z_m_s", "the same along z"),
    column("angular_velocity_x_rad_s", "angular velocity of the limb in the world"),
    column("angular_velocity_y_rad_s", "the same about y"),
    column("angular_velocity_z_rad_s", "the same about z"),
    column("joint_bend_rad", "bend of the joint in front of the limb; the head has none"),
    column("joint_twist_rad", "twist of that joint"),
    column("joint_bend_rate_rad_s", "rate of its bend"),
    column("joint_twist_rate_rad_s", "rate of its twist"),
    column("joint_bend_torque_nm", "torque about its bend axis in the step that led here"),
    column("joint_twist_torque_nm", "torque about its twist axis in that step"),
    column("contact_points", "points in which ground or stairs press on the limb"),
    column("contact_force_x_n", "force of ground and stairs on the limb in the last substep"),
    column("contact_force_y_n", "the same along y"),
    column("contact_force_z_n", "the same along z"),
    column("touches", "1 if the limb touches ground or stairs, else 0"),
    column("pitch_rad", "angle of the limb's axis over the horizontal"),
    column("roll_rad", "angle of the limb's sideways axis over the horizontal"),
    column("gap_m", "way along y from the front face to the next riser; none behind the last one"),
    column("step_up_m", "height of the next tread over the limb's lowest corner"),
    column("clearance_m", "height of the lowest corner over the surface below the limb"),
    column("blocked_n", "force of the contacts against the limb's forward axis"),
    column("head_yaw_rad", "sideways angle of the head; the same in the rows of all limbs"),
    column("speed_ahead_m_s", "velocity of the middle limb along y, as the snake senses it"),
    column(
        "aside_half_widths",
        "distance of the middle limb from the middle of the stairs, as a share of half their width",
    ),
];

/// Returns all columns in their order.
pub fn columns() -> impl Iterator<Item = Column> {
    KEYS.into_iter().chain(VALUES)
}

/// Reads the values of all limbs at the current step of a rollout. Buffers are reused.
#[derive(Debug, Default)]
pub(super) struct RowReader {
    readings: Vec<LimbReading>,
}

/// Values of a row, in the order of [`VALUES`]; `None` where nothing can be measured.
pub(super) type RowValues = [Option<f32>; VALUES.len()];

impl RowReader {
    /// Returns the rows of all limbs, head first.
    pub fn rows(&mut self, rollout: &Rollout) -> Vec<RowValues> {
        let world = rollout.simulation();
        world.read_limbs(&mut self.readings);
        let joints: Vec<_> = world.joint_states().zip(world.applied_torques()).collect();
        let forces = world.contact_forces();
        let snake = world.read_snake();
        let poses = rollout.body().limb_poses(rollout.poses());
        let limbs = poses.iter().zip(world.limb_velocities()).zip(&self.readings).enumerate();
        limbs
            .map(|(limb, ((pose, [velocity, spin]), reading))| {
                let joint = limb.checked_sub(1).and_then(|joint| joints.get(joint));
                let of_joint = joint.map_or([[None; 2]; 3], |(state, torque)| {
                    let angles = [state.bend_rad, state.twist_rad];
                    let rates = [state.bend_rad_s, state.twist_rad_s];
                    [angles, rates, [torque.bend_nm, torque.twist_nm]].map(|pair| pair.map(Some))
                });
                let on_it = forces.iter().filter(|contact| contact.limb == limb);
                let points = on_it.clone().count() as f32;
                let force: Vector = on_it.map(|contact| contact.force_n).sum();
                let turn = pose.rotation;
                let mut row = pose.translation.to_array().map(Some).to_vec();
                row.extend([turn.x, turn.y, turn.z, turn.w].map(Some));
                row.extend(velocity.to_array().map(Some));
                row.extend(spin.to_array().map(Some));
                row.extend(of_joint.as_flattened());
                row.push(Some(points));
                row.extend(force.to_array().map(Some));
                row.extend(sensed(reading, &snake));
                std::array::from_fn(|index| row.get(index).copied().flatten())
            })
            .collect()
    }
}

/// Returns the values of a limb's senses in physical units, before they are scaled, filtered and clamped for controllers.
fn sensed(limb: &LimbReading, snake: &SnakeReading) -> [Option<f32>; 10] {
    let angle_rad = |sine: f32| libm::asinf(sine.clamp(-1.0, 1.0));
    [
        Some(if limb.is_touching { 1.0 } else { 0.0 }),
        Some(angle_rad(limb.pitch)),
        Some(angle_rad(limb.roll)),
        limb.next_step.map(|[gap_m, _]| gap_m),
        limb.next_step.map(|[_, up_m]| up_m),
        Some(limb.clearance_m),
        Some(limb.blocked_n),
        Some(angle_rad(snake.yaw)),
        Some(snake.velocity_m_s[0]),
        Some(snake.aside),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documentation_lists_every_column() {
        let page = include_str!("../../../../docs/export.md");
        let rows: Vec<&str> = page
            .lines()
            .skip_while(|line| *line != "| column | meaning |")
            .skip(2)
            .take_while(|line| line.starts_with('|'))
            .collect();
        let row = |column: Column| format!("| `{}` | {} |", column.name, column.meaning);
        assert_eq!(rows, columns().map(row).collect::<Vec<_>>());
    }
}
