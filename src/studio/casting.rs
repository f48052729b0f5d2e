//! Who can be put on the stage, and beside whom: from what a person points at to lanes.

use bevy::prelude::*;

use super::evolution::Evolution;
use super::exhibit::{Exhibit, Source};
use super::stage::{MOST_LANES, Programme, Show};
use crate::evolve::{Champion, Place, Settings, fields, with_field, with_fields};
use crate::save::LoadedChampion;
use crate::score::Trial;

/// Somebody to be put on the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pick {
    /// A champion that the studio opened with; the first is 0.
    Opening(usize),
    /// The champion of this generation of the current run; the first is 1.
    Generation(u32),
    /// Somebody of the front of distance and energy.
    Front {
        /// The generation that found it; the first is 1.
        generation: u32,
        /// Its index in that generation.
        individual: u32,
    },
    /// The best of a cell of the archive.
    Elite(u32),
    /// Somebody of the latest generation, a champion, or one of whom they descend.
    Individual(Place),
}

/// A champion that the studio opened with, and what it is called.
#[derive(Debug, Clone)]
pub(super) struct Saved {
    /// Its name: that of its file.
    pub name: String,
    /// The champion.
    pub loaded: LoadedChampion,
}

impl From<(String, LoadedChampion)> for Saved {
    fn from((name, loaded): (String, LoadedChampion)) -> Self {
        Self { name, loaded }
    }
}

/// The champions that the studio opened with.
#[derive(Resource, Debug, Clone)]
pub(super) struct Opening(pub Vec<Saved>);

impl Opening {
    /// One of them, to be shown.
    pub fn exhibit(&self, index: usize) -> Option<Exhibit> {
        self.0.get(index).map(|saved| Exhibit::saved(&saved.loaded, index, &saved.name))
    }
}

/// A change of the world.
#[derive(Debug, Clone, Copy)]
pub(super) enum Change<'a> {
    /// Of one setting, by its name.
    Field {
        /// See [`with_field`].
        field: &'a str,
        /// Its value as text.
        text: &'a str,
    },
    /// Of several settings at once, by their names.
    Fields(&'a [(String, String)]),
    /// To that of a preset.
    Preset(&'a str),
}

/// So many generations race if there are more than there are lanes: as many as the report shows.
const CHOSEN_GENERATIONS: usize = 6;
/// A change is named by so many settings; more are counted.
const MOST_NAMED: usize = 2;

/// Somebody who was pointed at. None if there is nobody any more.
pub(super) fn exhibit_of(pick: &Pick, evolution: &Evolution, opening: &Opening) -> Option<Exhibit> {
    let number = evolution.number();
    let found = |champion: &Champion| Exhibit::found(champion, number);
    match *pick {
        Pick::Opening(index) => opening.exhibit(index),
        Pick::Generation(generation) => evolution.champion_of(generation).map(found),
        Pick::Front { generation, individual } => {
            evolution.front_member(generation, individual).as_ref().map(found)
        }
        Pick::Elite(cell) => evolution.elite(cell).as_ref().map(found),
        Pick::Individual(place) => evolution.individual(place).as_ref().map(found),
    }
}

/// Whether two exhibits are the same individual.
fn are_one(a: &Exhibit, b: &Exhibit) -> bool {
    let is_run = |exhibit: &Exhibit| matches!(exhibit.source(), Source::Run(_));
    a.source() == b.source() && (!is_run(a) || a.champion().origin == b.champion().origin)
}

/// Those on the stage and one more; if it is there already, without it.
pub(super) fn with_one_more(
    mut on_show: Vec<Exhibit>,
    exhibit: Exhibit,
) -> Result<Option<Show>, String> {
    if let Some(place) = on_show.iter().position(|other| are_one(other, &exhibit)) {
        if on_show.len() == 1 {
            return Ok(None);
        }
        on_show.remove(place);
    } else if on_show.len() >= MOST_LANES {
        return Err(format!("The stage has room for {MOST_LANES} lanes."));
    } else {
        on_show.push(exhibit);
    }
    Ok(Some(Show::race(on_show)))
}

/// The champions of the generations of the current run; of many, some at equal distances, the first and the last
/// among them.
pub(super) fn all_generations(evolution: &Evolution) -> Result<Vec<Exhibit>, String> {
    let champions: Vec<&Champion> =
        evolution.reports().iter().filter_map(|report| report.champion.as_ref()).collect();
    if champions.len() < 2 {
        return Err("A race of generations needs two with a champion; let it evolve.".to_owned());
    }
    let number = evolution.number();
    let chosen = evenly_chosen(champions.len());
    Ok(chosen.map(|index| Exhibit::found(champions[index], number)).collect())
}

/// The indices of those of `count` that race: all, or of many some at equal distances.
pub(super) fn evenly_chosen(count: usize) -> impl Iterator<Item = usize> {
    evenly(count, MOST_LANES, CHOSEN_GENERATIONS)
}

/// All of `count` indices if they are at most `most`, else `few` of them, evenly spread from the first to the last.
fn evenly(count: usize, most: usize, few: usize) -> impl Iterator<Item = usize> {
    let chosen = if count <= most { count } else { few };
    (0..chosen).map(move |index| index * (count - 1) / (chosen - 1).max(1))
}

/// The best of a generation, or of the latest one.
pub(super) fn leaders(
    evolution: &Evolution,
    generation: Option<u32>,
) -> Result<Vec<Exhibit>, String> {
    let leaders = evolution.leaders(generation);
    if leaders.len() < 2 {
        return Err("The best ten are known of the generations that this session has finished, if two were \
                    in good health."
            .to_owned());
    }
    let number = evolution.number();
    let names = (1..).map(|rank| format!("No. {rank}"));
    let exhibits = leaders.iter().zip(names);
    Ok(exhibits.map(|(champion, name)| Exhibit::found(champion, number).named(name)).collect())
}

/// Makes a change for the next run, and says what is to be shown: the first of those on the stage as it is, and
/// beside it with the change; nothing if the change does not concern it.
pub(super) fn what_if(
    evolution: &mut Evolution,
    on_show: &[Exhibit],
    programme: &Programme,
    change: &Change,
) -> Result<Option<Show>, String> {
    let before = match programme {
        Programme::WhatIf { before } => before.clone(),
        Programme::Solo | Programme::Race => Box::new(evolution.next_plan().clone()),
    };
    match change {
        Change::Field { field, text } => evolution.set_field(field, text)?,
        Change::Fields(changes) => evolution.set_fields(changes)?,
        Change::Preset(name) => evolution.set_preset(name)?,
    }
    // Only the change is to make a difference, not another engine too.
    let Some(original) = on_show.first().map(Exhibit::simulated) else { return Ok(None) };
    let original = &original;
    // Further changes add up.
    let so_far = match programme {
        Programme::WhatIf { .. } => on_show.last().unwrap_or(original),
        Programme::Solo | Programme::Race => original,
    };
    let next = evolution.next_settings();
    let trial = match change {
        // Only what was changed is to differ, not whatever else the next run's world has.
        Change::Field { field, text } => {
            let settings = Settings { trial: so_far.trial().clone(), ..next.clone() };
            with_field(&settings, field, text).map_err(|error| error.to_string())?.trial
        }
        Change::Fields(changes) => {
            let settings = Settings { trial: so_far.trial().clone(), ..next.clone() };
            let changes = changes.iter().map(|(field, text)| (field.as_str(), text.as_str()));
            with_fields(&settings, changes).map_err(|error| error.to_string())?.trial
        }
        // Its world; how long it lasts and what is rewarded stay, so that the two can be compared.
        Change::Preset(_) => Trial {
            duration_s: so_far.trial().duration_s,
            fitness: so_far.trial().fitness,
            energy_cost_per_kj: so_far.trial().energy_cost_per_kj,
            repeats: so_far.trial().repeats.clone(),
            ..next.trial.clone()
        },
    };
    if trial == *so_far.trial() {
        return Ok(None);
    }
    if trial == *original.trial() {
        return Ok(Some(Show::solo(original.clone())));
    }
    let label = match change {
        Change::Preset(name) => (*name).to_owned(),
        Change::Field { .. } | Change::Fields(_) => world_in_words(original.trial(), &trial),
    };
    let changed = original.in_world(&trial, label);
    changed.check().map_err(|reason| {
        format!("What is on show stays in its own world, the new one does not suit it: {reason}")
    })?;
    let exhibits = vec![original.clone(), changed];
    Ok(Some(Show { exhibits, programme: Programme::WhatIf { before } }))
}

/// Forgets what was changed.
pub(super) fn dropped(
    evolution: &mut Evolution,
    on_show: &[Exhibit],
    programme: &Programme,
) -> Result<Option<Show>, String> {
    let Programme::WhatIf { before } = programme else { return Ok(None) };
    evolution.undo_world(before)?;
    Ok(on_show.first().cloned().map(Show::solo))
}

/// Goes on with what was changed.
pub(super) fn kept(on_show: &[Exhibit], programme: &Programme) -> Option<Show> {
    let is_what_if = matches!(programme, Programme::WhatIf { .. });
    on_show.last().filter(|_| is_what_if).cloned().map(Show::solo)
}

/// What is other in a world, in a few words: "friction 0.5, rise 0.7".
pub(super) fn world_in_words(original: &Trial, changed: &Trial) -> String {
    let of = |trial: &Trial| Settings { trial: trial.clone(), ..Settings::default() };
    changes_in_words(&of(original), &of(changed))
}

/// What is other in some settings, in a few words.
pub(super) fn changes_in_words(original: &Settings, changed: &Settings) -> String {
    let before = fields(original);
    let was_there = |path: &str| before.iter().any(|(known, _)| known == path);
    let mut other: Vec<String> = fields(changed)
        .into_iter()
        .filter(|field| !before.contains(field))
        .map(|(path, value)| {
            let mut names = path.rsplit('.');
            let name = without_unit(names.next().unwrap_or(&path)).replace('_', " ");
            // What was not there at all before is named as a whole.
            let whole = names.next().filter(|_| !was_there(&path));
            whole.map_or(format!("{name} {value}"), |whole| format!("own {whole}"))
        })
        .collect();
    other.dedup();
    let mut text = other.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    if other.len() > MOST_NAMED {
        text += &format!(" and {} more", other.len() - MOST_NAMED);
    }
    text
}

/// A setting's name without the unit at its end.
fn without_unit(name: &str) -> &str {
    const UNITS: [&str; 10] = [
        "_nms_per_rad",
        "_m_s_per_n",
        "_kg_m3",
        "_per_s",
        "_m_s2",
        "_m_s",
        "_rad",
        "_nm",
        "_m",
        "_s",
    ];
    UNITS.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::evolution::{explored_run, prepared_run};

    fn saved(index: usize) -> Exhibit {
        Exhibit::saved(&shipped_champion().expect("well formed"), index, "climber")
    }

    #[test]
    fn of_many_generations_some_race_at_equal_distances() {
        let chosen = |count| evenly(count, 10, 6).collect::<Vec<_>>();
        assert_eq!(chosen(6), [0, 1, 2, 3, 4, 5]);
        assert_eq!(chosen(10).len(), 10);
        assert_eq!(chosen(101), [0, 20, 40, 60, 80, 100]);
    }

    #[test]
    fn who_joins_twice_leaves_and_the_eleventh_is_turned_away() {
        let mut on_show = vec![saved(0)];
        for index in 1..10 {
            on_show = with_one_more(on_show, saved(index)).expect("room").expect("new").exhibits;
        }
        assert_eq!(on_show.len(), 10);
        let full = with_one_more(on_show.clone(), saved(10)).expect_err("full");
        assert!(full.contains("room for 10"), "{full}");
        let fewer = with_one_more(on_show, saved(3)).expect("fine").expect("one less");
        assert_eq!(fewer.exhibits.len(), 9);
        assert!(with_one_more(vec![saved(0)], saved(0)).expect("fine").is_none(), "the last stays");
    }

    #[test]
    fn changes_add_up_beside_the_original_and_can_be_kept_or_dropped() {
        let mut run = prepared_run();
        let plan = run.next_plan().clone();
        let field = |field, text| Change::Field { field, text };
        let first =
            what_if(&mut run, &[saved(0)], &Programme::Solo, &field("surface.friction", "0.3"))
                .expect("allowed")
                .expect("it matters");
        assert_eq!(first.exhibits[1].label(), "friction 0.3");
        let second =
            what_if(&mut run, &first.exhibits, &first.programme, &field("stairs.rise_m", "0.7"))
                .expect("allowed")
                .expect("it matters");
        let [original, changed] = &second.exhibits[..] else { panic!("two lanes") };
        assert!(!original.is_changed() && changed.is_changed());
        assert_eq!(changed.label(), "rise 0.7, friction 0.3");
        let ground = field("ground.friction", "1");
        let third = what_if(&mut run, &second.exhibits, &second.programme, &ground);
        let third = third.expect("allowed").expect("it matters");
        assert_eq!(third.exhibits[1].label(), "own ground, rise 0.7 and 1 more");
        assert_eq!(changed.trial().surface.friction, 0.3);
        assert_eq!(changed.trial().duration_s, original.trial().duration_s, "nothing else");
        let kept = kept(&second.exhibits, &second.programme).expect("kept");
        assert_eq!(kept.exhibits[0].trial(), changed.trial());
        let shown = dropped(&mut run, &second.exhibits, &second.programme);
        let shown = shown.expect("allowed").expect("the original");
        assert_eq!(shown.exhibits[0].trial(), original.trial());
        assert_eq!(*run.next_plan(), plan, "as it was before the first change");
        // What was chosen meanwhile, and is no matter of the world, stays.
        what_if(&mut run, &[saved(0)], &Programme::Solo, &field("surface.friction", "0.3"))
            .expect("allowed");
        run.set_seed(77).expect("allowed");
        run.set_population(9).expect("allowed");
        dropped(&mut run, &second.exhibits, &second.programme).expect("allowed");
        assert_eq!((run.next_seed(), run.next_settings().evolution.population), (77, 9));
        assert_eq!(run.next_settings().trial, plan.settings.trial);
    }

    #[test]
    fn a_preset_that_the_genome_does_not_fit_is_refused_with_the_reason() {
        let mut run = prepared_run();
        let limbs = Change::Field { field: "agent.limbs", text: "7" };
        let refusal = what_if(&mut run, &[saved(0)], &Programme::Solo, &limbs);
        let refusal = refusal.expect_err("refused");
        assert!(refusal.contains("joints is 4 joints") && refusal.contains("7 limbs"), "{refusal}");
        let preset = what_if(&mut run, &[saved(0)], &Programme::Solo, &Change::Preset("ice"));
        let preset = preset.expect("allowed").expect("another world");
        assert_eq!(preset.exhibits[1].label(), "ice");
    }

    #[test]
    fn what_is_no_matter_of_the_world_changes_nothing_on_the_stage() {
        let mut run = prepared_run();
        let parents = Change::Field { field: "evolution.population", text: "7" };
        let shown = what_if(&mut run, &[saved(0)], &Programme::Solo, &parents).expect("allowed");
        assert!(shown.is_none());
        assert_eq!(run.next_settings().evolution.population, 7);
    }

    #[test]
    fn the_leaders_of_a_generation_race_by_rank() {
        let run = explored_run();
        let leaders = leaders(&run, None).expect("some are healthy");
        assert_eq!(leaders[0].name(), "No. 1");
        assert!(leaders.len() > 2 && leaders.len() <= MOST_LANES);
        let fitness: Vec<f32> = leaders.iter().map(Exhibit::fitness).collect();
        assert!(fitness.is_sorted_by(|a, b| a >= b), "{fitness:?}");
        assert!(super::leaders(&prepared_run(), None).is_err());
    }
}
