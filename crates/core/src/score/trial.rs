//! The conditions of an evaluation: everything that does not belong to the genome.

use super::{AgentSettings, Behaviour, Evaluation, Fitness, PerturbationList, Repeats};
use crate::check::Invalid;
use crate::genome::{Genome, GenomeShape};
use crate::schema::{
    self, Section, SettingGroup, Walk, absent, choice, number, setting_group, settings,
};
use crate::world::{HealthLimits, PhysicsSettings, Stairs, Surface, WorldPlan};

setting_group! {
    /// The conditions of an evaluation: place, duration, surfaces, body, and measure of fitness.
    pub struct Trial {
        /// Length of the trial, in simulated seconds.
        duration_s: f32 = 5.0;
        /// Position of the snake's centre on the y axis at the start, in metres. The default is where the report's first generation
        /// stands, which does not move. A body from the genome starts with its front 5 m before this position, like the report's snake, so
        /// that all bodies have the same distance to the stairs.
        start_y_m: f32 = -7.23;
        /// Settings of the physics: step length, substeps, gravity.
        physics: PhysicsSettings = PhysicsSettings::default();
        /// Shape and position of the staircase.
        stairs: Stairs = Stairs::default();
        /// The material of the stairs, and of the ground if `ground` is `None`.
        surface: Surface = Surface::default();
        /// The material of the ground, if it differs from that of the stairs.
        ground: Option<Surface> = None;
        /// Properties of the snake that do not evolve.
        agent: AgentSettings = AgentSettings::default();
        /// Measure of fitness.
        fitness: Fitness = Fitness::default();
        /// Cost of energy, in units of the fitness per kJ. It is subtracted from the fitness.
        energy_cost_per_kj: f32 = 0.0;
        /// Number of trials per evaluation, and their perturbations.
        repeats: Repeats = Repeats::default();
        /// Limits beyond which the snake is disqualified.
        health: HealthLimits = HealthLimits::default();
    }
}

/// Distance of the front of a body from the genome from `start_y_m`, in metres: half the length of the report's snake.
pub(crate) const FRONT_M: f32 = 5.0;

impl SettingGroup for Trial {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            duration_s,
            start_y_m,
            physics,
            stairs,
            surface,
            ground,
            agent,
            fitness,
            energy_cost_per_kj,
            repeats,
            health,
        } = self;
        walk.section(Self::SURFACE);
        walk.group("surface", surface);
        walk.section(Self::GROUND);
        match ground {
            Some(ground) => walk.group("ground", ground),
            None => walk.setting(
                "ground",
                absent(
                    "Ground",
                    "none; setting ground.friction, for example, gives it a surface of its own",
                )
                .hint("Unless the ground is given its own surface, it uses the same one as the stairs"),
                &mut (),
            ),
        }
        walk.group("agent", agent);
        walk.group("stairs", stairs);
        walk.section(Section {
            title: "Time and start",
            about: "Duration of a trial, and where the snake starts.",
        });
        settings! { walk,
            // The range ends at ten minutes, which take a third of a second to compute. Longer genomes would make unreadable saves.
            duration_s: number("Duration", 0.1..=600.0)
                .unit("s")
                .hint("Simulated time of a trial. Longer trials take longer to evaluate")
                .slider(1.0, 30.0);
            start_y_m: number("Start position", -100.0..=100.0).advanced()
                .unit("m")
                .hint("Distance of the snake's middle along the stairs (y) at the start. The stairs are further on")
                .slider(-20.0, 10.0);
        }
        walk.group("physics", physics);
        walk.section(Self::REWARD);
        settings! { walk,
            fitness: choice("Fitness").hint("Quantity that evolution maximises");
            // The range ends at 1000, at which a joule costs a metre.
            energy_cost_per_kj: number("Energy cost", 0.0..=1000.0)
                .unit("per kJ")
                .hint("Subtracted from the fitness for each kJ that the joints use")
                .slider(0.0, 10.0)
                .logarithmic_from(0.01);
        }
        walk.group("repeats", repeats);
        walk.group("health", health);
    }
}

impl Trial {
    /// Section of settings for the material of the stairs.
    pub const SURFACE: Section = Section {
        title: "Surface",
        about: "Material of the stairs, and of the ground unless it has its own surface.",
    };
    /// Section of settings for the material of the ground.
    pub const GROUND: Section =
        Section { title: "Ground", about: "Material of the ground around the stairs." };
    /// Section of settings for the reward.
    pub const REWARD: Section = Section { title: "Reward", about: "What evolution maximises." };

    /// Checks every field against its range.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        schema::check(self)
    }

    /// Returns this trial on other stairs, with the first riser and the landing of its own stairs.
    #[must_use]
    pub fn on_stairs(&self, stairs: Stairs) -> Self {
        let Stairs { first_riser_y_m, landing_m, .. } = self.stairs;
        Self { stairs: Stairs { first_riser_y_m, landing_m, ..stairs }, ..self.clone() }
    }

    /// Returns the number of physics steps of the trial: its duration, rounded to the nearest step.
    pub fn steps(&self) -> u32 {
        steps_in(self.duration_s, &self.physics)
    }

    /// Returns the maximum number of simulations for an evaluation.
    pub fn most_simulations(&self) -> u32 {
        self.repeats.trials.max(1)
    }

    /// Returns the number of simulations that an evaluation took: only one if the snake was disqualified in the nominal trial.
    pub fn simulations_of(&self, evaluation: &Evaluation) -> u32 {
        if evaluation.disqualified.is_none() { self.most_simulations() } else { 1 }
    }

    /// Returns the trial by whose fitness a run chooses its champions: this trial and a fixed list of variations. `None` if it chooses by
    /// the fitness in this trial alone.
    pub fn that_chooses_champions(&self) -> Option<Self> {
        let varied = self.repeats.champion_trials;
        let list = PerturbationList::Fixed;
        let repeats =
            || Repeats { trials: varied + 1, list, list_number: 0, ..self.repeats.clone() };
        (varied > 0).then(|| Self { repeats: repeats(), ..self.clone() })
    }

    /// Checks that a genome can be built and controlled in this trial.
    pub fn check_genome(&self, genome: &Genome) -> Result<(), Invalid> {
        genome.body.check()?;
        genome.check_neurons()?;
        let body = self.agent.body_plan(genome);
        let (joints, expected) = (genome.controller.joints(), body.joints.len());
        if joints != expected {
            let allowed = format!("{expected}, one per joint of {} limbs", body.limbs());
            return Err(Invalid::new("controller joints", format!("{joints} joints"), allowed));
        }
        if !genome.body.has_own_blocks() {
            self.agent
                .check_softness(genome.body.density_kg_m3)
                .map_err(|error| error.inside("agent"))?;
        }
        genome.controller.check()
    }

    /// Path of the physics engine in settings.
    pub const ENGINE_FIELD: &str = "trial.physics.engine";

    /// Returns the plan of the world in which this trial evaluates a genome.
    pub fn world_plan(&self, genome: &Genome) -> WorldPlan {
        let body = self.agent.body_plan(genome);
        let has_own_body = genome.body.has_own_blocks();
        WorldPlan {
            physics: self.physics.clone(),
            stairs: self.stairs.clone(),
            surface: self.surface.clone(),
            ground: self.ground().clone(),
            skin: self.agent.skin.clone(),
            health: self.health.clone(),
            // A body from the genome starts with its front in the same place, whatever its length.
            start_y_m: if has_own_body {
                self.start_y_m + FRONT_M - body.length_m() / 2.0
            } else {
                self.start_y_m
            },
            settles: has_own_body,
            body,
            start_x_m: 0.0,
            start_turn_rad: 0.0,
        }
    }

    /// Returns the shape of the genomes for this trial.
    pub fn genome_shape(&self) -> GenomeShape {
        GenomeShape { joints: self.agent.joints(), duration_s: self.duration_s }
    }

    /// Returns the fitness of an agent that does not move: its start, or zero if the fitness is not a position on the y axis.
    pub fn resting_fitness(&self) -> f32 {
        if self.fitness.is_along_y() { self.start_y_m } else { 0.0 }
    }

    /// Returns the material of the ground.
    pub fn ground(&self) -> &Surface {
        self.ground.as_ref().unwrap_or(&self.surface)
    }

    /// Describes the centre position `y_m`, for example a mean, in the words of the report's Table 1.
    pub fn meaning(&self, y_m: f64) -> String {
        let length_m = f64::from(self.agent.length_m());
        self.stairs.meaning(y_m, f64::from(self.start_y_m), length_m)
    }

    /// Describes the centre position `y_m` of the snake of a genome, which may have a body of its own.
    fn meaning_of(&self, genome: &Genome, y_m: f64) -> String {
        if !genome.body.has_own_blocks() {
            return self.meaning(y_m);
        }
        let length_m = self.agent.body_plan(genome).length_m();
        self.stairs.meaning(y_m, f64::from(self.middle_start_y_m(genome)), length_m.into())
    }

    /// Returns the position of the middle limb's centre on the y axis at the start, in metres.
    pub fn middle_start_y_m(&self, genome: &Genome) -> f32 {
        if !genome.body.has_own_blocks() {
            self.start_y_m
        } else {
            self.start_y_m + FRONT_M - self.agent.body_plan(genome).front_to_middle_m()
        }
    }

    /// Describes where a snake ended: like [`Trial::meaning`], unless its behaviour shows that it lay beside or behind the stairs. For a
    /// record without a behaviour, only the position is described.
    pub fn result_in_words(&self, genome: &Genome, evaluation: &Evaluation) -> String {
        let y_m = f64::from(evaluation.centre_y_m);
        let off_the_stairs = match evaluation.behaviour {
            Some(Behaviour { steps_climbed: 0, .. }) => self.stairs.meaning_off_the_stairs(y_m),
            _ => None,
        };
        off_the_stairs.unwrap_or_else(|| self.meaning_of(genome, y_m))
    }
}

/// Returns the number of physics steps of a duration in s, rounded to the nearest step; at least one.
pub(super) fn steps_in(duration_s: f32, physics: &PhysicsSettings) -> u32 {
    let steps = f64::from(duration_s) * f64::from(physics.steps_per_s);
    libm::round(steps).max(1.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Settings, with_fields};
    use crate::genome::{ControllerKind, GenomeShape, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::score::evaluate;
    use crate::world::Disqualification;

    impl Trial {
        /// Returns the random genome with this number, which plays torque signals.
        pub fn random_genome(&self, number: u32) -> Genome {
            self.random_genome_of(ControllerKind::Signal, number)
        }

        /// Returns the random genome with this number and this kind of controller.
        pub fn random_genome_of(&self, controller: ControllerKind, number: u32) -> Genome {
            let space = GenomeSpace { controller, ..GenomeSpace::default() };
            space.random_genome(self.genome_shape(), &mut stream(1, 1, number, Purpose::Birth))
        }
    }

    #[test]
    fn a_disqualified_snake_is_simulated_in_its_nominal_trial_alone() {
        let mut trial = Trial::default();
        trial.repeats.trials = 4;
        let healthy = Evaluation::of_fitness(1.0);
        let disqualified = Some(Disqualification::TooFast);
        assert_eq!(trial.simulations_of(&healthy), 4);
        assert_eq!(trial.simulations_of(&Evaluation { disqualified, ..healthy }), 1);
    }

    /// Returns settings in which every parameter has an effect.
    fn lively() -> Settings {
        let changes = [
            ("surface.bounce", "0.3"),
            ("surface.bounce_velocity_m_s", "0.5"),
            ("surface.soft_cfm_m_s_per_n", "0.001"),
            ("surface.slip_m_s_per_n", "0.001"),
            ("surface.dampen_per_s", "0.1"),
            ("skin.bounce", "0.1"),
            ("skin.soft_cfm_m_s_per_n", "0.001"),
            ("joint_cfm_m_s_per_n", "0.00001"),
            ("ground.friction", "0.9"),
            // The stairs are within reach at once.
            ("first_riser_y_m", "-1.5"),
            ("trial.duration_s", "5"),
            // These limits are wide enough for the trial to reach its end.
            ("joint_drift_m", "10"),
            ("speed_m_s", "1000"),
            ("arena_half_width_m", "1000"),
            ("arena_back_m", "1000"),
        ];
        with_fields(&Settings::default(), changes).expect("allowed")
    }

    /// Index of a random genome that touches ground and stairs, and lands on both.
    const TRAVELLER: u32 = 2;

    fn trace(settings: &Settings) -> u64 {
        let joints = settings.trial.agent.joints();
        let mut rng = stream(1, 1, TRAVELLER, Purpose::Birth);
        evaluate(
            &GenomeSpace::default()
                .random_genome(GenomeShape { joints, duration_s: 5.0 }, &mut rng),
            &settings.trial,
        )
        .trace_hash
    }

    #[test]
    fn each_parameter_alone_changes_the_trajectory_of_one_genome() {
        let lively = lively();
        let unchanged = trace(&lively);
        assert_eq!(unchanged, trace(&lively));
        for (field, value) in [
            ("surface.friction", "0.9"),
            ("surface.bounce", "0.35"),
            ("surface.bounce_velocity_m_s", "3"),
            ("surface.soft_erp", "0.3"),
            ("surface.soft_cfm_m_s_per_n", "0.0012"),
            ("surface.slip_m_s_per_n", "0.0012"),
            ("surface.dampen_per_s", "0.12"),
            ("ground.friction", "1.1"),
            ("ground.bounce", "0.35"),
            ("ground.bounce_velocity_m_s", "3"),
            ("ground.soft_erp", "0.3"),
            ("ground.soft_cfm_m_s_per_n", "0.0012"),
            ("ground.slip_m_s_per_n", "0.0012"),
            ("ground.dampen_per_s", "0.12"),
            ("skin.friction", "1.1"),
            ("skin.bounce", "0.35"),
            ("skin.soft_erp", "0.3"),
            ("skin.soft_cfm_m_s_per_n", "0.0012"),
            ("agent.limbs", "6"),
            ("limb_width_m", "[1, 1, 1.1, 1, 1]"),
            ("limb_length_m", "[2, 2, 2, 2.1, 2]"),
            ("limb_height_m", "[1, 1, 1, 1, 1.1]"),
            ("agent.density_kg_m3", "[2, 2, 2, 2, 3]"),
            ("agent.bend_limit_rad", "[0.5, 1, 1, 1]"),
            ("agent.twist_limit_rad", "[1, 1, 1, 0.2]"),
            ("max_bend_torque_nm", "[1000, 1000, 500, 1000]"),
            ("max_twist_torque_nm", "[1000, 300, 1000, 1000]"),
            ("joint_damping_nms_per_rad", "[30, 30, 31, 30]"),
            ("joint_cfm_m_s_per_n", "[0.00001, 0.00002, 0.00001, 0.00001]"),
            ("angular_damping_per_s", "2.1"),
            ("stairs.rise_m", "0.6"),
            ("stairs.tread_m", "1.8"),
            ("stairs.steps", "1"),
            ("stairs.first_riser_y_m", "-1.6"),
            ("trial.start_y_m", "-7.2"),
            ("trial.duration_s", "2.5"),
            ("steps_per_s", "61"),
            ("substeps", "5"),
            ("gravity_m_s2", "9.7"),
        ] {
            let changed = with_fields(&lively, [(field, value)]).expect(field);
            assert_ne!(changed, lively, "{field}");
            assert_ne!(trace(&changed), unchanged, "{field} = {value} does nothing");
        }
    }

    #[test]
    fn a_list_of_values_sets_the_parts_in_order() {
        let changes = [
            ("agent.limbs", "3"),
            ("limb_width_m", "[1, 2, 3]"),
            ("agent.density_kg_m3", "[4, 5, 6]"),
            ("agent.bend_limit_rad", "[0.1, 0.2]"),
            ("joint_damping_nms_per_rad", "[7, 8]"),
            ("max_bend_torque_nm", "[9, 10]"),
        ];
        let settings = with_fields(&Settings::default(), changes).expect("allowed");
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = GenomeSpace::default()
            .random_genome(GenomeShape { joints: 2, duration_s: 1.0 }, &mut rng);
        let body = settings.trial.world_plan(&genome).body;
        let limbs: Vec<_> =
            body.parts.iter().map(|limb| (limb.width_m, limb.density_kg_m3)).collect();
        assert_eq!(limbs, [(1.0, 4.0), (2.0, 5.0), (3.0, 6.0)]);
        let joints: Vec<_> = body
            .joints
            .iter()
            .map(|joint| {
                (joint.bend_limit_rad, joint.damping_nms_per_rad, joint.max_bend_torque_nm)
            })
            .collect();
        assert_eq!(joints, [(0.1, 7.0, 9.0), (0.2, 8.0, 10.0)]);
        assert_eq!(body.joints[0].twist_limit_rad, genome.body.twist_limit_rad, "the genome's own");
    }
}
