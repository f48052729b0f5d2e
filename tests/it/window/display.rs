//! A virtual display with the program on it.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::program::{folder, snakes};

/// The program in a window on a display of its own.
pub struct Studio {
    program: Mutex<Child>,
    xvfb: Child,
    display: String,
    window: String,
    screen: PathBuf,
    folder: tempfile::TempDir,
    /// Software rendering takes every core there is: one window at a time.
    _turn: MutexGuard<'static, ()>,
}

/// What is on the display.
pub struct Picture {
    width: u32,
    pixels: Vec<[u8; 3]>,
}

static TURN: Mutex<()> = Mutex::new(());
static SKIPPED: AtomicU32 = AtomicU32::new(0);
/// Software rendering on a busy machine draws a few frames a second; nothing here takes minutes.
const PATIENCE: Duration = Duration::from_secs(120);
const BETWEEN_LOOKS: Duration = Duration::from_millis(100);
/// Longer than a frame takes: between a press and the next move, egui and Bevy must have drawn one.
const A_FRAME: Duration = Duration::from_millis(700);

/// Skips a test, or fails where skipping is not allowed.
fn skip(test: &str, reason: &str) {
    let required = std::env::var("SNAKES_WINDOW_TESTS").is_ok_and(|value| value == "required");
    assert!(!required, "window test {test} cannot run: {reason}");
    let skipped = SKIPPED.fetch_add(1, Ordering::SeqCst) + 1;
    let line = format!("window tests skipped so far: {skipped} ({test}: {reason})\n");
    // Not through eprintln!, which the test runner swallows when a test passes.
    std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).expect("standard error");
}

/// Whether there is no Vulkan driver, so that nothing can be drawn; the test then is skipped.
pub fn lacks_a_driver(test: &str) -> bool {
    let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let is_there =
        |folder: &&str| std::fs::read_dir(folder).is_ok_and(|mut list| list.next().is_some());
    if folders.iter().any(is_there) {
        return false;
    }
    skip(test, "no Vulkan driver is installed");
    true
}

fn is_installed(tool: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(tool).is_file())
}

impl Studio {
    /// Opens the program at 800x600 with the keyboard on it; none where that is not possible.
    pub fn open(test: &str, arguments: &str) -> Option<Self> {
        Self::open_sized(test, arguments, (800, 600))
    }

    /// Opens the program in a window of this size.
    pub fn open_sized(test: &str, arguments: &str, (width, height): (u32, u32)) -> Option<Self> {
        if let Some(missing) = ["Xvfb", "xdotool"].into_iter().find(|tool| !is_installed(tool)) {
            skip(test, &format!("{missing} is not installed"));
            return None;
        }
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = folder();
        let mut xvfb = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &format!("{width}x{height}x24")])
            .args(["-nolisten", "tcp", "-fbdir"])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let stdout = xvfb.stdout.as_mut().expect("piped");
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb says its display");
        let display = format!(":{}", number.trim());
        let program = snakes(folder.path(), &format!("{arguments} --window-size {width}x{height}"))
            .env("DISPLAY", &display)
            .env("XDG_RUNTIME_DIR", folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let screen = folder.path().join("Xvfb_screen0");
        let mut studio = Self {
            program: Mutex::new(program),
            xvfb,
            display,
            window: String::new(),
            screen,
            folder,
            _turn: turn,
        };
        if let Err(reason) = studio.find_window() {
            assert!(reason.contains("no graphics driver"), "{test}: {reason}");
            skip(test, "no Vulkan driver is installed");
            return None;
        }
        studio.xdotool(&["windowfocus", "--sync", &studio.window]);
        studio.wait_for_title("showing");
        Some(studio)
    }

    /// The program's process.
    pub fn process(&self) -> u32 {
        self.program.lock().expect("no panic").id()
    }

    /// Waits for the window; the error is what the program said when it ended instead.
    fn find_window(&mut self) -> Result<(), String> {
        let started = Instant::now();
        loop {
            let program = self.program.get_mut().expect("no panic");
            if program.try_wait().expect("a status").is_some() {
                let mut said = String::new();
                let stderr = program.stderr.as_mut().expect("piped");
                stderr.read_to_string(&mut said).expect("read");
                return Err(said);
            }
            let found = self.xdotool_quietly(&["search", "--onlyvisible", "--name", "Snakes"]);
            if let Some(window) = found.lines().next() {
                self.window = window.to_owned();
                return Ok(());
            }
            assert!(started.elapsed() < PATIENCE, "no window appeared");
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// The window's title.
    pub fn title(&self) -> String {
        self.xdotool_quietly(&["getwindowname", &self.window]).trim().to_owned()
    }

    /// Finished generations, as the title has them.
    pub fn generations(&self) -> u32 {
        let title = self.title();
        let number = title.split(" of ").next().and_then(|head| head.rsplit(' ').next());
        number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("title: {title}"))
    }

    /// Waits until so many generations are finished, or more: a fast run passes any number between two looks.
    pub fn wait_for_generations(&self, count: u32) {
        let title = || format!("{count} generations in {:?}", self.title());
        self.wait(|| self.generations() >= count, title);
    }

    /// Waits until the title contains `part`.
    pub fn wait_for_title(&self, part: &str) {
        self.wait(|| self.title().contains(part), || format!("{part:?} in {:?}", self.title()));
    }

    /// Waits until the title does not contain `part`.
    pub fn wait_for_title_without(&self, part: &str) {
        self.wait(|| !self.title().contains(part), || format!("no {part:?} in {:?}", self.title()));
    }

    /// Pauses evolution, so that no newcomer takes the stage, and puts the first champion on it.
    pub fn pause_evolution(&self) {
        if !self.title().contains("finished") {
            self.key("e");
            self.wait(
                || ["paused", "finished"].iter().any(|word| self.title().contains(word)),
                || format!("paused in {:?}", self.title()),
            );
        }
        self.key("0");
        self.wait_for_title("showing saved champion");
    }

    /// Presses and releases a key.
    pub fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
        std::thread::sleep(A_FRAME);
    }

    /// Clicks a button of the evolution panel.
    pub fn click_button(&self, label: &str) {
        let x = match label {
            "Start" | "Pause" => "56",
            "One generation" => "159",
            "Reset" => "249",
            // Not a button: a place in the panel where there is nothing.
            "the empty panel" => return self.click("300", "60"),
            "Continue a stopped run" => return self.click("100", "277"),
            "the first stopped run" => return self.click("100", "308"),
            "Simulate here" => return self.click("735", "468"),
            "World" => return self.click("163", "59"),
            "The ground has a surface of its own" => return self.click("41", "285"),
            "As recorded" => return self.click("735", "468"),
            "Keep" => return self.click("369", "157"),
            "Drop" => return self.click("427", "157"),
            "From the start" => return self.click("350", PLAYER_Y),
            "Step back" => return self.click("382", PLAYER_Y),
            "Hold" => return self.click("414", PLAYER_Y),
            "Step forward" => return self.click("446", PLAYER_Y),
            "Side" => return self.click("421", "30"),
            "Top" => return self.click("466", "30"),
            "Free" => return self.click("511", "30"),
            "Follow" => return self.click("366", "30"),
            "the middle of the torques" => return self.click("560", "545"),
            "the start of the torques" => return self.click("336", "545"),
            other => panic!("no button {other}"),
        };
        self.click(x, BUTTONS_Y);
    }

    /// Clicks a row of the list of champions: 0 is the saved one, 1 the first generation's.
    pub fn click_champion(&self, row: u32) {
        self.click("100", &(CHAMPIONS_Y + ROW_HEIGHT * row).to_string());
    }

    /// Replaces the seed by `text` and leaves the field.
    pub fn type_seed(&self, text: &str) {
        self.xdotool(&["mousemove", "90", SEED_Y]);
        std::thread::sleep(A_FRAME);
        // A double click selects the number that stands there.
        self.xdotool(&["click", "--repeat", "2", "--delay", "60", "1"]);
        std::thread::sleep(A_FRAME);
        self.xdotool(&["type", "--delay", "200", text]);
        self.key("Return");
    }

    /// Clicks a row of the list of champions with Shift held down.
    pub fn shift_click_champion(&self, row: u32) {
        self.xdotool(&["keydown", "shift"]);
        std::thread::sleep(A_FRAME);
        self.click_champion(row);
        self.xdotool(&["keyup", "shift"]);
        std::thread::sleep(A_FRAME);
    }

    /// Clicks a point of the window.
    pub fn click_at(&self, (x, y): (u32, u32)) {
        self.click(&x.to_string(), &y.to_string());
    }

    /// Clicks a point of the window twice.
    pub fn double_click_at(&self, at: (u32, u32)) {
        self.move_to(at);
        self.xdotool(&["click", "1"]);
        // In frames of their own, and yet near each other.
        std::thread::sleep(std::time::Duration::from_millis(250));
        self.xdotool(&["click", "1"]);
        std::thread::sleep(A_FRAME);
    }

    /// Drags with the left button and holds on at the end until `then` has happened.
    pub fn drag_and_hold(&self, from: (u32, u32), to: (u32, u32), then: impl FnOnce()) {
        self.move_to(from);
        self.xdotool(&["mousedown", "1"]);
        std::thread::sleep(A_FRAME);
        self.move_to(to);
        then();
        self.xdotool(&["mouseup", "1"]);
        std::thread::sleep(A_FRAME);
    }

    /// The moment at which the stage is held, in simulated seconds, as the title has it.
    pub fn held_at_s(&self) -> f64 {
        let title = self.title();
        let text = title.rsplit_once("held at ").and_then(|(_, rest)| rest.strip_suffix(" s"));
        text.and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("title: {title}"))
    }

    /// Where the program keeps what it saves, unless told otherwise.
    pub fn folder(&self) -> &std::path::Path {
        self.folder.path()
    }

    fn click(&self, x: &str, y: &str) {
        self.xdotool(&["mousemove", x, y]);
        std::thread::sleep(A_FRAME);
        // Press and release at once: egui takes a button held for longer for something else.
        self.xdotool(&["click", "1"]);
        std::thread::sleep(A_FRAME);
    }

    /// Drags with a mouse button from one point of the window to another.
    pub fn drag(&self, button: u32, from: (u32, u32), to: (u32, u32)) {
        let button = button.to_string();
        self.move_to(from);
        self.xdotool(&["mousedown", &button]);
        std::thread::sleep(A_FRAME);
        self.move_to(to);
        self.xdotool(&["mouseup", &button]);
        std::thread::sleep(A_FRAME);
    }

    /// Turns the wheel away from the person, over a point of the window.
    pub fn wheel_up(&self, at: (u32, u32)) {
        self.move_to(at);
        self.xdotool(&["click", "--repeat", "3", "--delay", "50", "4"]);
        std::thread::sleep(A_FRAME);
    }

    /// Moves the pointer.
    pub fn move_to(&self, (x, y): (u32, u32)) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
        std::thread::sleep(A_FRAME);
    }

    /// What is on the display now.
    pub fn picture(&self) -> Picture {
        Picture::of_xwd(&fs::read(&self.screen).expect("Xvfb's screen"))
    }

    /// Waits for a picture that `is_it`.
    pub fn picture_with(&self, is_it: impl Fn(&Picture) -> bool) -> Picture {
        let started = Instant::now();
        loop {
            let picture = self.picture();
            if is_it(&picture) {
                return picture;
            }
            assert!(started.elapsed() < PATIENCE, "waited for a picture, {:?}", self.title());
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// Waits until the stage has stopped changing, with the pointer, which is part of the picture, away.
    pub fn still_picture(&self) -> Picture {
        self.move_to((5, 595));
        let region = |picture: &Picture| picture.region(320, 130, 480, 310);
        let mut before = self.picture();
        let mut equal = 0;
        let started = Instant::now();
        // A slow camera can look still for one frame; for three it is.
        while equal < 3 {
            std::thread::sleep(A_FRAME);
            let now = self.picture();
            equal = if region(&before) == region(&now) { equal + 1 } else { 0 };
            assert!(started.elapsed() < PATIENCE, "the picture never came to rest");
            before = now;
        }
        before
    }

    /// Quits by the keyboard; the program's exit code.
    pub fn quit(self) -> Option<i32> {
        self.xdotool(&["key", "ctrl+q"]);
        let started = Instant::now();
        loop {
            let status = self.program.lock().expect("no panic").try_wait().expect("a status");
            if let Some(status) = status {
                return status.code();
            }
            assert!(started.elapsed() < PATIENCE, "the program did not end");
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    fn wait(&self, is_it: impl Fn() -> bool, what: impl Fn() -> String) {
        let started = Instant::now();
        while !is_it() {
            assert!(started.elapsed() < PATIENCE, "waited in vain for {}", what());
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    fn xdotool(&self, arguments: &[&str]) {
        let status = self.xdotool_command(arguments).status().expect("xdotool starts");
        assert!(status.success(), "xdotool {arguments:?}: {status}");
    }

    fn xdotool_quietly(&self, arguments: &[&str]) -> String {
        let output = self.xdotool_command(arguments).output().expect("xdotool starts");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn xdotool_command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new("xdotool");
        command.args(arguments).env("DISPLAY", &self.display).current_dir(self.folder.path());
        command
    }
}

/// Where things are in the panel, in pixels at a scale of 1.
const BUTTONS_Y: &str = "133";
const SEED_Y: &str = "215";
const PLAYER_Y: &str = "500";
const CHAMPIONS_Y: u32 = 496;
const ROW_HEIGHT: u32 = 31;

impl Drop for Studio {
    fn drop(&mut self) {
        // Both may have ended already.
        let program = self.program.get_mut().unwrap_or_else(PoisonError::into_inner);
        let _ = program.kill();
        let _ = program.wait();
        let _ = self.xvfb.kill();
        let _ = self.xvfb.wait();
    }
}

impl Picture {
    /// Reads the XWD file that Xvfb keeps its screen in: a header of big-endian words, a colour map,
    /// rows of 32-bit pixels with blue in the lowest byte.
    fn of_xwd(file: &[u8]) -> Self {
        let word = |index: usize| {
            let bytes = file[index * 4..index * 4 + 4].try_into().expect("four bytes");
            u32::from_be_bytes(bytes)
        };
        let (header, width, height) = (word(0) as usize, word(4), word(5));
        let (bits, row_bytes, colours) = (word(11), word(12) as usize, word(19) as usize);
        assert_eq!(bits, 32, "Xvfb at depth 24 has pixels of 32 bits");
        let rows = &file[header + colours * 12..];
        let pixels = rows
            .chunks_exact(row_bytes)
            .take(height as usize)
            .flat_map(|row| row.chunks_exact(4).take(width as usize))
            .map(|pixel| [pixel[2], pixel[1], pixel[0]])
            .collect();
        Self { width, pixels }
    }

    /// The middle of a square of the stage all of whose pixels look like `is`.
    pub fn find(&self, is: fn(&[u8; 3]) -> bool) -> Option<(u32, u32)> {
        const SIDE: u32 = 9;
        let corners =
            (130..430).step_by(3).flat_map(|y| (540..780).step_by(3).map(move |x| (x, y)));
        let mut squares = corners.filter(|&(x, y)| self.region(x, y, SIDE, SIDE).iter().all(is));
        squares.next().map(|(x, y)| (x + SIDE / 2, y + SIDE / 2))
    }

    /// Writes it as PNG.
    pub fn store(&self, path: &std::path::Path) {
        let height = self.pixels.len() as u32 / self.width;
        let rgb = self.pixels.iter().flatten().copied().collect();
        let picture = snakes_and_stairs::save::Picture { width: self.width, height, rgb };
        snakes_and_stairs::save::store_picture(path, &picture).expect("written");
    }

    /// The pixels of a rectangle, row by row, as red, green, blue.
    pub fn region(&self, left: u32, top: u32, width: u32, height: u32) -> Vec<[u8; 3]> {
        let row = |y: u32| {
            let start = (y * self.width + left) as usize;
            &self.pixels[start..start + width as usize]
        };
        (top..top + height).flat_map(row).copied().collect()
    }
}
