//! Tests of the schema on a small group of settings.

use super::*;
use crate::check::{Invalid, within};

setting_group! {
    /// Number and radius of the wheels.
    pub struct Wheels {
        count: u32 = 3;
        radius_m: f32 = 0.5;
        widths_m: PerPart = 0.2.into();
        grip: Option<PerPart> = None;
        angles_rad: Vec<f32> = vec![0.5, 1.0];
        is_driven: bool = false;
        tyre: Tyre = Tyre::Soft;
        axle: Axle = Axle::default();
    }
}

setting_group! {
    /// The axle of the wheels.
    pub struct Axle in "Axle": "What joins the wheels." {
        least_m: f32 = 1.0, number("Least", 0.0..=5.0).unit("m");
        most_m: f32 = 2.0, number("Most", 0.0..=5.0).unit("m");
    }

    fn check_together(&self) -> Result<(), Invalid> {
        within("most_m", self.most_m, self.least_m..=5.0)
    }
}

choices! {
    /// The tyre of the wheels.
    pub enum Tyre {
        Soft = "soft", "Soft", "It gives way.";
        Hard = "hard", "Hard", "It does not.";
    }
}

impl SettingGroup for Wheels {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let each = Parts::Limbs(self.count as usize);
        let Self { count, radius_m, widths_m, grip, angles_rad, is_driven, tyre, axle } = self;
        walk.section(Section { title: "Wheels", about: "What it rolls on." });
        settings! { walk,
            count: whole("Wheels", 2..=6).hint("How many there are");
            radius_m: number("Radius", 0.1..=2.0).unit("m").hint("Half of its height");
            widths_m: per_part("Width", 0.1..=1.0, each).unit("m");
            grip: optional_per_part("Grip", 0.0..=9.0, each, 1.0);
            angles_rad: list_of_numbers("Angles", 0.0..=3.0).used_if(*is_driven);
            is_driven: switch("Driven").fixed("It is built in.");
            tyre: choice("Tyre");
        }
        walk.fixed("The frame cannot change.");
        walk.group("axle", axle);
    }
}

/// Returns the default wheels after the change of a setting, or the message of the error that refuses it.
fn changed(path: &str, text: &str) -> Result<Wheels, String> {
    let mut changed = Wheels::default();
    let result = find(&changed, path)
        .and_then(|path| set_text(&mut changed, &path, text))
        .and_then(|()| check(&changed));
    result.map(|()| changed).map_err(|error| error.to_string())
}

#[test]
fn the_list_has_every_setting_with_its_path_and_value() {
    let listed: Vec<String> = list(&Wheels::default())
        .iter()
        .map(|listed| format!("{} = {}", listed.path, listed.value))
        .collect();
    let expected = [
        "count = 3",
        "radius_m = 0.5",
        "widths_m = 0.2",
        "grip = none",
        "angles_rad = [0.5, 1]",
        "is_driven = false",
        "tyre = soft",
        "axle.least_m = 1",
        "axle.most_m = 2",
    ];
    assert_eq!(listed, expected);
}

#[test]
fn a_text_sets_the_field_that_its_path_ends_with() {
    assert_eq!(changed("count", "4").map(|w| w.count), Ok(4));
    assert_eq!(changed("radius_m", "5e-1").map(|w| w.radius_m), Ok(0.5));
    assert_eq!(changed("most_m", "3").map(|w| w.axle.most_m), Ok(3.0));
    assert_eq!(changed("is_driven", "true").map(|w| w.is_driven), Ok(true));
    assert_eq!(changed("tyre", "hard").map(|w| w.tyre), Ok(Tyre::Hard));
    assert_eq!(changed("angles_rad", "[ 1,2 ]").map(|w| w.angles_rad), Ok(vec![1.0, 2.0]));
    let each = PerPart::Each(vec![0.1, 0.2, 0.3]);
    assert_eq!(changed("widths_m", "[0.1, 0.2, 0.3]").map(|w| w.widths_m), Ok(each.clone()));
    assert_eq!(changed("grip", "[0.1, 0.2, 0.3]").map(|w| w.grip), Ok(Some(each)));
    assert_eq!(changed("grip", "none").map(|w| w.grip), Ok(None));
}

#[test]
fn s12_zero_has_no_sign() {
    for text in ["-0", "-0.0", "-1e-60", "0"] {
        let angles = changed("angles_rad", &format!("[{text}]")).expect("allowed").angles_rad;
        assert_eq!(angles[0].to_bits(), 0, "{text}");
    }
}

#[test]
fn a_wrong_value_is_refused_with_its_path_and_what_is_allowed() {
    for (path, text, message) in [
        ("count", "2.5", "count is \"2.5\"; allowed: 2 to 6, whole numbers"),
        ("count", "7", "count is 7; allowed: 2 to 6"),
        ("radius_m", "high", "radius_m is \"high\"; allowed: 0.1 to 2 m"),
        ("radius_m", "NaN", "radius_m is \"NaN\"; allowed: 0.1 to 2 m"),
        ("radius_m", "1e39", "radius_m is \"1e39\"; allowed: 0.1 to 2 m"),
        ("radius_m", "none", "radius_m is \"none\"; allowed: 0.1 to 2 m"),
        ("radius_m", "[1]", "radius_m is \"[1]\"; allowed: 0.1 to 2 m"),
        ("widths_m", "[0.1, 0.2]", "widths_m is a list of 2; allowed: one value, or a list of 3"),
        ("widths_m", "[0.1, 0.2, 3]", "widths_m[2] is 3; allowed: 0.1 to 1"),
        ("grip", "x", "grip is \"x\"; allowed: 0 to 9, or a list such as [1, 2], or none"),
        ("angles_rad", "[]", "angles_rad is 0 values; allowed: 1 to 100 values"),
        ("angles_rad", "[4]", "angles_rad is 4; allowed: 0 to 3"),
        ("is_driven", "yes", "is_driven is \"yes\"; allowed: true, false"),
        ("tyre", "flat", "tyre is \"flat\"; allowed: soft, hard"),
        ("axle.most_m", "0.5", "axle.most_m is 0.5; allowed: 1 to 5"),
    ] {
        assert_eq!(changed(path, text), Err(message.to_owned()));
    }
}

#[test]
fn a_setting_is_set_by_its_full_name_only() {
    let mut wheels = Wheels::default();
    set_text(&mut wheels, "axle.least_m", "0.5").expect("its full name");
    assert_eq!(wheels.axle.least_m, 0.5);
    assert!(set_text(&mut wheels, "least_m", "0.5").is_err());
}

#[test]
fn an_unknown_name_lists_the_nearest_and_an_ambiguous_one_all() {
    let message = changed("axle.least", "1").expect_err("unknown");
    assert!(
        message.starts_with(
            "set is \"axle.least\", an unknown setting; allowed: (nearest) axle.least_m"
        )
    );
    let mut both = Wheels::default();
    both.axle.least_m = 0.0;
    #[derive(Clone)]
    struct Pair(Axle, Axle);
    impl SettingGroup for Pair {
        fn walk(&mut self, walk: &mut Walk<'_>) {
            walk.group("front", &mut self.0);
            walk.group("rear", &mut self.1);
        }
    }
    let pair = Pair(both.axle.clone(), both.axle);
    let message = find(&pair, "least_m").expect_err("two").to_string();
    assert_eq!(
        message,
        "set is \"least_m\", an ambiguous name; allowed: front.least_m, rear.least_m"
    );
}

#[test]
fn a_group_says_what_is_used_and_what_may_change() {
    let listed = list(&Wheels::default());
    let of = |path: &str| {
        let listed = listed.iter().find(|listed| listed.path == path).expect("listed");
        (listed.section.title, listed.is_used, listed.live)
    };
    assert_eq!(of("count"), ("Wheels", true, Ok(())));
    assert_eq!(of("is_driven"), ("Wheels", true, Err("It is built in.")));
    assert_eq!(of("axle.most_m"), (Axle::SECTION.title, true, Err("The frame cannot change.")));
    let (_, is_used, live) = of("angles_rad");
    assert!(!is_used && live.is_err_and(|reason| reason.contains("does not use it")));
}

#[test]
fn the_tables_have_a_row_for_each_setting() {
    let text = markdown(&Wheels::default());
    let row = "| `radius_m` | 0.1 to 2 m | `0.5` | may change | Radius: Half of its height. |";
    assert!(text.contains("## Wheels\n\nWhat it rolls on.\n"), "{text}");
    assert!(text.contains(row), "{text}");
    assert!(text.contains("| `tyre` | `soft`, `hard` | `soft` |"), "{text}");
    assert!(text.contains("| `axle.most_m` | 0 to 5 m | `2` | fixed |"), "{text}");
}
