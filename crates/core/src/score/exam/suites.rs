//! The conditions of each suite of an exam.

use super::{ExamCondition, ExamSuite};
use crate::control::ActiveSenses;
use crate::genome::{HELD_OUT_PER_CLASS, StairsClass, held_out};
use crate::rng::{Purpose, stream};
use crate::schema::Choices;
use crate::score::perturbation_range::draw_shove;
use crate::score::{Perturbation, PerturbationRange, Trial};
use crate::world::Stairs;

/// Time by which a shoved snake may land later than without the shove, in s.
pub(super) const RECOVERY_S: f32 = 5.0;
/// Number of trials in the suites of random conditions.
const TRIALS: u32 = 100;
/// Number of different starts in the suite with the other engine.
const STARTS: u32 = 20;
/// Seed of the random conditions.
const SEED: u64 = 1;
/// Duration of the trials in the long suites, such as those on other stairs and with shoves, in s.
const DURATION_S: f32 = 30.0;
/// Depth of the landing in the long suites, in m: a snake that lands early has room for the rest of the time.
const LANDING_M: f32 = 100.0;
/// Shifts of the first riser away from the start, in m, relative to the champion's own trial.
const FURTHER_M: [f32; 5] = [-0.6, -0.3, 0.0, 0.3, 0.6];
/// Factor on the rise of the surprisingly high step.
const SURPRISE: f32 = 1.4;
/// Greatest rise that a staircase may have, in m.
const HIGHEST_RISE_M: f32 = 5.0;
/// Change of a limb's velocity by a shove, in m/s.
const SHOVE_M_S: f32 = 2.0;
/// First and last moment of a shove, in s.
const SHOVE_MOMENT_S: [f32; 2] = [3.0, 8.0];

impl ExamSuite {
    /// Returns the undisturbed trial with which the conditions are compared: the champion's own trial, with the duration of the
    /// conditions.
    pub fn undisturbed(self, trial: &Trial) -> ExamCondition {
        let trial = match self {
            Self::Trials | Self::StepRate | Self::Engine => trial.clone(),
            Self::Stairs | Self::Surprise | Self::Shove | Self::Lesion | Self::HeldOut => {
                long(trial)
            }
        };
        condition("undisturbed", trial)
    }

    /// Returns the conditions for a champion with this trial.
    pub fn conditions(self, trial: &Trial) -> Vec<ExamCondition> {
        match self {
            Self::Trials => varied(trial, &PerturbationRange::default(), TRIALS, SEED),
            Self::StepRate => step_rates(trial),
            Self::Stairs => other_stairs(trial),
            Self::Surprise => higher_steps(trial),
            Self::Shove => shoves(trial),
            Self::Lesion => other_stairs(&without_senses(trial)),
            Self::HeldOut => held_out_stairs(trial),
            Self::Engine => other_engine(trial),
        }
    }
}

/// Draws random variations of a trial.
pub fn varied(
    trial: &Trial,
    range: &PerturbationRange,
    trials: u32,
    seed: u64,
) -> Vec<ExamCondition> {
    let one = |number| {
        let mut rng = stream(seed, 0, number, Purpose::Perturbation);
        ExamCondition {
            perturbation: range.draw(trial.duration_s, trial.agent.limbs, &mut rng),
            ..condition(&format!("trial {}", number + 1), trial.clone())
        }
    };
    (0..trials).map(one).collect()
}

fn condition(label: &str, trial: Trial) -> ExamCondition {
    ExamCondition { label: label.to_owned(), trial, perturbation: Perturbation::default() }
}

/// Returns the trial with the duration and the landing of the long suites.
fn long(trial: &Trial) -> Trial {
    let stairs = Stairs { landing_m: LANDING_M, ..trial.stairs.clone() };
    Trial { duration_s: DURATION_S, stairs, ..trial.clone() }
}

/// Returns conditions with other starts, first all in the trial's own engine, then all in the other engine; empty if the other engine
/// cannot simulate the trial's snakes.
fn other_engine(trial: &Trial) -> Vec<ExamCondition> {
    if trial.agent.youngs_modulus_pa.is_some() {
        return Vec::new();
    }
    let mut other = trial.clone();
    other.physics.engine = trial.physics.engine.other();
    let range = PerturbationRange { friction: 0.0, rise: 0.0, ..Default::default() };
    let in_engine = |trial: &Trial, words: &str| {
        let starts = varied(trial, &range, STARTS, SEED).into_iter();
        let named =
            starts.map(|of| ExamCondition { label: format!("{}, {words}", of.label), ..of });
        named.collect::<Vec<_>>()
    };
    [in_engine(trial, "own engine"), in_engine(&other, "other engine")].concat()
}

/// Returns the trial with all senses switched off, except those of the joints.
fn without_senses(trial: &Trial) -> Trial {
    let mut trial = trial.clone();
    trial.agent.senses = ActiveSenses::NONE;
    trial
}

fn step_rates(trial: &Trial) -> Vec<ExamCondition> {
    let with = |label: &str, change: &dyn Fn(&mut Trial)| {
        let mut changed = trial.clone();
        change(&mut changed);
        condition(label, changed)
    };
    let rates = [60, 120, 240].map(|steps_per_s| {
        with(&format!("{steps_per_s} Hz"), &|trial| trial.physics.steps_per_s = steps_per_s)
    });
    let substeps = [4, 8].map(|substeps| {
        with(&format!("{substeps} substeps"), &|trial| trial.physics.substeps = substeps)
    });
    rates.into_iter().chain(substeps).collect()
}

fn other_stairs(trial: &Trial) -> Vec<ExamCondition> {
    let mut all = Vec::new();
    for rise_m in [0.3, 0.4, 0.5, 0.6, 0.7] {
        for tread_m in [1.5, 2.0, 2.5, 3.0] {
            for further_m in FURTHER_M {
                let mut other = long(trial);
                let first_riser_y_m = other.stairs.first_riser_y_m + further_m;
                let rise = rise_m.into();
                other.stairs = Stairs {
                    rise_m: rise,
                    tread_m: tread_m.into(),
                    slope_m: 0.0.into(),
                    first_riser_y_m,
                    ..other.stairs
                };
                let label =
                    format!("rise {rise_m} m, tread {tread_m} m, from {first_riser_y_m:.1} m");
                all.push(condition(&label, other));
            }
        }
    }
    all
}

/// Returns the held-out stairs, class by class. The first riser is where it is in the champion's own trial.
fn held_out_stairs(trial: &Trial) -> Vec<ExamCondition> {
    let on = |class: StairsClass, number: u32| {
        let other = long(trial).on_stairs(held_out(class, number).stairs());
        condition(&format!("{} {}", class.choice().name, number + 1), other)
    };
    let classes = StairsClass::OPTIONS.iter();
    classes
        .flat_map(|&class| (0..HELD_OUT_PER_CLASS).map(move |number| on(class, number)))
        .collect()
}

fn higher_steps(trial: &Trial) -> Vec<ExamCondition> {
    let mut all = Vec::new();
    let steps = trial.stairs.steps;
    // Index 0 is the first step. With at most three steps, any of them may be higher.
    let places = if steps > 3 { 3..steps.min(9) } else { 0..steps };
    // A step down cannot be higher.
    let places = places.filter(|step| trial.stairs.step_rise_m(*step) > 0.0);
    for high in places {
        for further_m in FURTHER_M {
            let mut other = long(trial);
            let first_riser_y_m = other.stairs.first_riser_y_m + further_m;
            let rises = (0..steps).map(|step| {
                let rise_m = other.stairs.step_rise_m(step);
                if step == high { (rise_m * SURPRISE).min(HIGHEST_RISE_M) } else { rise_m }
            });
            let rise_m = crate::schema::PerPart::Each(rises.collect());
            other.stairs =
                Stairs { rise_m, first_riser_y_m, ..other.stairs }.with_room_for_slopes();
            let label = format!("step {} higher, from {first_riser_y_m:.1} m", high + 1);
            all.push(condition(&label, other));
        }
    }
    all
}

fn shoves(trial: &Trial) -> Vec<ExamCondition> {
    let one = |number: u32| {
        let mut rng = stream(SEED, 0, number, Purpose::Shove);
        let shove = draw_shove(SHOVE_M_S, SHOVE_MOMENT_S, trial.agent.limbs, &mut rng);
        let perturbation = Perturbation { shove: Some(shove), ..Perturbation::default() };
        ExamCondition { perturbation, ..condition(&format!("shove {}", number + 1), long(trial)) }
    };
    (0..TRIALS).map(one).collect()
}
