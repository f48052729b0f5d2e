//! The snake as a physical plan: box-shaped limbs and the universal joints between them.
//!
//! The built body is the only source of facts about limbs and joints: their number, sizes, masses and
//! torque limits, and which limb represents the whole. It is made from the trial's agent settings and one
//! genome, because either may determine any of these numbers.

/// The whole body. Limb 0 is the head: the foremost limb, nearest to the stairs.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPlan {
    /// The limbs. The world inserts them in this order and lays them out in a row, head first.
    pub limbs: Vec<LimbPlan>,
    /// The joints, in the order in which the world inserts them. A joint's parent comes before its child.
    pub joints: Vec<JointPlan>,
    /// Pairs of limbs that pass through each other although no joint connects them, the front limb first. Joined limbs
    /// always do.
    pub contact_free_pairs: Vec<[usize; 2]>,
    /// Index of the limb whose centre counts as the centre of the snake.
    pub middle_limb: usize,
    /// Rate at which the air takes the limbs' angular velocity, in 1/s: after a time t, `exp(-rate t)` of it is left.
    pub angular_damping_per_s: f32,
}

/// One box-shaped limb.
#[derive(Debug, Clone, PartialEq)]
pub struct LimbPlan {
    /// Size across x, in metres.
    pub width_m: f32,
    /// Size along y, in metres.
    pub length_m: f32,
    /// Size along z, in metres.
    pub height_m: f32,
    /// Density, in kg/m³; with the size it gives the mass.
    pub density_kg_m3: f32,
}

/// One universal joint between the rear face of its parent and the front face of its child: bend about
/// the parent's x axis (snapping a stick), twist about its y axis (wringing a sponge), no other relative
/// motion.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlan {
    /// Index of the limb in front of the joint.
    pub parent: usize,
    /// Index of the limb behind the joint; larger than `parent`.
    pub child: usize,
    /// Largest bend to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist to either side, in radians.
    pub twist_limit_rad: f32,
    /// Largest torque on the bend axis, in N·m. A stronger command is clamped.
    pub max_bend_torque_nm: f32,
    /// Largest torque on the twist axis, in N·m. A stronger command is clamped.
    pub max_twist_torque_nm: f32,
    /// Torque that resists bend and twist, per joint rate, in N·m·s/rad. Integrated implicitly by
    /// the solver, so that large values stay stable.
    pub damping_nms_per_rad: f32,
    /// Factor of the allowed distance between its anchors: 1, or for a body of its own the smallest side of both limbs
    /// in metres, so that small limbs may not come further apart for their size.
    pub gap_scale: f32,
    /// Constraint force mixing, in m/s per N: 0 holds anchors, locked axis and limits practically
    /// rigidly, larger is softer. It stands for a spring of `12 / CFM` N/m along the snake: see
    /// [`super::ERP_TIME_S`].
    pub cfm_m_s_per_n: f32,
}

impl LimbPlan {
    /// Size across x, along y and along z, in metres.
    pub fn size_m(&self) -> [f32; 3] {
        [self.width_m, self.length_m, self.height_m]
    }

    /// Mass of the limb, in kg.
    pub fn mass_kg(&self) -> f32 {
        self.width_m * self.length_m * self.height_m * self.density_kg_m3
    }
}

impl BodyPlan {
    /// Length of the straight body from head to tail, in metres.
    pub fn length_m(&self) -> f32 {
        self.limbs.iter().map(|limb| limb.length_m).sum()
    }

    /// Width of the widest limb, in metres.
    pub fn width_m(&self) -> f32 {
        self.limbs.iter().map(|limb| limb.width_m).fold(0.0, f32::max)
    }

    /// Mass of the whole body, in kg.
    pub fn mass_kg(&self) -> f32 {
        self.limbs.iter().map(LimbPlan::mass_kg).sum()
    }

    /// Greatest torque of all joints together about both axes, in N·m.
    pub fn torque_nm(&self) -> f32 {
        self.joints.iter().map(|joint| joint.max_bend_torque_nm + joint.max_twist_torque_nm).sum()
    }

    /// Distance of the middle limb's centre from the front of the straight body, in metres.
    pub fn front_to_middle_m(&self) -> f32 {
        let before: f32 = self.limbs.iter().take(self.middle_limb).map(|limb| limb.length_m).sum();
        before + self.limbs.get(self.middle_limb).map_or(0.0, |limb| limb.length_m / 2.0)
    }

    /// Volume of the whole body, in m³.
    pub fn volume_m3(&self) -> f32 {
        self.limbs.iter().map(|limb| limb.size_m().into_iter().product::<f32>()).sum()
    }

    /// Height of the line on which the joints lie at the start, in metres: the centre of the tallest limb.
    pub fn axis_height_m(&self) -> f32 {
        self.limbs.iter().map(|limb| limb.height_m).fold(0.0, f32::max) / 2.0
    }

    /// Index of the middle one of limbs that are alike: the third of five.
    pub fn middle_of(limbs: &[LimbPlan]) -> usize {
        limbs.len() / 2
    }

    /// Index of the limb in which the centre of mass of the straight body lies.
    pub fn middle_by_mass(limbs: &[LimbPlan]) -> usize {
        let (mut mass_kg, mut moment_kg_m, mut end_m) = (0.0, 0.0, 0.0);
        for limb in limbs {
            moment_kg_m += limb.mass_kg() * (end_m + limb.length_m / 2.0);
            mass_kg += limb.mass_kg();
            end_m += limb.length_m;
        }
        let centre_m = moment_kg_m / mass_kg;
        let mut end_m = 0.0;
        let passed = limbs.iter().take_while(|limb| {
            end_m += limb.length_m;
            end_m < centre_m
        });
        passed.count().min(limbs.len().saturating_sub(1))
    }
}
