//! Exported pages in Chromium: they play, compute the same bits, execute no text from a file, and use no network.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use snakes_core::ENGINE_VERSION;
use snakes_core::evolve::begin;
use snakes_core::save::{champion_text, load_champion, parse_champion, shipped_champion};
use snakes_core::score::evaluate;
use snakes_lab::export::ExportSource;
use snakes_lab::run::verify::golden_plans;

use super::models::champion_of;
use super::{peer, peer_script, succeed};
use crate::program::folder;

/// Returns a command that opens pages, if Node.js, its packages and Chromium are installed.
pub fn browser(test: &str) -> Option<Command> {
    let script = peer_script("page.mjs");
    let script = script.to_str().expect("text");
    peer("node", &[script, "probe"], test).map(|mut node| {
        node.arg(script);
        node
    })
}

fn export(files: &[&Path], page: &Path) {
    let files: Vec<_> = files.iter().map(|file| file.to_path_buf()).collect();
    super::export(ExportSource::read(&files).expect("read"), page);
}

fn found(browser: &mut Command) -> Value {
    serde_json::from_str(&succeed(browser)).expect("JSON")
}

fn saved(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("saves").join(name)
}

#[test]
fn a_page_plays_computes_the_same_bits_and_asks_nothing_of_a_network() {
    let Some(mut browser) = browser("a page in Chromium") else { return };
    let folder = folder();
    let page = folder.path().join("climber.html");
    export(&[&saved("climber.ron")], &page);
    let bytes = std::fs::metadata(&page).expect("a page").len();
    assert!(bytes < 1_500_000, "{bytes} bytes");
    let found = found(browser.arg("visit").arg(&page).arg(folder.path()));
    println!("first frame after {} ms, {bytes} bytes", found["firstFrameMs"]);
    assert_eq!(found["errors"], serde_json::json!([]), "{found}");
    let requests = found["requests"].as_array().expect("a list");
    let is_local = |url: &Value| {
        ["file:", "blob:"]
            .iter()
            .any(|start| url.as_str().is_some_and(|url| url.starts_with(start)))
    };
    assert!(requests.iter().all(is_local), "{requests:?}");
    assert_eq!(found["check"], "equal");
    assert!(found["text"].as_str().expect("text").contains("the same, bit for bit"));
    assert_eq!(found["held"][0], found["held"][1], "it holds");
    assert_eq!(found["scrubbed"], 2.0);
    assert!(found["scrolledTo"].as_f64().expect("a number") > 0.0, "the wheel scrolls the page");
    assert_eq!((&found["lanes"], &found["lanesWithoutTwin"]), (&2.into(), &1.into()));
    assert!(found["twin"].as_str().expect("text").starts_with("On friction 0.20: "), "{found}");
    let numbers = found["twinNumbers"].as_str().expect("text");
    assert!(numbers.contains(" of 10") && numbers.contains(" kJ"), "{numbers}");
    assert!(found["evolved"].as_str().expect("text").contains("best: "), "{found}");
    let text = found["saved"].as_str().expect("text");
    let from_page = parse_champion(Path::new("saved"), text).expect("a champion");
    let own = load_champion(&saved("climber.ron")).expect("a champion");
    assert!(from_page == own, "the champion's own file");
    assert_eq!((&found["overflow"], &found["phoneOverflow"]), (&0.into(), &0.into()));
    assert!(found["phoneTurned"].as_f64().expect("a number").abs() > 0.1);
    let plain = found["withoutScripts"].as_str().expect("text");
    for part in ["411cfb816946c8fb", "26.00 m", "at most 26.00 m", "Gallops up the stairs"] {
        assert!(plain.contains(part), "{part} is not in {plain}");
    }
    assert_eq!(found["hasDrawing"], true);
}

#[test]
fn a_twin_gets_further_than_its_champion_and_disturbs_no_check() {
    let Some(mut browser) = browser("a twin in Chromium") else { return };
    let folder = folder();
    let mut champion = load_champion(&saved("climber.ron")).expect("a champion").champion;
    let good = champion.trial.surface.friction;
    champion.trial.surface.friction = 0.02;
    champion.evaluation = evaluate(&champion.genome, &champion.trial);
    let reached_m = champion.evaluation.centre_y_m;
    let (file, page) = (folder.path().join("slippery.ron"), folder.path().join("page.html"));
    std::fs::write(&file, champion_text(&champion, None, &[]).expect("written")).expect("written");
    export(&[&file], &page);
    let found = found(browser.arg("twin").arg(&page).arg(good.to_string()));
    assert_eq!((&found["errors"], &found["check"]), (&serde_json::json!([]), &"equal".into()));
    let words = found["words"].as_str().expect("text");
    assert!(words.contains("stands on the landing"), "{words}");
    let middle_m = found["middle"].as_f64().expect("a number");
    assert!(middle_m > 20.0 && reached_m < 15.0, "{middle_m} m, its champion {reached_m} m");
    assert_eq!(found["frames"], champion.trial.steps() + 1);
}

#[test]
fn names_with_markup_are_text_in_a_page() {
    let Some(mut browser) = browser("hostile names in Chromium") else { return };
    let folder = folder();
    let hostile = "a<img src=x onerror=alert(1)>\"'&<";
    let copy = folder.path().join(format!("{hostile}.ron"));
    std::fs::copy(saved("climber.ron"), &copy).expect("copied");
    let page = folder.path().join("page.html");
    export(&[&copy, &saved("fast.ron")], &page);
    let text = std::fs::read_to_string(&page).expect("a page");
    assert!(!text.contains("<img"), "no markup of a name");
    let picture = folder.path().join("page.png");
    let found = found(browser.arg("moment").arg(&page).args(["1", "side"]).arg(picture));
    assert_eq!(found["errors"], serde_json::json!([]), "{found}");
    assert!(found["text"].as_str().expect("text").contains(hostile));
    assert_eq!(found["check"], "equal");
}

#[test]
fn the_core_of_a_page_computes_the_golden_trajectories() {
    let Some(mut browser) = browser("golden trajectories in Chromium") else { return };
    let folder = folder();
    let page = folder.path().join("page.html");
    export(&[&saved("climber.ron")], &page);
    let plans = golden_plans().expect("well formed");
    let mut texts = vec![
        champion_text(&shipped_champion().expect("well formed").champion, None, &[])
            .expect("written"),
    ];
    let mut expected = vec!["411cfb816946c8fb".to_owned()];
    for (_, plan) in &plans {
        let genome = begin(plan).ask().swap_remove(0).genome;
        let champion = champion_of(genome, plan.trial_in(1));
        texts.push(champion_text(&champion, None, &[]).expect("written"));
        expected.push(format!("{:016x}", champion.evaluation.trace_hash));
    }
    let list = folder.path().join("champions.json");
    std::fs::write(&list, serde_json::to_string(&texts).expect("JSON")).expect("written");
    let found = found(browser.arg("hashes").arg(&page).arg(&list));
    assert_eq!(
        found["engine"], ENGINE_VERSION,
        "assets/page-core.wasm.gz is older than the engine: run web/build"
    );
    let hashes: Vec<&str> =
        found["hashes"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    for (((what, _), found), expected) in plans.iter().zip(&hashes[1..]).zip(&expected[1..]) {
        assert_eq!(found, expected, "{what}");
    }
    assert_eq!(hashes, expected);
    println!("{} trajectories", hashes.len());
}

/// Describes the snake in a picture: width divided by height of its bounding box, and within that box the middles of the red and of
/// the blue pixels, from 0 to 1.
#[cfg(all(feature = "studio", target_os = "linux"))]
fn outline(path: &Path) -> [f64; 5] {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut bytes).expect("a picture");
    let samples = info.color_type.samples();
    let (mut reds, mut blues) = (Vec::new(), Vec::new());
    for (index, pixel) in bytes[..info.buffer_size()].chunks_exact(samples).enumerate() {
        let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(f64::from);
        let at = [(index % info.width as usize) as f64, (index / info.width as usize) as f64];
        // The cyan of climbed steps and the blue of the sky do not count.
        if r > 80.0 && g < 0.45 * r && b < 0.45 * r {
            reds.push(at);
        } else if b > 70.0 && r < 0.55 * b && g < 0.6 * b {
            blues.push(at);
        }
    }
    assert!(reds.len() > 500 && blues.len() > 300, "{} red, {} blue", reds.len(), blues.len());
    let ends = |axis: usize| {
        let parts = reds.iter().chain(&blues).map(|at| at[axis]);
        parts.fold((f64::MAX, f64::MIN), |(least, most), part| (least.min(part), most.max(part)))
    };
    let ((left, right), (top, bottom)) = (ends(0), ends(1));
    let middle = |of: &[[f64; 2]], axis: usize, low: f64, high: f64| {
        let sum: f64 = of.iter().map(|at| at[axis]).sum();
        (sum / of.len() as f64 - low) / (high - low)
    };
    [
        (right - left) / (bottom - top),
        middle(&reds, 0, left, right),
        middle(&reds, 1, top, bottom),
        middle(&blues, 0, left, right),
        middle(&blues, 1, top, bottom),
    ]
}

#[cfg(all(feature = "studio", target_os = "linux"))]
#[test]
fn a_page_draws_the_snake_that_the_studio_draws() {
    let Some(browser) = browser("a moment in Chromium") else { return };
    if super::films::lacks("a moment in the studio", false) {
        return;
    }
    let folder = folder();
    let page = folder.path().join("page.html");
    export(&[&saved("climber.ron")], &page);
    for moment in ["3", "9"] {
        let [ours, theirs] = ["page.png", "studio.png"].map(|name| folder.path().join(name));
        let climber = saved("climber.ron");
        let order = format!(
            "export {} --at {moment} --camera side --size 960x540 -o {}",
            climber.display(),
            theirs.display()
        );
        crate::program::stdout_of(folder.path(), &order);
        let mut browser = Command::new(browser.get_program());
        browser
            .arg(peer_script("page.mjs"))
            .arg("moment")
            .arg(&page)
            .args([moment, "side"])
            .arg(&ours);
        found(&mut browser);
        let (ours, theirs) = (outline(&ours), outline(&theirs));
        println!("at {moment} s: {ours:.3?} in the page, {theirs:.3?} in the studio");
        assert!((ours[0] / theirs[0] - 1.0).abs() < 0.12, "{ours:?} {theirs:?}");
        let off = ours[1..].iter().zip(&theirs[1..]).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 0.06, "{ours:?} {theirs:?}");
    }
}
