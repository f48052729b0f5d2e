//! The share of the stairs that a body has climbed, for bodies of any length.

use crate::world::{BodyPlan, Pose, Stairs};

/// Time for which the whole body has to stay on the landing until it counts as arrived, in s.
const ARRIVAL_S: f32 = 0.5;
/// Greatest addition to the share of the stairs for an early arrival.
const ARRIVAL_BONUS: f32 = 0.1;

/// Data of a rollout on which [`Fitness::Share`](super::Fitness::Share) depends, besides its present state.
#[derive(Debug, Clone, Default)]
pub(super) struct WayUp {
    /// Distance of the body along the stairs at the start, in steps: see [`mean_steps`].
    start_steps: f32,
    arrival: Arrival,
}

/// When the whole body has stood on the landing for `ARRIVAL_S`.
#[derive(Debug, Clone, Default)]
pub(super) struct Arrival {
    /// Time since which the whole body has been on the landing, in s; `None` if it is not there.
    up_since_s: Option<f32>,
    /// Time at which the whole body had first been on the landing for `ARRIVAL_S`, in s; `None` if it never was.
    pub arrived_s: Option<f32>,
}

impl Arrival {
    /// Takes in the distance of the body along the stairs, see [`mean_steps`], at this simulated time.
    pub fn observe(&mut self, steps: f32, stairs: &Stairs, time_s: f32) {
        let is_up = steps >= stairs.steps as f32;
        self.up_since_s = is_up.then(|| self.up_since_s.unwrap_or(time_s));
        let stays = self.up_since_s.is_some_and(|since_s| time_s - since_s >= ARRIVAL_S);
        if stays && self.arrived_s.is_none() {
            self.arrived_s = Some(time_s);
        }
    }
}

impl WayUp {
    /// Begins with a body at its start.
    pub fn begin(body: &BodyPlan, poses: &[Pose], stairs: &Stairs) -> Self {
        Self { start_steps: mean_steps(body, poses, stairs), arrival: Arrival::default() }
    }

    /// Takes in the state after a healthy step, at this simulated time.
    pub fn observe(&mut self, body: &BodyPlan, poses: &[Pose], stairs: &Stairs, time_s: f32) {
        self.arrival.observe(mean_steps(body, poses, stairs), stairs, time_s);
    }

    /// Returns the share of the distance from the start to the landing. A body that has leapt over treads gets at most twice the share of
    /// the `touched` treads.
    pub fn share(&self, steps: f32, touched: u32, stairs: &Stairs) -> f32 {
        let all = stairs.steps as f32;
        let whole = all - self.start_steps;
        if whole <= 0.0 {
            return 0.0;
        }
        let share = (steps - self.start_steps) / whole;
        if stairs.steps == 0 {
            return share;
        }
        // The distance before the first riser needs no touch.
        let capped = (2.0 * touched as f32).min(all);
        share.min((capped - self.start_steps.min(0.0)) / (all - self.start_steps.min(0.0)))
    }

    /// Returns the addition for the time of arrival in a trial of this length, in s; 0 for a body that has left the landing.
    pub fn bonus(&self, duration_s: f32) -> f32 {
        let Arrival { up_since_s, arrived_s } = self.arrival;
        let arrived_s = arrived_s.filter(|_| up_since_s.is_some());
        arrived_s.map_or(0.0, |arrived_s| ARRIVAL_BONUS * (1.0 - arrived_s / duration_s).max(0.0))
    }
}

/// Returns the distance of a body along the stairs, in steps: the mean over its limbs, weighted by mass. The distance of a limb counts
/// from the first riser, in treads, up to the last step. It counts only above the limb's tread; beside, inside or behind the stairs, only
/// up to the first riser. Before the first riser it is negative.
pub(super) fn mean_steps(body: &BodyPlan, poses: &[Pose], stairs: &Stairs) -> f32 {
    let (mut sum, mut mass_kg) = (0.0, 0.0);
    for (pose, limb) in poses.iter().zip(&body.parts) {
        let at_m = pose.translation;
        let way = stairs.way_steps(at_m.y);
        let most = if stairs.is_over(at_m.to_array()) { stairs.steps as f32 } else { 0.0 };
        sum += limb.mass_kg() * way.min(most);
        mass_kg += limb.mass_kg();
    }
    // Equal limbs at the top have exactly all steps, even if their masses are rounded.
    let mean = sum / mass_kg;
    let all = stairs.steps as f32;
    if mean >= all * (1.0 - 1.0e-6) { all } else { mean }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::world::{PartPlan, Rotation, Vector};

    /// Returns a straight body of blocks of these lengths, in metres, without joints.
    pub fn body(lengths_m: &[f32]) -> BodyPlan {
        let limb = |&length_m| PartPlan {
            limb: 0,
            width_m: 1.0,
            length_m,
            height_m: 1.0,
            density_kg_m3: 2.0,
        };
        BodyPlan {
            parts: lengths_m.iter().map(limb).collect(),
            joints: Vec::new(),
            springs: Vec::new(),
            contact_free_pairs: Vec::new(),
            middle_part: 0,
            angular_damping_per_s: 0.0,
            holding_w_per_n2m2: 0.0,
        }
    }

    fn poses(places: &[[f32; 3]]) -> Vec<Pose> {
        let pose = |&at: &[f32; 3]| Pose::from_parts(Vector::from(at), Rotation::IDENTITY);
        places.iter().map(pose).collect()
    }

    #[test]
    fn the_way_counts_by_mass_and_only_on_the_stairs() {
        let stairs = Stairs::default();
        let heavy_tail = body(&[1.0, 3.0]);
        let way = |places: &[[f32; 3]]| mean_steps(&heavy_tail, &poses(places), &stairs);
        // The head is half a tread past the second riser, the tail two treads before the first riser.
        assert_eq!(way(&[[0.0, 6.0, 1.5], [0.0, -1.0, 0.5]]), (1.5 - 2.0 * 3.0) / 4.0);
        assert_eq!(
            way(&[[3.0, 6.0, 1.5], [0.0, -1.0, 0.5]]),
            -1.5,
            "the head is beside the stairs"
        );
        assert_eq!(way(&[[0.0, 6.0, 0.5], [0.0, -1.0, 0.5]]), -1.5, "the head is inside a step");
        assert_eq!(way(&[[0.0, 30.0, 5.5], [0.0, 27.0, 5.5]]), 10.0, "up");
    }

    #[test]
    fn a_leap_over_untouched_steps_is_capped() {
        let stairs = Stairs::default();
        let both = body(&[1.0, 1.0]);
        let way = WayUp::begin(&both, &poses(&[[0.0, -1.0, 0.5], [0.0, -3.0, 0.5]]), &stairs);
        assert_eq!(way.share(way.start_steps, 0, &stairs), 0.0, "nothing for staying");
        assert_eq!(way.share(10.0, 10, &stairs), 1.0);
        // Of the 12.5 treads from the start to the landing, 2.5 lie before the stairs. One touch counts for two steps.
        assert!((way.share(10.0, 1, &stairs) - 4.5 / 12.5).abs() < 1e-6);
    }

    #[test]
    fn an_early_arrival_has_a_bonus_as_long_as_the_body_stays() {
        let arrival = Arrival { arrived_s: Some(3.0), up_since_s: Some(2.5) };
        let mut way = WayUp { arrival, ..WayUp::default() };
        assert!((way.bonus(15.0) - 0.08).abs() < 1e-6);
        way.arrival.up_since_s = None;
        assert_eq!(way.bonus(15.0), 0.0, "it has fallen off again");
    }
}
