//! A second physics engine: boxes in a row or a tree, several snakes side by side, one per lane of the processor's vectors.
//!
//! # The method
//! The method is that of rapier, so that a snake moves alike in both engines, but written for boxes with one joint to a box before them:
//!
//! 1. **Contacts** are found once per step, for each snake on its own ([`contact`], [`block`]): up to four points per pair of bodies. A
//!    point keeps the impulses that it had in the step before.
//! 2. **Substeps** follow the scheme that Catto calls soft step ("Solver2D", 2024) and Macklin and others call substepping ("Small steps
//!    in physics simulation", SCA 2019): forces change the velocities; rows for all joints and contacts change the velocities until they
//!    satisfy the constraints and correct the positions; the parts move; and a last pass takes the corrections out of the velocities
//!    again. A pass goes over the joints and springs, group by group, and then over the contacts, the contacts with the ground last. The
//!    joints of a group have no part in common. From the head, each joint joins the first group that has room for it, as in rapier: in a
//!    row, every second joint is in the first group, and the others are in the second.
//! 3. **Rows** are sequential impulses (Catto, "Iterative dynamics with temporal coherence", GDC 2005): each row brings the velocity in
//!    its direction to its target at once, and accumulates its impulses within its limits. Rows that stand for a spring and a damper are
//!    soft constraints (Catto, "Soft constraints", GDC 2011), which yield by their compliance.
//! 4. **A universal joint** ([`joint_rows`]) has four rows that lock it: one for the z part of the relative quaternion and three for the
//!    coordinates of the gap between its anchors, orthogonalised by Gram and Schmidt's method, so that one pass solves all four. Two rows
//!    damp it, integrated implicitly by the solver, and two hold its limits where these are reached. The joints of a tree have a place
//!    and axes of their own on their front part.
//!
//!    **A spring** of a soft limb has three elastic rows, one about each axis, which the solver integrates implicitly, too, and the three
//!    rows for the gap between its anchors.
//! 5. **A contact** ([`contact_rows`]) has one row for each point, which prevents approach. For all points together, a pair of rows is
//!    friction along the surface, and one row is friction against turning on the spot, within Coulomb's cone.
//! 6. **Bounces** ([`restitution`]) happen once, at the end of a step.
//!
//! # Equal bits
//! See [`wide`]. Every computation of a lane depends on this lane alone, and consists of sums, products, quotients, roots and comparisons
//! of single numbers. Therefore neither the other lanes nor the number of lanes nor the processor change a bit. Neither do the vector
//! instructions that are chosen when the program runs ([`level`]).

mod angle;
mod block;
mod chain;
mod contact;
mod contact_rows;
mod joint;
mod joint_rows;
mod level;
mod part;
mod restitution;
mod shared_points;
mod solver;
mod wide;
mod world;

use chain::Chain;
pub use chain::LanesCommon;
pub use level::VectorLevel;
pub use solver::LANES;
pub(crate) use solver::LaneSolver;
pub(crate) use world::LanesWorld;
