//! Tests of the exam's suites.

use super::*;
use crate::genome::StairsGenome;
use crate::schema::Choices;
use crate::score::PerPart;

mod endings;

fn end(steps: u32, way: f32, landed_s: Option<f32>) -> ExamEnd {
    let has_landed = landed_s.is_some();
    ExamEnd { steps, way, landed_s, has_landed, is_disqualified: false, ..ExamEnd::CRASHED }
}

#[test]
fn stairs_with_ramps_nosings_and_steps_down_have_allowed_conditions() {
    let plain = || StairsGenome { steps: 8, ..StairsGenome::default() };
    for genome in [
        StairsGenome { ramp: 1.0, ..plain() },
        StairsGenome { nosing_m: 0.3, missing: 4, ..plain() },
        StairsGenome { landing: 4, down: 4, ..plain() },
    ] {
        let trial = Trial { stairs: genome.stairs(), ..Trial::default() };
        for &suite in ExamSuite::OPTIONS {
            for condition in suite.conditions(&trial) {
                condition.check().unwrap_or_else(|error| panic!("{}: {error}", condition.label));
            }
        }
    }
}

#[test]
fn every_condition_is_one_of_an_allowed_trial_and_differs_from_all_others() {
    let trial = Trial { duration_s: 15.0, ..Trial::default() };
    for &suite in ExamSuite::OPTIONS {
        let conditions = suite.conditions(&trial);
        let expected = match suite {
            ExamSuite::StepRate => 5,
            ExamSuite::Surprise => 30,
            ExamSuite::HeldOut => 60,
            ExamSuite::Engine => 40,
            _ => 100,
        };
        assert_eq!(conditions.len(), expected, "{suite:?}");
        for (index, condition) in conditions.iter().enumerate() {
            condition.trial.check().expect(&condition.label);
            let same = |other: &&ExamCondition| {
                other.label == condition.label
                    || (&other.trial, other.perturbation)
                        == (&condition.trial, condition.perturbation)
            };
            let earlier = conditions[..index].iter().find(same);
            assert_eq!(earlier, None, "{suite:?}: {}", condition.label);
        }
    }
}

#[test]
fn the_surprising_step_is_higher_and_the_others_are_not() {
    let trial = Trial::default();
    let conditions = ExamSuite::Surprise.conditions(&trial);
    let PerPart::Each(rises_m) = &conditions[0].trial.stairs.rise_m else { panic!("one for all") };
    assert_eq!(rises_m.len(), 10);
    assert_eq!((rises_m[3], rises_m[2], rises_m[4]), (0.7, 0.5, 0.5));
    let PerPart::Each(rises_m) = &conditions[29].trial.stairs.rise_m else { panic!("one for all") };
    assert_eq!(rises_m[8], 0.7, "the ninth of ten");
}

#[test]
fn a_suite_counts_landings_medians_and_the_share_of_the_way() {
    let own = end(10, 0.8, Some(12.0));
    let ends = [end(10, 0.8, Some(11.0)), end(4, 0.4, None), end(2, 0.2, None), end(0, 0.0, None)];
    let conditions = ExamSuite::StepRate.conditions(&Trial::default());
    let trials = SuiteResult::of(ExamSuite::Trials, &own, &conditions[..4], &ends);
    assert_eq!((trials.trials, trials.landed, trials.median_steps), (4, 1, 3.0));
    assert!((trials.kept - 0.375).abs() < 1e-6 && trials.each.is_empty(), "{trials:?}");
    let rates = SuiteResult::of(ExamSuite::StepRate, &own, &conditions[..4], &ends);
    assert_eq!((rates.kept, rates.each[1].0.as_str()), (0.0, "120 Hz"));
    assert!((rates.each[1].1 - 0.5).abs() < 1e-6);
    let none = SuiteResult::of(ExamSuite::Trials, &end(0, 0.0, None), &conditions[..4], &ends);
    assert_eq!(none.kept, 0.0, "of a way that is none, none is kept");
}

#[test]
fn a_shoved_snake_recovers_if_it_lands_at_most_five_seconds_later() {
    let own = end(10, 1.0, Some(10.0));
    let ends = [9.0, 15.0, 15.1].map(|landed_s| end(10, 1.0, Some(landed_s)));
    let conditions = ExamSuite::Shove.conditions(&Trial::default());
    let result = SuiteResult::of(ExamSuite::Shove, &own, &conditions[..3], &ends);
    assert_eq!(result.landed, 2);
    let lost = SuiteResult::of(ExamSuite::Shove, &end(9, 0.9, None), &conditions[..3], &ends);
    assert_eq!(lost.landed, 0, "it does not land undisturbed");
}

#[test]
fn the_way_counts_up_to_the_landing_and_beside_the_stairs_to_the_first_riser() {
    let stairs = Stairs::default();
    let at = |y_m: f32, steps| way(y_m, steps, &stairs, -7.0);
    assert_eq!(at(7.0, 2), 0.5);
    assert_eq!(at(30.0, 10), 1.0);
    assert!((at(30.0, 0) - 10.0 / 28.0).abs() < 1e-6, "behind the stairs");
    assert_eq!(at(-9.0, 0), 0.0, "backwards");
}

#[test]
fn the_held_out_stairs_keep_the_place_of_the_champions_own_and_count_whole_bodies() {
    let mut own = Trial::default();
    own.stairs.first_riser_y_m = 4.0;
    let conditions = ExamSuite::HeldOut.conditions(&own);
    assert_eq!(conditions.len(), 60);
    for condition in &conditions {
        condition.check().expect("allowed");
        assert_eq!(condition.trial.stairs.first_riser_y_m, 4.0, "{}", condition.label);
    }
    // The middle limb lands on all stairs, the whole body only on the first staircase of each class.
    let ends: Vec<ExamEnd> = (0..60)
        .map(|index| {
            let arrived_s = (index % 15 == 0).then_some(12.0);
            ExamEnd { arrived_s, has_landed: true, ..end(10, 1.0, Some(9.0)) }
        })
        .collect();
    let result = SuiteResult::of(ExamSuite::HeldOut, &ends[0], &conditions, &ends);
    assert_eq!((result.landed, result.trials), (4, 60));
    let classes: Vec<(&str, u32, u32)> =
        ["equal", "irregular", "house", "nosing"].map(|class| (class, 1, 15)).to_vec();
    assert_eq!(result.classes(), classes);
}

#[test]
fn r13_other_programs_read_the_held_out_stairs_of_the_exam() {
    let conditions = ExamSuite::HeldOut.conditions(&Trial::default());
    let lines = conditions.iter().map(|condition| {
        let name = serde_json::to_string(&condition.label).expect("a text");
        let stairs = serde_json::to_string(&condition.trial.stairs).expect("numbers");
        format!("{{\"name\": {name}, \"stairs\": {stairs}}}\n")
    });
    let expected: String = lines.collect();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../python/baselines/held_out.jsonl");
    let found = std::fs::read_to_string(path).expect("the file of held-out stairs");
    assert!(found == expected, "{path} should contain:\n{expected}");
}
