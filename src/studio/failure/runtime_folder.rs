//! The folder of a session's sockets, which the variable `XDG_RUNTIME_DIR` names.
//!
//! It is missing after `su`, in containers and over some remote connections. Then a layer of the Vulkan drivers (Mesa's
//! device selection) writes the same error to standard error each time devices are listed, twice at every start,
//! although nothing is wrong.

/// Starts this program again with the folder that the variable usually names, if it is missing. Then each library that
/// looks for a socket there finds none, without a word. Says so in one line through `say`.
#[cfg(target_os = "linux")]
pub fn name_runtime_folder(say: impl FnOnce(&str)) {
    use std::os::unix::fs::MetadataExt;
    use std::os::unix::process::CommandExt;
    use std::path::Path;

    if std::env::var_os(VARIABLE).is_some_and(|folder| !folder.is_empty()) {
        return;
    }
    // A process belongs to the user who started it, and so does its entry among the processes.
    let own = Path::new("/proc/self").metadata();
    let (Ok(program), Ok(own)) = (std::env::current_exe(), own) else { return };
    let folder = format!("/run/user/{}", own.uid());
    say(&format!("note: {VARIABLE} is not set, so {folder} is used"));
    let mut command = std::process::Command::new(program);
    // The process keeps its number. `exec` returns only on failure; then the errors are as harmless as before.
    let _ = command.args(std::env::args_os().skip(1)).env(VARIABLE, folder).exec();
}

/// Other systems have no such folder.
#[cfg(not(target_os = "linux"))]
pub fn name_runtime_folder(_say: impl FnOnce(&str)) {}

#[cfg(target_os = "linux")]
const VARIABLE: &str = "XDG_RUNTIME_DIR";
