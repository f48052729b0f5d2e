//! Steps of several snakes side by side. The documentation of the module `lanes` explains the method.

use super::chain::{Chain, LanesCommon};
use super::contact::Touching;
use super::contact_rows::WideContact;
use super::joint_rows::WideJoint;
use super::part::{MOST_TURN_RAD, WidePart};
use super::wide::Wide;

/// Solver that steps up to `N` snakes side by side. It holds working memory only.
#[derive(Debug, Clone)]
pub(crate) struct LaneSolver<const N: usize> {
    parts: Vec<WidePart<N>>,
    joints: Vec<WideJoint<N>>,
    /// Contacts of all lanes. The first `contacts_used` belong to this step.
    contacts: Vec<WideContact<N>>,
    contacts_used: usize,
}

impl<const N: usize> Default for LaneSolver<N> {
    fn default() -> Self {
        Self { parts: Vec::new(), joints: Vec::new(), contacts: Vec::new(), contacts_used: 0 }
    }
}

impl<const N: usize> LaneSolver<N> {
    /// Advances up to `N` snakes by one step, without their bounces. All of them have the same [`LanesCommon`]. Snakes beyond `N` are not
    /// advanced.
    pub fn advance(&mut self, chains: &mut [&mut Chain]) {
        let used = chains.len().min(N);
        let chains = &mut chains[..used];
        let Some(common) = chains.first().map(|chain| chain.common.clone()) else { return };
        for chain in chains.iter_mut() {
            chain.find_contacts();
        }
        self.load(&common, chains);
        let substep_s = common.step_s / common.substeps as f32;
        let (substep, per_substep) = (Wide::all(substep_s), Wide::all(1.0 / substep_s));
        let most_rad_s = MOST_TURN_RAD * (1.0 / common.step_s);
        for part in &mut self.parts {
            part.begin_step(substep);
        }
        for contact in &mut self.contacts[..self.contacts_used] {
            contact.build(&self.parts);
        }
        for _ in 0..common.substeps {
            self.substep(&common, substep, per_substep, most_rad_s);
        }
        for part in &mut self.parts {
            part.end_step();
        }
        for (lane, chain) in chains.iter_mut().enumerate() {
            for (index, part) in self.parts.iter().enumerate() {
                part.store(lane, chain, index);
            }
            for contact in &self.contacts[..self.contacts_used] {
                contact.store(lane, chain);
            }
        }
    }

    /// Loads the snakes into the lanes. A lane without a snake gets a copy of the first one.
    fn load(&mut self, common: &LanesCommon, chains: &[&mut Chain]) {
        self.parts.resize(common.parts, WidePart::EMPTY);
        self.joints.resize(common.joints.len(), WideJoint::EMPTY);
        let of_lane = |lane: usize| chains.get(lane).unwrap_or(&chains[0]);
        for lane in 0..N {
            let chain = of_lane(lane);
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
    }

    /// Loads the next contact of each snake, if it is between these bodies. Returns whether any snake has such a contact.
    fn load_contact(
        &mut self,
        chains: &[&mut Chain],
        next: &mut [usize; N],
        part: usize,
        other: Option<usize>,
    ) -> bool {
        let mut is_begun = false;
        for (lane, (chain, next)) in chains.iter().zip(next.iter_mut()).enumerate() {
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
                    self.contacts.push(WideContact::EMPTY);
                }
                self.contacts[self.contacts_used].begin(part, other);
                self.contacts_used += 1;
            }
            self.contacts[self.contacts_used - 1].load(lane, chain, *next);
            *next += 1;
        }
        is_begun
    }

    fn substep(
        &mut self,
        common: &LanesCommon,
        substep: Wide<N>,
        per_substep: Wide<N>,
        most_rad_s: f32,
    ) {
        let Self { parts, joints, contacts, contacts_used } = self;
        let contacts = &mut contacts[..*contacts_used];
        for part in parts.iter_mut() {
            part.accelerate(substep);
        }
        for joint in joints.iter_mut() {
            let [front, rear] = joint.parts;
            joint.build(&parts[front], &parts[rear], common);
        }
        for contact in contacts.iter_mut() {
            contact.begin_substep(parts, common, per_substep);
        }
        for _ in 0..common.iterations {
            for joint in joints.iter_mut() {
                joint.solve(parts, true);
            }
            for contact in contacts.iter_mut() {
                contact.solve_normal(parts);
                if common.has_springs {
                    contact.solve_friction(parts);
                }
            }
        }
        for part in parts.iter_mut() {
            part.advance(substep, most_rad_s);
        }
        if common.has_springs {
            return;
        }
        // The last pass is without corrections of positions, because these must not become velocities.
        for joint in joints.iter_mut() {
            joint.solve(parts, false);
        }
        for contact in contacts.iter_mut() {
            contact.end_substep(parts, per_substep);
            contact.solve_normal(parts);
            contact.solve_friction(parts);
        }
    }
}
