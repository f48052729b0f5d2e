//! Layouts for windows of several sizes, as text, and after panels were chosen.

use super::*;
use egui_dock::{Node, NodePath};

fn laid_out(width: f32) -> Layout {
    let mut layout = Layout::default();
    layout.state_in(egui::vec2(width, width * 9.0 / 16.0), true);
    layout
}

#[test]
fn the_default_layout_has_every_panel_once_at_any_width() {
    for width in [640.0, 1280.0, 2560.0] {
        let layout = laid_out(width);
        assert!(PanelKind::INITIAL.iter().all(|kind| layout.has(*kind)), "{width}");
        assert!(!layout.has(PanelKind::Machines), "opens on demand");
        assert!(is_sound(&layout.state), "{width}");
    }
}

#[test]
fn closed_panels_can_be_restored_and_the_stage_cannot_be_closed() {
    let mut layout = laid_out(1280.0);
    for &kind in PanelKind::IN_MENU {
        layout.close(kind);
        assert!(!layout.has(kind));
    }
    layout.close(PanelKind::Stage);
    assert!(layout.has(PanelKind::Stage));
    for &kind in PanelKind::IN_MENU {
        layout.open(kind);
        assert!(layout.has(kind));
    }
    assert!(is_sound(&layout.state));
}

#[test]
fn a2_further_panels_open_as_tabs_beside_those_of_their_side_and_never_below_them() {
    for (width, tabs) in [(1280.0, vec![7]), (1920.0, vec![7, 1])] {
        let mut layout = laid_out(width);
        for kind in [PanelKind::Machines, PanelKind::Body, PanelKind::Stairs] {
            layout.open(kind);
            assert!(layout.front_panels().contains(&kind), "{kind:?} at {width}");
        }
        let leaves = layout.state.iter_leaves().filter(|(_, leaf)| leaf.tabs != [PanelKind::Stage]);
        let mut found: Vec<usize> = leaves.map(|(_, leaf)| leaf.tabs.len()).collect();
        found.sort_by_key(|count| std::cmp::Reverse(*count));
        assert_eq!(found, tabs, "{width}");
        assert!(is_sound(&layout.state), "{width}");
    }
}

#[test]
fn tabs_that_do_not_fit_replace_those_that_were_chosen_longest_ago() {
    let size = egui::vec2(1280.0, 720.0);
    let mut layout = laid_out(1280.0);
    let demanded = [PanelKind::Charts, PanelKind::Senses, PanelKind::Charts, PanelKind::Champions];
    for kind in demanded.into_iter().chain([PanelKind::Body]) {
        layout.open(kind);
        layout.state_in(size, true);
    }
    let width_of_tab = LEFT / 6.5;
    layout.fit_tabs(|kinds| kinds.len() as f32 * width_of_tab);
    assert!(layout.has(PanelKind::Senses), "a bar that is not drawn has no width");
    for (_, leaf) in layout.state.iter_leaves_mut() {
        leaf.set_rect(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(LEFT, 600.0)));
    }
    layout.fit_tabs(|kinds| kinds.len() as f32 * width_of_tab);
    let tabs = layout.tab_bars().pop().expect("a bar").1;
    assert_eq!(tabs[..4], *PanelKind::INITIAL);
    assert_eq!(tabs[4..], [PanelKind::Champions, PanelKind::Body]);
    layout.fit_tabs(|_| f32::INFINITY);
    let tabs = layout.tab_bars().pop().expect("a bar").1;
    assert_eq!(tabs[4..], [PanelKind::Body], "the panel in front stays");
}

#[test]
fn a_tab_is_offered_beside_the_others_while_it_is_useful_and_stays_once_it_was_chosen() {
    let mut layout = laid_out(1280.0);
    let size = egui::vec2(1280.0, 720.0);
    let tabs = |layout: &Layout| layout.tab_bars().pop().expect("a bar").1;
    layout.offer(PanelKind::Senses, true);
    layout.state_in(size, true);
    assert_eq!(tabs(&layout)[4..], [PanelKind::Senses], "beside the four others");
    assert!(layout.front_panels().contains(&PanelKind::Run), "the same panel is in front");
    layout.close(PanelKind::Senses);
    layout.offer(PanelKind::Senses, true);
    assert!(!layout.has(PanelKind::Senses), "the user has closed it");
    for is_chosen in [false, true] {
        layout.offer(PanelKind::Senses, false);
        layout.offer(PanelKind::Senses, true);
        if is_chosen {
            layout.open(PanelKind::Senses);
            layout.state_in(size, true);
        }
        layout.offer(PanelKind::Senses, false);
        assert_eq!(layout.has(PanelKind::Senses), is_chosen);
    }
    assert!(is_sound(&layout.state));
}

#[test]
fn a_wider_window_widens_the_stage_but_not_the_panels() {
    let left = |layout: &Layout| {
        let path = layout.state.find_tab(&PanelKind::Run).expect("there");
        let root = layout.state.main_surface().root_node().expect("a root");
        let Node::Horizontal(split) = root else { panic!("split") };
        assert_eq!(path.node, NodeIndex(1));
        split.fraction
    };
    let mut layout = laid_out(1280.0);
    assert!((left(&layout) * 1280.0 - LEFT).abs() < 1.0);
    layout.state_in(egui::vec2(1490.0, 790.0), true);
    assert!((left(&layout) * 1490.0 - LEFT).abs() < 1.0);
}

#[test]
fn the_default_layout_follows_the_window_and_keeps_the_panel_in_front() {
    let columns = |layout: &Layout| layout.state.iter_leaves().count();
    let mut layout = Layout::default();
    layout.state_in(egui::vec2(1280.0, 720.0), true);
    layout.open(PanelKind::World);
    assert_eq!(columns(&layout), 2);
    layout.state_in(egui::vec2(1920.0, 1080.0), true);
    assert_eq!(columns(&layout), 3, "stage, champions and the other panels");
    assert!(layout.front_panels().contains(&PanelKind::World));
    // A layout that the user has arranged is kept.
    layout.close(PanelKind::Lessons);
    layout.state_in(egui::vec2(1280.0, 720.0), true);
    assert_eq!(columns(&layout), 3);
}

#[test]
fn the_chosen_panel_stays_in_front_after_the_window_was_enlarged_and_made_smaller() {
    let (small, large) = (egui::vec2(1024.0, 640.0), egui::vec2(1920.0, 1080.0));
    let mut layout = Layout::default();
    layout.state_in(small, true);
    layout.open(PanelKind::Library);
    layout.state_in(small, true);
    layout.open(PanelKind::World);
    layout.state_in(small, true);
    // A click on the stage takes the focus away.
    let (stage, _) = layout.state.find_main_surface_tab(&PanelKind::Stage).expect("there");
    layout.state.set_focused_node_and_surface(NodePath::new(SurfaceIndex::main(), stage));
    layout.state_in(small, true);
    for size in [large, small, large, small] {
        layout.state_in(size, true);
        assert!(
            layout.front_panels().contains(&PanelKind::World),
            "{size}: {:?}",
            layout.front_panels()
        );
    }
    layout.state_in(large, true);
    layout.open(PanelKind::Charts);
    layout.state_in(large, true);
    layout.state_in(small, true);
    assert!(layout.front_panels().contains(&PanelKind::Charts), "{:?}", layout.front_panels());
}

#[test]
fn a_panel_opened_before_the_window_has_a_size_gets_the_focus() {
    let mut layout = Layout::default();
    layout.open(PanelKind::Charts);
    layout.state_in(egui::vec2(1280.0, 720.0), true);
    assert!(layout.front_panels().contains(&PanelKind::Charts));
}

#[test]
fn a_layout_survives_as_text_and_invalid_text_is_rejected() {
    let mut layout = laid_out(1280.0);
    layout.close(PanelKind::Lessons);
    let again = Layout::from_text(&layout.to_text());
    assert!(!again.is_to_be_laid_out && !again.has(PanelKind::Lessons));
    assert!(again.has(PanelKind::Library));
    for text in ["", "(", "()", "(surfaces:[],focused_surface:None)"] {
        assert!(Layout::from_text(text).is_to_be_laid_out, "{text}");
    }
    let by_hand = layout.to_text().replace("fraction:0.3", "fraction:0.4");
    assert!(Layout::from_text(&by_hand).is_to_be_laid_out);
    let twice = layout.to_text().replace("Stage", "Lessons");
    let text = twice.split_once(' ').expect("sealed").1;
    assert!(Layout::from_text(&format!("{} {text}", seal(text))).is_to_be_laid_out);
}
