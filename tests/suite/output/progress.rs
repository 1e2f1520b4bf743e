//! Progress lines, events and Ctrl-C as other programs see them.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use gearcut::interrupt::Interrupt;
use gearcut::progress::{Progress, ProgressMode};

/// Writer whose text can be read afterwards.
#[derive(Clone, Default)]
struct Page(Arc<Mutex<Vec<u8>>>);

impl Page {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().expect("one thread at a time").clone()).expect("UTF-8")
    }
}

impl Write for Page {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("one thread at a time").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn said(mode: ProgressMode) -> String {
    let page = Page::default();
    let progress = Progress::to_writer(mode, Box::new(page.clone()));
    progress.note("backend: cpu");
    let step = progress.step("cut", 3, "flanks");
    step.advance(1);
    std::thread::sleep(std::time::Duration::from_millis(550));
    step.advance(2);
    step.finish();
    page.text()
}

#[test]
fn json_mode_gives_one_object_per_line() {
    let text = said(ProgressMode::Json);
    let events: Vec<serde_json::Value> =
        text.lines().map(|line| serde_json::from_str(line).expect("each line is JSON")).collect();
    let names: Vec<_> = events.iter().map(|event| event["event"].as_str().expect("named")).collect();
    assert_eq!(names, ["note", "step_started", "progress", "step_finished"]);
    assert_eq!(events[1]["total"], 3);
    assert_eq!(events[2]["done"], 3);
    assert!(events[2]["remaining_s"].is_null(), "no guess in the first two seconds");
    assert!(events[3]["elapsed_s"].as_f64().expect("a number") > 0.5);
}

#[test]
fn plain_lines_are_few_and_quiet_is_silent() {
    let text = said(ProgressMode::Lines);
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines.len(), 2, "{text}");
    assert_eq!(lines[0], "backend: cpu");
    assert!(lines[1].starts_with("cut: 3 flanks in 0."), "{text}");
    assert_eq!(said(ProgressMode::Quiet), "");
}

#[test]
fn the_flags_choose_the_mode() {
    assert_eq!(ProgressMode::choose(true, false), ProgressMode::Quiet);
    assert_eq!(ProgressMode::choose(false, true), ProgressMode::Json);
}

#[test]
fn a_raised_interrupt_stops_the_work_at_the_next_check() {
    let interrupt = Interrupt::default();
    interrupt.check().expect("nobody asked to stop");
    interrupt.clone().raise();
    assert_eq!(interrupt.check().expect_err("raised").to_string(), "stopped by Ctrl-C");
}

/// Not a test of its own: the child of the next one, which it starts with this variable set.
#[test]
fn child_that_is_interrupted() {
    if std::env::var_os("GEARCUT_TEST_INTERRUPT").is_none() {
        return;
    }
    let interrupt = Interrupt::listen().expect("the only listener");
    eprintln!("listening");
    while !interrupt.is_raised() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    eprintln!("raised");
    std::thread::sleep(std::time::Duration::from_secs(30));
}

/// The first signal only raises the flag; the second ends the process with code 130.
#[cfg(unix)]
#[test]
fn the_second_ctrl_c_ends_the_process_at_once() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    let this = std::env::current_exe().expect("the running test");
    let mut child = Command::new(this)
        .args(["output::progress::child_that_is_interrupted", "--exact", "--nocapture"])
        .env("GEARCUT_TEST_INTERRUPT", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the test can start itself");
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    let interrupt = |id: u32| Command::new("kill").args(["-INT", &id.to_string()]).status().expect("kill exists");
    for expected in ["listening", "raised"] {
        let line = lines.next().expect("the child speaks").expect("UTF-8");
        assert_eq!(line, expected);
        assert!(interrupt(child.id()).success());
    }
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
}
