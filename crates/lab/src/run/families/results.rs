//! The results of families: their finished runs, and the exams of their champions.

use super::family::{Family, Training};
use snakes_core::save::{FamilyChampion, FamilyRun};
use snakes_core::score::{ExamSuite, SuiteResult};

/// The results of several families.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Results(pub Vec<FamilyResults>);

/// The results of a family.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilyResults {
    /// The family.
    pub family: Family,
    /// Its runs, in the order of their seeds.
    pub runs: Vec<FamilyRun>,
    /// The champions that were examined, in the order of their seeds.
    pub examined: Vec<ExaminedChampion>,
}

/// A champion and its exam.
#[derive(Debug, Clone, PartialEq)]
pub struct ExaminedChampion {
    /// The seed of its run.
    pub seed: u64,
    /// Its results, one for each suite that concerns it.
    pub suites: Vec<SuiteResult>,
}

impl Results {
    /// The results of a family, if there are any.
    pub fn of(&self, family: Family) -> Option<&FamilyResults> {
        self.0.iter().find(|results| results.family == family)
    }
}

impl FamilyResults {
    /// The champions; a run that disqualified all its snakes has none.
    pub fn champions(&self) -> impl Iterator<Item = &FamilyChampion> {
        self.runs.iter().filter_map(|run| run.champion.as_ref())
    }

    /// For each examined champion, the seed and the landings in a suite, of 100 trials.
    pub fn landings(&self, suite: ExamSuite) -> Vec<(u64, f64)> {
        let of_one = |champion: &ExaminedChampion| {
            let result = champion.suites.iter().find(|result| result.suite == suite)?;
            Some((champion.seed, landings(result)))
        };
        self.examined.iter().filter_map(of_one).collect()
    }
}

/// Landings of 100 trials.
pub(super) fn landings(result: &SuiteResult) -> f64 {
    100.0 * f64::from(result.landed) / f64::from(result.trials.max(1))
}

/// The seeds of the runs whose champions are examined: of mixed stairs all, else the best: the one that landed, then the
/// one with the most steps, then the fittest, of equals the one with the lowest seed.
pub fn seeds_to_examine(family: Family, runs: &[FamilyRun]) -> Vec<u64> {
    let champions = runs.iter().filter_map(|run| Some((run.seed, run.champion.as_ref()?)));
    match family.info().training {
        Training::Mixed => champions.map(|(seed, _)| seed).collect(),
        Training::Standard => {
            let is_better = |a: &FamilyChampion, b: &FamilyChampion| {
                let rank = |of: &FamilyChampion| (of.has_landed, of.steps_climbed);
                rank(a).cmp(&rank(b)).then(a.fitness.total_cmp(&b.fitness)).is_gt()
            };
            let best =
                champions.reduce(|best, one| if is_better(one.1, best.1) { one } else { best });
            best.map(|(seed, _)| seed).into_iter().collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::fixtures::family;

    #[test]
    fn of_standard_stairs_the_best_champion_is_examined_and_of_mixed_ones_every_champion() {
        let mut runs = family(Family::Xcs, &[3, 9, 10, 10, 9]).runs;
        assert_eq!(seeds_to_examine(Family::Xcs, &runs), [3], "the first of equals");
        runs[3].champion.as_mut().expect("one").fitness = 26.0;
        assert_eq!(seeds_to_examine(Family::Xcs, &runs), [4]);
        runs[3].champion = None;
        assert_eq!(seeds_to_examine(Family::MixedGait, &runs), [1, 2, 3, 5]);
        assert_eq!(seeds_to_examine(Family::Xcs, &[]), [0_u64; 0]);
    }
}
