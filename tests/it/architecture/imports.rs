//! The graph of imports between source files: a file depends on the files that define the items it names.
//!
//! Imports and paths are resolved through re-exports to the defining file. A declaration `mod x;` is no import. The
//! resolution follows modules, items at the top level of a file, and `use`; an item that a macro defines counts as
//! part of the file in which its module begins.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::tokens;

/// The files on which each file depends. Paths are relative to the root.
pub type ImportGraph = BTreeMap<String, BTreeSet<String>>;

type Module = Vec<String>;

/// A source file, which is one module.
struct SourceFile {
    path: String,
    tokens: Vec<String>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
}

/// A name that a `use` brings into a module; `*` for all names of another module.
struct Use {
    name: String,
    path: Vec<String>,
}

#[derive(Clone)]
enum Target {
    Module(Module),
    /// Path of the file that defines the item.
    Item(String),
    /// An item of another crate.
    External,
}

/// Builds the graph of files, given their paths below the root and their texts. Paths into other crates among them are resolved.
pub fn import_graph(files: &[(String, String)]) -> ImportGraph {
    let modules: BTreeMap<Module, SourceFile> =
        files.iter().map(|(path, text)| (module_of(path), SourceFile::new(path, text))).collect();
    let source = Crates { modules };
    source
        .modules
        .iter()
        .map(|(module, file)| (file.path.clone(), source.imports(module)))
        .collect()
}

/// Returns the sets of files that depend on each other in a circle, larger sets first.
pub fn circles(graph: &ImportGraph) -> Vec<BTreeSet<String>> {
    let reachable = |start: &String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(next) = open.pop() {
            for target in graph.get(&next).into_iter().flatten() {
                if seen.insert(target.clone()) {
                    open.push(target.clone());
                }
            }
        }
        seen
    };
    let reach: BTreeMap<&String, BTreeSet<String>> =
        graph.keys().map(|file| (file, reachable(file))).collect();
    let mut circles: Vec<BTreeSet<String>> = Vec::new();
    for (file, targets) in &reach {
        if targets.contains(*file) && !circles.iter().any(|circle| circle.contains(*file)) {
            let is_mutual = |other: &&String| reach.get(other).is_some_and(|of| of.contains(*file));
            circles.push(targets.iter().filter(is_mutual).cloned().collect());
        }
    }
    circles.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    circles
}

/// Returns the path of a file's module. It begins with the name by which other crates refer to the module's crate.
fn module_of(path: &str) -> Module {
    let (folder, path) = path.split_once("src/").unwrap_or_default();
    let name = folder.trim_start_matches("crates/").trim_end_matches('/');
    let path = path.strip_suffix(".rs").unwrap_or(path);
    let path = path.strip_suffix("/mod").unwrap_or(path);
    let below = path.split('/').filter(|name| !["lib", "main"].contains(name)).map(str::to_owned);
    let start = if name.is_empty() { "snakes".to_owned() } else { format!("snakes_{name}") };
    [start].into_iter().chain(below).collect()
}

impl SourceFile {
    fn new(path: &str, text: &str) -> Self {
        let tokens = tokens(text);
        let (mut items, mut uses) = (BTreeSet::new(), Vec::new());
        let mut depth = 0;
        let mut index = 0;
        while index < tokens.len() {
            let next = tokens.get(index + 1).map_or("", String::as_str);
            match tokens[index].as_str() {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth -= 1,
                // `+ use<>` lists what a type captures; it imports nothing.
                "use" if next != "<" => {
                    index = read_use(&tokens, index + 1, &[], &mut uses);
                    continue;
                }
                "struct" | "enum" | "trait" | "type" | "fn" | "const" | "static" | "union"
                    if depth == 0 =>
                {
                    items.insert(next.to_owned());
                }
                "macro_rules" if depth == 0 => {
                    items.extend(tokens.get(index + 2).cloned());
                }
                _ => (),
            }
            index += 1;
        }
        Self { path: path.to_owned(), tokens, items, uses }
    }
}

/// Reads one tree of a `use` and returns the index after it.
fn read_use(tokens: &[String], mut index: usize, prefix: &[String], uses: &mut Vec<Use>) -> usize {
    let mut path = prefix.to_vec();
    while let Some(token) = tokens.get(index) {
        match token.as_str() {
            "::" => index += 1,
            "{" => {
                index += 1;
                while tokens.get(index).is_some_and(|token| token != "}") {
                    index = read_use(tokens, index, &path, uses);
                    if tokens.get(index).is_some_and(|token| token == ",") {
                        index += 1;
                    }
                }
                return index + 1;
            }
            "," | "}" | ";" => break,
            "as" => {
                let name = tokens.get(index + 1).cloned().unwrap_or_default();
                uses.push(Use { name, path });
                return index + 2;
            }
            "self" if !path.is_empty() && path.last().is_some_and(|last| last != "super") => {
                index += 1;
            }
            _ => {
                path.push(token.clone());
                index += 1;
            }
        }
    }
    if let Some(name) = path.last().cloned() {
        uses.push(Use { name, path });
    }
    index
}

struct Crates {
    modules: BTreeMap<Module, SourceFile>,
}

impl Crates {
    /// Returns the other files whose items a module names, in a `use` or in a path.
    fn imports(&self, module: &Module) -> BTreeSet<String> {
        let file = &self.modules[module];
        let used = file.uses.iter().map(|of| match of.path.split_last() {
            Some((last, before)) if last == "*" => match self.resolve(module, before, 0) {
                Some(Target::Module(of)) => self.modules.get(&of).map(|file| file.path.clone()),
                other => path_of(other),
            },
            _ => path_of(self.resolve(module, &of.path, 0)),
        });
        let mut found: BTreeSet<String> = used.flatten().collect();
        let mut index = 0;
        while index < file.tokens.len() {
            let path = path_at(&file.tokens, index);
            if path.len() > 1 && (index == 0 || file.tokens[index - 1] != "::") {
                found.extend(path_of(self.resolve(module, &path, 0)));
            }
            index += (2 * path.len()).saturating_sub(1).max(1);
        }
        found.remove(&file.path);
        found
    }

    /// Returns what a path means in a module; `None` outside these crates.
    fn resolve(&self, module: &Module, path: &[String], depth: u32) -> Option<Target> {
        // A name that is re-exported in a circle has no meaning.
        if depth > 20 {
            return None;
        }
        let (first, rest) = path.split_first()?;
        let start = match first.as_str() {
            "crate" => Target::Module(module[..1].to_vec()),
            "self" => Target::Module(module.clone()),
            "super" => Target::Module(module.split_last()?.1.to_vec()),
            name => match self.member(module, name, depth + 1) {
                Some(found) => found,
                None => {
                    Target::Module(self.modules.get_key_value(&vec![name.to_owned()])?.0.clone())
                }
            },
        };
        rest.iter().try_fold(start, |target, name| match target {
            Target::Item(_) | Target::External => Some(target),
            Target::Module(of) if name == "super" => {
                Some(Target::Module(of.split_last()?.1.to_vec()))
            }
            Target::Module(of) => match self.member(&of, name, depth + 1) {
                Some(found) => Some(found),
                // Only a macro can have defined the item.
                None => self.modules.get(&of).map(|file| Target::Item(file.path.clone())),
            },
        })
    }

    /// Returns what a name means in a module: a submodule, an item, or a name that a `use` brings in.
    fn member(&self, module: &Module, name: &str, depth: u32) -> Option<Target> {
        let file = self.modules.get(module)?;
        let submodule: Module = module.iter().cloned().chain([name.to_owned()]).collect();
        if self.modules.contains_key(&submodule) {
            return Some(Target::Module(submodule));
        }
        if file.items.contains(name) {
            return Some(Target::Item(file.path.clone()));
        }
        // A `use` of a crate by its own name would resolve to itself.
        let named = file.uses.iter().filter(|of| of.name == name && of.path != [name.to_owned()]);
        let mut found = named.map(|of| self.resolve(module, &of.path, depth + 1));
        if let Some(found) = found.next() {
            return Some(found.unwrap_or(Target::External));
        }
        let globs = file.uses.iter().filter(|of| of.name == "*");
        globs
            .filter_map(|of| self.resolve(module, &of.path[..of.path.len() - 1], depth + 1))
            .find_map(|target| match target {
                Target::Module(of) if of != *module => self.member(&of, name, depth + 1),
                _ => None,
            })
    }
}

/// Returns the file of an item. A module that is only named is no dependency; a path through it is one.
fn path_of(target: Option<Target>) -> Option<String> {
    match target? {
        Target::Item(path) => Some(path),
        Target::Module(_) | Target::External => None,
    }
}

/// Returns the path `a::b::c` that begins at a token; empty if none begins there.
fn path_at(tokens: &[String], index: usize) -> Vec<String> {
    let is_name = |token: &String| token.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let mut path = Vec::new();
    let mut at = index;
    while let Some(token) = tokens.get(at).filter(|token| is_name(token)) {
        path.push(token.clone());
        if tokens.get(at + 1).is_none_or(|token| token != "::") {
            break;
        }
        at += 2;
    }
    path
}

#[test]
fn imports_are_resolved_through_re_exports_to_the_defining_file() {
    let files = [
        ("crates/core/src/lib.rs", "pub mod a; pub mod b;"),
        ("crates/core/src/a/mod.rs", "mod deep; pub use deep::Thing; pub struct Own;"),
        ("crates/core/src/a/deep.rs", "use super::Own; pub struct Thing;"),
        (
            "crates/core/src/b.rs",
            "use crate::a::{self, Thing as T}; fn f() { a::Own; std::fs::read(); }",
        ),
        ("src/main.rs", "mod c; use snakes_core::a::Thing; fn main() {}"),
        ("src/c.rs", "fn g() { snakes_core::a::Own; crate::main(); }"),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let graph = import_graph(&files);
    let targets = |path: &str| graph[path].iter().map(String::as_str).collect::<Vec<_>>();
    let (deep, module) = ("crates/core/src/a/deep.rs", "crates/core/src/a/mod.rs");
    assert_eq!(targets("crates/core/src/lib.rs"), [""; 0]);
    assert_eq!(targets(module), [deep]);
    assert_eq!(targets(deep), [module]);
    assert_eq!(targets("crates/core/src/b.rs"), [deep, module]);
    assert_eq!(targets("src/main.rs"), [deep]);
    assert_eq!(targets("src/c.rs"), [module, "src/main.rs"]);
    let circle = [deep, module].map(str::to_owned);
    assert_eq!(circles(&graph), [BTreeSet::from(circle)]);
}
