//! Menus, settings and charts with real mouse and keys.

use super::display::Studio;

#[test]
fn a_slider_starts_a_what_if_and_can_be_undone_and_redone() {
    let Some(studio) = Studio::open("slider", "--preset quick") else { return };
    studio.pause_evolution();
    studio.open_panel("Change");
    let before = studio.value_of("TextInput", "Friction");
    studio.drag_slider("Friction", 0.25);
    studio.wait_for_title("showing climber with a what-if copy");
    let after = studio.value_of("TextInput", "Friction");
    assert_ne!(before, after);
    studio.step_aside();
    studio.key("ctrl+z");
    studio.wait_for_value("TextInput", "Friction", &before);
    studio.wait_for_title_without("what-if");
    studio.key("ctrl+shift+z");
    studio.wait_for_value("TextInput", "Friction", &after);
    studio.wait_for_title("showing climber with a what-if copy");
}

#[test]
fn clicking_a_point_or_bar_of_a_chart_replays_it() {
    let Some(studio) = Studio::open("charts", "--preset quick") else { return };
    studio.wait_for_title("4 of 4 generations, finished");
    studio.open_panel("Charts");
    let chart = studio.place("Chart: Fitness by generation").area;
    for generation in [3, 2] {
        // The axis spans six generations and a margin.
        let share = (f64::from(generation) - 0.8) / 5.4;
        studio.click_at(chart.at(share, 0.4));
        studio.wait_for_title(&format!("showing generation {generation}"));
    }
    studio.click_label("Spread");
    let chart = studio.place_where("the spread", |place| {
        place.label.starts_with("Chart: ") && !place.label.contains("Fitness by generation")
    });
    // Clicks along the bottom search for a bar. All bars belong to the latest generation.
    let is_shown = (1..24).any(|column| {
        studio.click_at(chart.area.at(f64::from(column) / 24.0, 0.985));
        studio.title().contains("showing generation 4")
    });
    assert!(is_shown, "no bar was met: {}", studio.title());
    studio.click_label("Ancestors");
    studio.place_with("Chart: Ancestors");
}

#[test]
fn search_settings_can_change_during_a_run() {
    let Some(studio) = Studio::open("during-run", "--preset quick --generations 1000") else {
        return;
    };
    studio.wait_for_title("running");
    studio.fold("Method of evolution");
    studio.type_into("Generations", "2000");
    studio.wait_for_title("of 2000 generations, running");
    studio.place("1 setting changed during the run");
    studio.type_into("Mutation range, N·m", "50");
    studio.place("2 settings changed during the run");
    let now = studio.generations();
    studio.wait_for_generations(now + 2);
}
