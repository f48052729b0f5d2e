//! Exams of a champion: its genome in many other conditions than those in which it evolved.

mod suites;

pub use suites::varied;

use serde::{Deserialize, Serialize};

use super::ending::median;
use super::way_up::{Arrival, mean_steps};
use super::{Ending, Endings, Evaluation, Perturbation, Rollout, Trial};
use crate::check::{Invalid, quoted, within};
use crate::genome::{Genome, HELD_OUT_PER_CLASS, StairsClass};
use crate::schema::{Choices, choices};
use crate::world::Stairs;

choices! {
    /// A suite of an exam: a list of conditions that test one ability.
    #[derive(PartialOrd, Ord)]
    pub enum ExamSuite {
        Trials = "trials", "Varied trials",
            "100 trials with other friction (±20 %), rise (±10 %) and start (±0.2 m, ±5°).";
        StepRate = "step-rate", "Step rates",
            "60, 120 and 240 physics steps per second, and 4 and 8 substeps per step.";
        Stairs = "stairs", "Other stairs",
            "100 staircases: rise 0.3 to 0.7 m, tread 1.5 to 3 m, 5 positions of the first riser; 30 s each.";
        Surprise = "surprise", "A higher step",
            "One step, of the fourth to ninth where there are so many, has 1.4 times the rise; 5 positions of the first riser; \
             30 s each.";
        Shove = "shove", "Shoves",
            "One block's velocity changes by 2 m/s, 3 to 8 s after the start. A landing counts if it comes at most 5 s later \
             than without the shove.";
        Lesion = "lesion", "Frozen senses",
            "The 100 other stairs, on which sight, touch and balance keep the values of the snake at rest: what remains is \
             what the snake does without them. Only for controllers that sense their surroundings.";
        HeldOut = "held-out", "Held-out stairs",
            "60 staircases on which no run may learn, 15 each with equal steps, irregular steps, the proportions of houses, and \
             nosings; 30 s each. A landing counts once the middles of all blocks have been behind the last tread for half a second.";
        Engine = "engine", "The other engine",
            "20 trials in the program's other physics engine, from other starts (±0.2 m, ±5°), and the same trials in its own: lanes \
             examines champions of rapier, and rapier those of lanes. Only if it is named.";
    }
}

/// One condition of a suite: a trial, and how the world deviates from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExamCondition {
    /// Description of the condition in a few words.
    pub label: String,
    /// Trial of the condition, without the perturbation.
    pub trial: Trial,
    /// Deviation of the world from the trial.
    pub perturbation: Perturbation,
}

/// The end of a trial of an exam.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExamEnd {
    /// Number of steps under the middle limb at the end; 0 after a disqualification.
    pub steps: u32,
    /// Share of the distance from the start to the landing that the middle limb covered, 0 to 1; 0 after a disqualification. Beside the
    /// stairs, only the distance to the first riser counts.
    pub way: f32,
    /// Time at which the middle limb was first on the landing, in s; `None` if it never was.
    pub landed_s: Option<f32>,
    /// Time at which the centres of all blocks had first been behind the last tread for half a second, in s; `None` if they never were.
    pub arrived_s: Option<f32>,
    /// Whether the middle limb ended on the landing.
    pub has_landed: bool,
    /// Whether the snake was disqualified.
    pub is_disqualified: bool,
    /// How the trial ended.
    pub ending: Ending,
}

/// The result of one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteResult {
    /// The suite.
    pub suite: ExamSuite,
    /// Number of trials of the suite.
    pub trials: u32,
    /// Number of trials that ended on the landing.
    pub landed: u32,
    /// Number of trials that were disqualified.
    pub disqualified: u32,
    /// Median of the numbers of steps climbed.
    pub median_steps: f32,
    /// Share of the distance in its own trial that the champion keeps: the median over the trials, or the smallest share for the suite of
    /// step rates, which has few trials.
    pub kept: f32,
    /// Label and share of each condition, for a suite of few conditions. For the held-out stairs: name of each class, and the share of its
    /// staircases on which the champion landed.
    pub each: Vec<(String, f32)>,
    /// How the trials ended. Empty in records of earlier versions.
    #[serde(default, skip_serializing_if = "Endings::is_empty")]
    pub endings: Endings,
}

impl ExamSuite {
    /// The suites of an exam without a list of suites: all but the one with the other physics engine.
    pub const USUAL: [Self; 7] = [
        Self::Trials,
        Self::StepRate,
        Self::Stairs,
        Self::Surprise,
        Self::Shove,
        Self::Lesion,
        Self::HeldOut,
    ];

    /// The suites with 100 other stairs.
    pub const OF_STAIRS: [Self; 2] = [Self::Stairs, Self::Lesion];

    /// Returns whether the suite can test a genome. For instance, senses that a controller does not use cannot be switched off.
    pub fn concerns(self, genome: &Genome) -> bool {
        self != Self::Lesion || genome.senses_surroundings()
    }
}

impl ExamCondition {
    /// Checks the trial and the perturbation.
    ///
    /// # Errors
    /// Returns an error for a trial that is not allowed, or a perturbation that no exam contains.
    pub fn check(&self) -> Result<(), Invalid> {
        self.trial.check().map_err(|error| error.inside("trial"))?;
        self.perturbation.check().map_err(|error| error.inside("perturbation"))
    }
}

impl ExamEnd {
    /// The end of a trial whose simulation panicked.
    pub const CRASHED: Self = Self {
        steps: 0,
        way: 0.0,
        landed_s: None,
        arrived_s: None,
        has_landed: false,
        is_disqualified: true,
        ending: Ending::CRASHED,
    };

    /// Checks that every value is one with which a trial can end.
    ///
    /// # Errors
    /// Returns an error for a value with which no trial ends.
    pub fn check(&self) -> Result<(), Invalid> {
        within("steps", self.steps, 0..=1000)?;
        within("way", self.way, 0.0..=1.0)?;
        let time = |field, time_s: Option<f32>| {
            time_s.map_or(Ok(()), |time_s| within(field, time_s, 0.0..=1.0e4))
        };
        time("landed_s", self.landed_s)?;
        time("arrived_s", self.arrived_s)?;
        self.ending.check()
    }

    /// Returns the share of the distance to the landing with which an evaluation ended, 0 to 1; 0 after a disqualification.
    pub fn way_of(evaluation: &Evaluation, trial: &Trial) -> f32 {
        way_of_end(evaluation, &trial.stairs, trial.start_y_m)
    }

    /// Simulates a genome in a condition and returns the end of the trial.
    pub fn of(genome: &Genome, condition: &ExamCondition) -> Self {
        let ExamCondition { trial, perturbation, .. } = condition;
        let mut rollout = Rollout::perturbed(genome, trial, perturbation);
        let mut landed_s = None;
        let mut arrival = Arrival::default();
        while rollout.advance() {
            if rollout.is_on_landing() {
                landed_s = landed_s.or(Some(rollout.time_s()));
            }
            let steps = mean_steps(rollout.body(), rollout.poses(), rollout.stairs());
            arrival.observe(steps, rollout.stairs(), rollout.time_s());
        }
        let evaluation = rollout.evaluation();
        let start_y_m = trial.middle_start_y_m(genome) + perturbation.ahead_m;
        Self {
            steps: steps_of_end(&evaluation),
            way: way_of_end(&evaluation, rollout.stairs(), start_y_m),
            landed_s,
            arrived_s: arrival.arrived_s,
            has_landed: evaluation.is_on_landing(rollout.stairs()),
            is_disqualified: evaluation.disqualified.is_some(),
            ending: rollout.ending(),
        }
    }

    /// Describes the end of a healthy trial whose middle limb ended at `middle_m`, in metres.
    pub(super) fn at(middle_m: [f32; 3], stairs: &Stairs, start_y_m: f32, ending: Ending) -> Self {
        let steps = stairs.steps_under(middle_m);
        Self {
            steps,
            way: way(middle_m[1], steps, stairs, start_y_m),
            landed_s: None,
            arrived_s: None,
            has_landed: stairs.steps > 0 && steps == stairs.steps,
            is_disqualified: false,
            ending,
        }
    }
}

/// Returns the number of steps under the middle limb at the end of a trial; 0 after a disqualification.
fn steps_of_end(evaluation: &Evaluation) -> u32 {
    let behaviour = evaluation.behaviour.filter(|_| evaluation.disqualified.is_none());
    behaviour.map_or(0, |behaviour| behaviour.steps_climbed)
}

/// Returns the share of the distance to the landing with which an evaluation ended, 0 to 1; 0 after a disqualification.
fn way_of_end(evaluation: &Evaluation, stairs: &Stairs, start_y_m: f32) -> f32 {
    if evaluation.disqualified.is_some() {
        return 0.0;
    }
    way(evaluation.centre_y_m, steps_of_end(evaluation), stairs, start_y_m)
}

/// Returns the share of the distance from the start to the landing that was covered at the end of a trial, 0 to 1.
fn way(centre_y_m: f32, steps: u32, stairs: &Stairs, start_y_m: f32) -> f32 {
    let goal_y_m = stairs.landing_y_m();
    let most_y_m = if steps > 0 { goal_y_m } else { stairs.first_riser_y_m };
    let share = (centre_y_m.min(most_y_m) - start_y_m) / (goal_y_m - start_y_m);
    // A start at or beyond the landing leaves no distance, and the share is 0.
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
}

/// Maximum number of conditions of a suite in a file.
const MOST_CONDITIONS: usize = 100;

impl SuiteResult {
    /// Checks every value that was read from a file.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("trials", self.trials, 1..=1_000_000)?;
        within("landed", self.landed, 0..=self.trials)?;
        within("disqualified", self.disqualified, 0..=self.trials)?;
        within("median_steps", self.median_steps, 0.0..=1000.0)?;
        within("kept", self.kept, 0.0..=1.0e6)?;
        within("number of conditions", self.each.len(), 0..=MOST_CONDITIONS)?;
        for (label, kept) in &self.each {
            if label.is_empty() || label.chars().count() > 40 || label.contains(char::is_control) {
                let allowed = "1 to 40 characters without control characters";
                return Err(Invalid::new("condition", quoted(label), allowed));
            }
            within("kept", *kept, 0.0..=1.0e6)?;
        }
        self.endings.check(self.trials).map_err(|error| error.inside("endings"))
    }

    /// Computes the result of a suite. `own` is the end of the champion's own trial, undisturbed and as long as the suite's trials; `ends`
    /// are the ends in the suite's conditions.
    ///
    /// In the suite with the other engine, `ends` has the starts in the champion's own engine, followed by the same starts in the other
    /// engine. Counts and the median of steps are those of the other engine. `kept` is the median, over the starts, of the distance in the
    /// other engine as a share of the distance in the own engine. Starts without a distance in the own engine do not count.
    pub fn of(
        suite: ExamSuite,
        own: &ExamEnd,
        conditions: &[ExamCondition],
        ends: &[ExamEnd],
    ) -> Self {
        let landed = |end: &&ExamEnd| match suite {
            // In the long trial, some snakes walk off the landing again, so landing in time counts instead of the end.
            ExamSuite::Shove => {
                let latest_s = own.landed_s.map(|landed_s| landed_s + suites::RECOVERY_S);
                let in_time = |(landed_s, latest_s)| landed_s <= latest_s;
                !end.is_disqualified && end.landed_s.zip(latest_s).is_some_and(in_time)
            }
            ExamSuite::HeldOut => !end.is_disqualified && end.arrived_s.is_some(),
            _ => end.has_landed,
        };
        let own_trials = if suite == ExamSuite::Engine { ends.len() / 2 } else { 0 };
        let (in_own_engine, ends) = ends.split_at(own_trials);
        let share = |end: &ExamEnd| if own.way > 0.0 { end.way / own.way } else { 0.0 };
        let each = match suite {
            ExamSuite::StepRate => {
                let labels = conditions.iter().map(|condition| condition.label.clone());
                labels.zip(ends.iter().map(share)).collect()
            }
            ExamSuite::HeldOut => {
                // The conditions of each class are consecutive.
                let each = ends.chunks(HELD_OUT_PER_CLASS as usize);
                let share =
                    |of: &[ExamEnd]| of.iter().filter(landed).count() as f32 / of.len() as f32;
                let names = StairsClass::names().into_iter().map(str::to_owned);
                names.zip(each.map(share)).collect()
            }
            _ => Vec::new(),
        };
        let shares = ends.iter().map(share);
        let kept = match suite {
            ExamSuite::StepRate => shares.fold(f32::MAX, f32::min),
            ExamSuite::Engine => {
                let starts = in_own_engine.iter().zip(ends).filter(|(own, _)| own.way > 0.0);
                median(starts.map(|(own, other)| other.way / own.way).collect())
            }
            _ => median(shares.collect()),
        };
        Self {
            suite,
            trials: ends.len() as u32,
            landed: ends.iter().filter(landed).count() as u32,
            disqualified: ends.iter().filter(|end| end.is_disqualified).count() as u32,
            median_steps: median(ends.iter().map(|end| end.steps as f32).collect()),
            kept,
            each,
            endings: Endings::of(ends.iter().map(|end| &end.ending)),
        }
    }

    /// Returns the classes of the held-out stairs, each with the number of staircases on which the champion landed and the number of all
    /// its staircases; empty for other suites.
    pub fn classes(&self) -> Vec<(&str, u32, u32)> {
        if self.suite != ExamSuite::HeldOut {
            return Vec::new();
        }
        let landed = |share: f32| (share * HELD_OUT_PER_CLASS as f32).round() as u32;
        let classes = self.each.iter();
        classes.map(|(name, share)| (name.as_str(), landed(*share), HELD_OUT_PER_CLASS)).collect()
    }
}

#[cfg(test)]
mod tests;
