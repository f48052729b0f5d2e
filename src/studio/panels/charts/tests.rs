//! Tests of the charts panel: select, hover, click, export.

use egui_kittest::kittest::Queryable;

use super::*;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{RunCommand, StageCommand};
use crate::studio::panels::testing::{self, Sent, assert_fits, click, click_at, shows};
use crate::studio::state::current_run::{
    bodies_run, compared_run, explored_run, next_generation, prepared_run, species_run,
};
use snakes_core::evolve::{IndividualId, RunPlan, Settings, StrategyKind};
use snakes_lab::run::Experiment;

/// Runs this number of generations for 0.5 s each. `change` changes the settings, which are also returned.
pub(super) fn experiment(
    generations: usize,
    change: impl FnOnce(&mut Settings),
) -> (Settings, Experiment) {
    let mut settings = Settings::default();
    settings.trial.duration_s = 0.5;
    change(&mut settings);
    let mut experiment = Experiment::new(RunPlan::new("test", 1, settings.clone()));
    for _ in 0..generations {
        next_generation(&mut experiment);
    }
    (settings, experiment)
}

/// Draws a chart, and clicks at a chart position, moved by `off` points. The pointer stays beside that place.
pub(super) fn clicked<'a>(view: &'a ChartView, at: [f64; 2], off: egui::Vec2) -> Sent<'a> {
    let height = theme::PLOT_HEIGHT + 35.0;
    let mut panel = testing::panel([theme::PANEL_WIDTH, 500.0], move |ui| {
        draw::draw(ui, "clicked", view, height, &[]);
    });
    let area = panel.get_by_label(&format!("Chart: {}", view.figure.title)).rect();
    let place = draw::screen_position(area, &view.figure.charts[0], at) + off;
    click_at(&mut panel, place);
    panel.hover_at(place + egui::vec2(1.0, 0.0));
    panel.run();
    panel
}

/// Calls `act` in a panel of this width, in points. Returns the commands that were sent.
fn with(
    run: &CurrentRun,
    kind: ChartKind,
    width: f32,
    act: impl FnOnce(&mut Sent<'_>),
) -> Vec<Command> {
    let mut panel = ChartsPanel { kind, ..ChartsPanel::new(None) };
    let best = run.reports.last().and_then(|report| report.champion.as_ref());
    let selected = best.map(|best| StagedChampion::from_run(best, run.number));
    let mut harness = testing::panel([width, 700.0], |ui| {
        panel.ui(ui, run, &[], selected.as_ref());
    });
    // Opening a chart may request the list of runs, which is removed.
    harness.state_mut().clear();
    testing::sent_by(harness, act)
}

#[test]
fn a_chart_is_selected_by_its_name() {
    let sent = with(&explored_run(), ChartKind::Fitness, 600.0, |harness| {
        assert!(harness.query_by_label("Fitness by generation").is_some());
        for (kind, title) in [
            (ChartKind::Ancestors, "Ancestors of the best"),
            (ChartKind::Runs, "Comparison of runs"),
        ] {
            click(harness, kind.name());
            assert!(harness.query_all_by_label(title).next().is_some(), "{title}");
        }
    });
    assert_eq!(sent, [Command::Run(RunCommand::ListRuns)], "other runs are looked for once");
}

/// Returns the kinds of charts that a run has.
fn offered(run: &CurrentRun) -> Vec<ChartKind> {
    let strategy = run.settings().evolution.strategy;
    let is_offered = |kind: &ChartKind| kind.is_offered(strategy, false);
    ChartKind::ALL.into_iter().filter(is_offered).collect()
}

#[test]
fn charts_without_data_are_not_offered() {
    let offered = |strategy, has_study| {
        let kinds = [ChartKind::Parents, ChartKind::Archive, ChartKind::Methods];
        kinds.map(|kind| kind.is_offered(strategy, has_study))
    };
    assert_eq!(offered(StrategyKind::CmaEs, false), [false; 3]);
    assert_eq!(offered(StrategyKind::MapElites, true), [true; 3]);
}

#[test]
fn only_a_run_with_species_offers_their_chart() {
    for (run, kind, is_offered) in [
        (explored_run(), ChartKind::Species, false),
        (species_run(), ChartKind::Species, true),
        (explored_run(), ChartKind::Blocks, false),
        (bodies_run(), ChartKind::Blocks, true),
    ] {
        with(&run, kind, 600.0, |harness| {
            let name = kind.name();
            let title = format!("{name} by generation");
            for label in [name, &title] {
                let mut found = harness.query_all_by_label(label);
                assert_eq!(found.next().is_some(), is_offered, "{label}");
            }
        });
    }
}

#[test]
fn before_the_first_generation_every_chart_explains_its_content() {
    let run = prepared_run();
    for kind in offered(&run) {
        let sent = with(&run, kind, theme::PANEL_WIDTH, |harness| {
            assert!(shows(harness, "will appear here"), "{kind:?}");
            assert!(harness.query_by_label("PNG").is_none(), "{kind:?}: nothing to write");
        });
        assert_eq!(sent, [], "{kind:?}");
    }
}

#[test]
fn every_chart_of_a_run_is_drawn_at_any_width_and_can_be_exported() {
    let (run, neat, bodies) = (explored_run(), species_run(), bodies_run());
    for width in [300.0, 900.0] {
        let charts =
            offered(&run).into_iter().map(|kind| (&run, kind)).chain([(&neat, ChartKind::Species)]);
        let charts = charts.chain(
            [ChartKind::Blocks, ChartKind::Bodies, ChartKind::Archive].map(|kind| (&bodies, kind)),
        );
        for (run, kind) in charts {
            let sent = with(run, kind, width, |harness| {
                // Another thread computes the torques of waves.
                for _ in 0..3000 {
                    if harness.query_by_label("CSV").is_some() {
                        break;
                    }
                    harness.run();
                }
                click(harness, "CSV");
            });
            let [Command::Run(RunCommand::ExportChart(ChartExport { figure, name, format, .. }))] =
                &sent[..]
            else {
                panic!("{kind:?}: {sent:?}")
            };
            assert_eq!((name, *format), (&kind.name().to_lowercase(), ChartFormat::Csv));
            assert!(figure.table().len() > 1, "{kind:?} has rows");
        }
    }
}

#[test]
fn a_click_replays_a_generation_a_bar_an_ancestor_or_a_parent() {
    let run = explored_run();
    for kind in [ChartKind::Fitness, ChartKind::Spread, ChartKind::Ancestors, ChartKind::Parents] {
        let view = view_of(kind, &run).expect("explored");
        let hit = view.hits[0].last().expect("a snake").clone();
        let at = match hit.target {
            view::HitShape::Point(point) | view::HitShape::Column(point) => point,
            view::HitShape::Area([left, right, ..]) => [(left + right) / 2.0, 0.5],
        };
        let panel = clicked(&view, at, egui::Vec2::ZERO);
        let first = hit.words().lines().next().expect("words").to_owned();
        assert!(shows(&panel, &first), "{kind:?} is read out: {}", hit.words());
        let show = Command::Stage(StageCommand::Show(hit.pick.expect("a snake")));
        assert_eq!(*panel.state(), [show], "{kind:?}");
    }
}

#[test]
fn another_run_is_drawn_and_a_damaged_one_is_reported() {
    let saves = tempfile::tempdir().expect("a folder");
    let run = compared_run(saves.path(), false);
    let view = view_of(ChartKind::Runs, &run).expect("there");
    let names: Vec<&str> = view.figure.listed().iter().map(|series| &*series.name).collect();
    let expected = [
        "this run (test, seed 2): median",
        "this run (test, seed 2): best",
        "other, seed 7, halving: median",
        "other, seed 7, halving: best",
    ];
    assert_eq!(names, expected);
    assert_eq!(view.figure.table().len(), 1 + 2, "two generations of both");
    assert_eq!(view.hits[0].len(), 4);

    let saves = tempfile::tempdir().expect("a folder");
    let run = compared_run(saves.path(), true);
    with(&run, ChartKind::Runs, 400.0, |harness| {
        assert!(harness.query_by_label_contains("log.jsonl: damaged").is_some());
    });
}

#[test]
fn a_clicked_snake_is_found_with_the_fitness_of_its_hover_text() {
    let run = explored_run();
    for kind in [ChartKind::Spread, ChartKind::Ancestors, ChartKind::Parents] {
        let view = view_of(kind, &run).expect("explored");
        for hit in view.hits[0].iter().take(12) {
            let Some(Pick::Individual(place)) = hit.pick else { panic!("{}", hit.words()) };
            let champion = run.individual(place).expect("remembered");
            let fitness = format!("{:.2} m", champion.evaluation.fitness);
            assert!(hit.words().contains(&fitness), "{kind:?}: {fitness} in {}", hit.words());
        }
    }
    assert!(run.individual(IndividualId { generation: 99, individual: 0 }).is_none());
}

/// Creates the reports of a long run, copied from the last report of a short one.
fn long_reports(generations: u32) -> Vec<snakes_lab::run::GenerationReport> {
    let run = explored_run();
    let last = run.reports.last().expect("explored");
    let of = |generation| {
        let mut report = last.clone();
        report.record.generation = generation;
        if let Some(statistics) = &mut report.record.statistics {
            statistics.best += f64::from(generation % 100) * 0.01;
        }
        report
    };
    (1..=generations).map(of).collect()
}

#[test]
fn ten_thousand_generations_are_downsampled_on_screen_but_not_in_the_table() {
    let reports = long_reports(10_000);
    let view = fitness::view(&Settings::default(), &reports);
    assert_eq!(view.figure.table().len(), 10_001);
    let points = view.drawn[0].iter().map(|drawn| drawn.points.len().max(drawn.area[0].len()));
    assert!(points.max().expect("series") <= downsample::MAX_POINTS + 2);
}

#[test]
fn a_long_name_in_a_legend_wraps() {
    let mut view = fitness::view(&Settings::default(), &long_reports(3));
    let figure = Arc::make_mut(&mut view.figure);
    figure.charts[0].series[0].name = "a run of a preset with quite a long name: median ".repeat(3);
    let harness = testing::panel([300.0, 700.0], |ui| draw::draw(ui, "long", &view, 400.0, &[]));
    assert_fits(&harness, 300.0);
}

#[test]
fn in_a_narrow_panel_axes_have_titles_with_units_and_a_legend_says_what_a_click_does() {
    let run = explored_run();
    let distance = "Distance of the middle block (m)";
    let of_point = "Click any point to replay that snake.";
    for (kind, texts) in [
        (ChartKind::Fitness, &[distance, "Generation", of_point][..]),
        (ChartKind::Spread, &["Snakes", distance, "Click a bar to replay its best snake."]),
        (ChartKind::Ancestors, &[distance, "Generation", of_point]),
        (ChartKind::Parents, &["Value within its range (0 lowest, 1 highest)", "Gene"]),
        (ChartKind::Front, &["Energy (kJ)", "Final distance (m)", of_point]),
        (ChartKind::Archive, &["Click a coloured cell to replay its snake."]),
        (ChartKind::Runs, &[distance, "Generation", "Point at a line to read it."]),
    ] {
        with(&run, kind, 365.0, |harness| {
            for text in texts {
                let found = harness.query_all_by_label(text).next();
                let rect = found.unwrap_or_else(|| panic!("{kind:?}: {text}")).rect();
                assert!(rect.width() < 360.0, "{kind:?}: {text} needs {rect:?}");
            }
            assert_fits(harness, 365.0);
        });
    }
}

#[test]
fn an_individual_in_a_lane_has_the_dot_of_that_lane() {
    let run = explored_run();
    let best = run.reports[1].champion.as_ref().expect("a healthy snake");
    let individual = best.origin.individual;
    let champion = Pick::Individual(IndividualId { generation: 2, individual });
    let view = view_of(ChartKind::Fitness, &run).expect("explored");
    for lane in [Some(3), None] {
        let shown = [ShownLane { champion, lane }];
        let harness = testing::panel([500.0, 500.0], |ui| {
            draw::draw(ui, "lanes", &view, 300.0, &shown);
        });
        let color = theme::of_context(&harness.ctx).lane_color(3);
        let is_dot = |shape: &egui::Shape| match shape {
            egui::Shape::Circle(circle) => {
                circle.fill == color && circle.radius == theme::LANE_DOT / 2.0
            }
            _ => false,
        };
        let dots = harness.output().shapes.iter().filter(|of| is_dot(&of.shape)).count();
        assert_eq!(dots, usize::from(lane.is_some()), "{lane:?}");
    }
}
