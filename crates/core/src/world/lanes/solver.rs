//! Steps of several snakes side by side. The documentation of the module `lanes` explains the method.

use fearless_simd::{Simd, dispatch};

use super::VectorLevel;
use super::chain::{Chain, LanesCommon};
use super::contact_rows::WideContact;
use super::joint_rows::WideJoint;
use super::level::BASELINE;
use super::part::{MOST_TURN_RAD, WidePart};
use super::wide::Wide;
use crate::world::engine::Touching;

/// Number of snakes that are advanced side by side: as many as AVX has lanes, and twice as many as SSE2 and NEON have. On web pages, where
/// the size of the code counts, it is the number of lanes of WebAssembly.
pub const LANES: usize = if cfg!(target_arch = "wasm32") { 4 } else { 8 };

/// Solver that steps up to `N` snakes side by side. It holds working memory only.
#[derive(Debug, Clone)]
pub(crate) struct LaneSolver<const N: usize> {
    level: VectorLevel,
    parts: Vec<WidePart<N>>,
    joints: Vec<WideJoint<N>>,
    /// Contacts of all lanes. The first `contacts_used` belong to this step.
    contacts: Vec<WideContact<N>>,
    contacts_used: usize,
}

impl<const N: usize> LaneSolver<N> {
    /// Makes a solver that computes with these vector instructions.
    pub fn at(level: VectorLevel) -> Self {
        let (parts, joints, contacts) = (Vec::new(), Vec::new(), Vec::new());
        Self { level, parts, joints, contacts, contacts_used: 0 }
    }

    /// Advances up to `N` snakes by one step, without their bounces. All of them have the same [`LanesCommon`].
    pub fn advance(&mut self, chains: &mut [Option<&mut Chain>; N]) {
        let Some(first) = chains.iter().position(Option::is_some) else { return };
        for chain in chains.iter_mut().flatten() {
            chain.find_contacts();
        }
        let Some(common) = self.load(chains, first) else { return };
        // A single lane gains nothing from vector instructions.
        let level = if N == 1 { BASELINE } else { self.level.0 };
        dispatch!(level, simd => self.step(simd, &common));
        for (lane, chain) in chains.iter_mut().enumerate() {
            let Some(chain) = chain else { continue };
            for (index, part) in self.parts.iter().enumerate() {
                part.store(lane, chain, index);
            }
            for contact in &self.contacts[..self.contacts_used] {
                contact.store(lane, chain);
            }
            chain.read_touches();
        }
    }

    /// Loads the snakes into the lanes, and returns what they have in common. A lane without a snake gets a copy of the first one.
    fn load(&mut self, chains: &[Option<&mut Chain>; N], first: usize) -> Option<LanesCommon> {
        let common = chains[first].as_ref()?.common();
        self.parts.resize(common.parts, WidePart::default());
        self.joints.resize(common.joints.len(), WideJoint::default());
        for (lane, chain) in chains.iter().enumerate() {
            let chain = chain.as_deref().or(chains[first].as_deref())?;
            for (index, part) in self.parts.iter_mut().enumerate() {
                part.load(lane, chain, index);
            }
            for (index, joint) in self.joints.iter_mut().enumerate() {
                joint.load(lane, chain, index);
            }
        }
        self.contacts_used = 0;
        let mut next = [0; N];
        // The contacts between parts come in the order of the pairs. The contacts of each part with the world follow, so that they are
        // solved last.
        for front in 0..common.parts {
            for rear in front + 1..common.parts {
                self.load_contact(chains, &mut next, rear, Some(front));
            }
        }
        for part in 0..common.parts {
            while self.load_contact(chains, &mut next, part, None) {}
        }
        Some(common)
    }

    /// Loads the next contact of each snake, if it is between these bodies. Returns whether any snake has such a contact.
    fn load_contact(
        &mut self,
        chains: &[Option<&mut Chain>; N],
        next: &mut [usize; N],
        part: usize,
        other: Option<usize>,
    ) -> bool {
        let mut is_begun = false;
        for (lane, (chain, next)) in chains.iter().zip(next.iter_mut()).enumerate() {
            let Some(chain) = chain else { continue };
            let Some(contact) = chain.contacts.get(*next) else { continue };
            let front = match contact.other {
                Touching::Part(front) => Some(front),
                Touching::Ground | Touching::Solid(_) => None,
            };
            if contact.part != part || front != other {
                continue;
            }
            if !is_begun {
                is_begun = true;
                if self.contacts_used == self.contacts.len() {
                    self.contacts.push(WideContact::default());
                }
                self.contacts[self.contacts_used].begin(part, other);
                self.contacts_used += 1;
            }
            self.contacts[self.contacts_used - 1].load(lane, chain, *next);
            *next += 1;
        }
        is_begun
    }

    /// Computes the step of the loaded snakes. It is compiled once for each level of vector instructions, and so are the closures that it
    /// gives to `vectorize`. Everything within them is inlined, because a function of its own would have the instructions of the weakest
    /// level.
    #[inline(always)]
    fn step<S: Simd>(&mut self, simd: S, common: &LanesCommon) {
        let substep_s = common.step_s / common.substeps as f32;
        let (substep, per_substep) = (Wide::all(substep_s), Wide::all(1.0 / substep_s));
        let most_rad_s = MOST_TURN_RAD * (1.0 / common.step_s);
        let Self { parts, joints, contacts, contacts_used, .. } = self;
        let contacts = &mut contacts[..*contacts_used];
        for part in parts.iter_mut() {
            part.begin_step(substep);
        }
        for contact in contacts.iter_mut() {
            simd.vectorize(
                #[inline(always)]
                || contact.build(parts),
            );
        }
        for _ in 0..common.substeps {
            for part in parts.iter_mut() {
                part.accelerate(substep);
            }
            for joint in joints.iter_mut() {
                simd.vectorize(
                    #[inline(always)]
                    || joint.build(parts, common),
                );
            }
            for contact in contacts.iter_mut() {
                simd.vectorize(
                    #[inline(always)]
                    || contact.begin_substep(parts, common, per_substep),
                );
            }
            for _ in 0..common.iterations {
                solve_joints(simd, joints, parts, true);
                for contact in contacts.iter_mut() {
                    solve_contact(simd, contact, parts, common.has_springs);
                }
            }
            for part in parts.iter_mut() {
                part.advance(substep, most_rad_s);
            }
            if common.has_springs {
                continue;
            }
            // The last pass is without corrections of positions, because these must not become velocities.
            solve_joints(simd, joints, parts, false);
            for contact in contacts.iter_mut() {
                simd.vectorize(
                    #[inline(always)]
                    || contact.end_substep(parts, per_substep),
                );
                solve_contact(simd, contact, parts, true);
            }
        }
        for part in parts.iter_mut() {
            part.end_step();
        }
    }
}

/// Makes one pass over the rows of all joints, with or without the correction of positions.
#[inline(always)]
fn solve_joints<S: Simd, const N: usize>(
    simd: S,
    joints: &mut [WideJoint<N>],
    parts: &mut [WidePart<N>],
    is_biased: bool,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for joint in joints.iter_mut() {
                joint.solve(parts, is_biased);
            }
        },
    );
}

/// Makes one pass over the rows of a contact, with or without its friction.
#[inline(always)]
fn solve_contact<S: Simd, const N: usize>(
    simd: S,
    contact: &mut WideContact<N>,
    parts: &mut [WidePart<N>],
    has_friction: bool,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            contact.solve_normal(parts);
            if has_friction {
                contact.solve_friction(parts);
            }
        },
    );
}
