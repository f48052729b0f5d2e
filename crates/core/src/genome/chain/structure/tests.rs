//! Tests of changes of the structure of a body.

use super::*;
use crate::genome::{ControllerKind, GenomeShape};
use crate::rng::{Purpose, stream};

const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 2.0 };

fn space() -> GenomeSpace {
    let mut space = GenomeSpace { controller: ControllerKind::Gait, ..GenomeSpace::default() };
    space.bodies.vary = true;
    space
}

fn rng(individual: u32) -> ChaCha8Rng {
    stream(7, 1, individual, Purpose::Mutation)
}

/// Returns a genome with the five blocks of the report, and a wave that runs down the body.
fn snake() -> Genome {
    let mut genome = space().random_genome_of_plain_body(SHAPE, &mut rng(0));
    for segment in &mut genome.body.segments {
        (segment.length_m, segment.width_m, segment.height_m) = (2.0, 1.0, 1.0);
        segment.density_kg_m3 = 2.5;
    }
    for (number, joint) in (0_u8..).zip(&mut waves(&mut genome).joints) {
        for wave in [&mut joint.bend, &mut joint.twist] {
            wave.offset = 0.2;
            wave.harmonics[0] = crate::genome::controllers::Harmonic {
                amplitude: 0.5,
                phase_rad: f32::from(number),
            };
        }
    }
    genome
}

fn waves(genome: &mut Genome) -> &mut Waves {
    waves_mut(&mut genome.controller).expect("a gait")
}

fn phases(genome: &mut Genome) -> Vec<f32> {
    waves(genome).joints.iter().map(|joint| joint.bend.harmonics[0].phase_rad).collect()
}

/// Returns the first genome with the change that satisfies `is_it`, found by trying random numbers.
fn changed(change: BodyChange, is_it: impl Fn(&Genome) -> bool) -> Genome {
    let parent = snake();
    let mut all = (0..200).filter_map(|i| space().with_body_change(&parent, change, &mut rng(i)));
    all.find(is_it).expect("one in 200")
}

fn assert_phases(genome: &mut Genome, expected: &[f32]) {
    let found = phases(genome);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    let is_near = |(found, expected): (&f32, &f32)| (found - expected).abs() < 1e-5;
    assert!(found.iter().zip(expected).all(is_near), "{found:?} instead of {expected:?}");
}

/// Returns a test of whether the new block is at this place.
fn is_new_at(place: usize) -> impl Fn(&Genome) -> bool {
    move |genome| genome.body.segments[place].id > 100
}

#[test]
fn halves_of_a_split_block_are_held_straight_and_equal_the_whole() {
    let mut split = changed(BodyChange::Split, is_new_at(3));
    let [front, rear] = [2, 3].map(|index| split.body.segments[index].clone());
    assert_eq!(Segment { id: front.id, ..rear }, front);
    assert!((front.length_m - 1.0).abs() < 1e-4 && (front.width_m - 1.0).abs() < 1e-4);
    let joint = waves(&mut split).joints[2].clone();
    assert_eq!((joint.bend.offset, joint.bend.harmonics[0].amplitude), (0.0, 0.0));
    assert_eq!(phases(&mut split), [0.0, 1.0, 0.0, 2.0, 3.0]);
    assert_eq!(split.body.block_ids().iter().filter(|id| **id > 100).count(), 1);
}

#[test]
fn a_copy_follows_in_the_rhythm_of_the_body() {
    let mut inside = changed(BodyChange::Duplicate, is_new_at(3));
    assert_phases(&mut inside, &[0.0, 1.0, 2.0, 2.0, 3.0]);
    let mut behind_tail = changed(BodyChange::Duplicate, is_new_at(5));
    assert_phases(&mut behind_tail, &[0.0, 1.0, 2.0, 3.0, 4.0]);
    let mut behind_head = changed(BodyChange::Duplicate, is_new_at(1));
    let back = std::f32::consts::TAU - 1.0;
    assert!((phases(&mut behind_head)[0] - back).abs() < 1e-5, "one lag before the first");
}

#[test]
fn an_inserted_block_is_the_mean_of_its_neighbours() {
    let mut inserted = changed(BodyChange::Insert, is_new_at(2));
    assert_phases(&mut inserted, &[0.0, 0.5, 1.0, 2.0, 3.0]);
    let wave = |phase_rad| Wave {
        offset: 0.0,
        harmonics: vec![crate::genome::controllers::Harmonic { amplitude: 1.0, phase_rad }],
    };
    let between = half_way(&wave(0.2), &wave(TAU - 0.2));
    assert!(between.harmonics[0].phase_rad.min(TAU - between.harmonics[0].phase_rad) < 1e-5);
    assert_eq!(between.harmonics[0].amplitude, 1.0, "opposite waves do not cancel");
}

#[test]
fn the_joints_beside_a_removed_block_share_its_offset() {
    let mut removed = changed(BodyChange::Remove, |genome| genome.body.block_ids() == [1, 2, 4, 5]);
    assert_eq!(phases(&mut removed), [0.0, 2.0, 3.0]);
    let offsets: Vec<f32> = waves(&mut removed).joints.iter().map(|of| of.bend.offset).collect();
    assert_eq!(offsets, [0.3, 0.3, 0.2]);
    let mut headless =
        changed(BodyChange::Remove, |genome| genome.body.block_ids() == [2, 3, 4, 5]);
    assert_eq!(phases(&mut headless), [1.0, 2.0, 3.0]);
}

#[test]
fn merging_undoes_a_split() {
    let split = changed(BodyChange::Split, is_new_at(3));
    let merged = (0..200).filter_map(|individual| {
        space().with_body_change(&split, BodyChange::Merge, &mut rng(individual))
    });
    let mut merged = merged.into_iter().find(|genome| genome.body.block_ids() == [1, 2, 3, 4, 5]);
    let merged = merged.as_mut().expect("one in 200");
    assert_eq!(phases(merged), phases(&mut snake()));
    for (merged, own) in merged.body.segments.iter().zip(&snake().body.segments) {
        assert!((merged.length_m - own.length_m).abs() < 1e-4, "{merged:?}");
    }
}

#[test]
fn the_same_change_of_the_same_body_has_the_same_id_everywhere() {
    let [first, second] =
        [0, 1].map(|_| changed(BodyChange::Duplicate, is_new_at(3)).body.block_ids());
    assert_eq!(first, second);
    let mut twice = changed(BodyChange::Duplicate, is_new_at(3));
    twice = space().with_body_change(&twice, BodyChange::Split, &mut rng(3)).expect("room");
    let mut all = twice.body.block_ids();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), 7);
}

#[test]
fn children_keep_the_volume_and_every_limit_over_100_000_mutations() {
    let space = space();
    let mut genome = snake();
    let mut counts = [0; 13];
    let mut worst = 0.0_f64;
    for individual in 0..100_000 {
        let mut rng = rng(individual);
        let change = BodyChange::draw(&mut rng);
        let changed = change.and_then(|change| space.with_body_change(&genome, change, &mut rng));
        genome = changed.unwrap_or_else(|| space.with_small_changes(&genome, 0.08, &mut rng));
        let segments = &genome.body.segments;
        genome.body.check().expect("a body that can be built");
        assert_eq!(genome.controller.joints(), segments.len() - 1);
        space.check_genome(&genome, SHAPE).expect("within every limit of the space");
        let volume_m3: f64 = segments.iter().map(Segment::volume_m3).sum();
        worst = worst.max((volume_m3 - 10.0).abs());
        counts[segments.len()] += 1;
    }
    assert!(worst <= 0.01, "{worst} m³ off");
    // The walk reaches every number of blocks, so no operator dominates so much that the others cannot compensate.
    assert!(counts[2..].iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn a_child_of_two_bodies_has_the_blocks_of_the_fitter_and_genes_of_both() {
    let space = space();
    let fitter = changed(BodyChange::Split, is_new_at(3));
    let mut other = snake();
    for segment in &mut other.body.segments {
        segment.strength = 0.5;
    }
    waves(&mut other).frequency_hz = 2.5;
    let (mut strengths, mut frequencies) = (0, 0);
    for individual in 0..100 {
        let mut child = space.with_crossed_bodies(&fitter, &other, &mut rng(individual));
        assert_eq!(child.body.block_ids(), fitter.body.block_ids());
        assert!(space.bodies.is_within_limits(&child.body.segments));
        assert_ne!(child.body.segments[3].strength, 0.5, "only the fitter has it");
        strengths += usize::from(child.body.segments[2].strength == 0.5);
        frequencies += usize::from(waves(&mut child).frequency_hz == 2.5);
    }
    assert!((30..70).contains(&strengths) && (30..70).contains(&frequencies));
}

#[test]
fn random_bodies_keep_every_limit_and_return_from_their_points() {
    let space = space();
    let mut counts = [0; 13];
    for individual in 0..2000 {
        let genome = space.random_genome(SHAPE, &mut rng(individual));
        let segments = &genome.body.segments;
        counts[segments.len()] += 1;
        space.check_genome(&genome, SHAPE).expect("one of this space");
        let shape = GenomeShape { joints: segments.len() - 1, ..SHAPE };
        let again = space.genome_at(&space.point_of(&genome), shape);
        for (again, own) in again.body.segments.iter().zip(segments) {
            assert!((again.length_m - own.length_m).abs() < 0.01, "{again:?} and {own:?}");
        }
    }
    assert!(counts[2..].iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn the_change_of_a_child_is_recognised() {
    use BodyChange::{Duplicate, Insert, Merge, Remove, Split};
    let parent = snake();
    for change in [Duplicate, Split, Remove, Merge, Insert] {
        for individual in 0..20 {
            let child = space().with_body_change(&parent, change, &mut rng(individual));
            let child = child.expect("the snake allows each change");
            assert_eq!(BodyChange::between(&parent, &child), Some(change), "{}", change.name());
        }
    }
    assert_eq!(BodyChange::between(&parent, &parent), None);
    let resized = changed(BodyChange::Resize, |_| true);
    assert_eq!(BodyChange::between(&parent, &resized), None, "the structure is the same");
}
