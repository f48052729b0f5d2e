//! Torques of the snake on the stage (or of the best one) and of its parent, for every joint, as in Figure 4 of the
//! original report.

use std::sync::Arc;

use super::view::{ChartHit, ChartView, HitShape, Version};
use crate::evolve::IndividualId;
use crate::genome::{Genome, JointCommands};
use crate::plot::{Axis, Chart, Figure, Role, Series, Shape};
use crate::run::Lookahead;
use crate::score::{KeyframeHistory, Trial};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::plot_axes::padded_range;

/// Maximum number of points that can be distinguished on a line.
const MAX_POINTS: usize = 600;

/// Torques about both axes of a joint: times in seconds and torques in N·m.
#[derive(Debug, Clone, PartialEq, Default)]
struct TorqueLines {
    bend: Vec<[f64; 2]>,
    twist: Vec<[f64; 2]>,
}

/// Snake whose torques are shown or being computed.
struct Subject {
    place: IndividualId,
    genome: Arc<Genome>,
    /// None if the genes are the torques.
    lookahead: Option<Lookahead>,
    lines: Option<Vec<TorqueLines>>,
}

/// A child and its parent, with their torques.
#[derive(Default)]
pub(super) struct TorqueComparison {
    child: Option<Subject>,
    parent: Option<Subject>,
    view: Option<ChartView>,
    /// Version of the run and individual on the stage at the last update.
    updated_for: Option<(Version, Option<IndividualId>)>,
}

impl TorqueComparison {
    /// Selects the snake on the stage (or the best one) and its parent. An error says what is missing.
    pub fn update(
        &mut self,
        run: &CurrentRun,
        shown: Option<IndividualId>,
    ) -> Result<(), &'static str> {
        // The search runs once per change instead of in every frame.
        let version = Some((run.version(), shown));
        if self.updated_for != version {
            self.updated_for = version;
            let best = run.exploration().and_then(|exploration| exploration.ancestry.line.first());
            let of_run = |place: IndividualId| Some((place, run.genome_of(place)?));
            let child = shown.filter(|shown| run.parents_of(*shown).is_some()).and_then(of_run);
            let child = child.or_else(|| of_run(best?.place));
            let parent = child.as_ref().and_then(|(place, genome)| parent(run, *place, genome));
            let trial = &run.settings().trial;
            let is_new = replace_subject(&mut self.child, child, trial)
                | replace_subject(&mut self.parent, parent, trial);
            if is_new {
                self.view = None;
            }
        }
        match &self.child {
            Some(_) => Ok(()),
            None => Err("The torques of the best snake and of its parent will appear here."),
        }
    }

    /// Charts, once the torques are known.
    pub fn view(&mut self, trial: &Trial) -> Option<&ChartView> {
        if self.view.is_none() {
            let subjects = [self.child.as_mut(), self.parent.as_mut()];
            let are_ready =
                subjects.into_iter().flatten().all(|subject| subject.has_torques(trial));
            if are_ready {
                self.view =
                    self.child.as_ref().map(|child| figure(child, self.parent.as_ref(), trial));
            }
        }
        self.view.as_ref()
    }
}

/// Nearest ancestor with other genes. An elite that survives unchanged is recorded as its own parent.
fn parent(
    run: &CurrentRun,
    of: IndividualId,
    genome: &Genome,
) -> Option<(IndividualId, Arc<Genome>)> {
    let mut place = of;
    loop {
        // Parents belong to earlier generations, so the loop ends.
        place = run.parents_of(place)?.ids().next()?;
        let parent = run.genome_of(place)?;
        // Unchanged genomes often share memory, which is quick to compare.
        if !std::ptr::eq(&*parent, genome) && *parent != *genome {
            return Some((place, parent));
        }
    }
}

/// Replaces a subject if it differs. Returns whether it did.
fn replace_subject(
    subject: &mut Option<Subject>,
    replacement: Option<(IndividualId, Arc<Genome>)>,
    trial: &Trial,
) -> bool {
    let place = |subject: &Option<Subject>| subject.as_ref().map(|subject| subject.place);
    let is_same = place(subject) == replacement.as_ref().map(|(place, _)| *place)
        && subject.as_ref().map(|of| &of.genome) == replacement.as_ref().map(|(_, genome)| genome);
    if is_same {
        return false;
    }
    *subject = replacement.map(|(place, genome)| {
        let duration_s = f64::from(trial.duration_s);
        let commands = genome.controller.commands(duration_s).filter(|commands| commands.is_held);
        let lines = commands.map(|commands| command_torques(&commands, duration_s));
        let lookahead = lines.is_none().then(|| Lookahead::begin(&genome, trial));
        Subject { place, genome, lookahead, lines }
    });
    true
}

impl Subject {
    /// Whether the torques are known.
    fn has_torques(&mut self, trial: &Trial) -> bool {
        if let Some(lookahead) = &mut self.lookahead {
            lookahead.poll();
            if lookahead.steps_done().is_some() {
                return false;
            }
            self.lines = lookahead.history().map(|history| history_torques(history, trial));
            // A lookahead holds whole simulations.
            self.lookahead = None;
        }
        true
    }
}

/// Torques that genes command, each held until the next.
fn command_torques(commands: &JointCommands, duration_s: f64) -> Vec<TorqueLines> {
    let held = |points: &[(f64, f64)]| {
        let next = points.iter().skip(1).map(|(time_s, _)| *time_s).chain([duration_s]);
        let ends = |(&(time_s, torque_nm), next_s): (&(f64, f64), f64)| {
            [time_s, next_s].map(|end_s| [end_s.min(duration_s), torque_nm])
        };
        points.iter().zip(next).flat_map(ends).collect()
    };
    let of_joint =
        |[bend, twist]: &[Vec<(f64, f64)>; 2]| TorqueLines { bend: held(bend), twist: held(twist) };
    commands.joints.iter().map(of_joint).collect()
}

/// Torques that acted in a rollout.
fn history_torques(history: &KeyframeHistory, trial: &Trial) -> Vec<TorqueLines> {
    let count = history.torques().len();
    let every = count.div_ceil(MAX_POINTS).max(1);
    let step_s = f64::from(trial.duration_s) / f64::from(trial.steps().max(1));
    let sample_s = step_s * f64::from(history.sample_steps());
    let mut joints: Vec<TorqueLines> = Vec::new();
    for (index, torques) in history.torques().enumerate().step_by(every) {
        joints.resize(torques.len().max(joints.len()), TorqueLines::default());
        let time_s = index as f64 * sample_s;
        for (lines, torque) in joints.iter_mut().zip(torques) {
            lines.bend.push([time_s, f64::from(torque.bend_nm)]);
            lines.twist.push([time_s, f64::from(torque.twist_nm)]);
        }
    }
    joints
}

/// Figure with one chart per joint: solid lines for the child, dashed lines for the parent.
fn figure(child: &Subject, parent: Option<&Subject>, trial: &Trial) -> ChartView {
    let lines = |subject: &Subject| subject.lines.clone().unwrap_or_default();
    let (of_child, of_parent) = (lines(child), parent.map(lines).unwrap_or_default());
    let all = of_child.iter().chain(&of_parent).flat_map(|of| of.bend.iter().chain(&of.twist));
    // All charts share a range, so that joints can be compared.
    let y = padded_range(all.map(|point| point[1]).chain([-1.0, 1.0]), 2.0).unwrap_or(-1.0..=1.0);
    let chart = |(index, lines): (usize, &TorqueLines)| {
        let before = of_parent.get(index);
        let dashed =
            |points: Option<&Vec<[f64; 2]>>| Shape::Dashed(points.cloned().unwrap_or_default());
        let series = [
            ("parent's bend", Role::Bend, dashed(before.map(|of| &of.bend))),
            ("parent's twist", Role::Twist, dashed(before.map(|of| &of.twist))),
            ("bend", Role::Bend, Shape::Line(lines.bend.clone())),
            ("twist", Role::Twist, Shape::Line(lines.twist.clone())),
        ];
        let has_points = |series: &&(&str, Role, Shape)| !matches!(&series.2, Shape::Dashed(points) if points.is_empty());
        Chart {
            name: format!("Joint {}", index + 1),
            x: Axis::new("Time", "s", 0.0..=f64::from(trial.duration_s)),
            y: Axis::new("Torque", "N·m", y.clone()),
            series: series
                .iter()
                .filter(has_points)
                .map(|(name, role, shape)| Series::new(name, *role, shape.clone()))
                .collect(),
            marks: Vec::new(),
        }
    };
    let charts: Vec<Chart> = of_child.iter().enumerate().map(chart).collect();
    let name = |place: IndividualId| {
        format!("snake {} of generation {}", place.individual + 1, place.generation)
    };
    let note = match parent {
        Some(parent) => {
            format!(
                "Solid lines: {}. Dashed lines: its parent, {}.",
                name(child.place),
                name(parent.place)
            )
        }
        None => format!("Solid lines: {}. Its parent is unknown.", name(child.place)),
    };
    let figure = Figure::of_several("Torques, child and parent", charts);
    let hits = of_child.iter().enumerate().map(|(index, lines)| hits(lines, of_parent.get(index)));
    let hits = hits.collect();
    ChartView::new(Figure { note, ..figure }, hits)
}

/// Hover texts of a joint's torques over time.
fn hits(child: &TorqueLines, parent: Option<&TorqueLines>) -> Vec<ChartHit> {
    let moments = child.bend.iter().zip(&child.twist).enumerate();
    let hit = |(index, (bend, twist)): (usize, (&[f64; 2], &[f64; 2]))| {
        let before = parent.and_then(|of| of.bend.get(index).zip(of.twist.get(index)));
        // The parent's torques are omitted if its rollout was sampled at other times.
        let before = before.filter(|(before, _)| before[0] == bend[0]);
        let before = before.map(|(bend, twist)| [bend[1], twist[1]]);
        let [time_s, bend_nm, twist_nm] = [bend[0], bend[1], twist[1]];
        let words = move || {
            let before = before.map_or(String::new(), |[bend_nm, twist_nm]| {
                format!("\nparent's bend {bend_nm:.0} N·m, twist {twist_nm:.0} N·m")
            });
            format!("{time_s:.2} s\nbend {bend_nm:.0} N·m, twist {twist_nm:.0} N·m{before}")
        };
        ChartHit::new(HitShape::Column(*bend), words)
    };
    moments.map(hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::rng::{Purpose, stream};

    fn subject(kind: ControllerKind, individual: u32, trial: &Trial) -> Option<Subject> {
        let space = crate::genome::GenomeSpace { controller: kind, ..Default::default() };
        let mut rng = stream(1, 1, individual, Purpose::Birth);
        let genome = space.random_genome(trial.genome_shape(), &mut rng);
        let place = IndividualId { generation: 1, individual };
        let mut subject = None;
        assert!(replace_subject(&mut subject, Some((place, Arc::new(genome.clone()))), trial));
        assert!(
            !replace_subject(&mut subject, Some((place, Arc::new(genome))), trial),
            "it is the same"
        );
        subject
    }

    #[test]
    fn signal_torques_hold_until_the_next_point() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let child = subject(ControllerKind::Signal, 0, &trial).expect("there");
        let parent = subject(ControllerKind::Signal, 1, &trial).expect("there");
        let ControllerGenes::Signal(signals) = &child.genome.controller else { panic!("a signal") };
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
    fn wave_torques_come_from_the_rollout() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let mut torques = TorqueComparison {
            child: subject(ControllerKind::Wave, 0, &trial),
            ..TorqueComparison::default()
        };
        if let Some(lookahead) = torques.child.as_mut().and_then(|child| child.lookahead.as_mut()) {
            lookahead.wait();
        }
        let view = torques.view(&trial).expect("worked out");
        let chart = &view.figure.charts[0];
        let names: Vec<&str> = chart.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["bend", "twist"], "without a parent, no dashes");
        let Shape::Line(bend) = &chart.series[0].shape else { panic!("a line") };
        assert_eq!(bend.len(), trial.steps() as usize);
        assert!(bend.iter().any(|point| point[1].abs() > 1.0));
        assert!(view.figure.note.contains("Its parent is unknown"), "{}", view.figure.note);
    }
}
