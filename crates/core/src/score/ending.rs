//! How a trial ended: one classification for the trials of all engines, from the places and the contacts of the limbs.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::schema::{Choices, choices};
use crate::world::{BodyPlan, Disqualification, Pose, Stairs};

choices! {
    /// A way in which a trial can end. Steps and places are those of the middle block.
    #[derive(PartialOrd, Ord)]
    pub enum EndingKind {
        Landed = "landed", "landed", "It is on the landing.";
        OffTheSide = "off-the-side", "fell off the side", "It left the stairs over an edge and did not come back; the step is the one that it left.";
        FellBack = "fell-back", "fell back",
            "It had climbed higher, but fell and did not get back up. The step is the one on which it ended, 0 on the ground before the stairs.";
        Stuck = "stuck", "stuck at a riser", "It got no further for the last three seconds, and its foremost block is at the riser with this number.";
        Beside = "beside", "passed the stairs", "It is beside the stairs, on which it never was.";
        LeftTheGround = "left-the-ground", "left the ground", "It has been in the air for longer than a fall from the highest step takes.";
        OutOfTime = "out-of-time", "out of time", "The time ended while it was still on its way.";
        Disqualified = "disqualified", "disqualified", "It broke a limit of the trial, so its result does not count.";
    }
}

choices! {
    /// A way to get ahead without climbing. A trial with any of them has an ending, too.
    #[derive(PartialOrd, Ord)]
    pub enum Trick {
        LeaptOver = "leapt-over", "leapt over steps", "No block touched more than half of the steps up to its highest one.";
        WentAround = "went-around", "went around", "It got at least two treads further beside the stairs than on them.";
        Flung = "flung", "was flung", "A single flight carried it up more than a third of the steps, and at least three.";
    }
}

/// How a trial ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ending {
    /// How it ended.
    pub kind: EndingKind,
    /// The step or the riser that the sentence of the kind names; otherwise the step on which the snake ended.
    pub step: u32,
    /// Time at which the trial was decided, in s: when the snake left the stairs, was at its highest, made its last progress or last touched
    /// the ground. For the other kinds, the end.
    pub at_s: f32,
    /// Reason of a disqualification.
    pub reason: Option<Disqualification>,
    /// Whether the snake used each of [`Trick::OPTIONS`](Choices::OPTIONS).
    pub tricks: [bool; Trick::OPTIONS.len()],
}

impl Ending {
    /// The end of a trial whose simulation failed.
    pub const CRASHED: Self = Self {
        kind: EndingKind::Disqualified,
        step: 0,
        at_s: 0.0,
        reason: Some(Disqualification::Crashed),
        tricks: [false; 3],
    };

    /// Checks the values that another machine has sent.
    ///
    /// # Errors
    /// Returns an error for a step that no stairs have, or a time that no trial has.
    pub fn check(&self) -> Result<(), Invalid> {
        within("step", self.step, 0..=1000)?;
        within("at_s", self.at_s, 0.0..=1.0e4)
    }

    /// Describes the ending in words, such as "fell off the side from step 4, was flung".
    pub fn words(&self) -> String {
        let Self { kind, step, reason, .. } = self;
        let title = kind.choice().title;
        let ending = match (kind, reason) {
            (EndingKind::OffTheSide, _) => format!("{title} from step {step}"),
            (EndingKind::FellBack, _) if *step == 0 => format!("{title} to the ground"),
            (EndingKind::FellBack, _) => format!("{title} to step {step}"),
            (EndingKind::Stuck, _) => format!("stuck with its front at riser {step}"),
            (EndingKind::OutOfTime, _) if *step > 0 => format!("{title} on step {step}"),
            (_, Some(reason)) => format!("{title}: {}", reason.words()),
            _ => title.to_owned(),
        };
        self.used().fold(ending, |words, trick| words + ", " + trick.choice().title)
    }

    /// Returns the tricks that the snake used.
    pub fn used(&self) -> impl Iterator<Item = Trick> {
        let all = Trick::OPTIONS.iter().zip(self.tricks);
        all.filter(|(_, used)| *used).map(|(trick, _)| *trick)
    }
}

/// Time for which a higher step counts although the snake is lower now, in s: a block on an edge rocks.
const ROCKS_S: f32 = 1.0;
/// Time without progress after which a snake is stuck, in s.
const STUCK_S: f32 = 3.0;
/// Least distance that counts as progress, in m.
const PROGRESS_M: f32 = 0.25;
/// Greatest distance between a block and the riser at which it is, in m.
const AT_RISER_M: f32 = 0.5;
/// Length that a snake may rise above the highest step in a leap, in m.
const LEAP_M: f32 = 2.0;

/// Returns the time of a fall from [`LEAP_M`] above the highest step, in s.
fn fall_s(stairs: &Stairs, gravity_m_s2: f32) -> f32 {
    (2.0 * (stairs.highest_m() + LEAP_M) / gravity_m_s2.max(0.01)).sqrt()
}

/// Watches a trial from its start, to say how it ended.
#[derive(Debug, Clone)]
pub(super) struct Watch {
    stairs: Stairs,
    middle_part: usize,
    half_lengths_m: Vec<f32>,
    /// Time that a fall from the highest step takes, in s.
    fall_s: f32,
    now_s: f32,
    /// Steps under the middle part now, and most of all times.
    steps: u32,
    most_steps: u32,
    most_steps_s: f32,
    /// Number of steps under the middle part when it was last on the stairs, the time, and, once it has left them, whether it did so over an
    /// edge.
    left: Option<(u32, f32, Option<bool>)>,
    is_beside: bool,
    /// Greatest y of the middle part on or before the stairs, and beside them, in m.
    furthest_m: f32,
    furthest_beside_m: f32,
    /// y and time of the last progress.
    progress: [f32; 2],
    /// Time and number of steps when the snake last touched ground or stairs.
    touched_s: f32,
    touched_steps: u32,
    /// Steps under the middle part when the watch began; `None` before.
    first_steps: Option<u32>,
    /// Most steps that one flight led up.
    highest_flight: u32,
    touched: Vec<bool>,
}

impl Watch {
    /// Prepares to watch a snake with this body.
    pub fn new(body: &BodyPlan, stairs: &Stairs, gravity_m_s2: f32) -> Self {
        Self {
            middle_part: body.middle_part,
            half_lengths_m: body.parts.iter().map(|part| part.length_m / 2.0).collect(),
            fall_s: fall_s(stairs, gravity_m_s2),
            touched: vec![false; stairs.steps as usize],
            stairs: stairs.clone(),
            now_s: 0.0,
            steps: 0,
            most_steps: 0,
            most_steps_s: 0.0,
            left: None,
            is_beside: false,
            furthest_m: f32::MIN,
            furthest_beside_m: f32::MIN,
            progress: [f32::MIN, 0.0],
            touched_s: 0.0,
            touched_steps: 0,
            first_steps: None,
            highest_flight: 0,
        }
    }

    /// Goes on under another gravity, in m/s².
    pub fn take_gravity(&mut self, gravity_m_s2: f32) {
        self.fall_s = fall_s(&self.stairs, gravity_m_s2);
    }

    /// Takes in the poses of all parts at a time, in s. `on_stairs` are the parts that touch the stairs (or the ground, if nothing else
    /// is known), and `flies` tells whether no part touches either.
    pub fn observe(
        &mut self,
        now_s: f32,
        poses: &[Pose],
        on_stairs: impl Iterator<Item = usize>,
        flies: bool,
    ) {
        let Some(middle_m) = poses.get(self.middle_part).map(|pose| pose.translation) else {
            return;
        };
        let stairs = &self.stairs;
        self.now_s = now_s;
        self.steps = stairs.steps_under(middle_m.to_array());
        self.is_beside = stairs.steps > 0 && self.steps == 0 && middle_m.y > stairs.first_riser_y_m;
        if self.first_steps.is_none() {
            (self.first_steps, self.touched_steps) = (Some(self.steps), self.steps);
        }
        if self.steps > 0 {
            self.left = Some((self.steps, now_s, None));
        } else if let Some((.., over_an_edge)) = &mut self.left {
            over_an_edge.get_or_insert(self.is_beside);
        }
        if self.steps >= self.most_steps {
            (self.most_steps, self.most_steps_s) = (self.steps, now_s);
        }
        let furthest_m =
            if self.is_beside { &mut self.furthest_beside_m } else { &mut self.furthest_m };
        *furthest_m = furthest_m.max(middle_m.y);
        if middle_m.y > self.progress[0] + PROGRESS_M {
            self.progress = [middle_m.y, now_s];
        }
        for part in on_stairs {
            let steps =
                poses.get(part).map_or(0, |pose| stairs.steps_under(pose.translation.to_array()));
            let tread =
                (steps as usize).checked_sub(1).and_then(|tread| self.touched.get_mut(tread));
            tread.into_iter().for_each(|touched| *touched = true);
        }
        if !flies {
            self.highest_flight = self.flight();
            (self.touched_s, self.touched_steps) = (now_s, self.steps);
        }
    }

    /// Returns the most steps that one flight has led up, with the one that may still go on.
    fn flight(&self) -> u32 {
        self.highest_flight.max(self.steps.saturating_sub(self.touched_steps))
    }

    /// Returns the number of steps that a part has touched.
    pub fn touched(&self) -> u32 {
        self.touched.iter().filter(|touched| **touched).count() as u32
    }

    /// Returns the distance between the foremost part and the next riser, in m, and the number of that riser; `None` on the landing.
    fn next_riser(&self, poses: &[Pose]) -> Option<(f32, u32)> {
        let parts = poses.iter().zip(&self.half_lengths_m);
        let foremost = parts.max_by(|(a, _), (b, _)| a.translation.y.total_cmp(&b.translation.y));
        let (pose, half_m) = foremost?;
        let number = self.stairs.steps_climbed(f64::from(pose.translation.y));
        let gap_m = self.stairs.riser_y_m(number) - pose.translation.y - half_m;
        (number < self.stairs.steps).then_some((gap_m, number + 1))
    }

    /// Returns how the trial ended, if it ends now with the parts in these poses.
    pub fn ending(&self, disqualified: Option<Disqualification>, poses: &[Pose]) -> Ending {
        let on_all = self.stairs.steps > 0 && self.steps == self.stairs.steps;
        let (steps, now_s) = (self.steps, self.now_s);
        let (kind, step, at_s) = match self.left.filter(|_| steps == 0) {
            _ if disqualified.is_some() => (EndingKind::Disqualified, steps, now_s),
            _ if on_all => (EndingKind::Landed, steps, now_s),
            _ if now_s - self.touched_s > self.fall_s => {
                (EndingKind::LeftTheGround, steps, self.touched_s)
            }
            Some((from, left_s, Some(true))) => (EndingKind::OffTheSide, from, left_s),
            Some((_, left_s, _)) => (EndingKind::FellBack, 0, left_s),
            None if self.is_beside => (EndingKind::Beside, 0, now_s),
            None if now_s - self.most_steps_s > ROCKS_S => {
                (EndingKind::FellBack, steps, self.most_steps_s)
            }
            None => match self.next_riser(poses) {
                Some((gap_m, riser))
                    if gap_m <= AT_RISER_M && now_s - self.progress[1] > STUCK_S =>
                {
                    (EndingKind::Stuck, riser, self.progress[1])
                }
                _ => (EndingKind::OutOfTime, steps, now_s),
            },
        };
        Ending { kind, step, at_s, reason: disqualified, tricks: self.tricks() }
    }

    fn tricks(&self) -> [bool; 3] {
        let stairs = &self.stairs;
        let first = self.first_steps.unwrap_or(0);
        let climbed = self.most_steps.saturating_sub(first);
        let passed = self.touched.iter().skip(first as usize).take(climbed as usize);
        let leapt = passed.filter(|touched| !**touched).count() as u32;
        let on_stairs_m = self.furthest_m.max(stairs.first_riser_y_m);
        let ahead = stairs.way_steps(self.furthest_beside_m) - stairs.way_steps(on_stairs_m);
        let least_flight = (stairs.steps / 3 + 1).max(3);
        [2 * leapt > climbed, stairs.steps > 0 && ahead >= 2.0, self.flight() >= least_flight]
    }
}

/// Maximum number of counts in a file: one for each way, and for each reason of a disqualification.
const MOST_ENDINGS: usize = 20;

/// Number of trials that ended in the same way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EndingCount {
    /// How they ended.
    pub kind: EndingKind,
    /// Reason of the disqualifications.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<Disqualification>,
    /// Number of trials.
    pub trials: u32,
    /// Median of the steps or risers that [`Ending::step`] names.
    pub step: f32,
}

/// How many of several trials ended in which way.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Endings {
    /// A count for each way in which at least one trial ended.
    pub counts: Vec<EndingCount>,
    /// Number of trials that used each of [`Trick::OPTIONS`](Choices::OPTIONS).
    pub tricks: [u32; Trick::OPTIONS.len()],
}

impl Endings {
    /// Counts the ways in which trials ended.
    pub fn of<'e>(endings: impl Iterator<Item = &'e Ending> + Clone) -> Self {
        let mut ways: Vec<_> = endings.clone().map(|ending| (ending.kind, ending.reason)).collect();
        ways.sort_unstable();
        ways.dedup();
        let count = |(kind, reason)| {
            let alike = endings.clone().filter(|of| (of.kind, of.reason) == (kind, reason));
            let steps: Vec<f32> = alike.map(|ending| ending.step as f32).collect();
            EndingCount { kind, reason, trials: steps.len() as u32, step: median(steps) }
        };
        let tricks = std::array::from_fn(|trick| {
            endings.clone().filter(|ending| ending.tricks[trick]).count() as u32
        });
        Self { counts: ways.into_iter().map(count).collect(), tricks }
    }

    /// Returns the number of trials that ended in a way.
    pub fn count(&self, kind: EndingKind) -> u32 {
        let alike = self.counts.iter().filter(|count| count.kind == kind);
        alike.map(|count| count.trials).sum()
    }

    /// Returns whether nothing was counted, as in records of earlier versions.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// Checks every value that was read from a file, for this number of trials.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self, trials: u32) -> Result<(), Invalid> {
        within("number of endings", self.counts.len(), 0..=MOST_ENDINGS)?;
        for count in &self.counts {
            within("trials", count.trials, 0..=trials)?;
            within("step", count.step, 0.0..=1000.0)?;
        }
        self.tricks.iter().try_for_each(|used| within("tricks", *used, 0..=trials))
    }
}

/// Returns the median; for an even number of values, the mean of the two middle ones; 0 without values.
pub fn median(mut values: Vec<f32>) -> f32 {
    values.sort_by(f32::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    (values[last / 2] + values[values.len() / 2]) / 2.0
}

#[cfg(test)]
mod tests;
