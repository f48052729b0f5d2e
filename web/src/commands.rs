//! The commands of a page to this module, and their answers.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Value, json};
use snakes_core::ENGINE_VERSION;
use snakes_core::save::parse_champion;

use crate::evolution::Evolution;
use crate::replay::Replay;

/// A command of the page, as JSON.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    /// Return the version of the engine.
    Engine,
    /// Begin to simulate a champion.
    Begin {
        /// Text of the champion's file.
        champion: String,
        /// Friction of stairs and ground; `None` for the champion's own.
        #[serde(default)]
        friction: Option<f32>,
    },
    /// Take physics steps.
    Advance {
        /// Maximum number of steps.
        steps: u32,
        /// Whether the answer has the poses after each step.
        poses: bool,
    },
    /// Begin to evolve from a champion.
    Evolve {
        /// Text of the champion's file.
        champion: String,
        /// Friction of stairs and ground; `None` for the champion's own.
        #[serde(default)]
        friction: Option<f32>,
        /// Seed of the search.
        seed: u64,
        /// Number of individuals in a generation.
        population: u32,
    },
    /// Evaluate the next individual.
    Next,
    /// Return the text of the best individual's file.
    Best,
}

/// State of a page: the replay and the evolution that it has begun.
#[derive(Default)]
pub struct Page {
    replay: Option<Replay>,
    evolution: Option<Evolution>,
}

impl Page {
    /// Creates the state of a page that has begun nothing.
    pub const fn new() -> Self {
        Self { replay: None, evolution: None }
    }

    /// Carries out a command, and returns the answer as JSON. If the command fails, the answer has the reason in the field `error`.
    pub fn answer(&mut self, command: &[u8]) -> String {
        let command: Result<Command, _> = serde_json::from_slice(command);
        let answer = command.map_err(|error| error.to_string());
        let answer = answer.and_then(|command| self.carry_out(command));
        answer.unwrap_or_else(|error| json!({ "error": error })).to_string()
    }

    fn carry_out(&mut self, command: Command) -> Result<Value, String> {
        match command {
            Command::Engine => Ok(json!({ "engine": ENGINE_VERSION })),
            Command::Begin { champion, friction } => {
                let loaded = champion_of(&champion)?;
                let replay = Replay::begin(loaded, friction)?;
                let answer = replay.start();
                self.replay = Some(replay);
                Ok(answer)
            }
            Command::Advance { steps, poses } => {
                let replay = self.replay.as_mut().ok_or("nothing has begun")?;
                Ok(replay.advance(steps, poses))
            }
            Command::Evolve { champion, friction, seed, population } => {
                let loaded = champion_of(&champion)?;
                let evolution = Evolution::begin(loaded, friction, seed, population)?;
                let answer = evolution.state();
                self.evolution = Some(evolution);
                Ok(answer)
            }
            Command::Next => Ok(self.evolution.as_mut().ok_or("nothing has begun")?.next()),
            Command::Best => self.evolution.as_ref().ok_or("nothing has begun")?.best(),
        }
    }
}

fn champion_of(text: &str) -> Result<snakes_core::evolve::Champion, String> {
    let loaded = parse_champion(Path::new("champion.ron"), text);
    Ok(loaded.map_err(|error| error.to_string())?.champion)
}
