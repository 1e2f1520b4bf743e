//! Notices of measured points.

use crate::findings::notice::notices;

notices! {
    /// What is not compared may be what is wrong.
    PointsOffFlanks: Note "deviations.off_flanks", "exchange.md", (off, points),
        "{off} of {points} points lie on no flank and are left out: roots, tips, the body, or further than half a \
         module off";
        "Measure flanks alone, or name tooth and flank of every point where flanks lie near each other."
}
