//! Tests of the compatibility of settings, and of which settings have an effect.

use super::*;
use crate::schema::{NumberRange, SettingKind};
use crate::world::Surface;

#[test]
fn every_strategy_has_a_row_of_its_own_and_is_stored_by_its_name() {
    for (index, kind) in StrategyKind::ALL.into_iter().enumerate() {
        assert_eq!(ron::to_string(&kind).expect("written"), kind.name());
        assert!(!kind.title().is_empty() && kind.words().ends_with('.'), "{kind}");
        for other in &StrategyKind::ALL[..index] {
            assert_ne!(other.info().color, kind.info().color, "{other}, {kind}");
            assert_ne!(other.title(), kind.title());
        }
    }
}

#[test]
fn senses_are_settings_of_controllers_that_have_them() {
    for (controller, expected) in [("gait", false), ("reflex", true)] {
        let settings = with_field(&Settings::default(), "genome.controller", controller);
        let listed = schema::list(&settings.expect("allowed"));
        let sight = listed.iter().find(|field| field.path == "trial.agent.senses.sight");
        assert_eq!(sight.expect("a setting").is_used, expected, "{controller}");
        let limbs = listed.iter().find(|field| field.path == "trial.agent.limbs");
        assert!(limbs.expect("a setting").is_used);
    }
}

#[test]
fn settings_without_effect_on_the_chosen_strategy_and_controller_are_marked() {
    use crate::genome::ControllerKind::{Ctrnn, Gait, Rules, Signal, Wave};
    use StrategyKind::{CmaEs, Ga, Novelty};
    let is_used = |strategy, controller, path: &str| {
        let mut settings = Settings::default();
        (settings.evolution.strategy, settings.genome.controller) = (strategy, controller);
        let listed = schema::list(&settings);
        listed.into_iter().find(|listed| listed.path == path).expect(path).is_used
    };
    let takeover = "evolution.ga.wave_takeover";
    assert!(is_used(Ga, Rules, takeover));
    for (strategy, controller) in [(Ga, Gait), (Novelty, Rules), (CmaEs, Rules)] {
        assert!(!is_used(strategy, controller, takeover), "{strategy}, {controller}");
    }
    assert!(is_used(Novelty, Rules, "evolution.ga.elites"));
    for (path, users) in [
        ("genome.network.library_waves", &[Rules][..]),
        ("genome.network.ctrnn_weight_range", &[Ctrnn]),
        ("genome.wave.harmonics", &[Gait, Rules, Wave]),
        ("genome.wave.angle_range_rad", &[Gait, Ctrnn, Rules]),
        ("genome.torque_range_nm", &[Signal, Wave]),
        ("genome.points_per_s", &[Signal]),
        ("genome.density_min_kg_m3", &[Gait, Ctrnn, Rules, Signal, Wave]),
    ] {
        for kind in [Gait, Ctrnn, Rules, Signal, Wave] {
            assert_eq!(is_used(Ga, kind, path), users.contains(&kind), "{path} of {kind}");
        }
    }
}

#[test]
fn a_setting_is_used_if_the_run_meets_its_need() {
    type Change = fn(&mut Settings);
    let default: Change = |_| {};
    let varies: Change = |settings| settings.genome.bodies.vary = true;
    let poet: Change = |settings| settings.evolution.strategy = StrategyKind::Poet;
    let body_poet: Change = |settings| settings.evolution.strategy = StrategyKind::BodyPoet;
    let ladder: Change = |settings| settings.evolution.ladder.first_rise_m = 0.1;
    let soft: Change = |settings| settings.trial.agent.youngs_modulus_pa = Some(4.0e4.into());
    for (path, with, without) in [
        ("evolution.ladder.share", ladder, default),
        ("evolution.poet.pair_step", poet, body_poet),
        ("trial.stairs.rise_m", default, poet),
        ("trial.agent.limb_width_m", default, varies),
        ("trial.agent.torque_budget_nm", varies, default),
        ("trial.agent.soft_parts", soft, default),
    ] {
        let is_used = [with, without].map(|change| {
            let mut settings = Settings::default();
            change(&mut settings);
            schema::list(&settings).iter().any(|listed| listed.path == path && listed.is_used)
        });
        assert_eq!(is_used, [true, false], "{path}");
    }
}

#[test]
fn the_defaults_are_allowed() {
    assert_eq!(Settings::default().check(), Ok(()));
}

/// Returns texts of the two numbers just outside a range, and of the two numbers at its ends.
fn around(range: &NumberRange) -> ([String; 2], [String; 2]) {
    let NumberRange { least, most, is_whole, .. } = *range;
    let beyond =
        if is_whole { [least - 1.0, most + 1.0] } else { [least.next_down(), most.next_up()] };
    (beyond.map(|number| number.to_string()), [least, most].map(|number| number.to_string()))
}

#[test]
fn every_setting_is_allowed_within_its_range_and_refused_beyond_it_by_name_value_and_range() {
    let mut settings = Settings::default();
    settings.trial.ground = Some(Surface::default());
    for listed in schema::list(&settings) {
        let (path, setting) = (&listed.path, &listed.setting);
        let allows = |text: &str| {
            let value = setting.parse(text).unwrap_or_else(|| panic!("{path} = {text}"));
            assert_eq!(setting.check(path, &value), Ok(()), "{path} = {text}");
        };
        let refuses = |text: &str, value: &str, allowed: &str| {
            let refusal = with_field(&settings, path, text).expect_err(path).to_string();
            assert_eq!(refusal, Invalid::new(path, value, allowed).to_string());
        };
        let refuses_text = |text: &str| refuses(text, &format!("{text:?}"), &setting.allowed());
        allows(&listed.value.to_string());
        match setting.kind {
            SettingKind::Number(range) => {
                let (beyond, ends) = around(&range);
                ends.iter().for_each(|end| allows(end));
                for number in beyond {
                    match range.is_whole && number.starts_with('-') {
                        true => refuses_text(&number),
                        false => refuses(&number, &number, &range.in_words()),
                    }
                }
                for end in range.gap.into_iter().flatten() {
                    allows(&end.to_string());
                    let inside =
                        if end > 0.0 { end.next_down() } else { end.next_up() }.to_string();
                    refuses(&inside, &inside, &range.in_words());
                }
                refuses_text("NaN");
            }
            SettingKind::List(range) => {
                let (beyond, ends) = around(&range);
                allows(&format!("[{}]", ends.join(", ")));
                for number in beyond {
                    refuses(&format!("[{number}]"), &number, &ends.join(" to "));
                }
                refuses_text("[NaN]");
            }
            SettingKind::Choice(choices) => {
                choices().iter().for_each(|choice| allows(choice.name));
                refuses_text("no such name");
            }
            SettingKind::Switch => {
                ["false", "true"].iter().for_each(|text| allows(text));
                refuses_text("yes");
            }
            SettingKind::Absent(_) => panic!("{path} is absent"),
        }
    }
}

#[test]
fn a_generation_that_would_not_fit_into_memory_is_refused() {
    let mut settings = Settings::default();
    settings.trial.duration_s = 600.0;
    settings.genome.points_per_s = 100.0;
    settings.evolution.population = 10_000;
    let error = settings.check().unwrap_err().to_string();
    assert!(error.starts_with("evolution.population is 10000; allowed: 1 to 52"), "{error}");
    settings.evolution.population = 50;
    settings.evolution.halving.parents = 50;
    let error = settings.check().unwrap_err().to_string();
    assert!(error.starts_with("evolution.halving.parents is 50; allowed: 1 to 4"), "{error}");
    settings.genome.points_per_s = 1000.0;
    let error = settings.check().unwrap_err().to_string();
    assert!(error.starts_with("genome.points_per_s is 1000 (4800000 torque points"), "{error}");
}

/// Returns numbers of a range to try: its ends, its middle, the ends of its gap and of its slider, and numbers next to zero.
fn samples(range: &NumberRange) -> Vec<f32> {
    let NumberRange { least, most, is_whole, slider, gap, begins_with, .. } = *range;
    let mut numbers =
        vec![least, most, f32::midpoint(least, most), 0.0, most * 1.0e-6, least * 1.0e-6];
    numbers.extend(slider.into_iter().chain(gap).flatten().chain(begins_with));
    let numbers = numbers.into_iter().map(|number| if is_whole { number.round() } else { number });
    numbers.filter(|number| range.allows(*number)).collect()
}

/// Returns texts that give the setting a number: alone and, where each part may have its own, behind the greatest number of the first.
fn texts_of(number: f32, kind: &SettingKind) -> Vec<String> {
    match kind {
        SettingKind::List(_) => vec![format!("[{number}]")],
        SettingKind::Number(range) if range.parts.count() > 1 => {
            let mut list = vec![range.most; range.parts.count()];
            list[1] = number;
            vec![number.to_string(), format!("{list:?}")]
        }
        _ => vec![number.to_string()],
    }
}

/// Settings that go with extreme values of others: high stairs, small blocks, large blocks.
const COMPANIONS: [&[(&str, &str)]; 4] = {
    const LIMBS: (&str, &str) = ("genome.bodies.limbs_max", "2");
    const WIDE: [(&str, &str); 3] = [
        ("genome.bodies.length_max_m", "10"),
        ("genome.bodies.thickness_max_m", "10"),
        ("genome.bodies.longest_m", "24"),
    ];
    const LEAST: [(&str, &str); 2] =
        [("genome.bodies.length_min_m", "0.1"), ("genome.bodies.thickness_min_m", "0.1")];
    [
        &[("trial.stairs.rise_m", "5")],
        &[LIMBS, WIDE[0], WIDE[1], WIDE[2], LEAST[0], LEAST[1], ("genome.bodies.volume_m3", "0.1")],
        &[LIMBS, WIDE[0], WIDE[1], WIDE[2], LEAST[0], LEAST[1], ("genome.bodies.volume_m3", "1")],
        &[LIMBS, WIDE[0], WIDE[1], WIDE[2], ("genome.bodies.volume_m3", "1000")],
    ]
};

#[test]
fn f14_every_number_that_a_setting_documents_is_allowed_in_some_run() {
    let presets = crate::save::shipped_presets().expect("well formed");
    let runs: Vec<Settings> = presets.into_iter().map(|preset| preset.settings).collect();
    let mut all = std::collections::BTreeMap::new();
    for run in &runs {
        all.extend(schema::list(run).into_iter().map(|listed| (listed.path.clone(), listed)));
    }
    let group_of = |path: &str| path.rsplit_once('.').map(|(group, _)| group.to_owned());
    let mut refused = Vec::new();
    for (path, listed) in &all {
        let (SettingKind::Number(range) | SettingKind::List(range)) = listed.setting.kind else {
            continue;
        };
        // Limits that depend on each other are tried together with another number of the same group, or with companions.
        let mut others: Vec<Vec<(&str, String)>> = vec![Vec::new()];
        for (other, listed) in &all {
            if let SettingKind::Number(range) = listed.setting.kind
                && other != path
                && group_of(other) == group_of(path)
            {
                let numbers = samples(&range).into_iter();
                others.extend(numbers.map(|number| vec![(other.as_str(), number.to_string())]));
            }
        }
        others.extend(COMPANIONS.map(|companions| {
            let besides = companions.iter().filter(|(other, _)| other != path);
            besides.map(|(other, text)| (*other, (*text).to_owned())).collect()
        }));
        for number in samples(&range) {
            let texts = texts_of(number, &listed.setting.kind);
            let is_allowed = |run: &Settings| {
                others.iter().any(|others| {
                    texts.iter().any(|text| {
                        let others = others.iter().map(|(path, text)| (*path, text.as_str()));
                        with_fields(run, others.chain([(path.as_str(), text.as_str())])).is_ok()
                    })
                })
            };
            if !runs.iter().any(is_allowed) {
                let allowed = listed.setting.allowed();
                let problem = with_field(&runs[0], path, &number.to_string()).map(drop);
                refused.push(format!("{path}: {allowed}, but {number} is refused: {problem:?}"));
            }
        }
    }
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}
