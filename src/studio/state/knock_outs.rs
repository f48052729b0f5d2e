//! Race of one champion with copies that each lack one thing, to find out what its climb needs.

use super::lineup::race_of;
use crate::studio::stage::Show;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::schema::PerPart;
use snakes_core::score::{AgentSettings, Evaluation, ExamEnd};

/// Creates a race of the champion with copies of it. In each copy, the muscles of one joint, or those of all joints for one kind of
/// motion, have no torque.
///
/// # Errors
/// The settings decide no torque of this snake's joints; the error is a sentence for the user.
pub(crate) fn knock_outs(champion: &StagedChampion) -> Result<Show, String> {
    let joints = champion.body().joints.len();
    let without = |name: String, weaken: &dyn Fn(&mut AgentSettings)| {
        let mut trial = champion.trial().clone();
        weaken(&mut trial.agent);
        champion.in_world(&trial, name)
    };
    let none = || PerPart::All(0.0);
    let by_motion = [
        without(format!("{NO}bending"), &|agent| agent.max_bend_torque_nm = none()),
        without(format!("{NO}twisting"), &|agent| agent.max_twist_torque_nm = none()),
    ];
    let by_joint = (0..joints).map(|joint| {
        without(format!("joint {}{LIMP}", joint + 1), &|agent| {
            for torque in [&mut agent.max_bend_torque_nm, &mut agent.max_twist_torque_nm] {
                let kept = |other| if other == joint { 0.0 } else { torque.at(other) };
                *torque = PerPart::Each((0..joints).map(kept).collect());
            }
        })
    });
    let has_lost = |staged: &StagedChampion| staged.body() != champion.body();
    let lacking = by_motion.into_iter().chain(by_joint);
    let lacking = lacking.filter(|staged| has_lost(staged) && staged.check().is_ok());
    let whole = champion.simulated().named("nothing missing".to_owned());
    let refusal = "The torques of this snake's joints are in its genes, so none can be taken away.";
    race_of(std::iter::once(whole).chain(lacking), refusal)
}

/// Share of the whole snake's way below which a loss counts as small.
const SMALL_LOSS: f32 = 0.1;

/// Says which lack costs the climb most, in a race of [`knock_outs`]; `None` in any other race. The result of each copy is computed in the
/// background, and the sentence waits for it.
pub(crate) fn answer_in_words(lanes: &[&Lane]) -> Option<String> {
    let (whole, copies) = lanes.split_first()?;
    if copies.is_empty() || !copies.iter().all(|copy| lacks_only_torque(copy, whole)) {
        return None;
    }
    let ends: Option<Vec<Evaluation>> =
        lanes.iter().map(|lane| Some(*lane.history()?.evaluation())).collect();
    let Some(ends) = ends else {
        return Some("The answer comes as soon as each copy is simulated to its end.".to_owned());
    };
    let ways: Vec<f32> =
        lanes.iter().zip(&ends).map(|(of, end)| ExamEnd::way_of(end, of.trial())).collect();
    if ways[0] <= 0.0 {
        return Some("The complete snake gets nowhere, so this race shows nothing.".to_owned());
    }
    let is_small = |copy: &usize| ways[0] - ways[*copy] < SMALL_LOSS * ways[0];
    let all = 1..lanes.len();
    let worst = all.clone().min_by(|a, b| ways[*a].total_cmp(&ways[*b]))?;
    if is_small(&worst) {
        return Some(
            "It can do without any one of these: no single loss costs a tenth of the way."
                .to_owned(),
        );
    }
    let genome = &whole.staged.champion().genome;
    let result = |lane: usize| match ways[lane] {
        _ if let Some(reason) = ends[lane].disqualified => reason.words().to_owned(),
        0.0 => "stays at the start".to_owned(),
        _ => lanes[lane].trial().result_in_words(genome, &ends[lane]),
    };
    let lacks = |lane: usize| {
        let label = lanes[lane].staged.label();
        label.trim_start_matches(NO).trim_end_matches(LIMP)
    };
    let mut answer = format!(
        "It needs {} most. With it: {}. Without: {}.",
        lacks(worst),
        result(0),
        result(worst)
    );
    let small: Vec<&str> = all.filter(is_small).map(lacks).collect();
    if !small.is_empty() {
        answer += &format!(" It can do without any one of these alone: {}.", small.join(", "));
    }
    Some(answer + " Joint 1 is behind the head.")
}

/// Beginning of the label of a copy that lacks a kind of motion.
const NO: &str = "no ";
/// End of the label of a copy that lacks a joint's torque.
const LIMP: &str = " limp";

/// Returns whether a lane shows the snake of `whole` in its world, but some of its joints have no torque.
fn lacks_only_torque(lane: &Lane, whole: &Lane) -> bool {
    let torques = |lane: &Lane| -> Vec<f32> {
        let joints = lane.body.joints.iter();
        joints.flat_map(|joint| [joint.max_bend_torque_nm, joint.max_twist_torque_nm]).collect()
    };
    let pairs: Vec<(f32, f32)> = torques(lane).into_iter().zip(torques(whole)).collect();
    let is_part = pairs.iter().all(|(of_lane, of_whole)| *of_lane == 0.0 || of_lane == of_whole);
    // Trials are compared last, because this costs most, and every race asks in every frame.
    let is_same_world = || {
        let mut strengthened = lane.trial().clone();
        let agent = &whole.trial().agent;
        strengthened.agent.max_bend_torque_nm.clone_from(&agent.max_bend_torque_nm);
        strengthened.agent.max_twist_torque_nm.clone_from(&agent.max_twist_torque_nm);
        strengthened == *whole.trial()
    };
    is_part
        && pairs.iter().any(|(of_lane, of_whole)| of_lane != of_whole)
        && lane.staged.champion().genome == whole.staged.champion().genome
        && is_same_world()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::StageMode;
    use crate::studio::state::current_run::climber;
    use crate::studio::state::sweep::sweep;

    #[test]
    fn each_copy_lacks_one_joint_or_one_motion() {
        let show = knock_outs(&climber(0)).expect("a snake with joints");
        assert_eq!(show.mode, StageMode::Race);
        let labels: Vec<&str> = show.champions.iter().map(StagedChampion::label).collect();
        let expected =
            ["nothing missing", "no bending", "no twisting", "joint 1 limp", "joint 2 limp"];
        assert_eq!(labels[..5], expected);
        assert_eq!(labels.len(), 7);
        let bends = |lane: usize| -> Vec<bool> {
            let joints = show.champions[lane].body().joints;
            joints.iter().map(|joint| joint.max_bend_torque_nm > 0.0).collect()
        };
        assert_eq!(bends(1), [false; 4]);
        assert_eq!(bends(2), [true; 4]);
        assert_eq!(bends(4), [true, false, true, true]);
    }

    #[test]
    fn the_race_of_copies_answers_in_words_and_no_other_race_does() {
        let lanes_of = |show: Show| -> Vec<Lane> {
            (0..).zip(show.champions).map(|(number, staged)| Lane::new(staged, number)).collect()
        };
        let answer = |lanes: &[Lane]| answer_in_words(&lanes.iter().collect::<Vec<_>>());
        let mut lanes = lanes_of(knock_outs(&climber(0)).expect("a snake with joints"));
        assert!(answer(&lanes).is_some_and(|words| words.contains("as soon as")));
        lanes.iter_mut().for_each(Lane::finish_lookahead);
        let words = answer(&lanes).expect("an answer");
        let start =
            "It needs bending most. With it: stands on the landing. Without: stays at the start.";
        assert!(words.starts_with(start), "{words}");
        assert!(words.ends_with(" Joint 1 is behind the head."), "{words}");
        for field in ["trial.surface.friction", "trial.agent.max_bend_torque_nm"] {
            assert_eq!(answer(&lanes_of(sweep(&climber(0), field).expect("a number"))), None);
        }
    }
}
