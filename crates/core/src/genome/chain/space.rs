//! The space of chains of blocks that evolve.

use crate::check::Invalid;
use crate::genome::gene::GeneRange;
use crate::genome::limits::{LARGEST_LIMIT_RAD, MODULUS_RANGE_PA};
use crate::schema::{
    Section, SettingGroup, Walk, is_default, number, setting_group, settings, switch, whole,
};

use super::segment::MOST_SEGMENTS;

setting_group! {
    /// Ranges of bodies that evolve. All bodies have the same volume.
    pub struct BodySpace {
        /// Whether each genome has a body of its own. Otherwise the trial determines the body.
        vary: bool = false;
        /// Least number of blocks of a body.
        limbs_min: u32 = 2;
        /// Greatest number of blocks of a body.
        limbs_max: u32 = MOST_SEGMENTS;
        /// Least length of a block, in metres.
        length_min_m: f32 = 0.4;
        /// Greatest length of a block, in metres.
        length_max_m: f32 = 4.0;
        /// Least width and height of a block, in metres: twenty times the distance at which the engine detects contacts in advance.
        thickness_min_m: f32 = 0.4;
        /// Greatest width and height of a block, in metres.
        thickness_max_m: f32 = 2.0;
        /// Least bend limit of a joint, in radians.
        bend_limit_min_rad: f32 = 0.2;
        /// Greatest bend limit of a joint, in radians.
        bend_limit_max_rad: f32 = 1.8;
        /// Least twist limit of a joint, in radians.
        twist_limit_min_rad: f32 = 0.0;
        /// Greatest twist limit of a joint, in radians.
        twist_limit_max_rad: f32 = 1.5;
        /// Least strength of a joint, as a share of the torque that its cross-section allows.
        strength_min: f32 = 0.25;
        /// Volume of every body, in m³. The snake of five blocks has 10 m³.
        volume_m3: f32 = 10.0;
        /// Greatest length of a straight body, in metres. The snake of five blocks has 10 m.
        longest_m: f32 = 12.0;
        /// Whether the softness of each block evolves. Otherwise all blocks are rigid.
        #[serde(default, skip_serializing_if = "is_default")]
        soft: bool = false;
        /// Least Young's modulus of a block, in Pa. A block that would fold up under its own weight gets the least modulus at which it
        /// does not.
        #[serde(default = "usual_modulus_min_pa", skip_serializing_if = "is_usual_modulus_min")]
        modulus_min_pa: f32 = USUAL_MODULUS_PA[0];
        /// Greatest Young's modulus of a block, in Pa. A block that is too stiff to bend is rigid.
        #[serde(default = "usual_modulus_max_pa", skip_serializing_if = "is_usual_modulus_max")]
        modulus_max_pa: f32 = USUAL_MODULUS_PA[1];
    }
}

/// Default range of Young's modulus, in Pa: from blocks of 1 m that sag like a wet sponge to rigid ones.
const USUAL_MODULUS_PA: [f32; 2] = [1000.0, 100_000.0];

fn usual_modulus_min_pa() -> f32 {
    USUAL_MODULUS_PA[0]
}

fn is_usual_modulus_min(modulus_pa: &f32) -> bool {
    *modulus_pa == USUAL_MODULUS_PA[0]
}

fn usual_modulus_max_pa() -> f32 {
    USUAL_MODULUS_PA[1]
}

fn is_usual_modulus_max(modulus_pa: &f32) -> bool {
    *modulus_pa == USUAL_MODULUS_PA[1]
}

impl SettingGroup for BodySpace {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            vary,
            limbs_min,
            limbs_max,
            length_min_m,
            length_max_m,
            thickness_min_m,
            thickness_max_m,
            bend_limit_min_rad,
            bend_limit_max_rad,
            twist_limit_min_rad,
            twist_limit_max_rad,
            strength_min,
            volume_m3,
            longest_m,
            soft,
            modulus_min_pa,
            modulus_max_pa,
        } = self;
        walk.section(Section {
            title: "Evolving bodies",
            about: "Ranges of bodies whose number and sizes of blocks evolve. All have the same volume.",
        });
        settings! { walk,
            vary: switch("Evolve bodies")
                .hint("Each snake has a body of its own: number, sizes, joints and strength of its blocks evolve");
        }
        walk.used_if(*vary);
        let sizes = || 0.1..=10.0;
        settings! { walk,
            limbs_min: whole("Minimum blocks", 2..=MOST_SEGMENTS)
                .hint("Smallest number of blocks that a body may have")
                .slider(2.0, 12.0);
            limbs_max: whole("Maximum blocks", 2..=MOST_SEGMENTS)
                .hint("Largest number of blocks that a body may have")
                .slider(2.0, 12.0);
            length_min_m: number("Minimum length", sizes()).advanced()
                .unit("m")
                .hint("Shortest block, along the body")
                .slider(0.1, 4.0)
                .logarithmic_from(0.1);
            length_max_m: number("Maximum length", sizes()).advanced()
                .unit("m")
                .hint("Longest block, along the body")
                .slider(0.2, 10.0)
                .logarithmic_from(0.2);
            thickness_min_m: number("Minimum thickness", sizes()).advanced()
                .unit("m")
                .hint("Smallest width and height of a block")
                .slider(0.1, 2.0)
                .logarithmic_from(0.1);
            thickness_max_m: number("Maximum thickness", sizes()).advanced()
                .unit("m")
                .hint("Largest width and height of a block")
                .slider(0.2, 5.0)
                .logarithmic_from(0.2);
            bend_limit_min_rad: number("Minimum bend limit", 0.0..=LARGEST_LIMIT_RAD)
                .advanced()
                .unit("rad")
                .hint("Least range of a joint upwards and downwards")
                .slider(0.0, 3.0);
            bend_limit_max_rad: number("Maximum bend limit", 0.0..=LARGEST_LIMIT_RAD)
                .advanced()
                .unit("rad")
                .hint("Greatest range of a joint upwards and downwards")
                .slider(0.0, 3.0);
            twist_limit_min_rad: number("Minimum twist limit", 0.0..=LARGEST_LIMIT_RAD)
                .advanced()
                .unit("rad")
                .hint("Least range of a joint about the long axis")
                .slider(0.0, 3.0);
            twist_limit_max_rad: number("Maximum twist limit", 0.0..=LARGEST_LIMIT_RAD)
                .advanced()
                .unit("rad")
                .hint("Greatest range of a joint about the long axis")
                .slider(0.0, 3.0);
            strength_min: number("Minimum strength", 0.01..=1.0).advanced()
                .hint("Weakest joint, as a share of the torque that its cross-section allows")
                .slider(0.01, 1.0);
            volume_m3: number("Volume", 0.1..=1000.0)
                .unit("m³")
                .hint("Volume of every body. A body with more blocks has smaller ones")
                .slider(1.0, 50.0)
                .logarithmic_from(1.0);
            longest_m: number("Maximum body length", 0.5..=24.0)
                .unit("m")
                .hint("Longest straight body, from head to tail")
                .slider(2.0, 24.0);
            soft: switch("Evolve softness")
                .hint("Each block has a stiffness of its own, which evolves. Soft blocks bend and spring back");
        }
        walk.used_if(*vary && *soft);
        settings! { walk,
            modulus_min_pa: number("Minimum Young's modulus", MODULUS_RANGE_PA).advanced()
                .unit("Pa")
                .hint("Softest material of a block")
                .slider(1000.0, 100_000.0)
                .logarithmic_from(1000.0);
            modulus_max_pa: number("Maximum Young's modulus", MODULUS_RANGE_PA).advanced()
                .unit("Pa")
                .hint("Stiffest material of a block. A block of 1 m and 9 kg/m³ is rigid above 86,000 Pa")
                .slider(1000.0, 100_000.0)
                .logarithmic_from(1000.0);
        }
    }

    fn check_together(&self) -> Result<(), Invalid> {
        let ordered = |field: &str, low: f32, high: f32| {
            let allowed = || format!("{low} or more, as the minimum is");
            if low <= high { Ok(()) } else { Err(Invalid::new(field, high, allowed())) }
        };
        ordered("limbs_max", self.limbs_min as f32, self.limbs_max as f32)?;
        ordered("length_max_m", self.length_min_m, self.length_max_m)?;
        ordered("thickness_max_m", self.thickness_min_m, self.thickness_max_m)?;
        ordered("bend_limit_max_rad", self.bend_limit_min_rad, self.bend_limit_max_rad)?;
        ordered("twist_limit_max_rad", self.twist_limit_min_rad, self.twist_limit_max_rad)?;
        ordered("modulus_max_pa", self.modulus_min_pa, self.modulus_max_pa)?;
        for limbs in [self.limbs_min, self.limbs_max] {
            if self.plain_block_m(limbs as usize).is_none() {
                let allowed = format!(
                    "a volume of which {limbs} blocks within the ranges of sizes can be made"
                );
                return Err(Invalid::new("volume_m3", self.volume_m3, allowed));
            }
        }
        Ok(())
    }
}

impl BodySpace {
    /// Paths, in the space of genomes, of the settings that have no effect on branching bodies.
    pub(in crate::genome) const OF_CHAINS: [&str; 5] = [
        "bodies.limbs_min",
        "bodies.limbs_max",
        "bodies.soft",
        "bodies.modulus_min_pa",
        "bodies.modulus_max_pa",
    ];

    /// Returns the range of the number of blocks that a body may have.
    pub fn limbs(&self) -> std::ops::RangeInclusive<u32> {
        self.limbs_min..=self.limbs_max
    }

    /// Returns the range of the length of a block or part.
    pub(in crate::genome) fn lengths(&self) -> GeneRange<'static> {
        GeneRange::Ratio(self.length_min_m, self.length_max_m)
    }

    /// Returns the range of the width and the height of a block or part.
    pub(in crate::genome) fn thicknesses(&self) -> GeneRange<'static> {
        GeneRange::Ratio(self.thickness_min_m, self.thickness_max_m)
    }

    /// Returns the range of the bend limit of a joint.
    pub(in crate::genome) fn bend_limits(&self) -> GeneRange<'static> {
        GeneRange::Between(self.bend_limit_min_rad, self.bend_limit_max_rad)
    }

    /// Returns the range of the twist limit of a joint.
    pub(in crate::genome) fn twist_limits(&self) -> GeneRange<'static> {
        GeneRange::Between(self.twist_limit_min_rad, self.twist_limit_max_rad)
    }

    /// Returns the range of the strength of a joint.
    pub(in crate::genome) fn strengths(&self) -> GeneRange<'static> {
        GeneRange::Between(self.strength_min, 1.0)
    }

    /// Returns the shortest and the longest straight body of this number of blocks, in metres; `None` if the ranges allow no such body.
    pub fn lengths_m(&self, limbs: u32) -> Option<[f64; 2]> {
        let [volume_m3, longest_m] = [self.volume_m3, self.longest_m].map(f64::from);
        let [thinnest_m, thickest_m] = [self.thickness_min_m, self.thickness_max_m].map(f64::from);
        let [least_m, most_m] = [self.length_min_m, self.length_max_m]
            .map(|length_m| f64::from(length_m) * f64::from(limbs));
        let shortest_m = (volume_m3 / (thickest_m * thickest_m)).max(least_m);
        let longest_m = (volume_m3 / (thinnest_m * thinnest_m)).min(most_m).min(longest_m);
        (shortest_m <= longest_m).then_some([shortest_m, longest_m])
    }

    /// Returns the length, width and height of each block of a body of equal blocks, in metres. Together they are as long as the snake of
    /// five blocks, as far as the ranges allow. `None` if the ranges allow no such body.
    pub(super) fn plain_block_m(&self, limbs: usize) -> Option<[f64; 3]> {
        let [volume_m3, longest_m] = [self.volume_m3, self.longest_m].map(f64::from);
        let [least_m, most_m] = [self.thickness_min_m, self.thickness_max_m].map(f64::from);
        let count = limbs.max(1) as f64;
        let each_m3 = volume_m3 / count;
        let shortest_m = (each_m3 / (most_m * most_m)).max(self.length_min_m.into());
        let greatest_m =
            (each_m3 / (least_m * least_m)).min(self.length_max_m.into()).min(longest_m / count);
        if shortest_m > greatest_m {
            return None;
        }
        let length_m = (longest_m / 1.2 / count).clamp(shortest_m, greatest_m);
        let side_m = (each_m3 / length_m).sqrt();
        Some([length_m, side_m, side_m])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_body_of_five_is_the_reports_snake() {
        let space = BodySpace::default();
        let five = space.plain_block_m(5).expect("possible");
        for (found, expected) in five.into_iter().zip([2.0, 1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-6, "{five:?}");
        }
        for limbs in space.limbs() {
            let [length, width, height] = space.plain_block_m(limbs as usize).expect("possible");
            assert!((length * width * height * f64::from(limbs) - 10.0).abs() < 1e-9);
        }
    }

    #[test]
    fn ranges_that_no_body_fits_are_refused() {
        let error = |change: fn(&mut BodySpace)| {
            let mut space = BodySpace::default();
            change(&mut space);
            crate::schema::check(&space).expect_err("refused").to_string()
        };
        assert!(error(|space| space.limbs_max = 1).starts_with("limbs_max is 1; allowed: 2 to 12"));
        assert!(error(|space| space.limbs_min = 13).starts_with("limbs_min is 13"));
        let swapped = error(|space| (space.limbs_min, space.limbs_max) = (7, 3));
        assert_eq!(swapped, "limbs_max is 3; allowed: 7 or more, as the minimum is");
        assert!(error(|space| space.volume_m3 = 100.0).contains("2 blocks within the ranges"));
        assert!(error(|space| space.volume_m3 = 0.5).contains("12 blocks within the ranges"));
        assert!(error(|space| space.length_max_m = f32::NAN).starts_with("length_max_m is NaN"));
    }
}
