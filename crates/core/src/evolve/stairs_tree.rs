//! The tree of the stairs that evolved in a run, each with the snake that climbs it best.

use serde::{Deserialize, Serialize};

use super::plan::RunPlan;
use crate::check::{Invalid, within};
use crate::genome::{Genome, StairsGenome};
use crate::schema::check;
use crate::score::Trial;

/// All stairs of a run in the order in which they were created; the first is the root.
#[derive(Debug, Clone, PartialEq)]
pub struct StairsTree {
    /// Number of finished rounds of the run.
    pub rounds: u32,
    /// All stairs so far, archived ones included.
    pub nodes: Vec<StairsNode>,
    /// Latest transfers of snakes between stairs, the earliest first.
    pub transfers: Vec<Transfer>,
}

/// A staircase and its agent, which is the snake that climbs it best.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsNode {
    /// Genes of the staircase.
    pub stairs: StairsGenome,
    /// Index of the staircase of which this one is a mutant. None for the root.
    pub parent: Option<u32>,
    /// Round at whose end the staircase was created; 0 for the root.
    pub born: u32,
    /// Round at whose end the staircase was archived, after which its agent does not learn. None while the staircase is active.
    pub archived: Option<u32>,
    /// Round in which the agent first solved the staircase. None if it has not.
    pub solved: Option<u32>,
    /// Whether the staircase, when it was created, was neither too easy nor too hard for the best of the active agents and of the copies of
    /// earlier agents. A copy was made when the stairs of its agent were created.
    pub is_new_challenge: bool,
    /// The snake that climbs the staircase best. None before the first measurement of the root.
    pub agent: Option<Agent>,
    /// Mean share of the way that the agent covered over the nominal and the perturbed trials, when last measured. A new mutant has the
    /// share of the nominal trial. 0 without an agent.
    pub score: f32,
    /// Number of trials simulated on the staircase.
    pub trials: u64,
}

/// A snake that was found in a run, with the position at which it was first evaluated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Agent {
    /// Genome of the snake.
    pub genome: Genome,
    /// Generation of the first evaluation; 0 for the founder of the run.
    pub generation: u32,
    /// Index within the generation.
    pub individual: u32,
}

/// The transfer of an agent to other stairs, where it replaced the agent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transfer {
    /// Round of the transfer.
    pub round: u32,
    /// Index of the stairs from which the agent was copied.
    pub from: u32,
    /// Index of the stairs whose agent was replaced.
    pub to: u32,
}

impl StairsNode {
    /// Makes a staircase without a parent, such as the first of a run, and without an agent.
    pub(super) fn new(stairs: StairsGenome) -> Self {
        Self {
            stairs,
            parent: None,
            born: 0,
            archived: None,
            solved: None,
            is_new_challenge: false,
            agent: None,
            score: 0.0,
            trials: 0,
        }
    }

    /// Checks that the staircase can have the index `index` in a run that has reached round `round`.
    ///
    /// # Errors
    /// Names the first value that is not allowed.
    pub fn check(&self, index: usize, round: u32, plan: &RunPlan) -> Result<(), Invalid> {
        check(&self.stairs)?;
        check_score("score", self.score)?;
        // A parent has a lower index than its child; only the root has no parent.
        if self.parent.is_none_or(|parent| parent as usize >= index) != (index == 0) {
            let found = self.parent.map_or("none".to_owned(), |parent| parent.to_string());
            return Err(Invalid::new("parent", found, "earlier stairs, and none of the first"));
        }
        within("born", self.born, 0..=round)?;
        self.agent.as_ref().map_or(Ok(()), |agent| plan.check_genome(&agent.genome))
    }

    /// Returns a trial of the run on this staircase.
    pub fn trial(&self, trial: &Trial) -> Trial {
        trial.on_stairs(self.stairs.stairs())
    }
}

impl StairsTree {
    /// Counts the accumulated novel environments created and solved (ANNECS, Wang et al., "Enhanced POET", 2020): stairs that were neither
    /// too easy nor too hard for any agent of the run when they were created, and that were solved later.
    pub fn solved_challenges(&self) -> usize {
        self.nodes.iter().filter(|node| node.is_new_challenge && node.solved.is_some()).count()
    }

    /// Counts the stairs that were solved.
    pub fn solved(&self) -> usize {
        self.nodes.iter().filter(|node| node.solved.is_some()).count()
    }

    /// Counts the active stairs, whose agents still learn.
    pub fn active(&self) -> usize {
        self.nodes.iter().filter(|node| node.archived.is_none()).count()
    }
}

/// Counts of stairs in a run whose stairs evolve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsCount {
    /// Number of finished rounds of the run.
    pub rounds: u32,
    /// Number of all stairs so far.
    pub all: u32,
    /// Number of active stairs, whose agents still learn.
    pub active: u32,
    /// Number of stairs that were solved.
    pub solved: u32,
    /// Number of solved stairs that were neither too easy nor too hard for any agent when they were created (ANNECS).
    pub challenges: u32,
}

impl StairsCount {
    /// Counts the stairs of a tree.
    pub fn of(tree: &StairsTree) -> Self {
        Self {
            rounds: tree.rounds,
            all: tree.nodes.len() as u32,
            active: tree.active() as u32,
            solved: tree.solved() as u32,
            challenges: tree.solved_challenges() as u32,
        }
    }

    /// Describes the counts in words, beginning with the number of the round in progress.
    pub fn words(self) -> String {
        let Self { rounds, all, active, solved, challenges } = self;
        let round = rounds.saturating_add(1);
        let words = format!("round {round}, {all} stairs, {active} active, {solved} solved");
        match challenges {
            // The strategies that do not determine new challenges always count 0.
            0 => words,
            _ => format!("{words}, {challenges} new challenges"),
        }
    }

    /// Checks that the counts are consistent with each other.
    ///
    /// # Errors
    /// Names the first count that is not allowed.
    pub fn check(self) -> Result<(), Invalid> {
        within("stairs.active", self.active, 0..=self.all)?;
        within("stairs.solved", self.solved, 0..=self.all)?;
        within("stairs.challenges", self.challenges, 0..=self.solved)
    }
}

/// Greatest score that a file may have. Scores that the program writes are at most 1.1.
const MOST_SCORE: f32 = 10.0;

/// Checks a share of the way that was read from a file.
///
/// # Errors
/// Fails if `score` is negative or greater than `MOST_SCORE`.
pub fn check_score(field: &str, score: f32) -> Result<(), Invalid> {
    within(field, score, 0.0..=MOST_SCORE)
}
