//! Worlds of lanes in the contexts of bevy_rapier3d.

use bevy_rapier3d::prelude::{
    RapierContextColliders, RapierContextJoints, RapierContextSimulation, RapierRigidBodySet,
};

use super::super::staged_world::StagedWorld;
use super::*;
use snakes_core::world::{PhysicsEngine, Surface};

const ENGINES: [PhysicsEngine; 2] = [PhysicsEngine::Rapier, PhysicsEngine::Lanes];

/// Returns the shipped champion, simulated by an engine on soft ground, which is a separate body in rapier.
fn shipped_in(engine: PhysicsEngine) -> LoadedChampion {
    let mut loaded = shipped();
    let trial = &mut loaded.champion.trial;
    trial.physics.engine = engine;
    trial.ground = Some(Surface { soft_cfm_m_s_per_n: 1.0e-4, ..trial.surface.clone() });
    loaded
}

#[test]
fn a_context_holds_what_the_engine_sees_at_the_place_of_its_lane() {
    for engine in ENGINES {
        let mut app = stage_of(vec![shipped_in(engine); 2]);
        play(&mut app, &[0.1], |lane| lane.replay.step() > 60);
        let world = app.world_mut();
        let mut worlds = world.query::<StagedWorld>();
        worlds.iter_mut(world).for_each(|mut held| held.hold_last_step());
        let mut held = world.query::<(
            &Lane,
            &RapierContextSimulation,
            &RapierRigidBodySet,
            &RapierContextColliders,
            &RapierContextJoints,
        )>();
        for (lane, context, bodies, colliders, joints) in held.iter(world) {
            let simulation = lane.replay.simulation().expect("simulated");
            let world = simulation.in_rapier();
            let physics = world.physics();
            let on_stage =
                |pose: &Pose| Pose { translation: pose.translation + lane.offset(), ..*pose };
            for (&part, pose) in world.bodies().iter().zip(lane.replay.poses()) {
                let body = &bodies.bodies[part];
                let collider = &colliders.colliders[body.colliders()[0]];
                assert_eq!([body.position(), collider.position()], [&on_stage(pose); 2]);
            }
            for (handle, fixed) in physics.colliders.iter() {
                let held = &colliders.colliders[handle];
                let is_fixed = fixed.parent().is_none();
                assert!(!is_fixed || *held.position() == on_stage(fixed.position()));
            }
            assert_eq!(joints.impulse_joints.len(), 4);
            let touching = physics.narrow_phase.contact_pairs().count();
            assert_eq!(context.narrow_phase.contact_pairs().count(), touching);
            assert_eq!(touching > 0, engine == PhysicsEngine::Rapier, "{touching} pairs");
        }
    }
}

#[test]
fn a_ray_hits_the_parts_the_steps_and_the_ground_of_its_lane() {
    for loaded in ENGINES.map(shipped_in).into_iter().chain([recorded()]) {
        let mut app = stage_of(vec![loaded; 2]);
        play(&mut app, &[0.1, 0.0137], |lane| lane.replay.step() > 60);
        let world = app.world_mut();
        let mut worlds = world.query::<StagedWorld>();
        for mut world in worlds.iter_mut(world) {
            let lane = world.lane;
            let mut hit = |from_m: Vec3, towards: Vec3| {
                let direction = Dir3::new(towards).expect("a direction");
                world.cast_ray(Ray3d::new(from_m + lane.offset(), direction)).expect("a surface")
            };
            for (part, (pose, plan)) in lane.drawn_poses().zip(&lane.body.parts).enumerate() {
                let above_m = pose * (Vec3::Z * (plan.height_m / 2.0 + 0.1));
                let seen = hit(above_m, pose.rotation * Vec3::NEG_Z);
                assert_eq!(seen.part, Some(part));
                assert!((seen.distance_m - 0.1).abs() < 1.0e-3, "{}", seen.distance_m);
            }
            let stairs = &lane.trial().stairs;
            for y_m in [stairs.end_y_m() - 1.0, stairs.first_riser_y_m + 0.5, -20.0] {
                let seen = hit(Vec3::new(0.0, y_m, 20.0), Vec3::NEG_Z);
                let z_m = 20.0 - seen.distance_m;
                assert_eq!(seen.part, None);
                assert!((z_m - stairs.surface_z_m(0.0, y_m)).abs() < 1.0e-3, "{z_m} at {y_m}");
            }
        }
    }
}

#[test]
fn a16_lines_show_the_shapes_of_no_ghost_even_after_a_ray_was_cast() {
    let mut app = stage_of(vec![shipped()]);
    play(&mut app, &[0.1], |lane| lane.replay.step() > 6);
    let ghost = Lane::ghost(lane(&mut app).staged.clone(), 1);
    app.world_mut().spawn(ghost);
    let world = app.world_mut();
    let mut worlds = world.query::<StagedWorld>();
    for mut world in worlds.iter_mut(world) {
        assert!(world.cast_ray(Ray3d::new(Vec3::Z * 9.0, Dir3::NEG_Z)).is_some());
        world.hold_for_lines();
    }
    let mut held = world.query::<(&Lane, &RapierContextColliders, &RapierRigidBodySet)>();
    for (lane, colliders, bodies) in held.iter(world) {
        assert_eq!(colliders.colliders.is_empty(), lane.is_ghost);
        assert_eq!(bodies.bodies.is_empty(), lane.is_ghost);
    }
}

#[test]
fn contexts_and_rays_leave_the_bits_of_a_replay_alone() {
    for engine in ENGINES {
        let loaded = shipped_in(engine);
        let headless = evaluate(&loaded.champion.genome, &loaded.champion.trial);
        let mut app = stage_of(vec![loaded]);
        app.add_systems(PostUpdate, |mut worlds: Query<StagedWorld>| {
            for mut world in &mut worlds {
                world.hold_last_step();
                assert!(world.cast_ray(Ray3d::new(Vec3::Z * 9.0, Dir3::NEG_Z)).is_some());
            }
        });
        play(&mut app, &[0.1], is_over);
        assert_eq!(lane(&mut app).evaluation(), headless, "{engine:?}");
    }
}
