//! Made-up results for tests.

use super::family::Family;
use super::results::{ExaminedChampion, FamilyResults, Results};
use snakes_core::save::{FamilyChampion, FamilyRun};
use snakes_core::score::{ExamSuite, SuiteResult};

/// A run with a champion of these steps, which lands if they are ten.
pub fn run(seed: u64, steps_climbed: u32) -> FamilyRun {
    let has_landed = steps_climbed == 10;
    let champion = FamilyChampion {
        fitness: steps_climbed as f32,
        steps_climbed,
        has_landed,
        wave_shares: Vec::new(),
        rules: None,
    };
    FamilyRun {
        seed,
        evaluations: 6000,
        first_landing: has_landed.then_some(100 * seed as u32),
        champion: Some(champion),
        run_hash: "0".repeat(16),
    }
}

/// A family whose runs, of the seeds 1, 2, 3 and so on, have champions of these steps.
pub fn family(family: Family, steps: &[u32]) -> FamilyResults {
    let runs = (1..).zip(steps).map(|(seed, steps)| run(seed, *steps)).collect();
    FamilyResults { family, runs, examined: Vec::new() }
}

/// Examined champions, each with its landings of 50 in each suite.
pub fn examined(family: Family, champions: &[&[(ExamSuite, u32)]]) -> FamilyResults {
    let result = |&(suite, landed): &(ExamSuite, u32)| SuiteResult {
        suite,
        trials: 50,
        landed,
        disqualified: 0,
        median_steps: 4.5,
        kept: 0.5,
        each: Vec::new(),
    };
    let of_one = |(seed, suites): (u64, &&[(ExamSuite, u32)])| ExaminedChampion {
        seed,
        suites: suites.iter().map(result).collect(),
    };
    let steps = vec![10; champions.len()];
    let examined = (1..).zip(champions).map(of_one).collect();
    FamilyResults { examined, ..self::family(family, &steps) }
}

/// Examined champions of a suite, one for each number of landings of 50.
pub fn landings(family: Family, suite: ExamSuite, landed: &[u32]) -> FamilyResults {
    let each: Vec<[(ExamSuite, u32); 1]> = landed.iter().map(|landed| [(suite, *landed)]).collect();
    examined(family, &each.iter().map(|suites| &suites[..]).collect::<Vec<_>>())
}

/// The results of these families.
pub fn results(families: &[&FamilyResults]) -> Results {
    Results(families.iter().map(|family| (*family).clone()).collect())
}
