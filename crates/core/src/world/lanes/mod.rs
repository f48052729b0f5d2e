//! A second physics engine: chains of boxes, several snakes side by side, one per lane of the processor's vectors.
//!
//! # The method
//! It is that of rapier, so that a snake moves in both engines alike, written for this one body:
//!
//! 1. **Contacts** are found once a step, for each snake on its own ([`contact`], [`block`]): up to four points per pair of
//!    bodies. A point keeps the impulses that it had in the step before.
//! 2. **Substeps** follow the scheme that Catto calls soft step ("Solver2D", 2024) and Macklin and others substepping ("Small
//!    steps in physics simulation", SCA 2019): forces change the velocities; rows for all joints and contacts change them until
//!    they agree with what these allow, together with a correction of the positions; the parts move; and a last pass takes the
//!    corrections out of the velocities again. A pass goes over every other joint, over those between, and then over the
//!    contacts, so that those with the ground are solved last.
//! 3. **Rows** are sequential impulses (Catto, "Iterative dynamics with temporal coherence", GDC 2005): each takes the velocity
//!    in its direction to its target, at once, and remembers the sum of its impulses, within its limits. Rows that stand for a
//!    spring and a damper are soft constraints (Catto, "Soft constraints", GDC 2011): compliance makes them yield.
//! 4. **A universal joint** ([`joint_rows`]) is four rows that lock it: the z part of the relative quaternion and the three
//!    coordinates of the gap between its anchors, orthogonalised by Gram and Schmidt's method, so that one pass solves all four;
//!    two rows for its damping, which the solver integrates implicitly; and two for its limits, where they are reached.
//! 5. **A contact** ([`contact_rows`]) has a row for each point against approaching, and for all points together a pair of rows
//!    for friction along the surface and one against turning on the spot, within Coulomb's cone.
//! 6. **Bounces** ([`restitution`]) happen once, at the end of a step.
//!
//! # Equal bits
//! See [`wide`]. Every computation of a lane depends on that lane alone, and consists of sums, products, quotients, roots and
//! comparisons of single numbers. So neither neighbours nor the number of lanes nor the processor change a bit.

mod block;
mod chain;
mod contact;
mod contact_rows;
mod joint_rows;
mod part;
mod restitution;
mod shared_points;
mod solver;
mod wide;

pub use chain::LanesCommon;
pub(crate) use chain::{Chain, PartState};
pub(crate) use contact::{Contact, ContactPoint, Touching};
pub(crate) use solver::LaneSolver;
