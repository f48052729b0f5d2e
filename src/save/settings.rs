//! Settings as presets and runs hold them, format 1. Never changed once released.

use serde::{Deserialize, Serialize};

use super::mirror::mirrors;
use super::v2::TrialV2;
use crate::evolve::{HalvingSettings, Settings};
use crate::genome::GenomeSpace;

mirrors! {
    SettingsV1 = Settings { trial: TrialV2, genome: SpaceV1, evolution: HalvingV1 }
    SpaceV1 = GenomeSpace {
        torque_range_nm: f32,
        torque_step_nm: f32,
        points_per_s: f32,
        bend_limits_rad: Vec<f32>,
        twist_limits_rad: Vec<f32>,
        density_min_kg_m3: f32,
        density_max_kg_m3: f32,
    }
    HalvingV1 = HalvingSettings {
        population: u32,
        generations: u32,
        parents: u32,
        mutation_range_nm: f32,
        mutation_decay: f32,
    }
}
