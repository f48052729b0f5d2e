//! Beside several lanes: who is where, who has landed, and what to do with a change that was tried.

use bevy_egui::egui;

use crate::studio::command::Command;
use crate::studio::lane::Lane;
use crate::studio::look;
use crate::studio::stage::Programme;

/// How a lane stands.
#[derive(Debug, Clone, PartialEq)]
struct Standing {
    lane: usize,
    name: String,
    /// When it landed, in simulated seconds.
    landed_s: Option<f64>,
    is_out: bool,
    /// Whether a hand has interfered: it is no finisher any more.
    is_disturbed: bool,
    y_m: f32,
}

/// The lanes in the order of finishing: who has landed by when they did, the others by where they are, who is
/// disqualified last.
fn standings<'a>(lanes: impl IntoIterator<Item = &'a Lane>, time_s: f64) -> Vec<Standing> {
    let mut standings: Vec<Standing> = lanes
        .into_iter()
        .map(|lane| {
            let evaluation = lane.evaluation();
            Standing {
                lane: lane.number(),
                name: lane.exhibit().label().to_owned(),
                landed_s: lane.landed_s(time_s),
                is_out: evaluation.disqualified.is_some(),
                is_disturbed: lane.is_disturbed(),
                y_m: evaluation.centre_y_m,
            }
        })
        .collect();
    order(&mut standings);
    standings
}

fn order(standings: &mut [Standing]) {
    standings.sort_by(|a, b| {
        let landed = |standing: &Standing| standing.landed_s.unwrap_or(f64::INFINITY);
        let by_place = b.y_m.total_cmp(&a.y_m).then(a.lane.cmp(&b.lane));
        let counts = |standing: &Standing| (standing.is_out, standing.is_disturbed);
        counts(a).cmp(&counts(b)).then(landed(a).total_cmp(&landed(b))).then(by_place)
    });
}

/// Draws the board and adds what was asked for. `focus` is the lane whose numbers are shown. Where the stage
/// `is_narrow` it says the same in fewer letters.
pub(super) fn board(
    ui: &mut egui::Ui,
    lanes: &[&Lane],
    programme: &Programme,
    focus: usize,
    time_s: f64,
    is_narrow: bool,
    asked: &mut Vec<Command>,
) {
    let palette = look::of(ui);
    let title = |ui: &mut egui::Ui, text: &str| {
        ui.label(egui::RichText::new(text).size(look::TITLE_SIZE).strong());
    };
    match programme {
        Programme::Solo => return,
        Programme::Race => title(ui, "Race"),
        Programme::WhatIf { .. } => title(ui, "What if"),
    }
    egui::Grid::new("board")
        .num_columns(3)
        .min_col_width(0.0)
        .spacing([look::GAP, look::GAP / 4.0])
        .show(ui, |ui| {
            for (place, standing) in standings(lanes.iter().copied(), time_s).iter().enumerate() {
                let rank = format!("{}", place + 1);
                ui.label(egui::RichText::new(rank).color(palette.text_weak).monospace());
                let hint = "Click to see its numbers and torques below";
                let name = ui.selectable_label(standing.lane == focus, &standing.name);
                if name.on_hover_text(hint).clicked() {
                    asked.push(Command::Focus(standing.lane));
                }
                // Of one width, so that nothing moves while it runs.
                let text = match (standing.is_out, standing.landed_s) {
                    _ if standing.is_disturbed => "by hand".to_owned(),
                    (true, _) => "out".to_owned(),
                    (false, Some(landed_s)) if is_narrow => format!("{landed_s:.2} s"),
                    (false, Some(landed_s)) => format!("landed {landed_s:.2} s"),
                    (false, None) => format!("{:.2} m", standing.y_m),
                };
                let color = match (standing.is_out || standing.is_disturbed, standing.landed_s) {
                    (true, _) => palette.problem,
                    (false, Some(_)) => palette.accent,
                    (false, None) => palette.text,
                };
                let width = if is_narrow { 8 } else { 14 };
                let text = egui::RichText::new(format!("{text:>width$}")).monospace().color(color);
                let value = ui.label(text);
                if standing.landed_s.is_some() && !standing.is_out && !standing.is_disturbed {
                    value.on_hover_text("When it landed");
                }
                ui.end_row();
            }
        });
    ui.horizontal(|ui| {
        let buttons: &[(&str, &str, Command)] = match programme {
            Programme::WhatIf { .. } => &[
                ("Keep", "Go on with the change; the next run has it too", Command::KeepChange),
                ("Drop", "Forget the change, for the next run too (Esc)", Command::DropChange),
            ],
            Programme::Solo | Programme::Race => {
                &[("Only this", "Leave the race with the chosen one (Esc)", Command::Single)]
            }
        };
        for (name, hint, command) in buttons {
            if ui.button(*name).on_hover_text(*hint).clicked() {
                asked.push(command.clone());
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings};
    use crate::save::shipped_champion;
    use crate::studio::exhibit::Exhibit;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn who_lands_first_is_first_and_who_was_pulled_or_is_out_is_last() {
        let standing = |lane, landed_s, is_out, y_m| Standing {
            lane,
            name: lane.to_string(),
            landed_s,
            is_out,
            is_disturbed: lane == 5,
            y_m,
        };
        let mut standings = [
            standing(0, None, false, 12.0),
            standing(1, Some(9.0), false, 24.0),
            standing(2, None, true, 30.0),
            standing(3, Some(7.5), false, 22.0),
            standing(4, None, false, 14.0),
            standing(5, None, false, 40.0),
        ];
        order(&mut standings);
        let lanes = standings.map(|standing| standing.lane);
        assert_eq!(lanes, [3, 1, 4, 0, 5, 2]);
    }

    #[test]
    fn a_click_on_a_name_shows_its_numbers_and_a_change_can_be_kept_or_dropped() {
        let loaded = shipped_champion().expect("well formed");
        let lane =
            |number| Lane::new(Exhibit::saved(&loaded, number, &format!("snake {number}")), number);
        let lanes = [lane(0), lane(1)];
        let before = Box::new(RunPlan::new("climb", 1, Settings::default()));
        for (programme, label, command) in [
            (Programme::Race, "snake 1", Command::Focus(1)),
            (Programme::Race, "Only this", Command::Single),
            (Programme::WhatIf { before: before.clone() }, "Keep", Command::KeepChange),
            (Programme::WhatIf { before }, "Drop", Command::DropChange),
        ] {
            let lanes: Vec<&Lane> = lanes.iter().collect();
            let mut harness = Harness::new_ui_state(
                |ui, asked| board(ui, &lanes, &programme, 0, 0.0, false, asked),
                Vec::new(),
            );
            harness.get_by_label(label).click();
            harness.run();
            assert_eq!(*harness.state(), [command], "{label}");
        }
    }

    #[test]
    fn over_a_narrow_stage_it_is_narrower() {
        let loaded = shipped_champion().expect("well formed");
        let lane = Lane::new(Exhibit::saved(&loaded, 0, "one"), 0);
        let width = |is_narrow| {
            let mut harness = Harness::new_ui_state(
                |ui, asked: &mut Vec<Command>| {
                    board(ui, &[&lane], &Programme::Race, 0, 0.0, is_narrow, asked);
                },
                Vec::new(),
            );
            harness.run();
            let [name, value] = ["one", " m"].map(|label| harness.get_by_label_contains(label));
            value.rect().right() - name.rect().left()
        };
        assert!(width(true) + 30.0 < width(false), "{} of {}", width(true), width(false));
    }
}
