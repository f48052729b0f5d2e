//! A web page that plays champions, simulates them again, and evolves them further.
//!
//! The page is one file: its script, its style, the core as WebAssembly, and the data. It makes no network requests. Names from
//! files appear only as text: in the data as JSON without `<`, in the markup with every special character escaped.

mod base85;
mod data;
mod drawing;
mod markup;
mod run_report;

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::source::ExportSource;
use super::{ExportError, ExportProgress};
use data::PageData;
use snakes_core::ENGINE_VERSION;
use snakes_core::save::store_text;

/// The core as a compressed WebAssembly module, made by `web/build`.
const CORE: &[u8] = include_bytes!("../../../../assets/page-core.wasm.gz");
/// Parts of the script, in their order.
const SCRIPT: [&str; 6] = [
    include_str!("../../../../web/page/scene.js"),
    include_str!("../../../../web/page/motion.js"),
    include_str!("../../../../web/page/simulation.js"),
    include_str!("../../../../web/page/charts.js"),
    include_str!("../../../../web/page/main.js"),
    include_str!("../../../../web/page/compute.js"),
];
const STYLE: &str = include_str!("../../../../web/page/page.css");
const TEMPLATE: &str = include_str!("../../../../web/page/page.html");

/// Writes a page with champions that race on one stage, or with a run whose champions are shown one at a time.
pub(super) fn write_page(
    source: &ExportSource,
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), ExportError> {
    let data = PageData::recorded(source, progress)?;
    Ok(store_text(path, &page(source, &data))?)
}

/// Returns the text of the page.
fn page(source: &ExportSource, data: &PageData) -> String {
    filled(TEMPLATE, &parts(source, data))
}

/// Returns the names in the template, each with the text that replaces it.
fn parts(source: &ExportSource, data: &PageData) -> [(&'static str, String); 12] {
    let script = format!("\n\"use strict\";\n{}", SCRIPT.concat());
    let hash = format!("sha256-{}", STANDARD.encode(Sha256::digest(script.as_bytes())));
    // Within a script element, `<` could end the element or begin a comment.
    let json = serde_json::to_string(data).unwrap_or_default().replace('<', "\\u003c");
    [
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("engine", ENGINE_VERSION.to_string()),
        ("script-hash", hash),
        ("title", markup::escaped(&data.title)),
        ("lead", markup::escaped(&data.lead)),
        ("style", STYLE.to_owned()),
        ("poster", drawing::of(&data.champions)),
        ("facts", markup::facts(source, &data.champions)),
        ("run", source.run.as_ref().map(run_report::of).unwrap_or_default()),
        ("data", json),
        ("core", base85::encoded(CORE)),
        ("script", script),
    ]
}

/// Replaces each `{{name}}` of a template by its text. The inserted texts are not searched for names. A test checks that the page's
/// template has no unknown names.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, behind) = after.split_once("}}").unwrap_or((after, ""));
        text += before;
        text += parts.iter().find(|(of, _)| *of == name).map_or("", |(_, part)| part);
        rest = behind;
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::ExportedChampion;
    use crate::run::RunControl;
    use snakes_core::save::shipped_champion;

    #[test]
    fn every_name_in_the_template_has_its_text_and_every_text_its_name() {
        let mut loaded = shipped_champion().expect("well formed");
        loaded.champion.trial.duration_s = 0.5;
        // A champion's name that looks like a placeholder must stay a name.
        let name = "{{core}}".to_owned();
        let champion = ExportedChampion { name, file: "a.ron".into(), loaded, note: None };
        let source = ExportSource { champions: vec![champion], run: None };
        let control = RunControl::default();
        let progress = ExportProgress::new(&|_| (), &control);
        let data = PageData::recorded(&source, &progress).expect("not cancelled");
        let parts = parts(&source, &data);
        let of_template = TEMPLATE.split("{{").skip(1).filter_map(|text| text.split_once("}}"));
        let of_template: Vec<&str> = of_template.map(|(name, _)| name).collect();
        for name in &of_template {
            assert!(parts.iter().any(|(of, _)| of == name), "{name} has no text");
        }
        for (name, _) in &parts {
            assert!(of_template.contains(name), "{name} is not in the template");
        }
        assert!(page(&source, &data).contains("<h1>{{core}}</h1>"));
    }
}
