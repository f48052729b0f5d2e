//! Questions that the reader answers by a guess before an experiment, and the comparison with the result.

use super::found::Found;
use super::lesson::LessonScene;
use super::plays::Plays;
use snakes_core::score::{Evaluation, Trial};

/// Maximum difference of final distances that count as equal, in metres.
pub(super) const EQUAL_M: f32 = 1.0;

/// A question that the reader answers by a guess.
#[derive(Debug)]
pub(crate) struct Question {
    /// Text of the question.
    pub text: &'static str,
    /// Quantity that determines the right answer.
    pub asks: Asks,
    /// Finding from the result, which is hidden until the result is shown.
    pub finding: &'static str,
}

/// Quantity that determines the right answer to a question.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Asks {
    /// The lane that ends furthest, or that all end within [`EQUAL_M`].
    Furthest,
    /// Whether the exact end of the scene's snake depends on the playback speed.
    PlaybackSpeed,
    /// The run whose best snake ends furthest.
    BestRun,
    /// Whether both runs have the same hash.
    SameHash,
    /// The run in which the best snake's body changes its structure more often in the second half.
    LateBodyChanges,
}

/// The reader's progress in a scene.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    /// Index of the answer that the reader has guessed.
    pub guess: Option<usize>,
    /// Whether the experiment may run, because the reader has guessed or has decided to watch without a guess.
    pub has_begun: bool,
    /// Whether the result may be shown.
    pub is_revealed: bool,
    /// Conditions of the first lane.
    pub trial: Option<Trial>,
    /// Name of each lane, and the result of its snake.
    pub lanes: Vec<(String, Evaluation)>,
    /// Results of the runs.
    pub runs: Vec<Found>,
    /// Complete playbacks, if the question is about playbacks.
    pub plays: Plays,
}

/// The right answer to a question.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truth {
    /// Index of the right answer.
    pub answer: usize,
    /// Result as a clause of a sentence.
    pub words: String,
}

impl LessonScene {
    /// Returns the answers from which the reader chooses; none without a question.
    pub fn answers(&self) -> Vec<&'static str> {
        let names = || self.sides.iter().map(|side| side.name);
        match self.question.as_ref().map(|question| question.asks) {
            Some(Asks::Furthest | Asks::BestRun) => {
                let near = match self.sides {
                    [_, _] => "both within 1 m of each other",
                    _ => "all within 1 m of each other",
                };
                names().chain([near]).collect()
            }
            Some(Asks::LateBodyChanges) => names().chain(["equally often"]).collect(),
            Some(Asks::PlaybackSpeed) => vec!["no, it ends differently", "yes, in every digit"],
            Some(Asks::SameHash) => vec!["the same hash", "different hashes"],
            None => Vec::new(),
        }
    }
}

impl Progress {
    /// Compares the guess with the result in one sentence; returns `None` before the result may be shown.
    pub fn comparison(&self, scene: &LessonScene) -> Option<String> {
        if !self.is_revealed {
            return None;
        }
        let Truth { answer, words } = self.truth(scene.question.as_ref()?.asks)?;
        let guessed = self.guess.and_then(|guess| scene.answers().get(guess).copied());
        Some(match guessed {
            Some(guessed) if self.guess == Some(answer) => {
                format!("You guessed \"{guessed}\", and you were right: {words}.")
            }
            Some(guessed) => format!("You guessed \"{guessed}\", but {words}."),
            None => format!("Without a guess: {words}."),
        })
    }

    /// Returns whether the result can be shown on request. A question about playbacks needs enough complete playbacks.
    pub fn knows_result(&self, question: &Question) -> bool {
        question.asks != Asks::PlaybackSpeed || self.plays.are_equal().is_some()
    }

    /// Returns the right answer, if it is known.
    pub(super) fn truth(&self, asks: Asks) -> Option<Truth> {
        match asks {
            Asks::Furthest => {
                let healthy = |evaluation: &Evaluation| {
                    evaluation.disqualified.is_none().then_some(evaluation.centre_y_m)
                };
                let ends: Vec<_> =
                    self.lanes.iter().map(|(name, of)| (name.as_str(), healthy(of))).collect();
                furthest(&ends)
            }
            Asks::BestRun => {
                // The panel's table and the worksheet have the fitness, too: the mean place over the last half second.
                let end = |found: &Found| found.best().map(|best| best.evaluation.fitness);
                let ends: Vec<_> =
                    self.runs.iter().map(|found| (found.name.as_str(), end(found))).collect();
                let mut truth = furthest(&ends)?;
                // The distance alone does not tell whether the snake is on the stairs.
                if let Some(best) = self.runs.get(truth.answer).and_then(Found::best) {
                    truth.words += ": it ";
                    truth.words += &best.trial.result_in_words(&best.genome, &best.evaluation);
                }
                Some(truth)
            }
            Asks::PlaybackSpeed => {
                let speeds = self.plays.finished.iter().map(|play| format!("× {}", play.speed));
                let speeds = speeds.collect::<Vec<_>>().join(" and ");
                Some(if self.plays.are_equal()? {
                    let words = format!("end position and hash are the same at {speeds}");
                    Truth { answer: 1, words }
                } else {
                    Truth { answer: 0, words: format!("the motions at {speeds} differ") }
                })
            }
            Asks::LateBodyChanges => {
                let runs = self.runs.iter();
                let late = runs.map(|found| (found.name.as_str(), found.late_body_changes()));
                more_often(&late.collect::<Vec<_>>())
            }
            Asks::SameHash => {
                let hashes: Option<Vec<u64>> = self.runs.iter().map(|of| of.run_hash).collect();
                let [first, second] = hashes?.try_into().ok()?;
                Some(if first == second {
                    Truth { answer: 0, words: "both runs have the same hash".to_owned() }
                } else {
                    Truth { answer: 1, words: "the two hashes differ".to_owned() }
                })
            }
        }
    }
}

/// Returns the competitor that ended furthest, in metres. If all are within [`EQUAL_M`], returns the answer after the last competitor.
fn furthest(ends: &[(&str, Option<f32>)]) -> Option<Truth> {
    let known =
        || ends.iter().enumerate().filter_map(|(index, (_, end_m))| Some((index, (*end_m)?)));
    let (best, most_m) = known().max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let least_m = known().map(|(_, end_m)| end_m).fold(f32::MAX, f32::min);
    let all_are_healthy = known().count() == ends.len();
    Some(if all_are_healthy && most_m - least_m < EQUAL_M {
        let all = if ends.len() == 2 { "both" } else { "all" };
        let words = format!("{all} end between {least_m:.2} m and {most_m:.2} m");
        Truth { answer: ends.len(), words }
    } else {
        let words = format!("\"{}\" gets furthest, to {most_m:.2} m", ends[best].0);
        Truth { answer: best, words }
    })
}

/// Returns the run in which the counted event was most frequent. If it was equally frequent in all, returns the answer
/// after the last run.
fn more_often(counts: &[(&str, usize)]) -> Option<Truth> {
    let most = counts.iter().map(|(_, count)| *count).max()?;
    let first = counts.iter().position(|(_, count)| *count == most)?;
    let all_are_equal = counts.iter().all(|(_, count)| *count == most);
    let words: Vec<String> =
        counts.iter().map(|(name, count)| format!("{count} times \"{name}\"")).collect();
    let answer = if all_are_equal { counts.len() } else { first };
    Some(Truth { answer, words: format!("it changed {}", words.join(" and ")) })
}

#[cfg(test)]
mod tests {
    use super::super::LESSONS;
    use super::*;
    use crate::studio::state::current_run::explored_run;

    fn progress(guess: Option<usize>, ends_m: &[f32]) -> Progress {
        let names = ["friction 0.1", "original", "friction 5"].into_iter();
        let lanes = names
            .zip(ends_m)
            .map(|(name, end_m)| (name.to_owned(), Evaluation::of_fitness(*end_m)));
        Progress { guess, lanes: lanes.collect(), ..Progress::default() }
    }

    #[test]
    fn a_guess_is_compared_with_the_result_in_one_sentence_once_that_may_be_seen() {
        let scene = &LESSONS[0].scenes[0];
        let mut right = progress(Some(1), &[2.0, 26.0, 4.0]);
        assert_eq!(right.comparison(scene), None);
        right.is_revealed = true;
        let expected =
            "You guessed \"original\", and you were right: \"original\" gets furthest, to 26.00 m.";
        assert_eq!(right.comparison(scene).as_deref(), Some(expected));
        for (guess, start) in
            [(Some(2), "You guessed \"friction 5\", but"), (None, "Without a guess")]
        {
            let of = Progress { is_revealed: true, ..progress(guess, &[2.0, 26.0, 4.0]) };
            let words = of.comparison(scene).expect("revealed");
            assert!(words.starts_with(start), "{words}");
        }
    }

    #[test]
    fn a25_the_answer_about_the_best_run_names_the_number_of_the_table() {
        let mut report = explored_run().reports[0].clone();
        let best = report.champion.as_mut().expect("a healthy snake");
        (best.evaluation.centre_y_m, best.evaluation.fitness) = (7.76, 7.19);
        let run = Found { reports: vec![report], ..Found::of("one") };
        let progress = Progress { runs: vec![run], ..Progress::default() };
        let words = progress.truth(Asks::BestRun).expect("a run").words;
        assert!(words.contains("7.19 m") && !words.contains("7.76"), "{words}");
    }

    #[test]
    fn ends_within_a_metre_count_as_equally_far() {
        let answer = |of: &Progress| of.truth(Asks::Furthest).map(|truth| truth.answer);
        let mut ends = progress(None, &[25.2, 26.0, 25.9]);
        assert_eq!(answer(&ends), Some(3));
        ends.lanes[0].1.disqualified = Some(snakes_core::world::Disqualification::TooFast);
        assert_eq!(answer(&ends), Some(1), "a disqualified snake ends nowhere");
    }

    #[test]
    fn changes_of_bodies_are_counted_in_words() {
        let of = |first, second| more_often(&[("with", first), ("without", second)]).expect("two");
        assert_eq!(of(3, 0).answer, 0);
        assert_eq!(of(3, 0).words, "it changed 3 times \"with\" and 0 times \"without\"");
        assert_eq!([of(1, 2).answer, of(2, 2).answer], [1, 2]);
    }

    #[test]
    fn playbacks_are_compared_once_two_speeds_were_watched() {
        let scene = &LESSONS[7].scenes[1];
        let mut of = Progress { guess: Some(1), is_revealed: true, ..Progress::default() };
        let mut play = |speed, trace_hash| {
            let end = Evaluation { trace_hash, ..Evaluation::of_fitness(26.0) };
            of.plays.follow(speed, 1.0, None);
            of.plays.follow(speed, 15.0, Some(&end));
            of.comparison(scene)
        };
        assert_eq!(play(1.0, 7), None);
        assert_eq!(play(1.0, 7), None, "the same speed again");
        let words = play(4.0, 7).expect("two speeds");
        assert!(words.ends_with("end position and hash are the same at × 1 and × 4."), "{words}");
        let words = play(0.25, 8).expect("three speeds");
        assert!(words.contains("but the motions at × 1 and × 4 and × 0.25 differ"), "{words}");
    }

    #[test]
    fn every_comparing_scene_asks_for_a_guess() {
        for lesson in &LESSONS {
            assert!(lesson.scenes.iter().any(|scene| scene.question.is_some()), "{}", lesson.title);
            for scene in lesson.scenes {
                let compares = scene.sides.len() > 1;
                assert!(scene.question.is_some() || !compares, "{}", scene.label);
                assert_eq!(scene.answers().is_empty(), scene.question.is_none());
            }
        }
    }
}
