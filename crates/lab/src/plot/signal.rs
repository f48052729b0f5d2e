//! The torque signal of a champion, as in the report's Figure 4.

use super::canvas::PlotError;
use super::figure::{Axis, Chart, Figure, Role, Series, Shape};
use super::paint::figure_of_size;
use snakes_core::evolve::Champion;
use snakes_core::genome::JointCommands;
use snakes_core::save::Picture;
use snakes_core::score::Rollout;

/// Width and height of the picture, in pixels: the width of a page of the report, and low.
const SIZE: (u32, u32) = (960, 420);

/// Plots the bend commands to a champion's first joint over time or, for a controller whose commands depend on its senses, the
/// applied torques.
///
/// # Errors
/// The plotting library failed.
pub fn signal(champion: &Champion, title: &str) -> Result<Picture, PlotError> {
    let duration_s = f64::from(champion.trial.duration_s);
    let (quantity, least_range, points) = match champion.genome.controller.commands(duration_s) {
        Some(JointCommands { quantity, least_range, joints, .. }) => {
            let bend = joints.into_iter().next().map_or(Vec::new(), |[bend, _]| bend);
            (quantity, least_range, bend.into_iter().map(<[f64; 2]>::from).collect())
        }
        None => ("torque in N·m", 1000.0, applied_torques(champion)),
    };
    let values = points.iter().map(|point: &[f64; 2]| point[1]);
    let y = Axis::around(quantity, "", values.chain([-least_range, least_range]), 0.0);
    let zero = Shape::Dashed(vec![[0.0, 0.0], [duration_s, 0.0]]);
    let series = vec![
        Series::new("", Role::Others, zero),
        Series::new("", Role::First, Shape::Line(points)),
    ];
    let x = Axis::new("time", "s", 0.0..=duration_s);
    figure_of_size(&Figure::of(title, Chart::new(x, y, series)), SIZE)
}

/// Returns the bend torques of the first joint in a champion's rollout: times in seconds and torques in N·m. Used for controllers
/// whose commands depend on their senses.
fn applied_torques(champion: &Champion) -> Vec<[f64; 2]> {
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    let step_s = f64::from(champion.trial.physics.step_s());
    let mut points = Vec::new();
    while rollout.advance() {
        let time_s = f64::from(rollout.step() - 1) * step_s;
        let first = rollout.simulation().applied_torques().next();
        points.extend(first.map(|torque| [time_s, f64::from(torque.bend_nm)]));
    }
    points
}
