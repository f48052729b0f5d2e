//! Tests of the champions list and its buttons.

use super::*;
use crate::studio::panels::testing::{self, Sent, assert_no_overlap, clicked, report_of, shows};
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::StairsCount;
use snakes_core::save::shipped_champion;
use snakes_core::schema::PerPart;
use snakes_core::score::Fitness;

/// Creates the panel with these champions. Two snakes can race in each generation.
fn panel<'a>(opening: &'a [(String, LoadedChampion)], reports: &'a [GenerationReport]) -> Sent<'a> {
    let mut panel = ChampionsPanel::default();
    testing::panel([360.0, 400.0], move |ui| {
        let shown = &[ShownLane { champion: Pick::Opened(0), lane: None }];
        let view = ChampionsView { opening, reports, shown, leaders: &|_| 2, follows: None };
        panel.ui(ui, &view);
    })
}

/// Creates the report of a generation whose best snake has this fitness.
fn report(generation: u32, fitness: f32) -> GenerationReport {
    let mut report = report_of(1);
    report.record.generation = generation;
    let champion = report.champion.as_mut().expect("a healthy snake");
    champion.origin.generation = generation;
    champion.evaluation.fitness = fitness;
    report
}

/// Returns which of the first five generations are listed.
fn listed(panel: &Sent<'_>) -> Vec<u32> {
    (1..=5).filter(|generation| shows(panel, &format!("Generation {generation}"))).collect()
}

#[test]
fn the_summary_is_updated_after_a_report_and_in_another_run() {
    let run = |seed: u64| [1, 2, 3].map(|_| report_of(seed));
    let (first, second) = (run(1), run(2));
    let mut panel = ChampionsPanel::default();
    for reports in [&first[..0], &first[..1], &first[..], &second[..], &first[..2]] {
        let summary = panel.summary(reports);
        let expected = ReportSummary::of(reports);
        assert_eq!((summary.champions, summary.best), (expected.champions, expected.best));
        assert_eq!(summary.better, expected.better);
    }
}

#[test]
fn a_click_on_a_generation_shows_its_champion() {
    let loaded = shipped_champion().expect("well formed");
    let opening = [("climber".to_owned(), loaded)];
    let reports = [report(1, 1.0), report(2, 2.0)];
    let mut panel = panel(&opening, &reports);
    panel.get_by_label_contains("Generation 2").click();
    panel.run();
    panel.get_by_label_contains("Generation 1").click_modifiers(egui::Modifiers::SHIFT);
    panel.run();
    let commands = [
        StageCommand::Show(Pick::Generation(2)),
        StageCommand::Join(Pick::Generation(1)),
        StageCommand::RaceGenerations,
    ];
    assert_eq!(clicked(&mut panel, "Race generations"), commands.map(Command::Stage));
}

#[test]
fn better_ones_only_lists_the_generations_that_improved_on_all_before() {
    let reports: Vec<GenerationReport> =
        (1..).zip([1.0, 0.5, 2.0, 2.0, 3.0]).map(|(of, fitness)| report(of, fitness)).collect();
    let mut panel = panel(&[], &reports);
    assert_eq!(listed(&panel), [1, 2, 3, 4, 5]);
    for head in ["Fitness", "Time", "Energy"] {
        assert!(panel.query_by_label(head).is_some(), "{head}");
    }
    assert!(shows(&panel, "Generation 5, best, 3.00 m, -, "));
    clicked(&mut panel, "Better ones only");
    assert_eq!(listed(&panel), [1, 3, 5]);
    panel.get_by_label_contains("Generation 3").click();
    panel.run();
    let command = Command::Stage(StageCommand::Show(Pick::Generation(3)));
    assert_eq!(*panel.state(), [command]);
}

#[test]
fn of_a_run_whose_stairs_evolve_only_generations_with_a_champion_are_listed() {
    let stairs = StairsCount { rounds: 1, all: 1, active: 1, solved: 0, challenges: 0 };
    let mut reports = [1, 2, 3].map(|of| report(of, 1.0 + of as f32));
    reports.iter_mut().for_each(|report| report.record.stairs = Some(stairs));
    reports[1].champion = None;
    let panel = panel(&[], &reports);
    assert_eq!(listed(&panel), [1, 3]);
    assert!(!shows(&panel, "disqualified"));
}

#[test]
fn a19_texts_of_a_row_do_not_overlap_and_the_highest_stairs_are_not_called_the_best() {
    let mut reports = [report(148, 1.013), report(149, 0.892)];
    for report in &mut reports {
        report.champion.as_mut().expect("healthy").trial.fitness = Fitness::Share;
    }
    reports[1].champion.as_mut().expect("healthy").trial.stairs.rise_m = PerPart::All(0.7);
    let panel = panel(&[], &reports);
    assert!(shows(&panel, "Generation 149, highest, 89.2 %, "));
    let row = panel.get_by_label_contains("Generation 149").rect();
    assert_no_overlap(&panel, row, 2, 0.0);
}
