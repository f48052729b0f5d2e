//! Steps of several snakes side by side: see the module's page for the method.

use super::chain::{Chain, Common};
use super::contact::Other;
use super::contact_rows::WideContact;
use super::joint_rows::WideJoint;
use super::wide::{Wide, WideRotation, WideSymmetric, WideVector};

/// Greatest speed of a part, in m/s, and its greatest turn within a step, in radians: rapier's.
const MOST_M_S: f32 = 400.0;
const MOST_TURN_RAD: f32 = std::f32::consts::FRAC_PI_4;

/// A part in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct WidePart<const N: usize> {
    pub at: WideVector<N>,
    /// Where the step began.
    pub began_at: WideVector<N>,
    pub turn: WideRotation<N>,
    /// Its axes in the world, at the present rotation.
    pub axes: [WideVector<N>; 3],
    pub linear: WideVector<N>,
    pub angular: WideVector<N>,
    pub inverse_kg: Wide<N>,
    /// 1, and 0 for a part that is held.
    moves: Wide<N>,
    /// In the world, at the beginning of the step.
    pub inverse_inertia: WideSymmetric<N>,
    inertia: WideVector<N>,
    /// What gravity, forces and torques add in a substep.
    adds_linear: WideVector<N>,
    adds_angular: WideVector<N>,
}

/// Two different parts, for changing both.
#[inline(always)]
pub(super) fn both<const N: usize>(
    parts: &mut [WidePart<N>],
    front: usize,
    rear: usize,
) -> Option<(&mut WidePart<N>, &mut WidePart<N>)> {
    let (before, after) = parts.split_at_mut_checked(rear)?;
    Some((before.get_mut(front)?, after.first_mut()?))
}

impl<const N: usize> WidePart<N> {
    const EMPTY: Self = Self {
        at: WideVector::ZERO,
        began_at: WideVector::ZERO,
        turn: WideRotation::IDENTITY,
        axes: [WideVector::ZERO; 3],
        linear: WideVector::ZERO,
        angular: WideVector::ZERO,
        inverse_kg: Wide::ONE,
        moves: Wide::ONE,
        inverse_inertia: WideSymmetric::ZERO,
        inertia: WideVector { x: Wide::ONE, y: Wide::ONE, z: Wide::ONE },
        adds_linear: WideVector::ZERO,
        adds_angular: WideVector::ZERO,
    };

    fn load(&mut self, lane: usize, chain: &Chain, index: usize) {
        let (part, state) = (&chain.parts[index], &chain.state[index]);
        self.at.set(lane, state.at);
        let [x, y, z, w] = state.turn;
        self.turn.x.0[lane] = x;
        self.turn.y.0[lane] = y;
        self.turn.z.0[lane] = z;
        self.turn.w.0[lane] = w;
        self.linear.set(lane, state.linear);
        self.angular.set(lane, state.angular);
        let moves = if state.is_held { 0.0 } else { 1.0 };
        self.moves.0[lane] = moves;
        self.inverse_kg.0[lane] = moves / part.mass_kg;
        self.inertia.set(lane, part.inertia_kg_m2);
        self.adds_linear.set(lane, chain.gravity * moves + state.force_n * (moves / part.mass_kg));
        self.adds_angular.set(lane, state.torque_nm);
    }

    fn store(&self, lane: usize, chain: &mut Chain, index: usize) {
        let state = &mut chain.state[index];
        state.at = self.at.get(lane);
        state.turn =
            [self.turn.x.0[lane], self.turn.y.0[lane], self.turn.z.0[lane], self.turn.w.0[lane]];
        state.linear = self.linear.get(lane);
        state.angular = self.angular.get(lane);
    }

    /// Prepares a step after all lanes were loaded.
    #[inline(always)]
    fn begin_step(&mut self, substep_s: Wide<N>) {
        self.began_at = self.at;
        self.axes = self.turn.axes();
        let inverse = WideVector {
            x: self.moves / self.inertia.x,
            y: self.moves / self.inertia.y,
            z: self.moves / self.inertia.z,
        };
        self.inverse_inertia = WideSymmetric::along(&self.axes, inverse);
        self.adds_linear = self.adds_linear * substep_s;
        self.adds_angular = self.inverse_inertia.of(self.adds_angular) * substep_s;
    }

    /// Forces, torques and the gyroscopic torque of a substep.
    #[inline(always)]
    fn accelerate(&mut self, substep_s: Wide<N>) {
        self.linear += self.adds_linear;
        self.angular += self.adds_angular;
        // The explicit step of Euler's equations, with the length of the angular momentum before it, as in rapier.
        let [a, b, c] = self.axes;
        let rate =
            WideVector { x: a.dot(self.angular), y: b.dot(self.angular), z: c.dot(self.angular) };
        let momentum = self.inertia.times(rate);
        let turned = momentum - rate.cross(momentum) * substep_s;
        let (before, after) = (momentum.dot(momentum), turned.dot(turned));
        let scale = Wide::where_less(
            Wide::ZERO,
            after,
            (before / after.max(Wide::all(f32::MIN_POSITIVE))).sqrt(),
            Wide::ONE,
        );
        let rate = WideVector {
            x: turned.x * scale / self.inertia.x,
            y: turned.y * scale / self.inertia.y,
            z: turned.z * scale / self.inertia.z,
        };
        self.angular = a * rate.x + b * rate.y + c * rate.z;
    }

    /// Moves the part for a substep.
    #[inline(always)]
    fn advance(&mut self, substep_s: Wide<N>, most_rad_s: f32) {
        self.linear = within(self.linear, MOST_M_S);
        self.angular = within(self.angular, most_rad_s);
        self.at += self.linear * substep_s;
        self.turn = self.turn.turned(self.angular, substep_s);
        self.axes = self.turn.axes();
    }

    #[inline(always)]
    fn end_step(&mut self) {
        self.at = self.at.without_signed_zeros();
        self.turn = self.turn.without_signed_zeros();
        self.linear = self.linear.without_signed_zeros();
        self.angular = self.angular.without_signed_zeros();
    }
}

/// The order in which the joints are solved, rapier's: every other one, whose parts are different, and then those between.
fn alternating(joints: usize) -> impl Iterator<Item = usize> {
    (0..joints).step_by(2).chain((1..joints).step_by(2))
}

/// A vector no longer than `most`.
#[inline(always)]
fn within<const N: usize>(vector: WideVector<N>, most: f32) -> WideVector<N> {
    let square = vector.dot(vector);
    let (most, most_square) = (Wide::all(most), Wide::all(most * most));
    if !square.any_greater(most_square) {
        return vector;
    }
    vector * Wide::where_less(most_square, square, most / square.sqrt(), Wide::ONE)
}

/// Solves up to `N` snakes side by side. It holds working memory only.
#[derive(Debug, Clone)]
pub(crate) struct LaneSolver<const N: usize> {
    parts: Vec<WidePart<N>>,
    joints: Vec<WideJoint<N>>,
    /// The first `contacts_used` of them are those of this step.
    contacts: Vec<WideContact<N>>,
    contacts_used: usize,
}

impl<const N: usize> Default for LaneSolver<N> {
    fn default() -> Self {
        Self { parts: Vec::new(), joints: Vec::new(), contacts: Vec::new(), contacts_used: 0 }
    }
}

impl<const N: usize> LaneSolver<N> {
    /// Advances up to `N` snakes by one step, without their bounces; all of them have the same [`Common`], and those beyond `N`
    /// are not advanced.
    pub fn advance(&mut self, chains: &mut [&mut Chain]) {
        let used = chains.len().min(N);
        let chains = &mut chains[..used];
        let Some(common) = chains.first().map(|chain| chain.common) else { return };
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

    /// Takes the snakes into the lanes. A lane without a snake is another copy of the first.
    fn load(&mut self, common: &Common, chains: &[&mut Chain]) {
        self.parts.resize(common.parts, WidePart::EMPTY);
        self.joints.resize(common.joints, WideJoint::EMPTY);
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
        // Contacts between parts, in the order of the pairs; then those of each part with the world, so that the world has the
        // last word.
        for front in 0..common.parts {
            for rear in front + 1..common.parts {
                self.load_contact(chains, &mut next, rear, Some(front));
            }
        }
        for part in 0..common.parts {
            while self.load_contact(chains, &mut next, part, None) {}
        }
    }

    /// Takes the next contact of each snake that is between these bodies. Returns whether there was any.
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
                Other::Part(front) => Some(front),
                Other::Ground | Other::Solid(_) => None,
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
        common: &Common,
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
            for index in alternating(joints.len()) {
                joints[index].solve(parts, true);
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
        // A last pass without corrections of positions, which must not become velocities.
        for index in alternating(joints.len()) {
            joints[index].solve(parts, false);
        }
        for contact in contacts.iter_mut() {
            contact.end_substep(parts, per_substep);
            contact.solve_normal(parts);
            contact.solve_friction(parts);
        }
    }
}
