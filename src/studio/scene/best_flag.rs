//! A flag at the best distance of the run.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;

use super::meshes::{BALL_SIDES, to_mesh};
use super::props::{Props, piece};
use super::text::{TextMeshes, TextPlacement};
use crate::studio::stage::lane::{AT_THE_TOP, Lane};
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::decimals::decimals;
use snakes_core::evolve::Champion;
use snakes_core::score::arrived_y_m;
use snakes_core::world::Stairs;
use snakes_lab::mesh::MeshBuilder;

/// Marks the entities of a flag.
#[derive(Component)]
pub(super) struct Flag;

/// Height of the flag's post, in metres: the flag is above the snake.
const POST_M: f32 = 2.3;
/// Radius of the flag's post, in metres.
const POST_RADIUS_M: f32 = 0.035;
/// Distance of the post from the left edge of the stairs, in metres. Seen from the right, the post is behind the snake.
const ASIDE_M: f32 = 0.2;
/// Height of the flag's cloth and of its digits, in metres.
const CLOTH_M: f32 = 0.62;
const DIGIT_M: f32 = 0.27;
/// Half the thickness of the flag's cloth, in metres.
const CLOTH_HALF_M: f32 = 0.012;

/// Spawns the flag on the first lane, and removes outdated flags.
pub(super) fn plant(
    run: Option<Res<CurrentRun>>,
    lanes: Query<(Entity, Ref<Lane>)>,
    flags: Query<Entity, With<Flag>>,
    (props, lettering): (Res<Props>, Res<TextMeshes>),
    mut planted: Local<Option<(f32, u32)>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    let Some(run) = run else { return };
    let champions = run.reports.iter().filter_map(|report| report.champion.as_ref());
    let reached_m = |champion: &&Champion| champion.evaluation.centre_y_m;
    let best = champions.max_by(|a, b| reached_m(a).total_cmp(&reached_m(b)));
    let place = best.as_ref().map(|champion| (reached_m(champion), run.number));
    let is_new = *planted != place;
    if is_new {
        *planted = place;
        flags.iter().for_each(|flag| commands.entity(flag).despawn());
    }
    let Some((best, (y_m, run))) = best.zip(place) else { return };
    for (entity, lane) in lanes.iter().filter(|(_, lane)| is_marked(lane, run)) {
        if !is_new && !lane.is_added() {
            continue;
        }
        let text = sign(best);
        let width_m = lettering.width_m(&text, DIGIT_M) + CLOTH_M - DIGIT_M;
        let middle = Vec3::new(0.0, width_m / 2.0, POST_M - CLOTH_M / 2.0);
        let mut writing = lettering.begin();
        for side in [1.0, -1.0] {
            // The text is on both sides, for cameras on the right, which is usual, and on the left.
            let right = if side > 0.0 { Dir3::Y } else { Dir3::NEG_Y };
            let middle = middle + Vec3::X * side * (CLOTH_HALF_M + 0.006);
            writing.text(&text, DIGIT_M, TextPlacement { middle, right, up: Dir3::Z });
        }
        let place = Transform::from_translation(foot(&lane.trial().stairs, y_m));
        let (mut post, mut cloth) = (MeshBuilder::default(), MeshBuilder::default());
        post.cylinder(Vec3::ZERO, Vec3::Z * POST_M, POST_RADIUS_M);
        post.ball(Vec3::Z * POST_M, POST_RADIUS_M * 2.0, BALL_SIDES);
        let size = Vec3::new(CLOTH_HALF_M * 2.0, width_m, CLOTH_M);
        cloth.rounded_box(middle, size, CLOTH_HALF_M, 1);
        let [post, cloth] = [post, cloth].map(|solid| meshes.add(to_mesh(solid)));
        let text = piece(&meshes.add(writing.into_mesh()), &lettering.on_flag);
        let post = (Flag, place, piece(&post, &props.post), ChildOf(entity));
        let mut post = commands.spawn(post);
        post.with_child(piece(&cloth, &props.cloth)).with_child((text, NotShadowCaster));
    }
}

/// Returns the text of the flag for the champion that got furthest: its distance, unless the whole snake is on the landing,
/// where its fitness no longer grows.
fn sign(best: &Champion) -> String {
    let Champion { evaluation, trial, genome, .. } = best;
    let arrived_y_m = || arrived_y_m(&trial.stairs, &trial.agent.body_plan(genome));
    match evaluation.is_on_landing(&trial.stairs) && evaluation.centre_y_m >= arrived_y_m() {
        true => AT_THE_TOP.to_owned(),
        false => format!("furthest {} m", decimals(evaluation.centre_y_m, 1)),
    }
}

/// Returns whether a lane has the flag of the run with this index: the first lane, which is nearest to the camera, if its
/// snake is of this run.
fn is_marked(lane: &Lane, run: u32) -> bool {
    let is_of_run = lane.staged.source() == ChampionSource::Run(run);
    lane.number == 0 && !lane.is_ghost && is_of_run
}

/// Returns the base of the flag's post: at the left edge of the stairs, on their surface.
fn foot(stairs: &Stairs, y_m: f32) -> Vec3 {
    let x_m = ASIDE_M - stairs.width_m / 2.0;
    Vec3::new(x_m, y_m, stairs.surface_z_m(x_m, y_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::staged_champion::StagedChampion;
    use crate::studio::state::current_run::climber;

    #[test]
    fn the_flag_stands_on_the_surface_below_it() {
        let stairs = Stairs::default();
        for (y_m, z_m) in [(-7.0, 0.0), (3.5, 0.5), (21.3, 5.0), (30.0, 5.0), (60.0, 0.0)] {
            assert_eq!(foot(&stairs, y_m).z, z_m, "at {y_m}");
        }
    }

    #[test]
    fn the_flag_tells_a_distance_until_the_whole_snake_is_on_the_landing() {
        let mut champion = climber(0).champion().clone();
        for (y_m, text) in [(34.1, "at the top"), (26.01, "at the top"), (25.9, "furthest 25.9 m")]
        {
            champion.evaluation.centre_y_m = y_m;
            assert_eq!(sign(&champion), text);
        }
        champion.trial.stairs.steps += 1;
        champion.evaluation.centre_y_m = 34.1;
        assert_eq!(sign(&champion), "furthest 34.1 m", "it stands on a lower step");
    }

    #[test]
    fn a20_the_flag_stands_only_beside_a_snake_of_the_run_that_it_tells_of() {
        let saved = climber(0);
        let of_run = |run| StagedChampion::from_run(saved.champion(), run);
        let ghost = Lane::ghost(of_run(3), 0);
        let is_marked = |lane: &Lane| is_marked(lane, 3);
        assert!(is_marked(&Lane::new(of_run(3), 0)) && !is_marked(&Lane::new(of_run(3), 1)));
        assert!(!is_marked(&Lane::new(of_run(2), 0)) && !is_marked(&Lane::new(saved.clone(), 0)));
        assert!(!is_marked(&ghost));
    }
}
