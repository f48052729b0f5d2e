//! A small library of waves, and rules that choose among them by what the snake senses.
//!
//! The idea is that of Lassabe, Luga and Duthen (2007) as the report describes it: what a creature senses is the input of a classifier
//! system, which picks the wave that drives the joints. In this program the rules are genes, with fixed strengths. Numbers of waves and
//! rules, conditions, periods and probabilities are this program's own.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SERVO_SETTINGS, SettingNames,
    TWIST_SETTINGS,
};
use super::wave::Waves;
use super::wave_rule::{RULE_SENSES, WaveRule};
use crate::genome::gene::{Genes, GenomeShape, coordinate_count};
use crate::genome::kind::ControllerKind;
use crate::genome::network_space::{MOST_LIBRARY_WAVES, MOST_WAVE_RULES};
use crate::genome::space::GenomeSpace;

/// Waves of target angles, the rules that choose among them, and the servo that turns the joints towards the targets: see
/// [`Gait`](super::Gait).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleGenes {
    /// Torque per angle between a joint and its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, per rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
    /// Waves of target angles, in radians. The first wave drives the joints for which no rule decides.
    pub library: Vec<Waves>,
    /// Rules that choose among the waves.
    pub rules: Vec<WaveRule>,
}

impl RuleGenes {
    fn library_genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        for (index, waves) in self.library.iter_mut().enumerate() {
            let field = format_args!("library[{index}].");
            let name = format_args!("wave {}, ", index + 1);
            genes.inside(field, name, |genes| waves.angle_genes(space, genes));
        }
    }

    fn rule_genes(&mut self, genes: &mut Genes<'_>) {
        let waves = self.library.len();
        for (index, rule) in self.rules.iter_mut().enumerate() {
            let (field, name) =
                (format_args!("rules[{index}]."), format_args!("rule {}", index + 1));
            genes.inside(field, name, |genes| rule.genes(waves, genes));
        }
    }
}

impl GenomeSpace {
    /// Returns the range of coordinates of each wave of the library in a point of the unit cube; empty for kinds without a library.
    pub fn library_coordinates(&self, shape: GenomeShape) -> Vec<Range<usize>> {
        if self.controller != ControllerKind::Rules {
            return Vec::new();
        }
        let mut genes = RuleGenes::zeroed(self, shape);
        let waves = genes.library.len();
        let each = coordinate_count(|visit| genes.library_genes(self, visit)) / waves.max(1);
        let end = self.dimension(shape) - coordinate_count(|visit| genes.rule_genes(visit));
        let start = end - waves * each;
        (0..waves).map(|wave| start + wave * each..start + (wave + 1) * each).collect()
    }
}

impl ControllerEncoding for RuleGenes {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            SERVO_SETTINGS,
            TWIST_SETTINGS,
            &["wave.harmonics", "network.library_waves", "network.wave_rules"],
        ]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let network = &space.network;
        Self {
            stiffness_nm_per_rad: 0.0,
            servo_damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            library: vec![Waves::zeroed(space, shape); network.library_waves as usize],
            rules: vec![WaveRule::ZEROED; network.wave_rules as usize],
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let servo = [&mut self.stiffness_nm_per_rad, &mut self.servo_damping_nms_per_rad];
        space.wave.servo_genes(servo, genes);
        self.library_genes(space, genes);
        self.rule_genes(genes);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        visit(format_args!("library waves"), self.library.len(), 1..=MOST_LIBRARY_WAVES);
        visit(format_args!("number of rules"), self.rules.len(), 1..=MOST_WAVE_RULES);
        for (index, rule) in self.rules.iter().enumerate() {
            let (name, senses) = (format_args!("rules[{index}].condition"), RULE_SENSES.len());
            visit(name, rule.condition.length(), senses..=senses);
        }
        let joints = self.joints();
        for (index, waves) in self.library.iter().enumerate() {
            let place = format!("library[{index}]");
            visit(format_args!("{place}.joints"), waves.joints.len(), joints..=joints);
            waves.lengths(&mut |name, length, allowed| {
                visit(format_args!("{place}.{name}"), length, allowed);
            });
        }
    }

    fn joints(&self) -> usize {
        self.library.first().map_or(0, |waves| waves.joints.len())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let mut ranges = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        for waves in &self.library {
            ranges = waves.widen_from(ranges, space);
        }
        [space.wave.angle_range_rad, space.wave.twist_range_rad] = ranges;
        space.network.library_waves = self.library.len() as u32;
        space.network.wave_rules = self.rules.len() as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerGenes, Genome};

    const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 2.0 };

    fn space() -> GenomeSpace {
        GenomeSpace { controller: ControllerKind::Rules, ..GenomeSpace::default() }
    }

    fn rules(genome: Genome) -> RuleGenes {
        let ControllerGenes::Rules(genes) = genome.controller else { panic!("rules") };
        genes
    }

    #[test]
    fn the_coordinates_of_a_wave_change_that_wave_alone() {
        let mut space = space();
        for twists in [true, false] {
            if !twists {
                space.twist_limits_rad = vec![0.0];
            }
            let blocks = space.library_coordinates(SHAPE);
            assert_eq!(blocks.len(), 4);
            let point = vec![0.4; space.dimension(SHAPE)];
            let original = rules(space.genome_at(&point, SHAPE));
            for (index, block) in blocks.into_iter().enumerate() {
                assert_eq!(block.len(), if twists { 25 } else { 13 });
                let mut point = point.clone();
                point[block].fill(0.7);
                let changed = rules(space.genome_at(&point, SHAPE));
                let other = changed.library[index].clone();
                assert!(other != original.library[index] && other.frequency_hz > 2.0);
                let mut back = changed;
                back.library[index] = original.library[index].clone();
                assert_eq!(back, original, "nothing else");
            }
        }
        let gaits = GenomeSpace { controller: ControllerKind::Gait, ..space };
        assert!(gaits.library_coordinates(SHAPE).is_empty());
    }
}
