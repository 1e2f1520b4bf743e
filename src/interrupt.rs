//! Ctrl-C that keeps what is finished.
//!
//! In: the signals that ask a program to stop (SIGINT, SIGTERM, SIGHUP; Ctrl-C and Ctrl-Break on Windows). Out: a flag
//! that the work looks at between its units, so that it ends by the usual way and removes its temporary files.
//!
//! The first signal raises the flag; a second one ends the process at once with code 130, for the user who will not
//! wait. It leaves what a killed process leaves: a hidden folder beside the results, which the next run removes.
//!
//! A driver that hangs may hold what the ends of libraries wait for. [`end_now`] ends such a process as well: after two
//! seconds it gives its place to a shell that does nothing but end with the same code, for `_exit` is unsafe to call.
//!
//! Road not taken: a global flag that everybody may ask. Passing [`Interrupt`] along shows in the signatures which work
//! can be stopped, and tests can raise it without a signal.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use std::{io, process, thread};

use gearcut_core::{Error, Result};

/// Exit code of a program ended by Ctrl-C: 128 + SIGINT.
pub const INTERRUPTED_EXIT_CODE: u8 = 130;

/// How long the libraries of the process may take to end.
const ENDING: Duration = Duration::from_secs(2);

/// Ends the process with a code, whatever its libraries do at their ends.
pub fn end_now(code: u8) -> ! {
    let watch = thread::Builder::new().spawn(move || {
        thread::sleep(ENDING);
        end_without_libraries(code)
    });
    if watch.is_err() {
        end_without_libraries(code);
    }
    process::exit(code.into())
}

/// Ends the process without a word to its libraries; without a shell it is aborted.
#[cfg_attr(not(unix), expect(unused_variables, reason = "no shell"))]
fn end_without_libraries(code: u8) -> ! {
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        let _no_shell = process::Command::new("/bin/sh").args(["-c", &format!("exit {code}")]).exec();
    }
    process::abort()
}

/// Flag that is raised when the user wants to stop; clones share it.
#[derive(Debug, Clone, Default)]
pub struct Interrupt {
    raised: Arc<AtomicBool>,
}

impl Interrupt {
    /// Flag that listens to the process's signals.
    ///
    /// # Errors
    /// Another listener is there already.
    #[cfg(feature = "command")]
    pub fn listen() -> io::Result<Self> {
        let interrupt = Self::default();
        let on_signal = interrupt.clone();
        ctrlc::set_handler(move || {
            if on_signal.raised.swap(true, Ordering::SeqCst) {
                end_now(INTERRUPTED_EXIT_CODE);
            }
        })
        .map_err(io::Error::other)?;
        Ok(interrupt)
    }

    /// Raises the flag as a signal would.
    pub fn raise(&self) {
        self.raised.store(true, Ordering::SeqCst);
    }

    /// Whether the user wants to stop.
    pub fn is_raised(&self) -> bool {
        self.raised.load(Ordering::SeqCst)
    }

    /// For use with `?` between units of work.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once the flag is raised.
    pub fn check(&self) -> Result<()> {
        if self.is_raised() { Err(Error::Interrupted) } else { Ok(()) }
    }
}
