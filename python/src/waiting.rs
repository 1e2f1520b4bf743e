//! Work that takes its time, seen from Python: without the interpreter's lock, ended by Ctrl-C, watched.
//!
//! In: work and the flag that ends it. Out: its result, and the exception that a signal or a watcher raised meanwhile.
//! The work runs on a thread of its own; the calling thread waits, and asks for signals some times a second, because
//! Python delivers them to its main thread alone.

use gearcut::interrupt::Interrupt;
use gearcut::progress::{Event, Progress, ProgressMode};
use pyo3::prelude::*;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// Between two questions for signals: at once for a hand on the keyboard, nothing for the processor.
const SIGNALS_EVERY: Duration = Duration::from_millis(50);

/// Does the work and gives its result. An exception that a signal raises meanwhile raises the flag, and comes beside
/// the result once the work has ended.
pub fn waited<T: Send>(py: Python<'_>, interrupt: &Interrupt, work: impl FnOnce() -> T + Send) -> (T, Option<PyErr>) {
    let (ended, bell) = (Mutex::new(false), Condvar::new());
    let mut raised = None;
    let done = thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let done = work();
            *ended.lock().unwrap_or_else(PoisonError::into_inner) = true;
            bell.notify_all();
            done
        });
        let wait = || {
            let guard = ended.lock().unwrap_or_else(PoisonError::into_inner);
            let waited = bell.wait_timeout_while(guard, SIGNALS_EVERY, |ended| !*ended);
            *waited.unwrap_or_else(PoisonError::into_inner).0
        };
        loop {
            // A worker that panics ends without the bell.
            let ended = py.detach(wait) || worker.is_finished();
            // Also once the work has ended: a signal of its last moments belongs to it.
            if let Err(signal) = py.check_signals() {
                interrupt.raise();
                raised.get_or_insert(signal);
            }
            if ended {
                break;
            }
        }
        py.detach(|| worker.join())
    });
    (done.unwrap_or_else(|panic| std::panic::resume_unwind(panic)), raised)
}

/// A callable of Python that takes every event as the text of a JSON object, and what it has raised.
pub struct EventWatch {
    /// Where the work reports.
    pub progress: Progress,
    raised: Arc<Mutex<Option<PyErr>>>,
}

impl EventWatch {
    /// Reports to a callable, or to nobody. What the callable raises ends the work.
    pub fn new(watcher: Option<Py<PyAny>>, interrupt: &Interrupt) -> Self {
        let raised = Arc::new(Mutex::new(None));
        let Some(watcher) = watcher else { return Self { progress: Progress::new(ProgressMode::Quiet), raised } };
        let (interrupt, of_watcher) = (interrupt.clone(), Arc::clone(&raised));
        let progress = Progress::watched(move |event: &Event| {
            if interrupt.is_raised() {
                return;
            }
            let text = serde_json::json!(event).to_string();
            if let Err(failed) = Python::attach(|py| watcher.call1(py, (text,)).map(drop)) {
                of_watcher.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(failed);
                interrupt.raise();
            }
        });
        Self { progress, raised }
    }

    /// What the callable has raised.
    pub fn raised(&self) -> Option<PyErr> {
        self.raised.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}
