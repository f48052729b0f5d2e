//! Tests of the Senses panel with snakes of several controllers.

use super::*;
use crate::studio::panels::testing::{
    self, Sent, assert_fits, assert_shows, click, clicked, random_snake, set, shows,
};
use egui_kittest::kittest::{NodeT, Queryable};
use snakes_core::genome::controllers::{POSTURES, Policy, SITUATION_BITS};
use snakes_core::genome::{ControllerGenes, Genome};
use snakes_core::learn::classifiers::{Zcs, ZcsSettings};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::library::load_entry;
use std::sync::Arc;

/// Creates a lane of a random snake with this controller, at 0.5 s, in a world with changed settings.
fn lane_of(
    kind: ControllerKind,
    fields: &[(&str, &str)],
    change: impl FnOnce(&mut Genome),
) -> Lane {
    let mut lane = Lane::new(random_snake(kind, fields, change), 0);
    lane.show(0.5, None, 3000).expect("healthy");
    lane
}

/// Creates the panel for a limb of a lane.
fn panel(lane: &Lane, limb: usize) -> Sent<'_> {
    panel_in_window(lane, limb, 1600.0)
}

/// Creates the panel in a window of this height, in points, in which it scrolls.
fn panel_in_window(lane: &Lane, limb: usize, height: f32) -> Sent<'_> {
    let mut panel = SensesPanel::default();
    testing::panel([320.0, height], move |ui| {
        theme::apply(ui.ctx());
        let view = SensesView {
            lane,
            limb,
            is_selected: limb > 0,
            racers: Vec::new(),
            switched: lane.trial().agent.senses,
        };
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        area.show(ui, |ui| panel.ui(ui, Some(&view), &StairsExams::default()));
    })
}

#[test]
fn the_readouts_of_the_chosen_limb_have_units_and_fit() {
    let lane = lane_of(ControllerKind::Modular, &[], |_| ());
    let panel_of = |limb| panel(&lane, limb);
    let head = panel_of(0);
    let senses = lane.replay.rollout().expect("simulated").perception();
    let gap_m = senses.limbs[0].gap * 2.0;
    assert!(shows(&head, "Block 1 of 5, the head"));
    let gap = if gap_m < 2.0 { format!("Gap: {gap_m:.2} m") } else { "Gap: ≥ 2.00 m".to_owned() };
    assert!(shows(&head, &gap), "{gap}");
    assert_shows(
        &head,
        &["Touch: ", "Load: ", "Yaw: ", "Speed ahead: ", "Joint 4 bend: ", "Click a block"],
    );
    assert!(!shows(&head, "frozen"));
    assert_fits(&head, 320.0);
    assert!(shows(&panel_of(4), "Block 5 of 5, the tail"));
}

#[test]
fn a_click_on_a_switch_tries_the_snake_without_that_sense() {
    let lane = lane_of(ControllerKind::Modular, &[], |_| ());
    for (name, field) in [("Sight", "sight"), ("Touch", "touch"), ("Balance", "balance")] {
        let mut panel = panel(&lane, 0);
        panel.get_by_role_and_label(egui::accesskit::Role::CheckBox, name).click();
        panel.run();
        assert_eq!(*panel.state(), [set(&format!("trial.agent.senses.{field}"), "false")]);
    }
}

#[test]
fn senses_that_do_not_work_are_marked_as_frozen() {
    let lane = lane_of(ControllerKind::Central, &[("trial.agent.senses.sight", "false")], |_| ());
    let panel = panel(&lane, 0);
    let frozen: Vec<String> = panel
        .query_all_by_label_contains("frozen")
        .filter_map(|node| node.accesskit_node().value())
        .collect();
    let starts = |name: &str| frozen.iter().any(|label| label.starts_with(name));
    assert!(starts("Gap") && starts("Step up") && starts("Clearance"), "{frozen:?}");
    assert!(!starts("Touch") && !starts("Pitch"), "{frozen:?}");
}

#[test]
fn a_snake_that_follows_only_its_genes_says_so() {
    for (kind, text) in
        [(ControllerKind::Gait, "feels only its joints"), (ControllerKind::Wave, "feels nothing")]
    {
        let lane = lane_of(kind, &[], |_| ());
        let mut panel = panel(&lane, 0);
        assert!(shows(&panel, text), "{kind}");
        assert!(!shows(&panel, "Sight"), "{kind}");
        let show = Command::Library(LibraryCommand::Replay(SavePlace::Shipped(FEELER)));
        assert_eq!(clicked(&mut panel, "Show me a snake that feels"), [show]);
        let (feeler, _) = load_entry(&SavePlace::Shipped(FEELER)).expect("shipped");
        assert!(feeler.champion.genome.controller.kind().senses_surroundings());
    }
}

#[test]
fn every_network_is_drawn_with_its_nodes_and_reflexes_are_listed_by_sense() {
    let reflexes: &[&str] = &["Joint 2: what each sense adds", "front touch: ", "Target moved: "];
    for (kind, labels) in [
        (ControllerKind::Modular, &["front step up "][..]),
        (ControllerKind::Central, &["block 1 gap "]),
        (ControllerKind::Ctrnn, &["neuron 1: bend target "]),
        (ControllerKind::Grown, &["head step up "]),
        (ControllerKind::Reflex, reflexes),
    ] {
        let lane = lane_of(kind, &[], |_| ());
        let panel = panel(&lane, 2);
        assert_shows(&panel, labels);
        assert_shows(&panel, &[&format!("Controller: {}", kind.title())]);
        assert_fits(&panel, 320.0);
    }
}

/// Creates a lane of a snake with 400 rules of equal strength. This share of their conditions' parts is left open.
fn lane_of_rules(wildcard_share: f32) -> Lane {
    lane_of(ControllerKind::Decisions, &[], |genome| {
        let ControllerGenes::Decisions(genes) = &mut genome.controller else { panic!("decisions") };
        let mut rng = stream(1, 1, 1, Purpose::Learn);
        let settings = ZcsSettings { wildcard_share, ..ZcsSettings::default() };
        let rules = Zcs::new(settings, SITUATION_BITS.len(), POSTURES.len(), &mut rng);
        genes.policy = Policy::Zcs(Arc::new(rules.expect("allowed")));
    })
}

#[test]
fn a_low_window_has_as_many_rules_in_sight_as_a_high_one() {
    let lane = lane_of_rules(0.9);
    let rules = |height| {
        let panel = panel_in_window(&lane, 0, height);
        panel.query_all_by_label_contains("strength 20.00. It matches").count()
    };
    assert_eq!(rules(500.0), rules(1600.0));
    assert!(rules(500.0) >= 6);
}

#[test]
fn the_panel_is_as_long_at_the_start_as_later() {
    for kind in [ControllerKind::Reflex, ControllerKind::Modular, ControllerKind::LimbNeurons] {
        let mut lane = lane_of(kind, &[], |_| ());
        let later = panel(&lane, 0).get_by_label_contains("Controller: ").rect();
        lane.show(0.0, None, 3000).expect("healthy");
        assert!(lane.replay.rollout().expect("simulated").perception().limbs.is_empty());
        assert_eq!(panel(&lane, 0).get_by_label_contains("Controller: ").rect(), later, "{kind}");
        assert!(shows(&panel(&lane, 0), "Joint 4 bend: "), "{kind}");
    }
}

#[test]
fn decisions_show_situation_postures_and_rules() {
    let lane = lane_of(ControllerKind::Decisions, &[], |_| ());
    let table = panel(&lane, 0);
    assert_shows(
        &table,
        &["Situation: ", "fold all: 0.00 0 visits", "0.00 0 visits, chosen", "taken before"],
    );
    assert!(!shows(&table, "Rules: "));
    let lane = lane_of_rules(0.2);
    let mut rules = panel(&lane, 0);
    assert!(shows(&rules, "of 400 match"));
    assert!(shows(&rules, "strength 20.00. It matches"));
    assert!(!shows(&rules, "does not match"));
    click(&mut rules, "Also rules that do not match");
    assert!(shows(&rules, "does not match this situation"));
    assert_fits(&rules, 320.0);
}

#[test]
fn waves_and_the_rules_that_chose_them_are_shown() {
    let lane = lane_of(ControllerKind::Rules, &[], |_| ());
    let panel = panel(&lane, 2);
    let activity = lane.replay.rollout().expect("simulated").activity(1);
    let Some(Activity::Waves(choice)) = activity else { panic!("{activity:?}") };
    assert!(shows(&panel, "Waves at joint 2"));
    for (joint, wave) in choice.of_joints.iter().enumerate() {
        let half = if joint < 2 { "front" } else { "rear" };
        let said = format!("Joint {}, in the {half} half, follows wave {}", joint + 1, wave + 1);
        assert!(shows(&panel, &said), "{said}");
    }
    for (index, wave) in choice.waves.iter().enumerate() {
        let (frequency_hz, percent) = (wave.frequency_hz, wave.share * 100.0);
        let said = format!("Wave {}: {frequency_hz:.2} Hz, {percent:.0} % of", index + 1);
        assert!(shows(&panel, &said), "{said}");
    }
    let held = choice.rules.iter().filter(|rule| rule.holds).count();
    assert!(shows(&panel, &format!("Rules: {held} of {} hold", choice.rules.len())));
    let strongest = choice.rules.iter().map(|rule| rule.rule.strength).fold(0.0, f32::max);
    assert!(shows(&panel, &format!("strength {strongest:.2}. It ")), "the strongest is first");
    assert_fits(&panel, 320.0);
}

#[test]
fn the_neurons_of_all_limbs_are_shown_and_the_wiring_of_the_selected_one() {
    let lane = lane_of(ControllerKind::LimbNeurons, &[], |_| ());
    for (limb, title) in [(0, "the head"), (2, "block 3"), (4, "the tail")] {
        let panel = panel(&lane, limb);
        assert!(shows(&panel, &format!("Wiring of {title}")));
        let activity = lane.replay.rollout().expect("simulated").activity(0);
        let Some(Activity::Limbs(limbs)) = activity else { panic!("{activity:?}") };
        let network = limbs.network(limb).expect("a limb");
        for node in &network.nodes {
            assert!(shows(&panel, &node.name), "{}", node.name);
        }
        for limb in 1..=5 {
            for neuron in 1..=4 {
                assert!(shows(&panel, &format!("Block {limb}, neuron {neuron}")));
            }
        }
        assert!(!shows(&panel, "Block 5, neuron 1, bend target"), "no joint is behind it");
        assert_fits(&panel, 320.0);
    }
}
