//! What a champion does in its own trial.

use snakes_core::control::Activity;
use snakes_core::evolve::Champion;
use snakes_core::genome::ControllerGenes;
use snakes_core::genome::controllers::{DECISIONS_PER_S, Policy};
use snakes_core::save::{FamilyChampion, RuleUse};
use snakes_core::score::Rollout;

/// Number of rules whose share of all decisions is measured.
const MOST_USED: usize = 20;

/// The results of a champion, and how it uses its waves or rules.
pub(super) fn observed(champion: &Champion) -> FamilyChampion {
    let Champion { evaluation, trial, .. } = champion;
    let behaviour = evaluation.behaviour.unwrap_or_default();
    let uses = behaviour.wave_uses.as_ref().map_or(&[][..], |uses| uses.counts());
    let all: u64 = uses.iter().map(|count| u64::from(*count)).sum();
    FamilyChampion {
        fitness: evaluation.fitness,
        steps_climbed: behaviour.steps_climbed,
        has_landed: evaluation.is_on_landing(&trial.stairs),
        wave_shares: uses
            .iter()
            .map(|count| (f64::from(*count) / all.max(1) as f64) as f32)
            .collect(),
        rules: rule_use(champion),
    }
}

/// How a champion with rules uses them; none for other champions. The trial is simulated again.
///
/// Several rules may stand behind one posture. The decision then counts for the rule with the greatest weight in the choice:
/// the greatest fitness in XCS, the greatest strength in ZCS, and of equals the eldest.
fn rule_use(champion: &Champion) -> Option<RuleUse> {
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
    let count = uses.len() as u32;
    uses.sort_unstable_by(|a, b| b.cmp(a));
    let by_few: u32 = uses.iter().take(MOST_USED).sum();
    let share_of_twenty = (f64::from(by_few) / f64::from(decisions.max(1))) as f32;
    Some(RuleUse { count, share_of_twenty })
}
