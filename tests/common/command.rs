//! The program, run as a user runs it.
#![allow(dead_code, reason = "each test binary uses its own part")]

use std::path::Path;
use std::process::Command;

/// What a run of the program gave.
#[derive(Debug)]
pub struct Outcome {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

/// Runs `gearcut` in the repository's root.
pub fn gearcut(arguments: &[&str]) -> Outcome {
    gearcut_in(Path::new(env!("CARGO_MANIFEST_DIR")), arguments)
}

/// Runs `gearcut` in a folder.
pub fn gearcut_in(folder: &Path, arguments: &[&str]) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_gearcut"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program is built before its tests");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program prints UTF-8");
    Outcome { code: output.status.code().unwrap_or(-1), out: text(output.stdout), err: text(output.stderr) }
}

impl Outcome {
    /// The outcome of a run that must have gone well.
    #[track_caller]
    pub fn done(self) -> Self {
        assert_eq!(self.code, 0, "standard error: {}", self.err);
        self
    }

    /// The outcome of a run that must have failed with this code and these words on standard error.
    #[track_caller]
    pub fn failed(self, code: i32, words: &[&str]) -> Self {
        assert_eq!(self.code, code, "standard error: {}", self.err);
        for word in words {
            assert!(self.err.contains(word), "no {word:?} in standard error: {}", self.err);
        }
        self
    }

    /// Asserts that standard output says this.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Self {
        for word in words {
            assert!(self.out.contains(word), "no {word:?} in standard output: {}", self.out);
        }
        self
    }
}
