//! The senses of the limbs: touch and load, attitude, and the distance to the next step.

use std::ops::Range;

use super::Simulation;
use crate::world::turning::turned;
use crate::world::{Rotation, Vector};

/// The senses of one limb, in units of the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LimbReading {
    /// Whether the limb touches the ground or the stairs.
    pub is_touching: bool,
    /// Upward force of the contacts on the limb, in N; at least 0.
    pub load_n: f32,
    /// Force of the contacts on the limb against its forward axis, in N; at least 0.
    pub blocked_n: f32,
    /// Sine of the pitch: upward component of the limb's forward axis.
    pub pitch: f32,
    /// Sine of the roll: upward component of the limb's axis to the right.
    pub roll: f32,
    /// Distance along y from the centre of the front face to the next riser, in metres, and the height of the tread behind the riser over
    /// the limb's lowest corner, in metres. `None` without a riser ahead.
    pub next_step: Option<[f32; 2]>,
    /// Height of the limb's lowest corner over the surface below the limb's centre, in metres.
    pub clearance_m: f32,
}

/// The senses of the snake as a whole, in units of the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SnakeReading {
    /// Sine of the yaw: sideways component of the head's forward axis, positive towards +x.
    pub yaw: f32,
    /// Velocity of the middle limb along y and z, in m/s.
    pub velocity_m_s: [f32; 2],
    /// Offset of the middle limb from the middle of the stairs along x, as a share of half the width of the stairs.
    pub aside: f32,
}

impl Simulation {
    /// Returns the weight of the snake, in N.
    pub fn weight_n(&self) -> f32 {
        self.body().mass_kg() * self.plan.physics.gravity_m_s2
    }

    /// Reads the senses of all limbs, head first, into a buffer that is reused.
    pub fn read_limbs(&self, readings: &mut Vec<LimbReading>) {
        readings.clear();
        let mut first = 0;
        for limb in self.body().parts.chunk_by(|front, rear| front.limb == rear.limb) {
            let parts = first..first + limb.len();
            first = parts.end;
            readings.push(if limb.len() == 1 {
                self.read_part(parts.start)
            } else {
                self.read_soft_limb(parts)
            });
        }
    }

    /// Returns the senses of a soft limb. It touches where one of its parts does, loads add up, pitch and roll are means, the distance to
    /// the next step is that of the front part, and the lowest corner is the lowest of all parts.
    fn read_soft_limb(&self, parts: Range<usize>) -> LimbReading {
        let lowest_z_m =
            parts.clone().map(|part| self.lowest_z_m(part)).fold(f32::INFINITY, f32::min);
        let count = parts.len() as f32;
        let middle = parts.start + parts.len() / 2;
        let middle_m = self.parts()[middle].at;
        let front = self.read_part(parts.start);
        let raised_m = self.lowest_z_m(parts.start) - lowest_z_m;
        let mut limb = LimbReading {
            next_step: front.next_step.map(|[gap_m, up_m]| [gap_m, up_m + raised_m]),
            clearance_m: lowest_z_m - self.profile.surface_z_m(middle_m.x, middle_m.y),
            ..LimbReading::default()
        };
        for part in parts.map(|part| self.read_part(part)) {
            limb.is_touching |= part.is_touching;
            limb.load_n += part.load_n;
            limb.blocked_n += part.blocked_n;
            limb.pitch += part.pitch / count;
            limb.roll += part.roll / count;
        }
        limb
    }

    /// Returns the height of the lowest corner of a part, in metres.
    fn lowest_z_m(&self, part: usize) -> f32 {
        let state = &self.parts()[part];
        self.lowest_z_of_m(part, state.at, axes(state.turn))
    }

    /// Returns the height of the lowest corner of a part with this centre and these axes, in metres.
    fn lowest_z_of_m(&self, part: usize, centre: Vector, axes: [Vector; 3]) -> f32 {
        let half_m = self.body().parts[part].size_m().map(|size_m| size_m / 2.0);
        let reach_m = axes.into_iter().zip(half_m);
        centre.z - reach_m.map(|(axis, half)| axis.z.abs() * half).sum::<f32>()
    }

    /// Returns the senses of the snake as a whole.
    pub fn read_snake(&self) -> SnakeReading {
        let (head, middle) = (&self.parts()[0], &self.parts()[self.body().middle_part]);
        SnakeReading {
            yaw: turned(head.turn, Vector::Y).x,
            velocity_m_s: [middle.linear.y, middle.linear.z],
            aside: middle.at.x / self.profile.half_width_m,
        }
    }

    fn read_part(&self, part: usize) -> LimbReading {
        let state = &self.parts()[part];
        let (centre, axes) = (state.at, axes(state.turn));
        let [right, forward, _] = axes;
        let lowest_z_m = self.lowest_z_of_m(part, centre, axes);
        let front = centre + forward * (self.body().parts[part].length_m / 2.0);
        let next = self.profile.next_step(front.x, front.y);
        LimbReading {
            is_touching: state.touch.any(),
            load_n: state.touch.force_n.z.max(0.0),
            blocked_n: (-state.touch.force_n.dot(forward)).max(0.0),
            pitch: forward.z,
            roll: right.z,
            next_step: next.map(|next| [next.gap_m, next.top_z_m - lowest_z_m]),
            clearance_m: lowest_z_m - self.profile.surface_z_m(centre.x, centre.y),
        }
    }
}

/// Returns the axes of a part with this rotation, as unit vectors in the world: right, forward, up.
fn axes(turn: Rotation) -> [Vector; 3] {
    [Vector::X, Vector::Y, Vector::Z].map(|axis| turned(turn, axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::{Rollout, Trial};

    #[test]
    fn limbs_feel_what_the_contacts_say() {
        let trial = Trial::default();
        let (mut readings, mut touches) = (Vec::new(), 0);
        for individual in 0..5 {
            let mut rollout = Rollout::new(&trial.random_genome(individual), &trial);
            while rollout.advance() {
                let world = rollout.simulation();
                world.read_limbs(&mut readings);
                let touching = readings.iter().filter(|limb| limb.is_touching).count();
                assert_eq!(touching, world.limbs_in_contact());
                touches += touching;
                let forces = world.contact_forces();
                for (limb, reading) in readings.iter().enumerate() {
                    let on_it = forces.iter().filter(|contact| contact.limb == limb);
                    let up_n: f32 = on_it.map(|contact| contact.force_n.z).sum();
                    let off_n = (reading.load_n - up_n.max(0.0)).abs();
                    assert!(off_n < 1e-3 * (1.0 + up_n.abs()), "{reading:?} for {up_n} N");
                }
            }
        }
        assert!(touches > 100);
    }

    #[test]
    fn a_soft_limb_feels_as_a_rigid_one_at_rest() {
        let champion = crate::save::shipped_champion().expect("shipped").champion;
        let mut soft = champion.trial.clone();
        soft.agent.youngs_modulus_pa = Some(60_000.0.into());
        let [rigid, soft] = [&champion.trial, &soft].map(|trial| {
            let mut plan = trial.world_plan(&champion.genome);
            // The limb is turned upwards about the x axis as a whole, and is away from the ground.
            plan.physics.gravity_m_s2 = 0.0;
            let mut world = Simulation::new(&plan);
            let turn = Rotation::from_xyzw(libm::sinf(0.2), 0.0, 0.0, libm::cosf(0.2));
            world.change_parts(|(_, part)| {
                (part.at, part.turn) = (turn * part.at + Vector::new(0.0, 0.0, 20.0), turn);
            });
            let mut readings = Vec::new();
            world.read_limbs(&mut readings);
            readings
        });
        assert_eq!((rigid.len(), soft.len()), (5, 5));
        for (rigid, soft) in rigid.iter().zip(&soft) {
            let values = |of: &LimbReading| {
                let [gap_m, up_m] = of.next_step.expect("a riser ahead");
                [of.pitch, of.roll, of.clearance_m, gap_m, up_m]
            };
            for (a, b) in values(rigid).into_iter().zip(values(soft)) {
                assert!((a - b).abs() < 1e-4, "{rigid:?} {soft:?}");
            }
            assert!((rigid.pitch - libm::sinf(0.4)).abs() < 1e-5);
        }
    }

    #[test]
    fn a_resting_snake_carries_its_weight_and_sees_the_first_riser() {
        let mut trial = Trial::default();
        trial.stairs.first_riser_y_m = 0.0;
        trial.start_y_m = -6.0;
        let genome = trial.random_genome(0);
        let mut world = Simulation::new(&trial.world_plan(&genome));
        for _ in 0..60 {
            world.step(&[Default::default(); 4]).expect("healthy");
        }
        let mut readings = Vec::new();
        world.read_limbs(&mut readings);
        let load_n: f32 = readings.iter().map(|limb| limb.load_n).sum();
        assert!((load_n / world.weight_n() - 1.0).abs() < 0.02, "{load_n} N");
        for (limb, reading) in readings.iter().enumerate() {
            let [gap_m, up_m] = reading.next_step.expect("a riser ahead");
            assert!((gap_m - (1.0 + 2.0 * limb as f32)).abs() < 0.01, "{gap_m} m of limb {limb}");
            assert!((up_m - 0.5).abs() < 0.01, "{up_m} m");
            assert!(reading.is_touching && reading.blocked_n < 1.0);
            assert!(reading.pitch.abs() < 0.01 && reading.roll.abs() < 0.01);
            assert!(reading.clearance_m.abs() < 0.01);
        }
        let snake = world.read_snake();
        assert!(snake.yaw.abs() < 0.01 && snake.aside.abs() < 0.01, "{snake:?}");
    }
}
