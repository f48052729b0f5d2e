//! Values of a champion in its own trial.

use std::collections::BTreeMap;

use super::values::short;
use snakes_core::control::Activity;
use snakes_core::evolve::{Champion, Descriptor};
use snakes_core::genome::controllers::{DECISIONS_PER_S, Policy};
use snakes_core::genome::{ControllerGenes, joint_tree};
use snakes_core::save::StudyValue;
use snakes_core::schema::Choices;
use snakes_core::score::Rollout;

/// Number of the most used rules whose share of all decisions is measured.
const MOST_USED: usize = 20;
/// Minimum share of a champion's decisions in which it must choose a wave to count as using it.
const LEAST_WAVE_SHARE: f64 = 0.1;

/// Returns the values of a run's champion by their names. A run without a champion has climbed no step.
pub(super) fn champion_values(champion: Option<&Champion>) -> BTreeMap<String, StudyValue> {
    let mut values = BTreeMap::new();
    let mut add = |name: &str, value| values.insert(name.to_owned(), value);
    let flag = |is_so: bool| StudyValue::Number(f64::from(u8::from(is_so)));
    let Some(champion) = champion else {
        add("steps_climbed", StudyValue::Number(0.0));
        add("landed", flag(false));
        return values;
    };
    let Champion { genome, trial, evaluation, .. } = champion;
    let behaviour = evaluation.behaviour.unwrap_or_default();
    add("fitness", short(evaluation.fitness));
    add("steps_climbed", StudyValue::Number(champion.steps_climbed().into()));
    add("landed", flag(evaluation.is_on_landing(&trial.stairs)));
    if let Some(ending) = evaluation.ending {
        add("ending", StudyValue::Text(ending.kind.choice().name.to_owned()));
    }
    add("way_m", short(champion.way_m()));
    add("blocks", StudyValue::Number(champion.body().limbs() as f64));
    let energy = Descriptor::EnergyPerMetre.value(evaluation, trial.middle_start_y_m(genome));
    energy
        .filter(|energy| energy.is_finite())
        .map(|energy| add("energy_j_per_m", StudyValue::Number(energy)));
    behaviour.cost_of_transport.map(|cost| add("cost_of_transport", short(cost)));
    behaviour.climbing_efficiency.map(|share| add("climbing_efficiency", short(share)));
    if let Some(uses) = &behaviour.wave_uses {
        let all: u32 = uses.counts().iter().sum();
        let is_used = |count: &&u32| f64::from(**count) >= LEAST_WAVE_SHARE * f64::from(all.max(1));
        let used = uses.counts().iter().filter(is_used).count();
        add("waves_used", StudyValue::Number(used as f64));
    }
    if genome.body.is_branching() {
        add("tree", StudyValue::Text(joint_tree(&genome.body.nodes)));
    }
    if let Some((count, by_twenty)) = rule_use(champion) {
        add("rules", StudyValue::Number(count as f64));
        add("decisions_of_20", StudyValue::Number(100.0 * by_twenty));
    }
    values
}

/// Simulates the trial of a champion with rules again. Returns the number of its rules, and the share of its decisions that the
/// most used rules make. `None` for other champions.
///
/// Several rules may advocate the chosen posture. The decision then counts for the rule with the greatest weight (the fitness in
/// XCS, the strength in ZCS) and, of equal rules, for the eldest.
fn rule_use(champion: &Champion) -> Option<(usize, f64)> {
    let ControllerGenes::Decisions(genes) = &champion.genome.controller else { return None };
    if matches!(genes.policy, Policy::Table(_)) {
        return None;
    }
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    let rate = u64::from(champion.trial.physics.steps_per_s);
    let (mut last, mut decisions, mut uses) = (None, 0_u32, Vec::new());
    while rollout.advance() {
        let quarter = u64::from(rollout.step() - 1) * u64::from(DECISIONS_PER_S) / rate;
        if last.replace(quarter) == Some(quarter) {
            continue;
        }
        let Some(Activity::Decision(decision)) = rollout.activity(0) else { continue };
        decisions += 1;
        uses.resize(decision.rules.len(), 0_u32);
        let weight = |index: usize| {
            let rule = &decision.rules[index];
            rule.fitness.unwrap_or(rule.worth)
        };
        let deciding = (0..decision.rules.len()).filter(|index| decision.rules[*index].decides);
        let heaviest =
            deciding.reduce(|best, index| if weight(index) > weight(best) { index } else { best });
        if let Some(rule) = heaviest {
            uses[rule] += 1;
        }
    }
    let count = uses.len();
    uses.sort_unstable_by(|a, b| b.cmp(a));
    let by_few: u32 = uses.iter().take(MOST_USED).sum();
    Some((count, f64::from(by_few) / f64::from(decisions.max(1))))
}
