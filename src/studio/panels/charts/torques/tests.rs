//! Tests of the torques chart: free signals, waves, and the choice of the snake.

use super::*;
use crate::studio::state::current_run::explored_run;
use snakes_core::evolve::{Champion, IndividualId, Parents};
use snakes_core::genome::{ControllerGenes, ControllerKind};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::shipped_champion;

fn subject(kind: ControllerKind, individual: u32, trial: &Trial) -> Subject {
    let space = snakes_core::genome::GenomeSpace { controller: kind, ..Default::default() };
    let mut rng = stream(1, 1, individual, Purpose::Birth);
    let genome = Arc::new(space.random_genome(trial.genome_shape(), &mut rng));
    let name = snake_of_generation(IndividualId { generation: 1, individual });
    Subject::new(name, genome, trial, |genome| Rollout::new(genome, trial))
}

#[test]
fn signal_torques_hold_until_the_next_point() {
    let trial = Trial { duration_s: 1.0, ..Trial::default() };
    let child = subject(ControllerKind::Signal, 0, &trial);
    let parent = subject(ControllerKind::Signal, 1, &trial);
    let ControllerGenes::Signal(signals) = &child.genome.controller else { panic!("a signal") };
    let view = figure(&child, Some(&parent));
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
    let child = Some(subject(ControllerKind::Wave, 0, &trial));
    let mut torques = TorqueComparison { child, ..TorqueComparison::default() };
    let view = computed(&mut torques);
    let chart = &view.figure.charts[0];
    let names: Vec<&str> = chart.series.iter().map(|series| series.name.as_str()).collect();
    assert_eq!(names, ["bend", "twist"], "without a parent, no dashes");
    let Shape::Line(bend) = &chart.series[0].shape else { panic!("a line") };
    assert_eq!(bend.len(), trial.steps() as usize);
    assert!(bend.iter().any(|point| point[1].abs() > 1.0));
    assert!(view.figure.note.contains("No parent is known"), "{}", view.figure.note);
}

/// Waits until the torques are computed, and returns the charts.
fn computed(torques: &mut TorqueComparison) -> ChartView {
    for subject in [&mut torques.child, &mut torques.parent].into_iter().flatten() {
        subject.lookahead.iter_mut().for_each(Lookahead::wait);
    }
    torques.view().expect("computed").clone()
}

#[test]
fn the_torques_are_those_of_the_selected_snake_and_its_parent() {
    let run = explored_run();
    let latest = run.exploration().expect("explored").generation.clone().expect("this session's");
    // The genomes of some parents are not kept.
    let first = |parents: &Parents| parents.ids().next().filter(|of| run.genome_of(*of).is_some());
    let mut children = (0..).zip(&latest.parents);
    let child = children.find_map(|(individual, parents)| Some((individual, first(parents)?)));
    let (individual, parent) = child.expect("a snake with a parent");
    let child = IndividualId { generation: latest.number, individual };
    let staged = |place| {
        let champion: Champion = run.individual(place).expect("kept");
        StagedChampion::from_run(&champion, run.number)
    };
    let mut torques = TorqueComparison::default();
    torques.update(&run, Some(&staged(child))).expect("a snake");
    let figure = computed(&mut torques).figure;
    assert_eq!(figure.title, format!("Torques: {}", snake_of_generation(child)));
    let of_parent = format!("its parent, {}", snake_of_generation(parent));
    assert!(figure.note.contains(&of_parent), "{}", figure.note);
    torques.update(&run, Some(&staged(parent))).expect("a snake");
    let figure = computed(&mut torques).figure;
    assert_eq!(figure.title, format!("Torques: {}", snake_of_generation(parent)));
}

#[test]
fn a_snake_of_a_file_is_named_and_shown_instead_of_the_best_of_the_run() {
    let run = explored_run();
    let loaded = shipped_champion().expect("well formed");
    let staged = StagedChampion::from_file(&loaded, 0, "climber");
    let mut torques = TorqueComparison::default();
    torques.update(&run, Some(&staged)).expect("a snake");
    let view = computed(&mut torques);
    assert_eq!(view.figure.title, "Torques: climber");
    let lasts_s = *view.figure.charts[0].x.range.end();
    assert_eq!(lasts_s, f64::from(loaded.champion.trial.duration_s), "its own trial");

    let low = Trial { duration_s: 2.0, ..loaded.champion.trial.clone() };
    let changed = staged.in_world(&low, "duration 2 s".to_owned());
    torques.update(&run, Some(&changed)).expect("a snake");
    let view = computed(&mut torques);
    assert_eq!(view.figure.title, "Torques: climber with duration 2 s");
    assert_eq!(*view.figure.charts[0].x.range.end(), 2.0, "the world in which it is shown");

    torques.update(&run, None).expect_err("no snake");
}
