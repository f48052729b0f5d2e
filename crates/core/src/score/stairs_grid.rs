//! The exam on other stairs as a grid of rise and tread: how often a champion lands in each cell, and a typical trial of the cell.

use super::{ExamCondition, ExamEnd, ExamSuite, Trial, median};

/// The results of a suite of [`ExamSuite::OF_STAIRS`] by rise and tread.
#[derive(Debug, Clone, PartialEq)]
pub struct StairsGrid {
    /// The suite.
    pub suite: ExamSuite,
    /// Rises in ascending order, in m.
    pub rises_m: Vec<f32>,
    /// Treads in ascending order, in m.
    pub treads_m: Vec<f32>,
    /// Cells, ordered by rise and then by tread. A combination without trials has no cell.
    pub cells: Vec<StairsCell>,
}

/// The trials on stairs with one rise and one tread. They differ in the place of the first riser.
#[derive(Debug, Clone, PartialEq)]
pub struct StairsCell {
    /// Height of the steps, in m.
    pub rise_m: f32,
    /// Depth of the steps, in m.
    pub tread_m: f32,
    /// Number of trials in the cell.
    pub trials: u32,
    /// Number of trials in the cell that ended on the landing.
    pub landed: u32,
    /// Median of the numbers of steps climbed in the cell's trials.
    pub median_steps: f32,
    /// Typical trial of the cell. It ends on the landing if most trials do. Of these trials, its steps are nearest to the median; of equal
    /// ones, its first riser is nearest to that of the champion's own trial.
    pub typical: Trial,
    /// End of the typical trial.
    pub typical_end: ExamEnd,
}

impl StairsGrid {
    /// Computes the grid of a suite for a champion whose own trial is `own`, from the ends in the suite's conditions.
    pub fn of(
        suite: ExamSuite,
        own: &Trial,
        conditions: &[ExamCondition],
        ends: &[ExamEnd],
    ) -> Self {
        let all: Vec<(&Trial, &ExamEnd)> =
            conditions.iter().map(|condition| &condition.trial).zip(ends).collect();
        let rises_m = ascending(all.iter().map(|(trial, _)| rise_m(trial)));
        let treads_m = ascending(all.iter().map(|(trial, _)| trial.stairs.step_tread_m(0)));
        let mut cells = Vec::new();
        for &rise in &rises_m {
            for &tread in &treads_m {
                let is_here = |(trial, _): &&(&Trial, &ExamEnd)| {
                    rise_m(trial) == rise && trial.stairs.step_tread_m(0) == tread
                };
                let here: Vec<(&Trial, &ExamEnd)> = all.iter().filter(is_here).copied().collect();
                cells.extend(StairsCell::of(rise, tread, own, &here));
            }
        }
        Self { suite, rises_m, treads_m, cells }
    }

    /// Returns the number of trials in all cells.
    pub fn trials(&self) -> u32 {
        self.cells.iter().map(|cell| cell.trials).sum()
    }

    /// Returns the number of trials in all cells that ended on the landing.
    pub fn landed(&self) -> u32 {
        self.cells.iter().map(|cell| cell.landed).sum()
    }
}

impl StairsCell {
    /// Computes the cell of these trials; `None` without a trial.
    fn of(rise_m: f32, tread_m: f32, own: &Trial, here: &[(&Trial, &ExamEnd)]) -> Option<Self> {
        let trials = here.len() as u32;
        let landed = here.iter().filter(|(_, end)| end.has_landed).count() as u32;
        let median_steps = median(here.iter().map(|(_, end)| end.steps as f32).collect());
        let lands = landed * 2 > trials;
        let strangeness = |(trial, end): &(&Trial, &ExamEnd)| {
            let other_steps = (end.steps as f32 - median_steps).abs();
            let moved_m = (trial.stairs.first_riser_y_m - own.stairs.first_riser_y_m).abs();
            [f32::from(u8::from(end.has_landed != lands)), other_steps, moved_m]
        };
        // Of equal trials, the first is chosen.
        let (typical, typical_end) = here.iter().min_by(|one, other| {
            let pairs = strangeness(one).into_iter().zip(strangeness(other));
            pairs
                .map(|(one, other)| one.total_cmp(&other))
                .fold(std::cmp::Ordering::Equal, |so_far, next| so_far.then(next))
        })?;
        let (typical, typical_end) = ((*typical).clone(), **typical_end);
        Some(Self { rise_m, tread_m, trials, landed, median_steps, typical, typical_end })
    }
}

/// Returns the rise of the first step, in m.
fn rise_m(trial: &Trial) -> f32 {
    trial.stairs.step_rise_m(0)
}

/// Returns the different values in ascending order.
fn ascending(values: impl Iterator<Item = f32>) -> Vec<f32> {
    let mut values: Vec<f32> = values.collect();
    values.sort_by(f32::total_cmp);
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(steps: u32, has_landed: bool) -> ExamEnd {
        let landed_s = has_landed.then_some(9.0);
        ExamEnd {
            steps,
            way: 0.5,
            landed_s,
            has_landed,
            is_disqualified: false,
            ..ExamEnd::CRASHED
        }
    }

    #[test]
    fn each_of_the_100_stairs_counts_in_the_cell_of_its_rise_and_tread() {
        let own = Trial::default();
        let conditions = ExamSuite::Stairs.conditions(&own);
        // In the made-up ends of the i-th of 20 cells, i modulo 6 of the five trials land; the others climb i steps.
        let ends: Vec<ExamEnd> = (0..100)
            .map(|index| match index % 5 < index / 5 % 6 {
                true => end(10, true),
                false => end(index / 5, false),
            })
            .collect();
        let grid = StairsGrid::of(ExamSuite::Stairs, &own, &conditions, &ends);
        assert_eq!(grid.rises_m, [0.3, 0.4, 0.5, 0.6, 0.7]);
        assert_eq!(grid.treads_m, [1.5, 2.0, 2.5, 3.0]);
        assert_eq!((grid.cells.len(), grid.trials()), (20, 100));
        for (index, cell) in grid.cells.iter().enumerate() {
            let index = index as u32;
            assert_eq!(cell.rise_m, grid.rises_m[index as usize / 4]);
            assert_eq!(cell.tread_m, grid.treads_m[index as usize % 4]);
            assert_eq!((cell.trials, cell.landed), (5, index % 6), "cell {index}");
            let median = if index % 6 >= 3 { 10.0 } else { index as f32 };
            assert_eq!(cell.median_steps, median, "cell {index}");
        }
        assert_eq!(grid.landed(), 3 * (1 + 2 + 3 + 4 + 5) + 1);
    }

    #[test]
    fn the_typical_trial_ends_like_most_and_is_nearest_to_the_champion_s_own() {
        let own = Trial::default();
        let conditions = &ExamSuite::Lesion.conditions(&own)[..5];
        let typical = |ends: [ExamEnd; 5]| {
            let grid = StairsGrid::of(ExamSuite::Lesion, &own, conditions, &ends);
            let cell = &grid.cells[0];
            let at = |condition: &ExamCondition| condition.trial == cell.typical;
            let index = conditions.iter().position(at).expect("one of the conditions");
            assert_eq!(cell.typical_end, ends[index]);
            index
        };
        let (top, not) = (end(10, true), |steps| end(steps, false));
        assert_eq!(typical([top; 5]), 2, "the middle one has the champion's first riser");
        assert_eq!(typical([top, not(0), not(0), top, top]), 3, "most land");
        assert_eq!(typical([top, not(5), not(0), not(1), not(4)]), 4, "nearest to the median");
        assert_eq!(typical([not(3), top, top, not(4), not(3)]), 3, "most do not land");
    }

    #[test]
    fn without_trials_the_grid_is_empty() {
        let own = Trial::default();
        let grid = StairsGrid::of(ExamSuite::Stairs, &own, &[], &[]);
        assert_eq!((grid.cells.len(), grid.trials(), grid.landed()), (0, 0, 0));
    }
}
