//! Starts the studio of Snakes & Stairs without a console window, for a double click. A file that is dropped on it is replayed.
//!
//! `snakes.exe`, which lies beside it, is a program for the console, so that it prints and can be waited for.
#![windows_subsystem = "windows"]

use std::os::windows::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};

/// [Process creation flags](https://learn.microsoft.com/windows/win32/procthread/process-creation-flags).
const CREATE_NO_WINDOW: u32 = 0x0800_0000;
const CREATE_NEW_CONSOLE: u32 = 0x0000_0010;

fn main() -> std::io::Result<()> {
    let own = std::env::current_exe()?;
    let folder = own.parent().unwrap_or(Path::new("."));
    // The working directory of a double click may be any; the folder of saves is the one beside the program.
    let files = std::env::args_os().skip(1).map(std::path::absolute);
    let files = files.collect::<std::io::Result<Vec<_>>>()?;
    let mut command = Command::new(folder.join("snakes.exe"));
    if !files.is_empty() {
        command.args(["replay", "--desktop"]).args(files);
    }
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::null());
    let problem = match command.creation_flags(CREATE_NO_WINDOW).output() {
        Ok(output) if output.status.success() => return Ok(()),
        Ok(output) => output.stderr,
        Err(error) => format!("snakes.exe cannot be started: {error}").into_bytes(),
    };
    // Without a console the error would be lost: a new one shows it, in UTF-8.
    let path = std::env::temp_dir().join(format!("snakes-{}.txt", std::process::id()));
    std::fs::write(&path, problem)?;
    let show = format!("/d /c \"chcp 65001 >nul & type \"{}\" & pause\"", path.display());
    let shown = Command::new("cmd").raw_arg(show).creation_flags(CREATE_NEW_CONSOLE).status();
    std::fs::remove_file(&path)?;
    shown.map(|_| ())
}
