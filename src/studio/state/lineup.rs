//! Chooses the individuals on the stage: single individuals, races of generations, races of the best.

use super::current_run::CurrentRun;
use crate::studio::commands::pick::Pick;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::stage::staged_champion::{ChampionSource, StagedChampion};
use crate::studio::stage::{MAX_LANES, Show, evenly};
use snakes_core::evolve::Champion;

/// Number of generations that race if there are more generations than lanes: as many as in the report.
pub(crate) const CHOSEN_GENERATIONS: usize = 6;

/// Creates a race of one champion with variations of it, of which as many are kept as there are lanes.
///
/// # Errors
/// There are no variations; the error is `refusal`.
pub(super) fn race_of(
    lanes: impl Iterator<Item = StagedChampion>,
    refusal: impl Into<String>,
) -> Result<Show, String> {
    let champions: Vec<StagedChampion> = lanes.take(MAX_LANES).collect();
    if champions.len() < 2 { Err(refusal.into()) } else { Ok(Show::race(champions)) }
}

/// Returns the champion that was chosen; `None` if it is not kept any more.
pub(crate) fn champion_of(
    pick: &Pick,
    run: &CurrentRun,
    opening: &OpeningChampions,
) -> Option<StagedChampion> {
    let found = match *pick {
        Pick::Opened(index) => return opening.staged(index),
        Pick::Generation(generation) => run.champion_of(generation).cloned(),
        Pick::Front(place) => run.front_member(place),
        Pick::Elite(cell) => run.elite(cell),
        Pick::Stairs(node) => run.stairs_agent(node),
        Pick::Individual(place) => run.individual(place),
    };
    found.map(|champion| StagedChampion::from_run(&champion, run.number))
}

/// Returns whether two lanes show the same individual.
fn are_one(a: &StagedChampion, b: &StagedChampion) -> bool {
    let is_run = |staged: &StagedChampion| matches!(staged.source(), ChampionSource::Run(_));
    a.source() == b.source() && (!is_run(a) || a.champion().origin == b.champion().origin)
}

/// Returns the stage with a champion added, or removed if it is there already. Returns `None` if it is there alone.
pub(crate) fn with_one_more(
    mut on_show: Vec<StagedChampion>,
    staged: StagedChampion,
) -> Result<Option<Show>, String> {
    if let Some(place) = on_show.iter().position(|other| are_one(other, &staged)) {
        if on_show.len() == 1 {
            return Ok(None);
        }
        on_show.remove(place);
    } else if on_show.len() >= MAX_LANES {
        return Err(format!("At most {MAX_LANES} snakes fit on the stage."));
    } else {
        on_show.push(staged);
    }
    Ok(Some(Show::race(on_show)))
}

/// Returns the indices of the generations to race, given the fitness of the champion of each. Of many generations, those race that show how
/// the run learned: they have records. Of many records, those race that first reach evenly spaced results from the first to the best.
pub(crate) fn learning(fitness: &[f32]) -> Vec<usize> {
    let all = || evenly(fitness.len(), MAX_LANES, CHOSEN_GENERATIONS).collect();
    if fitness.len() <= MAX_LANES {
        return all();
    }
    let mut best = f32::NEG_INFINITY;
    let is_record = |(index, fitness): (usize, &f32)| {
        let is_better = *fitness > best;
        best = best.max(*fitness);
        is_better.then_some(index)
    };
    let mut records: Vec<usize> = fitness.iter().enumerate().filter_map(is_record).collect();
    if let [first, .., last] = records[..]
        && records.len() > MAX_LANES
    {
        let (least, gain) = (fitness[first], fitness[last] - fitness[first]);
        let result = |race: usize| least + gain * race as f32 / (CHOSEN_GENERATIONS - 1) as f32;
        let reaches = |race: usize| records.iter().copied().find(|at| fitness[*at] >= result(race));
        let mut chosen: Vec<usize> =
            (0..CHOSEN_GENERATIONS).map(|race| reaches(race).unwrap_or(last)).collect();
        chosen.dedup();
        records = chosen;
    }
    if records.len() > 1 { records } else { all() }
}

/// Returns the champions of the current run's generations; of many, those that show how the run learned.
pub(crate) fn all_generations(run: &CurrentRun) -> Result<Vec<StagedChampion>, String> {
    let champions: Vec<&Champion> =
        run.reports.iter().filter_map(|report| report.champion.as_ref()).collect();
    if champions.len() < 2 {
        return Err("Nothing to race yet: finish two generations first.".to_owned());
    }
    let number = run.number;
    let fitness: Vec<f32> = champions.iter().map(|champion| champion.evaluation.fitness).collect();
    let staged = |index| StagedChampion::from_run(champions[index], number);
    Ok(learning(&fitness).into_iter().map(staged).collect())
}

/// Returns the best snakes of a generation, or of the latest one.
pub(crate) fn leaders(
    run: &CurrentRun,
    generation: Option<u32>,
) -> Result<Vec<StagedChampion>, String> {
    let leaders = run.leaders(generation);
    if leaders.len() < 2 {
        return Err("Nothing to race yet: finish a generation first.".to_owned());
    }
    let number = run.number;
    let staged = |(rank, champion): (usize, &Champion)| {
        StagedChampion::from_run(champion, number).named(format!("No. {rank}"))
    };
    Ok((1..).zip(leaders).map(staged).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{climber, explored_run, prepared_run};

    #[test]
    fn of_many_generations_those_race_that_learned() {
        assert_eq!(learning(&[1.0; 6]), [0, 1, 2, 3, 4, 5]);
        assert_eq!(learning(&[1.0; 101]), [0, 20, 40, 60, 80, 100], "it learns nothing");
        // It learns in the first 20 of 200 generations.
        let fitness: Vec<f32> = (0..200_u8).map(|at| f32::from(at.min(20))).collect();
        assert_eq!(learning(&fitness), [0, 4, 8, 12, 16, 20]);
        let mut fitness = [1.0; 200];
        fitness[7] = 9.0;
        fitness[90..].fill(8.0);
        fitness[150] = 20.0;
        assert_eq!(learning(&fitness), [0, 7, 150]);
    }

    #[test]
    fn joining_twice_removes_and_an_eleventh_lane_is_refused() {
        let mut on_show = vec![climber(0)];
        for index in 1..10 {
            let more = with_one_more(on_show, climber(index)).expect("not full");
            on_show = more.expect("new").champions;
        }
        assert_eq!(on_show.len(), 10);
        let full = with_one_more(on_show.clone(), climber(10)).expect_err("full");
        assert!(full.contains("At most 10 snakes"), "{full}");
        let fewer = with_one_more(on_show, climber(3)).expect("fine").expect("one less");
        assert_eq!(fewer.champions.len(), 9);
        let last = with_one_more(vec![climber(0)], climber(0));
        assert!(last.expect("fine").is_none(), "the last stays");
    }

    #[test]
    fn the_leaders_of_a_generation_race_by_rank() {
        let run = explored_run();
        let leaders = leaders(&run, None).expect("some are healthy");
        assert_eq!(leaders[0].name(), "No. 1");
        assert!(leaders.len() > 2 && leaders.len() <= MAX_LANES);
        let fitness: Vec<f32> = leaders.iter().map(|of| of.champion().evaluation.fitness).collect();
        assert!(fitness.is_sorted_by(|a, b| a >= b), "{fitness:?}");
        assert!(crate::studio::state::lineup::leaders(&prepared_run(), None).is_err());
    }
}
