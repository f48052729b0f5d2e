//! The invariants of `crates/core/src/lib.rs` that a scan of the source can check.

mod imports;
mod tokens;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use imports::{circles, import_graph};
use tokens::tokens;

/// Returns the repository's root.
fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Returns all source files: the path below the root with forward slashes, and the text.
fn all_files() -> Vec<(String, String)> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    let mut paths = Vec::new();
    for crate_folder in ["crates/core/src", "crates/lab/src", "crates/cluster/src", "src"] {
        collect(&root().join(crate_folder), &mut paths);
    }
    paths.sort();
    let relative = |path: &Path| {
        let path = path.strip_prefix(root()).expect("below the root");
        path.to_string_lossy().replace('\\', "/")
    };
    paths.iter().map(|path| (relative(path), fs::read_to_string(path).expect("read"))).collect()
}

/// Returns the path of a file within its crate's `src`.
fn within_crate(path: &str) -> &str {
    path.split_once("src/").expect("a source file").1
}

/// Returns the top-level module of a crate to which a file belongs. Files of the crate `cluster` belong to `cluster`.
fn module_of(path: &str) -> &str {
    if path.starts_with("crates/cluster/") {
        return "cluster";
    }
    within_crate(path).split(['/', '.']).next().unwrap_or_default()
}

/// Returns all source files, without their tests.
fn files() -> Vec<(String, String)> {
    let texts = all_files();
    let exists = |path: &str| texts.iter().any(|(of, _)| of == path);
    // A module is a file, or a folder.
    let found = |path: String| {
        let folder = path.replace(".rs", "/mod.rs");
        if exists(&folder) { folder } else { path }
    };
    let of_tests: Vec<String> =
        texts.iter().flat_map(|(path, text)| test_files(path, text)).map(found).collect();
    for path in &of_tests {
        assert!(texts.iter().any(|(of, _)| of == path), "{path} is declared but does not exist");
    }
    // The submodules of a test module are tests, too.
    let is_of_tests = |path: &String| {
        let is_below =
            |of: &String| path.starts_with(&of.replace("/mod.rs", "/").replace(".rs", "/"));
        of_tests.iter().any(|of| path == of || is_below(of))
    };
    texts
        .into_iter()
        .filter(|(path, _)| !is_of_tests(path))
        .map(|(path, text)| (path, without_tests(&text)))
        .collect()
}

/// Returns the files of the modules that a file declares for tests only.
fn test_files(path: &str, text: &str) -> Vec<String> {
    let folder = path.strip_suffix("/mod.rs").or(path.strip_suffix(".rs")).expect("a source file");
    let declared = text.split("#[cfg(test)]\n").skip(1).filter_map(|after| {
        let (head, _) = after.lines().next()?.split_once(';')?;
        let (_, name) = head.split_once("mod ")?;
        Some(format!("{folder}/{name}.rs"))
    });
    declared.collect()
}

/// Returns a file's text without its test modules. Other items that exist only in tests stay.
fn without_tests(text: &str) -> String {
    let mut rest = text;
    let mut kept = String::new();
    while let Some((before, after)) = rest.split_once("#[cfg(test)]\n") {
        kept += before;
        let head = after.lines().next().unwrap_or_default();
        let is_module = head.contains("mod ") && head.ends_with('{');
        // The module ends at the first closing brace without indentation.
        rest = match after.split_once("\n}\n") {
            Some((_, after_it)) if is_module => after_it,
            _ => after,
        };
    }
    kept + rest
}

#[test]
fn test_modules_are_removed_and_the_rest_of_a_file_is_scanned() {
    let text = "a\n#[cfg(test)]\nfn b() {\n}\n#[cfg(test)]\nmod tests {\n    c\n}\nd\n";
    assert_eq!(without_tests(text), "a\nfn b() {\n}\nd\n");
    let text = "mod a;\n#[cfg(test)]\npub(super) mod tests;\nmod b;\n";
    assert_eq!(test_files("studio/mod.rs", text), ["studio/tests.rs"]);
    assert_eq!(test_files("studio/lane.rs", text), ["studio/lane/tests.rs"]);
}

/// The modules of the core in the order of the pipeline. Each may use only those before it. Cargo enforces the order of the crates.
const PIPELINE: [&str; 11] = [
    "check", "rng", "learn", "schema", "engine", "world", "genome", "control", "score", "evolve",
    "save",
];

/// Returns the lines of a text, without lines that are only comments.
fn code(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.trim_start().starts_with("//"))
}

#[test]
fn imports_are_written_one_use_per_module() {
    for (path, text) in files() {
        for grouped in ["use crate::{", "use std::{"] {
            let found = code(&text).find(|line| line.trim_start().starts_with(grouped));
            assert_eq!(found, None, "{path}: one use per module, so that this test can read it");
        }
    }
}

#[test]
fn every_module_of_the_core_uses_only_those_before_it() {
    let is_core = |path: &String| path.starts_with("crates/core/") && !path.ends_with("src/lib.rs");
    let place_of = |path: &str| {
        let place = PIPELINE.iter().position(|known| *known == module_of(path));
        place.unwrap_or_else(|| panic!("{path} is in no module of the pipeline"))
    };
    for (path, targets) in import_graph(&files()).into_iter().filter(|(path, _)| is_core(path)) {
        for target in targets.iter().filter(|target| is_core(target)) {
            assert!(place_of(target) <= place_of(&path), "{path} uses {target}, which comes later");
        }
    }
}

/// The folders of the studio, lowest level first. Each may use only folders of lower levels, so folders of the same level do not
/// use each other.
const STUDIO_LAYERS: [&[&str]; 8] = [
    &["commands", "schedule", "error"],
    &["ui"],
    &["stage"],
    &["state"],
    &["workspace", "failure", "scene"],
    &["pictures", "panels"],
    &["app"],
    &["mod"],
];

#[test]
fn every_layer_of_the_studio_uses_only_lower_layers() {
    let layer_of = |path: &str| {
        let below_studio = path.strip_prefix("src/studio/")?;
        below_studio.split(['/', '.']).next().map(str::to_owned)
    };
    let level_of = |layer: &str| STUDIO_LAYERS.iter().position(|level| level.contains(&layer));
    for (path, targets) in import_graph(&files()) {
        let Some(layer) = layer_of(&path) else { continue };
        let level = level_of(&layer);
        assert!(level.is_some(), "{path} is in no layer of the studio");
        for target in targets {
            let other = layer_of(&target).filter(|other| *other != layer);
            let is_lower = other.is_none_or(|other| level_of(&other) < level);
            assert!(is_lower, "{path} uses {target}, which is not in a lower layer");
        }
    }
}

/// Maximum number of files that depend on each other in a circle.
const LARGEST_CIRCLE: usize = 2;

#[test]
fn no_circle_of_imports_is_too_large() {
    let circles = circles(&import_graph(&files()));
    let too_large: Vec<_> = circles.iter().filter(|circle| circle.len() > LARGEST_CIRCLE).collect();
    assert!(too_large.is_empty(), "files that import each other: {too_large:#?}");
}

/// Returns the names of the types that a text defines, without associated types and types that only a macro names.
fn type_names(text: &str) -> Vec<String> {
    let tokens = tokens(text);
    let mut depth = 0;
    let mut names = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let next = tokens.get(index + 1).map_or("", String::as_str);
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "struct" | "enum" | "trait" | "union" if next.starts_with(char::is_alphabetic) => {
                names.push(next.to_owned());
            }
            // A `type` within braces is an associated type.
            "type" if depth == 0 => names.push(next.to_owned()),
            _ => (),
        }
    }
    names
}

#[test]
fn associated_types_and_types_named_by_a_macro_have_no_name_of_their_own() {
    let text = "struct A; trait B { type Item; } impl B for A { type Item = u8; }\n\
                type C = u8; macro_rules! d { ($e:ident) => { enum $e {} } } fn f() { struct G; }";
    assert_eq!(type_names(text), ["A", "B", "C", "G"]);
}

#[test]
fn no_two_types_share_a_name() {
    let mut homes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in files() {
        for name in type_names(&text) {
            homes.entry(name).or_default().push(path.clone());
        }
    }
    homes.retain(|_, paths| paths.len() > 1);
    assert!(homes.is_empty(), "types that share a name: {homes:#?}");
}

/// Words that may be used only in certain modules: word, modules, reason. Packages on which a crate does not depend need no row.
const RESTRICTED_WORDS: [(&str, &[&str], &str); 12] = [
    ("rapier3d", &["world", "run", "studio"], "only the world knows the physics engine"),
    ("std::thread", &["run", "cluster"], "results could depend on threads"),
    ("thread::spawn", &[], "it panics if the system refuses a thread; Builder returns an error"),
    ("scope.spawn(", &[], "it panics if the system refuses a thread; Builder returns an error"),
    ("enable_steady_tick", &[], "it panics if the system refuses a thread"),
    ("std::net", &["cluster"], "only an evaluator connects to other machines"),
    (
        "process::Command",
        &["run", "plot", "export", "studio"],
        "child processes evaluate, find fonts, write films, or replace a failed studio",
    ),
    ("std::fs", &["save"], "only one module accesses files"),
    ("Instant", &["run", "cluster", "studio"], "a clock must not decide a result"),
    ("SystemTime", &[], "a clock must not decide a result"),
    ("HashMap", &[], "its iteration order differs between runs"),
    ("HashSet", &[], "its iteration order differs between runs"),
];

#[test]
fn restricted_words_are_used_only_in_their_modules() {
    for (path, text) in files() {
        let module = module_of(&path);
        for (word, homes, reason) in RESTRICTED_WORDS {
            if !homes.contains(&module) {
                let found = code(&text).find(|line| line.contains(word));
                assert_eq!(found, None, "{word} in {path}: {reason}");
            }
        }
    }
}

#[test]
fn only_the_simulation_steps_the_engine() {
    for (path, text) in files() {
        let allowed = within_crate(&path) == "world/rapier/mod.rs";
        for step in ["physics.step(", ".step_with_events(", ".step_simulation("] {
            let steps = code(&text).any(|line| line.contains(step));
            assert!(!steps || allowed, "{path} steps the engine itself");
        }
    }
}

#[test]
fn every_file_opens_with_a_module_comment() {
    for (path, text) in all_files() {
        assert!(text.starts_with("//!"), "{path} does not open with //!");
    }
}
