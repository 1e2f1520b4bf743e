//! Notices of hobbed gears.

use crate::findings::notice::notices;

notices! {
    /// Pitch errors of the hob's threads repeat on the gear instead of averaging out.
    Hunting: Warning "hob.hunting", "hobbing.md", (starts, teeth, common),
        "{starts} starts and {teeth} teeth share the divisor {common}: each start always cuts the same tooth spaces, \
         and the hob's pitch errors stay on the gear";
        "Take a number of starts that shares no divisor with the teeth."
    /// The helix of the gear comes out wrong.
    HeadAngle: Warning "hob.head_angle", "hobbing.md", (operation, head_deg, right_deg),
        "operation {operation}: the head is set to {head_deg} deg, hob and gear need {right_deg} deg: the flanks \
         will be off";
        "Leave the head's angle out: it follows from hob and gear."
    /// Cycle by cycle the gear turns on, and flanks no longer meet.
    CurveClosure: Warning "curve.closure", "hobbing.md", (operation, closure_mm),
        "operation {operation}: the pitch curve's closure error adds up to {closure_mm} mm over its cycles: "
        + "leave the size out and it is solved"
    /// Feed marks are higher on one side of the curve than on the other.
    ResultantFeed: Warning "hob.resultant_feed", "hobbing.md", (operation, first_mm, second_mm, factor),
        "operation {operation}: with feed_of = \"resultant\" the slide feeds {first_mm} mm per revolution one way and \
         {second_mm} mm the other: feed marks differ by a factor of {factor}";
        "Take another feed_of."
    /// The tip diameter is that of the hob and no longer that of the blank.
    Tops: Note "hob.tops", "hobbing.md", (tip_mm, under_mm),
        "the hob tops the gear: its roots end the tips {tip_mm} mm over the pitch curve, {under_mm} mm under the \
         blank's outline; "
        + "a larger tool.hob.dedendum_coefficient keeps the blank's own tips"
    /// Undercut weakens the root and shortens the active flank.
    Undercut: Warning "flank.undercut", "hobbing.md", (count, teeth),
        "the hob's tip corner undercuts {count} teeth ({teeth}): "
        + "use more teeth, a larger gear.profile_shift_coefficient, a smaller addendum_coefficient of the hob, or a \
           pitch curve that is flatter there"
    /// What the hob is made to take off counts as damage.
    Protuberance: Note "hob.protuberance", "hobbing.md", (),
        "the target knows no protuberance: its relief at the roots is reported as a cut below the \
         target and as gouges";
        "Read cuts below the target near the roots as the protuberance's relief."
    /// What the hob is made to take off counts as a deviation.
    TipRelief: Note "hob.tip_relief", "hobbing.md", (),
        "the target is the involute up to the tip: what tip relief and semi-topping of the hob take off there is \
         reported as deviation and as a cut below the target; "
        + "measure.profile_end_height_mm ends the evaluation below it"
    /// The dexels end above the surface: its true depth is not known.
    BeyondRecord: Warning "flank.beyond_record", "dexels.md", (reach_mm),
        "cuts go deeper than rays record: {reach_mm} mm under the target means that and more";
        "Look for what cuts so deep: damage in results.json names it."
    /// Teeth of the hob that take thicker chips wear fast or break out.
    ThickChip: Warning "hob.thick_chip", "hobbing.md", (operation, tooth, chip, usual_mm),
        "operation {operation}: hob tooth {tooth} takes {chip}, more than {usual_mm} mm, which few hobs bear: "
        + "lower the feed, take more gashes or fewer starts, or divide the cut"
    /// A tooth at the end of the hob does the work of several: it wears fast or breaks out.
    ThickChipAtEnd: Warning "hob.thick_chip", "hobbing.md", (operation, tooth, chip, usual_mm, end, side, shift_mm),
        "operation {operation}: hob tooth {tooth} takes {chip}, more than {usual_mm} mm, which few hobs bear, and far \
         more than the tooth beside it: it is the last at the {end} end, and the hob ends within the zone where the \
         blank is roughed out; "
        + "use a longer hob (tool.hob.length_mm), or shift it towards its {end} end \
           (operation.shift_start_mm {side} {shift_mm})"
    /// The flank is rougher than the scene allows.
    FeedMarks: Warning "hob.feed_marks", "hobbing.md", (operation, height_um, allowed_um, feed_mm),
        "operation {operation}: the feed makes marks up to {height_um} um high, {allowed_um} um are allowed \
         (ridge_tolerance_um): "
        + "feed at most {feed_mm} mm per revolution"
    /// The machine goes to the first position at rapid, and there the hob is in the blank.
    StartsInside: Warning or Fault where "the gear is round" "hob.starts_inside", "hobbing.md",
        (operation, approach_mm, clear_mm),
        "operation {operation}: the hob starts inside the blank: the slide begins {approach_mm} mm before the face, \
         and the hob is clear of the blank from {clear_mm} mm on: "
        + "leave operation.approach_mm out, or make it larger"
    /// The ends of flanks keep material.
    ShortOverrun: Warning "hob.short_overrun", "hobbing.md", (operation, overrun_mm, leaves_mm),
        "operation {operation}: the slide ends {overrun_mm} mm beyond the face, and the last contacts leave the work \
         at {leaves_mm} mm: flanks keep material at that face: "
        + "leave operation.overrun_mm out, or make it larger"
    /// Helix deviations come out too small.
    MissedMarks: Warning "hob.missed_marks", "hobbing.md", (rows_um, feed_mm, height_um, enough_um),
        "rows of flanks lie {rows_um} um apart and meet the marks of {feed_mm} mm of feed at few places: F_beta and \
         f_f_beta may lack most of their {height_um} um: "
        + "set fields.flank.lead_spacing_um to {enough_um} or less"
    /// Only the paper's own gear is meant to be cut with it.
    AsPrinted: Warning "hob.as_printed", "hobbing.md", (operation),
        "operation {operation}: the linkage is the one printed in the paper; work and carriage part on a curve that is \
         no circle, and no G-code is written";
        "Take the linkage that is not as printed."
}
