//! Notices of measured points.

use crate::findings::notice::notices;

notices! {
    /// Deviations from other flanks than those that were measured say nothing.
    ContradictedFlanks: Fault "deviations.contradicted", "exchange.md", (named, points, rms_um, unnamed, way_out),
        "tooth and flank of the points contradict their places: {named} of {points} lie on the flanks that they name, \
         {rms_um} um off in the root mean square, {unnamed} if they may lie on any: {way_out}";
        "Look in which direction the measuring machine counts teeth, and which flank it calls left."
    /// What is not compared may be what is wrong.
    PointsOffFlanks: Note "deviations.off_flanks", "exchange.md", (off, points),
        "{off} of {points} points lie on no flank and are left out: roots, tips, the body, beyond the face, or \
         further than half a module off";
        "Measure flanks alone, or name tooth and flank of every point where flanks lie near each other; z = 0 \
         is the middle of the face."
}
