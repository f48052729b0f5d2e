//! The fitness measures: what a trial rewards.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

use crate::check::Invalid;
use crate::schema::{Choice, Choices};
use crate::world::{BodyPlan, Pose, Stairs};

/// Allowed range of a fitness in a file. Even with the highest cost of energy a fitness lies within it.
pub const FITNESS_RANGE: std::ops::RangeInclusive<f32> = -1.0e15..=1.0e15;

/// The measure by which a rollout is scored. The report chose the first and considered the next three.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fitness {
    /// y of the middle limb's centre at the end, in m. The report's choice. Rewards wrongly: flying past
    /// the stairs at their side, and being in mid-leap at the end.
    #[default]
    Centre,
    /// y of the head's centre at the end, in m. Rewards wrongly: stretching the neck, or throwing the
    /// head forward, instead of going anywhere.
    Head,
    /// y of the centre of mass at the end, in m. Rewards wrongly: the same as the centre; and a curled snake
    /// scores less than a straight one that did not get further.
    CentreOfMass,
    /// z of the middle limb's centre at the end, in m. Rewards wrongly: jumping, and rearing on the spot.
    Height,
    /// The furthest y that the middle limb's centre had at any time, in m. Rewards wrongly: a leap that
    /// falls back; where the snake ends does not count.
    FurthestY,
    /// Number of steps climbed at the end: the middle limb's centre is past the riser, over the tread,
    /// and within the width. Rewards nothing before the first step: all snakes that have not reached it
    /// are equal, and evolution searches blindly at first.
    StepsClimbed,
    /// y of the middle limb's centre at the end, in m, as far as it is on the stairs. Beside, inside or behind
    /// them it counts only up to the first riser; on the landing it counts up to where the whole snake stands
    /// there. Rewards wrongly: being in mid-leap over the stairs at the end.
    Climb,
}

impl Fitness {
    /// All measures, the default first.
    pub const ALL: [Self; 7] = [
        Self::Centre,
        Self::Head,
        Self::CentreOfMass,
        Self::Height,
        Self::FurthestY,
        Self::StepsClimbed,
        Self::Climb,
    ];

    /// The name in flags and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Centre => "centre",
            Self::Climb => "climb",
            Self::Head => "head",
            Self::CentreOfMass => "centre_of_mass",
            Self::Height => "height",
            Self::FurthestY => "furthest_y",
            Self::StepsClimbed => "steps_climbed",
        }
    }

    /// A short description, to follow "fitness: ".
    pub fn words(self) -> &'static str {
        match self {
            Self::Centre => "y of the middle block at the end",
            Self::Climb => "y of the middle block at the end, as far as it is on the stairs",
            Self::Head => "y of the head at the end",
            Self::CentreOfMass => "y of the centre of mass at the end",
            Self::Height => "height of the middle block at the end",
            Self::FurthestY => "furthest y of the middle block at any time",
            Self::StepsClimbed => "steps climbed at the end",
        }
    }

    /// Unwanted behaviour that the measure rewards, in a sentence.
    pub fn rewards_wrongly(self) -> &'static str {
        match self {
            Self::Centre => "Passing beside the stairs, and being caught in mid-leap at the end.",
            Self::Climb => "Being caught in mid-leap over the stairs at the end.",
            Self::Head => "Stretching or throwing the head forward.",
            Self::CentreOfMass => "The same as with the centre; a curled snake scores less.",
            Self::Height => "Jumping and rearing on the spot.",
            Self::FurthestY => "A leap that falls back.",
            Self::StepsClimbed => "Nothing before the first step, so the search starts blindly.",
        }
    }

    /// Whether the measure is a position on the y axis.
    pub fn is_along_y(self) -> bool {
        !matches!(self, Self::Height | Self::StepsClimbed)
    }

    /// The unit with a leading space, or nothing for a count.
    pub fn unit(self) -> &'static str {
        if self == Self::StepsClimbed { "" } else { " m" }
    }
}

impl Choices for Fitness {
    const OPTIONS: &'static [Self] = &Self::ALL;

    fn choice(self) -> Choice {
        let title = match self {
            Self::Centre => "Centre, y",
            Self::Head => "Head, y",
            Self::CentreOfMass => "Centre of mass, y",
            Self::Height => "Height",
            Self::FurthestY => "Furthest y",
            Self::StepsClimbed => "Steps climbed",
            Self::Climb => "Climb: y on the stairs",
        };
        let about =
            format!("The {}.\nUnintended rewards: {}", self.words(), self.rewards_wrongly());
        Choice::new(self.name(), title, about)
    }
}

impl fmt::Display for Fitness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Fitness {
    type Err = Invalid;

    fn from_str(text: &str) -> Result<Self, Invalid> {
        let name = text.replace('-', "_");
        Self::ALL.into_iter().find(|fitness| fitness.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|fitness| fitness.name()).collect();
            Invalid::new("fitness", format!("{text:?}"), names.join(", "))
        })
    }
}

/// State at the end of a rollout, from which every fitness is computed.
#[derive(Debug, Clone, Copy)]
pub(super) struct FinalState<'a> {
    /// The built body.
    pub body: &'a BodyPlan,
    /// Poses of the limbs, head first.
    pub poses: &'a [Pose],
    /// The furthest y that the middle limb's centre had, in m.
    pub furthest_y_m: f32,
    /// The stairs.
    pub stairs: &'a Stairs,
}

impl FinalState<'_> {
    /// The score.
    pub fn score(&self, fitness: Fitness) -> f32 {
        let middle = self.poses[self.body.middle_limb()].translation;
        match fitness {
            Fitness::Centre => middle.y,
            Fitness::Climb => {
                let is_up = self.stairs.steps_under(middle.to_array()) > 0;
                let landing_y_m = self.stairs.riser_y_m(self.stairs.steps.saturating_sub(1));
                let arrived_y_m = landing_y_m + self.body.length_m() / 2.0;
                let max_y_m = if is_up { arrived_y_m } else { self.stairs.first_riser_y_m };
                middle.y.min(max_y_m)
            }
            Fitness::Head => self.poses[0].translation.y,
            Fitness::CentreOfMass => {
                let limbs = self.poses.iter().zip(&self.body.limbs);
                let moment: f32 =
                    limbs.map(|(pose, limb)| pose.translation.y * limb.mass_kg()).sum();
                moment / self.body.mass_kg()
            }
            Fitness::Height => middle.z,
            Fitness::FurthestY => self.furthest_y_m,
            Fitness::StepsClimbed => self.stairs.steps_under([middle.x, middle.y, middle.z]) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{LimbPlan, Rotation, Vector};

    #[test]
    fn each_fitness_follows_its_description() {
        let stairs = Stairs::default();
        let limb = |length_m, mass_kg: f32| LimbPlan {
            width_m: 1.0,
            length_m,
            height_m: 1.0,
            density_kg_m3: mass_kg / length_m,
        };
        let body = BodyPlan {
            limbs: vec![limb(4.0, 1.0), limb(4.0, 1.0), limb(2.0, 2.0)],
            joints: Vec::new(),
            angular_damping_per_s: 0.0,
        };
        let pose = |x, y, z| Pose::from_parts(Vector::new(x, y, z), Rotation::IDENTITY);
        let score = |fitness, x, z| {
            let poses = [pose(0.0, 10.0, 1.0), pose(x, 6.0, z), pose(0.0, 4.0, 1.0)];
            FinalState { body: &body, poses: &poses, furthest_y_m: 9.5, stairs: &stairs }
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
        for fitness in Fitness::ALL {
            assert_eq!(fitness.name().parse(), Ok(fitness));
            let text = serde_json::to_string(&fitness).expect("serialisable");
            assert_eq!(text, format!("\"{fitness}\""));
        }
        assert_eq!("centre-of-mass".parse(), Ok(Fitness::CentreOfMass), "as flags spell it");
        let error = "speed".parse::<Fitness>().unwrap_err().to_string();
        assert!(error.starts_with("fitness is \"speed\"; allowed: centre, head,"), "{error}");
    }
}
