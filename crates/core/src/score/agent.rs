//! Settings of the snake's body: its limbs, its joints, its skin.

use super::own_body::{creature_body, own_body};
use crate::check::Invalid;
use crate::control::ActiveSenses;
use crate::genome::{DENSITY_RANGE_KG_M3, Genome, LARGEST_LIMIT_RAD, MODULUS_RANGE_PA};
use crate::schema::{
    Need, Parts, PerPart, Section, SettingGroup, Walk, is_default, number, optional_per_part,
    per_part, setting_group, settings, whole,
};
use crate::world::{BodyPlan, Elasticity, JointPlan, PartPlan, Skin, check_softness};

setting_group! {
    /// The properties of the snake that do not evolve. Sizes have one value per limb from the head, other properties one per joint, or one
    /// value for all.
    pub struct AgentSettings {
        /// Number of limbs. The report has five limbs.
        limbs: u32 = 5;
        /// Width of the limbs across x, in metres.
        limb_width_m: PerPart = 1.0.into();
        /// Length of the limbs along y, in metres.
        limb_length_m: PerPart = 2.0.into();
        /// Height of the limbs, in metres.
        limb_height_m: PerPart = 1.0.into();
        /// Density of the limbs, in kg/m³. `None`: each genome has its own density, which evolves.
        density_kg_m3: Option<PerPart> = None;
        /// Largest bend of the joints to either side, in radians. `None`: each genome has its own limit.
        bend_limit_rad: Option<PerPart> = None;
        /// Largest twist of the joints to either side, in radians. `None`: each genome has its own limit.
        twist_limit_rad: Option<PerPart> = None;
        /// Largest torque on the joints' bend axes, in N·m.
        max_bend_torque_nm: PerPart = 1000.0.into();
        /// Largest torque on the joints' twist axes, in N·m.
        max_twist_torque_nm: PerPart = 1000.0.into();
        /// Greatest sum of the torques of all joints about both axes, in N·m, for a body from the genome. In a stronger body, all torques
        /// are reduced by one factor. The default is the sum of the report's five blocks.
        #[serde(default = "usual_torque_budget_nm", skip_serializing_if = "is_usual_torque_budget")]
        torque_budget_nm: f32 = USUAL_TORQUE_BUDGET_NM;
        /// Torque that resists the joints' motion, per joint rate, in N·m·s/rad. Without damping the motion is chaotic, and a child's
        /// fitness hardly depends on its parent's.
        joint_damping_nms_per_rad: PerPart = 30.0.into();
        /// Power that a joint axis takes for a torque of 1000 N·m, in W, whether the joint moves or not. It grows with the square of the
        /// torque, like the heat of an electric motor.
        #[serde(default, skip_serializing_if = "is_default")]
        holding_power_w: f32 = 0.0;
        /// Constraint force mixing of the joints, in m/s per N: 0 is rigid, larger is softer.
        joint_cfm_m_s_per_n: PerPart = 0.0.into();
        /// Young's modulus of the limbs' material, in Pa, which makes the limbs soft. `None`: limbs are rigid, unless the genome
        /// determines the limbs and their modulus.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        youngs_modulus_pa: Option<PerPart> = None;
        /// Number of parts into which a soft limb is cut.
        #[serde(default = "usual_soft_parts", skip_serializing_if = "are_usual_soft_parts")]
        soft_parts: u32 = USUAL_SOFT_PARTS;
        /// Damping of a soft limb's slowest vibration, as a share of the critical damping.
        #[serde(default = "usual_soft_damping", skip_serializing_if = "is_usual_soft_damping")]
        soft_damping_ratio: f32 = USUAL_SOFT_DAMPING;
        /// Rate d at which the air slows a limb's rotation, in 1/s: after a time t, the limb keeps exp(-d t) of its angular velocity.
        angular_damping_per_s: f32 = 2.0;
        /// The material of the limbs.
        skin: Skin = Skin::default();
        /// Senses that work.
        #[serde(default, skip_serializing_if = "is_default")]
        senses: ActiveSenses = ActiveSenses::default();
    }
}

/// Default torque budget: four joints with two axes of 1000 N·m each.
const USUAL_TORQUE_BUDGET_NM: f32 = 8000.0;

fn usual_torque_budget_nm() -> f32 {
    USUAL_TORQUE_BUDGET_NM
}

fn is_usual_torque_budget(budget_nm: &f32) -> bool {
    *budget_nm == USUAL_TORQUE_BUDGET_NM
}

/// Default number of parts of a soft limb. Three parts bend like a beam within 6 %, at little cost of time.
const USUAL_SOFT_PARTS: u32 = 3;

fn usual_soft_parts() -> u32 {
    USUAL_SOFT_PARTS
}

fn are_usual_soft_parts(parts: &u32) -> bool {
    *parts == USUAL_SOFT_PARTS
}

/// Default damping ratio, like that of rubber foam: a limb comes to rest after a few vibrations.
const USUAL_SOFT_DAMPING: f32 = 0.3;

fn usual_soft_damping() -> f32 {
    USUAL_SOFT_DAMPING
}

fn is_usual_soft_damping(ratio: &f32) -> bool {
    *ratio == USUAL_SOFT_DAMPING
}

impl SettingGroup for AgentSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let (limb_count, joint_count) = (self.limbs as usize, self.joints());
        let (each_limb, each_joint) = (Parts::Limbs(limb_count), Parts::Joints(joint_count));
        let Self {
            limbs,
            limb_width_m,
            limb_length_m,
            limb_height_m,
            density_kg_m3,
            bend_limit_rad,
            twist_limit_rad,
            max_bend_torque_nm,
            max_twist_torque_nm,
            torque_budget_nm,
            joint_damping_nms_per_rad,
            holding_power_w,
            joint_cfm_m_s_per_n,
            youngs_modulus_pa,
            soft_parts,
            soft_damping_ratio,
            angular_damping_per_s,
            skin,
            senses,
        } = self;
        walk.section(Self::SKIN);
        walk.group("skin", skin);
        walk.section(Section { title: "Body", about: "Number, size and weight of the blocks." });
        settings! { walk,
            // The range begins with the two limbs of a single joint. With more than twelve limbs, the snake is longer than the arena.
            limbs: whole("Blocks", 2..=12)
                .needs(Self::GIVEN_BODY)
                .hint("Number of blocks of the snake. Genomes for a different number do not fit")
                .slider(2.0, 12.0);
            // The range goes from a finger to a bus. The engine's tolerances are made for sizes around a metre.
            limb_width_m: per_part("Block width", 0.1..=10.0, each_limb)
                .needs(Self::GIVEN_BODY)
                .unit("m")
                .hint("Size of a block across the stairs. Wide blocks roll over less easily")
                .slider(0.2, 3.0);
            limb_length_m: per_part("Block length", 0.1..=10.0, each_limb)
                .needs(Self::GIVEN_BODY)
                .unit("m")
                .hint("Size of a block along the snake. Long blocks reach further, but joints are further apart")
                .slider(0.2, 5.0);
            limb_height_m: per_part("Block height", 0.1..=10.0, each_limb)
                .needs(Self::GIVEN_BODY)
                .unit("m")
                .hint("Size of a block upwards. Tall blocks reach the next step more easily")
                .slider(0.2, 3.0);
            density_kg_m3: optional_per_part("Density", DENSITY_RANGE_KG_M3, each_limb, 2.2)
                .needs(Self::GIVEN_BODY)
                .unit("kg/m³")
                .hint(
                    "Mass per volume of the blocks. Heavy snakes press harder and need more torque. \
                     Without a value, each snake has its own, which evolves",
                )
                .slider(0.1, 50.0)
                .logarithmic_from(0.1);
            // The range ends at 1000, at which rotation stops within a millisecond, as in tar.
            angular_damping_per_s: number("Angular damping", 0.0..=1000.0).advanced()
                .unit("1/s")
                .hint("Rate at which a block loses its spin, as in thick air")
                .slider(0.0, 500.0)
                .logarithmic_from(0.1);
        }
        walk.section(Section {
            title: "Soft blocks",
            about: "Elasticity of the blocks. A soft block is a row of parts with springs between them.",
        });
        settings! { walk,
            youngs_modulus_pa: optional_per_part("Young's modulus", MODULUS_RANGE_PA, each_limb, 40_000.0)
                .needs(Self::GIVEN_BODY)
                .unit("Pa")
                .hint(
                    "Stiffness of the blocks' material: soft foam has some 10,000 Pa. Blocks of 1 m and 9 kg/m³ fold up under \
                     their own weight below 4,300 Pa, and are rigid above 86,000 Pa. Without a value, blocks are rigid",
                )
                .slider(1000.0, 100_000.0)
                .logarithmic_from(1000.0);
            soft_parts: whole("Parts per soft block", 2..=4).advanced().needs(Self::SOFT_LIMBS)
                .hint("Number of rigid parts of which a soft block consists. More parts bend more smoothly but take longer")
                .slider(2.0, 4.0);
            soft_damping_ratio: number("Damping of soft blocks", 0.0..=1.0).advanced().needs(Self::SOFT_LIMBS)
                .hint("Damping of a soft block's slowest vibration: at 0 it vibrates for long, at 1 it creeps back without a vibration")
                .slider(0.0, 1.0);
        }
        walk.section(Self::JOINTS);
        let limits = 0.0..=LARGEST_LIMIT_RAD;
        settings! { walk,
            bend_limit_rad: optional_per_part("Bend limit", limits.clone(), each_joint, 1.0)
                .needs(Self::GIVEN_BODY)
                .unit("rad")
                .hint(
                    "Maximum angle by which a joint bends up or down. Without a value, each random \
                     snake gets one of the limits to choose from",
                )
                .slider(0.0, 3.0);
            twist_limit_rad: optional_per_part("Twist limit", limits, each_joint, 1.0)
                .needs(Self::GIVEN_BODY)
                .unit("rad")
                .hint(
                    "Maximum angle by which a joint twists about the snake's long axis, in either direction. Without a value, each random \
                     snake gets one of the limits to choose from",
                )
                .slider(0.0, 3.0);
            // The range ends at a thousand times the torque of the report. A greater torque would only disqualify snakes.
            max_bend_torque_nm: per_part("Maximum bend torque", 0.0..=1.0e6, each_joint)
                .unit("N·m")
                .hint("How strongly a joint can bend. Larger torques from the controller are cut off")
                .slider(0.0, 2000.0);
            max_twist_torque_nm: per_part("Maximum twist torque", 0.0..=1.0e6, each_joint)
                .unit("N·m")
                .hint("How strongly a joint can twist. Larger torques from the controller are cut off")
                .slider(0.0, 2000.0);
            torque_budget_nm: number("Torque budget", 1.0..=1.0e7).advanced().needs(Self::OWN_BODIES)
                .unit("N·m")
                .hint("Greatest sum of the torques of all joints of an evolving body. A stronger body has all of them reduced")
                .slider(100.0, 20_000.0)
                .logarithmic_from(100.0);
            // The range ends at 1e5, at which a torque of 1000 N·m turns a joint by half a degree per second.
            joint_damping_nms_per_rad: per_part("Joint damping", 0.0..=1.0e5, each_joint)
                .unit("N·m·s/rad")
                .hint(
                    "Resistance that grows with the speed at which a joint turns. Without it, motion is chaotic and children \
                     hardly move like their parents",
                )
                .slider(0.0, 500.0)
                .logarithmic_from(1.0);
            // Motors of robots with such torques take some 100 W to hold them. At the end of the range, 10 kW, eight axes take 20 times
            // the power of the climber.
            holding_power_w: number("Holding power", 0.0..=10_000.0).advanced()
                .unit("W")
                .hint(
                    "Power that each axis of a joint takes to hold 1,000 N·m, even if it does not move; it grows with the \
                     square of the torque and counts as energy",
                )
                .slider(0.0, 1000.0)
                .logarithmic_from(1.0);
            // The range ends at 0.1 m/s per N, at which the report's snake comes apart under its own weight.
            joint_cfm_m_s_per_n: per_part("Joint softness (CFM)", 0.0..=0.1, each_joint).advanced()
                .unit("m/s per N")
                .hint("0 is rigid; larger values let the joints give way under load")
                .slider(0.0, 0.1)
                .logarithmic_from(1.0e-6);
        }
        walk.used_if(walk.meets(Self::SENSING));
        walk.group("senses", senses);
    }
}

impl AgentSettings {
    /// Section of settings for the joints.
    pub const JOINTS: Section =
        Section { title: "Joints", about: "Range, strength and resistance of the joints." };
    /// Section of settings for the material of the limbs.
    pub const SKIN: Section = Section { title: "Skin", about: "Material of the snake's blocks." };

    /// Needed by settings of the body of the trial, which genomes with a body of their own ignore.
    pub const GIVEN_BODY: Need = Need("a body of the trial");
    /// Needed by settings of bodies that evolve.
    pub const OWN_BODIES: Need = Need("bodies that evolve");
    /// Needed by settings of soft limbs.
    pub const SOFT_LIMBS: Need = Need("soft blocks");
    /// Needed by settings of a controller that senses its surroundings.
    pub const SENSING: Need = Need("a controller that senses its surroundings");

    /// Returns the number of joints between the limbs.
    pub fn joints(&self) -> usize {
        self.limbs.saturating_sub(1) as usize
    }

    /// Returns the power that a joint axis takes per square of its torque, in W/(N·m)².
    pub(super) fn holding_w_per_n2m2(&self) -> f32 {
        self.holding_power_w / 1.0e6
    }

    /// Returns the length of the straight snake, in metres, for genomes without a body of their own.
    pub fn length_m(&self) -> f32 {
        (0..self.limbs as usize).map(|limb| self.limb_length_m.at(limb)).sum()
    }

    /// Builds the body from these settings and a genome. No other function combines the two.
    pub fn body_plan(&self, genome: &Genome) -> BodyPlan {
        if genome.body.is_branching() {
            return creature_body(self, &genome.body.nodes);
        }
        if genome.body.has_own_blocks() {
            return own_body(self, &genome.body.segments);
        }
        let given = |part: &Option<PerPart>, index: usize, of_genome: f32| {
            part.as_ref().map_or(of_genome, |part| part.at(index))
        };
        let limb = |index| PartPlan {
            limb: index,
            width_m: self.limb_width_m.at(index),
            length_m: self.limb_length_m.at(index),
            height_m: self.limb_height_m.at(index),
            density_kg_m3: given(&self.density_kg_m3, index, genome.body.density_kg_m3),
        };
        let joint = |index| JointPlan {
            parent: index,
            child: index + 1,
            mount: None,
            bend_limit_rad: given(&self.bend_limit_rad, index, genome.body.bend_limit_rad),
            twist_limit_rad: given(&self.twist_limit_rad, index, genome.body.twist_limit_rad),
            max_bend_torque_nm: self.max_bend_torque_nm.at(index),
            max_twist_torque_nm: self.max_twist_torque_nm.at(index),
            gap_scale: 1.0,
            damping_nms_per_rad: self.joint_damping_nms_per_rad.at(index),
            cfm_m_s_per_n: self.joint_cfm_m_s_per_n.at(index),
        };
        let limbs: Vec<PartPlan> = (0..self.limbs as usize).map(limb).collect();
        let body = BodyPlan {
            contact_free_pairs: Vec::new(),
            middle_part: BodyPlan::middle_of(&limbs),
            parts: limbs,
            joints: (0..self.joints()).map(joint).collect(),
            springs: Vec::new(),
            angular_damping_per_s: self.angular_damping_per_s,
            holding_w_per_n2m2: self.holding_w_per_n2m2(),
        };
        match &self.youngs_modulus_pa {
            Some(modulus_pa) => {
                body.with_soft_limbs(|limb| Some(self.elasticity(modulus_pa.at(limb))))
            }
            None => body,
        }
    }

    /// Returns the elasticity of a limb with this modulus, in Pa.
    pub(super) fn elasticity(&self, youngs_modulus_pa: f32) -> Elasticity {
        Elasticity {
            youngs_modulus_pa,
            parts: self.soft_parts,
            damping_ratio: self.soft_damping_ratio,
        }
    }

    /// Checks that limbs with the sizes of the trial do not fold up under their own weight. `greatest_kg_m3` is the greatest density that
    /// a genome may have, in kg/m³; it counts unless the trial sets the density.
    ///
    /// # Errors
    /// Returns the first modulus that is too small.
    pub fn check_softness(&self, greatest_kg_m3: f32) -> Result<(), Invalid> {
        let Some(modulus_pa) = &self.youngs_modulus_pa else { return Ok(()) };
        (0..self.limbs as usize).try_for_each(|limb| {
            let sides_m = [self.limb_width_m.at(limb), self.limb_height_m.at(limb)];
            let density = self.density_kg_m3.as_ref().map_or(greatest_kg_m3, |of| of.at(limb));
            let field = match modulus_pa {
                PerPart::All(_) => "youngs_modulus_pa".to_owned(),
                PerPart::Each(_) => format!("youngs_modulus_pa[{limb}]"),
            };
            check_softness(&field, modulus_pa.at(limb), sides_m, density)
        })
    }
}
