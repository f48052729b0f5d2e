//! Snakes & Stairs: a five-block snake evolves until it climbs a staircase.
//!
//! The modules below are in the order of the pipeline: each uses only those above it. The crates above this one run experiments
//! (`snakes-lab`), spread them over machines (`snakes-cluster`), and show them (the program).
//!
//! # Invariants
//! 1. **One scoring path.** Headless runs, the studio, replays and tests all advance a
//!    [`score::Rollout`], which calls [`world::Simulation::step`] with one constant step.
//! 2. **The same seed and settings give the same bits**: for any number of threads, in debug and
//!    release, with and without the studio, on any x86-64 machine. Random numbers come from streams
//!    identified by run seed, generation, individual and purpose ([`rng::stream`]), never by the order
//!    of evaluation. A strategy receives results in the order of the individuals. A change of settings during a
//!    run ([`evolve::SettingChange`]) takes effect with a given generation, is saved before that generation
//!    begins, and belongs to the run like its settings; so does the champion from which a run may start
//!    ([`evolve::Founder`]).
//! 3. **No transcendental function of the standard library in the core**: their results differ between C
//!    libraries. The core uses `libm` only; `clippy.toml` lists the forbidden functions.
//!    Through rapier a step calls two float functions of the C library, and neither can change
//!    a result: `sincosf`, always with +0, because joint limits are symmetric (the C standard fixes both
//!    results); and `log2f`, with which parry's bounding volume tree decides how much of itself to rebuild,
//!    rounded to a whole number that no error of a few units in the last place changes for any tree of
//!    fewer than 100 000 leaves. The engine *lanes* calls none, and its bits are the same on every processor, not on x86-64
//!    alone: see [`world`]. `snakes verify` compares the resulting trajectories.
//! 4. **The viewer only reads.** The frame rate, a moved window or a slow panel cannot change a result. If the user
//!    pulls a limb, the rollout is marked as disturbed, is never compared with a record, and is never saved.
//! 5. **Panels send messages; one system applies them.** All actions that have a name stand in one list, from which
//!    menus, keys and command palette are built.
//! 6. **Input is checked where it enters**, and the error names the field, its value and the allowed range
//!    ([`check::Invalid`]).
//! 7. **A number has its unit in its name**: `duration_s`, `bend_limit_rad`, `torque_nm`.
//!
//! A test (`tests/it/architecture.rs`) checks the invariants that a scan of the source can check.
//!
//! # Axes
//! x across the stairs, y towards and up the stairs, z up, both in the core and in the window: the
//! studio's camera has z up, so that the drawings of the engine's own tools match the blocks.

pub mod check;
pub mod rng;

/// Learners that improve from the outcome of actions: classifier systems, Q-learning and NEAT, independent of the snake.
pub mod learn;

/// The settings schema: a row that describes each setting, and the walk through all rows.
pub mod schema;

/// Stairs, surfaces, the snake's body, and a `Simulation` that steps them with rapier3d or with the engine *lanes*.
pub mod world;

/// Genomes: the controllers and body properties that evolve.
pub mod genome;

/// Controllers, which compute torques from genes and sensed joint angles.
pub mod control;

/// Scoring: a `Trial`, a `Rollout` of one genome in it, and its `Evaluation`.
pub mod score;

/// Search strategies. The caller asks a strategy for individuals and tells it their evaluations.
pub mod evolve;

/// File formats and folders: runs, champions, presets.
pub mod save;

/// The version of the engine, and the processors on which it computes the same bits.
mod engine;

pub use engine::{ENGINE_VERSION, Engine, Processors};
