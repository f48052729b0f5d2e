//! The runs of the studies of evolving bodies: of chains of blocks, and of creatures.

use serde::{Deserialize, Serialize};

use super::study::StudiedRun;
use crate::check::{Invalid, within};
use crate::score::FITNESS_RANGE;

/// Maximum number of changed snakes of a run.
const MOST_CHANGES: usize = 1000;
/// Maximum length of the text of a tree of joints: 16 letters with parentheses and spaces.
const LONGEST_TREE: usize = 64;

/// The measurements of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyStudyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that its generations spent.
    pub evaluations: u32,
    /// Best share; none if all were disqualified.
    pub share: Option<f32>,
    /// Number of blocks of the best.
    pub blocks: u32,
    /// Changes of structure in the line of descent of the best.
    pub changes: u32,
    /// Those of them in the second half of the generations.
    pub late_changes: u32,
    /// Filled cells of an archive of all that was evaluated.
    pub cells: u32,
    /// Quality-diversity score of this archive.
    pub qd_score: f64,
    /// Changes of the share of the best of the last generation by a split at a random place.
    pub split_changes: Vec<f32>,
    /// The same by an insertion.
    pub insertion_changes: Vec<f32>,
    /// Hash over the run.
    pub run_hash: String,
}

impl StudiedRun for BodyStudyRun {
    const KIND: &'static str = "snakes-and-stairs body study";

    fn seed(&self) -> u64 {
        self.seed
    }

    fn check(&self) -> Result<(), Invalid> {
        within("share", self.share.unwrap_or(0.0), FITNESS_RANGE)?;
        within("qd_score", self.qd_score, 0.0..=1.0e15)?;
        for changes in [&self.split_changes, &self.insertion_changes] {
            within("changes", changes.len(), 0..=MOST_CHANGES)?;
            changes.iter().try_for_each(|&change| within("change", change, FITNESS_RANGE))?;
        }
        Ok(())
    }
}

/// The measurements of a run of creatures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CreatureStudyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that its generations spent.
    pub evaluations: u32,
    /// Evaluations up to the end of the first generation whose best reached the goal; none if none did.
    pub reached_after: Option<u32>,
    /// Best fitness; none if all were disqualified.
    pub fitness: Option<f32>,
    /// Way of the middle of the best creature towards the stairs, in metres.
    pub way_m: f32,
    /// Steps that it climbed.
    pub steps: u32,
    /// Number of its parts.
    pub parts: u32,
    /// Its tree of joints: see `genome::joint_tree`.
    pub tree: String,
    /// Hash over the run.
    pub run_hash: String,
}

impl StudiedRun for CreatureStudyRun {
    const KIND: &'static str = "snakes-and-stairs creature study";

    fn seed(&self) -> u64 {
        self.seed
    }

    fn check(&self) -> Result<(), Invalid> {
        within("fitness", self.fitness.unwrap_or(0.0), FITNESS_RANGE)?;
        within("way_m", self.way_m, -1.0e4..=1.0e4)?;
        within("tree", self.tree.len(), 0..=LONGEST_TREE)
    }
}
