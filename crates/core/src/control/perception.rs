//! The senses as controllers receive them: scaled to a magnitude of about one, clamped, and independent of the place.
//!
//! The senses contain neither the time since the start nor an absolute place, so a controller cannot memorise one staircase through its
//! senses.

use super::sense::{
    ANGLE_SCALE_RAD, ActiveSenses, GAP_SCALE_M, RATE_SCALE_RAD_S, SPEED_SCALE_M_S, SenseKind,
};
use crate::genome::controllers::sense_count;
use crate::world::{JointState, LimbReading, PhysicsSettings, Simulation};

/// Everything that a snake senses at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Perception {
    /// Senses of the joints, from the head.
    pub joints: Vec<JointSenses>,
    /// Senses of the limbs, head first.
    pub limbs: Vec<LimbSenses>,
    /// Senses of the snake as a whole.
    pub snake: SnakeSenses,
    /// Share with which the filter of contact forces follows a new force in a step.
    force_share: f32,
    /// Readings of the limbs: working memory.
    readings: Vec<LimbReading>,
}

/// The senses of one joint: see [`SenseKind`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointSenses {
    /// Angle of the joint's bend: [`SenseKind::Bend`].
    pub bend: f32,
    /// Angle of the joint's twist: [`SenseKind::Twist`].
    pub twist: f32,
    /// Rate of the joint's bend: [`SenseKind::BendRate`].
    pub bend_rate: f32,
    /// Rate of the joint's twist: [`SenseKind::TwistRate`].
    pub twist_rate: f32,
}

/// The senses of one limb: see [`SenseKind`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LimbSenses {
    /// Whether the limb touches ground or stairs: [`SenseKind::Touch`].
    pub touch: f32,
    /// Upward force of contacts: [`SenseKind::Load`]. A force F has the value F / (F + W/n), for the weight W of a snake of n limbs.
    pub load: f32,
    /// Force of contacts against the limb's direction, scaled like the load: [`SenseKind::Blocked`].
    pub blocked: f32,
    /// Sine of the limb's pitch: [`SenseKind::Pitch`].
    pub pitch: f32,
    /// Sine of the limb's roll: [`SenseKind::Roll`].
    pub roll: f32,
    /// Distance to the next riser: [`SenseKind::Gap`]. It is 1 without a riser ahead.
    pub gap: f32,
    /// Height of the next tread: [`SenseKind::StepUp`]. It is 0 without a riser ahead.
    pub step_up: f32,
    /// Height over the surface below: [`SenseKind::Clearance`].
    pub clearance: f32,
}

/// The senses of the snake as a whole: see [`SenseKind`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SnakeSenses {
    /// Sine of the head's yaw: [`SenseKind::Yaw`].
    pub yaw: f32,
    /// Velocity towards the stairs: [`SenseKind::SpeedAhead`].
    pub speed_ahead: f32,
    /// Upward velocity: [`SenseKind::SpeedUp`].
    pub speed_up: f32,
    /// Offset from the middle of the stairs: [`SenseKind::Aside`].
    pub aside: f32,
}

/// Time constant of the filter of the contact forces, in s. Without a filter, the forces of a substep would jump by their whole size from
/// step to step.
const FORCE_FILTER_S: f32 = 0.1;

impl Perception {
    /// Computes the share of the filter of forces for the length of a step.
    pub(super) fn take_step(&mut self, physics: &PhysicsSettings) {
        self.force_share = 1.0 - libm::expf(-physics.step_s() / FORCE_FILTER_S);
    }

    /// Senses the world before a step. Values of organs that do not work stay as they are. Nothing is allocated after the first step.
    pub(super) fn update(
        &mut self,
        world: &Simulation,
        joints: &[JointState],
        active: &ActiveSenses,
    ) {
        self.joints.clear();
        self.joints.extend(joints.iter().map(JointSenses::of));
        let is_first = self.limbs.is_empty();
        if !is_first && *active == ActiveSenses::NONE {
            return;
        }
        world.read_limbs(&mut self.readings);
        if is_first {
            self.limbs.resize(self.readings.len(), LimbSenses::default());
        }
        // At the first step every organ gets its value, and the filters begin with the present forces.
        let works = |organ: bool| organ || is_first;
        let force_share = if is_first { 1.0 } else { self.force_share };
        let limb_weight_n = world.weight_n() / self.readings.len() as f32;
        for (limb, reading) in self.limbs.iter_mut().zip(&self.readings) {
            if works(active.touch) {
                limb.touch = if reading.is_touching { 1.0 } else { 0.0 };
                let load = share_of(reading.load_n, limb_weight_n);
                let blocked = share_of(reading.blocked_n, limb_weight_n);
                limb.load += (load - limb.load) * force_share;
                limb.blocked += (blocked - limb.blocked) * force_share;
            }
            if works(active.balance) {
                limb.pitch = SenseKind::Pitch.clamped(reading.pitch);
                limb.roll = SenseKind::Roll.clamped(reading.roll);
            }
            if works(active.sight) {
                let [gap, step_up] = match reading.next_step {
                    Some([gap_m, up_m]) => [gap_m / GAP_SCALE_M, up_m],
                    None => [1.0, 0.0],
                };
                limb.gap = SenseKind::Gap.clamped(gap);
                limb.step_up = SenseKind::StepUp.clamped(step_up);
                limb.clearance = SenseKind::Clearance.clamped(reading.clearance_m);
            }
        }
        if works(active.balance) {
            let reading = world.read_snake();
            let [ahead, up] = reading.velocity_m_s.map(|m_s| m_s / SPEED_SCALE_M_S);
            self.snake = SnakeSenses {
                yaw: SenseKind::Yaw.clamped(reading.yaw),
                speed_ahead: SenseKind::SpeedAhead.clamped(ahead),
                speed_up: SenseKind::SpeedUp.clamped(up),
                aside: SenseKind::Aside.clamped(reading.aside),
            };
        }
    }

    /// Returns the value of a sense of part number `part`, a joint or a limb; 0 for a part that does not exist.
    pub fn value(&self, kind: SenseKind, part: usize) -> f32 {
        let joint = |of: fn(&JointSenses) -> f32| self.joints.get(part).map_or(0.0, of);
        let limb = |of: fn(&LimbSenses) -> f32| self.limbs.get(part).map_or(0.0, of);
        match kind {
            SenseKind::Bend => joint(|joint| joint.bend),
            SenseKind::Twist => joint(|joint| joint.twist),
            SenseKind::BendRate => joint(|joint| joint.bend_rate),
            SenseKind::TwistRate => joint(|joint| joint.twist_rate),
            SenseKind::Touch => limb(|limb| limb.touch),
            SenseKind::Load => limb(|limb| limb.load),
            SenseKind::Blocked => limb(|limb| limb.blocked),
            SenseKind::Pitch => limb(|limb| limb.pitch),
            SenseKind::Roll => limb(|limb| limb.roll),
            SenseKind::Gap => limb(|limb| limb.gap),
            SenseKind::StepUp => limb(|limb| limb.step_up),
            SenseKind::Clearance => limb(|limb| limb.clearance),
            SenseKind::Yaw => self.snake.yaw,
            SenseKind::SpeedAhead => self.snake.speed_ahead,
            SenseKind::SpeedUp => self.snake.speed_up,
            SenseKind::Aside => self.snake.aside,
        }
    }

    /// Returns the number of values that a snake with this many joints senses.
    pub const fn count(joints: usize) -> usize {
        sense_count(joints)
    }

    /// Returns all values in a fixed order: joint by joint, limb by limb, then those of the whole snake.
    pub fn values(&self) -> impl Iterator<Item = f32> + '_ {
        let joints = self
            .joints
            .iter()
            .flat_map(|joint| [joint.bend, joint.twist, joint.bend_rate, joint.twist_rate]);
        let limbs = self.limbs.iter().flat_map(|limb| {
            let LimbSenses { touch, load, blocked, pitch, roll, gap, step_up, clearance } = *limb;
            [touch, load, blocked, pitch, roll, gap, step_up, clearance]
        });
        let SnakeSenses { yaw, speed_ahead, speed_up, aside } = self.snake;
        joints.chain(limbs).chain([yaw, speed_ahead, speed_up, aside])
    }

    /// Returns the name of value number `index` of [`Self::values`] for a snake with this many joints, such as "block 2 gap".
    pub fn name(index: usize, joints: usize) -> String {
        let [of_joints, of_limbs, of_snake] =
            [&SenseKind::ALL[..4], &SenseKind::ALL[4..12], &SenseKind::ALL[12..]];
        let part = |kinds: &[SenseKind], word: &str, index: usize| {
            let (number, kind) = (index / kinds.len() + 1, kinds[index % kinds.len()]);
            format!("{word} {number} {}", kind.info().name)
        };
        if index < 4 * joints {
            return part(of_joints, "joint", index);
        }
        let index = index - 4 * joints;
        if index < 8 * (joints + 1) {
            return part(of_limbs, "block", index);
        }
        let index = index - 8 * (joints + 1);
        of_snake.get(index).map_or("bias", |kind| kind.info().name).to_owned()
    }
}

impl JointSenses {
    fn of(state: &JointState) -> Self {
        Self {
            bend: SenseKind::Bend.clamped(state.bend_rad / ANGLE_SCALE_RAD),
            twist: SenseKind::Twist.clamped(state.twist_rad / ANGLE_SCALE_RAD),
            bend_rate: SenseKind::BendRate.clamped(state.bend_rad_s / RATE_SCALE_RAD_S),
            twist_rate: SenseKind::TwistRate.clamped(state.twist_rad_s / RATE_SCALE_RAD_S),
        }
    }
}

/// Returns F / (F + W) for a force F and a weight W: one half if the force equals the weight, and less than 1 for any force.
fn share_of(force_n: f32, weight_n: f32) -> f32 {
    if force_n > 0.0 { (force_n / (force_n + weight_n)).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::{Rollout, Trial};

    fn updated(perception: &mut Perception, rollout: &Rollout, active: &ActiveSenses) {
        let world = rollout.simulation();
        let joints: Vec<JointState> = world.joint_states().collect();
        perception.update(world, &joints, active);
    }

    #[test]
    fn senses_do_not_depend_on_the_place_of_stairs_and_start() {
        let near = Trial { start_y_m: -2.2, ..Trial::default() };
        let mut far = near.clone();
        far.start_y_m += 4.0;
        far.stairs.first_riser_y_m += 4.0;
        let mut most = [0.0_f32; Perception::count(4)];
        for individual in 0..8 {
            let genome = near.random_genome(individual);
            let mut rollouts = [&near, &far].map(|trial| Rollout::new(&genome, trial));
            let mut perceptions = [Perception::default(), Perception::default()];
            perceptions.iter_mut().for_each(|perception| perception.take_step(&near.physics));
            // After these steps, the difference by rounding of the places has grown, as any difference does.
            for step in 0..25 {
                for (perception, rollout) in perceptions.iter_mut().zip(&rollouts) {
                    updated(perception, rollout, &ActiveSenses::default());
                }
                let [near, far] = &perceptions;
                for (index, (a, b)) in near.values().zip(far.values()).enumerate() {
                    let name = Perception::name(index, 4);
                    assert!((a - b).abs() < 1e-4, "{name}: {a} and {b} in step {step}");
                    most[index] = most[index].max(a.abs());
                }
                rollouts.iter_mut().for_each(|rollout| assert!(rollout.advance()));
            }
        }
        let silent = (0..most.len())
            .filter(|&index| most[index] == 0.0)
            .map(|index| Perception::name(index, 4));
        assert_eq!(silent.collect::<Vec<_>>(), [""; 0], "every sense said something");
    }

    #[test]
    fn a_sense_that_does_not_work_keeps_its_value_and_the_others_go_on() {
        let trial = Trial { start_y_m: -3.0, ..Trial::default() };
        let genome = trial.random_genome(2);
        let mut rollout = Rollout::new(&genome, &trial);
        let mut perception = Perception::default();
        perception.take_step(&trial.physics);
        updated(&mut perception, &rollout, &ActiveSenses::NONE);
        let at_rest = perception.clone();
        assert!(at_rest.limbs.iter().all(|limb| limb.touch == 0.0 && limb.gap > 0.0));
        for _ in 0..60 {
            assert!(rollout.advance());
        }
        updated(&mut perception, &rollout, &ActiveSenses::NONE);
        assert_eq!((&perception.limbs, perception.snake), (&at_rest.limbs, at_rest.snake));
        assert_ne!(perception.joints, at_rest.joints, "the joints always feel");
        let sight = ActiveSenses { sight: true, ..ActiveSenses::NONE };
        updated(&mut perception, &rollout, &sight);
        assert_ne!(perception.limbs[0].gap, at_rest.limbs[0].gap);
        assert_eq!(perception.limbs[0].pitch, at_rest.limbs[0].pitch);
        assert_eq!(perception.snake, at_rest.snake);
    }

    #[test]
    fn values_names_and_kinds_agree() {
        let mut perception = Perception::default();
        perception.joints.resize(2, JointSenses::default());
        perception.limbs.resize(3, LimbSenses::default());
        perception.limbs[1].gap = 0.25;
        perception.joints[1].twist = -0.5;
        perception.snake.aside = 0.75;
        let values: Vec<f32> = perception.values().collect();
        assert_eq!(values.len(), Perception::count(2));
        for (index, value) in values.into_iter().enumerate() {
            let name = Perception::name(index, 2);
            let expected = match name.as_str() {
                "block 2 gap" => 0.25,
                "joint 2 twist" => -0.5,
                "aside" => 0.75,
                _ => 0.0,
            };
            assert_eq!(value, expected, "{name}");
        }
        assert_eq!(perception.value(SenseKind::Gap, 1), 0.25);
        assert_eq!(perception.value(SenseKind::Gap, 9), 0.0);
    }
}
