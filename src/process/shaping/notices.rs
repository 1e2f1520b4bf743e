//! Notices of shaped gears.

use crate::findings::notice::notices;

notices! {
    /// Returning along the flanks rubs the edge and marks the gear.
    NoBackOff: Warning "return.no_back_off", "shaping.md", (),
        "machine.back_off_mm = 0: the cutter returns along the surfaces that it has cut"; "Give machine.back_off_mm."
    /// The edge wears and scores the flank where relief is small.
    ReliefTight: Warning "return.tight", "shaping.md", (operation, back_off_mm, place, clearance_um, percent),
        "operation {operation}: backing off by {back_off_mm} mm along the line of centres clears {place} by only \
         {clearance_um} um to first order, {percent} % of what a circular gear gets: "
        + "back off further, or along the normal of the pitch curve"
    /// The returning cutter scores flanks that it has cut.
    ReliefRubs: Warning "return.enters", "shaping.md", (operation, place, depth_um, back_off_mm),
        "operation {operation}: the return stroke rubs: backing off along the line of centres moves the cutter into \
         {place} by {depth_um} um to first order for {back_off_mm} mm; "
        + "back off along the normal of the pitch curve, or take a larger pressure angle or a cutter with more teeth"
    /// The edge wears and scores the flank where relief is small.
    ReturnTight: Warning "return.tight", "shaping.md", (operation, place, clearance_um, way_out),
        "operation {operation}: by the surfaces that it generates, the returning cutter clears the teeth near {place} \
         by {clearance_um} um only. {way_out}";
        "Draw back another way or further, as the notice says."
    /// The returning cutter scores flanks that it has cut.
    ReturnEnters: Warning "return.enters", "shaping.md", (operation, depth_um, place, overlap_mm2, way_out),
        "operation {operation}: by the surfaces that it generates, the returning cutter is {depth_um} um deep in \
         the teeth near {place}, over {overlap_mm2} mm^2 of their section. {way_out}";
        "Draw back another way or further, as the notice says."
    /// The returning cutter scores flanks of the gear as it was cut.
    ReturnRubs: Warning "return.rubs", "blank.md", (operation, stroke, depth_um, tooth, side, volume_mm3, way_out),
        "operation {operation}: in the gear as cut, after stroke {stroke} the returning cutter is {depth_um} um \
         deep in tooth {tooth} {side}, and in {volume_mm3} mm^3 in all: {way_out}; gearcut check says where it clears";
        "Set another machine.retraction or machine.back_off_mm."
    /// The cutter is still in the way when the ram comes back through the face.
    ReturnNoTime: Warning "return.no_time", "shaping.md", (operation, why),
        "operation {operation}: the axes cannot draw the cutter back: {why}";
        "Give machine.approach_mm and machine.overrun_mm."
    /// At this stroke rate the axes lag behind, and the cutter rubs.
    ReturnSlow: Warning "return.slow", "shaping.md", (operation, needed_ms, free_ms, most_per_minute),
        "operation {operation}: drawing the cutter back takes the axes {needed_ms} ms, and the ram gives them \
         {free_ms} ms: "
        + "run at most {most_per_minute} double strokes per minute, give more machine.approach_mm and \
           machine.overrun_mm, or back off by less"
    /// One tilt of the retraction cannot serve all strokes.
    ReturnNoDirection: Warning "return.no_direction", "shaping.md", (operation, above_deg, below_deg),
        "operation {operation}: no direction clears everything: some strokes need a tilt above {above_deg} deg, others \
         one below {below_deg} deg; "
        + "leave less stock to this operation"

    /// Material that finishing should find is gone: its own cut cannot mend the flank.
    DeeperByOffset: Warning or Fault where "the cut is deeper than a gouge" "cut.deeper_than_finishing", "shaping.md",
        (operation, deeper_mm, depth_um),
        "operation {operation}: it goes {deeper_mm} mm deeper than finishing and cuts some {depth_um} um into every \
         flank: "
        + "give it a larger offset_mm"
    /// Material that finishing should find is gone: its own cut cannot mend the flank.
    DeeperByEnvelope: Warning or Fault where "the cut is deeper than a gouge" "cut.deeper_than_finishing", "shaping.md",
        (operation, depth_um, flanks, tooth, side, height_mm),
        "operation {operation}: its envelope lies up to {depth_um} um below {flanks} of the finished flanks, deepest \
         on tooth {tooth} {side}, {height_mm} mm over the pitch curve: "
        + "leave more stock, or take the linkage of finishing"
    /// The ram stalls, or the machine bends far beyond what is usual.
    Force: Warning "cut.force", "chips.md", (operation, what, force_kn, limit_kn, source, way_out),
        "operation {operation}: {what} {force_kn} kN, more than {limit_kn} kN ({source}): {way_out}";
        "Take thinner chips, or state the ram's true limit in machine.limits.cutting_force_n."
    /// The dexels end above the surface: its true depth is not known.
    BeyondRecord: Warning "flank.beyond_record", "dexels.md", (dexels),
        "{dexels} dexels were cut deeper than their rays record: heights there are upper bounds";
        "Look for what cuts so deep: damage in results.json names it."
    /// Part of the flanks is still the blank, and no number covers it.
    Uncut: Warning "flank.uncut", "shaping.md", (dexels, flanks, tooth, side, percent, from_mm),
        "{dexels} dexels were reached by no pass: part of {flanks} flanks is still the blank, most of tooth {tooth} \
         {side}: {percent} % of it, beginning {from_mm} mm above the start of the involute";
        "Give the cutter more addendum or the gear less, so that the cutter reaches the whole flank."
    /// The gear is damaged: material of its finished flanks is gone.
    FlankGouge: Fault "flank.gouge", "results.md", (count, tooth, side, depth_um, arc_mm, gouge_um),
        "{count} flanks are cut below the target, tooth {tooth} {side} by {depth_um} um, {arc_mm} mm above the start \
         of the involute: a gouge is deeper than {gouge_um} um";
        "Cut with rays through the blank, which name the stroke that does it."
    /// Deviations of this size spend the tolerance of the drawing.
    FlankBelowTarget: Warning "flank.below_target", "results.md", (count, tooth, side, depth_um, arc_mm, gouge_um),
        "{count} flanks are cut below the target, tooth {tooth} {side} by {depth_um} um, {arc_mm} mm above the start \
         of the involute: on evaluated profiles a gouge is deeper than {gouge_um} um";
        "Nothing, where the drawing allows it; else look at errors of the machine and at roughing."
    /// Pitch, thickness and allowance of these flanks are not known.
    Unsettled: Fault "flank.unsettled", "results.md", (count, tooth, side),
        "{count} flanks jump where they meet the pitch curve, first that of tooth {tooth} {side}: their pitch, \
         thickness and allowance are not known";
        "Look for what cuts into these flanks."

    /// Undercut weakens the root and shortens the active flank.
    Undercut: Warning "flank.undercut", "shaping.md", (flanks, depth_um),
        "the cutter undercuts {flanks}, up to {depth_um} um deep: "
        + "use a cutter that reaches less deep (a smaller tool.shaper_cutter.addendum_coefficient, a lower drawn tip), \
           more teeth on the gear, or a pitch curve with a larger smallest radius of curvature"
    /// The tip is no involute there: mates do not roll on it.
    CutterBase: Warning "flank.cutter_base", "shaping.md", (flanks),
        "the cutter's involute ends before the tip of {flanks}: the rest of the tip is cut by the cutter's base; "
        + "use a cutter with more teeth or a smaller gear.addendum_coefficient"
    /// The teeth are lower than the drawing says, and their tips are the cutter's roots.
    Topped: Warning or Fault where "the cut is deeper than a gouge" "tip.topped", "shaping.md", (depth_um),
        "the cutter's root circle takes {depth_um} um off the tips of the teeth: "
        + "use a cutter with deeper roots (a larger tool.shaper_cutter.dedendum_coefficient, lower roots of a drawn \
           tooth), a smaller gear.addendum_coefficient, or teeth thinned by less"
    /// Pointed teeth break at their tips and are lower than the drawing says.
    Pointed: Warning "tip.pointed", "shaping.md", (teeth),
        "pointed below the blank's outline: tooth {teeth}"; "Use a smaller addendum of the gear, or more teeth."
    /// Hardened tips of little width break.
    NarrowTip: Warning "tip.narrow", "shaping.md", (modules, narrow_mm, teeth),
        "tip land below {modules} modules ({narrow_mm} mm): tooth {teeth}";
        "Use a smaller addendum of the gear, or more teeth."

    /// The cutter damages teeth beside the space that it cuts.
    TipCorners: Warning or Fault where "the cut is deeper than a gouge" "ring.tip_corners", "internal.md",
        (depth_mm, place, way_out),
        "the tip corners of the cutter cut {depth_mm} mm into teeth beside their space ({place}). {way_out}";
        "Use a cutter with fewer teeth."
    /// The cutter takes off part of the ring's tips on its way in.
    Trimmed: Warning or Fault where "the cut is deeper than a gouge" "ring.trimmed", "internal.md",
        (depth_um, place, way_out),
        "going in, the cutter trims the ring's teeth by {depth_um} um ({place}). {way_out}";
        "Use a cutter with fewer teeth."

    /// The cutter comes too close to a flank on its way from stroke to stroke.
    ProgramBetween: Warning or Fault where "the cutter scrapes deeper than a gouge" "program.between", "gcode.md",
        (operation, distance_um, stroke, clearance_um),
        "operation {operation}: between strokes the program lies up to {distance_um} um off the straight way from the \
         one to the next, at stroke {stroke}; relief clears a flank by {clearance_um} um (machine.back_off_mm); "
        + "let the axes go straight, or draw back"
    /// The cutter clears the flanks by less than the scene says, or drags over them.
    ProgramBack: Warning or Fault where "the cutter drags over the flanks" "program.back", "gcode.md",
        (operation, short_um, asked_um, stroke, so),
        "operation {operation}: while the ram returns the program has the cutter up to {short_um} um short of where \
         machine.retraction draws it back to, {asked_um} um away, at stroke {stroke}; {so}";
        "Draw back before the return stroke enters the face, and come in after it has left it."
    /// Where strokes are missing, material is left.
    ProgramMissing: Fault "program.missing", "gcode.md", (operation, strokes, first),
        "operation {operation}: {strokes} missing from the program, {first}";
        "Let the program make every stroke of the scene."
    /// The ram's clock and the axes no longer agree.
    ProgramTwice: Fault "program.twice", "gcode.md", (operation, strokes, first),
        "operation {operation}: {strokes} made twice, {first}"; "Let the program make every stroke once."
    /// These strokes cut where the scene does not.
    ProgramForeign: Fault "program.foreign", "gcode.md", (operation, strokes, first),
        "operation {operation}: {strokes} none of the scene's, {first}";
        "Let the program make the scene's strokes alone."
    /// Forces, errors that depend on speed and times follow the program and no longer the scene.
    ProgramSpeed: Fault "program.time", "gcode.md", (operation, program_per_minute, scene_per_minute),
        "operation {operation}: the program's S is {program_per_minute} double strokes per minute, the scene says \
         {scene_per_minute}: times, speeds, drifts and lags are those of the program";
        "Let both say the same."

    /// Every flank leans along the tooth: mates touch at one end of the face.
    GuideLead: Warning "helix.lead", "shaping.md", (lead_mm, needed_mm, slope_um, angle_deg),
        "the guide's lead of {lead_mm} mm is not the {needed_mm} mm that the gear's helix needs: helices of all flanks \
         slope by {slope_um} um over the face; "
        + "leave machine.guide_lead_mm out, or write gear.helix_angle_deg = {angle_deg}, which that lead cuts"
    /// The force of a whole stroke is more even than that of one section.
    HelixChips: Note "helix.chips", "chips.md", (),
        "chips and forces of a stroke are those of the section in the middle of the face: at other heights the guide \
         has turned the cutter, and the stroke takes the chips of others there";
        "Read them as those of one section; volumes and areas of whole operations are those of the gear."

    /// Helices of the cut gear are smoother than those of the real one.
    FastNoise: Warning "axis.fast_noise", "errors.md", (operation, axis, bandwidth_hz, apart, most_hz, most_apart),
        "operation {operation}: noise of the {axis} up to {bandwidth_hz} Hz is faster than strokes follow along the \
         tooth: between four places of the face they leave it by {apart} of its standard deviation, up to {most_hz} Hz \
         by {most_apart} at most; helices are smoother than it";
        "Trust no helix form of this axis's noise, or lower its bandwidth."
    /// Waves grow from stroke to stroke: flanks get marks, and the edge and the machine suffer.
    Chatter: Warning "machine.chatter", "deflection.md", (operation, strokes, times, left_um, right_um),
        "operation {operation}: {strokes} are beyond the limit of stability, by {times} times at most: the cutter \
         chatters, by up to {left_um} um on left flanks and {right_um} um on right ones (root mean square along the \
         face): "
        + "take thinner chips or a narrower face, or make the machine stiffer or better damped"
    /// A step on the last flank counts as a form and pitch deviation.
    ClosingStep: Warning "measure.closing_step", "errors.md", (operation, tooth, side, step_um, way, causes),
        "operation {operation}: where its end meets its beginning, on tooth {tooth} {side}, the later strokes lie \
         {step_um} um {way} the earlier ones: "
        + "see {causes}"
    /// The largest pitch deviation says nothing of the indexing there.
    ClosingPitch: Note "measure.closing_pitch", "errors.md", (single_um, before, tooth, side, operation, causes),
        "the largest f_p, {single_um} um from tooth {before} to tooth {tooth} {side}, is measured where operation \
         {operation} closes, and is no error of pitch of the machine: see {causes}";
        "Judge the indexing by the other pitches."
}
