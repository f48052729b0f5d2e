//! Hostile champions of every family of controllers that learns or senses: each is refused with one line that names the field, its
//! value and the allowed range. Another test covers each single gene.

use std::fs;
use std::path::Path;

use snakes_core::save::parse_champion;

/// Returns the text of the champion with this name in the corpus.
fn champion(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/champion");
    fs::read_to_string(folder.join(name)).expect("a file of the corpus")
}

/// Returns the text with another number, word or string directly after `mark`.
fn with_value(text: &str, mark: &str, value: &str) -> String {
    let start = text.find(mark).expect(mark) + mark.len();
    let length = text[start..].find([',', ')', ']', '\n']).expect("an end");
    format!("{}{value}{}", &text[..start], &text[start + length..])
}

/// Checks that a champion is refused with one line that contains `parts`.
fn assert_refused(file: &str, text: &str, parts: &[&str]) {
    let error = parse_champion(Path::new("x.ron"), text).err();
    let error = error.map(|error| error.to_string()).unwrap_or_default();
    assert!(parts.iter().all(|part| error.contains(part)), "{file}: {parts:?} in: {error}");
    assert!(!error.contains('\n') && error.len() < 1000, "{file}: {error}");
}

/// Checks that a champion is refused if the value after `mark` in its controller is replaced.
fn assert_refuses(file: &str, mark: &str, value: &str, parts: &[&str]) {
    assert_refuses_behind("        controller: ", file, mark, value, parts);
}

/// Checks that a champion is refused if the value after `mark`, searched from `place` on, is replaced.
fn assert_refuses_behind(place: &str, file: &str, mark: &str, value: &str, parts: &[&str]) {
    let text = champion(file);
    let (before, behind) = text.split_at(text.find(place).expect("the place"));
    assert_refused(file, &format!("{before}{}", with_value(behind, mark, value)), parts);
}

#[test]
fn hostile_tables_are_refused_with_field_value_and_range() {
    for (mark, value, parts) in [
        ("states: ", "9", ["rows[0].state is ", "allowed: 0 to 8"]),
        ("states: ", "4294967295", ["states is 4294967295", "allowed"]),
        ("states: ", "0", ["states is 0", "allowed"]),
        ("actions: ", "10", ["numbers", "10"]),
        ("actions: ", "1000000000", ["actions is 1000000000", "allowed"]),
        ("rows: [(", "1000000", ["state is 1000000", "allowed: 0 to "]),
        ("rows: [(", "-1", ["out of bounds", "line"]),
    ] {
        assert_refuses("q-learning", mark, value, &parts);
    }
    let table = champion("q-learning");
    let start = table.find("rows: [(").expect("rows") + "rows: [(".len();
    let comma = start + table[start..].find(',').expect("a state");
    let values = comma + ", [".len();
    let with_first = |value: &str| {
        let end = values + table[values..].find(',').expect("a value");
        format!("{}{value}{}", &table[..values], &table[end..])
    };
    for (value, part) in
        [("NaN", "values is NaN"), ("inf", "values is inf"), ("1.0e30", "values is 1e30")]
    {
        assert_refused("q-learning", &with_first(value), &[part, "allowed", "rows[0]"]);
    }
    let longer = format!("{}0.5, {}", &table[..values], &table[values..]);
    assert_refused("q-learning", &longer, &["rows[0].values is 12 numbers; allowed: 11"]);
    let row = &table[start - 1..start + table[start..].find(")").expect("an end") + 1];
    let twice = table.replacen("rows: [", &format!("rows: [{row}, "), 1);
    assert_refused("q-learning", &twice, &["rows[1].state is ", "states in rising order"]);
}

#[test]
fn hostile_rules_are_refused_with_field_value_and_range() {
    for file in ["xcs", "zcs"] {
        for (mark, value, parts) in [
            ("condition: ", "\"0101\"", ["rules[0].condition is 0101", "allowed"]),
            ("condition: ", "\"\"", ["condition", "allowed"]),
            ("condition: ", "\"012\"", ["condition", "allowed"]),
            ("action: ", "11", ["rules[0].action is 11", "allowed: 0 to 10"]),
            ("action: ", "-1", ["out of bounds", "line"]),
            ("actions: ", "3", ["action", "allowed"]),
            ("situation_bits: ", "33", ["situation_bits is 33", "allowed: 1 to 32"]),
            ("situation_bits: ", "5", ["condition is", "allowed"]),
            ("population: ", "1000000000", ["population is 1000000000", "allowed"]),
            ("population: ", "0", ["population is 0", "allowed"]),
            ("learning_rate: ", "NaN", ["learning_rate is NaN", "allowed"]),
            ("discount: ", "1.0", ["discount is 1;", "allowed: 0 to 0.999"]),
        ] {
            assert_refuses(file, mark, value, &parts);
        }
        let text = champion(file);
        let at = text.find("rules: [(").expect("rules") + "rules: [".len();
        let rule = &text[at..at + text[at..].find(')').expect("an end") + 1];
        let many = format!("{rule},").repeat(60_000);
        let text = format!("{}{many}{}", &text[..at], &text[at..]);
        assert_refused(file, &text, &["rules", "allowed"]);
    }
    for (mark, value, part) in [
        ("prediction: ", "NaN", "rules[0].prediction is NaN"),
        ("error: ", "-1.0", "rules[0].error is -1"),
        ("fitness: ", "2.0", "fitness is 2"),
        ("numerosity: ", "0", "rules[0].numerosity is 0"),
        ("numerosity: ", "1000000000", "rules[0].numerosity is 1000000000"),
        ("numerosity: ", "100", "sum of numerosities is"),
        ("action_set_size: ", "0.0", "rules[0].action_set_size is 0"),
        ("time_stamp: ", "18446744073709551615", "rules[0].time_stamp is 18446744073709551615"),
        ("time: ", "18446744073709551615", "time is 18446744073709551615"),
    ] {
        let place = if mark == "time: " { "situation_bits: " } else { "rules: [" };
        assert_refuses_behind(place, "xcs", mark, value, &[part, "allowed"]);
    }
    for value in ["NaN", "-1.0", "1.0e30"] {
        let parts = ["rules[0].strength is", "allowed"];
        assert_refuses_behind("rules: [", "zcs", "strength: ", value, &parts);
    }
    for (mark, value, part) in [
        ("strength: ", "1.5", "strength is 1.5"),
        ("wave: ", "0", "wave is 0"),
        ("wave: ", "99", "wave is 99"),
        ("frequency_hz: ", "NaN", "frequency_hz is NaN"),
        ("amplitude: ", "1.0e9", "amplitude is 1000000000"),
    ] {
        assert_refuses("rules", mark, value, &[part, "allowed"]);
    }
}

#[test]
fn hostile_rules_of_joints_are_refused_with_field_value_and_range() {
    for (mark, value, part) in [
        ("situation_bits: ", "33", "situation_bits is 33"),
        ("actions: ", "300", "actions is 300"),
        ("action: ", "3", "action is 3"),
        ("prediction: ", "NaN", "prediction is NaN"),
        ("condition: ", "\"01\"", "condition is 01"),
    ] {
        let parts = [part, "allowed"];
        assert_refuses_behind("systems: [(", "joint-decisions", mark, value, &parts);
    }
    let text = champion("joint-decisions");
    let start = text.find("systems: [").expect("systems") + "systems: [".len();
    let end = text.rfind("],").expect("the end of the systems");
    let systems = &text[start..end];
    let with = |systems: &str| format!("{}{systems}{}", &text[..start], &text[end..]);
    assert_refused("no systems", &with(""), &["joints", "allowed"]);
    let twice = with(&format!("{systems}, {systems}"));
    assert_refused("eight systems", &twice, &["joints", "allowed"]);
}

#[test]
fn hostile_networks_are_refused_with_field_value_and_range() {
    let cases: [(&str, &str, &str, &str); 11] = [
        ("central", "hidden: [[", "NaN", "is NaN; allowed"),
        ("central", "joints: ", "1000000000", "joints is 1000000000"),
        ("central", "joints: ", "3", "allowed"),
        ("modular", "hidden: [[", "NaN", "is NaN; allowed"),
        ("ctrnn", "log_time_constant: ", "-9.0", "log_time_constant is -9"),
        ("limb-neurons", "weight: ", "NaN", "weight is NaN"),
        ("limb-neurons", "source: ", "own9", "own9"),
        ("neat", "inputs: ", "0", "inputs is 0"),
        ("neat", "outputs: ", "1000", "outputs is 1000"),
        ("neat", "links: [(", "4294967295", "4294967295; allowed"),
        ("reflex", "stiffness_nm_per_rad: ", "-5.0", "stiffness_nm_per_rad is -5"),
    ];
    for (file, mark, value, part) in cases {
        assert_refuses(file, mark, value, &[part]);
    }
    let text = champion("neat");
    let at = text.find("links: [").expect("links") + "links: [".len();
    let many = "(0, 21, 1.0, 1, 0), ".repeat(400_000);
    let hostile = format!("{}{many}{}", &text[..at], &text[at..]);
    assert_refused("neat", &hostile, &["allowed"]);
    let missing_row = champion("modular").replacen("hidden: [[", "hidden: [[0.5], [", 1);
    assert_refused("modular", &missing_row, &["hidden[0].weights is 1", "allowed: "]);
}

#[test]
fn hostile_bodies_are_refused_with_field_value_and_range() {
    let place = "        body: ";
    for (mark, value, parts) in [
        ("length_m: ", "NaN", ["segments[0].length_m is NaN", "allowed: 0.1 to 10"]),
        (
            "strength: ",
            "1.0,youngs_modulus_pa:Some(NaN)",
            ["segments[0].youngs_modulus_pa is NaN", "allowed: 1 to 10000000"],
        ),
        (
            "strength: ",
            "1.0,youngs_modulus_pa:Some(20.0)",
            ["segments[0].youngs_modulus_pa is 20", "would fold up under their own weight"],
        ),
        ("bend_limit_rad: ", "0.5", ["bend_limit_rad is 0.5", "allowed: 0, because"]),
        ("id: ", "2", ["segments[1].id is 2", "no other block of the body"]),
        ("id: ", "-1", ["out of bounds", "line"]),
        (
            "length_m: ",
            "9.0",
            ["of segments[0] and segments[1] is in the ratio", "allowed: a ratio of 1 to "],
        ),
    ] {
        assert_refuses_behind(place, "bodies", mark, value, &parts);
    }
    let text = champion("bodies");
    let start = text.find("segments: [").expect("segments") + "segments: [".len();
    let segment = &text[start..start + text[start..].find(')').expect("an end") + 1];
    let with = |count: usize| {
        let many: String = (0..count)
            .map(|number| segment.replacen("id: 1,", &format!("id: {},", 1000 + number), 1) + ", ")
            .collect();
        format!("{}{many}{}", &text[..start], &text[start..])
    };
    assert_refused("bodies", &with(8), &["segments is 13", "allowed: 2 to 12"]);
    assert_refused("bodies", &with(20_000), &["segments is 20005", "allowed: 2 to 12"]);
    // The body has one block more than the controller has joints for.
    assert_refused("bodies", &with(1), &["controller joints is 4 joints", "allowed: 5"]);
}

#[test]
fn hostile_creatures_are_refused_with_field_value_and_range() {
    let body = "        body: ";
    for (mark, value, parts) in [
        ("length_m: ", "NaN", ["nodes[0].length_m is NaN", "allowed: 0.1 to 10"]),
        ("copies: ", "4000000000", ["nodes[0].copies is 4000000000", "allowed: 1 to 5"]),
        ("to: ", "99", ["nodes[0].connections[0].to is 99", "allowed: 0 to "]),
        ("scale: ", "-1.0", ["nodes[0].connections[0].scale is -1", "allowed: 0.5 to 1.5"]),
        ("joint: ", "spherical", ["spherical", "rigid"]),
        ("bend_limit_rad: ", "0.5", ["bend_limit_rad is 0.5", "allowed: 0, because"]),
    ] {
        assert_refuses_behind(body, "creatures", mark, value, &parts);
    }
    for (mark, value, parts) in [
        ("bias: ", "NaN", ["part_neurons.nodes[0].neurons[0].bias is NaN", "allowed: -100 to 100"]),
        ("joints: ", "40", ["controller joints is 40 joints", "allowed: 4"]),
        ("function: ", "cosine", ["cosine", "sum"]),
    ] {
        assert_refuses("creatures", mark, value, &parts);
    }
    // The graph would grow without end, except for the limit on parts. The neurons fit other joints.
    let text = champion("creatures");
    let start = text.find("nodes: [").expect("nodes") + "nodes: [".len();
    let bomb = "(length_m: 1.0, width_m: 1.0, height_m: 1.0, density_kg_m3: 9.0, joint: universal, bend_limit_rad: 1.0, \
                twist_limit_rad: 1.0, bend_start: 0.0, twist_start: 0.0, strength: 1.0, copies: 5, connections: [";
    let rear = "(to: 0, side: rear, place: (0.0, 0.0), turn_rad: (0.0, 0.0, 0.0), scale: 1.0, is_mirrored: true, \
                is_terminal: false), ";
    let with = |nodes: String| format!("{}{nodes}{}", &text[..start], &text[start..]);
    let node = |connections: usize| format!("{bomb}{}]), ", rear.repeat(connections));
    assert_refused("creatures", &with(node(3)), &["part_neurons.nodes is 3", "allowed: 4 to 4"]);
    assert_refused("creatures", &with(node(4)), &["nodes[0].connections is 4", "allowed: 0 to 3"]);
    assert_refused(
        "creatures",
        &with(node(200_000)),
        &["connections is 200000", "allowed: 0 to 3"],
    );
    assert_refused(
        "creatures",
        &with(node(1).repeat(100_000)),
        &["nodes is 10000", "allowed: 1 to 16"],
    );
}
