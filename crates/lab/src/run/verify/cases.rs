//! The runs whose bits are compared.

use super::VerifyError;
use snakes_core::evolve::{RunPlan, Settings, with_fields};
use snakes_core::save::{Preset, load_preset, shipped_presets};
use snakes_core::schema::Choices;
use snakes_core::score::Fitness;
use snakes_core::world::PhysicsEngine;

/// A case: its description; its seed, population and generations; and its changes to the preset `report`, in the syntax of `--set`.
type Case = (&'static str, [u32; 3], &'static str);

const CASES: &[Case] = &[
    ("report, 3 generations of 40, seed 1", [1, 40, 3], ""),
    ("the same with seed 2", [2, 40, 3], ""),
    (
        "120 steps a second, 8 substeps, moon gravity, 30 points a second",
        [1, 40, 3],
        "steps_per_s=120; substeps=8; gravity_m_s2=1.62; genome.points_per_s=30",
    ),
    (
        "bouncing ice, soft joints without damping, seven limbs",
        [1, 40, 3],
        "surface.friction=0.05; surface.bounce=0.8; joint_damping_nms_per_rad=0; joint_cfm_m_s_per_n=0.0001; \
         agent.limbs=7",
    ),
    (
        "slipping stairs, a soft damping ground, soft limbs of different lengths and densities, steps climbed",
        [1, 40, 3],
        "surface.slip_m_s_per_n=0.01; surface.bounce=0.4; surface.bounce_velocity_m_s=1; ground.soft_erp=0.5; \
         ground.soft_cfm_m_s_per_n=0.003; ground.dampen_per_s=0.5; trial.fitness=steps_climbed; \
         skin.soft_cfm_m_s_per_n=0.001; limb_length_m=[1, 2, 2, 2, 1.5]; agent.density_kg_m3=[2, 2, 3, 2, 2]; \
         agent.bend_limit_rad=0.9",
    ),
    ("bouncing stairs", [3, 6, 2], "surface.bounce=0.5; first_riser_y_m=-1.5"),
    (
        "stairs with a bounce velocity",
        [3, 6, 2],
        "surface.bounce=0.6; surface.bounce_velocity_m_s=2; first_riser_y_m=-1.5",
    ),
    (
        "soft stairs",
        [3, 6, 2],
        "surface.soft_cfm_m_s_per_n=0.002; surface.soft_erp=0.4; first_riser_y_m=-1.5",
    ),
    ("slipping stairs", [3, 6, 2], "surface.slip_m_s_per_n=0.005; first_riser_y_m=-1.5"),
    ("damping stairs", [3, 6, 2], "surface.dampen_per_s=0.6; first_riser_y_m=-1.5"),
    ("ice on the ground only", [3, 6, 2], "ground.friction=0.03; ground.bounce=0.2"),
    (
        "a slipping ground with a bounce velocity",
        [3, 6, 2],
        "ground.slip_m_s_per_n=0.01; ground.bounce_velocity_m_s=1",
    ),
    ("a rubber skin", [3, 6, 2], "skin.friction=2; skin.bounce=0.6; skin.soft_erp=0.5"),
    ("a soft skin", [3, 6, 2], "skin.soft_cfm_m_s_per_n=0.002"),
    ("two limbs", [3, 6, 2], "agent.limbs=2"),
    ("three limbs, no stairs", [3, 6, 2], "agent.limbs=3; stairs.steps=0"),
    ("twelve limbs, one step", [3, 6, 2], "agent.limbs=12; stairs.steps=1"),
    (
        "a hundred low steps",
        [3, 6, 2],
        "stairs.steps=100; rise_m=0.1; tread_m=0.3; first_riser_y_m=-2",
    ),
    (
        "a short landing, a wide stair",
        [3, 6, 2],
        "landing_m=2; stairs.width_m=9; stairs.steps=1; first_riser_y_m=-1.5",
    ),
    (
        "limbs of different sizes",
        [3, 6, 2],
        "limb_width_m=[1, 1.2, 1, 1, 0.8]; limb_height_m=[0.8, 1, 1, 1, 1.1]",
    ),
    (
        "joints of different limits and torques",
        [3, 6, 2],
        "agent.bend_limit_rad=[0.5, 1, 1, 2.9]; agent.twist_limit_rad=[1, 0, 1, 0.2]; \
         max_bend_torque_nm=[1000, 500, 1000, 100]; max_twist_torque_nm=[300, 1000, 0, 1000]",
    ),
    (
        "joints of different damping and softness",
        [3, 6, 2],
        "joint_damping_nms_per_rad=[0, 30, 100, 10]; joint_cfm_m_s_per_n=[0, 0.00001, 0.0001, 0]; \
         angular_damping_per_s=2",
    ),
    ("the same density for all", [3, 6, 2], "agent.density_kg_m3=3"),
    (
        "a thousand steps a second, one substep",
        [3, 4, 1],
        "steps_per_s=1000; substeps=1; trial.duration_s=1",
    ),
    ("twenty steps a second", [3, 6, 2], "steps_per_s=20; substeps=8"),
    ("another start and a longer trial", [3, 6, 2], "start_y_m=2; trial.duration_s=6.03"),
    (
        "narrow health limits",
        [3, 20, 1],
        "joint_drift_m=0.01; speed_m_s=8; arena_half_width_m=2; arena_back_m=13",
    ),
    (
        "other ranges of the genes",
        [3, 6, 2],
        "torque_range_nm=400; torque_step_nm=50; bend_limits_rad=[0.3, 0.7]; twist_limits_rad=[0.4]; \
         density_max_kg_m3=8; density_min_kg_m3=1",
    ),
    (
        "halving, one parent, five generations",
        [3, 8, 5],
        "parents=1; mutation_range_nm=300; mutation_decay=0.8",
    ),
    ("waves, halving", [3, 6, 3], "controller=wave; harmonics=2; frequency_max_hz=2"),
    ("gaits, halving", [3, 6, 3], "controller=gait; angle_range_rad=1.2; twist_range_rad=0.3"),
    ("one iteration per substep", [3, 6, 2], "iterations=1; substeps=4"),
    (
        "stairs with a height for each step",
        [3, 6, 2],
        "stairs.steps=3; rise_m=[0.5, 0.2, 0.7]; start_y_m=-2.2",
    ),
    (
        "treads of different depths, slopes up and down, a step down to the ground, nosings",
        [3, 6, 2],
        "stairs.steps=5; rise_m=[0.5, 0.3, -0.4, -0.4, 0.4]; tread_m=[1.5, 2, 2, 0.8, 2]; \
         slope_m=[0.8, 0, 1.2, 0, 0]; nosing_m=0.2; first_riser_y_m=-1.5",
    ),
    (
        "gaits, CMA-ES, a ladder of stairs",
        [3, 8, 3],
        "controller=gait; strategy=cma_es; ladder.first_rise_m=0.1; ladder.step_m=0.2; ladder.share=0.1; way=0.02; \
         patience=1; first_riser_y_m=-1.5",
    ),
    (
        "champions chosen on varied trials, the same for all",
        [3, 12, 2],
        "controller=gait; repeats.trials=3; repeats.list=fixed; champion_trials=2; off.tread=0.2; step_rate=0.4; \
         shove_m_s=3",
    ),
    ("gaits, genetic algorithm", [3, 12, 4], "controller=gait; strategy=ga; frequency_min_hz=0.5"),
    (
        "signals, genetic algorithm by rank",
        [3, 12, 4],
        "strategy=ga; selection=rank; tournament=2; crossover=one_point; crossover_share=0.9; \
         mutation=uniform; ga.step=0.2; cooling=0.8; elites=1",
    ),
    (
        "gaits, CMA-ES",
        [3, 8, 5],
        "controller=gait; strategy=cma_es; cma_es.step=0.2; newborns=5; stiffness_min_nm_per_rad=100; \
         stiffness_max_nm_per_rad=600; servo_damping_nms_per_rad=10",
    ),
    (
        "short signals, CMA-ES without negative weights",
        [3, 8, 5],
        "strategy=cma_es; genome.points_per_s=1; active=false; restarts=ipop",
    ),
    ("long signals, CMA-ES", [3, 8, 5], "strategy=cma_es; restarts=none"),
    ("waves, MAP-Elites", [3, 20, 5], "controller=wave; strategy=map_elites; map_elites.step=0.1"),
    (
        "gaits, MAP-Elites with another archive",
        [3, 20, 5],
        "controller=gait; strategy=map_elites; map_elites.x=contact_duty; map_elites.y=frequency; \
         map_elites.cells=5; map_elites.line=0.5; cma_share=0.3; cma_step=0.3",
    ),
    ("gaits, novelty", [3, 12, 4], "controller=gait; strategy=novelty"),
    (
        "waves, pure novelty",
        [3, 12, 4],
        "controller=wave; strategy=novelty; novelty.weight=1; neighbours=3; remembered=2; archive_limit=5; \
         novelty.first=sideways; novelty.second=energy_per_metre",
    ),
    ("gaits, random", [3, 12, 2], "controller=gait; strategy=random"),
    (
        "the mean of three trials, less what energy costs",
        [3, 6, 2],
        "controller=gait; repeats.trials=3; energy_cost_per_kj=0.1",
    ),
    (
        "the worst of three trials",
        [3, 6, 2],
        "controller=gait; repeats.trials=3; counts=worst; repeats.off.friction=0.5; repeats.off.rise=0.3; \
         repeats.off.density=0.3; repeats.off.start_m=1; repeats.off.turn_deg=20",
    ),
    (
        "gaits with reflexes on stairs of their generation",
        [3, 8, 4],
        "controller=reflex; strategy=cma_es; repeats.trials=3; repeats.list=generation; start_y_m=-3; \
         reflex_weight_range=2; reflex_reach_rad=0.5; reflex_phase_rad_per_s=3",
    ),
    (
        "gaits with reflexes, blind and numb",
        [3, 6, 2],
        "controller=reflex; senses.sight=false; senses.touch=false; start_y_m=-3",
    ),
    (
        "modular networks without balance",
        [3, 12, 3],
        "controller=modular; strategy=ga; network.hidden=3; network.weight_range=2; senses.balance=false; \
         start_y_m=-3",
    ),
    ("central networks", [3, 8, 3], "controller=central; strategy=cma_es; start_y_m=-3"),
    (
        "continuous-time networks",
        [3, 8, 3],
        "controller=ctrnn; strategy=cma_es; ctrnn_weight_range=8; start_y_m=-3",
    ),
    (
        "waves by rules, with waves taken over",
        [3, 12, 4],
        "controller=rules; strategy=ga; wave_takeover=0.5; library_waves=3; wave_rules=6; start_y_m=-3",
    ),
    (
        "limb neurons, each limb its own",
        [3, 12, 4],
        "controller=limb_neurons; strategy=ga; limb_neurons_shared=false; start_y_m=-3",
    ),
    (
        "networks that grow",
        [3, 20, 4],
        "controller=grown; strategy=neat; neat.add_node=0.3; neat.add_link=0.3; neat.weight_step=1; \
         species_threshold=1; neat.species=4; neat.stagnation=3; start_y_m=-3",
    ),
    (
        "Q-learning",
        [3, 8, 5],
        "controller=decisions; strategy=q_learning; rate_power=0.7; rate_floor=0.1; exploration.first=0.8; \
         exploration.decay=0.9; exploration.least=0.2; start_y_m=-3",
    ),
    (
        "XCS",
        [3, 8, 5],
        "controller=decisions; strategy=xcs; xcs.rules=300; xcs.wildcard_share=0.6; xcs.discount=0.8; \
         xcs.learning_rate=0.1; ga_interval=5; error_threshold=20; start_y_m=-3",
    ),
    (
        "XCS of each joint",
        [3, 8, 5],
        "controller=joint_decisions; strategy=xcs; xcs.rules=300; xcs.wildcard_share=0.6; ga_interval=5; start_y_m=-3",
    ),
    (
        "ZCS",
        [3, 8, 5],
        "controller=decisions; strategy=zcs; zcs.rules=300; zcs.wildcard_share=0.6; zcs.discount=0.8; \
         zcs.learning_rate=0.1; ga_rate=0.5; start_y_m=-3",
    ),
    (
        "bodies, islands",
        [3, 24, 3],
        "controller=gait; strategy=islands; bodies.vary=true; limbs_min=3; limbs_max=4; candidates=6; first_step=0.2; body_share=0.5; \
         trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "bodies in other ranges, genetic algorithm",
        [3, 12, 4],
        "controller=wave; strategy=body_ga; bodies.vary=true; protection=none; tournament_size=2; body_ga.two_parents=0.8; \
         body_ga.mutation_step=0.2; kept_best=1; length_min_m=0.3; length_max_m=3; thickness_min_m=0.3; thickness_max_m=2.5; \
         bend_limit_min_rad=0.5; bend_limit_max_rad=1; twist_limit_min_rad=0.1; twist_limit_max_rad=0.5; \
         strength_min=0.1; volume_m3=8; longest_m=11; torque_budget_nm=6000; trial.fitness=share; start_y_m=-3; \
         trial.duration_s=3",
    ),
    (
        "bodies, MAP-Elites",
        [3, 12, 4],
        "controller=gait; strategy=body_map_elites; bodies.vary=true; length_cells=5; body_map_elites.two_parents=0.7; \
         body_map_elites.mutation_step=0.15; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "bodies, novelty search",
        [3, 12, 4],
        "controller=gait; strategy=body_novelty; bodies.vary=true; novelty.weight=0.7; novelty.neighbours=5; \
         novelty.first=frequency; holding_power_w=100; energy_cost_per_kj=0.01; trial.fitness=share; start_y_m=-3; \
         trial.duration_s=3",
    ),
    (
        "soft blocks of four parts and rigid ones, CMA-ES",
        [3, 8, 3],
        "controller=gait; strategy=cma_es; youngs_modulus_pa=[3000, 1000000, 6000, 20000, 3000]; soft_parts=4; \
         soft_damping_ratio=0.2; agent.density_kg_m3=3; substeps=4; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "soft bodies, genetic algorithm",
        [3, 8, 3],
        "controller=gait; strategy=body_ga; bodies.vary=true; limbs_max=4; bodies.soft=true; modulus_min_pa=500; \
         modulus_max_pa=30000; substeps=4; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "gaits on any other stairs in each generation",
        [3, 8, 3],
        "controller=gait; strategy=cma_es; repeats.trials=4; repeats.list=generation; off.stairs=drawn; trial.fitness=share; \
         start_y_m=-3; trial.duration_s=3",
    ),
    (
        "POET",
        [3, 40, 40],
        "controller=gait; strategy=poet; pairs=3; pair_candidates=4; pair_step=0.2; learn_generations=1; transfers=2; \
         children=4; admitted=2; reproduces_from=0; too_hard_below=0.01; too_easy_above=0.9; solved_from=0.3; perturbed=1; \
         root_rise_m=0.2; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "POET with bodies, stairs without features",
        [3, 30, 20],
        "controller=gait; strategy=body_poet; bodies.vary=true; limbs_max=4; pairs=2; pair_candidates=6; learn_generations=2; \
         transfers=1; features=false; reproduces_from=0; too_hard_below=0; too_easy_above=1.1; trial.fitness=share; \
         start_y_m=-3; trial.duration_s=3",
    ),
    (
        "minimal criterion coevolution",
        [3, 40, 20],
        "controller=gait; strategy=mcc; criterion=0.15; snake_queue=8; snake_children=3; child_step=0.1; stairs_queue=3; \
         stairs_children=2; uses_of_stairs=2; first_snakes=4; start_rise_m=0.15; special_steps=false; trial.fitness=share; \
         start_y_m=-3; trial.duration_s=3",
    ),
    // Many joints of these creatures have asymmetric limits.
    (
        "creatures",
        [3, 12, 4],
        "controller=part_neurons; strategy=creature_ga; bodies.vary=true; creatures.parts_min=3; creatures.parts_max=9; \
         creature_ga.survivors=0.4; creature_ga.mutation_step=0.2; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    (
        "creatures with the neurons of Sims",
        [3, 12, 4],
        "controller=part_neurons; strategy=creature_ga; bodies.vary=true; creatures.neurons=sims; creatures.parts_min=4; \
         network.weight_range=3; volume_m3=8; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
    ("lanes: signals", [1, 20, 3], "engine=lanes"),
    (
        "lanes: gaits, CMA-ES",
        [3, 24, 3],
        "engine=lanes; controller=gait; strategy=cma_es; first_riser_y_m=-1.5",
    ),
    (
        "lanes: bouncing ice, soft joints without damping, seven limbs",
        [1, 20, 2],
        "engine=lanes; surface.friction=0.05; surface.bounce=0.8; joint_damping_nms_per_rad=0; joint_cfm_m_s_per_n=0.0001; \
         agent.limbs=7; first_riser_y_m=-1.5",
    ),
    (
        "lanes: slipping stairs, a soft damping ground, soft skins, limbs of different lengths and densities",
        [1, 20, 2],
        "engine=lanes; surface.slip_m_s_per_n=0.01; surface.bounce=0.4; surface.bounce_velocity_m_s=1; ground.soft_erp=0.5; \
         ground.soft_cfm_m_s_per_n=0.003; ground.dampen_per_s=0.5; skin.soft_cfm_m_s_per_n=0.001; \
         limb_length_m=[1, 2, 2, 2, 1.5]; agent.density_kg_m3=[2, 2, 3, 2, 2]; first_riser_y_m=-1.5",
    ),
    (
        "lanes: slipping stairs with a bounce velocity, a damping ground",
        [3, 12, 2],
        "engine=lanes; surface.slip_m_s_per_n=0.005; surface.bounce=0.6; surface.bounce_velocity_m_s=2; \
         ground.dampen_per_s=0.6; first_riser_y_m=-1.5",
    ),
    (
        "lanes: twelve limbs, one step",
        [3, 12, 2],
        "engine=lanes; agent.limbs=12; stairs.steps=1; first_riser_y_m=-9",
    ),
    (
        "lanes: slopes up and down, a step down, nosings, 120 steps a second",
        [3, 12, 2],
        "engine=lanes; controller=gait; stairs.steps=5; rise_m=[0.5, 0.3, -0.4, -0.4, 0.4]; tread_m=[1.5, 2, 2, 0.8, 2]; \
         slope_m=[0.8, 0, 1.2, 0, 0]; nosing_m=0.2; first_riser_y_m=-3; steps_per_s=120; substeps=4; iterations=2",
    ),
    (
        "lanes: reflexes on three varied trials",
        [3, 12, 2],
        "engine=lanes; controller=reflex; repeats.trials=3; repeats.list=fixed; champion_trials=2; off.tread=0.2; \
         first_riser_y_m=-1.5",
    ),
    (
        "lanes: modular networks, narrow joint limits",
        [3, 12, 2],
        "engine=lanes; controller=modular; bend_limits_rad=[0.2]; twist_limits_rad=[0.1]; first_riser_y_m=-1.5",
    ),
    (
        "lanes: waves chosen by rules",
        [3, 8, 2],
        "engine=lanes; controller=rules; strategy=ga; wave_takeover=0.5; library_waves=3; wave_rules=6; start_y_m=-3",
    ),
    (
        "lanes: evolving bodies",
        [3, 24, 2],
        "engine=lanes; controller=wave; strategy=body_ga; bodies.vary=true; protection=none; tournament_size=2; \
         body_ga.two_parents=0.8; trial.fitness=share; start_y_m=-3; trial.duration_s=3",
    ),
];

/// Presets with the engine `lanes` whose worlds are also computed in rapier.
const ALSO_IN_RAPIER: [&str; 4] = ["climb", "rubber", "mud", "trampoline"];

/// Returns the runs whose bits are compared, with their descriptions: the cases, each kind of fitness, and the shipped presets.
///
/// # Errors
/// An embedded preset or a case is broken, which a test rules out.
pub fn golden_plans() -> Result<Vec<(String, RunPlan)>, VerifyError> {
    let presets = shipped_presets()?;
    let sized = |settings: &mut Settings, population, generations| {
        settings.evolution.population = population;
        settings.evolution.generations = generations;
    };
    let report = load_preset("report")?.settings;
    let mut plans = Vec::new();
    for &(what, [seed, population, generations], changes) in CASES {
        let changes = changes.split("; ").filter(|change| !change.is_empty());
        let changes = changes.map(|change| change.split_once('=').unwrap_or((change, "")));
        let mut settings = with_fields(&report, changes)?;
        sized(&mut settings, population, generations);
        settings.check()?;
        plans.push((what.to_owned(), RunPlan::new("verify", seed.into(), settings)));
    }
    // Each run has another seed. Otherwise presets that differ only in the size of their runs would compute the same bits.
    for (fitness, seed) in Fitness::OPTIONS.iter().copied().zip(100..) {
        let mut settings = report.clone();
        settings.trial.fitness = fitness;
        sized(&mut settings, 6, 2);
        plans.push((format!("fitness {fitness}"), RunPlan::new("verify", seed, settings)));
    }
    // Seeds follow the order of the presets, so a new preset must come last to keep the others' seeds. Presets with controllers
    // that sense their surroundings are left out: their worlds equal the first preset's, their controllers have cases above, and
    // emulated processors would take minutes. The preset of evolving bodies is left out because one of its generations is larger
    // than a case.
    let of_worlds = |preset: &Preset| {
        let genome = &preset.settings.genome;
        !genome.controller.senses_surroundings() && !genome.bodies.vary
    };
    let mut in_rapier = Vec::new();
    for (preset, seed) in presets.into_iter().filter(of_worlds).zip(200..) {
        let mut settings = preset.settings;
        sized(&mut settings, 6, 2);
        if ALSO_IN_RAPIER.contains(&preset.name.as_str()) {
            let mut settings = settings.clone();
            settings.trial.physics.engine = PhysicsEngine::Rapier;
            let what = format!("preset {}, in rapier", preset.name);
            in_rapier.push((what, RunPlan::new("verify", seed, settings)));
        }
        plans.push((format!("preset {}", preset.name), RunPlan::new("verify", seed, settings)));
    }
    plans.append(&mut in_rapier);
    Ok(plans)
}
