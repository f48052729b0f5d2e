//! View of a decision: the situation in words, the worth of each posture in it, and the rules on which it is based.

use bevy_egui::egui;

use super::rule_row::{RuleRow, rule_list};
use super::value_bar::ValueBar;
use crate::studio::ui::check_box::check_box;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::text_rows::{explain, title};
use crate::studio::ui::theme;
use snakes_core::control::{ActiveRule, DecisionActivity};

/// Width of the postures' names, in points.
const POSTURE_NAMES: f32 = theme::GAP * 20.5;

/// Width of the postures' worths, in points: up to seven characters without a unit.
const WORTHS: f32 = theme::GAP * 7.0;

/// Draws a decision of the controller.
pub(super) fn decision_view(
    ui: &mut egui::Ui,
    decision: &DecisionActivity,
    shows_all_rules: &mut bool,
) {
    let of_joint = |joint| format!("Joint {}. ", joint + 1);
    let joint = decision.joint.map_or_else(String::new, of_joint);
    ui.label(egui::RichText::new(format!("{joint}Situation: {}", decision.situation)).strong());
    if decision.joint.is_some() {
        explain(
            ui,
            "Each joint has rules of its own. Click a block to see those of the joint in front of it.",
        );
    }
    postures(ui, decision);
    if !decision.rules.is_empty() {
        rules(ui, decision, shows_all_rules);
    }
}

fn postures(ui: &mut egui::Ui, decision: &DecisionActivity) {
    let palette = theme::of(ui);
    let has_rules = !decision.rules.is_empty();
    let worths = || decision.postures.iter().filter_map(|posture| posture.worth);
    let (least, most) = (worths().fold(0.0, f32::min), worths().fold(0.0, f32::max));
    let largest = most.max(-least);
    if decision.postures.iter().all(|posture| posture.count == 0) {
        let then = match decision.joint {
            Some(_) => "keeps its bend",
            None => "takes the first other posture",
        };
        explain(ui, &format!("It knows nothing about this situation yet, and {then}."));
    }
    for (index, posture) in decision.postures.iter().enumerate() {
        let (is_chosen, is_barred) = (index == decision.chosen, decision.barred == Some(index));
        let uses = match (has_rules, posture.count) {
            (true, 1) => "rule",
            (true, _) => "rules",
            (false, 1) => "visit",
            (false, _) => "visits",
        };
        let note = match is_barred {
            true => "taken before".to_owned(),
            false => format!("{} {uses}", posture.count),
        };
        let row = ValueBar {
            name: posture.name,
            names_width: POSTURE_NAMES,
            numbers_width: WORTHS,
            text: posture
                .worth
                .map_or_else(|| "-".to_owned(), |worth| worth_in_words(worth, largest)),
            value: posture.worth.unwrap_or(0.0),
            range: [least, most],
            note: &note,
            color: if is_chosen { palette.accent } else { palette.second },
            is_frozen: is_barred || posture.worth.is_none() || posture.count == 0,
            is_chosen,
            hint: match (is_chosen, is_barred) {
                (true, _) => format!("The {} that it has chosen", noun(decision)),
                (_, true) => "The posture before: none follows itself".to_owned(),
                _ => format!("What it has learned this {} to be worth here", noun(decision)),
            },
        };
        row.ui(ui);
    }
}

/// Returns the name of what the controller decides on: a bend or a posture.
fn noun(decision: &DecisionActivity) -> &'static str {
    if decision.joint.is_some() { "bend" } else { "posture" }
}

/// Formats a worth with as many decimals as fit beside the largest of the list.
fn worth_in_words(worth: f32, most: f32) -> String {
    match most {
        size if size >= 1.0e6 => format!("{worth:.1e}"),
        size if size >= 100.0 => decimals(worth, 0),
        _ => decimals(worth, 2),
    }
}

fn rules(ui: &mut egui::Ui, decision: &DecisionActivity, shows_all: &mut bool) {
    let matching = decision.rules.iter().filter(|rule| rule.matches).count();
    title(ui, &format!("Rules: {matching} of {} match", decision.rules.len()));
    check_box(ui, shows_all, "Also rules that do not match")
        .on_hover_text("List all rules; those that match are lit");
    let meaning = match decision.rules.iter().any(|rule| rule.fitness.is_some()) {
        true => "Each predicts the worth of what it advises, and counts by its accuracy.",
        false => "The strengths of those that match and advise the same add up.",
    };
    explain(ui, meaning);
    let listed = decision.rules.iter().filter(|rule| *shows_all || rule.matches);
    let mut listed: Vec<&ActiveRule> = listed.collect();
    // Rules that have decided come first, then others that match. Within each group, the most influential rules come first.
    let rank = |rule: &ActiveRule| (rule.decides, rule.matches);
    let use_of = |rule: &ActiveRule| rule.fitness.unwrap_or(rule.worth);
    listed.sort_by(|a, b| rank(b).cmp(&rank(a)).then(use_of(b).total_cmp(&use_of(a))));
    rule_list(ui, "rules", listed.len(), |index| entry(listed[index], decision));
}

/// Returns the row of a rule: its condition above, its posture and numbers below.
fn entry(rule: &ActiveRule, decision: &DecisionActivity) -> RuleRow {
    let posture = decision.postures.get(rule.posture).map_or("", |posture| posture.name);
    RuleRow {
        condition: match rule.condition.care() {
            0 => "Always".to_owned(),
            _ => format!("If {}", rule.words()),
        },
        action: format!("{posture}: {}", rule_numbers(rule)),
        holds: rule.matches,
        decides: rule.decides,
        state: match (rule.matches, rule.decides) {
            (_, true) if decision.joint.is_some() => "It matches, and its bend was chosen",
            (_, true) => "It matches, and its posture was chosen",
            (true, false) => "It matches",
            (false, false) => "It does not match this situation",
        },
    }
}

/// Describes the numbers of a rule briefly, because they follow its posture.
fn rule_numbers(rule: &ActiveRule) -> String {
    let worth = worth_in_words(rule.worth, rule.worth.abs());
    match (rule.fitness, rule.experience) {
        (Some(fitness), Some(experience)) => {
            format!("{worth}, accuracy {}, used {experience}×", decimals(fitness, 2))
        }
        _ => format!("strength {worth}"),
    }
}
