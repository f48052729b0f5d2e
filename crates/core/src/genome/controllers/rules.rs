//! A small library of waves, and rules that choose among them by what the snake senses.
//!
//! The idea is that of Lassabe, Luga and Duthen (2007) as the report describes it: what a creature senses passes through
//! a classifier system, which picks the wave that drives the joints. Here the rules are genes, with fixed strengths.
//! Numbers of waves and rules, conditions, periods and probabilities are this program's own.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::wave::Waves;
use super::wave_rule::WaveRule;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::kind::ControllerKind;
use crate::genome::limits::LARGEST_LIMIT_RAD;
use crate::genome::network_space::{MOST_LIBRARY_WAVES, MOST_WAVE_RULES};
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::{SERVO_DAMPING_RANGE, STIFFNESS_RANGE_NM_PER_RAD};

/// Waves of target angles, the rules that choose among them, and the servo that pulls towards the targets: see
/// [`Gait`](super::Gait).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleGenes {
    /// Torque per angle by which a joint misses its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
    /// The waves, in radians. The first drives the joints for which no rule decides.
    pub library: Vec<Waves>,
    /// The rules.
    pub rules: Vec<WaveRule>,
}

impl RuleGenes {
    fn servo_genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        let wave = &space.wave;
        let range =
            GeneRange::Between(wave.stiffness_min_nm_per_rad, wave.stiffness_max_nm_per_rad);
        let (field, name) = (format_args!("stiffness_nm_per_rad"), format_args!("stiffness"));
        visit(Gene { field, name, unit: "N·m/rad", range }, &mut self.stiffness_nm_per_rad);
        let range = GeneRange::Fixed(wave.servo_damping_nms_per_rad);
        let field = format_args!("servo_damping_nms_per_rad");
        let name = format_args!("servo damping");
        visit(Gene { field, name, unit: "N·m·s/rad", range }, &mut self.servo_damping_nms_per_rad);
    }

    fn library_genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        let ranges = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        for (index, waves) in self.library.iter_mut().enumerate() {
            let number = index + 1;
            waves.genes_up_to(ranges, "rad", space, &mut |gene, value| {
                let Gene { field, name, unit, range } = gene;
                let field = format_args!("library[{index}].{field}");
                let name = format_args!("wave {number}, {name}");
                visit(Gene { field, name, unit, range }, value);
            });
        }
    }

    fn rule_genes(&mut self, visit: GeneVisitor<'_>) {
        let waves = self.library.len();
        for (index, rule) in self.rules.iter_mut().enumerate() {
            rule.genes(index, waves, visit);
        }
    }

    fn check_library(&self) -> Result<(), Invalid> {
        within("library waves", self.library.len(), 1..=MOST_LIBRARY_WAVES)?;
        let joints = self.joints();
        for (index, waves) in self.library.iter().enumerate() {
            let inside = |error: Invalid| error.inside(&format!("library[{index}]"));
            within("number of joints", waves.joints.len(), joints..=joints).map_err(inside)?;
            waves.check_up_to(LARGEST_LIMIT_RAD).map_err(inside)?;
        }
        Ok(())
    }
}

/// Number of coordinates of the genes that are visited.
fn coordinates(genes: impl FnOnce(GeneVisitor<'_>)) -> usize {
    let mut count = 0;
    genes(&mut |gene, _| count += usize::from(!gene.range.is_point()));
    count
}

impl GenomeSpace {
    /// The coordinates of each wave of the library in a point of the unit cube; none for kinds without a library.
    pub fn library_coordinates(&self, shape: GenomeShape) -> Vec<Range<usize>> {
        if self.controller != ControllerKind::Rules {
            return Vec::new();
        }
        let mut genes = RuleGenes::zeroed(self, shape);
        let waves = genes.library.len();
        let each = coordinates(|visit| genes.library_genes(self, visit)) / waves.max(1);
        let end = self.dimension(shape) - coordinates(|visit| genes.rule_genes(visit));
        let start = end - waves * each;
        (0..waves).map(|wave| start + wave * each..start + (wave + 1) * each).collect()
    }
}

impl ControllerEncoding for RuleGenes {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "rules",
            title: "Rules",
            words: "Rules choose among a few waves by what the snake senses.",
            senses_surroundings: true,
            settings: &[
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.harmonics",
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
                "network.library_waves",
                "network.wave_rules",
            ],
        }
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

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.servo_genes(space, visit);
        self.library_genes(space, visit);
        self.rule_genes(visit);
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        visit("library waves", self.library.len());
        visit("rules", self.rules.len());
        self.library.iter().for_each(|waves| waves.lengths(visit));
    }

    fn joints(&self) -> usize {
        self.library.first().map_or(0, |waves| waves.joints.len())
    }

    /// That of the first wave.
    fn frequency_hz(&self) -> f32 {
        self.library.first().map_or(0.0, |waves| waves.frequency_hz)
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("rules");
        let (stiffness, damping) = (self.stiffness_nm_per_rad, self.servo_damping_nms_per_rad);
        within("stiffness_nm_per_rad", stiffness, STIFFNESS_RANGE_NM_PER_RAD).map_err(inside)?;
        within("servo_damping_nms_per_rad", damping, SERVO_DAMPING_RANGE).map_err(inside)?;
        self.check_library().map_err(inside)?;
        within("number of rules", self.rules.len(), 1..=MOST_WAVE_RULES).map_err(inside)?;
        for (index, rule) in self.rules.iter().enumerate() {
            let place = format!("rules[{index}]");
            rule.check(self.library.len()).map_err(|error| inside(error.inside(&place)))?;
        }
        Ok(())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let mut ranges = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        for waves in &self.library {
            ranges = waves.widen_from(ranges, space);
        }
        [space.wave.angle_range_rad, space.wave.twist_range_rad] = ranges;
        let wave = &mut space.wave;
        wave.widen_stiffness(self.stiffness_nm_per_rad);
        wave.servo_damping_nms_per_rad = self.servo_damping_nms_per_rad;
        space.network.library_waves = self.library.len() as u32;
        space.network.wave_rules = self.rules.len() as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerGenes, Genome};
    use crate::rng::{Purpose, stream};

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

    #[test]
    fn hostile_genes_are_refused_with_their_place_and_what_is_allowed() {
        let random = rules(space().random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth)));
        random.check().expect("allowed");
        let refusal = |change: fn(&mut RuleGenes)| {
            let mut genes = random.clone();
            change(&mut genes);
            genes.check().expect_err("refused").to_string()
        };
        for (change, message) in [
            (
                (|genes| genes.rules[3].wave = 5) as fn(&mut RuleGenes),
                "rules.rules[3].wave is 5; allowed: 1 to 4",
            ),
            (|genes| genes.rules[3].wave = 0, "rules.rules[3].wave is 0; allowed: 1 to 4"),
            (
                |genes| genes.rules[0].strength = f32::NAN,
                "rules.rules[0].strength is NaN; allowed: 0 to 1",
            ),
            (|genes| genes.rules.clear(), "rules.number of rules is 0; allowed: 1 to 64"),
            (
                |genes| genes.rules = vec![WaveRule::ZEROED; 65],
                "rules.number of rules is 65; allowed: 1 to 64",
            ),
            (|genes| genes.library.clear(), "rules.library waves is 0; allowed: 1 to 8"),
            (
                |genes| drop(genes.library[2].joints.pop()),
                "rules.library[2].number of joints is 3; allowed: 4 to 4",
            ),
            (
                |genes| genes.library[1].joints[0].bend.offset = f32::INFINITY,
                "rules.library[1].joints[0].bend.offset is inf; allowed: -3 to 3",
            ),
        ] {
            assert_eq!(refusal(change), message);
        }
    }

    #[test]
    fn a_space_widened_for_rules_contains_them() {
        let mut wide = space();
        (wide.network.library_waves, wide.network.wave_rules) = (6, 3);
        wide.wave.harmonics = 2;
        wide.wave.angle_range_rad = 2.5;
        let genome = wide.random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth));
        let narrow = GenomeSpace::default();
        assert!(narrow.check_genome(&genome, SHAPE).is_err());
        let widened = narrow.widened_for(&genome);
        widened.check_genome(&genome, SHAPE).expect("widened");
        let message = space().check_genome(&genome, SHAPE).expect_err("more waves").to_string();
        assert_eq!(message, "library waves is 6; allowed: 4");
    }
}
