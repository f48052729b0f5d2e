//! Rules that all worlds of an environment share.

use pyo3::prelude::*;
use snakes_core::control::{Perception, SenseInfo, SenseKind};
use snakes_core::genome::controllers::{JointSignals, TorqueSignals};
use snakes_core::genome::{
    BodyGenes, ControllerGenes, Genome, GenomeSpace, SERVO_DAMPING_RANGE,
    STIFFNESS_RANGE_NM_PER_RAD,
};
use snakes_core::rng::{Purpose, stream};
use snakes_core::schema;
use snakes_core::score::{Perturbation, PerturbationRange, Trial};
use snakes_core::world::BodyPlan;

use crate::convert::{changes_in, whole};
use crate::errors::{invalid, refused};
use crate::problem::Problem;

/// Meaning of an action's number for each joint axis.
#[derive(Clone, Copy, PartialEq)]
pub enum ActionKind {
    /// The number is the target angle of a servo, in rad.
    Targets,
    /// The number is a torque, in N·m.
    Torques,
}

/// Rules that all worlds of an environment share.
pub struct WorldRules {
    pub trial: Trial,
    /// Genome that gives the snake its body. Its controller is not used.
    pub genome: Genome,
    pub actions: ActionKind,
    pub steps_per_action: u32,
    pub stiffness_nm_per_rad: f32,
    pub damping_nms_per_rad: f32,
    pub perturbation: Option<PerturbationRange>,
    /// Penalty on the reward of the step in which the snake is disqualified.
    pub disqualification_penalty: f64,
}

/// Returns a genome with these genes of the body, whose controller does nothing.
pub fn at_rest(body: BodyGenes, trial: &Trial) -> Genome {
    let joints = |genome: &Genome| trial.agent.body_plan(genome).joints.len();
    let controller = |joints| {
        let still = JointSignals { bend_nm: vec![0.0], twist_nm: vec![0.0] };
        let joints = vec![still; joints];
        ControllerGenes::Signal(TorqueSignals { points_per_s: 1.0, joints })
    };
    let genome = Genome { body, controller: controller(0) };
    Genome { controller: controller(joints(&genome)), ..genome }
}

/// Returns the genes of the body in the middle of a space's ranges.
fn middle_body(space: &GenomeSpace, trial: &Trial) -> BodyGenes {
    let shape = trial.genome_shape();
    space.genome_at(&vec![0.5; space.dimension(shape)], shape).body
}

impl WorldRules {
    /// Checks the arguments of an environment. `servo` has stiffness and damping, where they are given.
    pub fn new(
        problem: &Problem,
        actions: &str,
        steps_per_action: &Bound<'_, PyAny>,
        servo: [Option<f64>; 2],
        perturbation: Option<&Bound<'_, PyAny>>,
        disqualification_penalty: f64,
    ) -> PyResult<Self> {
        let (trial, space) = (problem.settings.trial.clone(), &problem.settings.genome);
        let steps_per_action =
            whole("steps_per_action", steps_per_action, 1..=MOST_STEPS_PER_ACTION)? as u32;
        let actions = match actions {
            "targets" => ActionKind::Targets,
            "torques" => ActionKind::Torques,
            _ => return Err(refused("actions", format!("{actions:?}"), "targets, torques")),
        };
        let fields = [
            ("stiffness_nm_per_rad", STIFFNESS_RANGE_NM_PER_RAD),
            ("damping_nms_per_rad", SERVO_DAMPING_RANGE),
        ];
        let wave = &space.wave;
        let middle = (wave.stiffness_min_nm_per_rad + wave.stiffness_max_nm_per_rad) / 2.0;
        let mut servo_values = [middle, wave.servo_damping_nms_per_rad];
        for (((field, range), given), value) in fields.into_iter().zip(servo).zip(&mut servo_values)
        {
            let Some(given) = given else { continue };
            if actions == ActionKind::Torques {
                let allowed = "None with actions=\"torques\", which no servo follows";
                return Err(refused(field, given, allowed));
            }
            *value = within(field, given, f64::from(*range.start())..=f64::from(*range.end()))?;
        }
        let [stiffness_nm_per_rad, damping_nms_per_rad] = servo_values;
        within("disqualification_penalty", disqualification_penalty, 0.0..=1.0e6)?;
        let body = problem.body.clone().unwrap_or_else(|| middle_body(space, &trial));
        let rules = Self {
            genome: at_rest(body, &trial),
            trial,
            actions,
            steps_per_action,
            stiffness_nm_per_rad,
            damping_nms_per_rad,
            perturbation: perturbation_of(perturbation)?,
            disqualification_penalty,
        };
        let is_own = rules.genome.body.has_own_blocks();
        let checked = if is_own { rules.trial.check_own_bodies() } else { Ok(()) };
        checked.and_then(|()| rules.trial.check_genome(&rules.genome)).map_err(invalid)?;
        Ok(rules)
    }

    pub fn body(&self) -> BodyPlan {
        self.trial.agent.body_plan(&self.genome)
    }

    /// Returns the greatest action of each joint axis in either direction: bend and twist, joint by joint.
    pub fn action_limits(&self) -> Vec<f32> {
        let limits = self.body().joints.into_iter().flat_map(|joint| match self.actions {
            ActionKind::Targets => [joint.bend_limit_rad, joint.twist_limit_rad],
            ActionKind::Torques => [joint.max_bend_torque_nm, joint.max_twist_torque_nm],
        });
        limits.collect()
    }

    /// Returns names and descriptions of the senses, in the order of an observation.
    pub fn senses(&self) -> Vec<(String, SenseInfo)> {
        let joints = self.body().joints.len();
        let kinds = std::iter::repeat_n(&SenseKind::ALL[..4], joints)
            .chain(std::iter::repeat_n(&SenseKind::ALL[4..12], joints + 1))
            .chain([&SenseKind::ALL[12..]])
            .flatten();
        kinds.enumerate().map(|(i, kind)| (Perception::name(i, joints), kind.info())).collect()
    }

    /// Draws the perturbation of an episode from its seed.
    pub fn draw(&self, seed: u64) -> Perturbation {
        self.perturbation.map_or_else(Perturbation::default, |range| {
            let mut rng = stream(seed, 0, 0, Purpose::Perturbation);
            range.draw(self.trial.duration_s, self.trial.agent.limbs, &mut rng)
        })
    }
}

/// Maximum number of physics steps of one action.
const MOST_STEPS_PER_ACTION: u64 = 1000;

fn within(field: &str, value: f64, range: std::ops::RangeInclusive<f64>) -> PyResult<f32> {
    if range.contains(&value) {
        return Ok(value as f32);
    }
    Err(refused(field, value, &format!("{} to {}", range.start(), range.end())))
}

/// Reads the ranges of perturbations from Python: None for no perturbation, True for the usual ranges, or a dictionary, in which
/// missing ranges are 0.
fn perturbation_of(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<PerturbationRange>> {
    let Some(value) = value.filter(|value| !value.is_none()) else { return Ok(None) };
    if let Ok(is_usual) = value.extract::<bool>() {
        return Ok(is_usual.then(PerturbationRange::default));
    }
    let mut range = PerturbationRange {
        friction: 0.0,
        rise: 0.0,
        density: 0.0,
        start_m: 0.0,
        turn_deg: 0.0,
        tread: 0.0,
        step_rate: 0.0,
        shove_m_s: 0.0,
        ..PerturbationRange::default()
    };
    for (name, text) in changes_in("perturbation", "", Some(value))? {
        let path = schema::find(&range, &name).map_err(|error| {
            let allowed = error.allowed.replace("(nearest) ", "");
            refused("perturbation", format!("{name:?}"), &allowed)
        })?;
        schema::set_text(&mut range, &path, &text)
            .map_err(|error| invalid(error.inside("perturbation")))?;
    }
    schema::check(&range).map_err(|error| invalid(error.inside("perturbation")))?;
    Ok(Some(range))
}
