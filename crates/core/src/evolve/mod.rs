//! Evolution: the settings and the plan of a run, and the strategies that search.
//!
//! A strategy proposes candidates and learns from their evaluations. It has no access to the world, a thread or a clock.

mod archives;
mod candidate;
mod champion;
mod generation;
mod parents;
mod plan;
mod settings;
mod stairs_tree;
mod strategies;
mod strategy;
mod wording;

pub use archives::{
    Archive, ArchiveAxis, AxisScale, Descriptor, Elite, EliteGenes, Front, FrontMember,
    body_archive, body_cell, feasible_cells,
};
pub use candidate::{Candidate, OwnStairs};
pub use champion::{Champion, Origin};
pub use generation::{
    BandCount, GenerationRecord, MOST_SPECIES_RECORDED, Rung, SpeciesCount, Statistics, run_hash,
};
pub use parents::{IndividualId, Parents};
pub use plan::{
    Founder, MOST_CHANGES, RunPlan, SettingChange, SettingChanges, may_change_during_run,
};
pub use settings::{
    BodyProtection, CmaEsSettings, Crossover, EvolutionSettings, ExplorationSettings, GaSettings,
    HalvingSettings, LARGEST_POPULATION, LadderSettings, MapElitesSettings, MccSettings, Mutation,
    NeatSettings, NoveltySettings, ParentSelection, PoetSettings, QLearningSettings, RestartKind,
    Settings, StrategyInfo, StrategyKind, XcsRunSettings, ZcsRunSettings, changed_values,
    check_effects, fields, with_field, with_fields, with_value,
};
pub use stairs_tree::{Agent, StairsCount, StairsNode, StairsTree, Transfer};
pub use strategies::{begin, resume};
pub use strategy::{Strategy, StrategyState, ranking};
pub use wording::{changes_in_words, world_in_words};
