//! The measures of fitness: what a trial rewards.

use std::collections::VecDeque;
use std::fmt;

use super::way_up::{WayUp, mean_steps};
use crate::schema::{Choices, choices};
use crate::world::{BodyPlan, Pose, Stairs};

/// Allowed range of a fitness in a file. Even with the highest cost of energy, a fitness lies within it.
pub const FITNESS_RANGE: std::ops::RangeInclusive<f32> = -1.0e15..=1.0e15;

choices! {
    /// The measure by which a rollout is scored, in metres except for the count of steps and the share. The report chose the first measure
    /// and considered the next three.
    #[derive(Default)]
    pub enum Fitness {
        #[default]
        Centre = "centre", "Distance of the middle block",
            "Distance of the middle block along the stairs (y) at the end.\n\
             Unintended rewards: Passing beside the stairs, and a leap in the last half second.";
        Head = "head", "Distance of the head",
            "Distance of the head along the stairs (y) at the end.\n\
             Unintended rewards: Stretching or throwing the head forward.";
        /// The y of the centre of mass at the end. A curled snake scores less than a straight one that got as far.
        CentreOfMass = "centre_of_mass", "Distance of the centre of mass",
            "Distance of the centre of mass along the stairs (y) at the end.\n\
             Unintended rewards: The same as with the middle block; a curled snake scores less.";
        Height = "height", "Height of the middle block",
            "The height of the middle block at the end.\n\
             Unintended rewards: Jumping and rearing on the spot.";
        /// The furthest y of the middle limb at any time, wherever the snake ends.
        FurthestY = "furthest_y", "Furthest distance",
            "Furthest distance of the middle block along the stairs (y) at any time.\n\
             Unintended rewards: A leap that falls back.";
        /// The number of steps climbed. A step is climbed if the middle limb's centre is past the riser, over the tread, and within the
        /// width. All snakes that have not climbed a step are equal.
        StepsClimbed = "steps_climbed", "Steps climbed",
            "The steps climbed at the end.\n\
             Unintended rewards: None, but there is no reward before the first step, so the search starts blindly.";
        /// The y of the middle limb's centre. Beside, inside or behind the stairs it counts only up to the first riser. On the landing it
        /// counts up to the place where the whole snake stands on the landing.
        Climb = "climb", "Distance on the stairs",
            "Distance of the middle block along the stairs (y) at the end. Beside the stairs, only the distance to the first riser counts.\n\
             Unintended rewards: A leap over the stairs in the last half second.";
        /// The share of the stairs. The distance of every limb along the stairs counts by its mass, so no body has an advantage by its
        /// length: 0 at the start, 1 with all limbs on the landing. An early arrival adds up to 0.1.
        Share = "share", "Share of the stairs",
            "The share of the way to the landing that the whole body has covered at the end, weighted by mass.\n\
             Unintended rewards: None known. Beside the stairs nothing counts, and a leap over untouched steps is capped.";
    }
}

impl Fitness {
    /// Returns the name in flags and files.
    pub fn name(self) -> &'static str {
        self.choice().name
    }

    /// Returns a short description, to follow "fitness: ".
    pub fn words(self) -> &'static str {
        match self {
            Self::Centre => "distance of the middle block along the stairs (y) at the end",
            Self::Climb => {
                "distance of the middle block along the stairs (y) at the end (beside them, only the distance to the first riser counts)"
            }
            Self::Head => "distance of the head along the stairs (y) at the end",
            Self::CentreOfMass => "distance of the centre of mass along the stairs (y) at the end",
            Self::Height => "height of the middle block at the end",
            Self::FurthestY => {
                "furthest distance of the middle block along the stairs (y) at any time"
            }
            Self::StepsClimbed => "steps climbed at the end",
            Self::Share => {
                "share of the way to the landing at the end, plus up to 10 % for an early arrival"
            }
        }
    }

    /// Computes the fitness from the scores of the last half second: their mean, but the least for a count of steps, and the last for the
    /// furthest y. `None` without scores.
    pub(super) fn over(self, scores: &VecDeque<f32>) -> Option<f32> {
        match self {
            Self::FurthestY => scores.back().copied(),
            Self::StepsClimbed => scores.iter().copied().reduce(f32::min),
            _ => {
                let sum: f64 = scores.iter().copied().map(f64::from).sum();
                (!scores.is_empty()).then(|| (sum / scores.len() as f64) as f32)
            }
        }
    }

    /// Returns whether the measure is a position on the y axis.
    pub fn is_along_y(self) -> bool {
        !matches!(self, Self::Height | Self::StepsClimbed | Self::Share)
    }

    /// Returns the unit with a leading space, or an empty string for a count or a share.
    pub fn unit(self) -> &'static str {
        if matches!(self, Self::StepsClimbed | Self::Share) { "" } else { " m" }
    }

    /// Describes a fitness in a few letters for tables, with its unit. A share is in percent.
    pub fn brief(self, fitness: f32) -> String {
        match self {
            Self::Share => format!("{:.1} %", 100.0 * fitness),
            other => other.text(fitness),
        }
    }

    /// Describes a fitness in words, with its unit.
    pub fn text(self, fitness: f32) -> String {
        match self {
            Self::StepsClimbed => format!("{fitness:.0} steps"),
            // A share above one adds a bonus for an early landing.
            Self::Share if fitness >= 1.0 => {
                format!("all the way (+{:.1} %)", 100.0 * (fitness - 1.0))
            }
            Self::Share => format!("{:.1} % of the way", 100.0 * fitness),
            other => format!("{fitness:.2}{}", other.unit()),
        }
    }
}

impl fmt::Display for Fitness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// Returns the greatest score of [`Fitness::Climb`], in m: the y of the body's middle when the whole body lies on the landing.
pub fn arrived_y_m(stairs: &Stairs, body: &BodyPlan) -> f32 {
    stairs.landing_y_m() + body.length_m() / 2.0
}

/// The state of a rollout from which every measure of fitness is computed.
#[derive(Debug, Clone, Copy)]
pub(super) struct FinalState<'a> {
    /// Built body of the snake.
    pub body: &'a BodyPlan,
    /// Poses of the parts, from the head.
    pub poses: &'a [Pose],
    /// Furthest y that the middle limb's centre has had, in m.
    pub furthest_y_m: f32,
    /// The stairs of the trial.
    pub stairs: &'a Stairs,
    /// Progress of the body over the stairs so far, on which [`Fitness::Share`] depends.
    pub way: &'a WayUp,
    /// Number of steps that a part has touched, on which [`Fitness::Share`] depends.
    pub touched_steps: u32,
}

impl FinalState<'_> {
    /// Returns the score of this state by a measure of fitness.
    pub fn score(&self, fitness: Fitness) -> f32 {
        let middle = self.poses[self.body.middle_part].translation;
        match fitness {
            Fitness::Centre => middle.y,
            Fitness::Climb => {
                let is_up = self.stairs.is_over(middle.to_array());
                let arrived_y_m = arrived_y_m(self.stairs, self.body);
                let max_y_m = if is_up { arrived_y_m } else { self.stairs.first_riser_y_m };
                middle.y.min(max_y_m)
            }
            Fitness::Head => self.poses[0].translation.y,
            Fitness::CentreOfMass => {
                let limbs = self.poses.iter().zip(&self.body.parts);
                let moment: f32 =
                    limbs.map(|(pose, limb)| pose.translation.y * limb.mass_kg()).sum();
                moment / self.body.mass_kg()
            }
            Fitness::Height => middle.z,
            Fitness::FurthestY => self.furthest_y_m,
            Fitness::StepsClimbed => self.stairs.steps_under([middle.x, middle.y, middle.z]) as f32,
            Fitness::Share => {
                let steps = mean_steps(self.body, self.poses, self.stairs);
                self.way.share(steps, self.touched_steps, self.stairs)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::way_up::tests::body;
    use super::*;
    use crate::world::{Rotation, Vector};

    #[test]
    fn each_fitness_follows_its_description() {
        let stairs = Stairs::default();
        let mut body = BodyPlan { middle_part: 1, ..body(&[4.0, 4.0, 2.0]) };
        for (part, mass_kg) in body.parts.iter_mut().zip([1.0, 1.0, 2.0]) {
            part.density_kg_m3 = mass_kg / part.length_m;
        }
        let pose = |x, y, z| Pose::from_parts(Vector::new(x, y, z), Rotation::IDENTITY);
        let score = |fitness, x, z| {
            let poses = [pose(0.0, 10.0, 1.0), pose(x, 6.0, z), pose(0.0, 4.0, 1.0)];
            let way = WayUp::begin(&body, &poses, &stairs);
            let (body, poses, stairs, way) = (&body, &poses, &stairs, &way);
            FinalState { body, poses, furthest_y_m: 9.5, stairs, way, touched_steps: 0 }
                .score(fitness)
        };
        for (fitness, expected) in [
            (Fitness::Centre, 6.0),
            (Fitness::Head, 10.0),
            (Fitness::CentreOfMass, 6.0),
            (Fitness::Height, 1.5),
            (Fitness::FurthestY, 9.5),
            (Fitness::StepsClimbed, 2.0),
        ] {
            assert_eq!(score(fitness, 0.0, 1.5), expected, "{fitness}");
        }
        assert_eq!(score(Fitness::Climb, 0.0, 1.5), 6.0);
        assert_eq!(score(Fitness::Climb, 3.0, 0.5), 3.0, "beside the stairs");
        assert_eq!(score(Fitness::StepsClimbed, 3.0, 0.5), 0.0, "beside the stairs");
        assert_eq!(score(Fitness::StepsClimbed, 0.0, 0.5), 0.0, "inside the stairs");
    }

    #[test]
    fn each_name_parses_to_its_fitness() {
        for &fitness in Fitness::OPTIONS {
            assert_eq!(Fitness::named("fitness", fitness.name()), Ok(fitness));
            let text = serde_json::to_string(&fitness).expect("serialisable");
            assert_eq!(text, format!("\"{fitness}\""));
        }
        let flag = Fitness::named("fitness", "centre-of-mass");
        assert_eq!(flag, Ok(Fitness::CentreOfMass), "as flags spell it");
        let error = Fitness::named("fitness", "speed").unwrap_err().to_string();
        assert!(error.starts_with("fitness is \"speed\"; allowed: centre, head,"), "{error}");
    }
}
