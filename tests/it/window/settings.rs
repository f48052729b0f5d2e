//! Preferences of the window survive a restart.

use super::display::{Studio, preferences};
use super::places::Area;

#[test]
fn theme_scale_panels_and_overlays_survive_a_restart() {
    let folder = super::folder();
    let path = folder.path().join("studio.ron");
    std::fs::write(&path, preferences("tour_is_over: true")).expect("written");
    let saves = folder.path().join("saves");
    let arguments =
        format!("--preset quick --saves {} --preferences {}", saves.display(), path.display());
    let Some(studio) = Studio::open("settings", &arguments) else { return };
    studio.pause_evolution();
    let at_first = studio.place("Panel Watch").area;
    studio.key("t");
    studio.place_of("Button", "Light");
    studio.key("ctrl+plus");
    let is_larger = || studio.place("Panel Watch").area.height() > at_first.height();
    studio.wait(is_larger, || "larger panels".to_owned());
    studio.key("b");
    studio.open_panel("Charts");
    studio.step_aside();
    studio.key("ctrl+w");
    studio.wait_for_no("Panel Charts");
    let (tab, stage) = (studio.place("Panel Watch").area, studio.stage());
    assert_eq!(studio.quit(), Some(0));

    let studio = Studio::open("settings-again", &arguments).expect("it opened before");
    studio.place_of("Button", "Light");
    let are_back = || (studio.place("Panel Watch").area, studio.stage()) == (tab, stage);
    studio.wait(are_back, || format!("{tab:?} and {stage:?}"));
    assert!(studio.find(|place| place.label == "Panel Charts").is_none());
    let menu = Area { left: 2, top: 2, right: 22, bottom: 6 };
    studio.picture_with(|picture| picture.brightness(menu) < 90);
    studio.click_label("Show");
    studio.wait_for_value("CheckBox", "Trail", "on");
    assert_eq!(studio.value_of("CheckBox", "Contacts and forces"), "off");
    // The menu restores a closed panel.
    studio.key("Escape");
    studio.choose("Panels", "Charts");
    studio.place("Panel Charts");
}
