//! Format 3 of a saved champion, which is only read: format 2, what the champion looked like, and
//! what its run demanded of it.

use serde::{Deserialize, Serialize};

use super::mirror::mirrors;
use super::poses::PosesV3;
use super::v2::{ChampionV2, GenomeV2, OriginV2, RecordedV2, TrialV2};
use crate::check::{Invalid, within};
use crate::world::Effort;

/// What every file of this kind says first.
pub const KIND: &str = "snakes-and-stairs champion";
/// The whole file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV3 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    pub origin: OriginV2,
    pub recorded: RecordedV3,
    pub trial: TrialV2,
    pub genome: GenomeV2,
    pub poses: Option<PosesV3>,
}

/// What the champion reached when it was found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedV3 {
    pub fitness: f32,
    pub centre_y_m: f32,
    pub steps: u32,
    pub trace_hash: String,
    /// None in what formats 1 and 2 recorded.
    pub effort: Option<EffortV3>,
}

mirrors! {
    EffortV3 = Effort {
        energy_j: f32,
        top_speed_m_s: f32,
        joint_drift_m: f32,
        sideways_m: f32,
    }
}

impl EffortV3 {
    /// Checks every value.
    pub fn check(&self) -> Result<(), Invalid> {
        for (field, value) in [
            ("energy_j", self.energy_j),
            ("top_speed_m_s", self.top_speed_m_s),
            ("joint_drift_m", self.joint_drift_m),
            ("sideways_m", self.sideways_m),
        ] {
            within(field, value, 0.0..=1.0e12)?;
        }
        Ok(())
    }
}

impl From<RecordedV2> for RecordedV3 {
    fn from(file: RecordedV2) -> Self {
        let RecordedV2 { fitness, centre_y_m, steps, trace_hash } = file;
        Self { fitness, centre_y_m, steps, trace_hash, effort: None }
    }
}

impl From<ChampionV2> for ChampionV3 {
    fn from(file: ChampionV2) -> Self {
        let ChampionV2 { kind, format: _, engine, origin, recorded, trial, genome } = file;
        let recorded = recorded.into();
        Self { kind, format: 3, engine, origin, recorded, trial, genome, poses: None }
    }
}
