//! Turns of the presenting mode, which shows one champion after another without end: the champion of each generation of
//! the run or, before the first finished generation, the built-in champions.
//!
//! A race, a what-if and champions with which the studio was opened are repeated until the presenter goes on by hand.
//! While evolution is followed, and during a story, [`Following`] determines what is shown.

use std::time::Duration;

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use super::following::Following;
use crate::studio::commands::Turn;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::staged_champion::{ChampionSource, StagedChampion};
use crate::studio::stage::{Show, StageMode, end_s};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::shipped_champions;

/// State of showing champions one after another in the presenting mode.
#[derive(Resource, Debug, Default)]
pub(crate) struct Turns {
    /// Whether the presenting mode is on.
    is_on: bool,
    /// Whether the stage is prevented from going on automatically, for example while the screen is black.
    pub is_held: bool,
    /// Whether champions with which the studio was opened stay on the stage.
    keeps_opened: bool,
    /// Whether the presenter has gone on by hand, so that the stage always goes on afterwards.
    is_led: bool,
    /// Step that the presenter has requested, if any.
    asked: Option<Turn>,
    /// Time since the stage reached its end.
    rested: Duration,
    /// Built-in champions; empty until they are needed.
    shipped: Vec<StagedChampion>,
}

/// Time for which a champion rests at its end before the next one is shown; shorter than the pause of a loop.
const REST: Duration = Duration::from_millis(1200);

impl Turns {
    /// Creates the turns of a studio that was opened with or without champions.
    pub fn new(keeps_opened: bool) -> Self {
        Self { keeps_opened, ..Self::default() }
    }

    /// Begins or ends showing champions one after another.
    pub fn set_on(&mut self, is_on: bool) {
        (self.is_on, self.is_led, self.asked, self.rested) = (is_on, false, None, Duration::ZERO);
    }

    /// Requests a step that the presenter makes by hand.
    pub fn take(&mut self, turn: Turn) {
        (self.asked, self.is_led) = (Some(turn), true);
    }

    /// Returns the champion of a step, if there is one besides that on the stage.
    fn champion(
        &mut self,
        turn: Turn,
        run: &CurrentRun,
        on_stage: Option<&StagedChampion>,
    ) -> Option<StagedChampion> {
        let number = run.number;
        let found = run.reports.iter().filter_map(|report| report.champion.as_ref());
        let of_run: Vec<_> =
            found.map(|champion| StagedChampion::from_run(champion, number)).collect();
        if of_run.is_empty() && self.shipped.is_empty() {
            let shipped = shipped_champions();
            let staged = |(name, loaded): &(&str, _)| StagedChampion::from_file(loaded, 0, name);
            self.shipped = shipped.iter().map(staged).collect();
        }
        let mut all = if of_run.is_empty() { self.shipped.clone() } else { of_run };
        // A champion that stays the best for several generations is shown only once.
        all.dedup_by(|later, earlier| later.champion() == earlier.champion());
        let is_same = |other: &StagedChampion| {
            on_stage.is_some_and(|staged| staged.champion() == other.champion())
        };
        let place = all.iter().position(is_same);
        let index = match (turn, place) {
            (Turn::First, _) | (Turn::Next, None) => 0,
            (Turn::Next, Some(place)) => (place + 1) % all.len().max(1),
            (Turn::Previous, place) => {
                place.unwrap_or(0).checked_sub(1).unwrap_or(all.len().saturating_sub(1))
            }
        };
        (index < all.len()).then(|| all.swap_remove(index))
    }

    /// Returns whether the stage goes on automatically at its end.
    fn goes_on(
        &self,
        run: &CurrentRun,
        following: &Following,
        (mode, on_stage): (&StageMode, Option<&StagedChampion>),
    ) -> bool {
        let is_live = following.follows_evolution() && run.status() == RunStatus::Running;
        let is_opened = on_stage.is_some_and(|of| matches!(of.source(), ChampionSource::Opened(_)));
        let stays = matches!(mode, StageMode::Race | StageMode::WhatIf { .. })
            || (is_opened && self.keeps_opened);
        let is_told = is_live || following.holds || following.story_part().is_some();
        !is_told && !self.is_held && (self.is_led || !stays)
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Turns>().add_systems(Update, take_turns.in_set(FrameSet::TakeIn));
}

/// Shows the next champion when the presenter requests it, or when it is due.
fn take_turns(
    mut turns: ResMut<Turns>,
    run: Res<CurrentRun>,
    (mut following, mut playback): (ResMut<Following>, ResMut<Playback>),
    mode: Res<StageMode>,
    lanes: Query<&Lane>,
    time: Res<Time<Real>>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    if !turns.is_on || run.is_lent {
        return;
    }
    let first = lanes.iter().min_by_key(|lane| lane.number);
    let on_stage = first.map(|lane| &lane.staged);
    let end_s = end_s(lanes);
    let is_over = playback.is_playing && end_s > 0.0 && playback.time_s() >= end_s;
    turns.rested = if is_over { turns.rested + time.delta() } else { Duration::ZERO };
    let goes_on = turns.rested >= REST && turns.goes_on(&run, &following, (&mode, on_stage));
    let asked = turns.asked.take();
    let Some(turn) = asked.or(goes_on.then_some(Turn::Next)) else { return };
    turns.rested = Duration::ZERO;
    match turns.champion(turn, &run, on_stage) {
        Some(champion) => {
            following.stop();
            playback.begin();
            show.write(Show::solo(champion));
        }
        None => notices.problem("There is no champion to show.".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{climber, explored_run, prepared_run};
    use std::collections::BTreeSet;

    /// Returns the champions that a run's presentation shows after these steps.
    fn shown(run: &CurrentRun, steps: &[Turn]) -> Vec<StagedChampion> {
        let (mut turns, mut shown) = (Turns::new(false), Vec::new());
        for turn in steps {
            shown.extend(turns.champion(*turn, run, shown.last()));
        }
        shown
    }

    #[test]
    fn the_champions_of_all_generations_come_in_turn_without_end() {
        let steps = [Turn::Next, Turn::Next, Turn::Next, Turn::Previous, Turn::First];
        let shown = shown(&explored_run(), &steps);
        let seen: Vec<u32> = shown.iter().map(|of| of.champion().origin.generation).collect();
        assert_eq!(seen, [1, 2, 1, 2, 1]);
    }

    #[test]
    fn without_a_generation_the_champions_of_the_program_come_in_turn() {
        let count = shipped_champions().len();
        let shown = shown(&prepared_run(), &vec![Turn::Next; count + 1]);
        let names: Vec<&str> = shown.iter().map(StagedChampion::name).collect();
        assert_eq!(names.first(), names.last(), "from the start again");
        let distinct: BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!((distinct.len(), names.len(), count > 5), (count, count + 1, true), "{names:?}");
    }

    #[test]
    fn what_was_chosen_stays_until_the_presenter_goes_on() {
        let opened = climber(0);
        let (run, following) = (prepared_run(), Following::default());
        let goes_on = |turns: &Turns, mode: &StageMode| {
            turns.goes_on(&run, &following, (mode, Some(&opened)))
        };
        let mut turns = Turns::new(true);
        turns.set_on(true);
        assert!(!goes_on(&turns, &StageMode::Solo), "the user opened it");
        assert!(goes_on(&Turns::new(false), &StageMode::Solo), "the program's own");
        assert!(!goes_on(&Turns::new(false), &StageMode::Race));
        turns.take(Turn::Next);
        assert!(goes_on(&turns, &StageMode::Solo));
        turns.is_held = true;
        assert!(!goes_on(&turns, &StageMode::Solo), "nothing is visible");
        turns.is_held = false;
        turns.set_on(false);
        assert!(!goes_on(&turns, &StageMode::Solo), "the next presentation begins afresh");
    }

    #[test]
    fn while_evolution_is_awaited_or_a_story_is_told_there_are_no_turns() {
        let run = explored_run();
        let turns = Turns::new(false);
        let goes_on =
            |following: &Following| turns.goes_on(&run, following, (&StageMode::Solo, None));
        assert!(goes_on(&Following::default()));
        assert!(!goes_on(&Following::from_start()), "the first generation is awaited");
        let mut following = Following::default();
        following.tell_story(&run).expect("two better generations");
        assert!(!goes_on(&following));
    }
}
