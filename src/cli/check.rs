//! `gearcut check`: what a scene means, before anything is cut.
//!
//! The verdict comes first, then one part per question: is this the pitch curve I meant, what does the tool do to the
//! teeth, can the machine follow, what will the cut cost. On one screen, unless all is asked for. A scene whose cut
//! will be faulty is told so by the exit code as well.

use super::args::CheckArguments;
use super::failure::Failure;
use super::print;
use crate::findings::notice::count_words;
use crate::output::text::Sheet;
use crate::process;

/// Most lines of facts and warnings together, as a terminal shows them.
const BRIEF_LINES: usize = 50;
/// Fewest lines of facts, however many warnings there are.
const FEWEST_FACTS: usize = 20;

/// Runs the command.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let scene = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let mut sheet = if arguments.verbose { Sheet::default() } else { Sheet::brief() };
    let checked =
        print::waiting("check", "scene", || process::prepare(&scene.scene).and_then(|job| job.check(&mut sheet)));
    let warnings = checked.map_err(|error| Failure::of_scene(&scene, error))?;
    let rules = arguments.verdict.rules();
    let verdict = if warnings.iter().any(|of| rules.is_bad(of)) { "not as it is" } else { "can be cut" };
    let verdict = format!("{verdict}: {}", count_words(&warnings));
    if arguments.verbose {
        print::sheet(&format!("{verdict}\n\n{}", sheet.into_text()))?;
        print::warnings(&warnings);
    } else {
        let lines = print::lines_on_a_terminal(&warnings);
        // The verdict and the empty line after it, and the count of warnings.
        let room = BRIEF_LINES.saturating_sub(lines + 3).max(FEWEST_FACTS);
        print::sheet(&format!("{verdict}\n\n{}", print::at_most(&sheet.into_text(), room)))?;
        print::warnings_within(&warnings, BRIEF_LINES - FEWEST_FACTS - 3);
    }
    Failure::verdict(&warnings, &rules)
}
