//! The state of decisions at a moment, for display: the value of each choice, and the rules that predict it.

use crate::genome::controllers::{BitNames, bits_in_words};
use crate::learn::classifiers::{Condition, Xcs, Zcs};

/// A decision, with the values and rules by which it was taken.
#[derive(Debug, Clone, PartialEq)]
pub struct DecisionActivity {
    /// Joint that decides, if each joint decides for itself; the first joint is 0. `None` if the whole snake decides.
    pub joint: Option<usize>,
    /// Situation in words.
    pub situation: String,
    /// Value of each posture, or of each bend of the joint, in this situation.
    pub postures: Vec<PostureWorth>,
    /// Index of the chosen posture in the list.
    pub chosen: usize,
    /// Posture before the decision, which cannot be chosen again; `None` where it can.
    pub barred: Option<usize>,
    /// Rules in order of birth; empty for a table.
    pub rules: Vec<ActiveRule>,
}

/// The value of a posture in a situation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PostureWorth {
    /// Name of the posture.
    pub name: &'static str,
    /// Value in a table, payoff that rules predict, or strength of the rules; `None` if no rule advises the posture.
    pub worth: Option<f32>,
    /// How often a table has tried the posture in this situation, or how many matching rules advise it.
    pub count: u32,
}

/// A rule of a population.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveRule {
    /// Condition on the situations to which the rule applies.
    pub condition: Condition,
    /// Names of the bits of situations.
    pub names: &'static BitNames,
    /// Index of the posture that the rule advises.
    pub posture: usize,
    /// Payoff that the rule predicts, or its strength.
    pub worth: f32,
    /// Accuracy of the rule relative to others, 0 to 1; `None` for rules that are kept for their strength.
    pub fitness: Option<f32>,
    /// Number of updates of the rule; `None` for rules that do not count them.
    pub experience: Option<u32>,
    /// Whether the rule matches the situation.
    pub matches: bool,
    /// Whether the rule matches the situation and advises the chosen posture.
    pub decides: bool,
}

/// The situation and the action for which rules are displayed.
#[derive(Debug, Clone, Copy)]
pub(super) struct RulePlace {
    /// Bits of the situation.
    pub bits: u32,
    /// Names of the bits.
    pub names: &'static BitNames,
    /// Index of the chosen action; `None` if none was chosen.
    pub chosen: Option<usize>,
}

impl RulePlace {
    /// Returns the rules of an XCS, in order of birth.
    pub fn rules_of_xcs(&self, system: &Xcs) -> Vec<ActiveRule> {
        let rules = system.rules.iter().map(|rule| ActiveRule {
            fitness: Some(rule.fitness),
            experience: Some(rule.experience),
            ..self.rule(rule.condition, rule.action, rule.prediction)
        });
        rules.collect()
    }

    /// Returns the rules of a ZCS, in order of birth.
    pub fn rules_of_zcs(&self, system: &Zcs) -> Vec<ActiveRule> {
        let rules = system.rules.iter();
        rules.map(|rule| self.rule(rule.condition, rule.action, rule.strength)).collect()
    }

    fn rule(&self, condition: Condition, action: u16, worth: f32) -> ActiveRule {
        let (posture, matches) = (usize::from(action), condition.matches(self.bits));
        ActiveRule {
            condition,
            names: self.names,
            posture,
            worth,
            fitness: None,
            experience: None,
            matches,
            decides: matches && Some(posture) == self.chosen,
        }
    }
}

impl ActiveRule {
    /// Returns the value of each action with its name, and the number of matching rules that advise it.
    pub(super) fn worths(
        names: &[&'static str],
        worths: Vec<Option<f32>>,
        rules: &[Self],
    ) -> Vec<PostureWorth> {
        let advising = |index: usize| {
            rules.iter().filter(|rule| rule.matches && rule.posture == index).count() as u32
        };
        let each = names.iter().zip(worths).enumerate();
        each.map(|(index, (name, worth))| PostureWorth { name, worth, count: advising(index) })
            .collect()
    }

    /// Describes the rule's condition in words, such as "riser at the middle, not moving".
    pub fn words(&self) -> String {
        bits_in_words(self.names, self.condition.care(), self.condition.value(), "always")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Activity;
    use crate::control::activity::tests::played;
    use crate::genome::controllers::{
        JOINT_BENDS, JOINT_BITS, JointDecisionGenes, POSTURES, Policy, SITUATION_BITS,
    };
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::learn::classifiers::{EpisodeEnd, RecordedDecision, XcsSettings, ZcsSettings};
    use crate::rng::{Purpose, stream};
    use std::sync::Arc;

    #[test]
    fn decisions_show_the_worth_of_all_postures_and_the_rules_that_match() {
        let mut rng = stream(1, 1, 1, Purpose::Learn);
        let zcs = Zcs::new(ZcsSettings::default(), SITUATION_BITS.len(), POSTURES.len(), &mut rng);
        let xcs = Xcs::new(XcsSettings::default(), SITUATION_BITS.len(), POSTURES.len());
        let policies = [
            Policy::default(),
            Policy::Zcs(Arc::new(zcs.expect("allowed"))),
            Policy::Xcs(Arc::new(xcs.expect("allowed"))),
        ];
        for (policy, rules) in policies.into_iter().zip([0, 400, 0]) {
            let rollout = played(ControllerKind::Decisions, 20, |genome| {
                if let ControllerGenes::Decisions(genes) = &mut genome.controller {
                    genes.policy = policy.clone();
                }
            });
            let Some(Activity::Decision(decision)) = rollout.activity(0) else { panic!("one") };
            assert_eq!((decision.postures.len(), decision.rules.len()), (POSTURES.len(), rules));
            assert!(decision.situation.contains("head"), "{}", decision.situation);
            let advised: u32 = decision.postures.iter().map(|posture| posture.count).sum();
            let matching = decision.rules.iter().filter(|rule| rule.matches).count();
            assert_eq!(advised as usize, matching);
            let chosen = |rule: &&ActiveRule| rule.decides;
            assert!(
                decision
                    .rules
                    .iter()
                    .filter(chosen)
                    .all(|rule| { rule.matches && rule.posture == decision.chosen })
            );
        }
    }

    #[test]
    fn joint_decisions_show_the_worth_of_the_bends_of_a_joint() {
        let rollout = played(ControllerKind::JointDecisions, 20, |genome| {
            let ControllerGenes::JointDecisions(genes) = &mut genome.controller else { return };
            let settings = XcsSettings { wildcard_share: 1.0, ..XcsSettings::default() };
            let mut systems = JointDecisionGenes::empty_systems(&settings, 4).expect("allowed");
            let lesson = [RecordedDecision { bits: 0, action: 2, reward: 500.0 }];
            let mut rng = stream(1, 1, 1, Purpose::Learn);
            systems[3].learn(&lesson, EpisodeEnd::Terminal, &mut rng).expect("it fits");
            genes.systems = Arc::new(systems);
        });
        let decision = |joint| match rollout.activity(joint) {
            Some(Activity::Decision(decision)) => decision,
            other => panic!("{other:?}"),
        };
        let (first, last) = (decision(0), decision(3));
        assert_eq!((first.joint, first.rules.len(), first.chosen), (Some(0), 0, 0));
        assert_eq!(last.postures.iter().map(|bend| bend.name).collect::<Vec<_>>(), JOINT_BENDS);
        assert_eq!((last.rules.len(), JOINT_BENDS[last.chosen]), (3, "sag"));
        assert!(last.rules.iter().all(|rule| rule.matches && rule.names == JOINT_BITS));
        assert_eq!(last.rules.iter().filter(|rule| rule.decides).count(), 1);
    }
}
