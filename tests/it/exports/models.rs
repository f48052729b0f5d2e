//! Bodies as models for MuJoCo, ODE and URDF, and champions that climb in other engines.

use std::f32::consts::TAU;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use snakes_core::Engine;
use snakes_core::evolve::{Champion, Origin, Settings, with_fields};
use snakes_core::genome::Genome;
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::LoadedChampion;
use snakes_core::score::{Trial, evaluate};
use snakes_core::world::{JointTorque, Simulation, WorldPlan};
use snakes_lab::export::{ExportSource, ExportedChampion};

use super::{peer_python, peer_script, succeed};
use crate::program::{folder, snakes};

/// Number of random bodies.
const BODIES: u32 = 100;
/// Number of steps of this engine for each step of control, where limbs are compared in free motion.
const FINER: u32 = 4;
/// Time after which a body rests on the ground, in s.
const SETTLED_S: f32 = 4.0;

/// Draws a number between two bounds, evenly on a logarithmic scale.
pub(super) fn log_between(rng: &mut ChaCha8Rng, [least, most]: [f32; 2]) -> f32 {
    least * libm::powf(most / least, rng.random_range(0.0..=1.0))
}

/// Draws the sizes of the limbs of a snake, in m. The snake is at most 12 m long, and neighbours differ in mass by a factor of at
/// most eight.
fn random_sizes(rng: &mut ChaCha8Rng) -> Vec<[f32; 3]> {
    let limbs = rng.random_range(2..=12);
    let height_m = log_between(rng, [0.4, 2.0]);
    // Half of the snakes have limbs of different heights, which begin in the air.
    let lowest = if rng.random_bool(0.5) { 0.6 } else { 1.0 };
    loop {
        let mut limb = || {
            let (width, length) = (log_between(rng, [0.4, 2.0]), log_between(rng, [0.4, 4.0]));
            [width, length, height_m * rng.random_range(lowest..=1.0)]
        };
        let sizes: Vec<[f32; 3]> = (0..limbs).map(|_| limb()).collect();
        let volume = |[x, y, z]: [f32; 3]| x * y * z;
        let is_even = sizes.windows(2).all(|pair| {
            let ratio = volume(pair[0]) / volume(pair[1]);
            (1.0 / 6.0..=6.0).contains(&ratio)
        });
        if is_even && sizes.iter().map(|[_, y, _]| y).sum::<f32>() <= 12.0 {
            return sizes;
        }
    }
}

/// Draws a body on stairs, as a trial.
pub(super) fn random_trial(rng: &mut ChaCha8Rng) -> Trial {
    let sizes = random_sizes(rng);
    let joints = sizes.len() - 1;
    let list = |values: Vec<f32>| format!("{values:?}");
    let of_limbs = |axis: usize| list(sizes.iter().map(|size| size[axis]).collect());
    // Strength and damping of a joint grow with the cross-section and the height.
    let scales: Vec<f32> = sizes
        .windows(2)
        .map(|pair| {
            let least = |of: fn([f32; 3]) -> f32| of(pair[0]).min(of(pair[1]));
            least(|[x, _, z]| x * z) * least(|[_, _, z]| z)
        })
        .collect();
    let mut drawn = |count: usize, [least, most]: [f32; 2]| -> Vec<f32> {
        (0..count).map(|_| rng.random_range(least..=most)).collect()
    };
    let strengths = drawn(joints, [0.25, 1.0]);
    let scaled = |most: f32| {
        list(scales.iter().zip(&strengths).map(|(scale, share)| most * scale * share).collect())
    };
    let bend_limits_rad = drawn(joints, [0.2, 1.8]);
    // A sixth of the joints cannot twist, as in many champions.
    let twist_limits_rad = drawn(joints, [-0.3, 1.5]);
    let twist_limits_rad: Vec<f32> =
        twist_limits_rad.into_iter().map(|limit_rad| limit_rad.max(0.0)).collect();
    let number = |values: Vec<f32>| values[0].to_string();
    let fields = [
        ("agent.limbs", sizes.len().to_string()),
        ("limb_width_m", of_limbs(0)),
        ("limb_length_m", of_limbs(1)),
        ("limb_height_m", of_limbs(2)),
        ("agent.density_kg_m3", list(drawn(sizes.len(), [2.0, 3.0]))),
        ("agent.bend_limit_rad", list(bend_limits_rad)),
        ("agent.twist_limit_rad", list(twist_limits_rad)),
        ("max_bend_torque_nm", scaled(1000.0)),
        ("max_twist_torque_nm", scaled(700.0)),
        ("joint_damping_nms_per_rad", list(scales.iter().map(|scale| 30.0 * scale).collect())),
        ("angular_damping_per_s", "0".to_owned()),
        ("skin.friction", number(drawn(1, [0.5, 2.0]))),
        ("surface.friction", number(drawn(1, [0.3, 2.0]))),
        ("ground.friction", number(drawn(1, [0.3, 2.0]))),
        ("stairs.steps", "7".to_owned()),
        ("stairs.rise_m", list(drawn(7, [0.2, 0.8]))),
        ("stairs.tread_m", number(drawn(1, [1.0, 3.0]))),
        ("trial.start_y_m", number(drawn(1, [-9.0, -5.0]))),
        ("trial.duration_s", "0.1".to_owned()),
        ("steps_per_s", "60".to_owned()),
        ("substeps", "4".to_owned()),
        // For the accuracy of MuJoCo's joints, chains of twelve limbs need more than four iterations.
        ("iterations", "16".to_owned()),
    ];
    let fields = fields.iter().map(|(name, value)| (*name, value.as_str()));
    with_fields(&Settings::default(), fields).expect("allowed").trial
}

/// Moves all limbs of a world upwards.
fn raise(world: &mut Simulation, height_m: f32) {
    world.change_parts(|(_, part)| part.at.z += height_m);
}

/// Takes `count` steps, each with its torques, and reads the world after each.
fn steps<T>(
    world: &mut Simulation,
    count: u32,
    torques: impl Fn(u32) -> Vec<JointTorque>,
    read: impl Fn(&Simulation) -> T,
) -> Vec<T> {
    let mut step = |number| {
        world.step(&torques(number)).expect("healthy");
        read(world)
    };
    (0..count).map(&mut step).collect()
}

fn no_torques(plan: &WorldPlan) -> Vec<JointTorque> {
    vec![JointTorque::default(); plan.body.joints.len()]
}

/// Returns the centre of mass, in m.
fn centre_m(world: &Simulation) -> [f64; 3] {
    let limbs = || world.body().parts.iter().map(|limb| f64::from(limb.mass_kg()));
    let mut sum = [0.0; 3];
    for (pose, kg) in world.poses().zip(limbs()) {
        for (sum, at_m) in sum.iter_mut().zip(pose.translation.to_array()) {
            *sum += kg * f64::from(at_m);
        }
    }
    sum.map(|sum| sum / limbs().sum::<f64>())
}

/// Returns the bend of a limb that hangs on a clamped one, in each step of 1.3 s.
fn pendulum_rad(plan: &WorldPlan) -> Vec<f32> {
    let mut world = Simulation::new(plan);
    raise(&mut world, 20.0);
    world.change_parts(|(index, part)| part.is_held = index == 0);
    let bend = |world: &Simulation| world.joint_states().next().expect("a joint").bend_rad;
    steps(&mut world, 78, |_| no_torques(plan), bend)
}

/// Returns the torques about the bend axes in each step of two seconds: a sine for each joint, weak enough for its limit.
fn sines_nm(plan: &WorldPlan, rng: &mut ChaCha8Rng) -> Vec<Vec<f32>> {
    let sines: Vec<[f32; 3]> = plan
        .body
        .joints
        .iter()
        .map(|joint| {
            let (hz, phase) = (rng.random_range(0.5..1.5), rng.random_range(0.0..TAU));
            // At this strength the damping alone keeps the bend within an eighth of its limit.
            let held_nm = joint.damping_nms_per_rad * joint.bend_limit_rad * TAU * hz / 8.0;
            let strongest_nm = 40.0 / 30.0 * joint.damping_nms_per_rad;
            [held_nm.min(strongest_nm).min(joint.max_bend_torque_nm), hz, phase]
        })
        .collect();
    let at = |step: u32| {
        let time_s = step as f32 / 60.0;
        let torque = |[nm, hz, phase]: &[f32; 3]| nm * libm::sinf(TAU * hz * time_s + phase);
        sines.iter().map(torque).collect()
    };
    (0..120).map(at).collect()
}

/// Returns the expected model of a world, and the motion of its body in this engine.
pub(super) fn description(plan: &WorldPlan, pendulum: &WorldPlan, rng: &mut ChaCha8Rng) -> Value {
    let start = Simulation::new(plan);
    let parts = plan.body.parts.iter();
    let masses = parts.map(|part| (part.mass_kg(), part.inertia_kg_m2().to_array()));
    let limbs = plan.body.parts.iter().zip(masses).zip(start.poses());
    let limbs = limbs.map(|((limb, (kg, kg_m2)), pose)| {
        let at_m = pose.translation.to_array();
        json!({"size_m": limb.size_m(), "kg": kg, "kg_m2": kg_m2, "at_m": at_m})
    });
    let joints = plan.body.joints.iter().map(|joint| {
        json!({
            "bend_limit_rad": joint.bend_limit_rad,
            "twist_limit_rad": joint.twist_limit_rad,
            "bend_nm": joint.max_bend_torque_nm,
            "twist_nm": joint.max_twist_torque_nm,
            "damping": joint.damping_nms_per_rad,
        })
    });
    let boxes = plan.stairs.boxes();
    let boxes = boxes.iter().map(|stair| [stair.min_m, stair.max_m].concat());

    let mut falling = Simulation::new(plan);
    raise(&mut falling, 10.0);
    let [_, _, from_m] = centre_m(&falling);
    let heights = steps(&mut falling, 60, |_| no_torques(plan), |world| centre_m(world)[2]);

    let mut weightless = plan.clone();
    weightless.physics.gravity_m_s2 = 0.0;
    // For light limbs with strong damping, this engine's own error at 60 Hz would be as large as the bound.
    weightless.physics.steps_per_s = 60 * FINER;
    let mut free = Simulation::new(&weightless);
    raise(&mut free, 20.0);
    let sines_nm = sines_nm(plan, rng);
    let torques = |step: u32| {
        let bends = sines_nm[(step / FINER) as usize].iter();
        bends.map(|&bend_nm| JointTorque { bend_nm, twist_nm: 0.0 }).collect()
    };
    let bends = |world: &Simulation| -> Vec<f32> {
        world.joint_states().map(|joint| joint.bend_rad).collect()
    };
    let all_bends_rad = steps(&mut free, 120 * FINER, torques, bends);
    let bends_rad: Vec<_> = all_bends_rad.chunks(FINER as usize).filter_map(<[_]>::last).collect();

    let mut settling = Simulation::new(plan);
    let settled = (SETTLED_S * 60.0) as u32;
    steps(&mut settling, settled, |_| no_torques(plan), |_| ());
    let settled_z_m: Vec<f32> = settling.poses().map(|pose| pose.translation.z).collect();
    json!({
        "substeps": plan.physics.substeps,
        "limbs": limbs.collect::<Vec<_>>(),
        "joints": joints.collect::<Vec<_>>(),
        "steps": boxes.collect::<Vec<_>>(),
        "centre_m": centre_m(&start),
        "skin_friction": plan.skin.friction,
        "ground_friction": plan.ground.friction * plan.skin.friction,
        "fallen_m": heights.last().expect("steps") - from_m,
        "pendulum_rad": pendulum_rad(pendulum),
        "bend_torques_nm": sines_nm,
        "bends_rad": bends_rad,
        "settled_s": SETTLED_S,
        "settled_z_m": settled_z_m,
    })
}

/// Exports a champion to a file whose ending decides the format.
pub(super) fn export(name: &str, champion: &Champion, path: &Path) {
    let loaded = LoadedChampion {
        champion: champion.clone(),
        engine: Engine::THIS,
        recording: None,
        exam: Vec::new(),
    };
    let exported =
        ExportedChampion { name: name.to_owned(), file: path.to_owned(), loaded, note: None };
    super::export(ExportSource { champions: vec![exported], run: None }, path);
}

/// Makes a champion of a random snake.
pub(super) fn champion(trial: Trial, rng: &mut ChaCha8Rng) -> Champion {
    let genome = Settings::default().genome.random_genome(trial.genome_shape(), rng);
    champion_of(genome, trial)
}

/// Makes a champion of a genome, by evaluating it.
pub(super) fn champion_of(genome: Genome, trial: Trial) -> Champion {
    let evaluation = evaluate(&genome, &trial);
    let origin = Origin { preset: "test".to_owned(), seed: 1, generation: 1, individual: 0 };
    Champion { genome, trial, evaluation, chosen_by: None, origin }
}

/// Returns a trial with the front two limbs of a snake, without damping, for a pendulum.
fn pendulum_trial(trial: &Trial) -> Trial {
    let agent = &trial.agent;
    let first = |of: &dyn Fn(usize) -> f32| format!("[{}, {}]", of(0), of(1));
    let density = |limb| agent.density_kg_m3.as_ref().map_or(2.5, |density| density.at(limb));
    let bend = |joint| agent.bend_limit_rad.as_ref().map_or(1.0, |limit| limit.at(joint));
    let fields = [
        ("agent.limbs", "2".to_owned()),
        ("limb_width_m", first(&|limb| agent.limb_width_m.at(limb))),
        ("limb_length_m", first(&|limb| agent.limb_length_m.at(limb))),
        ("limb_height_m", first(&|limb| agent.limb_height_m.at(limb))),
        ("agent.density_kg_m3", first(&density)),
        ("agent.bend_limit_rad", bend(0).to_string()),
        ("agent.twist_limit_rad", "0.5".to_owned()),
        ("joint_damping_nms_per_rad", "0".to_owned()),
        ("max_bend_torque_nm", "1000".to_owned()),
        ("max_twist_torque_nm", "1000".to_owned()),
        ("angular_damping_per_s", "0".to_owned()),
        ("stairs.steps", "0".to_owned()),
        ("stairs.rise_m", "0.5".to_owned()),
        ("steps_per_s", "60".to_owned()),
        ("substeps", "4".to_owned()),
        ("trial.duration_s", "0.1".to_owned()),
    ];
    let fields = fields.iter().map(|(name, value)| (*name, value.as_str()));
    with_fields(&Settings::default(), fields).expect("allowed").trial
}

/// Writes a hundred random bodies with their descriptions, and lets MuJoCo compare all of them, and ODE every fourth. `write` exports a
/// body to files, whose path it gets for each ending, and returns the description. Returns the output of both, or an empty text if one
/// of them is missing.
pub(super) fn compare_in_other_engines(
    test: &str,
    seed: u64,
    write: impl Fn(&str, &dyn Fn(&str) -> PathBuf, &mut ChaCha8Rng) -> Value,
) -> String {
    let Some(python) = peer_python("mujoco, numpy, panda3d.ode", test) else {
        return String::new();
    };
    let folder = folder();
    for body in 0..BODIES {
        let mut rng = stream(seed, 1, body, Purpose::Birth);
        let name = format!("body {body}");
        let path = |ending: &str| folder.path().join(format!("{name}{ending}"));
        let expected = write(&name, &path, &mut rng);
        fs::write(path(".json"), expected.to_string()).expect("written");
    }
    let compare = |(script, bodies)| {
        let mut python = Command::new(python.get_program());
        python.current_dir(folder.path()).arg(peer_script(script)).arg(folder.path());
        let said = succeed(&mut python);
        assert!(said.contains(&format!("{bodies} bodies")), "{said}");
        said
    };
    [("models.py", BODIES), ("ode_models.py", BODIES / 4)].map(compare).concat()
}

#[test]
fn a_hundred_random_bodies_move_in_other_engines_as_here() {
    let test = "a_hundred_random_bodies_move_in_other_engines_as_here";
    let said = compare_in_other_engines(test, 1, |name, path, rng| {
        let champion = champion(random_trial(rng), rng);
        let pendulum = self::champion(pendulum_trial(&champion.trial), rng);
        let plan = |champion: &Champion| champion.trial.world_plan(&champion.genome);
        export(name, &champion, &path(".xml"));
        export(name, &champion, &path(".urdf"));
        export(name, &pendulum, &path("-pendulum.xml"));
        description(&plan(&champion), &plan(&pendulum), rng)
    });
    println!("{said}");
}

#[test]
fn champions_with_and_without_senses_climb_in_other_engines() {
    let test = "champions_with_and_without_senses_climb_in_other_engines";
    let Some(python) = peer_python("mujoco, numpy, panda3d.ode", test) else { return };
    let folder = folder();
    let saves = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    let mut exam = snakes(folder.path(), "exam --json --suite mujoco --suite ode");
    exam.env("SNAKES_PEER_PYTHON", python.get_program());
    let said = succeed(exam.args(["rigid.ron", "feeler.ron"].map(|name| saves.join(name))));
    let lines: Vec<Value> =
        said.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(lines.len(), 5, "{said}");
    for (line, suite) in lines.iter().zip(["mujoco", "ode"].into_iter().cycle()).take(4) {
        assert_eq!((&line["suite"], &line["trials"]), (&json!(suite), &json!(20)), "{line}");
        // There is no exact threshold, but a snake with wrong torques or senses would not get onto the stairs: its share of the way
        // would be about 0. In ODE `feeler` falls off the side before its third step.
        assert!(line["there"]["way"].as_f64() > Some(0.2), "{line}");
    }
}

#[test]
fn a_study_has_its_champions_judged_in_other_engines_and_continues_with_what_is_missing() {
    let test = "a_study_has_its_champions_judged";
    let Some(python) = peer_python("mujoco, panda3d.ode", test) else { return };
    let folder = folder();
    let study = "(name: \"tiny\", title: \"Tiny\", preset: \"climb\", seeds: 1, evaluations: 12, judges: [\"mujoco\", \"ode\"], \
                 settings: {\"trial.duration_s\": 2, \"cma_es.newborns\": 0, \"evolution.population\": 6}, \
                 arms: [(name: \"a\", title: \"A\")], show: [\"exam_mujoco_kept\", \"exam_ode_kept\", \"simulations\"])";
    fs::write(folder.path().join("tiny.ron"), study).expect("written");
    let perform = |python: &OsStr| {
        let mut command = snakes(folder.path(), "study tiny.ron --json --out out");
        command.env(super::PYTHON_VARIABLE, python).output().expect("it starts")
    };
    let refused = perform(OsStr::new("no-such-python"));
    let said = String::from_utf8_lossy(&refused.stderr).trim_end().to_owned();
    assert!(said.starts_with("error: MuJoCo needs Python with its package: "), "{said}");
    let value = |name: &str| -> f64 {
        let output = perform(python.get_program());
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let lines = text.lines().map(|line| serde_json::from_str(line).expect("JSON"));
        let run = lines.into_iter().find(|line: &Value| line["type"] == "run").expect("a run");
        run[name].as_f64().unwrap_or_else(|| panic!("{name} in {run}"))
    };
    let first =
        ["exam_mujoco_trials", "exam_ode_trials", "exam_ode_kept", "simulations"].map(value);
    assert_eq!(first[..2], [20.0, 20.0]);
    assert!(first[2] > 0.0, "{first:?}");
    // A second command makes nothing again, so that its simulations are those of the first.
    assert_eq!(value("simulations"), first[3]);
}

#[test]
fn without_python_a_judge_says_so_in_one_line_and_the_default_exam_does_not_need_it() {
    let folder = folder();
    let champion = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves/first-climber.ron");
    let run = |arguments: &str| {
        let mut exam = snakes(folder.path(), arguments);
        exam.env("SNAKES_PEER_PYTHON", "no-such-python").arg(&champion);
        exam.output().expect("the program starts")
    };
    for (judge, package) in [("mujoco", "\"mujoco>=3,<5\""), ("ode", "\"panda3d>=1.10,<2\"")] {
        let output = run(&format!("exam --suite {judge}"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        for word in ["no-such-python", &format!("pip install {package}"), "SNAKES_PEER_PYTHON"] {
            assert!(said.contains(word), "{said}");
        }
        let output = run(&format!("exam --suite {judge} --write"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("--write is set; allowed: "), "{said}");
    }
    assert!(run("exam --suite step-rate").status.success());
}
