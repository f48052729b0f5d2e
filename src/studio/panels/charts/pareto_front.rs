//! Pareto front of distance and energy. A click replays a member.

use std::ops::RangeInclusive;

use bevy_egui::egui;
use egui_plot::{HoverPosition, Line, PlotPoint, PlotPoints, Points};

use super::legend::click_hint;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, StageCommand};
use crate::studio::panels::shown::ShownLane;
use crate::studio::ui::plot_axes::{bounds, fixed_plot, number, padded_range, x_title, y_title};
use crate::studio::ui::theme;
use snakes_core::evolve::{Front, FrontMember};
use snakes_core::score::Trial;

/// Draws a front that has members, `height` points high, and collects the user's commands.
pub(crate) fn front_plot(
    ui: &mut egui::Ui,
    front: &Front,
    trial: &Trial,
    shown: &[ShownLane],
    height: f32,
    commands: &mut Vec<Command>,
) {
    let members: Vec<&FrontMember> = front.members().collect();
    let points: Vec<[f64; 2]> = members.iter().map(|member| place(member)).collect();
    let Some((x_range, y_range)) = ranges(&points) else { return };
    click_hint(ui, "Click any point to replay that snake.");
    y_title(ui, "Energy (kJ)");
    let shown_points = shown.iter().filter_map(|shown| {
        let is_it = |of: &&FrontMember| shown.champion.is(of.generation, of.individual);
        Some((*shown, members.iter().position(is_it)?))
    });
    let label = |position: &HoverPosition<'_>| match position {
        HoverPosition::NearDataPoint { index, .. } => {
            members.get(*index).map(|of| hover_text(of, trial))
        }
        HoverPosition::Elsewhere { .. } => None,
    };
    let palette = theme::of(ui);
    let plot = fixed_plot("front", height).label_formatter(label).show(ui, |plot| {
        plot.set_plot_bounds(bounds(&x_range, &y_range));
        let line = Line::new("line", PlotPoints::from(points.clone()));
        plot.line(line.color(palette.text_weak.gamma_multiply(0.6)).allow_hover(false));
        plot.points(Points::new("front", points.clone()).color(palette.accent).radius(4.0));
        for (shown, index) in shown_points {
            let color = shown.color(palette).unwrap_or(palette.second);
            let dot = Points::new("shown", vec![points[index]]).color(color);
            plot.points(dot.radius(6.5).allow_hover(false));
        }
    });
    x_title(ui, "Final distance (m)");
    let response = plot.response;
    response.widget_info(|| {
        egui::WidgetInfo::labeled(
            egui::WidgetType::Other,
            true,
            "Pareto front of distance and energy",
        )
    });
    let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) else { return };
    let distance = |point: &[f64; 2]| {
        let point = PlotPoint::new(point[0], point[1]);
        plot.transform.position_from_point(&point).distance(at)
    };
    let nearest = members.iter().zip(&points).map(|(member, point)| (member, distance(point)));
    let nearest = nearest.min_by(|(_, a), (_, b)| a.total_cmp(b));
    if let Some((member, distance)) = nearest
        && distance <= CLICK_DISTANCE
    {
        let FrontMember { generation, individual, .. } = **member;
        commands.push(Command::Stage(StageCommand::Show(Pick::Front { generation, individual })));
    }
}

/// Maximum distance between a click and a point, in screen points.
const CLICK_DISTANCE: f32 = 16.0;
/// Chart position of a member, in metres and kJ.
fn place(member: &FrontMember) -> [f64; 2] {
    let energy_j = member.evaluation.effort.map_or(0.0, |effort| f64::from(effort.energy_j));
    [f64::from(member.evaluation.centre_y_m), energy_j / 1000.0]
}

/// Ranges of both axes.
fn ranges(points: &[[f64; 2]]) -> Option<(RangeInclusive<f64>, RangeInclusive<f64>)> {
    let axis = |of: usize, least_width| {
        padded_range(points.iter().map(move |point| point[of]), least_width)
    };
    Some((axis(0, 2.0)?, axis(1, 0.01)?))
}

/// Hover text of a member.
fn hover_text(member: &FrontMember, trial: &Trial) -> String {
    let [y_m, energy_kj] = place(member);
    format!(
        "Distance {y_m:.2} m: {}\nEnergy {} kJ\nGeneration {}, snake {}\nClick to replay",
        trial.result_in_words(&member.genome, &member.evaluation),
        number(energy_kj),
        member.generation,
        member.individual + 1
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::explored_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Commands sent by a click at a chart position, moved by `off` points.
    fn sent(front: &Front, at: [f64; 2], off: egui::Vec2) -> Vec<Command> {
        let size = egui::vec2(theme::PANEL_WIDTH, 400.0);
        let mut harness = Harness::builder().with_size(size).build_ui_state(
            |ui, commands| {
                front_plot(ui, front, &Trial::default(), &[], theme::PLOT_HEIGHT, commands)
            },
            Vec::new(),
        );
        harness.run();
        let chart = harness.get_by_label("Pareto front of distance and energy").rect();
        let points: Vec<[f64; 2]> = front.members().map(place).collect();
        let (x, y) = ranges(&points).expect("points");
        let share = |value: f64, range: &RangeInclusive<f64>| {
            ((value - range.start()) / (range.end() - range.start())) as f32
        };
        let position = egui::pos2(
            chart.left() + chart.width() * share(at[0], &x),
            chart.bottom() - chart.height() * share(at[1], &y),
        ) + off;
        harness.drag_at(position);
        harness.run();
        harness.drop_at(position);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn a_click_near_a_point_replays_it_and_one_far_away_does_not() {
        let run = explored_run();
        let front = &run.exploration().expect("explored").front;
        let best = front.members().last().expect("a member");
        let FrontMember { generation, individual, .. } = *best;
        let off = egui::vec2(3.0, 3.0);
        assert_eq!(
            sent(front, place(best), off),
            [Command::Stage(StageCommand::Show(Pick::Front { generation, individual }))]
        );
        // Far below the point there is no member.
        assert_eq!(sent(front, place(best), egui::vec2(0.0, 60.0)), []);
    }

    #[test]
    fn a_snake_beyond_the_landing_is_not_said_to_stand_on_it() {
        let run = explored_run();
        let front = &run.exploration().expect("explored").front;
        let mut member = front.members().next().expect("a member").clone();
        member.evaluation.centre_y_m = 68.0;
        let behaviour = member.evaluation.behaviour.as_mut().expect("measured");
        behaviour.steps_climbed = 0;
        let text = hover_text(&member, &Trial::default());
        assert!(text.starts_with("Distance 68.00 m: lies behind the stairs\n"), "{text}");
    }
}
