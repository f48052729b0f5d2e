//! Settings as presets and runs hold them: format 1, which is only read, and format 2. Never changed once
//! released.

use serde::{Deserialize, Serialize};

use super::mirror::mirrors;
use super::v2::TrialV2;
use super::v4::TrialV4;
use crate::evolve::{
    CmaEsSettings, Crossover, Descriptor, EvolutionSettings, GaSettings, HalvingSettings,
    MapElitesSettings, Mutation, NoveltySettings, RestartKind, Selection, Settings, StrategyKind,
};
use crate::genome::{ControllerKind, GenomeSpace, WaveSpace};

mirrors! {
    SettingsV2 = Settings { trial: TrialV4, genome: SpaceV2, evolution: EvolutionV2 }
    SpaceV2 = GenomeSpace {
        controller: ControllerKind,
        wave: WaveSpaceV2,
        torque_range_nm: f32,
        torque_step_nm: f32,
        points_per_s: f32,
        bend_limits_rad: Vec<f32>,
        twist_limits_rad: Vec<f32>,
        density_min_kg_m3: f32,
        density_max_kg_m3: f32,
    }
    WaveSpaceV2 = WaveSpace {
        frequency_min_hz: f32,
        frequency_max_hz: f32,
        harmonics: u32,
        angle_range_rad: f32,
        stiffness_min_nm_per_rad: f32,
        stiffness_max_nm_per_rad: f32,
        servo_damping_nms_per_rad: f32,
    }
    EvolutionV2 = EvolutionSettings {
        strategy: StrategyKind,
        population: u32,
        generations: u32,
        halving: HalvingV2,
        ga: GaV2,
        cma_es: CmaEsV2,
        map_elites: MapElitesV2,
        novelty: NoveltyV2,
    }
    HalvingV2 = HalvingSettings { parents: u32, mutation_range_nm: f32, mutation_decay: f32 }
    GaV2 = GaSettings {
        selection: Selection,
        tournament: u32,
        crossover: Crossover,
        crossover_share: f32,
        mutation: Mutation,
        step: f32,
        cooling: f32,
        elites: u32,
    }
    CmaEsV2 = CmaEsSettings { step: f32, active: bool, restarts: RestartKind, newborns: u32 }
    MapElitesV2 = MapElitesSettings {
        x: Descriptor,
        y: Descriptor,
        cells: u32,
        step: f32,
        line: f32,
        cma_share: f32,
        cma_step: f32,
    }
    NoveltyV2 = NoveltySettings {
        weight: f32,
        neighbours: u32,
        remembered: u32,
        archive_limit: u32,
        first: Descriptor,
        second: Descriptor,
    }
}

/// Format 1: the report's method and its signals alone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettingsV1 {
    trial: TrialV2,
    genome: SpaceV1,
    evolution: HalvingV1,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct SpaceV1 {
    torque_range_nm: f32,
    torque_step_nm: f32,
    points_per_s: f32,
    bend_limits_rad: Vec<f32>,
    twist_limits_rad: Vec<f32>,
    density_min_kg_m3: f32,
    density_max_kg_m3: f32,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct HalvingV1 {
    population: u32,
    generations: u32,
    parents: u32,
    mutation_range_nm: f32,
    mutation_decay: f32,
}

impl From<SettingsV1> for SettingsV2 {
    fn from(SettingsV1 { trial, genome, evolution }: SettingsV1) -> Self {
        let HalvingV1 { population, generations, parents, mutation_range_nm, mutation_decay } =
            evolution;
        let SpaceV1 {
            torque_range_nm,
            torque_step_nm,
            points_per_s,
            bend_limits_rad,
            twist_limits_rad,
            density_min_kg_m3,
            density_max_kg_m3,
        } = genome;
        Self {
            trial: trial.into(),
            genome: SpaceV2 {
                controller: ControllerKind::Signal,
                wave: WaveSpace::default().into(),
                torque_range_nm,
                torque_step_nm,
                points_per_s,
                bend_limits_rad,
                twist_limits_rad,
                density_min_kg_m3,
                density_max_kg_m3,
            },
            evolution: EvolutionV2 {
                strategy: StrategyKind::Halving,
                population,
                generations,
                halving: HalvingV2 { parents, mutation_range_nm, mutation_decay },
                ..EvolutionSettings::default().into()
            },
        }
    }
}
