//! Notices of comparisons.

use crate::findings::notice::notices;

notices! {
    /// Extremes and means of this result lack some flanks.
    Stopped: Warning "compare.stopped", "howto.md", (name),
        "{name} was stopped before all flanks were cut"; "Cut it to its end."
    /// Its numbers may be those of a damaged gear.
    HasFaults: Warning "compare.faults", "results.md", (name, counts),
        "{name} has {counts}"; "Read them on that result's page."
    /// Its numbers may not mean what they seem to.
    HasNotices: Note "compare.notices", "results.md", (name, counts),
        "{name} has {counts}"; "Read them on that result's page."
}
