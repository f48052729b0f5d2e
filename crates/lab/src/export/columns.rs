//! The columns of the table of motion: one row for each limb at each step.

use snakes_core::score::Rollout;
use snakes_core::world::{LimbReading, SnakeReading};

/// A column of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its name, which ends in the unit of its values; a pure number has none.
    pub name: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
}

/// The columns that say which row this is: whole numbers, but for the champion's name, which is text, and the time.
pub(super) const KEYS: [Column; 4] = [
    Column { name: "champion", meaning: "name of the champion" },
    Column { name: "step", meaning: "number of the physics step; 0 is the start" },
    Column { name: "time_s", meaning: "simulated time" },
    Column { name: "limb", meaning: "number of the limb; the head is 1" },
];

/// The columns of values.
pub(super) const VALUES: [Column; 33] = [
    Column { name: "x_m", meaning: "position of the limb's centre across the stairs" },
    Column { name: "y_m", meaning: "position towards and up the stairs" },
    Column { name: "z_m", meaning: "position upwards" },
    Column { name: "rotation_x", meaning: "rotation of the limb in the world, a unit quaternion" },
    Column { name: "rotation_y", meaning: "the same" },
    Column { name: "rotation_z", meaning: "the same" },
    Column { name: "rotation_w", meaning: "the same, real part" },
    Column { name: "velocity_x_m_s", meaning: "velocity of the limb's centre" },
    Column { name: "velocity_y_m_s", meaning: "the same along y" },
    Column { name: "velocity_z_m_s", meaning: "the same along z" },
    Column {
        name: "angular_velocity_x_rad_s",
        meaning: "angular velocity of the limb in the world",
    },
    Column { name: "angular_velocity_y_rad_s", meaning: "the same about y" },
    Column { name: "angular_velocity_z_rad_s", meaning: "the same about z" },
    Column {
        name: "joint_bend_rad",
        meaning: "bend of the joint in front of the limb; the head has none",
    },
    Column { name: "joint_twist_rad", meaning: "twist of that joint" },
    Column { name: "joint_bend_rate_rad_s", meaning: "rate of its bend" },
    Column { name: "joint_twist_rate_rad_s", meaning: "rate of its twist" },
    Column {
        name: "joint_bend_torque_nm",
        meaning: "torque about its bend axis in the step that led here",
    },
    Column { name: "joint_twist_torque_nm", meaning: "torque about its twist axis in that step" },
    Column {
        name: "contact_points",
        meaning: "points in which ground or stairs press on the limb",
    },
    Column {
        name: "contact_force_x_n",
        meaning: "force of ground and stairs on the limb in the last substep",
    },
    Column { name: "contact_force_y_n", meaning: "the same along y" },
    Column { name: "contact_force_z_n", meaning: "the same along z" },
    Column { name: "touches", meaning: "1 if the limb touches ground or stairs, else 0" },
    Column { name: "pitch_rad", meaning: "angle of the limb's axis over the horizontal" },
    Column { name: "roll_rad", meaning: "angle of the limb's sideways axis over the horizontal" },
    Column {
        name: "gap_m",
        meaning: "way along y from the front face to the next riser; none behind the last one",
    },
    Column { name: "step_up_m", meaning: "height of the next tread over the limb's lowest corner" },
    Column {
        name: "clearance_m",
        meaning: "height of the lowest corner over the surface below the limb",
    },
    Column { name: "blocked_n", meaning: "force of the contacts against the limb's forward axis" },
    Column {
        name: "head_yaw_rad",
        meaning: "sideways angle of the head; the same in the rows of all limbs",
    },
    Column {
        name: "speed_ahead_m_s",
        meaning: "velocity of the middle limb along y, as the snake senses it",
    },
    Column {
        name: "aside_half_widths",
        meaning: "distance of the middle limb from the middle of the stairs, as a share of half their width",
    },
];

/// All columns, in their order.
pub fn columns() -> impl Iterator<Item = Column> {
    KEYS.into_iter().chain(VALUES)
}

/// Reads the values of all limbs at a moment; buffers are reused.
#[derive(Debug, Default)]
pub(super) struct RowReader {
    readings: Vec<LimbReading>,
}

/// The values of a row, in the order of [`VALUES`]; none where there is nothing to measure.
pub(super) type RowValues = [Option<f32>; VALUES.len()];

impl RowReader {
    /// The rows of all limbs, head first.
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
                let of_joint = joint.map(|(state, torque)| {
                    let rates = [state.bend_rad_s, state.twist_rad_s];
                    [
                        state.bend_rad,
                        state.twist_rad,
                        rates[0],
                        rates[1],
                        torque.bend_nm,
                        torque.twist_nm,
                    ]
                });
                let of_joint = of_joint.map_or([None; 6], |values| values.map(Some));
                let on_it = forces.iter().filter(|contact| contact.limb == limb);
                let (mut points, mut force) = (0.0, [0.0; 3]);
                for contact in on_it {
                    points += 1.0;
                    let parts = contact.force_n.to_array();
                    force = std::array::from_fn(|axis| force[axis] + parts[axis]);
                }
                let turn = pose.rotation;
                let mut row = pose.translation.to_array().map(Some).to_vec();
                row.extend([turn.x, turn.y, turn.z, turn.w].map(Some));
                row.extend(velocity.to_array().map(Some));
                row.extend(spin.to_array().map(Some));
                row.extend(of_joint);
                row.push(Some(points));
                row.extend(force.map(Some));
                row.extend(sensed(reading, &snake));
                std::array::from_fn(|index| row.get(index).copied().flatten())
            })
            .collect()
    }
}

/// The values of the senses, in units: before they are scaled, filtered and clamped for controllers.
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
