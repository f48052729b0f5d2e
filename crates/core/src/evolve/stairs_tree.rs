//! Stairs that evolved in a run, each with the snake that climbs it best: a tree by descent.

use serde::{Deserialize, Serialize};

use super::plan::RunPlan;
use crate::check::{Invalid, within};
use crate::genome::{Genome, StairsGenome};
use crate::schema::check;
use crate::score::Trial;

/// The stairs of a run, in the order in which they came; the first is the root.
#[derive(Debug, Clone, PartialEq)]
pub struct StairsTree {
    /// Number of finished rounds.
    pub rounds: u32,
    /// All stairs so far.
    pub nodes: Vec<StairsNode>,
    /// The latest transfers of snakes between stairs, the earliest first.
    pub transfers: Vec<Transfer>,
}

/// A staircase and its agent: the snake that climbs it best.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsNode {
    /// The staircase.
    pub stairs: StairsGenome,
    /// Index of the staircase of which it is a mutant; none for the root.
    pub parent: Option<u32>,
    /// The round at whose end it came; 0 for the root.
    pub born: u32,
    /// The round at whose end it was archived, after which its agent no longer learns; none while it is active.
    pub archived: Option<u32>,
    /// The round in which its agent first solved it.
    pub solved: Option<u32>,
    /// Whether it was neither too easy nor too hard, when it came, for the best of the active agents and of a copy of each
    /// earlier one as it was when its stairs came.
    pub is_new_challenge: bool,
    /// Its agent; none before the root's first measurement.
    pub agent: Option<Agent>,
    /// The agent's mean share of the way over the nominal and the perturbed trials, when it was last measured; a mutant
    /// begins with the share of the nominal trial. 0 without an agent.
    pub score: f32,
    /// Trials simulated on it.
    pub trials: u64,
}

/// A snake that was found in a run, and the place where it was first evaluated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Agent {
    /// Its genes.
    pub genome: Genome,
    /// The generation; 0 for the founder of the run.
    pub generation: u32,
    /// The index within the generation.
    pub individual: u32,
}

/// The transfer of an agent to other stairs, whose agent it replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transfer {
    /// The round.
    pub round: u32,
    /// Index of the stairs from which the agent came.
    pub from: u32,
    /// Index of the stairs to which it went.
    pub to: u32,
}

impl Agent {
    /// Checks that a run with this plan can have found it.
    ///
    /// # Errors
    /// Its genes do not fit.
    pub fn check(&self, plan: &RunPlan) -> Result<(), Invalid> {
        plan.check_genome(&self.genome)
    }
}

impl StairsNode {
    /// The first stairs of a run, without an agent.
    pub(super) fn root(stairs: StairsGenome) -> Self {
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

    /// Checks that these stairs can be number `index`, from 0, of a run that has come to this round.
    ///
    /// # Errors
    /// The first value that is not allowed.
    pub fn check(&self, index: usize, round: u32, plan: &RunPlan) -> Result<(), Invalid> {
        check(&self.stairs)?;
        check_score("score", self.score)?;
        // The parent comes before its child; the root has none.
        if self.parent.is_none_or(|parent| parent as usize >= index) != (index == 0) {
            let found = self.parent.map_or("none".to_owned(), |parent| parent.to_string());
            return Err(Invalid::new("parent", found, "earlier stairs, and none of the first"));
        }
        within("born", self.born, 0..=round)?;
        self.agent.as_ref().map_or(Ok(()), |agent| agent.check(plan))
    }

    /// A trial of the run on these stairs.
    pub fn trial(&self, trial: &Trial) -> Trial {
        trial.on_stairs(self.stairs.stairs())
    }
}

impl StairsTree {
    /// Number of accumulated novel environments created and solved (ANNECS, Wang et al., "Enhanced POET", 2020): stairs that
    /// were neither too easy nor too hard for any agent of the run so far and that were solved later.
    pub fn solved_challenges(&self) -> usize {
        self.nodes.iter().filter(|node| node.is_new_challenge && node.solved.is_some()).count()
    }

    /// Number of stairs that were solved.
    pub fn solved(&self) -> usize {
        self.nodes.iter().filter(|node| node.solved.is_some()).count()
    }

    /// Number of stairs whose agents still learn.
    pub fn active(&self) -> usize {
        self.nodes.iter().filter(|node| node.archived.is_none()).count()
    }
}

/// Numbers of the stairs of a run whose stairs evolve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsCount {
    /// Finished rounds.
    pub rounds: u32,
    /// All stairs so far.
    pub all: u32,
    /// Stairs whose snakes still learn.
    pub active: u32,
    /// Stairs that were solved.
    pub solved: u32,
    /// Solved stairs that were neither too easy nor too hard for any snake when they came (ANNECS).
    pub challenges: u32,
}

impl StairsCount {
    /// The numbers of a tree.
    pub fn of(tree: &StairsTree) -> Self {
        Self {
            rounds: tree.rounds,
            all: tree.nodes.len() as u32,
            active: tree.active() as u32,
            solved: tree.solved() as u32,
            challenges: tree.solved_challenges() as u32,
        }
    }

    /// The numbers of rounds, stairs and challenges in words.
    pub fn words(self) -> String {
        let Self { rounds, all, active, solved, challenges } = self;
        let round = rounds.saturating_add(1);
        let words = format!("round {round}, {all} stairs, {active} active, {solved} solved");
        match challenges {
            // Not every strategy knows new challenges.
            0 => words,
            _ => format!("{words}, {challenges} new challenges"),
        }
    }

    /// Checks that these numbers go together.
    ///
    /// # Errors
    /// The first that is not allowed.
    pub fn check(self) -> Result<(), Invalid> {
        within("stairs.active", self.active, 0..=self.all)?;
        within("stairs.solved", self.solved, 0..=self.all)?;
        within("stairs.challenges", self.challenges, 0..=self.solved)
    }
}

/// Greatest score in a file. A share is at most 1.1.
const MOST_SCORE: f32 = 10.0;

/// Checks a share of the way in a file.
///
/// # Errors
/// It is negative, or greater than any share.
pub fn check_score(field: &str, score: f32) -> Result<(), Invalid> {
    within(field, score, 0.0..=MOST_SCORE)
}
