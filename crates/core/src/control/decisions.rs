//! The controller with decisions: it chooses a posture four times a second, and records the experience.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;

use super::decision_clock::DecisionClock;
use super::network::servos;
use super::posture_choice::{best_posture, explored_posture};
use super::postures::bend;
use super::rewards::RewardMeter;
use super::servo::JointServos;
use super::situation::{SensedSituation, way_m};
use super::{
    ActiveRule, Activity, Controller, DecisionActivity, Observation, PostureWorth, RulePlace,
    Senses,
};
use crate::genome::controllers::{
    DECISIONS_PER_S, DecisionGenes, Explorer, POSTURES, Policy, SITUATION_BITS,
};
use crate::learn::Episode;
use crate::learn::classifiers::{EpisodeEnd, RecordedDecision};
use crate::learn::q_table::{Next, Transition};
use crate::world::JointTorque;

/// Number of ticks of 1/60 s for which a decision lasts. The learner's discount is per tick, whatever the step rate.
const TICKS: u16 = 60 / DECISIONS_PER_S as u16;
/// Index of the posture before the first decision: straight.
const FIRST_POSTURE: usize = 0;

/// Decides by a learned policy. An explorer sometimes decides at random, and learns in its own copy of a table.
#[derive(Debug, Clone)]
pub struct DecisionController {
    genes: DecisionGenes,
    servo: JointServos,
    rng: Option<ChaCha8Rng>,
    clock: DecisionClock,
    /// Situation in which the present decision was taken; `None` before the first decision.
    at: Option<DecisionPoint>,
    /// Posture of the present decision; `previous` is the posture before it.
    action: usize,
    previous: usize,
    /// Bends of each joint at the last decision and the target bends of this decision, in radians.
    bends_rad: Vec<[f32; 2]>,
    moved_m: f32,
    rewards: RewardMeter,
    /// Experience so far for a table; `decisions` is the experience for rules.
    transitions: Vec<Transition>,
    decisions: Vec<RecordedDecision>,
    /// End of the episode, after which nothing more is learned; `None` during the episode.
    end: Option<EpisodeEnd>,
}

/// A situation, as a state of a table and as bits of rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct DecisionPoint {
    situation: SensedSituation,
    state: u32,
    bits: u32,
}

impl DecisionController {
    /// Creates the controller before the first step.
    pub fn new(genes: DecisionGenes) -> Self {
        Self {
            servo: servos(&genes.servo),
            rng: genes.explorer.as_ref().map(Explorer::rng),
            clock: DecisionClock::default(),
            at: None,
            action: FIRST_POSTURE,
            previous: FIRST_POSTURE,
            bends_rad: vec![[0.0; 2]; genes.joints as usize],
            moved_m: 0.0,
            rewards: RewardMeter::default(),
            transitions: Vec::new(),
            decisions: Vec::new(),
            end: None,
            genes,
        }
    }

    /// Ends the present decision, and takes the next one.
    fn decide(&mut self, observation: &Observation) {
        let place = self.place(observation);
        self.close(Some(place));
        self.rewards.begin_decision();
        self.moved_m = 0.0;
        self.previous = self.action;
        self.action = self.choice(&place);
        self.at = Some(place);
        let joints = self.bends_rad.len();
        for (joint, [from, to]) in self.bends_rad.iter_mut().enumerate() {
            *from = *to;
            *to = bend(self.action, joint, joints) * self.genes.servo.bend_range_rad;
        }
    }

    /// Returns the situation that the senses show now.
    fn place(&self, observation: &Observation) -> DecisionPoint {
        let senses = &observation.perception;
        let situation = SensedSituation::of(senses, self.action, self.moved_m);
        let (state, bits) = (situation.table_state() as u32, situation.bits(senses));
        DecisionPoint { situation, state, bits }
    }

    /// Chooses a posture by the policy, or by the explorer.
    fn choice(&mut self, place: &DecisionPoint) -> usize {
        let worths = self.known_worths(place);
        match self.genes.explorer.as_ref().zip(self.rng.as_mut()) {
            Some((explorer, rng)) => explored_posture(&worths, self.action, explorer.epsilon, rng),
            None => best_posture(&worths, self.action),
        }
    }

    /// Returns the value of each posture in a situation; `None` where it is unknown. No rules are made, because new rules would change the
    /// champion.
    fn known_worths(&self, place: &DecisionPoint) -> Vec<Option<f32>> {
        match &self.genes.policy {
            Policy::Table(table) => {
                table.values(place.state as usize).iter().copied().map(Some).collect()
            }
            Policy::Xcs(rules) => rules.prediction_array(place.bits),
            Policy::Zcs(rules) => rules.strength_array(place.bits),
        }
    }

    /// Returns the value of each posture in a situation, with the number of times it was tried or of rules that advise it.
    fn worths(&self, place: &DecisionPoint, rules: &[ActiveRule]) -> Vec<PostureWorth> {
        let visits = match &self.genes.policy {
            Policy::Table(table) => table.visits(place.state as usize),
            Policy::Xcs(_) | Policy::Zcs(_) => &[],
        };
        let mut of_rules = ActiveRule::worths(&POSTURES, self.known_worths(place), rules);
        for (worth, visits) in of_rules.iter_mut().zip(visits) {
            worth.count = u32::from(*visits);
        }
        of_rules
    }

    /// Returns the rules of the policy, and whether they match and decide in a situation.
    fn rules(&self, place: &DecisionPoint) -> Vec<ActiveRule> {
        let at = RulePlace { bits: place.bits, names: &SITUATION_BITS, chosen: Some(self.action) };
        match &self.genes.policy {
            Policy::Table(_) => Vec::new(),
            Policy::Xcs(rules) => at.rules_of_xcs(rules),
            Policy::Zcs(rules) => at.rules_of_zcs(rules),
        }
    }

    /// Adds the experience of the decision that ends. `next` is the situation to which it led; `None` at an end.
    fn close(&mut self, next: Option<DecisionPoint>) {
        let Some(at) = self.at.filter(|_| self.end.is_none()) else { return };
        let is_end = next.is_none();
        match &mut self.genes.policy {
            Policy::Table(table) => {
                let transition = Transition {
                    state: at.state,
                    action: self.action as u16,
                    reward: self.rewards.of_decision(is_end),
                    ticks: TICKS,
                    next: next.map_or(Next::Terminal, |next| Next::State(next.state)),
                };
                if let Some(explorer) = &self.genes.explorer {
                    Arc::make_mut(table).learn_next(&transition, &explorer.rule);
                }
                self.transitions.push(transition);
            }
            Policy::Xcs(_) | Policy::Zcs(_) => {
                let (action, reward) = (self.action as u16, self.rewards.of_rules(is_end));
                self.decisions.push(RecordedDecision { bits: at.bits, action, reward });
            }
        }
        if is_end {
            self.end = Some(EpisodeEnd::Terminal);
        }
    }
}

impl Controller for DecisionController {
    fn needs(&self) -> Senses {
        Senses { climb: true, ..Senses::ALL }
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        self.rewards.observe(&observation.climb);
        if self.rewards.has_landed() {
            self.close(None);
        }
        if self.clock.is_due(observation) {
            self.decide(observation);
        }
        self.moved_m += way_m(&observation.perception, observation.steps_per_s);
        let share = DecisionClock::share(observation);
        let targets = self.bends_rad.iter().map(|[from, to]| [from + (to - from) * share, 0.0]);
        self.servo.pull(observation, targets, torques);
    }

    fn finish(&mut self, observation: &Observation, is_disqualified: bool) -> Option<Episode> {
        if is_disqualified {
            self.rewards.disqualify();
            self.close(None);
        }
        // The end of time does not end the task: the snake could continue.
        let now = self.place(observation);
        if self.end.is_none() {
            self.rewards.observe(&observation.climb);
            self.close(Some(now));
        }
        let end = self.end.unwrap_or(EpisodeEnd::TimeOut { bits: now.bits });
        Some(match &self.genes.policy {
            Policy::Table(_) => Episode::Table(std::mem::take(&mut self.transitions)),
            Policy::Xcs(_) | Policy::Zcs(_) => {
                Episode::Rules(std::mem::take(&mut self.decisions), end)
            }
        })
    }

    fn activity(&self, _observation: &Observation, _joint: usize) -> Option<Activity> {
        let place = self.at?;
        let rules = self.rules(&place);
        Some(Activity::Decision(DecisionActivity {
            joint: None,
            situation: place.situation.words(),
            postures: self.worths(&place, &rules),
            chosen: self.action,
            barred: Some(self.previous),
            rules,
        }))
    }
}
