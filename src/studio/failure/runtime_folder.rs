//! The folder of the login session's sockets, which the variable `XDG_RUNTIME_DIR` names.
//!
//! The variable is missing after `su`, in containers and over some remote connections. A layer of the Vulkan drivers
//! (Mesa's device selection) then writes a harmless error to standard error each time devices are listed, twice at
//! every start.

/// Restarts the program with the usual folder in `XDG_RUNTIME_DIR` if the variable is missing or empty. Libraries that
/// look for a socket there then find none, but report no error. Announces the restart in one line through `say`.
#[cfg(target_os = "linux")]
pub fn name_runtime_folder(say: impl FnOnce(&str)) {
    use std::os::unix::fs::MetadataExt;
    use std::os::unix::process::CommandExt;
    use std::path::Path;

    if std::env::var_os(VARIABLE).is_some_and(|folder| !folder.is_empty()) {
        return;
    }
    // The entry of a process in `/proc` belongs to the user who started it.
    let own = Path::new("/proc/self").metadata();
    let (Ok(program), Ok(own)) = (std::env::current_exe(), own) else { return };
    let folder = format!("/run/user/{}", own.uid());
    say(&format!("note: {VARIABLE} is not set, so {folder} is used"));
    let mut command = std::process::Command::new(program);
    // The process keeps its ID. `exec` returns only on failure; the harmless errors then remain.
    let _ = command.args(std::env::args_os().skip(1)).env(VARIABLE, folder).exec();
}

/// Does nothing: other systems have no such variable.
#[cfg(not(target_os = "linux"))]
pub fn name_runtime_folder(_say: impl FnOnce(&str)) {}

#[cfg(target_os = "linux")]
const VARIABLE: &str = "XDG_RUNTIME_DIR";
