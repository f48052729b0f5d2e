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
        if let Some(missing) = ["Xvfb", "xdotool"].into_iter().find(|tool| !is_installed(tool)) {
            skip(test, &format!("{missing} is not installed"));
            return None;
        }
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = folder();
        let mut xvfb = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp", "-fbdir"])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let stdout = xvfb.stdout.as_mut().expect("piped");
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb says its display");
        let display = format!(":{}", number.trim());
        let program = snakes(folder.path(), &format!("{arguments} --window-size 800x600"))
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
            "Simulate here" => return self.click("397", "562"),
            "World" => return self.click("163", "59"),
            "The ground has a surface of its own" => return self.click("41", "285"),
            "As recorded" => return self.click("397", "562"),
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

    fn move_to(&self, (x, y): (u32, u32)) {
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
        let region = |picture: &Picture| picture.region(320, 130, 480, 370);
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

    /// The pixels of a rectangle, row by row, as red, green, blue.
    pub fn region(&self, left: u32, top: u32, width: u32, height: u32) -> Vec<[u8; 3]> {
        let row = |y: u32| {
            let start = (y * self.width + left) as usize;
            &self.pixels[start..start + width as usize]
        };
        (top..top + height).flat_map(row).copied().collect()
    }
}
