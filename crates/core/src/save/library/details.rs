//! Contents of library entries: one entry at a time is read and checked, never simulated.

use std::path::{Path, PathBuf};

use super::place::SavePlace;
use super::shipped::{SHIPPED, shipped_text};
use super::thumbnail::Thumbnail;
use crate::Engine;
use crate::check::Invalid;
use crate::evolve::{GenerationRecord, Origin, StrategyKind};
use crate::genome::ControllerKind;
use crate::save::champion::note;
use crate::save::files::{numbered, read_text, refuse_link};
use crate::save::plan::load_plan;
use crate::save::record::load_log;
use crate::save::{LoadedChampion, SaveError, load_generation, parse_champion, settings_in_words};
use crate::score::{Fitness, SuiteResult};
use crate::world::PhysicsEngine;

/// Contents of a library entry.
#[derive(Debug, Clone, PartialEq)]
pub enum EntryDetails {
    /// Contents of a champion's file.
    Champion(Box<ChampionDetails>),
    /// Contents of a run's folder.
    Run(Box<RunDetails>),
}

/// Contents of a champion's file, as the library shows them.
#[derive(Debug, Clone, PartialEq)]
pub struct ChampionDetails {
    /// Fitness of the champion.
    pub fitness: f32,
    /// Kind of fitness that was maximised.
    pub rewarded: Fitness,
    /// Result of the champion in words.
    pub reached: String,
    /// Number of steps that the middle limb had climbed at the end.
    pub climbed: u32,
    /// Number of steps of the staircase.
    pub steps: u32,
    /// Length of the trial, in simulated seconds.
    pub duration_s: f32,
    /// Run that found the champion, with its generation and index.
    pub origin: Origin,
    /// Engine that found the champion.
    pub engine: Engine,
    /// Physics engine of the trial.
    pub physics: PhysicsEngine,
    /// Controller of the joints.
    pub controller: ControllerKind,
    /// Results of the exam, one per suite; empty if the file has no results.
    pub exam: Vec<SuiteResult>,
    /// Comment of the user in the first line of the file. None if there is none.
    pub note: Option<String>,
    /// Movement of the champion, seen from the side.
    pub thumbnail: Thumbnail,
}

/// Contents of a run's folder, as the library shows them.
#[derive(Debug, Clone, PartialEq)]
pub struct RunDetails {
    /// Name of the run's preset, with what differs from it: see [`settings_in_words`].
    pub preset: String,
    /// Seed of the run.
    pub seed: u64,
    /// Search strategy. None (unknown) for a run of another engine.
    pub strategy: Option<StrategyKind>,
    /// Controller of the joints.
    pub controller: ControllerKind,
    /// Kind of fitness that was maximised.
    pub rewarded: Fitness,
    /// Number of finished generations of the run.
    pub finished: u32,
    /// Finished generations in words: see [`RunPlan::generations_in_words`]. None (unknown) for a run of another engine.
    pub generations: Option<String>,
    /// Generation of the best champion, from 1, and the champion's fitness. None if there is no champion. If the run chooses champions by
    /// their fitness over varied trials, that fitness determines the best.
    pub best: Option<(u32, f32)>,
    /// Best fitness of each generation, in order. None for a generation of which all individuals were disqualified.
    pub best_of_each: Vec<Option<f32>>,
    /// Generations whose champions are saved, in order.
    pub champions: Vec<u32>,
    /// Reason why the run cannot continue. None if it can.
    pub ended: Option<String>,
    /// Movement of the best champion, seen from the side.
    pub thumbnail: Thumbnail,
}

/// Reads and checks the contents of an entry.
///
/// # Errors
/// Fails if the entry is unreadable, too large, damaged, a link, of another kind or format, or has a value out of range.
pub fn read_entry(place: &SavePlace) -> Result<EntryDetails, SaveError> {
    match place {
        SavePlace::Run(folder) => run(folder),
        SavePlace::Shipped(_) | SavePlace::Champion(_) => champion(place),
    }
}

/// Reads the champion of an entry. For a run, this is the champion of the best generation, whose number is also returned.
///
/// # Errors
/// Fails as [`read_entry`] does, or if the run has no champion yet.
pub fn load_entry(place: &SavePlace) -> Result<(LoadedChampion, Option<u32>), SaveError> {
    match place {
        SavePlace::Shipped(_) | SavePlace::Champion(_) => Ok((loaded_champion(place)?.0, None)),
        SavePlace::Run(folder) => {
            let EntryDetails::Run(details) = run(folder)? else { return Err(no_champion(folder)) };
            let best = details.best.map(|(generation, _)| generation);
            let there = best.filter(|best| details.champions.binary_search(best).is_ok());
            let generation = there.or(details.champions.last().copied());
            let generation = generation.ok_or_else(|| no_champion(folder))?;
            Ok((load_generation(folder, generation)?, Some(generation)))
        }
    }
}

/// Returns the names and champions that are part of the program.
pub fn shipped_champions() -> Vec<(&'static str, LoadedChampion)> {
    // A test checks that all shipped champions can be parsed.
    let parsed = |(name, text): &(&'static str, &str)| {
        Some((*name, parse_champion(Path::new(name), text).ok()?))
    };
    SHIPPED.iter().filter_map(parsed).collect()
}

fn no_champion(folder: &Path) -> SaveError {
    let source = std::io::Error::other("the run has no champion yet");
    SaveError::Unreadable { path: folder.to_owned(), source }
}

/// Returns the text of a champion's file.
///
/// # Errors
/// Fails if the file cannot be read or is a link, or if the entry is a run.
pub fn text_of_champion(place: &SavePlace) -> Result<String, SaveError> {
    let name = || format!("{:?}", place.name());
    let invalid = |source| SaveError::Invalid { path: path_in_errors(place), source };
    match place {
        SavePlace::Champion(path) => text_of_file(path),
        SavePlace::Shipped(shipped) => shipped_text(shipped).map(str::to_owned).ok_or_else(|| {
            invalid(Invalid::new("name", name(), "the name of a built-in champion"))
        }),
        SavePlace::Run(_) => Err(invalid(Invalid::new("entry", "a run", "a champion's file"))),
    }
}

/// Returns the path of an entry for errors; for an entry that is part of the program, its name.
pub fn path_in_errors(place: &SavePlace) -> PathBuf {
    place.path().map_or_else(|| place.name().into(), Path::to_owned)
}

fn loaded_champion(place: &SavePlace) -> Result<(LoadedChampion, String), SaveError> {
    let text = text_of_champion(place)?;
    Ok((parse_champion(&path_in_errors(place), &text)?, text))
}

/// Reads the text of a champion's file. Refuses a link.
pub fn text_of_file(path: &Path) -> Result<String, SaveError> {
    refuse_link(path).map_err(SaveError::unreadable(path))?;
    read_text(path)
}

fn champion(place: &SavePlace) -> Result<EntryDetails, SaveError> {
    let (loaded, text) = loaded_champion(place)?;
    let champion = &loaded.champion;
    let evaluation = &champion.evaluation;
    let stairs = &champion.trial.stairs;
    let by_place = || stairs.steps_climbed(f64::from(evaluation.centre_y_m));
    Ok(EntryDetails::Champion(Box::new(ChampionDetails {
        fitness: evaluation.fitness,
        rewarded: champion.trial.fitness,
        reached: champion.reached(),
        climbed: evaluation.behaviour.map_or_else(by_place, |behaviour| behaviour.steps_climbed),
        steps: stairs.steps,
        duration_s: champion.trial.duration_s,
        origin: champion.origin.clone(),
        engine: loaded.engine,
        physics: champion.trial.physics.engine,
        controller: champion.genome.controller.kind(),
        exam: loaded.exam,
        note: note(&text),
        thumbnail: Thumbnail::of_champion(champion, loaded.recording.as_ref()),
    })))
}

fn run(folder: &Path) -> Result<EntryDetails, SaveError> {
    let mut champions = numbered(folder, "generation-")?;
    champions.sort_unstable();
    // A run of another engine cannot continue, but its champions can be shown.
    if let Err(error @ SaveError::Invalid { .. }) = load_plan(folder) {
        return of_other_engine(folder, champions, error);
    }
    let (plan, records) = load_log(folder)?;
    champions.retain(|generation| *generation as usize <= records.len());
    let best_of = |record: &GenerationRecord| record.statistics.map(|of| of.best as f32);
    let best_of_each: Vec<Option<f32>> = records.iter().map(best_of).collect();
    // Champions are ranked as in the run: on a ladder, higher stairs come before greater fitness.
    let rank = |record: &GenerationRecord| {
        let fitness = record.chosen_by.or(record.statistics.map(|of| of.best))?;
        Some([record.rung.map_or(0.0, |rung| f64::from(rung.rise_m)), fitness])
    };
    let ranked = records.iter().zip(1..).filter_map(|(of, number)| Some((number, rank(of)?)));
    // Of champions with equal rank, the first is the best. Where stairs evolve, a run keeps only champions that are better than all before,
    // so the last is the best.
    let best = match champions.last().filter(|_| records.iter().any(|of| of.stairs.is_some())) {
        Some(&last) => records.get(last as usize - 1).and_then(rank).map(|rank| (last, rank)),
        None => ranked.reduce(|best, next| if next.1 > best.1 { next } else { best }),
    };
    let shown = best.and_then(|(generation, _)| load_generation(folder, generation).ok());
    let best = best.and_then(|(generation, _)| {
        let of_all = best_of_each.get(generation as usize - 1).copied().flatten();
        let own = shown.as_ref().map(|of| of.champion.evaluation.fitness);
        Some((generation, own.or(of_all)?))
    });
    let thumbnail = match &shown {
        Some(of) => Thumbnail::of_champion(&of.champion, of.recording.as_ref()),
        None => Thumbnail::of_trial(&plan.settings.trial),
    };
    let is_finished = plan.has_ended(&records);
    let ended = is_finished.then(|| "all its generations are finished".to_owned());
    let settings = &plan.settings;
    let generations = plan.generations_in_words(records.len() as u32, is_finished);
    Ok(EntryDetails::Run(Box::new(RunDetails {
        strategy: Some(settings.evolution.strategy),
        controller: settings.genome.controller,
        rewarded: settings.trial.fitness,
        finished: records.len() as u32,
        generations: Some(generations),
        best,
        best_of_each,
        champions,
        ended,
        thumbnail,
        preset: settings_in_words(&plan),
        seed: plan.seed,
    })))
}

/// Returns the contents of a run that cannot continue with this engine, as far as its latest champion has them.
fn of_other_engine(
    folder: &Path,
    champions: Vec<u32>,
    error: SaveError,
) -> Result<EntryDetails, SaveError> {
    let Some(latest) = champions.last().copied() else { return Err(error) };
    let LoadedChampion { champion, recording, .. } = load_generation(folder, latest)?;
    Ok(EntryDetails::Run(Box::new(RunDetails {
        strategy: None,
        controller: champion.genome.controller.kind(),
        rewarded: champion.trial.fitness,
        finished: latest,
        generations: None,
        best: Some((latest, champion.evaluation.fitness)),
        best_of_each: Vec::new(),
        champions,
        ended: Some(match error {
            SaveError::Invalid { source, .. } => source.to_string(),
            other => other.to_string(),
        }),
        thumbnail: Thumbnail::of_champion(&champion, recording.as_ref()),
        preset: champion.origin.preset,
        seed: champion.origin.seed,
    })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ENGINE_VERSION;
    use crate::save::library::fixtures::{champion_in, run_in, saves};
    use crate::save::library::list;
    use std::fs;

    #[test]
    fn every_shipped_champion_can_be_read() {
        for (name, _) in SHIPPED {
            let EntryDetails::Champion(details) =
                read_entry(&SavePlace::Shipped(name)).expect("whole")
            else {
                panic!("{name} is no champion");
            };
            assert!(details.climbed >= 3, "{name} climbs {}", details.climbed);
            let (loaded, generation) = load_entry(&SavePlace::Shipped(name)).expect("whole");
            let parts = loaded.champion.body().parts.len();
            assert_eq!(details.thumbnail.parts_m.len(), parts, "{name} is on record");
            assert_eq!(loaded.champion.origin, details.origin);
            assert_eq!(generation, None);
        }
        let EntryDetails::Champion(fast) = read_entry(&SavePlace::Shipped("fast")).expect("whole")
        else {
            panic!("no champion");
        };
        assert!(fast.note.expect("explained").starts_with("The fast one: it has learned"));
    }

    #[test]
    fn a_runs_details_name_its_progress_and_its_best_champion() {
        let (_folder, saves) = saves();
        let place = run_in(&saves, 3);
        let EntryDetails::Run(run) = read_entry(&place).expect("whole") else { panic!("no run") };
        assert_eq!((run.preset.as_str(), run.seed), ("test", 3));
        assert_eq!(run.finished, 2);
        assert_eq!(run.generations.as_deref(), Some("2 of 4 generations"));
        assert_eq!(run.champions, [1, 2]);
        assert_eq!(run.ended, None);
        assert_eq!(run.best_of_each.len(), 2);
        let (best, fitness) = run.best.expect("a healthy individual");
        assert_eq!(run.best_of_each[best as usize - 1], Some(fitness));
        let (loaded, generation) = load_entry(&place).expect("whole");
        assert_eq!((generation, loaded.champion.evaluation.fitness), (Some(best), fitness));
    }

    #[test]
    fn a_run_of_another_engine_can_be_shown_but_not_continued() {
        let (_folder, saves) = saves();
        let place = run_in(&saves, 1);
        let file = place.path().expect("a folder").join("run.ron");
        let text = fs::read_to_string(&file).expect("read");
        fs::write(&file, text.replace(&format!("engine: {ENGINE_VERSION}"), "engine: 1"))
            .expect("written");
        let EntryDetails::Run(run) = read_entry(&place).expect("seen") else { panic!("no run") };
        assert!(run.ended.expect("it has").contains("engine is 1"));
        assert!(load_entry(&place).is_ok());
    }

    #[test]
    fn a_damaged_entry_gives_its_error_and_the_others_can_be_read() {
        let (folder, saves) = saves();
        champion_in(&saves, "good");
        let text = fs::read_to_string(folder.path().join("good.ron")).expect("read");
        fs::write(folder.path().join("cut.ron"), &text[..text.len() / 2]).expect("written");
        fs::write(folder.path().join("empty.ron"), "").expect("written");
        fs::write(folder.path().join("other.ron"), "(kind: \"a recipe\")").expect("written");
        let run = run_in(&saves, 1);
        fs::write(run.path().expect("a folder").join("log.jsonl"), "{}\n").expect("written");
        let entries = list(&saves).expect("listed");
        let own = entries.iter().filter(|entry| entry.place.path().is_some());
        let read = |entry: &crate::save::library::LibraryEntry| {
            let problem = read_entry(&entry.place).err().map(|error| error.to_string());
            (entry.place.name(), problem)
        };
        for (name, problem) in own.map(read) {
            let expected = match name.as_str() {
                "good" => None,
                "cut" | "empty" => Some("damaged or incomplete at line"),
                "other" => Some("kind is \"a recipe\""),
                _ => Some("log.jsonl: damaged or incomplete at line 1"),
            };
            assert_eq!(problem.is_some(), expected.is_some(), "{name}: {problem:?}");
            let problem = problem.unwrap_or_default();
            assert!(problem.contains(expected.unwrap_or_default()), "{name}: {problem}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_device_is_not_read() {
        let (folder, saves) = saves();
        let link = folder.path().join("zero.ron");
        std::os::unix::fs::symlink("/dev/zero", &link).expect("linked");
        let listed = list(&saves).expect("listed");
        let place = SavePlace::Champion(link);
        assert!(listed.iter().any(|entry| entry.place == place));
        let error = read_entry(&place).expect_err("refused").to_string();
        assert!(
            error.ends_with("zero.ron: cannot be read: it is a link or not a regular file"),
            "{error}"
        );
    }
}
