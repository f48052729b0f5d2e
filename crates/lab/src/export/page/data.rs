//! The data of a page: recorded motion and facts of each champion.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use crate::export::motion::follow;
use crate::export::source::{ExportSource, ExportedChampion};
use crate::export::{ExportError, ExportProgress};
use snakes_core::ENGINE_VERSION;
use snakes_core::save::champion_text;
use snakes_core::schema::{Choices, PerPart};
use snakes_core::score::{Fitness, Rollout, arrived_y_m};
use snakes_core::world::{StairSolid, Stairs};

/// Everything that the page's script reads.
#[derive(Debug, Serialize)]
pub struct PageData {
    /// The page's heading.
    pub title: String,
    /// The line below it.
    pub lead: String,
    /// The version of the engine.
    engine: u32,
    /// Whether the champions are those of a run's generations, which are shown one at a time.
    is_run: bool,
    /// The champions.
    pub champions: Vec<PageChampion>,
}

/// A solid of the stairs: its middle and its size across, along and upwards, in metres, and its turn as x, y, z, w.
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
    /// Its name.
    pub name: String,
    /// Labels and texts about it.
    pub facts: Vec<(&'static str, String)>,
    /// Where it ended, such as "stands on the landing".
    meaning: String,
    hash: String,
    friction: f32,
    /// Width of its stairs, in metres.
    width_m: f32,
    step_count: u32,
    /// The solids of its stairs.
    stairs: Vec<PageSolid>,
    /// The edges of its steps: y and z, in metres, and 1, or -1 for one that leads down.
    edges: Vec<[f32; 3]>,
    /// The outline of its stairs from the side, for the drawing: y and z, in metres.
    #[serde(skip)]
    pub outline: Vec<[f32; 2]>,
    /// The size of each part across, along and upwards, in metres; the head first.
    pub parts: Vec<[f32; 3]>,
    /// The index of the limb of each part; the head is 0.
    pub limbs: Vec<usize>,
    /// Length of a physics step, in s.
    step_s: f32,
    /// Time from one frame to the next, in s.
    frame_s: f32,
    frames: usize,
    /// Metres per unit of the positions.
    unit_m: f32,
    /// Frame by frame and part by part, seven numbers of 16 bits: position, and rotation times 32,767.
    poses: String,
    /// Frame by frame and joint by joint, bend and twist, in shares of `torque_unit_nm` times 32,767.
    torques: String,
    torque_unit_nm: f32,
    /// Steps of the stairs below the middle limb, frame by frame.
    steps: Vec<u32>,
    /// Energy that the joints have spent, frame by frame, in J.
    energy: Vec<u32>,
    /// The text of its file.
    file: String,
    /// The recorded poses, for the drawing.
    #[serde(skip)]
    pub drawn: Vec<Vec<[f32; 7]>>,
}

/// Frames in a second, as far as there are fewer than [`MOST_FRAMES`]; half of them for each champion of a run.
const FRAMES_PER_S: u32 = 30;
/// Maximum number of frames.
const MOST_FRAMES: u32 = 6000;
/// The greatest number of 16 bits.
const MOST: f32 = 32_767.0;

impl PageData {
    /// Records all champions.
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

/// The motion of a champion, frame by frame.
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

/// Numbers as text: 16 bits each, the lower byte first.
fn packed(numbers: impl Iterator<Item = f32>) -> String {
    let bytes: Vec<u8> = numbers.flat_map(|number| (number.round() as i16).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

/// The edge of a step, and where its tread lies: behind it, or before it if it leads down.
fn edge(stairs: &Stairs, step: u32) -> [f32; 3] {
    let [y_m, z_m] = stairs.edge_m(step);
    [y_m, z_m, stairs.step_rise_m(step).signum()]
}

/// The number of steps, and their depth.
fn stairs_in_words(stairs: &Stairs) -> String {
    let depth = match &stairs.tread_m {
        PerPart::All(tread_m) => format!("each {tread_m} m deep"),
        PerPart::Each(_) => format!("{:.2} m deep on average", stairs.mean_tread_m()),
    };
    format!("{} steps, {depth}", stairs.steps)
}

/// Facts about a champion: result, body, world and origin.
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
                "{} limbs, {:.1} m long, {:.1} kg",
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
        facts.push(("Energy", format!("{:.2} kJ", effort.energy_j / 1000.0)));
    }
    facts.push(("Engine", exported.loaded.engine.to_string()));
    facts.push(("Trace hash", format!("{:016x}", champion.evaluation.trace_hash)));
    let file = exported.file.file_name().unwrap_or_default().to_string_lossy();
    facts.push(("Replay", format!("snakes replay {file}")));
    facts
}
