//! The outcome of a task, and its form in messages.

use serde::{Deserialize, Serialize};

use super::wire::{WireError, line_of, parse_line};
use snakes_core::check::{Invalid, quoted, within};
use snakes_core::learn::Episode;
use snakes_core::score::{Evaluation, ExamEnd, Scored};
use snakes_core::world::Disqualification;
use snakes_lab::run::EvaluationResult;

/// Maximum length of a panic's message, in bytes.
const LONGEST_MESSAGE: usize = 4000;

/// The outcome of a task.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Score of a genome in a trial, or the message of a panic.
    Scored(EvaluationResult),
    /// End of an exam under one condition.
    Examined(ExamEnd),
    /// The task could not be read, or the task or its result is too large. Holds the reason.
    Refused(String),
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum OutcomeLine {
    Scored(ScoredLine),
    Panicked(String),
    Examined(ExamEnd),
    Refused(String),
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScoredLine {
    disqualified: Option<Disqualification>,
    recorded: Evaluation,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    episode: Option<Episode>,
}

impl Outcome {
    /// Returns the outcome as a line of JSON. Numbers are written exactly, so equal lines mean equal bits.
    pub fn line(self) -> String {
        let short = |text: String| text.chars().take(LONGEST_MESSAGE / 4).collect::<String>();
        line_of(&match self {
            Self::Scored(Ok(Scored { evaluation, episode })) => OutcomeLine::Scored(ScoredLine {
                disqualified: evaluation.disqualified,
                recorded: evaluation,
                episode,
            }),
            Self::Scored(Err(message)) => OutcomeLine::Panicked(short(message)),
            Self::Examined(end) => OutcomeLine::Examined(end),
            Self::Refused(message) => OutcomeLine::Refused(short(message)),
        })
    }

    /// Reads an outcome and checks every value.
    ///
    /// # Errors
    /// The line is damaged, or a value is not allowed.
    pub fn read(line: &str) -> Result<Self, WireError> {
        let short = |message: String| -> Result<String, Invalid> {
            within("length of the message", message.len(), 0..=LONGEST_MESSAGE)?;
            Ok(message)
        };
        Ok(match parse_line(line)? {
            OutcomeLine::Scored(ScoredLine { disqualified, recorded, episode }) => {
                recorded.check()?;
                let evaluation = Evaluation { disqualified, ..recorded };
                if let Some(episode) = &episode {
                    episode.check()?;
                }
                Self::Scored(Ok(Scored { evaluation, episode }))
            }
            OutcomeLine::Panicked(message) => Self::Scored(Err(short(message)?)),
            OutcomeLine::Examined(end) => {
                end.check()?;
                Self::Examined(end)
            }
            OutcomeLine::Refused(message) => Self::Refused(short(message)?),
        })
    }

    /// Checks that the outcome belongs to a task of this kind.
    ///
    /// # Errors
    /// The outcome belongs to a task of the other kind.
    pub fn check_kind(&self, kind: super::wire::TaskKind) -> Result<(), WireError> {
        use super::wire::TaskKind::{Examine, Score};
        match (self, kind) {
            (Self::Scored(_), Score) | (Self::Examined(_), Examine) | (Self::Refused(_), _) => {
                Ok(())
            }
            _ => {
                let problem =
                    format!("an outcome of another kind than {}", quoted(&line_of(&kind)));
                Err(WireError::Damaged(problem))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::genome::Genome;
    use snakes_core::rng::{Purpose, stream};
    use snakes_core::save::{load_preset, shipped_champion};
    use snakes_core::score::Trial;
    use snakes_lab::run::evaluate_caught;

    fn scored(genome: &Genome, trial: &Trial) -> Outcome {
        Outcome::Scored(evaluate_caught(genome, trial))
    }

    #[test]
    fn every_bit_of_an_outcome_is_read_again() {
        for preset in ["climb", "senses", "waves-by-rules", "q-learning", "xcs"] {
            let mut settings = load_preset(preset).expect("shipped").settings;
            settings.trial.duration_s = 3.0;
            let mut rng = stream(1, 1, 3, Purpose::Birth);
            let shape = settings.trial.genome_shape();
            let genome = settings.genome.random_genome(shape, &mut rng);
            let outcome = scored(&genome, &settings.trial);
            let read = Outcome::read(&outcome.clone().line()).expect("read");
            assert_eq!(read, outcome, "{preset}");
            // Genome and trial must survive JSON as well.
            let again: Genome = parse_line(&line_of(&genome)).expect("read");
            assert_eq!(again.hash(), genome.hash(), "{preset}");
            let trial: Trial = parse_line(&line_of(&settings.trial)).expect("read");
            assert_eq!(trial, settings.trial, "{preset}");
        }
        let panicked = Outcome::Scored(Err("index out of bounds".to_owned()));
        assert_eq!(Outcome::read(&panicked.clone().line()), Ok(panicked));
    }

    #[test]
    fn a_wrong_value_is_refused_and_named() {
        let champion = shipped_champion().expect("well formed").champion;
        let line = Outcome::Scored(Ok(Scored { evaluation: champion.evaluation, episode: None }));
        let line = line.line();
        for (from, to, problem) in [
            ("\"fitness\":", "\"fitness\":1e30,\"x\":", "unknown field `x`"),
            ("\"steps\":", "\"steps\":-", "invalid value"),
            ("\"trace_hash\":\"", "\"trace_hash\":\"g", "hash is"),
        ] {
            let error = Outcome::read(&line.replace(from, to)).expect_err("refused").to_string();
            assert!(error.contains(problem), "{error}");
        }
        let end = ExamEnd { way: 0.5, ..ExamEnd::CRASHED };
        let line = Outcome::Examined(end).line().replace("0.5", "1.5");
        let error = Outcome::read(&line).expect_err("refused").to_string();
        assert!(error.contains("way is 1.5; allowed: 0 to 1"), "{error}");
    }
}
