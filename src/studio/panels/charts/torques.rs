//! Charts of the joint torques of the selected snake on the stage and of its parent, as in Figure 4 of the original
//! report.

use std::sync::Arc;

use super::view::{ChartHit, ChartView, HitShape, Version, snake_of_generation};
use crate::studio::panels::shown::place_of;
use crate::studio::stage::staged_champion::{ChampionSource, StagedChampion};
use crate::studio::state::current_run::CurrentRun;
use snakes_core::genome::{Genome, JointCommands};
use snakes_core::score::{KeyframeHistory, Rollout, Trial};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape};
use snakes_lab::run::Lookahead;

/// Maximum number of points on a line that can be distinguished.
const MAX_POINTS: usize = 600;

/// Torques of a joint, about the bend axis and about the twist axis: points of time in seconds and torque in N·m.
type TorqueLines = [Vec<[f64; 2]>; 2];

/// A snake whose torques are shown or being computed.
struct Subject {
    name: String,
    genome: Arc<Genome>,
    trial: Trial,
    /// Simulation that computes the torques; `None` if the genes contain the torques.
    lookahead: Option<Lookahead>,
    lines: Option<Vec<TorqueLines>>,
    is_of_run: bool,
}

/// The selected snake as child, and its parent, with their torques.
#[derive(Default)]
pub(super) struct TorqueComparison {
    child: Option<Subject>,
    parent: Option<Subject>,
    view: Option<ChartView>,
    /// Version of the run and selected snake at the last update.
    updated_for: Option<(Version, Option<StagedChampion>)>,
}

impl TorqueComparison {
    /// Sets the child to the selected snake of the stage, and finds its parent. The error is a message about what is missing.
    pub fn update(
        &mut self,
        run: &CurrentRun,
        selected: Option<&StagedChampion>,
    ) -> Result<(), &'static str> {
        // The search is repeated only after a change instead of in every frame.
        let version = run.version();
        let known = self.updated_for.as_ref();
        let of_version = known.is_some_and(|(known, _)| *known == version);
        let of_selected = known.is_some_and(|(_, known)| known.as_ref() == selected);
        if !of_selected {
            let simulated = selected.filter(|staged| staged.recording().is_none());
            self.child = simulated.map(|staged| Subject::staged(staged, run.number));
            self.parent = None;
            self.view = None;
        }
        if !(of_version && of_selected) {
            self.updated_for = Some((version, selected.cloned()));
            // The parent is replaced if it is another individual, or is not kept any more.
            let child = selected.filter(|_| self.child.is_some());
            let found = child.and_then(|child| parent(run, child)).zip(child);
            let known = self.parent.as_ref().map(|known| (&known.name, &known.genome));
            let is_same = known == found.as_ref().map(|((name, genome), _)| (name, genome));
            if !is_same {
                self.view = None;
                self.parent = found.map(|((name, genome), child)| {
                    let trial = &child.champion().trial;
                    Subject::new(name, genome, trial, |genome| Rollout::new(genome, trial))
                });
            }
        }
        match (&self.child, selected) {
            (Some(_), _) => Ok(()),
            (None, Some(_)) => Err("A recording contains poses, but no torques."),
            (None, None) => {
                Err("The torques of the snake on the stage and of its parent will appear here.")
            }
        }
    }

    /// Returns the charts; `None` until the torques are known.
    pub fn view(&mut self) -> Option<&ChartView> {
        if self.view.is_none() {
            let subjects = [self.child.as_mut(), self.parent.as_mut()];
            if subjects.into_iter().flatten().all(Subject::has_torques) {
                self.view = self.child.as_ref().map(|child| figure(child, self.parent.as_ref()));
            }
        }
        self.view.as_ref()
    }
}

/// Returns the name and the genome of the nearest ancestor with different genes. An elite that survives unchanged is
/// recorded as its own parent.
fn parent(run: &CurrentRun, of: &StagedChampion) -> Option<(String, Arc<Genome>)> {
    let mut place = place_of(of.champion());
    if of.source() != ChampionSource::Run(run.number) {
        return None;
    }
    loop {
        // Parents are from earlier generations, so the loop ends.
        place = run.parents_of(place)?.ids().next()?;
        let genome = run.genome_of(place)?;
        if *genome != of.champion().genome {
            let own_world = if of.is_changed() { ", in its own world" } else { "" };
            return Some((format!("{}{own_world}", snake_of_generation(place)), genome));
        }
    }
}

impl Subject {
    /// Creates the subject for a snake on the stage, in the world in which it is shown. `run` is the number of the current run.
    fn staged(staged: &StagedChampion, run: u32) -> Self {
        let name = match staged.source() {
            ChampionSource::Run(_) => snake_of_generation(place_of(staged.champion())),
            _ => staged.name().to_owned(),
        };
        let beginning = staged.beginning_in_words().map_or(String::new(), |of| format!(", {of}"));
        let name = match staged.is_changed() {
            true => format!("{name} with {}{beginning}", staged.label()),
            false => name,
        };
        let genome = Arc::new(staged.champion().genome.clone());
        let is_of_run = staged.source() == ChampionSource::Run(run);
        Self { is_of_run, ..Self::new(name, genome, staged.trial(), |_| staged.rollout()) }
    }

    /// Creates the subject for a snake. The torques are those in its genes, or else those of a rollout.
    fn new(
        name: String,
        genome: Arc<Genome>,
        trial: &Trial,
        rollout: impl FnOnce(&Genome) -> Rollout,
    ) -> Self {
        let duration_s = f64::from(trial.duration_s);
        let commands = genome.controller.commands(duration_s).filter(|commands| commands.is_held);
        let lines = commands.map(|commands| command_torques(&commands, duration_s));
        let lookahead = lines.is_none().then(|| Lookahead::of(rollout(&genome)));
        Self { name, genome, trial: trial.clone(), lookahead, lines, is_of_run: true }
    }

    /// Returns whether the torques are known, after processing the results of the simulation.
    fn has_torques(&mut self) -> bool {
        if let Some(lookahead) = &mut self.lookahead {
            lookahead.poll();
            if lookahead.steps_done().is_some() {
                return false;
            }
            let trial = &self.trial;
            self.lines = lookahead.history().map(|history| history_torques(history, trial));
            // The lookahead holds whole simulations, so it is dropped.
            self.lookahead = None;
        }
        true
    }
}

/// Returns the torques in the genes, each held until the next.
fn command_torques(commands: &JointCommands, duration_s: f64) -> Vec<TorqueLines> {
    let held = |points: &[(f64, f64)]| {
        let next = points.iter().skip(1).map(|(time_s, _)| *time_s).chain([duration_s]);
        let ends = |(&(time_s, torque_nm), next_s): (&(f64, f64), f64)| {
            [time_s, next_s].map(|end_s| [end_s.min(duration_s), torque_nm])
        };
        points.iter().zip(next).flat_map(ends).collect()
    };
    commands.joints.iter().map(|axes| axes.each_ref().map(|points| held(points))).collect()
}

/// Returns the torques that acted in a rollout.
fn history_torques(history: &KeyframeHistory, trial: &Trial) -> Vec<TorqueLines> {
    let count = history.torques().len();
    let every = count.div_ceil(MAX_POINTS).max(1);
    let step_s = f64::from(trial.duration_s) / f64::from(trial.steps().max(1));
    let sample_s = step_s * f64::from(history.sample_steps());
    let mut joints: Vec<TorqueLines> = Vec::new();
    for (index, torques) in history.torques().enumerate().step_by(every) {
        joints.resize(torques.len().max(joints.len()), TorqueLines::default());
        let time_s = index as f64 * sample_s;
        for ([bend, twist], torque) in joints.iter_mut().zip(torques) {
            bend.push([time_s, f64::from(torque.bend_nm)]);
            twist.push([time_s, f64::from(torque.twist_nm)]);
        }
    }
    joints
}

/// Creates the figure with one chart per joint: solid lines for the child, dashed lines for the parent.
fn figure(child: &Subject, parent: Option<&Subject>) -> ChartView {
    let trial = &child.trial;
    let lines = |subject: &Subject| subject.lines.clone().unwrap_or_default();
    let (of_child, of_parent) = (lines(child), parent.map(lines).unwrap_or_default());
    let all = of_child.iter().chain(&of_parent).flatten().flatten();
    // All charts have the same range, so that joints can be compared.
    let y = Axis::around("Torque", "N·m", all.map(|point| point[1]).chain([-1.0, 1.0]), 2.0);
    let series = |names: [&str; 2], lines: &TorqueLines, shape: fn(Vec<[f64; 2]>) -> Shape| {
        let roles = [Role::Bend, Role::Twist];
        [0, 1].map(|axis| Series::new(names[axis], roles[axis], shape(lines[axis].clone())))
    };
    let chart = |(index, lines): (usize, &TorqueLines)| {
        let before = of_parent.get(index).filter(|[bend, _]| !bend.is_empty());
        let before =
            before.map(|of| series(["parent's bend", "parent's twist"], of, Shape::Dashed));
        let now = series(["bend", "twist"], lines, Shape::Line);
        let series = before.into_iter().flatten().chain(now).collect();
        let x = Axis::new("Time", "s", 0.0..=f64::from(trial.duration_s));
        Chart::new(x, y.clone(), series).named(&format!("Joint {}", index + 1))
    };
    let charts: Vec<Chart> = of_child.iter().enumerate().map(chart).collect();
    let note = match parent {
        Some(parent) => {
            format!("Solid lines: {}. Dashed lines: its parent, {}.", child.name, parent.name)
        }
        None => format!(
            "Solid lines: {}. No parent is known to compare it with; snakes of CMA-ES and of random search have none.",
            child.name
        ),
    };
    let figure = Figure::of_several(&format!("Torques: {}", child.name), charts);
    let hits = of_child.iter().enumerate().map(|(index, lines)| hits(lines, of_parent.get(index)));
    let hits = hits.collect();
    let view = ChartView::new(figure.with_note(note), hits);
    ChartView { is_of_run: child.is_of_run, ..view }
}

/// Returns the hover targets of a joint's torques over time.
fn hits([bend, twist]: &TorqueLines, parent: Option<&TorqueLines>) -> Vec<ChartHit> {
    let moments = bend.iter().zip(twist).enumerate();
    let hit = |(index, (bend, twist)): (usize, (&[f64; 2], &[f64; 2]))| {
        let before = parent.and_then(|[bend, twist]| bend.get(index).zip(twist.get(index)));
        // The parent's torques are left out if its rollout was sampled at other times.
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
mod tests;
