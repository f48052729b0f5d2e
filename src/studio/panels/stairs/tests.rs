//! Tests of the Stairs panel.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use super::*;
use crate::studio::panels::testing::{click, press, shows};
use crate::studio::state::current_run::prepared_run;
use crate::studio::state::plan_commands::borrowed;
use crate::studio::ui::theme;
use snakes_core::genome::StairsClass;

/// State of a test: a next run, the panel, and the commands that it sent.
struct Editing {
    run: CurrentRun,
    panel: StairsPanel,
    commands: Vec<Command>,
}

type Window = Harness<'static, Editing>;

/// Creates the panel for a next run with these stairs.
fn editing(stairs: &Stairs, width: f32) -> Window {
    let mut run = prepared_run();
    set(&mut run, stairs);
    let draw = |ui: &mut egui::Ui, of: &mut Editing| {
        theme::apply(ui.ctx());
        of.panel.ui(ui, &of.run, &UndoHistory::default(), None);
        let commands = Command::take_sent(ui);
        for command in &commands {
            if let Command::Plan(PlanCommand::SetFields(changes)) = command {
                of.run.set_fields(&borrowed(changes)).expect("allowed");
            }
        }
        of.commands.extend(commands);
    };
    let state = Editing { run, panel: StairsPanel::default(), commands: Vec::new() };
    let mut window = Harness::builder()
        .with_size(egui::vec2(width, 1200.0))
        .with_step_dt(1.0 / 60.0)
        .build_ui_state(draw, state);
    window.run();
    window
}

fn set(run: &mut CurrentRun, stairs: &Stairs) {
    if let Some(Command::Plan(PlanCommand::SetFields(changes))) =
        replacement(run.next_settings(), stairs)
    {
        run.set_fields(&borrowed(&changes)).expect("allowed");
    }
}

fn stairs(window: &Window) -> Stairs {
    window.state().run.next_settings().trial.stairs.clone()
}

fn house() -> Stairs {
    Stairs { tread_m: 0.8.into(), ..Stairs::default() }
}

fn centre(window: &Window, name: &str) -> egui::Pos2 {
    window.get_by_label(name).rect().center()
}

/// Drags the element with this name by some points, in many small steps, and lets the pointer rest before it is released.
fn drag(window: &mut Window, name: &str, by: egui::Vec2) {
    let from = centre(window, name);
    window.hover_at(from);
    window.run_steps(2);
    window.drag_at(from);
    window.run_steps(2);
    for share in 1_u8..=8 {
        window.hover_at(from + by * (f32::from(share) / 8.0));
        window.run_steps(1);
    }
    window.run_steps(20);
    window.drop_at(from + by);
    window.run_steps(3);
}

#[test]
fn a_dragged_edge_moves_one_step_and_is_one_change() {
    let mut window = editing(&house(), theme::PANEL_WIDTH);
    let points_per_m =
        (centre(&window, "Edge of step 3").x - centre(&window, "Edge of step 2").x) / 0.8;
    drag(&mut window, "Edge of step 3", egui::vec2(0.2, -0.3) * points_per_m);
    let expected = house().with_handle_at(2, [3.0 + 1.6 + 0.2, 1.5 + 0.3]);
    assert_eq!(stairs(&window), expected);
    let changes = window.state().commands.iter();
    let sent = changes.filter(|of| matches!(of, Command::Plan(PlanCommand::SetFields(_))));
    assert_eq!(sent.count(), 1, "one step to undo");
    assert!(window.state().panel.draft.is_none());
}

#[test]
fn the_first_and_the_last_edge_follow_a_pointer_that_rests() {
    for (edge, step, by_m) in
        [("Edge of step 1", 0, [-0.5, 0.0]), ("Edge of step 10", 9, [0.0, 0.3])]
    {
        let mut window = editing(&house(), theme::PANEL_WIDTH);
        let [a, b] = ["Edge of step 2", "Edge of step 3"].map(|name| centre(&window, name));
        let points_per_m = (b.x - a.x) / 0.8;
        drag(&mut window, edge, egui::vec2(by_m[0], -by_m[1]) * points_per_m);
        let [y_m, z_m] = house().handle_m(step);
        let expected = house().with_handle_at(step, [y_m + by_m[0], z_m + by_m[1]]);
        assert_eq!(stairs(&window), expected, "{edge}");
    }
}

#[test]
fn a_click_on_an_edge_changes_nothing_and_escape_drops_a_drag() {
    let irregular = StairsClass::Irregular.of_seed(3).stairs();
    let mut window = editing(&irregular, theme::PANEL_WIDTH);
    let at = centre(&window, "Edge of step 3") + egui::vec2(3.0, 3.0);
    window.drag_at(at);
    window.run_steps(2);
    window.drop_at(at);
    window.run_steps(3);
    window.drag_at(at);
    window.run_steps(2);
    window.hover_at(at + egui::vec2(0.0, -10.0));
    window.run_steps(2);
    assert!(window.state().panel.draft.is_some(), "it is dragged");
    window.key_press(egui::Key::Escape);
    window.run_steps(2);
    window.drop_at(at + egui::vec2(0.0, -10.0));
    window.run_steps(3);
    assert_eq!(stairs(&window), irregular);
    assert_eq!(window.state().commands, []);
}

#[test]
fn an_edge_stays_where_a_further_move_is_not_allowed_and_the_panel_says_why() {
    let mut window = editing(&house(), theme::PANEL_WIDTH);
    let [from, next] = ["Edge of step 3", "Edge of step 4"].map(|name| centre(&window, name));
    // The edge is dragged beyond the edge behind it.
    drag(&mut window, "Edge of step 3", egui::vec2((next - from).x * 1.5, 0.0));
    let tread_m = stairs(&window).step_tread_m(2);
    assert!((0.1..0.3).contains(&tread_m), "{tread_m}");
    assert!(shows(&window, "Not possible: tread_m"));
    drag(&mut window, "Edge of step 3", egui::vec2(-10.0, 0.0));
    assert!(!shows(&window, "Not possible"));
}

#[test]
fn the_table_changes_copies_and_removes_steps() {
    let mut window = editing(&house(), theme::PANEL_WIDTH);
    click(&mut window, "Copy step 2");
    assert_eq!(stairs(&window), Stairs { steps: 11, ..house() });
    click(&mut window, "Remove step 11");
    assert_eq!(stairs(&window), house());
    click(&mut window, "Rise of step 2");
    window.event(egui::Event::Text("0.7".to_owned()));
    window.run();
    press(&mut window, egui::Key::Enter);
    assert_eq!(stairs(&window), house().with_step_rise(1, 0.7));
}

#[test]
fn the_last_step_can_be_removed_and_put_back() {
    let one = Stairs { steps: 1, ..house() };
    let mut window = editing(&one, theme::PANEL_WIDTH);
    click(&mut window, "Remove step 1");
    assert_eq!(stairs(&window).steps, 0);
    click(&mut window, "Add a step");
    assert_eq!(stairs(&window), one);
}

#[test]
fn random_stairs_are_those_of_the_next_seed_where_the_others_were() {
    let before = Stairs { first_riser_y_m: 4.0, landing_m: 30.0, ..house() };
    let mut window = editing(&before, theme::PANEL_WIDTH);
    for seed in [1, 2] {
        click(&mut window, "Next");
        let drawn = StairsClass::Irregular.of_seed(seed).stairs();
        let expected = Stairs { first_riser_y_m: 4.0, landing_m: 30.0, ..drawn };
        assert_eq!(stairs(&window), expected);
    }
}

#[test]
fn stairs_are_saved_under_a_suggested_name() {
    let mut window = editing(&house(), theme::PANEL_WIDTH);
    click(&mut window, "Save as…");
    press(&mut window, egui::Key::Enter);
    let saved = Command::Plan(PlanCommand::StoreStairs("my-stairs".to_owned()));
    assert_eq!(window.state().commands, [saved]);
}

#[test]
fn building_codes_are_compared_in_words() {
    let window = editing(&house(), theme::PANEL_WIDTH);
    assert!(shows(&window, "175 × 280 mm, 32° steep"));
    assert_eq!(window.query_all_by_label("rises and treads allowed").count(), 3);
    let steep = Stairs { rise_m: 0.7.into(), ..house() };
    let window = editing(&steep, theme::PANEL_WIDTH);
    assert!(shows(&window, "rise 1 is 245 mm, over 196"));
}

#[test]
fn nothing_is_wider_than_the_panel() {
    let long = Stairs { steps: 60, ..Stairs::default() };
    for stairs in [house(), Stairs::uneven(), Stairs { steps: 0, ..house() }, long] {
        for width in [theme::PANEL_WIDTH, 600.0] {
            let window = editing(&stairs, width);
            for step in 0..stairs.steps {
                let at = centre(&window, &format!("Edge of step {}", step + 1));
                assert!((0.0..=width).contains(&at.x), "{width}: step {step} at {at}");
            }
        }
    }
}
