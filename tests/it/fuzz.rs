//! A bounded fuzz run over the parsers of files. The targets in `fuzz/` run without a bound. Both start from the files in
//! `fuzz/corpus`.

use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::FileFailurePersistence;
use snakes_core::evolve::{RunPlan, Settings, StrategyKind, resume, with_field};
use snakes_core::genome::{
    BodyChange, ControllerKind, CreatureChange, GenomeSpace, MOST_PARTS, MOST_SEGMENTS,
};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{
    fingerprint, parse_champion, parse_changes, parse_checkpoint, parse_evaluations, parse_lineage,
    parse_plan, parse_preset, parse_records, parse_stairs,
};
use snakes_core::score::Fitness;
use xxhash_rust::xxh3::xxh3_64;

/// A change to a file's bytes.
#[derive(Debug, Clone)]
enum Edit {
    CutOff(Index),
    Remove(Index, usize),
    Flip(Index, u8),
    Insert(Index, Vec<u8>),
    /// Repeats a piece of the file at another place.
    Repeat(Index, usize, Index),
}

/// Tokens that are likely to reach unusual paths of a parser, with a space between them.
const TOKENS: &str = "( ) [ ] { } , : \" ' \\ /* */ // r#\" Some( None NaN -inf 1e999 99999999999999999999 -1 \0 \u{feff}";

fn edit() -> impl Strategy<Value = Edit> {
    let tokens: Vec<&str> = TOKENS.split(' ').collect();
    let token = select(tokens).prop_map(|token| token.as_bytes().to_vec());
    prop_oneof![
        1 => any::<Index>().prop_map(Edit::CutOff),
        3 => (any::<Index>(), 1..40_usize).prop_map(|(at, length)| Edit::Remove(at, length)),
        3 => (any::<Index>(), 0..8_u8).prop_map(|(at, bit)| Edit::Flip(at, bit)),
        3 => (any::<Index>(), token).prop_map(|(at, token)| Edit::Insert(at, token)),
        1 => (any::<Index>(), prop::collection::vec(any::<u8>(), 1..9))
            .prop_map(|(at, bytes)| Edit::Insert(at, bytes)),
        2 => (any::<Index>(), 1..400_usize, any::<Index>())
            .prop_map(|(from, length, to)| Edit::Repeat(from, length, to)),
    ]
}

fn edited(mut bytes: Vec<u8>, edits: &[Edit]) -> Vec<u8> {
    for edit in edits {
        let place = |index: &Index| index.index(bytes.len() + 1);
        match edit {
            Edit::CutOff(at) => bytes.truncate(place(at)),
            Edit::Remove(at, length) => {
                let at = place(at);
                bytes.drain(at..(at + length).min(bytes.len()));
            }
            Edit::Flip(at, bit) => {
                let at = place(at);
                bytes.get_mut(at).into_iter().for_each(|byte| *byte ^= 1 << bit);
            }
            Edit::Insert(at, inserted) => {
                let at = place(at);
                bytes.splice(at..at, inserted.iter().copied());
            }
            Edit::Repeat(from, length, to) => {
                let (from, to) = (place(from), place(to));
                let piece = bytes[from..(from + length).min(bytes.len())].to_vec();
                bytes.splice(to..to, piece);
            }
        }
    }
    bytes
}

/// Returns the files from which fuzzing starts, sorted.
fn corpus(target: &str) -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("a corpus").map(|file| file.expect("a file").path()).collect();
    files.sort();
    files
}

/// Returns a strategy that edits files of the corpus.
fn inputs(target: &str) -> impl Strategy<Value = Vec<u8>> + use<> {
    let files: Vec<Vec<u8>> =
        corpus(target).iter().map(|file| fs::read(file).expect("read")).collect();
    (select(files), prop::collection::vec(edit(), 1..6))
        .prop_map(|(file, edits)| edited(file, &edits))
}

fn rules(cases: u32) -> ProptestConfig {
    // Failures are not stored automatically: each becomes a named test.
    let failure_persistence = Some(Box::new(FileFailurePersistence::Off) as Box<_>);
    ProptestConfig { cases, failure_persistence, ..ProptestConfig::default() }
}

/// Parses every file of the corpus, which must succeed, and then edited files.
fn read_corpus<T, E: ToString>(target: &str, parse: impl Fn(&Path, &str) -> Result<T, E>) {
    for file in corpus(target) {
        let text = fs::read_to_string(&file).expect("text");
        let error = parse(&file, &text).err().map(|error| error.to_string());
        assert_eq!(error, None);
    }
    read_all(target, parse);
}

/// Parses edited files of the corpus. Any bytes must give a value or an error of one line.
fn read_all<T, E: ToString>(target: &str, parse: impl Fn(&Path, &str) -> Result<T, E>) {
    proptest!(rules(3000), |(bytes in inputs(target))| {
        if let Ok(text) = String::from_utf8(bytes)
            && let Err(error) = parse(Path::new("x"), &text)
        {
            let message = error.to_string();
            prop_assert!(!message.contains(char::is_control), "{message}");
            prop_assert!(message.len() < 1000, "{message}");
        }
    });
}

#[test]
fn every_champion_file_gives_a_champion_or_one_line() {
    read_corpus("champion", parse_champion);
}

/// Returns the text of a champion with these blocks. Its gait has waves for the joints of five blocks.
fn with_blocks(blocks: &str) -> String {
    let champion = include_str!("../../fuzz/corpus/champion/bodies");
    let (before, rest) = champion.split_once("segments: [(").expect("blocks");
    let (_, behind) = rest.split_once(")],").expect("their end");
    format!("{before}segments: {blocks},{behind}")
}

/// Accepted blocks can be built, and every change to them stays within the limits of a space that includes them.
#[test]
fn every_list_of_blocks_gives_a_body_or_one_line() {
    read_corpus("body", |path, blocks| {
        parse_champion(path, &with_blocks(blocks)).map(|loaded| {
            let genome = &loaded.champion.genome;
            let body = loaded.champion.body();
            assert!(body.limbs() <= MOST_SEGMENTS as usize, "{} blocks", body.limbs());
            assert!(body.parts.len() <= 4 * MOST_SEGMENTS as usize, "{} parts", body.parts.len());
            let space = GenomeSpace::default().widened_for(genome);
            for (number, (change, _)) in (0..).zip(BodyChange::RATES) {
                let mut rng = stream(1, 1, number, Purpose::Mutation);
                if let Some(child) = space.with_body_change(genome, change, &mut rng) {
                    child.body.check().expect("within the limits");
                }
            }
        })
    });
}

/// Returns the text of a champion with the nodes of this graph. Its neurons fit three nodes and four joints.
fn with_nodes(nodes: &str) -> String {
    let champion = include_str!("../../fuzz/corpus/champion/creatures");
    let (before, rest) = champion.split_once("nodes: [").expect("nodes");
    let (_, behind) = rest.split_once("        controller:").expect("their end");
    format!("{before}nodes: {nodes},\n),\ncontroller:{behind}")
}

/// Accepted graphs grow into bodies of a bounded size, and their children can be built.
#[test]
fn every_graph_of_nodes_gives_a_creature_or_one_line() {
    read_corpus("creature", |path, nodes| {
        parse_champion(path, &with_nodes(nodes)).map(|loaded| {
            let genome = &loaded.champion.genome;
            assert!(loaded.champion.body().parts.len() <= MOST_PARTS);
            let space = GenomeSpace::default().widened_for(genome);
            for number in 0..6 {
                let mut rng = stream(1, 1, number, Purpose::Mutation);
                let change = CreatureChange::draw(&mut rng);
                if let Some(child) = space.changed_creature([genome; 2], change, 0.2, &mut rng) {
                    child.body.check().expect("within the limits");
                }
            }
        })
    });
}

#[test]
fn every_preset_file_gives_a_preset_or_one_line() {
    read_corpus("preset", parse_preset);
}

#[test]
fn every_file_of_stairs_gives_stairs_that_can_be_built_or_one_line() {
    read_corpus("stairs", |path, text| {
        parse_stairs(path, text).map(|named| {
            for solid in named.stairs.solids() {
                let half_m = solid.half_m;
                assert!(half_m.min_element() > 0.0 && half_m.is_finite(), "{solid:?}");
            }
            for [y_m, z_m] in named.stairs.outline_m() {
                assert!(y_m.is_finite() && z_m >= 0.0, "{:?}", named.stairs);
            }
        })
    });
}

#[test]
fn every_plan_file_gives_a_plan_or_one_line() {
    read_corpus("plan", parse_plan);
}

/// Returns a plan and its fingerprint, which replaces the word PLAN in the corpus.
fn plan() -> (RunPlan, String) {
    let plan = RunPlan::new("x", 1, Settings::default());
    let fingerprint = fingerprint(&plan);
    (plan, fingerprint)
}

#[test]
fn every_checkpoint_gives_a_state_that_resumes_or_one_line() {
    for (strategy, controller, untouched) in [
        (StrategyKind::Halving, ControllerKind::Signal, "two-parents"),
        (StrategyKind::Ga, ControllerKind::Gait, "ga"),
        (StrategyKind::CmaEs, ControllerKind::Gait, "cma-es"),
        (StrategyKind::MapElites, ControllerKind::Gait, "map-elites"),
        (StrategyKind::Novelty, ControllerKind::Gait, "novelty"),
        (StrategyKind::Random, ControllerKind::Gait, "random"),
        (StrategyKind::Neat, ControllerKind::Grown, "neat"),
        (StrategyKind::QLearning, ControllerKind::Decisions, "q-learning"),
        (StrategyKind::Xcs, ControllerKind::Decisions, "xcs"),
        (StrategyKind::Xcs, ControllerKind::JointDecisions, "xcs-per-joint"),
        (StrategyKind::Zcs, ControllerKind::Decisions, "zcs"),
        (StrategyKind::BodyGa, ControllerKind::Gait, "body-ga"),
        (StrategyKind::BodyNovelty, ControllerKind::Gait, "body-novelty"),
        (StrategyKind::BodyMapElites, ControllerKind::Gait, "body-map-elites"),
        (StrategyKind::CreatureGa, ControllerKind::PartNeurons, "creature-ga"),
        (StrategyKind::Islands, ControllerKind::Gait, "islands"),
        (StrategyKind::Poet, ControllerKind::Gait, "poet"),
        (StrategyKind::BodyPoet, ControllerKind::Gait, "body-poet"),
        (StrategyKind::Mcc, ControllerKind::Gait, "mcc"),
    ] {
        let (mut plan, _) = plan();
        plan.settings.evolution.strategy = strategy;
        plan.settings.genome.controller = controller;
        plan.settings.evolution.population = 4;
        if strategy.info().varies_bodies {
            plan.settings.genome.bodies.vary = true;
            plan.settings.genome.bodies.limbs_max = 3;
            plan.settings.evolution.islands.candidates = 4;
            plan.settings.evolution.generations = 40;
        }
        if strategy.info().evolves_stairs {
            plan.settings.trial.fitness = Fitness::Share;
            plan.settings.evolution.generations = 100;
            plan.settings.evolution.poet.pair_candidates = 4;
            plan.settings.evolution.mcc.snake_queue = 4;
            plan.settings.evolution.mcc.first_snakes = 4;
        }
        plan.settings.evolution.xcs.rules = 20;
        plan.settings.evolution.zcs.rules = 20;
        let fingerprint = fingerprint(&plan);
        let read = |path: &Path, text: &str| {
            parse_checkpoint(path, &text.replace("PLAN", &fingerprint), &plan).map(|read| {
                // A state that is accepted can be resumed.
                let (generation, _, knowledge) = read;
                let strategy = resume(&plan, generation, &knowledge.strategy);
                drop(strategy.expect("it passed the same check").ask());
            })
        };
        let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/checkpoint");
        let untouched = fs::read_to_string(corpus.join(untouched)).expect("a file");
        read(Path::new("x"), &untouched).expect("the corpus begins with what is allowed");
        read_all("checkpoint", read);
    }
}

/// Adds correct checksums to the lines, so that more of them reach the parser.
fn summed(bytes: &[u8]) -> Vec<u8> {
    let lines = bytes.split(|byte| *byte == b'\n').map(|line| {
        let sum = format!(",\"sum\":\"{:016x}\"}}\n", xxh3_64(line));
        [line, sum.as_bytes()].concat()
    });
    lines.collect::<Vec<_>>().concat()
}

#[test]
fn every_log_gives_records_or_one_line() {
    let (plan, fingerprint) = plan();
    // The first byte is used only by the fuzz target of the same name, so it is dropped.
    let lines =
        |text: &str| summed(text.replace("PLAN", &fingerprint).get(1..).unwrap_or("").as_bytes());
    let records = |path: &Path, text: &str| parse_records(path, &lines(text), &plan);
    let changes = |path: &Path, text: &str| parse_changes(path, &lines(text), &plan);
    let evaluations = |path: &Path, text: &str| parse_evaluations(path, &lines(text), 1, &plan);
    let untouched = include_str!("../../fuzz/corpus/logs/generations");
    assert_eq!(records(Path::new("x"), untouched).expect("allowed").len(), 3);
    let untouched = include_str!("../../fuzz/corpus/logs/evaluations");
    assert_eq!(evaluations(Path::new("x"), untouched).expect("allowed").len(), 2);
    let untouched = include_str!("../../fuzz/corpus/logs/changes");
    assert_eq!(changes(Path::new("x"), untouched).expect("allowed").len(), 4);
    read_all("logs", changes);
    let lineage = |path: &Path, text: &str| parse_lineage(path, &lines(text), &plan);
    let untouched = include_str!("../../fuzz/corpus/logs/lineage");
    assert_eq!(lineage(Path::new("x"), untouched).expect("allowed").len(), 2);
    read_all("logs", records);
    read_all("logs", lineage);
    read_all("logs", evaluations);
    read_all("logs", |path, text| parse_records(path, text.as_bytes(), &plan));
}

#[test]
fn every_value_of_a_setting_is_accepted_or_gives_one_line() {
    let settings = Settings::default();
    read_all("field", |_, text| {
        let (field, value) = text.split_once('=').unwrap_or((text, ""));
        with_field(&settings, field, value)
    });
}

#[cfg(feature = "cluster")]
#[test]
fn every_message_between_machines_is_read_or_gives_one_line() {
    use snakes_cluster::kinds_of_message;
    for file in corpus("wire") {
        assert!(kinds_of_message(&fs::read(&file).expect("read")).is_ok(), "{}", file.display());
    }
    // Names with line breaks in a message must not bring the line breaks into its error.
    for file in corpus("wire") {
        let text = fs::read_to_string(&file).unwrap_or_default().replace("_s\"", "\\n_s\"");
        if let Err(error) = kinds_of_message(text.as_bytes()) {
            assert!(!error.to_string().contains(char::is_control), "{error}");
        }
    }
    proptest!(rules(3000), |(bytes in inputs("wire"))| {
        if let Err(error) = kinds_of_message(&bytes) {
            prop_assert!(!error.to_string().contains('\n'), "{error}");
        }
    });
}
