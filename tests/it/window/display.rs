//! The program on a virtual display.

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::picture::Picture;
use crate::program::{CLIMBER, folder, snakes};

/// The program in a window on a virtual display of its own.
pub struct Studio {
    program: Mutex<Child>,
    xvfb: Child,
    /// Name of the display.
    pub display: String,
    /// Number of the window in xdotool.
    pub window: String,
    /// Width and height of the window.
    pub size: (i32, i32),
    folder: Arc<tempfile::TempDir>,
    /// Lock that allows one window at a time, because software rendering uses all cores.
    _turn: MutexGuard<'static, ()>,
}

static TURN: Mutex<()> = Mutex::new(());
static SKIPPED: AtomicU32 = AtomicU32::new(0);
/// Timeout of a wait. Software rendering on a busy machine draws a few frames per second.
const PATIENCE: Duration = Duration::from_secs(120);
const BETWEEN_LOOKS: Duration = Duration::from_millis(100);
/// Pause between two pictures that must be equal.
const STILL_FOR: Duration = Duration::from_millis(700);
/// Default width and height of the window: wide enough for all cards over the stage, small enough to be drawn quickly.
const SIZE: (i32, i32) = (1000, 860);

/// Skips a test, or fails where skipping is forbidden.
fn skip(test: &str, reason: &str) {
    let required = std::env::var("SNAKES_WINDOW_TESTS").is_ok_and(|value| value == "required");
    assert!(!required, "window test {test} cannot run: {reason}");
    let skipped = SKIPPED.fetch_add(1, Ordering::SeqCst) + 1;
    let line = format!("window tests skipped so far: {skipped} ({test}: {reason})\n");
    // Not through eprintln!, because the test runner swallows its output when a test passes.
    std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).expect("standard error");
}

/// Returns whether there is no Vulkan driver. The test is then skipped.
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

/// Returns a folder for the search path, with a file manager that shows nothing.
fn file_manager(folder: &Path) -> PathBuf {
    let programs = folder.join("bin");
    let opener = programs.join("xdg-open");
    if !opener.exists() {
        fs::create_dir(&programs).expect("created");
        fs::write(&opener, "#!/bin/sh\nexit 0\n").expect("written");
        fs::set_permissions(&opener, fs::Permissions::from_mode(0o755)).expect("executable");
    }
    programs
}

/// Returns the text of a preferences file with these fields.
pub fn preferences(fields: &str) -> String {
    format!("(kind: \"snakes-and-stairs preferences\", format: 1, preferences: ({fields}))")
}

impl Studio {
    /// Opens the program with the keyboard focus and without the tour; `None` if that is impossible.
    pub fn open(test: &str, arguments: &str) -> Option<Self> {
        Self::open_sized(test, arguments, SIZE)
    }

    /// Opens the program in a window of this size, with a champion that stays on the stage. The tour is skipped unless the
    /// arguments name a preferences file.
    pub fn open_sized(test: &str, arguments: &str, size: (i32, i32)) -> Option<Self> {
        let names_show = ["replay ", "--resume "].iter().any(|word| arguments.contains(word));
        let show = if names_show { String::new() } else { format!("replay {CLIMBER} ") };
        Self::open_plain(test, &format!("{show}{arguments}"), size)
    }

    /// Opens the program without anything to watch, so that it follows evolution.
    pub fn open_following(test: &str, arguments: &str) -> Option<Self> {
        Self::open_plain(test, arguments, SIZE)
    }

    fn open_plain(test: &str, arguments: &str, size: (i32, i32)) -> Option<Self> {
        Self::open_in(&Arc::new(folder()), test, arguments, size, size)
    }

    /// Opens the program with other environment variables.
    pub fn open_with(test: &str, arguments: &str, variables: &[(&str, &str)]) -> Option<Self> {
        Self::open_anywhere(&Arc::new(folder()), test, arguments, (SIZE, SIZE), variables)
    }

    /// Opens the program without anything to watch. `folder` is its working directory and home. The screen may be larger than the
    /// window.
    pub fn open_in(
        folder: &Arc<tempfile::TempDir>,
        test: &str,
        arguments: &str,
        size: (i32, i32),
        screen: (i32, i32),
    ) -> Option<Self> {
        Self::open_anywhere(folder, test, arguments, (size, screen), &[])
    }

    fn open_anywhere(
        folder: &Arc<tempfile::TempDir>,
        test: &str,
        arguments: &str,
        (size, screen): ((i32, i32), (i32, i32)),
        variables: &[(&str, &str)],
    ) -> Option<Self> {
        if let Some(missing) = ["Xvfb", "xdotool"].into_iter().find(|tool| !is_installed(tool)) {
            skip(test, &format!("{missing} is not installed"));
            return None;
        }
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let ((width, height), (screen_width, screen_height)) = (size, screen);
        let mut xvfb = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                &format!("{screen_width}x{screen_height}x24"),
            ])
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
        let mut arguments = format!("{arguments} --window-size {width}x{height} --places {PLACES}");
        if !arguments.contains("--preferences") {
            let path = folder.path().join(PREFERENCES);
            fs::write(path, preferences("tour_is_over: true")).expect("written");
            arguments += &format!(" --preferences {PREFERENCES}");
        }
        // An earlier window with this folder has left its last list.
        let _ = fs::remove_file(folder.path().join(PLACES));
        let program = snakes(folder.path(), &arguments)
            .env("DISPLAY", &display)
            .env("XDG_RUNTIME_DIR", folder.path())
            // Dialogs and file managers must not appear on the desktop of the user who runs the tests.
            .env_remove("DBUS_SESSION_BUS_ADDRESS")
            .env("PATH", file_manager(folder.path()))
            // The log must be plain text, even where it would be coloured.
            .env("NO_COLOR", "1")
            .envs(variables.iter().copied())
            .stderr(fs::File::create(folder.path().join(LOG)).expect("created"))
            .spawn()
            .expect("the program starts");
        let (program, window, folder) = (Mutex::new(program), String::new(), Arc::clone(folder));
        let mut studio = Self { program, xvfb, display, window, size, folder, _turn: turn };
        if let Err(reason) = studio.find_window() {
            assert!(reason.contains("no graphics driver"), "{test}: {reason}");
            skip(test, "no Vulkan driver is installed");
            return None;
        }
        studio.xdotool(&["windowfocus", "--sync", &studio.window]);
        studio.wait_for_title("showing");
        studio.place("The stage");
        Some(studio)
    }

    /// Returns the process id of the program.
    pub fn process(&self) -> u32 {
        self.program.lock().expect("no panic").id()
    }

    /// Waits for the window. The error is the log of the program if it ended instead.
    fn find_window(&mut self) -> Result<(), String> {
        let started = Instant::now();
        loop {
            let program = self.program.get_mut().expect("no panic");
            if program.try_wait().expect("a status").is_some() {
                return Err(self.log());
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

    /// Returns the title of the window.
    pub fn title(&self) -> String {
        self.xdotool_quietly(&["getwindowname", &self.window]).trim().to_owned()
    }

    /// Returns the number of finished generations from the title.
    pub fn generations(&self) -> u32 {
        let title = self.title();
        let number = title.split(" of ").next().and_then(|head| head.rsplit(' ').next());
        number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("title: {title}"))
    }

    /// Waits until at least this many generations are finished. A fast run may pass several between two polls.
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

    /// Pauses evolution, so that no new champion is shown, and shows the saved champion.
    pub fn pause_evolution(&self) {
        if !self.title().contains("finished") {
            self.key("e");
            self.wait(
                || ["paused", "finished"].iter().any(|word| self.title().contains(word)),
                || format!("paused in {:?}", self.title()),
            );
        }
        self.key("0");
        let shows_another =
            || ["showing generation ", "showing a "].iter().any(|of| self.title().contains(of));
        self.wait(|| !shows_another(), || format!("the saved champion in {:?}", self.title()));
    }

    /// Returns the time at which the stage is paused, in simulated seconds, from the title.
    pub fn held_at_s(&self) -> f64 {
        let title = self.title();
        let text = title.rsplit_once("stopped at ").and_then(|(_, rest)| rest.strip_suffix(" s"));
        text.and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("title: {title}"))
    }

    /// Returns the working directory and home of the program.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the current picture of the display.
    pub fn picture(&self) -> Picture {
        let screen = self.folder.path().join("Xvfb_screen0");
        Picture::of_xwd(&fs::read(screen).expect("Xvfb's screen"), self.scene())
    }

    /// Waits for a picture that meets the condition.
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

    /// Waits until the stage is still, without the pointer and without messages, which would disappear later.
    pub fn still_picture(&self) -> Picture {
        self.step_aside();
        let has_no_message = || self.find(|place| place.role == "Status").is_none();
        self.wait(has_no_message, || "messages to go".to_owned());
        let mut before = self.picture();
        let mut equal = 0;
        let started = Instant::now();
        // A slow camera can look still for one frame, but not for three pictures in a row.
        while equal < 3 {
            std::thread::sleep(STILL_FOR);
            self.wait_for_frames(2);
            let now = self.picture();
            equal = if before.scene_pixels() == now.scene_pixels() { equal + 1 } else { 0 };
            assert!(started.elapsed() < PATIENCE, "the picture never came to rest");
            before = now;
        }
        before
    }

    /// Moves the pointer to a point without a tooltip.
    pub fn step_aside(&self) {
        self.move_to((1, self.size.1 - 2));
    }

    /// Returns how the program ended, or `None` while it runs.
    pub fn ended(&self) -> Option<ExitStatus> {
        self.program.lock().expect("no panic").try_wait().expect("a status")
    }

    /// Returns what the program has written to standard error, including its log.
    pub fn log(&self) -> String {
        String::from_utf8_lossy(&fs::read(self.folder.path().join(LOG)).expect("a log"))
            .into_owned()
    }

    /// Quits with the keyboard, closes the display and returns the exit code.
    pub fn quit(self) -> Option<i32> {
        self.end()
    }

    /// Quits with the keyboard and returns the exit code.
    pub fn end(&self) -> Option<i32> {
        self.xdotool(&["key", "ctrl+q"]);
        self.wait(|| self.ended().is_some(), || "the end of the program".to_owned());
        self.ended().and_then(|status| status.code())
    }

    /// Waits for a condition; `what` describes it in the failure message.
    pub fn wait(&self, is_it: impl Fn() -> bool, what: impl Fn() -> String) {
        let started = Instant::now();
        while !is_it() {
            assert!(started.elapsed() < PATIENCE, "waited in vain for {}", what());
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// Runs xdotool with these arguments, and waits for its end.
    pub fn xdotool(&self, arguments: &[&str]) {
        let status = self.xdotool_command(arguments).status().expect("xdotool starts");
        assert!(status.success(), "xdotool {arguments:?}: {status}");
    }

    /// Starts an xdotool that reads commands from its standard input, one per line.
    pub fn xdotool_reader(&self) -> Child {
        let mut command = self.xdotool_command(&["-"]);
        command.stdin(Stdio::piped()).stderr(Stdio::null()).spawn().expect("xdotool starts")
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

/// Name of the file of `--places`.
pub const PLACES: &str = "places.txt";
/// Name of the file with the program's standard error.
const LOG: &str = "stderr.txt";
/// Name of the preferences file.
const PREFERENCES: &str = "studio.ron";

impl Drop for Studio {
    fn drop(&mut self) {
        // Both processes may have ended already.
        let program = self.program.get_mut().unwrap_or_else(PoisonError::into_inner);
        let _ = program.kill();
        let _ = program.wait();
        let _ = self.xvfb.kill();
        let _ = self.xvfb.wait();
    }
}
