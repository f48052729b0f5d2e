//! The space from which genomes are drawn: the range of every gene.

use super::chain::BodySpace;
use super::creature::CreatureSpace;
use super::gene::{GeneRange, Quantity};
use super::kind::ControllerKind;
use super::limits::{DENSITY_RANGE_KG_M3, LARGEST_LIMIT_RAD};
use super::network_space::NetworkSpace;
use super::wave_space::WaveSpace;
use crate::check::{Invalid, within};
use crate::schema::{
    Section, SettingGroup, Walk, choice, is_default, list_of_numbers, number, setting_group,
    settings,
};

setting_group! {
    /// Ranges and lists from which every genome is drawn.
    pub struct GenomeSpace {
        /// The kind of controller that drives the joints.
        controller: ControllerKind = ControllerKind::Signal;
        /// Ranges of periodic controllers.
        wave: WaveSpace = WaveSpace::default();
        /// Ranges of controllers that sense their surroundings, such as reflexes and networks.
        #[serde(default, skip_serializing_if = "is_default")]
        network: NetworkSpace = NetworkSpace::default();
        /// Ranges of bodies that evolve.
        #[serde(default, skip_serializing_if = "is_default")]
        bodies: BodySpace = BodySpace::default();
        /// Ranges of the parts and neurons of branching bodies.
        #[serde(default, skip_serializing_if = "is_default")]
        creatures: CreatureSpace = CreatureSpace::default();
        /// Greatest torque of a signal or a wave to either side, in N·m. In the report it is 1000.
        torque_range_nm: f32 = 1000.0;
        /// Greatest difference between neighbouring points of a random signal, in N·m. In the report it is 1000.
        torque_step_nm: f32 = 1000.0;
        /// Number of torque points that take effect per simulated second. The report found that it matters.
        points_per_s: f32 = 10.0;
        /// Bend limits from which random genomes choose, in radians. In the report they are 0.6, 0.8, 1.0, 1.8.
        bend_limits_rad: Vec<f32> = vec![0.6, 0.8, 1.0, 1.8];
        /// Twist limits from which random genomes choose, in radians. In the report they are 0, 0.9, 1.2, 1.5.
        twist_limits_rad: Vec<f32> = vec![0.0, 0.9, 1.2, 1.5];
        /// Least density of the material, in kg/m³.
        density_min_kg_m3: f32 = 2.0;
        /// Greatest density of the material, in kg/m³.
        density_max_kg_m3: f32 = 2.5;
    }
}

/// Range of the number of torque points per second. Points beyond the rate of physics steps have no effect.
pub const POINTS_PER_S_RANGE: std::ops::RangeInclusive<f32> = 0.1..=1000.0;

/// Largest torque in a file, in N·m: a thousand times that of the report.
pub const LARGEST_TORQUE_NM: f32 = 1.0e6;

/// Quantity of a number of torque points per second.
pub const POINTS_PER_S: Quantity = Quantity::new("Hz", POINTS_PER_S_RANGE);
/// Quantity of a torque to either side.
pub const TORQUE: Quantity = Quantity::new("N·m", -LARGEST_TORQUE_NM..=LARGEST_TORQUE_NM);

/// Greatest number of torque points in a genome, over all its signals. The save of a genome with this number stays below 10 MiB, the
/// largest size that is loaded.
pub const LARGEST_GENOME_TORQUES: usize = 600_000;

impl SettingGroup for GenomeSpace {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            controller,
            wave,
            network,
            bodies,
            creatures,
            torque_range_nm,
            torque_step_nm,
            points_per_s,
            bend_limits_rad,
            twist_limits_rad,
            density_min_kg_m3,
            density_max_kg_m3,
        } = self;
        let mut unused = controller.unused_settings();
        if bodies.vary {
            unused.extend(["bend_limits_rad", "twist_limits_rad"]);
        }
        if *controller == ControllerKind::PartNeurons {
            unused.extend(BodySpace::OF_CHAINS);
        }
        walk.without_effect(unused);
        walk.section(Self::CONTROLLER);
        settings! { walk, controller: choice("Controller").hint("How the genome drives the joints"); }
        walk.section(Section {
            title: "Torques",
            about: "Range of the torques, and how random signals vary within it.",
        });
        settings! { walk,
            torque_range_nm: number("Torque range", 0.001..=1.0e6)
                .unit("N·m")
                .hint("Torques of signals and waves stay between minus and plus this value")
                .slider(1.0, 2000.0);
            torque_step_nm: number("Torque step", 0.0..=1.0e6).advanced()
                .unit("N·m")
                .hint("Maximum change between adjacent points of a random signal")
                .slider(0.0, 2000.0);
            points_per_s: number("Points per second", POINTS_PER_S_RANGE)
                .hint("How often a signal's torque changes. One to three points per second move a snake; many cancel out")
                .slider(0.5, 60.0)
                .logarithmic_from(0.5);
        }
        walk.group("wave", wave);
        walk.group("network", network);
        walk.group("bodies", bodies);
        walk.group("creatures", creatures);
        walk.section(Section {
            title: "Random snakes",
            about: "Where joint limits and densities of snakes come from, unless they have fixed values.",
        });
        settings! { walk,
            bend_limits_rad: list_of_numbers("Bend limits to choose from", 0.0..=LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint("Each random snake gets one of these. A single number applies to all");
            twist_limits_rad: list_of_numbers("Twist limits to choose from", 0.0..=LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint("Each random snake gets one of these. 0 locks the twist");
            density_min_kg_m3: number("Minimum density", DENSITY_RANGE_KG_M3)
                .unit("kg/m³")
                .hint("Lightest material that a snake may have")
                .slider(0.1, 50.0)
                .logarithmic_from(0.1);
            density_max_kg_m3: number("Maximum density", DENSITY_RANGE_KG_M3)
                .unit("kg/m³")
                .hint("Heaviest material that a snake may have")
                .slider(0.1, 50.0)
                .logarithmic_from(0.1);
        }
    }

    fn check_together(&self) -> Result<(), Invalid> {
        let densities = self.density_min_kg_m3..=*DENSITY_RANGE_KG_M3.end();
        within("density_max_kg_m3", self.density_max_kg_m3, densities)
    }
}

impl GenomeSpace {
    /// Returns whether the controllers of this space can sense contacts, attitude or the stairs ahead, besides their joints.
    pub fn senses_surroundings(&self) -> bool {
        let steers = self.controller == ControllerKind::Gait && self.wave.steering_range_rad > 0.0;
        steers || self.controller.senses_surroundings()
    }

    /// Section of settings for the kind of controller.
    pub const CONTROLLER: Section =
        Section { title: "Controller", about: "How genes become torques." };

    /// Returns whether joints can bend, and whether they can twist.
    pub(super) fn turning_axes(&self) -> [bool; 2] {
        if self.bodies.vary {
            let BodySpace { bend_limit_max_rad, twist_limit_max_rad, .. } = self.bodies;
            return [bend_limit_max_rad > 0.0, twist_limit_max_rad > 0.0];
        }
        [&self.bend_limits_rad, &self.twist_limits_rad]
            .map(|limits| limits.iter().any(|limit| *limit > 0.0))
    }

    /// Returns the range of the density of a part.
    pub(super) fn densities(&self) -> GeneRange<'static> {
        GeneRange::Ratio(self.density_min_kg_m3, self.density_max_kg_m3)
    }

    /// Returns how many points a signal needs to last `duration_s` seconds; at least 1.
    pub fn points(&self, duration_s: f32) -> usize {
        libm::ceilf(duration_s * self.points_per_s).max(1.0) as usize
    }
}
