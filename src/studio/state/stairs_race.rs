//! Race of one champion on many staircases, in lanes side by side.

use super::lineup::race_of;
use crate::studio::stage::Show;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::save::built_in_stairs;

/// Creates a race of the champion on its own stairs and on each of the built-in ones that it fits.
///
/// # Errors
/// The champion fits no built-in stairs; the error is a sentence for the user.
pub(crate) fn stairs_race(champion: &StagedChampion) -> Result<Show, String> {
    let own = champion.simulated().named("its own stairs".to_owned());
    let others = built_in_stairs().map_err(|error| format!("{error}."))?;
    let others = others.into_iter().map(|other| {
        let trial = champion.trial().on_stairs(other.stairs);
        champion.in_world(&trial, other.name.replace('-', " "))
    });
    // The champion's own stairs may be among the built-in ones, and are not repeated.
    let is_other = |staged: &StagedChampion| staged.trial() != champion.trial();
    let others = others.filter(|staged| is_other(staged) && staged.check().is_ok());
    race_of(std::iter::once(own).chain(others), "The snake on the stage fits no other stairs.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::{MAX_LANES, StageMode};
    use crate::studio::state::current_run::climber;

    #[test]
    fn a_race_has_the_own_stairs_and_all_built_in_ones() {
        let show = stairs_race(&climber(0)).expect("it fits");
        assert_eq!(show.mode, StageMode::Race);
        let labels: Vec<&str> = show.champions.iter().map(StagedChampion::label).collect();
        assert_eq!(labels.len(), MAX_LANES, "{labels:?}");
        assert_eq!(labels[0], "its own stairs");
        for name in ["house", "missing step", "over the top"] {
            assert!(labels.contains(&name), "{name} in {labels:?}");
        }
        let stairs = |index: usize| &show.champions[index].trial().stairs;
        assert!((1..labels.len()).all(|index| stairs(index) != stairs(0)));
        // A race that is started from one of the lanes has the same stairs.
        let again = stairs_race(&show.champions[1]).expect("it fits");
        assert!(again.champions.len() >= MAX_LANES - 1);
        let own = again.champions[0].trial();
        assert!(again.champions[1..].iter().all(|of| of.trial() != own), "its own only once");
    }
}
