//! What who is on the stage, or else the best, does with its joints, and what its parent did: the torques before and
//! after the mutation, as in the report's Figure 4, but for every joint.

use std::sync::Arc;

use super::Version;
use super::view::{Hit, Target, View};
use crate::evolve::Place;
use crate::genome::{Controller, Genome, Signals};
use crate::plot::{Axis, Chart, Figure, Role, Series, Shape};
use crate::run::Lookahead;
use crate::score::{History, Trial};
use crate::studio::evolution::Evolution;
use crate::studio::panels::axes::around;

/// More points of a line nobody could tell apart.
const MOST_POINTS: usize = 600;

/// Torques about both axes of a joint: moments and N·m.
#[derive(Debug, Clone, PartialEq, Default)]
struct Lines {
    bend: Vec<[f64; 2]>,
    twist: Vec<[f64; 2]>,
}

/// A snake whose torques are shown, or on their way.
struct Subject {
    place: Place,
    genome: Arc<Genome>,
    /// None where the genes themselves are the torques.
    coming: Option<Lookahead>,
    lines: Option<Vec<Lines>>,
}

/// Somebody and its parent, with what is known of their torques.
#[derive(Default)]
pub(super) struct Torques {
    child: Option<Subject>,
    parent: Option<Subject>,
    view: Option<View>,
    /// The state of the run, and who was on the stage, when they were taken in.
    followed: Option<(Version, Option<Place>)>,
}

impl Torques {
    /// Takes somebody of a run and its parent in: who is on the stage, or else the best. Says what is missing.
    pub fn follow(&mut self, run: &Evolution, shown: Option<Place>) -> Result<(), &'static str> {
        // Whoever it was is looked for once, not in every frame.
        let what = Some((run.version(), shown));
        if self.followed != what {
            self.followed = what;
            let best = run.exploration().and_then(|exploration| exploration.descent.line.first());
            let of_run = |place: Place| Some((place, run.genome_of(place)?));
            let child = shown.filter(|shown| run.parents_of(*shown).is_some()).and_then(of_run);
            let child = child.or_else(|| of_run(best?.place));
            let parent = child.as_ref().and_then(|(place, genome)| parent(run, *place, genome));
            let trial = &run.settings().trial;
            let is_new =
                renew(&mut self.child, child, trial) | renew(&mut self.parent, parent, trial);
            if is_new {
                self.view = None;
            }
        }
        match &self.child {
            Some(_) => Ok(()),
            None => Err("The torques of the best, and of its parent, will appear here."),
        }
    }

    /// The charts, once the torques are known.
    pub fn view(&mut self, trial: &Trial) -> Option<&View> {
        if self.view.is_none() {
            let subjects = [self.child.as_mut(), self.parent.as_mut()];
            let are_there = subjects.into_iter().flatten().all(|subject| subject.is_there(trial));
            if are_there {
                self.view =
                    self.child.as_ref().map(|child| figure(child, self.parent.as_ref(), trial));
            }
        }
        self.view.as_ref()
    }
}

/// The parent of somebody. Who goes on unchanged is its own parent: whoever it was changed from comes before it.
fn parent(run: &Evolution, of: Place, genome: &Genome) -> Option<(Place, Arc<Genome>)> {
    let mut place = of;
    loop {
        // Parents are of earlier generations: this ends.
        place = run.parents_of(place)?.places().next()?;
        let parent = run.genome_of(place)?;
        // The same genes are often the same piece of memory: that is seen at once.
        if !std::ptr::eq(&*parent, genome) && *parent != *genome {
            return Some((place, parent));
        }
    }
}

/// Puts somebody else in a subject's place, if it is somebody else. Says whether it was.
fn renew(subject: &mut Option<Subject>, by: Option<(Place, Arc<Genome>)>, trial: &Trial) -> bool {
    let place = |subject: &Option<Subject>| subject.as_ref().map(|subject| subject.place);
    let is_same = place(subject) == by.as_ref().map(|(place, _)| *place)
        && subject.as_ref().map(|of| &of.genome) == by.as_ref().map(|(_, genome)| genome);
    if is_same {
        return false;
    }
    *subject = by.map(|(place, genome)| {
        let lines = match &genome.controller {
            Controller::Signal(signals) => Some(of_signals(signals, trial.duration_s)),
            Controller::Wave(_) | Controller::Gait(_) => None,
        };
        let coming = lines.is_none().then(|| Lookahead::begin(&genome, trial));
        Subject { place, genome, coming, lines }
    });
    true
}

impl Subject {
    /// Whether its torques are known by now.
    fn is_there(&mut self, trial: &Trial) -> bool {
        if let Some(coming) = &mut self.coming {
            coming.poll();
            if coming.steps_done().is_some() {
                return false;
            }
            self.lines = coming.history().map(|history| of_history(history, trial));
            // It holds whole worlds.
            self.coming = None;
        }
        true
    }
}

/// The torques that a signal's points are: each holds until the next.
fn of_signals(signals: &Signals, duration_s: f32) -> Vec<Lines> {
    let seconds =
        |point: usize| (point as f64 / f64::from(signals.points_per_s)).min(f64::from(duration_s));
    let held = |torques: &[f32]| {
        let ends = |(index, &torque): (usize, &f32)| {
            [index, index + 1].map(|end| [seconds(end), f64::from(torque)])
        };
        torques.iter().enumerate().flat_map(ends).collect()
    };
    let of_joint = |joint: &crate::genome::JointSignals| Lines {
        bend: held(&joint.bend_nm),
        twist: held(&joint.twist_nm),
    };
    signals.joints.iter().map(of_joint).collect()
}

/// The torques that acted in a rollout.
fn of_history(history: &History, trial: &Trial) -> Vec<Lines> {
    let count = history.torques().len();
    let every = count.div_ceil(MOST_POINTS).max(1);
    let step_s = f64::from(trial.duration_s) / f64::from(trial.steps().max(1));
    let sample_s = step_s * f64::from(history.sample_steps());
    let mut joints: Vec<Lines> = Vec::new();
    for (index, torques) in history.torques().enumerate().step_by(every) {
        joints.resize(torques.len().max(joints.len()), Lines::default());
        let time_s = index as f64 * sample_s;
        for (lines, torque) in joints.iter_mut().zip(torques) {
            lines.bend.push([time_s, f64::from(torque.bend_nm)]);
            lines.twist.push([time_s, f64::from(torque.twist_nm)]);
        }
    }
    joints
}

/// A chart for each joint: the child's torques in lines, the parent's in dashes.
fn figure(child: &Subject, parent: Option<&Subject>, trial: &Trial) -> View {
    let lines = |subject: &Subject| subject.lines.clone().unwrap_or_default();
    let (of_child, of_parent) = (lines(child), parent.map(lines).unwrap_or_default());
    let all = of_child.iter().chain(&of_parent).flat_map(|of| of.bend.iter().chain(&of.twist));
    // All charts reach as far, so that joints can be compared.
    let y = around(all.map(|point| point[1]).chain([-1.0, 1.0]), 2.0).unwrap_or(-1.0..=1.0);
    let chart = |(index, lines): (usize, &Lines)| {
        let before = of_parent.get(index);
        let dashed =
            |points: Option<&Vec<[f64; 2]>>| Shape::Dashed(points.cloned().unwrap_or_default());
        let series = [
            ("parent's bend", Role::Bend, dashed(before.map(|of| &of.bend))),
            ("parent's twist", Role::Twist, dashed(before.map(|of| &of.twist))),
            ("bend", Role::Bend, Shape::Line(lines.bend.clone())),
            ("twist", Role::Twist, Shape::Line(lines.twist.clone())),
        ];
        let is_there = |series: &&(&str, Role, Shape)| !matches!(&series.2, Shape::Dashed(points) if points.is_empty());
        Chart {
            name: format!("Joint {}", index + 1),
            x: Axis::new("Time", "s", 0.0..=f64::from(trial.duration_s)),
            y: Axis::new("Torque", "N·m", y.clone()),
            series: series
                .iter()
                .filter(is_there)
                .map(|(name, role, shape)| Series::new(name, *role, shape.clone()))
                .collect(),
            marks: Vec::new(),
        }
    };
    let charts: Vec<Chart> = of_child.iter().enumerate().map(chart).collect();
    let name =
        |place: Place| format!("snake {} of generation {}", place.individual + 1, place.generation);
    let note = match parent {
        Some(parent) => {
            format!("Lines: {}. Dashes: its parent, {}.", name(child.place), name(parent.place))
        }
        None => format!("Lines: {}. No parent of it is known.", name(child.place)),
    };
    let figure = Figure::of_several("Torques, child and parent", charts);
    let hits = of_child.iter().enumerate().map(|(index, lines)| hits(lines, of_parent.get(index)));
    let hits = hits.collect();
    View::new(Figure { note, ..figure }, hits)
}

/// What there is to read of a joint's torques, moment by moment.
fn hits(child: &Lines, parent: Option<&Lines>) -> Vec<Hit> {
    let moments = child.bend.iter().zip(&child.twist).enumerate();
    let hit = |(index, (bend, twist)): (usize, (&[f64; 2], &[f64; 2]))| {
        let before = parent.and_then(|of| of.bend.get(index).zip(of.twist.get(index)));
        // A parent whose rollout was sampled at other moments is not read out beside its child.
        let before = before.filter(|(before, _)| before[0] == bend[0]);
        let before = before.map(|(bend, twist)| [bend[1], twist[1]]);
        let [time_s, bend_nm, twist_nm] = [bend[0], bend[1], twist[1]];
        let words = move || {
            let before = before.map_or(String::new(), |[bend_nm, twist_nm]| {
                format!("\nparent's bend {bend_nm:.0} N·m, twist {twist_nm:.0} N·m")
            });
            format!("{time_s:.2} s\nbend {bend_nm:.0} N·m, twist {twist_nm:.0} N·m{before}")
        };
        Hit::new(Target::Column(*bend), words)
    };
    moments.map(hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::ControllerKind;
    use crate::rng::{Purpose, stream};

    fn subject(kind: ControllerKind, individual: u32, trial: &Trial) -> Option<Subject> {
        let space = crate::genome::GenomeSpace { controller: kind, ..Default::default() };
        let mut rng = stream(1, 1, individual, Purpose::Birth);
        let genome = space.birth(trial.descent(), &mut rng);
        let place = Place { generation: 1, individual };
        let mut subject = None;
        assert!(renew(&mut subject, Some((place, Arc::new(genome.clone()))), trial));
        assert!(!renew(&mut subject, Some((place, Arc::new(genome))), trial), "it is the same");
        subject
    }

    #[test]
    fn the_torques_of_a_signal_are_its_points_each_held_until_the_next() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let child = subject(ControllerKind::Signal, 0, &trial).expect("there");
        let parent = subject(ControllerKind::Signal, 1, &trial).expect("there");
        let Controller::Signal(signals) = &child.genome.controller else { panic!("a signal") };
        let view = figure(&child, Some(&parent), &trial);
        assert_eq!(view.figure.charts.len(), 4, "one for each joint");
        let chart = &view.figure.charts[2];
        let names: Vec<&str> = chart.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["parent's bend", "parent's twist", "bend", "twist"]);
        let Shape::Line(bend) = &chart.series[2].shape else { panic!("a line") };
        let torques = &signals.joints[2].bend_nm;
        assert_eq!(bend.len(), torques.len() * 2);
        assert_eq!((bend[2][1], bend[3][1]), (f64::from(torques[1]), f64::from(torques[1])));
        assert_eq!(bend[1][0], bend[2][0], "it jumps");
        let hit = &view.hits[2][2];
        let words = hit.words();
        assert!(words.contains(&format!("bend {:.0} N·m, twist", bend[2][1])), "{words}");
        assert!(words.contains("parent's bend"), "{words}");
    }

    #[test]
    fn the_torques_of_a_wave_are_those_of_its_rollout() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let mut torques =
            Torques { child: subject(ControllerKind::Wave, 0, &trial), ..Torques::default() };
        if let Some(coming) = torques.child.as_mut().and_then(|child| child.coming.as_mut()) {
            coming.wait();
        }
        let view = torques.view(&trial).expect("worked out");
        let chart = &view.figure.charts[0];
        let names: Vec<&str> = chart.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["bend", "twist"], "without a parent, no dashes");
        let Shape::Line(bend) = &chart.series[0].shape else { panic!("a line") };
        assert_eq!(bend.len(), trial.steps() as usize);
        assert!(bend.iter().any(|point| point[1].abs() > 1.0));
        assert!(view.figure.note.contains("No parent of it is known"), "{}", view.figure.note);
    }
}
