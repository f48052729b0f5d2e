//! The data of a page: recorded motion of each champion, and facts about it.

use serde::Serialize;

use super::base85;
use crate::export::motion::follow;
use crate::export::source::{ExportSource, ExportedChampion};
use crate::export::{ExportError, ExportProgress};
use snakes_core::ENGINE_VERSION;
use snakes_core::save::champion_text;
use snakes_core::schema::{Choices, PerPart};
use snakes_core::score::{Fitness, Rollout, arrived_y_m};
use snakes_core::world::{StairSolid, Stairs};

/// All data that the page's script reads.
#[derive(Debug, Serialize)]
pub struct PageData {
    /// Heading of the page.
    pub title: String,
    /// Line below the heading.
    pub lead: String,
    /// Version of the engine.
    engine: u32,
    /// Whether the champions belong to the generations of a run, and are shown one at a time.
    is_run: bool,
    /// Champions of the page.
    pub champions: Vec<PageChampion>,
}

/// A solid of the stairs: its centre and its size (across, along, up) in metres, and its rotation as a quaternion x, y, z, w.
#[derive(Debug, Serialize)]
struct PageSolid {
    at: [f32; 3],
    size: [f32; 3],
    turn: [f32; 4],
}

impl PageSolid {
    fn of(solid: StairSolid) -> Self {
        let StairSolid { pose, half_m, .. } = solid;
        let size = (half_m * 2.0).to_array();
        Self { at: pose.translation.to_array(), size, turn: pose.rotation.to_array() }
    }
}

/// A champion with its recorded motion.
#[derive(Debug, Serialize)]
pub struct PageChampion {
    /// Name of the champion.
    pub name: String,
    /// Facts about the champion: labels and texts.
    pub facts: Vec<(&'static str, String)>,
    /// Where the champion ended, such as "stands on the landing".
    meaning: String,
    hash: String,
    friction: f32,
    /// Width of the stairs, in metres.
    width_m: f32,
    step_count: u32,
    /// Solids of the stairs.
    stairs: Vec<PageSolid>,
    /// Edges of the steps: y and z in metres, and 1 for a step up or -1 for a step down.
    edges: Vec<[f32; 3]>,
    /// Outline of the stairs from the side, for the drawing: y and z in metres.
    #[serde(skip)]
    pub outline: Vec<[f32; 2]>,
    /// Size of each part across, along and upwards, in metres; the head first.
    pub parts: Vec<[f32; 3]>,
    /// Index of the limb to which each part belongs; the head is 0.
    pub limbs: Vec<usize>,
    /// Length of a physics step, in s.
    step_s: f32,
    /// Time from one frame to the next, in s.
    frame_s: f32,
    frames: usize,
    /// Length of one unit of the positions in `poses`, in metres.
    unit_m: f32,
    /// Poses in [`base85`], frame by frame and part by part: seven numbers of 16 bits each, the position and the rotation times 32,767.
    poses: String,
    /// Torques in [`base85`], frame by frame and joint by joint: bend and twist as shares of `torque_unit_nm` times 32,767.
    torques: String,
    torque_unit_nm: f32,
    /// Number of steps of the stairs below the middle limb, frame by frame.
    steps: Vec<u32>,
    /// Energy that the joints have spent so far, frame by frame, in J.
    energy: Vec<u32>,
    /// Text of the champion's file.
    file: String,
    /// Recorded poses of the parts, frame by frame, for the drawing.
    #[serde(skip)]
    pub drawn: Vec<Vec<[f32; 7]>>,
}

/// Frames per second, unless there would be more than [`MOST_FRAMES`]; half as many for each champion of a run.
const FRAMES_PER_S: u32 = 30;
/// Maximum number of frames of a champion.
const MOST_FRAMES: u32 = 6000;
/// Greatest signed number of 16 bits.
const MOST: f32 = 32_767.0;

impl PageData {
    /// Simulates and records all champions.
    pub fn recorded(source: &ExportSource, progress: &ExportProgress) -> Result<Self, ExportError> {
        let champions = &source.champions;
        let is_run = source.run.is_some();
        let each = champions.iter().enumerate();
        let record = |(index, champion)| {
            PageChampion::recorded(champion, is_run, &progress.part(index, champions.len()))
        };
        let recorded = each.map(record).collect::<Result<Vec<_>, _>>()?;
        let (title, lead) = match (&source.run, &recorded[..]) {
            (Some(run), _) => {
                let settings = &run.plan.settings;
                let strategy = settings.evolution.strategy.choice().title;
                (
                    format!("{}, seed {}", run.plan.preset, run.plan.seed),
                    format!("A run of {} generations: {strategy}.", run.records.len()),
                )
            }
            (None, [only]) => (only.name.clone(), format!("It {}.", only.meaning)),
            (None, all) => (
                format!("A race of {}", all.len()),
                all.iter().map(|one| one.name.as_str()).collect::<Vec<_>>().join(", "),
            ),
        };
        Ok(Self { title, lead, engine: ENGINE_VERSION, is_run, champions: recorded })
    }
}

/// Motion of a champion, frame by frame.
#[derive(Default)]
struct Frames {
    poses: Vec<Vec<[f32; 7]>>,
    torques_nm: Vec<f32>,
    steps: Vec<u32>,
    energy: Vec<u32>,
}

impl Frames {
    fn take(&mut self, rollout: &Rollout) {
        let of_limb = |pose: &snakes_core::world::Pose| {
            let (at, turn) = (pose.translation, pose.rotation);
            [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]
        };
        self.poses.push(rollout.poses().iter().map(of_limb).collect());
        let torques = rollout.simulation().applied_torques();
        self.torques_nm.extend(torques.flat_map(|torque| [torque.bend_nm, torque.twist_nm]));
        self.steps.push(rollout.stairs().steps_under(rollout.middle_m().to_array()));
        self.energy.push(rollout.evaluation().effort.map_or(0.0, |effort| effort.energy_j) as u32);
    }
}

impl PageChampion {
    fn recorded(
        exported: &ExportedChampion,
        is_of_run: bool,
        progress: &ExportProgress,
    ) -> Result<Self, ExportError> {
        let champion = &exported.loaded.champion;
        let trial = &champion.trial;
        let frames_per_s = if is_of_run { FRAMES_PER_S / 2 } else { FRAMES_PER_S };
        let every = (trial.physics.steps_per_s / frames_per_s).max(1);
        let every = every.max(trial.steps().div_ceil(MOST_FRAMES));
        let mut frames = Frames::default();
        follow(champion, progress, |rollout| {
            if rollout.step().is_multiple_of(every) {
                frames.take(rollout);
            }
            Ok(())
        })?;
        let stairs = &trial.stairs;
        let positions = frames.poses.iter().flatten().flat_map(|pose| &pose[..3]);
        let unit_m = positions.fold(1.0_f32, |most, part| most.max(part.abs())) / MOST;
        let most_nm = frames.torques_nm.iter().fold(1.0_f32, |most, part| most.max(part.abs()));
        let of_pose = |pose: &[f32; 7]| {
            let [x, y, z, turn @ ..] = *pose;
            let place = [x, y, z].map(|part| part / unit_m);
            place.into_iter().chain(turn.map(|part| part * MOST)).collect::<Vec<f32>>()
        };
        let torques = frames.torques_nm.iter().map(|torque| torque / most_nm * MOST);
        let loaded = &exported.loaded;
        Ok(Self {
            name: exported.name.clone(),
            facts: facts(exported),
            meaning: trial.result_in_words(&champion.genome, &champion.evaluation),
            hash: format!("{:016x}", champion.evaluation.trace_hash),
            friction: trial.surface.friction,
            width_m: stairs.width_m,
            step_count: stairs.steps,
            stairs: stairs.solids().into_iter().map(PageSolid::of).collect(),
            edges: (0..stairs.steps).map(|step| edge(stairs, step)).collect(),
            outline: stairs.outline_m(),
            parts: champion.body().parts.iter().map(|part| part.size_m()).collect(),
            limbs: champion.body().parts.iter().map(|part| part.limb).collect(),
            step_s: trial.physics.step_s(),
            frame_s: trial.physics.step_s() * every as f32,
            frames: frames.poses.len(),
            unit_m,
            poses: packed(frames.poses.iter().flatten().flat_map(of_pose)),
            torques: packed(torques),
            torque_unit_nm: most_nm,
            steps: frames.steps,
            energy: frames.energy,
            file: exported.note.iter().map(|note| format!("// {note}\n")).collect::<String>()
                + &champion_text(
                    champion,
                    loaded.recording.as_ref().filter(|_| !is_of_run),
                    &loaded.exam,
                )?,
            drawn: frames.poses,
        })
    }
}

/// Packs numbers as [`base85`]: 16 bits each, the lower byte first.
fn packed(numbers: impl Iterator<Item = f32>) -> String {
    let bytes: Vec<u8> = numbers.flat_map(|number| (number.round() as i16).to_le_bytes()).collect();
    base85::encoded(&bytes)
}

/// Returns y and z of the edge of a step, in metres, and 1 if the step leads up or -1 if it leads down.
fn edge(stairs: &Stairs, step: u32) -> [f32; 3] {
    let [y_m, z_m] = stairs.edge_m(step);
    [y_m, z_m, stairs.step_rise_m(step).signum()]
}

/// Describes the number of steps and their depth in words.
fn stairs_in_words(stairs: &Stairs) -> String {
    let depth = match &stairs.tread_m {
        PerPart::All(tread_m) => format!("each {tread_m} m deep"),
        PerPart::Each(_) => format!("{:.2} m deep on average", stairs.mean_tread_m()),
    };
    format!("{} steps, {depth}", stairs.steps)
}

/// Returns facts about a champion: result, body, world and origin.
fn facts(exported: &ExportedChampion) -> Vec<(&'static str, String)> {
    let champion = &exported.loaded.champion;
    let (origin, trial) = (&champion.origin, &champion.trial);
    let body = champion.body();
    let stairs = &trial.stairs;
    let effort = champion.evaluation.effort;
    let mut measure = trial.fitness.words().to_owned();
    if trial.fitness == Fitness::Climb {
        measure += &format!("; at most {:.2} m", arrived_y_m(stairs, &body));
    }
    let mut facts = Vec::new();
    facts.extend(exported.note.clone().map(|note| ("Note", note)));
    facts.extend([
        ("Result", champion.reached()),
        ("Fitness", measure),
        ("Controller", champion.genome.controller.kind().choice().title.to_owned()),
        (
            "Body",
            format!(
                "{} blocks, {:.1} m long, {:.1} kg",
                body.limbs(),
                body.length_m(),
                body.mass_kg()
            ),
        ),
        ("Stairs", stairs_in_words(stairs)),
        (
            "Trial",
            format!(
                "{} s, {} physics steps per second",
                trial.duration_s, trial.physics.steps_per_s
            ),
        ),
        (
            "Run",
            format!(
                "preset {}, seed {}, generation {}, snake {}",
                origin.preset,
                origin.seed,
                origin.generation,
                origin.individual + 1
            ),
        ),
    ]);
    if let Some(effort) = effort {
        facts.push(("Energy", format!("{:.1} kJ", effort.energy_j / 1000.0)));
    }
    facts.push(("Engine", exported.loaded.engine.to_string()));
    facts.push(("Trace hash", format!("{:016x}", champion.evaluation.trace_hash)));
    let file = exported.file.file_name().unwrap_or_default().to_string_lossy();
    facts.push(("Replay", format!("snakes replay {file}")));
    facts
}
