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
    /// Surfaces of different places have no difference.
    PoorCorrelation: Warning "compare.correlation", "texture.md", (correlation),
        "a correlation of {correlation} is poor: are these surfaces of one place?"; "Compare surfaces of one place."
    /// Differences of a replica are those of heights with the wrong sign.
    Inverted: Warning "compare.inverted", "texture.md", (correlation),
        "with its heights inverted the second correlates with {correlation}: is one of them a replica? "
        + "`gearcut texture FILE --invert --save ...` turns it back"
}
