//! Decisions at work: a posture four times a second, and the experience that comes of it.

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

/// Ticks of 1/60 s that a decision lasts: the unit of the learner's discount, whatever the step rate.
const TICKS: u16 = 60 / DECISIONS_PER_S as u16;
/// The posture before the first decision: straight.
const FIRST_POSTURE: usize = 0;

/// Decides by a learned policy. An explorer decides at random now and then, and learns in its own copy of a table.
#[derive(Debug, Clone)]
pub struct DecisionController {
    genes: DecisionGenes,
    servo: JointServos,
    rng: Option<ChaCha8Rng>,
    clock: DecisionClock,
    /// The situation in which it was taken.
    at: Option<DecisionPoint>,
    /// The posture that it took, and the one before.
    action: usize,
    previous: usize,
    /// Bends at the last decision, and those that it asks for, in radians.
    bends_rad: Vec<[f32; 2]>,
    moved_m: f32,
    rewards: RewardMeter,
    /// The experience so far, of a table or of rules.
    transitions: Vec<Transition>,
    decisions: Vec<RecordedDecision>,
    /// The end of the episode, after which there is nothing more to learn.
    end: Option<EpisodeEnd>,
}

/// A situation as tables and rules distinguish it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct DecisionPoint {
    situation: SensedSituation,
    state: u32,
    bits: u32,
}

impl DecisionController {
    /// The controller before the first step.
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

    /// Ends the decision that held, and takes the next one.
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

    /// The situation that the senses show now.
    fn place(&self, observation: &Observation) -> DecisionPoint {
        let senses = &observation.perception;
        let situation = SensedSituation::of(senses, self.action, self.moved_m);
        let (state, bits) = (situation.table_state() as u32, situation.bits(senses));
        DecisionPoint { situation, state, bits }
    }

    /// The posture that the policy takes, or the explorer's.
    fn choice(&mut self, place: &DecisionPoint) -> usize {
        let worths = self.known_worths(place);
        match self.genes.explorer.as_ref().zip(self.rng.as_mut()) {
            Some((explorer, rng)) => explored_posture(&worths, self.action, explorer.epsilon, rng),
            None => best_posture(&worths, self.action),
        }
    }

    /// The worth of each posture in a place, as far as it is known. No rule is made: it would change the champion.
    fn known_worths(&self, place: &DecisionPoint) -> Vec<Option<f32>> {
        match &self.genes.policy {
            Policy::Table(table) => {
                table.values(place.state as usize).iter().copied().map(Some).collect()
            }
            Policy::Xcs(rules) => rules.prediction_array(place.bits),
            Policy::Zcs(rules) => rules.strength_array(place.bits),
        }
    }

    /// The worth of each posture in a place, and how often it was tried or is advised there.
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

    /// The rules of the policy, and which of them match and decide in a place.
    fn rules(&self, place: &DecisionPoint) -> Vec<ActiveRule> {
        let at = RulePlace { bits: place.bits, names: &SITUATION_BITS, chosen: Some(self.action) };
        match &self.genes.policy {
            Policy::Table(_) => Vec::new(),
            Policy::Xcs(rules) => at.rules_of_xcs(rules),
            Policy::Zcs(rules) => at.rules_of_zcs(rules),
        }
    }

    /// Adds the experience of the decision that held until now. `next` is where it led; nothing follows an end.
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
        // Time that is up is no end: the snake would go on.
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
