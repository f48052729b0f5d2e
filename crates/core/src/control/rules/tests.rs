//! Tests of waves chosen by rules.

use super::*;
use crate::control::perception::{JointSenses, LimbSenses};
use crate::control::{ActiveSenses, ControlLoop};
use crate::evolve::Champion;
use crate::genome::controllers::RULE_SENSES;
use crate::genome::{ControllerGenes, ControllerKind, Genome};
use crate::save::shipped_champion;
use crate::score::{Rollout, Trial, evaluate};
use crate::world::PhysicsSettings;

fn genome(individual: u32, trial: &Trial) -> Genome {
    trial.random_genome_of(ControllerKind::Rules, individual)
}

fn genes(genome: &Genome) -> RuleGenes {
    let ControllerGenes::Rules(genes) = &genome.controller else { panic!("rules") };
    genes.clone()
}

fn rule(condition: &str, group: JointGroup, wave: u32, strength: f32) -> WaveRule {
    let condition = condition.parse().expect("a condition");
    WaveRule { condition, group, wave, strength }
}

/// Returns an observation of a snake of five limbs that senses nothing except what `change` sets.
fn moment(steps_per_s: u32, change: impl FnOnce(&mut Perception)) -> Observation {
    let physics = PhysicsSettings { steps_per_s, ..PhysicsSettings::default() };
    let mut observation = Observation::at_start(&physics);
    observation.joints = vec![Default::default(); 4];
    let perception = &mut observation.perception;
    perception.joints = vec![JointSenses::default(); 4];
    perception.limbs = vec![LimbSenses { gap: 1.0, ..LimbSenses::default() }; 5];
    change(perception);
    observation
}

#[test]
fn each_bit_says_what_its_name_says() {
    let of = |change: fn(&mut Perception)| bits(&moment(60, change).perception, 0.0);
    let set = |bits: u32| -> Vec<&str> {
        let is_set = |index: &usize| bits >> index & 1 == 1;
        (0..RULE_SENSES.len()).filter(is_set).map(|index| RULE_SENSES[index][0]).collect()
    };
    assert_eq!(of(|_| ()), 0);
    for (change, expected) in [
        ((|p| p.limbs[0].gap = 0.49) as fn(&mut Perception), vec!["head gap under 1 m"]),
        (|p| p.limbs[0].gap = 0.12, vec!["head gap under 1 m", "head gap under 0.25 m"]),
        (|p| p.limbs[0].gap = 0.5, vec![]),
        (|p| p.limbs[0].step_up = 0.06, vec!["step up over 0.05 m"]),
        (|p| p.limbs[0].step_up = 0.61, vec!["step up over 0.05 m", "step up over 0.6 m"]),
        (|p| p.limbs[0].pitch = 0.31, vec!["head pitched up"]),
        (|p| p.limbs[0].pitch = -0.9, vec![]),
        (|p| p.limbs[0].blocked = 0.51, vec!["head blocked"]),
        (|p| p.limbs[2].touch = 1.0, vec!["middle touches"]),
        (|p| p.limbs[4].touch = 1.0, vec!["tail touches"]),
        (|p| p.limbs[2].gap = 0.4, vec!["middle gap under 1 m"]),
    ] {
        assert_eq!(set(of(change)), expected);
    }
    let moved = |way_m| set(bits(&moment(60, |_| ()).perception, way_m));
    assert_eq!((moved(0.11), moved(0.1), moved(-3.0)), (vec!["moved ahead"], vec![], vec![]));
}

#[test]
fn the_strongest_rule_that_holds_decides_and_of_equals_the_lowest() {
    use JointGroup::{All, Front, Rear};
    let rules = [
        rule("1#########", All, 2, 0.5),
        rule("##########", Rear, 3, 0.5),
        rule("1#0#######", Front, 4, 0.7),
        rule("#######1##", All, 2, 0.9),
    ];
    let of = |bits| HALVES.map(|half| chosen_wave(&rules, bits, half) + 1);
    assert_eq!(of(0b0), [1, 3], "no rule for the front: the first wave");
    assert_eq!(of(0b1), [4, 2], "the third is stronger in front, the first is lower behind");
    assert_eq!(of(0b101), [2, 2], "the third does not hold");
    assert_eq!(of(0b1000_0001), [2, 2], "the last is the strongest");
}

#[test]
fn the_choice_that_is_shown_is_the_one_that_was_made() {
    use JointGroup::{All, Front, Rear};
    let mut genes = genes(&genome(0, &Trial::default()));
    genes.rules = vec![
        rule("1#########", All, 2, 0.5),
        rule("##########", Rear, 3, 0.5),
        rule("1#0#######", Front, 4, 0.7),
        rule("#######1##", All, 2, 0.9),
    ];
    let mut follower = RuleFollower::new(genes.clone());
    let mut near = moment(60, |senses| senses.limbs[0].gap = 0.2);
    near.step = 45;
    assert_eq!(follower.choice(&near, 1), None, "it has not decided");
    follower.act(&near, &mut [JointTorque::default(); 4]);
    let shown = follower.choice(&near, 1).expect("decided");
    assert_eq!(shown.of_joints, [3, 3, 1, 1]);
    let rules: Vec<_> = shown.rules.iter().map(|rule| (rule.holds, rule.decides)).collect();
    assert_eq!(rules, [(true, Some(Rear)), (true, None), (true, Some(Front)), (false, None)]);
    let shares: Vec<f32> = shown.waves.iter().map(|wave| wave.share).collect();
    assert_eq!(shares, [0.0, 0.5, 0.0, 0.5]);
    for (shown, waves) in shown.waves.iter().zip(&genes.library) {
        assert_eq!(shown.targets, waves.joints[1]);
        let periods = near.periods(waves.frequency_hz);
        let (now, then) =
            (shown.targets.bend.at(shown.phase.into()), waves.joints[1].bend.at(periods));
        assert!((0.0..1.0).contains(&shown.phase) && (now - then).abs() < 1e-4, "{now} {then}");
    }
    // Senses between decisions do not change the displayed choice.
    let mut later = moment(60, |_| ());
    later.step = 46;
    follower.act(&later, &mut [JointTorque::default(); 4]);
    assert_eq!(follower.choice(&later, 1).expect("decided").rules, shown.rules);
}

#[test]
fn decisions_fall_on_whole_numbers_of_their_period_at_every_step_rate() {
    let trial = Trial::default();
    let mut genes = genes(&genome(0, &trial));
    genes.rules = vec![rule("######1###", JointGroup::All, 2, 1.0)];
    for steps_per_s in [20, 30, 59, 60, 61, 120, 240, 1000] {
        let mut follower = RuleFollower::new(genes.clone());
        let mut torques = [JointTorque::default(); 4];
        let mut decided = Vec::new();
        for step in 0..steps_per_s * 2 {
            let mut observation = moment(steps_per_s, |_| ());
            observation.step = step;
            let before: u32 = follower.uses.counts().iter().sum();
            follower.act(&observation, &mut torques);
            if follower.uses.counts().iter().sum::<u32>() > before {
                decided.push(step);
            }
        }
        let expected: Vec<u32> = (0..8).map(|number| (number * steps_per_s).div_ceil(4)).collect();
        assert_eq!(decided, expected, "{steps_per_s} steps per second");
        assert_eq!(follower.uses.counts(), [16, 0, 0, 0], "both halves each time");
    }
}

#[test]
fn the_target_passes_from_one_wave_to_the_next_within_a_fifth_of_a_second() {
    let trial = Trial::default();
    let mut genes = genes(&genome(0, &trial));
    // With a stiffness of 1 and joints at rest in the middle, the torque is the target.
    (genes.stiffness_nm_per_rad, genes.servo_damping_nms_per_rad) = (1.0, 0.0);
    for (waves, offset) in genes.library.iter_mut().zip([0.0, 1.0, -1.0, 0.5]) {
        for wave in waves.all_mut() {
            (wave.offset, wave.harmonics[0].amplitude) = (offset, 0.0);
        }
    }
    genes.rules = vec![rule("######1###", JointGroup::Front, 2, 1.0)];
    let mut follower = RuleFollower::new(genes);
    let mut targets = Vec::new();
    for step in 0..60 {
        let mut observation = moment(60, |p| p.limbs[2].touch = 1.0);
        // A touch begins at the second decision and ends before the fourth.
        if !(10..40).contains(&step) {
            observation.perception.limbs[2].touch = 0.0;
        }
        observation.step = step;
        let mut torques = [JointTorque::default(); 4];
        follower.act(&observation, &mut torques);
        assert_eq!((torques[0], torques[2]), (torques[1], torques[3]));
        assert_eq!((torques[2].bend_nm, torques[2].twist_nm), (0.0, 0.0), "the rear half");
        targets.push(torques[0].bend_nm);
    }
    for (step, expected) in
        [(0, 0.0), (15, 0.0), (18, 0.25), (21, 0.5), (27, 1.0), (44, 1.0), (48, 0.75), (57, 0.0)]
    {
        assert!((targets[step] - expected).abs() < 1e-6, "{} at {step}", targets[step]);
    }
    assert_eq!(follower.uses.counts(), [6, 2, 0, 0]);
}

#[test]
fn with_one_wave_in_all_places_rules_leave_the_trace_of_a_gait() {
    let Champion { genome, trial, evaluation, .. } =
        shipped_champion().expect("well formed").champion;
    let ControllerGenes::Gait(gait) = genome.controller.clone() else { panic!("a gait") };
    let rules = RuleGenes {
        stiffness_nm_per_rad: gait.stiffness_nm_per_rad,
        servo_damping_nms_per_rad: gait.servo_damping_nms_per_rad,
        library: vec![gait.waves; 2],
        rules: vec![rule("1#########", JointGroup::All, 2, 1.0)],
    };
    let genome = Genome { controller: ControllerGenes::Rules(rules), ..genome };
    let found = evaluate(&genome, &trial);
    assert_eq!(found.trace_hash, evaluation.trace_hash);
    let uses = found.behaviour.and_then(|behaviour| behaviour.wave_uses).expect("counted");
    let decisions = (trial.duration_s * 4.0) as u32;
    assert_eq!(uses.counts().iter().sum::<u32>(), 2 * decisions);
    assert!(uses.counts().iter().all(|count| *count > 10), "{uses:?}");
}

#[test]
fn a_clone_decides_as_the_original_does() {
    let trial = Trial { duration_s: 3.0, start_y_m: -2.0, ..Trial::default() };
    for individual in 0..4 {
        let mut rollout = Rollout::new(&genome(individual, &trial), &trial);
        // The clone is made within a blend, with a part of a distance covered.
        (0..22).for_each(|_| assert!(rollout.advance()));
        let mut copy = rollout.clone();
        while rollout.advance() {}
        while copy.advance() {}
        assert_eq!(copy.evaluation(), rollout.evaluation());
    }
}

#[test]
fn without_senses_the_rules_never_choose_anew() {
    let mut changing = 0;
    for individual in 0..12 {
        let mut trial = Trial { duration_s: 4.0, start_y_m: -2.0, ..Trial::default() };
        let genome = genome(individual, &trial);
        let waves = |trial: &Trial| {
            let world = Rollout::new(&genome, trial);
            let plan = trial.world_plan(&genome);
            let mut control = ControlLoop::new(&genome, &plan, trial.agent.senses);
            let mut world = world.simulation().clone();
            let mut torques = vec![JointTorque::default(); world.joint_states().len()];
            for step in 0..trial.steps() {
                control.act(step, &world, &mut torques);
                if world.step(&torques).is_err() {
                    break;
                }
            }
            let uses = control.wave_uses().expect("rules");
            uses.counts().iter().filter(|count| **count > 0).count()
        };
        changing += usize::from(waves(&trial) > 2);
        trial.agent.senses = ActiveSenses::NONE;
        // Each half has a wave.
        assert!(waves(&trial) <= 2);
    }
    assert!(changing >= 3, "with senses, {changing} of 12 use more than one wave for each half");
}
