//! Changes of the structure of a body: blocks are added, removed, split and merged, together with their waves.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f32::consts::{PI, TAU};
use xxhash_rust::xxh3::xxh3_64;

use super::segment::Segment;
use crate::genome::controllers::{ControllerGenes, JointWaves, Wave, Waves};
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;
use crate::schema::named_values;

named_values! {
    /// A change of the structure of a body.
    pub enum BodyChange {
        /// A block was copied. The copy lies behind it, and the copy's joint continues the rhythm of the neighbouring joints.
        Duplicate = "duplicate";
        /// A block was split into two halves, held straight: at first this makes hardly any difference.
        Split = "split";
        /// A block was removed, with its joint.
        Remove = "remove";
        /// Two neighbouring blocks were merged: the inverse of a split.
        Merge = "merge";
        /// A block was inserted between two neighbours, as the mean of both.
        Insert = "insert";
        /// The sizes of a block changed a lot.
        Resize = "resize";
    }
}

/// Standard deviation of the logarithm of a size in [`BodyChange::Resize`].
const RESIZE: f64 = 0.4;
/// Growth of a block's length from which on a missing block behind it is taken as merged into it rather than removed.
const MERGED: f32 = 1.3;

impl BodyChange {
    /// All changes, with the probability that a child has the change.
    pub const RATES: [(Self, f64); 6] = [
        (Self::Duplicate, 0.07),
        (Self::Split, 0.06),
        (Self::Remove, 0.07),
        (Self::Merge, 0.03),
        (Self::Insert, 0.03),
        (Self::Resize, 0.04),
    ];

    /// Counts the places at which a body with this number of blocks can have this change: its blocks, or its pairs of neighbours.
    fn places(self, blocks: usize) -> usize {
        let pairs = matches!(self, Self::Merge | Self::Insert);
        if pairs { blocks.saturating_sub(1) } else { blocks }
    }

    /// Returns the change as a phrase, such as "a block split".
    pub fn words(self) -> &'static str {
        match self {
            Self::Duplicate => "a block duplicated",
            Self::Split => "a block split",
            Self::Remove => "a block removed",
            Self::Merge => "two blocks merged",
            Self::Insert => "a block inserted",
            Self::Resize => "a block resized",
        }
    }

    /// Finds the change that made the structure of a child from that of its parent; `None` if it was not a single change. Ids do not tell
    /// a removed block from a block that was merged into the one before it. It counts as merged if the block before it has grown much
    /// longer.
    pub fn between(parent: &Genome, child: &Genome) -> Option<Self> {
        let (parent, child) = (&parent.body.segments, &child.body.segments);
        let same = parent.iter().zip(child).take_while(|(a, b)| a.id == b.id).count();
        let are_same = |a: &[Segment], b: &[Segment]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.id == b.id)
        };
        if child.get(same + 1..).is_some_and(|rest| are_same(&parent[same..], rest)) {
            let place = same.checked_sub(1)?;
            let made = [Self::Duplicate, Self::Split, Self::Insert];
            return made.into_iter().find(|of| new_id(parent, place, *of) == child[same].id);
        }
        if !are_same(parent.get(same + 1..)?, &child[same..]) {
            return None;
        }
        let grown = |place: usize| child[place].length_m / parent[place].length_m;
        let is_merged = same.checked_sub(1).is_some_and(|place| grown(place) > MERGED);
        Some(if is_merged { Self::Merge } else { Self::Remove })
    }

    /// Draws a change by the probabilities of all changes; `None` with the remaining probability.
    pub fn draw(rng: &mut ChaCha8Rng) -> Option<Self> {
        let mut left = rng.random_range(0.0..1.0);
        Self::RATES.into_iter().find_map(|(change, rate)| {
            left -= rate;
            (left < 0.0).then_some(change)
        })
    }
}

impl GenomeSpace {
    /// Returns a genome whose body has this change at a random place, within all limits. `None` if the body does not allow the change, or
    /// if the genome has no body of its own.
    pub fn with_body_change(
        &self,
        parent: &Genome,
        change: BodyChange,
        rng: &mut ChaCha8Rng,
    ) -> Option<Genome> {
        let places = change.places(parent.body.segments.len());
        if places == 0 {
            return None;
        }
        let place = rng.random_range(0..places);
        self.with_body_change_at(parent, change, place, rng)
    }

    /// Returns a genome whose body has this change at a place: the index of the block, or of the first of two blocks. `None` under the
    /// conditions of [`Self::with_body_change`].
    pub fn with_body_change_at(
        &self,
        parent: &Genome,
        change: BodyChange,
        place: usize,
        rng: &mut ChaCha8Rng,
    ) -> Option<Genome> {
        if place >= change.places(parent.body.segments.len()) {
            return None;
        }
        let mut child = parent.clone();
        let mut editor = BodyInChange {
            waves: waves_mut(&mut child.controller)?,
            segments: &mut child.body.segments,
            space: self,
        };
        match change {
            BodyChange::Duplicate => editor.duplicate(place)?,
            BodyChange::Split => editor.split(place)?,
            BodyChange::Remove => editor.remove(place)?,
            BodyChange::Merge => editor.merge(place)?,
            BodyChange::Insert => editor.insert(place)?,
            BodyChange::Resize => editor.resize(place, rng),
        }
        self.bodies.repair(&mut child.body.segments);
        self.bodies.is_within_limits(&child.body.segments).then_some(child)
    }
}

/// Returns the id of a new block between two others. It is derived from their ids alone, so that the same change of the same body has the
/// same id in every run and on every machine.
fn new_id(segments: &[Segment], place: usize, change: BodyChange) -> u64 {
    let id = |index: usize| segments.get(index).map_or(0, |segment| segment.id);
    let mut ordinal = 0_u64;
    loop {
        let parts = [id(place), id(place + 1), change as u64, ordinal];
        let bytes: Vec<u8> = parts.iter().flat_map(|part| part.to_le_bytes()).collect();
        let new = xxh3_64(&bytes);
        if segments.iter().all(|segment| segment.id != new) {
            return new;
        }
        ordinal += 1;
    }
}

/// Returns the waves of a controller; `None` for a controller without waves.
pub(super) fn waves_mut(controller: &mut ControllerGenes) -> Option<&mut Waves> {
    match controller {
        ControllerGenes::Wave(waves) => Some(waves),
        ControllerGenes::Gait(gait) => Some(&mut gait.waves),
        _ => None,
    }
}

/// A genome during a change of its body. The joint in front of block k, counted from 0, has the waves with index k - 1.
struct BodyInChange<'a> {
    segments: &'a mut Vec<Segment>,
    waves: &'a mut Waves,
    space: &'a GenomeSpace,
}

impl BodyInChange<'_> {
    /// Checks whether another block fits: `None` if the body already has the greatest number of blocks.
    fn room(&self) -> Option<()> {
        (self.segments.len() < self.space.bodies.limbs_max as usize).then_some(())
    }

    fn duplicate(&mut self, place: usize) -> Option<()> {
        self.room()?;
        let id = new_id(self.segments, place, BodyChange::Duplicate);
        let copy = Segment { id, ..self.segments[place].clone() };
        let joint = self.joint_behind(place)?;
        self.segments.insert(place + 1, copy);
        self.waves.joints.insert(place, joint);
        Some(())
    }

    fn split(&mut self, place: usize) -> Option<()> {
        self.room()?;
        let half_m = self.segments[place].length_m / 2.0;
        if half_m < self.space.bodies.length_min_m {
            return None;
        }
        let id = new_id(self.segments, place, BodyChange::Split);
        self.segments[place].length_m = half_m;
        let rear = Segment { id, ..self.segments[place].clone() };
        self.segments.insert(place + 1, rear);
        let mut joint = self.waves.joints.first()?.clone();
        for wave in [&mut joint.bend, &mut joint.twist] {
            wave.offset = 0.0;
            wave.harmonics.iter_mut().for_each(|harmonic| {
                (harmonic.amplitude, harmonic.phase_rad) = (0.0, 0.0);
            });
        }
        self.waves.joints.insert(place, joint);
        Some(())
    }

    /// Removes a block. The joints beside the removed joint share its offset, so that the body roughly keeps its posture.
    fn remove(&mut self, place: usize) -> Option<()> {
        if self.segments.len() <= self.space.bodies.limbs_min as usize {
            return None;
        }
        self.segments.remove(place);
        let joint = place.saturating_sub(1);
        let gone = self.waves.joints.remove(joint);
        let [bend, twist] = self.offset_ranges();
        for beside in [joint.checked_sub(1), Some(joint)].into_iter().flatten() {
            if let Some(waves) = self.waves.joints.get_mut(beside) {
                add_offset(&mut waves.bend, gone.bend.offset / 2.0, bend);
                add_offset(&mut waves.twist, gone.twist.offset / 2.0, twist);
            }
        }
        Some(())
    }

    fn merge(&mut self, place: usize) -> Option<()> {
        if self.segments.len() <= self.space.bodies.limbs_min as usize {
            return None;
        }
        let rear = self.segments.remove(place + 1);
        let front = &mut self.segments[place];
        let length_m = front.length_m + rear.length_m;
        if length_m > self.space.bodies.length_max_m {
            return None;
        }
        let share = (rear.volume_m3() / (front.volume_m3() + rear.volume_m3())) as f32;
        let mean = |front: f32, rear: f32| front + (rear - front) * share;
        front.length_m = length_m;
        front.width_m = mean(front.width_m, rear.width_m);
        front.height_m = mean(front.height_m, rear.height_m);
        front.density_kg_m3 = mean(front.density_kg_m3, rear.density_kg_m3);
        if let (Some(of_front), Some(of_rear)) =
            (&mut front.youngs_modulus_pa, rear.youngs_modulus_pa)
        {
            *of_front = mean(*of_front, of_rear);
        }
        self.waves.joints.remove(place);
        Some(())
    }

    fn insert(&mut self, place: usize) -> Option<()> {
        self.room()?;
        let id = new_id(self.segments, place, BodyChange::Insert);
        let (front, rear) = (&self.segments[place], &self.segments[place + 1]);
        let size = |of: fn(&Segment) -> f32| (of(front) * of(rear)).sqrt();
        let mean = |of: fn(&Segment) -> f32| (of(front) + of(rear)) / 2.0;
        let new = Segment {
            id,
            length_m: size(|segment| segment.length_m),
            width_m: size(|segment| segment.width_m),
            height_m: size(|segment| segment.height_m),
            density_kg_m3: size(|segment| segment.density_kg_m3),
            bend_limit_rad: mean(|segment| segment.bend_limit_rad),
            twist_limit_rad: mean(|segment| segment.twist_limit_rad),
            strength: mean(|segment| segment.strength),
            youngs_modulus_pa: front
                .youngs_modulus_pa
                .zip(rear.youngs_modulus_pa)
                .map(|(front, rear)| (front * rear).sqrt()),
        };
        let behind = self.waves.joints.get(place)?;
        let before = match place.checked_sub(1) {
            Some(index) => self.waves.joints[index].clone(),
            None => self.joint_before_head()?,
        };
        let joint = JointWaves {
            bend: half_way(&before.bend, &behind.bend),
            twist: half_way(&before.twist, &behind.twist),
        };
        self.segments.insert(place + 1, new);
        self.waves.joints.insert(place, joint);
        Some(())
    }

    fn resize(&mut self, place: usize, rng: &mut ChaCha8Rng) {
        let bodies = &self.space.bodies;
        let segment = &mut self.segments[place];
        let thickness = [bodies.thickness_min_m, bodies.thickness_max_m];
        for (size, [least, most]) in [
            (&mut segment.length_m, [bodies.length_min_m, bodies.length_max_m]),
            (&mut segment.width_m, thickness),
            (&mut segment.height_m, thickness),
        ] {
            let factor = libm::exp(RESIZE * crate::rng::normal(rng)) as f32;
            *size = (*size * factor).clamp(least, most);
        }
    }

    /// Returns the waves of a joint inserted behind the joint of a block, one step further in the rhythm of the body.
    fn joint_behind(&self, place: usize) -> Option<JointWaves> {
        let joints = &self.waves.joints;
        let Some(own) = place.checked_sub(1) else { return self.joint_before_head() };
        let pair = match (joints.get(own + 1), own.checked_sub(1)) {
            (Some(next), _) => Some([joints.get(own)?, next]),
            (None, Some(previous)) => Some([&joints[previous], joints.get(own)?]),
            (None, None) => None,
        };
        Some(moved_on(joints.get(own)?, pair, 1.0))
    }

    /// Returns the waves of a joint in front of the first joint, one step back in the rhythm of the body.
    fn joint_before_head(&self) -> Option<JointWaves> {
        let joints = &self.waves.joints;
        let pair = joints.get(1).map(|second| [&joints[0], second]);
        Some(moved_on(joints.first()?, pair, -1.0))
    }

    /// Returns the greatest offsets about the bend and the twist axes, in rad for gaits and in N·m for torque waves.
    fn offset_ranges(&self) -> [f32; 2] {
        let wave = &self.space.wave;
        if self.space.controller == crate::genome::ControllerKind::Gait {
            [wave.angle_range_rad, wave.twist_range_rad]
        } else {
            [self.space.torque_range_nm; 2]
        }
    }
}

/// Returns a joint's waves, shifted by the lag from the first to the second joint of a pair. `direction` is 1 or -1.
fn moved_on(joint: &JointWaves, pair: Option<[&JointWaves; 2]>, direction: f32) -> JointWaves {
    let mut moved = joint.clone();
    let Some([first, second]) = pair else { return moved };
    for (wave, first, second) in [
        (&mut moved.bend, &first.bend, &second.bend),
        (&mut moved.twist, &first.twist, &second.twist),
    ] {
        for ((harmonic, first), second) in
            wave.harmonics.iter_mut().zip(&first.harmonics).zip(&second.harmonics)
        {
            let lag = lag_rad(first.phase_rad, second.phase_rad);
            harmonic.phase_rad = turn(harmonic.phase_rad + direction * lag);
        }
    }
    moved
}

/// Returns the wave half way between two: with the means of offset and amplitude, and the phase half way along the shorter way round. A
/// mean of phasors would cancel opposite waves.
fn half_way(a: &Wave, b: &Wave) -> Wave {
    let mut wave = a.clone();
    wave.offset = (a.offset + b.offset) / 2.0;
    for ((harmonic, a), b) in wave.harmonics.iter_mut().zip(&a.harmonics).zip(&b.harmonics) {
        harmonic.amplitude = (a.amplitude + b.amplitude) / 2.0;
        harmonic.phase_rad = turn(a.phase_rad + lag_rad(a.phase_rad, b.phase_rad) / 2.0);
    }
    wave
}

/// Returns the lag from one phase to another by the shorter way round, from -π to π.
fn lag_rad(from: f32, to: f32) -> f32 {
    turn(to - from + PI) - PI
}

/// Wraps a phase to the range from 0 to less than a full turn.
fn turn(phase_rad: f32) -> f32 {
    phase_rad - TAU * libm::floorf(phase_rad / TAU)
}

fn add_offset(wave: &mut Wave, by: f32, range: f32) {
    wave.offset = (wave.offset + by).clamp(-range, range);
}

#[cfg(test)]
mod tests;
