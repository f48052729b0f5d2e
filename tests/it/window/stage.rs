//! The stage with real mouse and keys: play, step, seek, race, what-if, pulls, cameras, overlays, pictures.

use super::display::Studio;
use super::picture::{Picture, difference, is_blue, is_red};
use super::places::Area;

/// Opens a studio with the saved champion paused at its start and evolution paused.
fn held_at_start(test: &str) -> Option<Studio> {
    let studio = Studio::open(test, "--preset quick --saves saves")?;
    studio.pause_evolution();
    studio.key("space");
    studio.wait_for_title(", stopped at ");
    studio.seek(0.0);
    studio.wait_for_title("stopped at 0.00 s");
    Some(studio)
}

#[test]
fn the_player_pauses_steps_and_seeks() {
    let Some(studio) = Studio::open("player", "--preset quick") else { return };
    studio.pause_evolution();
    studio.click_label("Pause playback");
    studio.wait_for_title(", stopped at ");
    studio.seek(0.5);
    // A pixel of the timeline stands for a few hundredths of a second.
    let is_there =
        || ["stopped at 7.4", "stopped at 7.5"].iter().any(|at| studio.title().contains(at));
    studio.wait(is_there, || format!("the middle of 15 s in {:?}", studio.title()));
    let middle = studio.held_at_s();
    let picture = studio.still_picture();
    studio.click_label("Previous step");
    studio.click_label("Previous step");
    let before = studio.held_at_s();
    assert!((0.015..0.035).contains(&(middle - before)), "{middle} to {before}");
    studio.key("Right");
    studio.key("Left");
    studio.click_label("Next step");
    studio.click_label("Next step");
    let again = studio.held_at_s();
    assert!((again - middle).abs() < 0.018, "{middle} and {again}");
    studio.seek(0.5);
    assert!((studio.held_at_s() - middle).abs() < 0.001);
    studio.picture_with(|now| difference(&picture, now) < 50);
    studio.key("End");
    studio.wait_for_title("stopped at 15.00 s");
    studio.click_label("Play from start");
    studio.wait_for_title_without("stopped");
    // The replay runs at four times the speed, without looping.
    studio.key("o");
    for _ in 0..4 {
        studio.key("plus");
    }
    studio.wait_for_title("stopped at 15.00 s");
}

#[test]
fn a_race_starts_by_key_or_click_and_ends_by_key() {
    let Some(studio) = Studio::open("race", "--preset quick") else { return };
    studio.wait_for_title("4 of 4 generations, finished");
    studio.key("n");
    studio.wait_for_title("showing a race of 4");
    studio.picture_with(|picture| picture.count(is_red) > 300 && picture.count(is_blue) > 300);
    studio.key("Escape");
    studio.wait_for_title("showing climber");
    // The race selects its best snake, from any generation.
    studio.key("n");
    studio.wait_for_title("showing a race of 4");
    studio.click_label("Only this one");
    studio.wait_for_title("showing generation ");
    studio.click_champion(0);
    studio.wait_for_title("showing climber");
    studio.shift_click_champion(1);
    studio.wait_for_title("showing a race of 2");
    studio.shift_click_champion(1);
    studio.wait_for_title("showing climber");
    studio.key("m");
    studio.wait_for_title("showing a race of 10");
}

#[test]
fn a_change_is_tried_from_the_present_moment_on_and_copies_stay_side_by_side() {
    let Some(studio) = Studio::open("what-if-moment", "--preset quick") else { return };
    studio.pause_evolution();
    studio.open_panel("Change");
    studio.key("0");
    studio.wait_for_title("showing climber");
    studio.seek(0.4);
    let rail = studio.scrolled_to("Slider", "Friction").area;
    // The copy exists already while the button is held.
    studio.drag_and_hold(1, rail.at(0.5, 0.5), rail.at(0.25, 0.5), || {
        studio.wait_for_title("showing climber with a what-if copy, from ");
    });
    let moment_s = || -> f64 {
        let title = studio.title();
        let (_, after) = title.split_once(", from ").expect("a moment");
        after.split(' ').next().and_then(|number| number.parse().ok()).expect("a number")
    };
    let first_s = moment_s();
    assert!(first_s > 1.0, "{}", studio.title());
    studio.key("space");
    studio.wait_for_title(", stopped at ");
    let title = studio.title();
    let stopped_s = title
        .split_once(", stopped at ")
        .and_then(|(_, after)| after.trim_end_matches(" s").parse::<f64>().ok());
    assert!(stopped_s.expect("a time") >= first_s, "the clock goes on from there: {title}");
    studio.click_label("Try another");
    studio.drag_slider("Friction", 0.7);
    studio.wait_for_title("with 2 what-if copies, from ");
    assert_eq!(moment_s(), first_s, "the same moment, although the clock went on");
    studio.key("Escape");
    studio.wait_for_title("with a what-if copy, from ");
    studio.key("Escape");
    studio.wait_for_title_without("what-if");
}

#[test]
fn clicking_a_limb_shows_its_numbers_and_dragging_disturbs_the_snake() {
    let Some(studio) = held_at_start("hands") else { return };
    let before = studio.still_picture();
    let limb = before.find(is_red).expect("a red limb");
    studio.click_at(limb);
    let with_card = studio.still_picture();
    // The card takes a free place of the stage.
    assert!(difference(&before, &with_card) > 10_000, "its numbers are shown");
    // The limb is grabbed while the stage is paused, and pulled once it moves.
    studio.drag_and_hold(1, limb, (limb.0 - 60, limb.1 - 90), || {
        studio.key("space");
        studio.wait_for_title(", pulled");
    });
    studio.key("r");
    studio.wait_for_title_without(", pulled");
}

#[test]
fn camera_modes_differ_and_follow_can_be_restored() {
    let Some(studio) = held_at_start("cameras") else { return };
    let follow = studio.still_picture();
    let mut before = studio.still_picture();
    for button in ["Side", "Top"] {
        studio.click_label(button);
        let now = studio.still_picture();
        assert!(difference(&before, &now) > 3000, "{button}");
        assert!(now.count(is_red) > 100, "{button} shows the snake");
        before = now;
    }
    studio.click_label("Free");
    let (x, y) = studio.stage().at(0.58, 0.8);
    studio.drag(1, (x, y), (x + 100, y - 20));
    let free = studio.still_picture();
    assert!(difference(&before, &free) > 2000, "a drag turns the free camera");
    studio.key("f");
    studio.picture_with(|now| difference(&follow, now) < 200);
    studio.key("c");
    studio.picture_with(|now| difference(&follow, now) > 3000);
    studio.key("Home");
    studio.picture_with(|now| difference(&follow, now) < 200);
    // A double click on the ground focuses there. From this near, the snake is large or out of the picture.
    studio.double_click_at(studio.stage().at(0.67, 0.55));
    studio.picture_with(|now| difference(&follow, now) > 20_000);
}

#[test]
fn each_overlay_can_be_shown_and_hidden() {
    let Some(studio) = held_at_start("overlays") else { return };
    studio.seek(0.5);
    let bare = studio.still_picture();
    for key in ["v", "j", "b", "l", "d"] {
        studio.key(key);
        studio.picture_with(|now| difference(&bare, now) > 100);
        studio.key(key);
        studio.picture_with(|now| difference(&bare, now) < 50);
    }
}

#[test]
fn the_theme_applies_to_panels_and_scene_and_pictures_are_saved() {
    let Some(studio) = held_at_start("theme") else { return };
    let stage = studio.stage();
    let panel = Area { left: 2, top: 2, right: 22, bottom: 6 };
    let sky = Area { left: stage.right - 60, top: stage.top + 100, ..stage };
    let sky = Area { right: sky.left + 20, bottom: sky.top + 6, ..sky };
    let both_are = |dark: bool| {
        let is_so = |now: &Picture, area: Area| (now.brightness(area) < 90) == dark;
        studio.picture_with(|now| is_so(now, panel) && is_so(now, sky));
    };
    both_are(false);
    studio.key("t");
    both_are(true);
    let pictures = studio.folder().join("saves/pictures");
    // Of three presses at once, one takes a picture: each picture that is being drawn makes the frames of a software driver longer.
    let presses: [(&[&str], &str); 2] = [
        (&["key", "p", "p", "p"], "snakes-and-stairs-1.png"),
        (&["key", "shift+p"], "snakes-and-stairs-2.png"),
    ];
    for (keys, name) in presses {
        studio.xdotool(keys);
        let path = pictures.join(name);
        studio.picture_with(|_| path.is_file());
        let bytes = std::fs::read(&path).expect("a picture");
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 15_000, "{name}");
    }
    studio.key("t");
    both_are(false);
    assert_eq!(std::fs::read_dir(&pictures).expect("a folder").count(), 2);
}

/// This test opens no window, but needs the same driver: it draws a moment without a display.
#[test]
fn a_moment_is_drawn_without_a_display() {
    if super::display::lacks_a_driver("export") {
        return;
    }
    let folder = super::folder();
    let saves = concat!(env!("CARGO_MANIFEST_DIR"), "/saves");
    for (arguments, name) in [
        (
            format!("export {saves}/climber.ron --at 3.5 --size 640x360 --camera side -o a.png"),
            "a.png",
        ),
        (
            format!(
                "export {saves}/fast.ron {saves}/thrifty.ron --size 640x360 --show trail --at end -o b.png"
            ),
            "b.png",
        ),
    ] {
        super::stdout_of(folder.path(), &arguments);
        let bytes = std::fs::read(folder.path().join(name)).expect(name);
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 15_000, "{name}");
    }
}
