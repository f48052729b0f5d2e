//! What can be put on the stage: a champion, where it is from, how it is shown.

use std::sync::Arc;

use crate::check::Invalid;
use crate::evolve::Champion;
use crate::save::LoadedChampion;
use crate::score::{Recording, Trial};

/// A champion with the words under it.
#[derive(Debug, Clone)]
pub(super) struct Exhibit {
    champion: Champion,
    name: String,
    source: Source,
    /// The engine that found it and what it looked like there, if that was another engine than this.
    elsewhere: Option<(u32, Option<Arc<Recording>>)>,
    manner: Manner,
}

/// Where an exhibit is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// A save the studio opened with; the first is 0.
    Opening(usize),
    /// An entry of the library, by a number that stands for its place.
    Library(u64),
    /// A run of this session; the first is 0. The generation is the champion's origin's.
    Run(u32),
    /// A lesson.
    Lesson,
}

/// How an exhibit is shown.
#[derive(Debug, Clone, PartialEq)]
enum Manner {
    /// As it was found. What another engine found is played from its recording, if there is one.
    Found,
    /// Simulated by this engine, in the world in which it was found.
    Simulated,
    /// Simulated by this engine in another world, and what is other there.
    Changed(Box<Trial>, String),
}

impl Exhibit {
    /// A champion from a file: which of those that the studio opened with, and its name.
    pub fn saved(loaded: &LoadedChampion, index: usize, name: &str) -> Self {
        let recording = loaded.recording.clone().map(Arc::new);
        Self {
            champion: loaded.champion.clone(),
            name: name.to_owned(),
            source: Source::Opening(index),
            elsewhere: (!loaded.is_of_this_engine()).then_some((loaded.engine, recording)),
            manner: Manner::Found,
        }
    }

    /// A champion of the library: the number that stands for its place, and its name.
    pub fn of_library(loaded: &LoadedChampion, place: u64, name: &str) -> Self {
        Self { source: Source::Library(place), ..Self::saved(loaded, 0, name) }
    }

    /// Somebody that a run of this session found.
    pub fn found(champion: &Champion, run: u32) -> Self {
        Self {
            champion: champion.clone(),
            name: format!("Generation {}", champion.origin.generation),
            source: Source::Run(run),
            elsewhere: None,
            manner: Manner::Found,
        }
    }

    /// Somebody whom a lesson shows.
    pub fn of_lesson(champion: &Champion) -> Self {
        Self { source: Source::Lesson, ..Self::found(champion, 0) }
    }

    /// The same under another name.
    pub fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// The same in another world, in which this is other. It may not fit there: see [`Self::check`].
    pub fn in_world(&self, trial: &Trial, what_is_other: String) -> Self {
        if *trial == self.champion.trial {
            return self.as_found();
        }
        let manner = Manner::Changed(Box::new(trial.clone()), what_is_other);
        Self { manner, ..self.clone() }
    }

    /// Checks that its genome can be built in the world in which it is to be shown.
    pub fn check(&self) -> Result<(), Invalid> {
        self.trial().check().map_err(|error| error.inside("trial"))?;
        self.trial().check_genome(&self.champion.genome).map_err(|error| error.inside("genome"))
    }

    /// The same as it was found.
    pub fn as_found(&self) -> Self {
        Self { manner: Manner::Found, ..self.clone() }
    }

    /// The same, simulated by this engine, if it is not already.
    pub fn simulated(&self) -> Self {
        let manner = match &self.manner {
            Manner::Found if self.recording().is_some() => Manner::Simulated,
            other => other.clone(),
        };
        Self { manner, ..self.clone() }
    }

    /// Whether it is shown in another world than the one in which it was found.
    pub fn is_changed(&self) -> bool {
        matches!(self.manner, Manner::Changed(..))
    }

    /// The recording that is played in place of a simulation, if one is.
    pub fn recording(&self) -> Option<&Arc<Recording>> {
        match (&self.manner, &self.elsewhere) {
            (Manner::Found, Some((_, recording))) => recording.as_ref(),
            _ => None,
        }
    }

    /// The engine that found it, if that was another one than this.
    pub fn other_engine(&self) -> Option<u32> {
        self.elsewhere.as_ref().map(|(engine, _)| *engine)
    }

    /// Whether a simulation should end as recorded, because this engine recorded it in this world.
    pub fn must_match_record(&self) -> bool {
        self.elsewhere.is_none() && !self.is_changed()
    }

    /// Whether it is shown otherwise than it was found, though it could be.
    pub fn could_be_as_found(&self) -> bool {
        let is_resimulated = self.manner == Manner::Simulated && self.has_recording();
        self.is_changed() || is_resimulated
    }

    fn has_recording(&self) -> bool {
        matches!(self.elsewhere, Some((_, Some(_))))
    }

    /// The champion as it was found.
    pub fn champion(&self) -> &Champion {
        &self.champion
    }

    /// The world in which it is shown.
    pub fn trial(&self) -> &Trial {
        match &self.manner {
            Manner::Changed(trial, _) => trial,
            Manner::Found | Manner::Simulated => &self.champion.trial,
        }
    }

    /// Where it is from.
    pub fn source(&self) -> Source {
        self.source
    }

    /// The generation it is from, in whichever run; the first is 1.
    pub fn generation(&self) -> u32 {
        self.champion.origin.generation
    }

    /// What it reached.
    pub fn fitness(&self) -> f32 {
        self.champion.evaluation.fitness
    }

    /// What it is called, in a word or two.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What tells it from its neighbours: its name, or what is other in its world.
    pub fn label(&self) -> &str {
        match &self.manner {
            Manner::Changed(_, what_is_other) => what_is_other,
            Manner::Found | Manner::Simulated => &self.name,
        }
    }

    /// What it is and what it reached, in a line.
    pub fn caption(&self) -> String {
        let name = &self.name;
        let manner = match (&self.manner, self.other_engine()) {
            (Manner::Changed(_, what), _) => {
                // What that place means was said of another world.
                return format!("{name} with {what}; as found {}", self.champion.score());
            }
            (_, None) => ": ".to_owned(),
            (_, Some(engine)) if self.recording().is_some() => {
                format!(" as engine {engine} recorded it: ")
            }
            (_, Some(engine)) => format!(" simulated anew; engine {engine} recorded "),
        };
        format!("{name}{manner}{}", self.champion.reached())
    }
}
