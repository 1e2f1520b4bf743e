//! Graphics drivers on a machine without a window system.
//!
//! Mesa's device selection layer asks for a Wayland display and, where `XDG_RUNTIME_DIR` is not set, prints on standard
//! error that it is not. gearcut opens no window, and its standard error is its own: one JSON event a line with
//! `--json`. So the program starts itself anew, as the same process, with the variable set to a folder that does not
//! exist.
//!
//! Roads not taken: setting the variable in the running process, which is unsafe as long as other threads may read the
//! environment; putting another file in place of standard error while drivers are asked, which would swallow the last
//! words of a driver that crashes; leaving the layer out, by which users choose among their GPUs.

/// Comes back at once where drivers have nothing to say; otherwise in the program started anew.
#[cfg(all(feature = "gpu", target_os = "linux"))]
pub fn without_window_system() {
    use std::os::unix::process::CommandExt;
    const FOLDER_OF_WINDOW_SYSTEM: &str = "XDG_RUNTIME_DIR";
    // An empty one is none to the driver.
    if std::env::var_os(FOLDER_OF_WINDOW_SYSTEM).is_some_and(|folder| !folder.is_empty()) {
        return;
    }
    let mut arguments = std::env::args_os();
    let mut anew = std::process::Command::new("/proc/self/exe");
    if let Some(name) = arguments.next() {
        anew.arg0(name);
    }
    // Where this cannot be done, the layer's line on standard error is no reason to stop.
    let _not_started = anew.args(arguments).env(FOLDER_OF_WINDOW_SYSTEM, "/nonexistent").exec();
}

/// Other systems' drivers ask for no such variable, and a build without the GPU backend asks no driver.
#[cfg(not(all(feature = "gpu", target_os = "linux")))]
pub fn without_window_system() {}
