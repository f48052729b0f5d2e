//! Snakes & Stairs: a five-block snake evolves until it climbs a staircase.
//!
//! Read this file from top to bottom and you have read the pipeline. Each module uses those above
//! it, never those below.
//!
//! # Invariants
//! 1. **One scoring path.** Headless runs, the studio, replays and tests all advance a
//!    [`score::Rollout`], which goes through [`world::Simulation::step`] with one constant step.
//! 2. **The same seed and settings give the same bits**: for any number of threads, in debug and
//!    release, with and without the studio, on any x86-64 machine. Random numbers come from streams
//!    named after run seed, generation, individual and purpose ([`rng::stream`]), never from the order
//!    of arrival; results are in the order of the individuals before a strategy sees them. What is changed during a
//!    run ([`evolve::SettingChange`]) counts from a generation on, is written down before that generation begins, and
//!    belongs to the run like its settings; so does the champion that a run may descend from ([`evolve::Founder`]).
//! 3. **No transcendental function of the standard library in the core**: they differ from one C
//!    library to the next. `libm` only; `clippy.toml` lists them.
//!    Of the C library's float functions a step reaches two, through the physics engine, and neither can
//!    make a difference: `sincosf`, only ever of +0, because joint limits are symmetric (the C standard
//!    fixes both results); and `log2f`, by which parry's bounding volume tree decides how much of itself
//!    to rebuild, rounded to a whole number that no error of a few units in the last place changes for
//!    any tree of fewer than 100 000 leaves. `snakes verify` compares what comes of it.
//! 4. **The viewer only looks.** The frame rate, a moved window or a slow panel cannot change a result. A hand that
//!    pulls a limb makes a disturbed rollout, which is marked, compared with nothing and kept nowhere.
//! 5. **Panels send messages; one system applies them.** What can be done by name stands in one list, from which
//!    menus, keys and palette are drawn.
//! 6. **Whatever a person can break is checked where it enters**, and the error names the field, the
//!    value and what is allowed ([`check::Invalid`]).
//! 7. **A number has its unit in its name**: `duration_s`, `bend_limit_rad`, `torque_nm`.
//!
//! A test (`tests/it/architecture.rs`) checks those that a scan of the source can.
//!
//! # Axes
//! x across the stairs, y towards and up the stairs, z up, in the core and in the window alike: the
//! studio's camera has z up, so that what the engine's own tools draw lies where the blocks are.

pub mod check;
pub mod rng;

/// Stairs, surface, snake, and one `Simulation` that steps them; built on rapier3d.
pub mod world;

/// What evolves.
pub mod genome;

/// From genes to torques.
pub mod control;

/// A `Trial`, a `Rollout` of one genome through it, and what it scored.
pub mod score;

/// Strategies behind ask and tell.
pub mod evolve;

/// Files: runs, champions, presets.
pub mod save;

/// Experiments on worker threads, and the headless mode.
pub mod run;

/// Plots as pictures.
pub mod plot;

/// The window.
#[cfg(feature = "studio")]
pub mod studio;

/// The command line.
pub mod cli;

/// Version of everything that decides the bits of a run: physics, controllers, random streams,
/// strategies. Raised by hand whenever a change alters them on purpose; saves record it.
pub const ENGINE_VERSION: u32 = 2;
