//! Chart of the Pareto front of distance and energy. A click replays a member.

use super::view::{ChartHit, ChartView, HitShape, generation_and_snake};
use crate::studio::commands::pick::Pick;
use crate::studio::ui::plot_axes::number;
use snakes_core::evolve::{Front, FrontMember, IndividualId, Settings};
use snakes_core::score::Trial;
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape};

/// Creates the chart of a front, which is empty if the front has no members.
pub(super) fn view(settings: &Settings, front: &Front) -> ChartView {
    let points: Vec<[f64; 2]> = front.members().map(place).collect();
    let along = |axis: usize| points.iter().map(move |point| point[axis]);
    let x = Axis::around("Final distance", "m", along(0), 2.0);
    let y = Axis::around("Energy", "kJ", along(1), 0.01);
    let series = vec![
        Series::new("", Role::Others, Shape::Line(points.clone())),
        Series::new("Pareto front", Role::First, Shape::Points(points.clone())),
    ];
    let hit = |member: &FrontMember| {
        let words = hover_text(member, &settings.trial);
        let at = id(member);
        ChartHit::of(HitShape::Point(place(member)), move || words.clone(), Pick::Front(at), at)
    };
    let figure = Figure::of("Distance and energy", Chart::new(x, y, series));
    ChartView::new(figure, vec![front.members().map(hit).collect()])
}

/// Returns the place of a member in the run.
fn id(member: &FrontMember) -> IndividualId {
    IndividualId { generation: member.generation, individual: member.individual }
}

/// Returns the chart position of a member: distance in metres and energy in kJ.
fn place(member: &FrontMember) -> [f64; 2] {
    let energy_j = member.evaluation.effort.map_or(0.0, |effort| f64::from(effort.energy_j));
    [f64::from(member.evaluation.centre_y_m), energy_j / 1000.0]
}

/// Returns the hover text of a member.
fn hover_text(member: &FrontMember, trial: &Trial) -> String {
    let [y_m, energy_kj] = place(member);
    format!(
        "Distance {y_m:.2} m: {}\nEnergy {} kJ\n{}",
        trial.result_in_words(&member.genome, &member.evaluation),
        number(energy_kj),
        generation_and_snake(id(member))
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{Command, StageCommand};
    use crate::studio::panels::charts::tests::clicked;
    use crate::studio::state::current_run::explored_run;
    use bevy_egui::egui;

    #[test]
    fn a_click_near_a_point_replays_it_and_one_far_away_does_not() {
        let run = explored_run();
        let front = &run.exploration().expect("explored").front;
        let view = view(run.settings(), front);
        let best = front.members().last().expect("a member");
        let show = Command::Stage(StageCommand::Show(Pick::Front(id(best))));
        assert_eq!(*clicked(&view, place(best), egui::vec2(3.0, 3.0)).state(), [show]);
        // There is no member far below the point.
        assert_eq!(*clicked(&view, place(best), egui::vec2(0.0, 60.0)).state(), []);
        let table = view.figure.table();
        assert_eq!(table.len(), 1 + front.members().len());
        assert_eq!(table[0], ["Final distance (m)", "Pareto front (kJ)"]);
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
