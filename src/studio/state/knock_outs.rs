//! Race of one champion with copies that each lack one thing, to find out what its climb needs.

use super::lineup::race_of;
use crate::studio::stage::Show;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::schema::PerPart;
use snakes_core::score::AgentSettings;
use snakes_core::world::JointPlan;

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
        without("no bending".to_owned(), &|agent| agent.max_bend_torque_nm = none()),
        without("no twisting".to_owned(), &|agent| agent.max_twist_torque_nm = none()),
    ];
    let by_joint = (0..joints).map(|joint| {
        without(format!("joint {} limp", joint + 1), &|agent| {
            for torque in [&mut agent.max_bend_torque_nm, &mut agent.max_twist_torque_nm] {
                let kept = |other| if other == joint { 0.0 } else { torque.at(other) };
                *torque = PerPart::Each((0..joints).map(kept).collect());
            }
        })
    });
    let has_lost = |staged: &StagedChampion| {
        let torques = |of: &StagedChampion| {
            let body = of.body();
            let both = |joint: &JointPlan| [joint.max_bend_torque_nm, joint.max_twist_torque_nm];
            body.joints.iter().map(both).collect::<Vec<_>>()
        };
        torques(staged) != torques(champion)
    };
    let lacking = by_motion.into_iter().chain(by_joint);
    let lacking = lacking.filter(|staged| has_lost(staged) && staged.check().is_ok());
    let whole = champion.simulated().named("nothing missing".to_owned());
    let refusal = "The torques of this snake's joints are in its genes, so none can be taken away.";
    race_of(std::iter::once(whole).chain(lacking), refusal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::StageMode;
    use crate::studio::state::current_run::climber;

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
}
