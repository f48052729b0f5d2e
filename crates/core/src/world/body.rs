//! The snake as a physical plan: box-shaped parts, the universal joints between limbs, and the springs within soft limbs.
//!
//! A **part** is one body of the physics engine. A rigid **limb** is one part; a soft limb is several parts in a row, held together by
//! springs.
//!
//! The built body is the only source of facts about limbs and joints: their number, sizes, masses and torque limits, and which part
//! represents the whole. It is made from the trial's agent settings and one genome, because either may determine each of these numbers.

use std::ops::Range;

use super::{Mount, Pose, Rotation, Vector};

/// The whole body. Part 0 is the head, or the foremost part of a soft head: the part nearest to the stairs.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPlan {
    /// Parts of the body, limb by limb from the head. The world inserts them in this order and lays them out in a row, unless joints have
    /// mounts.
    pub parts: Vec<PartPlan>,
    /// Joints between limbs, from the head, which the controller drives. A joint's parent comes before its child.
    pub joints: Vec<JointPlan>,
    /// Springs within soft limbs, from the head; empty if all limbs are rigid.
    pub springs: Vec<SpringPlan>,
    /// Pairs of limbs that pass through each other, the front limb first: neighbours of a short limb, and joined limbs of which at least
    /// one is soft. Joined rigid limbs always pass through each other and are not listed.
    pub contact_free_pairs: Vec<[usize; 2]>,
    /// Index of the part whose centre counts as the centre of the snake.
    pub middle_part: usize,
    /// Rate at which the air slows the rotation of the parts, in 1/s: after a time t, a part keeps `exp(-rate t)` of its angular velocity.
    pub angular_damping_per_s: f32,
    /// Power that a joint axis takes for its torque alone, per square of the torque, in W/(N·m)².
    pub holding_w_per_n2m2: f32,
}

/// One box-shaped part of the body: a rigid limb, or a piece of a soft limb.
#[derive(Debug, Clone, PartialEq)]
pub struct PartPlan {
    /// Index of the limb to which the part belongs; the head is 0.
    pub limb: usize,
    /// Size of the part across x, in metres.
    pub width_m: f32,
    /// Size of the part along y, in metres.
    pub length_m: f32,
    /// Size of the part along z, in metres.
    pub height_m: f32,
    /// Density of the part, in kg/m³.
    pub density_kg_m3: f32,
}

/// One universal joint. It connects the rear face of its parent, or the place of its mount, to the front face of its child. It bends about
/// the parent's x axis (snapping a stick) and twists about the parent's y axis (wringing a sponge), and allows no other relative motion.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlan {
    /// Index of the part in front of the joint.
    pub parent: usize,
    /// Index of the part behind the joint; larger than `parent`.
    pub child: usize,
    /// Where the joint holds its child on its parent. `None`: at the rear face of the parent, with the child straight behind it.
    pub mount: Option<Mount>,
    /// Largest bend of the joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of the joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Largest torque on the bend axis, in N·m. A stronger command is clamped.
    pub max_bend_torque_nm: f32,
    /// Largest torque on the twist axis, in N·m. A stronger command is clamped.
    pub max_twist_torque_nm: f32,
    /// Torque that resists bend and twist, per joint rate, in N·m·s/rad. The solver integrates it implicitly, so that large values stay
    /// stable.
    pub damping_nms_per_rad: f32,
    /// Factor on the allowed distance between the joint's two anchors: 1, or for a body from the genome the smallest side of both limbs in
    /// metres, so that the anchors of small limbs may only come apart in proportion to their size.
    pub gap_scale: f32,
    /// Constraint force mixing, in m/s per N: 0 holds anchors, locked axis and limits practically
    /// rigidly, larger is softer. It stands for a spring of `12 / CFM` N/m along the snake: see
    /// [`super::ERP_TIME_S`].
    pub cfm_m_s_per_n: f32,
}

/// A spring between the rear face of a part and the front face of the next one of the same limb. It holds the faces together,
/// and resists their rotation against each other about all three axes.
#[derive(Debug, Clone, PartialEq)]
pub struct SpringPlan {
    /// Index of the part in front of the spring.
    pub parent: usize,
    /// Index of the part behind the spring.
    pub child: usize,
    /// Torque per angle about x (bending up and down), y (torsion) and z (bending sideways), in N·m/rad.
    pub stiffness_nm_per_rad: [f32; 3],
    /// Torque per angular rate about x, y and z, in N·m·s/rad.
    pub damping_nms_per_rad: [f32; 3],
    /// Factor on the allowed distance between the spring's two anchors: the smallest side of the parts in metres, but at most 1.
    pub gap_scale: f32,
}

/// Length of a part, as a share of the height of its taller neighbour, below which its two neighbours pass through each other.
const SHORT_MIDDLE: f32 = 0.6;

/// Returns whether the neighbours of a part of this length pass through each other, given their heights. All are in metres. If they
/// collided, a bend of the joints between them would press their edges together and block the joints.
pub fn neighbours_pass(middle_length_m: f32, heights_m: [f32; 2]) -> bool {
    middle_length_m < SHORT_MIDDLE * heights_m[0].max(heights_m[1])
}

impl PartPlan {
    /// Returns the size of the part across x, along y and along z, in metres.
    pub fn size_m(&self) -> [f32; 3] {
        [self.width_m, self.length_m, self.height_m]
    }

    /// Returns the part's smallest side, in metres.
    pub fn smallest_side_m(&self) -> f32 {
        self.size_m().into_iter().fold(f32::INFINITY, f32::min)
    }

    /// Returns the mass of the part, in kg.
    pub fn mass_kg(&self) -> f32 {
        self.width_m * self.length_m * self.height_m * self.density_kg_m3
    }

    /// Returns the moments of inertia of the part about its own axes, in kg·m².
    pub fn inertia_kg_m2(&self) -> Vector {
        let [w2, l2, h2] = self.size_m().map(|size_m| size_m * size_m);
        Vector::new(l2 + h2, w2 + h2, w2 + l2) * (self.mass_kg() / 12.0)
    }
}

impl BodyPlan {
    /// Returns the length of the straight body from head to tail, in metres. For a branching body, it is the extent along y before the
    /// trial.
    pub fn length_m(&self) -> f32 {
        if self.is_branching() {
            return self.branching_length_m();
        }
        self.parts.iter().map(|part| part.length_m).sum()
    }

    /// Returns the two parts that each joint, and after the joints each spring, connects. Snakes of equal pairs can be simulated side by
    /// side.
    pub fn joined_parts(&self) -> Vec<[usize; 2]> {
        let joints = self.joints.iter().map(|joint| [joint.parent, joint.child]);
        joints.chain(self.springs.iter().map(|spring| [spring.parent, spring.child])).collect()
    }

    /// Returns the number of limbs.
    pub fn limbs(&self) -> usize {
        self.parts.last().map_or(0, |last| last.limb + 1)
    }

    /// Returns the range of the indices of a limb's parts.
    pub fn parts_of(&self, limb: usize) -> Range<usize> {
        let first = self.parts.partition_point(|part| part.limb < limb);
        first..self.parts.partition_point(|part| part.limb <= limb)
    }

    /// Returns the size of a limb at rest across x, along y and along z, in metres; zeros if there is no such limb.
    pub fn limb_size_m(&self, limb: usize) -> [f32; 3] {
        let parts = &self.parts[self.parts_of(limb)];
        let length_m = parts.iter().map(|part| part.length_m).sum();
        parts.first().map_or([0.0; 3], |first| [first.width_m, length_m, first.height_m])
    }

    /// Returns the joint in front of a limb; `None` for the head.
    pub fn joint_before(&self, limb: usize) -> Option<&JointPlan> {
        let first = self.parts_of(limb).start;
        self.joints.iter().find(|joint| joint.child == first)
    }

    /// Returns the first spring within a limb, which is equal to the limb's other springs; `None` for a rigid limb.
    pub fn spring_of(&self, limb: usize) -> Option<&SpringPlan> {
        let parts = self.parts_of(limb);
        self.springs.iter().find(|spring| parts.contains(&spring.parent))
    }

    /// Returns the density of a limb, in kg/m³.
    pub fn limb_density_kg_m3(&self, limb: usize) -> f32 {
        self.parts[self.parts_of(limb).start].density_kg_m3
    }

    /// Returns the mass of a limb, in kg.
    pub fn limb_mass_kg(&self, limb: usize) -> f32 {
        self.parts[self.parts_of(limb)].iter().map(PartPlan::mass_kg).sum()
    }

    /// Computes the poses of the limbs from the poses of the parts. A soft limb has the mean position of its parts, and the rotation of
    /// its middle part or the mean of its two middle ones.
    pub fn limb_poses(&self, parts: &[Pose]) -> Vec<Pose> {
        if self.springs.is_empty() {
            return parts.to_vec();
        }
        let limb = |limb: usize| {
            let parts = parts.get(self.parts_of(limb)).unwrap_or_default();
            let places = parts.iter().map(|part| part.translation);
            let place = places.sum::<Vector>() / parts.len().max(1) as f32;
            let turn = |part: usize| parts.get(part).map_or(Rotation::IDENTITY, |of| of.rotation);
            let half = parts.len() / 2;
            let between = turn((parts.len() - 1) / 2).lerp(turn(half), 0.5);
            Pose::from_parts(place, if parts.len() % 2 == 1 { turn(half) } else { between })
        };
        (0..self.limbs()).map(limb).collect()
    }

    /// Returns the width of the widest limb, in metres.
    pub fn width_m(&self) -> f32 {
        self.parts.iter().map(|part| part.width_m).fold(0.0, f32::max)
    }

    /// Returns the mass of the whole body, in kg.
    pub fn mass_kg(&self) -> f32 {
        self.parts.iter().map(PartPlan::mass_kg).sum()
    }

    /// Returns the sum of the greatest torques of all joints about both axes, in N·m.
    pub fn torque_nm(&self) -> f32 {
        self.joints.iter().map(|joint| joint.max_bend_torque_nm + joint.max_twist_torque_nm).sum()
    }

    /// Returns the distance of the middle part's centre from the front of the body before its trial, in metres.
    pub fn front_to_middle_m(&self) -> f32 {
        if self.is_branching() {
            return -self.rest_poses()[self.middle_part].translation.y;
        }
        let before: f32 = self.parts.iter().take(self.middle_part).map(|part| part.length_m).sum();
        before + self.parts.get(self.middle_part).map_or(0.0, |part| part.length_m / 2.0)
    }

    /// Returns the volume of the whole body, in m³.
    pub fn volume_m3(&self) -> f32 {
        self.parts.iter().map(|part| part.size_m().into_iter().product::<f32>()).sum()
    }

    /// Returns the height of the line on which the joints lie at the start, in metres: half the height of the tallest limb.
    pub fn axis_height_m(&self) -> f32 {
        self.parts.iter().map(|part| part.height_m).fold(0.0, f32::max) / 2.0
    }

    /// Returns the index of the middle part of equal parts: the third of five.
    pub fn middle_of(parts: &[PartPlan]) -> usize {
        parts.len() / 2
    }

    /// Returns the index of the part in which the centre of mass of the straight body lies.
    pub fn middle_by_mass(parts: &[PartPlan]) -> usize {
        let (mut mass_kg, mut moment_kg_m, mut end_m) = (0.0, 0.0, 0.0);
        for part in parts {
            moment_kg_m += part.mass_kg() * (end_m + part.length_m / 2.0);
            mass_kg += part.mass_kg();
            end_m += part.length_m;
        }
        let centre_m = moment_kg_m / mass_kg;
        let mut end_m = 0.0;
        let passed = parts.iter().take_while(|part| {
            end_m += part.length_m;
            end_m < centre_m
        });
        passed.count().min(parts.len().saturating_sub(1))
    }
}
